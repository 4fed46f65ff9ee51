# shellcheck shell=bash
# The C programs on a Cortex-M4F under QEMU. Sourced by check.sh.

board=thumbv7em-none-eabihf

board_can_run() {
    if ! has arm-none-eabi-gcc || ! has qemu-system-arm; then
        skipped "C on a Cortex-M4F" "gcc-arm-none-eabi, libnewlib-arm-none-eabi and qemu-system-arm"
        return 1
    fi
    # Rust for it comes from rustup, else from Debian, as for the firmware.
    if ! (compiler_for $board); then
        skipped "C on a Cortex-M4F" "'rustup target add $board'"
        return 1
    fi
}

run_on_board() {
    local name t compile=()
    compiler_for $board
    "${compile[@]}" build --quiet --profile small --lib --target $board --target-dir "$target"
    for name in "${programs[@]}"; do
        for t in f32 f64; do
            arm-none-eabi-gcc "${flags[@]}" -mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16 \
                -ffunction-sections -fdata-sections --specs=rdimon.specs -nostartfiles -Wl,--gc-sections \
                -Wl,-z,noexecstack -Wl,-Map="$work/${name}_$t.map" -T tests/mps2/link.ld tests/mps2/start.c \
                "$work/${name}_$t.c" "$target/$board/small/libhooke_c.a" -o "$work/${name}_$t.elf"
            timeout 120 qemu-system-arm -M mps2-an386 -cpu cortex-m4 -nographic -semihosting \
                -kernel "$work/${name}_$t.elf" >>"$work/board" ||
                { tail -5 "$work/board"; echo "c: $name $t fails on the Cortex-M4F"; exit 1; }
        done
    done
    if arm-none-eabi-nm "$work"/*.elf | grep -E 'panicking|begin_unwind'; then echo "c: panics in the image"; exit 1; fi
}

# What the linker took from the library, constants included; soft floats and memcpy are not its own.
size_on_board() { # program, precision
    local part bytes=0
    local placed='\.(text|rodata)\S* +0x[0-9a-f]+ +0x[0-9a-f]+ \S*libhooke_c\.a\(hooke_c-'
    for part in $(tr '\n' ' ' <"$work/$1_$2.map" | grep -oE "$placed" | awk '$2 !~ /^0x0+$/ {print $3}'); do
        bytes=$((bytes + part))
    done
    [ $bytes -gt 0 ] || { echo "c: nothing of the library in $1 $2: this counts nothing"; exit 1; }
    echo "c: $1 $2 on the Cortex-M4F: $bytes bytes of code and constants from the library"
}
