#!/usr/bin/env bash
# Builds the firmware for every target, runs it under QEMU or node, and compares its bits with golden.txt; then the same
# on this machine at every optimisation level. Installs what is absent. Prints a table; fails with the target, job and
# step that differ.
#
#   check.sh                 all of it
#   check.sh m4f rv64gc      only these images (see targets.txt)
#   check.sh bless WHY       takes this machine's trace as golden, and logs why in golden.txt
#   check.sh lower           all of it; then lowers every budget that can be lower, and README.md's tables
#   check.sh raise WHY       all of it; then takes what was seen as budgets, logs why in budgets.txt, and the same
set -euo pipefail
cd "$(dirname "$0")"
export CARGO_TERM_COLOR=never CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-$PWD/../../target/firmware}
unset RUSTFLAGS CARGO_ENCODED_RUSTFLAGS CARGO_BUILD_TARGET
out=$CARGO_TARGET_DIR/check
judge=$CARGO_TARGET_DIR/release/firmware-host
source ./install.sh
source ./run.sh
source ./stack.sh
source ./table.sh
source ./budgets.sh
source ./unnamed.sh

# The logs only grow: every line that an earlier commit had must still be there, in order.
older_log() {
    local commit file=$1
    git rev-parse --git-dir >/dev/null 2>&1 || return 0
    for commit in $(git log --format=%h -n 3 -- "$file"); do
        local before now
        before=$(git show "$commit:./$file" 2>/dev/null | grep '^change ' || true)
        now=$(grep '^change ' "$file" 2>/dev/null | head -n "$(wc -l <<<"$before")" || true)
        [ -z "$before" ] || [ "$before" = "$now" ] ||
            { echo "firmware: the log of $file lost a line that $commit had"; exit 1; }
    done
}

cargo build --quiet --release -p firmware-host
if [ "${1:-}" = bless ]; then
    "$judge" bless golden.txt "${2:-}"
    exit
fi
"$judge" log golden.txt
older_log golden.txt
older_log budgets.txt
what=check why=
case ${1:-} in
    lower) what=lower && shift ;;
    raise) what=raise why=${2:?say in one line why budgets are raised} && shift 2 ;;
esac
cargo test --quiet --release -p firmware-host >/dev/null

rm -rf "$out" && mkdir -p "$out"
names=("$@")
[ $# -gt 0 ] || mapfile -t names < <(grep -v '^#' targets.txt | cut -d' ' -f1)
install_tools
# A target's programs run while the next one's are built.
for name in "${names[@]}"; do
    build_target "$name"
    case $name in microbit | wasm32) ;; *) build_entries "$name" ;; esac
    run_target "$name" >"$out/$name.log" 2>&1 &
    eval "job_$name=$!"
done
[ $# -gt 0 ] || host_variants
failed=0
unnamed || failed=1
for name in "${names[@]}"; do
    job="job_$name"
    wait "${!job}" || { failed=1; sed 's/^/firmware: /' "$out/$name.log"; }
done
table "${names[@]}"
[ "$failed" = 1 ] || budgets "$what" "$why" "${names[@]}" || failed=1
case $what in check) ./figures.sh --check || failed=1 ;; *) ./figures.sh ;; esac
[ "$failed" = 0 ] || { echo "firmware: FAILED"; exit 1; }
echo "firmware: the same bits on every target, in ${SECONDS} s"
