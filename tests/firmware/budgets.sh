# What the minimal program and a step may cost. Sourced by check.sh.

# What was seen of a target: flash, RAM, stack, thousands of instructions of a step of the rope.
seen() {
    local dir=$out/$1
    echo "$(bytes "$dir/minimal" '.vector_table .init .text .rodata .data')" "$(bytes "$dir/minimal" '.data .bss')" \
        "$(awk '$1 == "rope40" { print $11, ($3 == 0 ? "-" : int(($3 + 999) / 1000)) }' "$dir/measured")"
}

# Compares what was seen of the named targets with budgets.txt; fails when something has grown by more than 2 %. Under
# another compiler than the budgets' own it only tells.
budgets() {
    local name columns=(flash RAM stack kinstr) over=0 i
    local compiler
    compiler=$(awk '$1 == "rustc" { print $2 }' budgets.txt)
    for name in "$@"; do
        [ -f "$out/$name/measured" ] || continue
        local line now=() allowed=()
        line=$(grep -E "^$name " budgets.txt) || { echo "firmware: $name has no line in budgets.txt: $(seen "$name")"; over=1; continue; }
        read -r -a now <<<"$(seen "$name")"
        read -r -a allowed <<<"${line#"$name"}"
        for i in "${!columns[@]}"; do
            [ "${allowed[i]}" != - ] && [ "${now[i]}" != - ] || continue
            if [ $((now[i] * 100)) -gt $((allowed[i] * 102)) ]; then
                echo "firmware: $name: ${columns[i]} is ${now[i]}, budget ${allowed[i]}"
                over=1
            elif [ $((now[i] * 100)) -lt $((allowed[i] * 98)) ]; then
                echo "firmware: $name: ${columns[i]} is ${now[i]}: lower its budget of ${allowed[i]}"
            fi
        done
    done
    if [ "$over" = 1 ] && [ "$(rustc --version | cut -d' ' -f2)" != "$compiler" ]; then
        echo "firmware: the budgets are those of rustc $compiler; not enforced under another"
        return 0
    fi
    return "$over"
}
