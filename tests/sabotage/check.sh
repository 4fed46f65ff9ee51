#!/usr/bin/env bash
# The checks, checked: four patches that break a promise are each applied to a copy of the kernel, and the check that
# guards the promise must fail there and name the culprit.
#
#   index       an index that can panic            → tests/bare: a panic is reachable, from the function that has it
#   fused       a fused multiply-add in a dot      → golden bits: which job differs, at which step
#   reordered   a sum in another order             → golden bits
#   maximum     a float max where a select was     → clippy, by the kernel's own list of what changes bits
set -euo pipefail
cd "$(dirname "$0")"
root=$(cd ../.. && pwd)
target=${CARGO_TARGET_DIR:-$root/target}/sabotage
mkdir -p "$target"
copy=$(mktemp -d "$target/copy.XXXXXX")
trap 'rm -rf "$copy"' EXIT
export CARGO_TERM_COLOR=never
unset RUSTFLAGS

bits() {
    (cd tests/firmware && cargo build --quiet --release -p firmware-host --target-dir "$target/firmware" &&
        "$target/firmware/release/firmware-host" run | "$target/firmware/release/firmware-host" compare host golden.txt)
}
bare() { CARGO_TARGET_DIR=$target/bare tests/bare/check.sh; }
lint() { cargo clippy --quiet -p hooke --target-dir "$target/lint" -- -D warnings; }

# Applies a patch to a fresh copy, runs a check in it, and wants it to fail with words that name the culprit.
sabotage() { # patch, check, words
    rm -rf "$copy/tree" && mkdir "$copy/tree"
    (cd "$root" && git ls-files -z | xargs -0 cp --parents -t "$copy/tree")
    (cd "$copy/tree" && patch --quiet -p1 <"$root/tests/sabotage/$1.patch")
    local said
    if said=$(cd "$copy/tree" && "$2" 2>&1); then
        echo "sabotage: '$1' was not caught"
        return 1
    fi
    local line
    line=$(grep -m1 -E "$3" <<<"$said") || { echo "sabotage: '$1' failed, but not for its reason:"; tail -n 5 <<<"$said"; return 1; }
    echo "sabotage: '$1' caught: ${line#"${line%%[![:space:]]*}"}"
}

sabotage index bare 'panic is reachable.*kinetic_energy_of'
sabotage fused bits 'differs at step'
sabotage reordered bits 'differs at step'
sabotage maximum lint 'f(32|64)::max'
