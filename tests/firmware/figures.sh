#!/usr/bin/env bash
# The tables of README.md's section on microcontrollers, from budgets.txt: written anew, or with --check compared.
set -euo pipefail
cd "$(dirname "$0")"
readme=../../README.md

# A budget: row, column.
budget() {
    awk -v row="$1" -v target="$2" '$1 == "kind" { for (i = 3; i <= NF; i++) if ($i == target) column = i }
        column && $1 " " $2 == row { print $column }' budgets.txt
}

# Thousands apart.
spaced() { sed -E ':a; s/^([0-9]+)([0-9]{3})/\1,\2/; ta' <<<"$1"; }

targets() {
    local names target
    read -r -a names <<<"$(sed -n 's/^kind *what *//p' budgets.txt)"
    echo '| target | flash, B | RAM, B | stack of a step, B | instructions of a step, rope | cloth 8×8 |'
    echo '| --- | --: | --: | --: | --: | --: |'
    for target in "${names[@]}"; do
        echo "| $target | $(spaced "$(budget 'flash minimal' "$target")") | $(spaced "$(budget 'RAM minimal' "$target")") |" \
            "$(spaced "$(budget 'stack f32::MassSpring::step[gravity]' "$target")") |" \
            "$(spaced "$(budget 'instructions rope40-step' "$target")") | $(spaced "$(budget 'instructions cloth8x8-step' "$target")") |"
    done
}

features() {
    local names feature
    mapfile -t names < <(awk '$1 == "flash" && $2 ~ /^[+]/ { print $2 }' budgets.txt)
    echo '| added on an M4F | flash, B | RAM, B |'
    echo '| --- | --: | --: |'
    for feature in "${names[@]}"; do
        echo "| $(tr _ ' ' <<<"${feature#+}") | $(spaced "$(budget "flash $feature" m4f)") | $(spaced "$(budget "RAM $feature" m4f)") |"
    done
}

text=$(
    awk '{ print } /^<!-- firmware:/ { exit }' "$readme"
    targets
    echo
    features
    awk '/^<!-- end of firmware/ { on = 1 } on' "$readme"
)
if [ "${1:-}" = --check ]; then
    [ "$text" = "$(cat "$readme")" ] || { echo "firmware: README.md is not what budgets.txt says: run tests/firmware/figures.sh"; exit 1; }
else
    echo "$text" >"$readme"
fi
