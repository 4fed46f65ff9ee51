#!/usr/bin/env bash
# fuzz/table.sh: what the runs of fuzz/run.sh came to, from their logs: seconds of the clock and of a processor, and executions, of all of
# them; edges and features covered by the best of them. `rm -r $CARGO_TARGET_DIR/logs` begins anew.
set -euo pipefail
cd "$(dirname "$0")"
target_dir=${CARGO_TARGET_DIR:-$PWD/target}
printf '| target | seconds | of a processor | executions | per second | edges | features | inputs kept | findings |\n'
printf '| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n'
for first in "$target_dir"/logs/*.0.log; do
    target=$(basename "$first" .0.log)
    # A run that found something has no "Done"; what it did is counted, its seconds of the clock stand as 0.
    cat "$target_dir/logs/$target".*.log | awk -v target="$target" '
        /^Done [0-9]+ runs in/ { seconds += $5 }
        /^processor: / { processor += $2 }
        /^stat::number_of_executed_units/ { runs += $2 }
        /^SUMMARY: libFuzzer/ { findings++ }
        / cov: / { for (i = 1; i < NF; i++) { if ($i == "cov:" && $(i + 1) > cov) cov = $(i + 1); if ($i == "ft:" && $(i + 1) > ft) ft = $(i + 1); if ($i == "corp:" && $(i + 1) + 0 > kept) kept = $(i + 1) + 0 } }
        END {
            printf "| `%s` | %d | %d | %d | %d | %d | %d | %d | %d |\n", target, seconds, processor, runs, (processor ? runs / processor : 0), cov, ft, kept, findings
        }'
done
