# shellcheck shell=bash
# What the kernel costs on a target, as lines `target kind what number`. Sourced by check.sh.

# Bytes of sections: file, names.
bytes() { size -A "$1" | awk -v names=" $2 " 'index(names, " " $1 " ") { sum += $2 } END { print sum + 0 }'; }
flash() { bytes "$1" '.vector_table .init .text .rodata .data'; }
ram() { bytes "$1" '.data .bss'; }

# What was seen of a target: the minimal program, what each feature adds to it, what `measure` counted, and the deepest
# stack of each entry point (in f64 only where the features are priced).
seen() {
    local dir=$out/$1 program precision='f32::'
    [ -f "$dir/measured" ] || return 0
    echo "flash minimal $(flash "$dir/minimal")"
    echo "RAM minimal $(ram "$dir/minimal")"
    for program in "$dir"/with_*; do
        [ -f "$program" ] || continue
        precision='f(32|64)::'
        echo "flash +${program##*/with_} $(($(flash "$program") - $(flash "$dir/minimal")))"
        echo "RAM +${program##*/with_} $(($(ram "$program") - $(ram "$dir/minimal")))"
    done
    grep -E '^(RAM|instructions) ' "$dir/measured"
    # Of cores that calculate in software, the ratio would say how good that is.
    [ "$1" != m4f ] || "$judge" ratios arithmetic.md "$dir/measured"
    sed -nE "s/^(${precision}[^\t]*)\t/stack \1 /p" "$dir/stacks"
}

# Compares what was seen of the named targets with the budgets, or takes it as such.
budgets() {
    local what=$1 why=$2 name
    shift 2
    for name in "$@"; do seen "$name" | sed "s/^/$name /"; done >"$out/seen"
    [ -s "$out/seen" ] || return 0
    # shellcheck disable=SC2034 # Set by describe.
    local triple board flags machine compile=()
    describe "$1"
    compiler_for "$triple"
    case $what in
        check) "$judge" budgets check budgets.txt "$out/seen" "$(compiler_version)" ;;
        lower) "$judge" budgets lower budgets.txt "$out/seen" ;;
        raise) "$judge" budgets raise budgets.txt "$out/seen" "$(compiler_version)" "$why" ;;
    esac
}
