#!/usr/bin/env bash
# Counts the instructions of the parts of a step under valgrind and compares them with instructions.txt: more than 2 % up
# fails, more than 2 % down asks for a new count. Instructions are not time, but they do not depend on who else is at
# work on the machine.
#
#   instructions.sh          compares
#   instructions.sh bless    takes the counts seen
set -euo pipefail
cd "$(dirname "$0")"
command -v valgrind >/dev/null || { echo "instructions: skipped: needs valgrind (apt-get install valgrind)"; exit 0; }
unset RUSTFLAGS CARGO_ENCODED_RUSTFLAGS CARGO_BUILD_TARGET
cargo build --quiet --release -p hooke-benches --bin instructions
binary=${CARGO_TARGET_DIR:-../target}/release/instructions
compiler=$(rustc --version | cut -d' ' -f2)

count() {
    local said
    said=$(valgrind --tool=callgrind --callgrind-out-file=/dev/null --collect-atstart=no \
        --toggle-collect='*instructions*counted*' "$binary" "$1" "$2" 2>&1) || { echo "$said" >&2; return 1; }
    awk '/Collected *:/ { print $NF }' <<<"$said"
}

if [ "${1:-}" = bless ]; then
    sed -i -E "s/^rustc .*/rustc $compiler/" instructions.txt
fi
failed=0
mapfile -t lines < <(grep -E '^[a-z]+ +[a-z]+:' instructions.txt)
for line in "${lines[@]}"; do
    read -r part scene allowed <<<"$line"
    now=$(count "$part" "$scene")
    # A count of 0 means that the function was not found: a check of nothing.
    if [ "${now:-0}" = 0 ]; then
        echo "instructions: $part $scene: nothing was counted"
        exit 1
    elif [ "${1:-}" = bless ]; then
        sed -i -E "s/^($part +$scene +)[0-9]+/\1$now/" instructions.txt
    elif [ $((now * 100)) -gt $((allowed * 102)) ]; then
        echo "instructions: $part $scene: $now, it was $allowed"
        failed=1
    elif [ $((now * 100)) -lt $((allowed * 98)) ]; then
        echo "instructions: $part $scene: $now, it was $allowed: take the new count (instructions.sh bless)"
    fi
    printf '%-15s %-14s %12s\n' "$part" "$scene" "$now"
done
counted_with=$(awk '$1 == "rustc" { print $2 }' instructions.txt)
if [ "$failed" = 1 ] && [ "$compiler" != "$counted_with" ]; then
    echo "instructions: the counts are those of rustc $counted_with; not enforced under $compiler"
    exit 0
fi
exit "$failed"
