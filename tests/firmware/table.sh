# shellcheck shell=bash
# The table of what was seen. Sourced by check.sh.

# Jobs of which all bits agree; flash and RAM of the minimal program; of one step of the rope and of the cloth
# instructions, iterations, and what the stack was painted over, with the bound.
table() {
    local name row
    printf '%-13s %4s %7s %6s | %-37s | %s\n' target jobs flash RAM 'rope40: step, its, painted and bound' 'cloth8x8: step, its'
    for name in "$@" ${variants[@]+"${variants[@]}"}; do
        row=$(printf '%-13s %4s' "$name" "$(awk '{ sum += $1 } END { print sum + 0 }' "$out/$name/jobs" 2>/dev/null || echo 0)")
        if [ -f "$out/$name/painted" ]; then
            row+=$(printf ' %7s %6s' "$(flash "$out/$name/minimal")" "$(ram "$out/$name/minimal")")
            row+=$(awk -v stack="$(cat "$out/$name/painted")" '{ n[$2] = $3 } END { split(stack, s, " ")
                printf " | %12s %5s %8s %8s | %10s %5s", n["rope40-step"], n["rope40-iterations"], s[1], s[2],
                    n["cloth8x8-step"], n["cloth8x8-iterations"] }' "$out/$name/measured")
        fi
        echo "$row"
    done
}
