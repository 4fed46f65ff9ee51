#!/usr/bin/env bash
# The C interface: header current, no reachable panic, every bad input; from C on this machine and on a Cortex-M4F under
# QEMU the golden bits of tests/firmware, and in a rope that uses more of the interface the bits of Rust. Installs what is
# absent; what cannot be had here is skipped and says so, and with CI=true that fails.
set -euo pipefail
cd "$(dirname "$0")/.."
source ./tools.sh
source ./tests/panics.sh
source ./tests/board.sh
source ../../tests/firmware/install.sh # compiler_for
target=$(realpath -m "${CARGO_TARGET_DIR:-../../target}")/c
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
install_packages gcc:gcc gcc:libc6-dev g++:g++ valgrind:valgrind qemu-system-arm:qemu-system-arm \
    arm-none-eabi-gcc:gcc-arm-none-eabi arm-none-eabi-gcc:libnewlib-arm-none-eabi

cargo fmt -- --check
./header.sh --check
cargo clippy --quiet --profile small --target-dir "$target" -- -D warnings
no_panic small
no_panic release

# Each C file is written for float; in double it is the same text.
programs=(rope errors golden)
for file in examples/rope.c tests/errors.c tests/golden.c; do
    name=$(basename "$file" .c)
    cp "$file" "$work/${name}_f32.c"
    sed 's/f32/@/g; s/f64/f32/g; s/@/f64/g; /#include/!s/\bfloat\b/double/g; s/FLT_/DBL_/g' "$file" \
        >"$work/${name}_f64.c"
done
flags=(-std=c99 -Wall -Wextra -Werror -pedantic -ffp-contract=off -O2 -Iinclude)

# What they must print: of golden.c the firmware's golden file, of rope.c what Rust computes (with overflow checks and
# assertions, unlike the libraries: the bits do not depend on that either).
sed -n '/^job rope f32$/,/^end/p; /^job rope f64$/,/^end/p' ../../tests/firmware/golden.txt >"$work/golden"
[ "$(grep -c '^end' "$work/golden")" = 2 ] || { echo "c: golden.txt has no job rope: this proves nothing"; exit 1; }
cargo run --quiet --target-dir "$target" --example rope >"$work/rust"
same_bits() { # output of all programs, where
    diff "$work/golden" <(sed -n '/^job/,/^end/p' "$1") || { echo "c: $2: not the golden bits (expected: <)"; exit 1; }
    diff "$work/rust" <(grep digest "$1") || { echo "c: $2: not the bits of Rust (expected: <)"; exit 1; }
    sed -n "s/^errors/c: $2: errors/p; s/^end/c: $2: golden:/p; s/^digest/c: $2: as in Rust:/p" "$1"
}

if has gcc; then
    cargo build --quiet --release --lib --target-dir "$target"
    for name in "${programs[@]}"; do
        for t in f32 f64; do
            gcc "${flags[@]}" "$work/${name}_$t.c" "$target/release/libhooke_c.a" -o "$work/${name}_$t"
            "$work/${name}_$t" >>"$work/host" || { tail -5 "$work/host"; echo "c: $name $t fails here"; exit 1; }
            ! has valgrind || valgrind --quiet --error-exitcode=9 --leak-check=full "$work/${name}_$t" >/dev/null
        done
    done
    same_bits "$work/host" "C here"
    if has valgrind; then echo "c: valgrind sees no access out of place"; else skipped "the memory check" valgrind; fi
else
    skipped "C on this machine" gcc
fi
if has g++; then
    g++ -std=c++11 -Wall -Wextra -Werror -pedantic -fsyntax-only -x c++ include/hooke.h
else
    skipped "the header in C++" g++
fi
if board_can_run; then
    run_on_board
    same_bits "$work/board" "C on a Cortex-M4F"
    size_on_board rope f32
    size_on_board rope f64
fi
