# shellcheck shell=bash
# How deep the stack can get below each entry point, from the machine code. Sourced by check.sh.

# The linker of a compiler: rustup brings one, beside Debian's stands its own.
linker() {
    local own
    own=$(rustc --print sysroot)/lib/rustlib/$(rustc -vV | sed -n 's/^host: //p')/bin/rust-lld
    if [ "${compile[0]}" = cargo ] && [ -x "$own" ]; then
        "$own" -flavor gnu "$@"
    else
        "$(compgen -c ld.lld | sort | head -n 1)" "$@"
    fi
}

# Links the library of tests/bare for a target, every entry point and the control in it, frames stated.
build_entries() {
    # shellcheck disable=SC2034 # Set by describe.
    local triple board flags machine dir=$out/$1
    describe "$1"
    compiler_for "$triple"
    (cd ../bare && RUSTC_BOOTSTRAP=1 RUSTFLAGS="-Zemit-stack-sizes $flags" "${compile[@]}" build --quiet --profile s \
        --target "$triple" --target-dir "$CARGO_TARGET_DIR/entries-$1") || { echo "firmware: $1: no entry points"; exit 1; }
    mkdir -p "$dir"
    local library=$CARGO_TARGET_DIR/entries-$1/$triple/s/libhooke_bare.a
    # Old readers complain about members of compiler-builtins that they do not know.
    { llvm-nm "$library" 2>/dev/null || true; } | sed -nE 's/^.* T ((f32|f64|control)::.*)$/-u "\1"/p' >"$dir/entries.names"
    local kind
    case $triple in
        thumb*) kind=armelf ;;
        riscv32*) kind=elf32lriscv ;;
        riscv64*) kind=elf64lriscv ;;
        aarch64*) kind=aarch64elf ;;
        *) echo "firmware: stack.sh does not know how to link for $triple"; exit 1 ;;
    esac
    linker -m "$kind" -e 0 --gc-sections "@$dir/entries.names" "$library" -o "$dir/entries"
}

# Disassembles one of a target's programs.
list() {
    # shellcheck disable=SC2034 # Set by describe.
    local triple board flags machine
    describe "$1"
    # shellcheck disable=SC2046 # Zero or one option.
    llvm-objdump -d --no-show-raw-insn $(sed -n 's/.*-Ctarget-cpu=/--mcpu=/p' <<<"$flags") "$out/$1/$2" >"$out/$1/$2.list"
}

# Bounds for all entry points; the control must be refused; what was painted must lie below the bound of the same code.
bound_stack() {
    local dir=$out/$1 refused painted bound
    list "$1" entries && list "$1" measure
    "$judge" stack "$dir"/entries{,.list} f32:: f64:: >"$dir/stacks" || { echo "$1: no bound on the stack"; return 1; }
    [ "$(wc -l <"$dir/stacks")" = "$(grep -vc control:: "$dir/entries.names")" ] ||
        { echo "$1: $(wc -l <"$dir/stacks") bounds for $(grep -vc control:: "$dir/entries.names") entry points"; return 1; }
    refused=$("$judge" refused "$dir"/entries{,.list} control::) || return 1
    [ "$refused" = 2 ] || { echo "$1: $refused of 2 controls refused: the walk is blind"; return 1; }
    painted=$(awk '$1 == "painted" && $3 > most { most = $3 } END { print most }' "$dir/measured")
    bound=$("$judge" stack "$dir"/measure{,.list} firmware_image::stack::used | awk -F'\t' '$2 > most { most = $2 } END { print most }')
    # The paint begins within the frame of the function that counts it, which is not part of the bound: 32 bytes at most.
    if [ "$painted" -gt $((bound + 32)) ] || [ "$bound" -gt $((2 * painted)) ]; then
        echo "$1: $painted bytes of stack painted, bound $bound"
        return 1
    fi
    echo "$painted $bound" >"$dir/painted"
}
