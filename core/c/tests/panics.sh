# shellcheck shell=bash
# No function of the library can panic: nothing is left of its panic handler after linking. A function that can is added,
# and must be caught. Sourced by check.sh.

nm=$(command -v llvm-nm-22 || command -v llvm-nm || command -v nm)

panic_is_reachable() { # profile, feature
    cargo rustc --quiet --lib --profile "$1" --features "$2" --target-dir "$target/prove"
    # Old readers complain about members of compiler-builtins that they do not know; the functions are counted below.
    "$nm" "$target/prove/$1/libhooke_c.a" 2>/dev/null >"$work/symbols" || true
    functions=$(grep -cE ' T hooke_(f32|f64|message)' "$work/symbols" || true)
    grep -q hooke_panicked "$work/symbols"
}

no_panic() { # profile
    local functions declared
    declared=$(grep -cE '^[a-z].*\bhooke_(f32|f64|message)\w*\(' include/hooke.h)
    if panic_is_reachable "$1" prove; then echo "c: a panic is reachable at $1"; exit 1; fi
    [ "$functions" = "$declared" ] || { echo "c: $functions of $declared functions: this proves nothing"; exit 1; }
    panic_is_reachable "$1" sabotage || { echo "c: the sabotaged function was not caught at $1"; exit 1; }
    echo "c: $functions functions, no std, no alloc, no panic at $1; sabotage caught"
}
