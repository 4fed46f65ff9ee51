#!/usr/bin/env bash
# fuzz/run.sh [SECONDS] [TARGET…]: every target for so many seconds of a processor (600), one after the other, and a table of what all
# runs came to (fuzz/table.sh). Of a processor and not of the clock: on a machine that is shared the clock says little. Installs
# cargo-fuzz and a nightly compiler where they are absent. What fuzzing adds to a corpus stays outside of the checked-in one;
# fuzz/select.sh takes the best of it over. A finding lies in fuzz/artifacts and ends its target's run; the exit code then is 1.
set -euo pipefail
cd "$(dirname "$0")"
seconds=${1:-600}
shift || true
targets=("$@")
export CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-$PWD/target}
logs=$CARGO_TARGET_DIR/logs

command -v cargo-fuzz >/dev/null || cargo install --locked cargo-fuzz
cargo +nightly --version >/dev/null 2>&1 || rustup toolchain install nightly --profile minimal
[ ${#targets[@]} -gt 0 ] || mapfile -t targets < <(cargo +nightly fuzz list)
cargo +nightly fuzz build
built=$CARGO_TARGET_DIR/$(rustc -vV | sed -n 's/^host: //p')/release
mkdir -p "$logs"

TIMEFORMAT='processor: %U s'
failed=0
for target in "${targets[@]}"; do
    grown=$CARGO_TARGET_DIR/corpus/$target
    mkdir -p "$grown" "artifacts/$target"
    left=$seconds
    # libFuzzer counts seconds of the clock: it runs again for what a processor still owes.
    while [ "$left" -gt 0 ]; do
        log=$logs/$target.$(find "$logs" -name "$target.*.log" | wc -l).log
        # An input's time is of the clock too: ten seconds of a processor can take a hundred on a machine that is full.
        # Memory: no input of a thousand bytes needs so much, unless a count in a header is believed.
        { time "$built/$target" "$grown" "corpus/$target" -artifact_prefix="artifacts/$target/" -max_total_time="$left" \
            -timeout=100 -rss_limit_mb=2048 -max_len=1024 -print_final_stats=1 >"$log" 2>&1; } 2>>"$log" ||
            { tail -20 "$log" >&2; failed=1; break; }
        left=$(awk -v left="$left" '/^processor: / { print int(left - $2 + 0.999) }' "$log")
    done
done
./table.sh
exit $failed
