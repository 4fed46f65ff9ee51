#!/usr/bin/env bash
# fuzz/run.sh [SECONDS] [TARGET…]: every target for so many seconds (600), one after the other, and a table of what came out.
# Installs cargo-fuzz and a nightly compiler where they are absent. What fuzzing adds to a corpus stays outside of the
# checked-in one; fuzz/select.sh takes the best of it over. A finding lies in fuzz/artifacts and ends its target's run.
set -euo pipefail
cd "$(dirname "$0")"
seconds=${1:-600}
shift || true
targets=("$@")
export CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-$PWD/target}
grown=$CARGO_TARGET_DIR/corpus
logs=$CARGO_TARGET_DIR/logs

command -v cargo-fuzz >/dev/null || cargo install --locked cargo-fuzz
cargo +nightly --version >/dev/null 2>&1 || rustup toolchain install nightly --profile minimal
[ ${#targets[@]} -gt 0 ] || mapfile -t targets < <(cargo +nightly fuzz list)
cargo +nightly fuzz build 2>/dev/null || cargo +nightly fuzz build # once more for its messages
mkdir -p "$logs"

# The number behind the last "NAME " or "NAME: " in a log.
number() { grep -oE "$1:? +[0-9]+" "$2" | tail -1 | grep -oE '[0-9]+$' || echo 0; }

printf '| target | seconds | executions | per second | edges | features | corpus | findings |\n'
printf '| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n'
failed=0
for target in "${targets[@]}"; do
    mkdir -p "$grown/$target" "artifacts/$target"
    rm -f "artifacts/$target"/*
    log=$logs/$target.log
    # Memory: no input of a thousand bytes needs so much, unless a count in a header is believed.
    cargo +nightly fuzz run "$target" "$grown/$target" "corpus/$target" -- -max_total_time="$seconds" -timeout=10 \
        -rss_limit_mb=2048 -max_len=1024 -print_final_stats=1 >"$log" 2>&1 || true
    ran=$(sed -nE 's/^Done [0-9]+ runs in ([0-9]+) second.*/\1/p' "$log" | tail -1)
    findings=$(find "artifacts/$target" -type f | wc -l)
    [ "$findings" = 0 ] || failed=1
    # A run that neither ended nor found anything did not run.
    [ -n "$ran" ] || [ "$findings" != 0 ] || { tail -20 "$log" >&2; failed=1; }
    printf '| %s | %s | %s | %s | %s | %s | %s | %s |\n' "$target" "${ran:-–}" \
        "$(number stat::number_of_executed_units "$log")" "$(number stat::average_exec_per_sec "$log")" \
        "$(number cov "$log")" "$(number ft "$log")" "$(find "$grown/$target" -type f | wc -l)" "$findings"
done
exit $failed
