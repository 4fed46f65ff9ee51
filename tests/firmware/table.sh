# The table of what was seen. Sourced by check.sh.

# Bytes of sections: file, names.
bytes() { size -A "$1" | awk -v names=" $2 " 'index(names, " " $1 " ") { sum += $2 } END { print sum + 0 }'; }

# What was seen. Flash and RAM are the minimal program's (a rope of 40 particles in f32); instructions and stack are of
# one step of that rope and of the 8×8 cloth.
table() {
    local name row measured
    printf '%-13s %5s %8s %7s | %-40s | %s\n' target jobs flash RAM 'rope40: step, its, per it., rest, stack' cloth8x8
    for name in "$@" ${variants[@]+"${variants[@]}"}; do
        row=$(printf '%-13s %5s' "$name" "$(awk '{ sum += $1 } END { print sum + 0 }' "$out/$name/jobs" 2>/dev/null || echo 0)")
        if [ -f "$out/$name/minimal" ]; then
            row+=$(printf ' %8s %7s' "$(bytes "$out/$name/minimal" '.vector_table .init .text .rodata .data')" \
                "$(bytes "$out/$name/minimal" '.data .bss')")
        fi
        if [ -f "$out/$name/measured" ]; then
            row+=$(awk '{ for (i = 1; i <= NF; i++) if ($i == 0) $i = "-"
                printf " | %8s %3s %7s %8s %6s", $3, $5, $7, $9, $11 }' "$out/$name/measured")
        fi
        echo "$row"
    done
}
