# shellcheck shell=bash
# Building and running one target's programs. Sourced by check.sh.

# The columns of targets.txt for a name: sets triple, board, flags, machine.
describe() {
    local line
    line=$(grep -E "^$1 " targets.txt) || { echo "firmware: no target named $1 in targets.txt"; exit 1; }
    read -r _ triple board flags machine <<<"$line"
    [ "$flags" != - ] || flags=
}

# Which programs a target gets: those that fit and can run there.
programs() {
    case $1 in
        microbit) echo rope_f32 rope_f64 ;;
        wasm32) ;;
        m4f) echo all minimal measure; (cd image/src/bin && basename -s .rs with_*.rs) ;;
        *) echo all minimal measure ;;
    esac
}

# Builds them and copies them to where no other target overwrites them.
build_target() {
    local triple board flags machine program link package=firmware-image bins=() compile=()
    describe "$1"
    compiler_for "$triple"
    for program in $(programs "$1"); do bins+=(--bin "$program"); done
    case $board in
        -) link='' package=firmware-wasm ;;
        aarch64) link="-Clink-arg=-T$PWD/boards/aarch64/link.x" ;;
        riscv) link="-L$PWD/boards/riscv -Clink-arg=-Tmemory.x -Clink-arg=-Tlink.x" ;;
        *) link="-L$PWD/boards/$board -Clink-arg=-Tlink.x" ;;
    esac
    RUSTFLAGS="$link $flags" "${compile[@]}" build --quiet --profile image --target "$triple" -p "$package" ${bins[@]+"${bins[@]}"} ||
        { echo "firmware: $1 does not build"; exit 1; }
    mkdir -p "$out/$1"
    for program in $(programs "$1"); do cp "$CARGO_TARGET_DIR/$triple/image/$program" "$out/$1/"; done
    [ "$board" != - ] || cp "$CARGO_TARGET_DIR/$triple/image/firmware_wasm.wasm" "$out/$1/"
}

# Runs one program: target, program, more options of QEMU.
emulate() {
    local triple board flags machine name=$1 program=$2
    shift 2
    describe "$name"
    # shellcheck disable=SC2086 # The machine is a list of options.
    timeout 240 qemu-system-$machine "$@" -display none -monitor none -serial null \
        -semihosting-config enable=on,target=native -kernel "$out/$name/$program" </dev/null
}

# Compares a program's trace; its exit code counts too.
same_bits() {
    local name=$1 trace=$2 code=$3
    shift 3
    grep '^failed' "$trace" || true
    "$judge" compare "$name" golden.txt "$@" <"$trace" || return 1
    [ "$code" = 0 ] || { echo "$name: exit code $code"; return 1; }
}

# Measures until two runs agree to a thousand instructions: the clock that counts on AArch64 may jump when this machine is
# busy. Elsewhere the counts are exact and the first run is the answer.
steadily() {
    local name=$1 now before='' try
    for try in 1 2 3 4 5; do
        emulate "$name" measure -icount "shift=$2" >"$out/$name/measured" ||
            { echo "$name: measure failed"; return 1; }
        now=$(awk '/-step / { printf "%d ", $3 / 1000 }' "$out/$name/measured")
        if [ "$name" != aarch64 ] || [ "$now" = "$before" ]; then return; fi
        before=$now
    done
    echo "$name: no two of $try measurements agree"
    return 1
}

# Runs all of a target's programs and compares.
run_target() {
    local name=$1 code=0 precision program
    if [ "$name" = wasm32 ]; then
        node wasm/run.mjs "$out/$name/firmware_wasm.wasm" >"$out/$name/trace" || code=$?
        same_bits "$name" "$out/$name/trace" "$code" >"$out/$name/jobs"
        return
    fi
    if [ "$name" = microbit ]; then
        for precision in f32 f64; do
            emulate "$name" "rope_$precision" >"$out/$name/trace" || code=$?
            same_bits "$name" "$out/$name/trace" "$code" rope "$precision" >>"$out/$name/jobs" || return 1
        done
        return
    fi
    emulate "$name" all >"$out/$name/trace" || code=$?
    same_bits "$name" "$out/$name/trace" "$code" >"$out/$name/jobs" || return 1
    for program in $(programs "$name" | grep -vx 'all\|measure'); do
        emulate "$name" "$program" || { echo "$name: the program $program failed"; return 1; }
    done
    local shift=0
    case $name in m*) shift=6 ;; esac
    steadily "$name" "$shift"
    bound_stack "$name"
}

# The same jobs on this machine: not optimised, and optimised in every way.
host_variants() {
    local variant profile
    for variant in debug:dev O0:o0 O1:o1 O2:o2 O3:release Os:s Oz:z native:release; do
        profile=${variant#*:} variant=${variant%%:*}
        local folder=$CARGO_TARGET_DIR flags=
        [ "$variant" != native ] || { folder=$CARGO_TARGET_DIR/native flags=-Ctarget-cpu=native; }
        RUSTFLAGS=$flags cargo build --quiet --profile "$profile" -p firmware-host --target-dir "$folder"
        mkdir -p "$out/host-$variant"
        "$folder/${profile/dev/debug}/firmware-host" run >"$out/host-$variant/trace"
        "$judge" compare "host-$variant" golden.txt <"$out/host-$variant/trace" >"$out/host-$variant/jobs"
        variants+=("host-$variant")
    done
}
variants=()
