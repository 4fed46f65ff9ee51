#!/usr/bin/env bash
# fuzz/select.sh [MOST] [TARGET…]: of what fuzzing found (fuzz/run.sh) and of the checked-in corpus, the inputs of at most 400
# bytes that cover most, up to MOST (20) a target, into fuzz/corpus, named by their content. Seeds with a name of their own stay.
set -euo pipefail
cd "$(dirname "$0")"
most=${1:-20}
shift || true
targets=("$@")
export CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-$PWD/target}
[ ${#targets[@]} -gt 0 ] || mapfile -t targets < <(cargo +nightly fuzz list)
built=$CARGO_TARGET_DIR/$(rustc -vV | sed -n 's/^host: //p')/release

# Greedy set cover over the features that libFuzzer wrote down for each file: which files, in their order of gain.
greedy() { # control file, how many
    awk -v most="$2" '
        NR == 1 { files = $1; next }
        NR == 2 { next }
        NR <= files + 2 { name[NR - 3] = $0; next }
        $1 == "FT" { for (k = 3; k <= NF; k++) has[$2] = has[$2] " " $k }
        END {
            for (n = 0; n < most; n++) {
                best = -1; most_new = 0
                for (i in has) {
                    count = split(has[i], list, " "); new = 0
                    for (k = 1; k <= count; k++) new += !(list[k] in seen)
                    if (new > most_new || (new == most_new && new > 0 && i + 0 < best + 0)) { best = i; most_new = new }
                }
                if (most_new == 0) exit
                count = split(has[best], list, " ")
                for (k = 1; k <= count; k++) seen[list[k]] = 1
                delete has[best]
                print name[best]
            }
        }' "$1"
}

work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
for target in "${targets[@]}"; do
    mkdir -p "$work/$target/all" "$work/$target/out"
    # Of what was grown 400 inputs: names are hashes, so that every k-th is a sample.
    find "$CARGO_TARGET_DIR/corpus/$target" -type f -size -401c | sort >"$work/grown"
    awk -v every="$(($(wc -l <"$work/grown") / 400 + 1))" 'NR % every == 0' "$work/grown" |
        xargs -r cp -t "$work/$target/all"
    find "corpus/$target" -type f -size -401c -exec cp -t "$work/$target/all" {} +
    "$built/$target" -set_cover_merge=1 -merge_control_file="$work/$target/control" "$work/$target/out" \
        "$work/$target/all" >"$work/log" 2>&1 ||
        { tail -20 "$work/log"; exit 1; }
    find "corpus/$target" -type f -regextype posix-extended -regex '.*/[0-9a-f]{40}' -delete
    greedy "$work/$target/control" "$most" | while read -r file; do
        sum=$(sha1sum <"$file" | cut -c1-40)
        # Not a seed that is there under its own name.
        grep -q "$sum" < <(sha1sum "corpus/$target"/* | cut -c1-40) || cp "$file" "corpus/$target/$sum"
    done
    echo "$target: $(find "corpus/$target" -type f | wc -l) files, $(du -cb "corpus/$target"/* | tail -1 | cut -f1) bytes"
done
