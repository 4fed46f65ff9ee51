#!/usr/bin/env bash
# The C interface: header current, no reachable panic, every bad input, and the same bits from C on this machine, from C
# on a Cortex-M4F under QEMU, and from the kernel itself. What needs a tool that is not here is skipped and says so.
set -euo pipefail
cd "$(dirname "$0")/.."
target=${CARGO_TARGET_DIR:-../../target}/c
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
has() { command -v "$1" >/dev/null; }

cargo fmt -- --check
./header.sh --check
cargo clippy --quiet --profile small --target-dir "$target" -- -D warnings

# Panics: what is left of the panic handler after linking. The sabotaged library must be caught.
nm=$(command -v llvm-nm-22 || command -v llvm-nm || command -v nm)
panics() { # profile, feature
    cargo rustc --quiet --lib --profile "$1" --features "$2" --target-dir "$target/prove"
    # Old readers complain about members of compiler-builtins that they do not know; the functions are counted below.
    "$nm" "$target/prove/$1/libhooke_c.a" 2>/dev/null >"$work/symbols" || true
    functions=$(grep -cE ' T hooke_(f32|f64|message)' "$work/symbols" || true)
    grep -q hooke_panicked "$work/symbols"
}
declared=$(grep -cE '^[a-z].*\bhooke_(f32|f64|message)\w*\(' include/hooke.h)
for profile in small release; do
    if panics $profile prove; then echo "c: a panic is reachable at $profile"; exit 1; fi
    [ "$functions" = "$declared" ] || { echo "c: $functions of $declared functions: this proves nothing"; exit 1; }
    panics $profile sabotage || { echo "c: the sabotaged function was not caught at $profile"; exit 1; }
    echo "c: $functions functions, no std, no alloc, no panic at $profile; sabotage caught"
done

# Each C file is written for float; in double it is the same text.
for file in examples/rope.c tests/errors.c; do
    name=$(basename "$file" .c)
    cp "$file" "$work/${name}_f32.c"
    sed 's/f32/@/g; s/f64/f32/g; s/@/f64/g; /#include/!s/\bfloat\b/double/g; s/FLT_/DBL_/g' "$file" \
        >"$work/${name}_f64.c"
done
flags=(-std=c99 -Wall -Wextra -Werror -pedantic -ffp-contract=off -O2 -Iinclude)

# Unlike the libraries with overflow checks and assertions: the bits do not depend on that either.
cargo run --quiet --target-dir "$target" --example rope >"$work/rust"
same="Rust"
if has gcc; then
    cargo build --quiet --release --lib --target-dir "$target"
    for name in rope errors; do
        for t in f32 f64; do
            gcc "${flags[@]}" "$work/${name}_$t.c" "$target/release/libhooke_c.a" -o "$work/${name}_$t"
            "$work/${name}_$t" >>"$work/host"
            ! has valgrind || valgrind --quiet --error-exitcode=9 --leak-check=full "$work/${name}_$t" >/dev/null
        done
    done
    ! has g++ || g++ -std=c++11 -Wall -Wextra -Werror -pedantic -fsyntax-only -x c++ include/hooke.h
    diff "$work/rust" <(grep digest "$work/host") || { echo "c: C and Rust give different bits"; exit 1; }
    same="$same = C here"
    grep -h errors: "$work/host"
    has valgrind && echo "c: valgrind sees no access out of place" || echo "c: skipped: valgrind"
else
    echo "c: skipped: programs for this machine need gcc"
fi

board=thumbv7em-none-eabihf
if ! has arm-none-eabi-gcc || ! has qemu-system-arm; then
    echo "c: skipped: Cortex-M4F needs gcc-arm-none-eabi, libnewlib-arm-none-eabi and qemu-system-arm"
elif ! rustup target list --installed 2>/dev/null | grep -qx $board &&
    ! timeout 60 rustup target add $board >/dev/null 2>&1; then
    echo "c: skipped: Cortex-M4F needs 'rustup target add $board'"
else
    cargo build --quiet --profile small --lib --target $board --target-dir "$target"
    arm=(-mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16 -ffunction-sections -fdata-sections)
    for name in rope errors; do
        for t in f32 f64; do
            arm-none-eabi-gcc "${flags[@]}" "${arm[@]}" --specs=rdimon.specs -nostartfiles -Wl,--gc-sections \
                -Wl,-z,noexecstack -Wl,-Map="$work/${name}_$t.map" -T tests/mps2/link.ld tests/mps2/start.c "$work/${name}_$t.c" \
                "$target/$board/small/libhooke_c.a" -o "$work/${name}_$t.elf"
            timeout 120 qemu-system-arm -M mps2-an386 -cpu cortex-m4 -nographic -semihosting \
                -kernel "$work/${name}_$t.elf" >>"$work/arm" ||
                { tail -5 "$work/arm"; echo "c: $name $t fails on the Cortex-M4F"; exit 1; }
        done
    done
    diff "$work/rust" <(grep digest "$work/arm") || { echo "c: the Cortex-M4F gives different bits"; exit 1; }
    same="$same = C on the Cortex-M4F"
    grep -h errors: "$work/arm"
    if arm-none-eabi-nm "$work"/*.elf | grep -E 'panicking|begin_unwind'; then echo "c: panics in the image"; exit 1; fi
    for t in f32 f64; do
        # What the linker took from the library, constants included; soft floats and memcpy are not its own.
        bytes=0
        placed='\.(text|rodata)\S* +0x[0-9a-f]+ +0x[0-9a-f]+ \S*libhooke_c\.a\(hooke_c-'
        for part in $(tr '\n' ' ' <"$work/rope_$t.map" | grep -oE "$placed" | awk '$2 !~ /^0x0+$/ {print $3}'); do
            bytes=$((bytes + part))
        done
        echo "c: rope $t on the Cortex-M4F: $bytes bytes of code and constants from the library"
    done
fi
sed "s/^/c: $same: /" "$work/rust"
