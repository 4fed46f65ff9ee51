#!/usr/bin/env bash
# tests/mutants.sh [WORD…]: mutants of core that cargo-mutants lists, judged by the tests: of all files, or of those whose path contains
# one of the words, without those with a `-` before it; and the page MUTANTS.md anew. What is judged stays judged until core
# changes, so that a run which is cut short goes on; where a test changes what lives is asked anew (remove target/mutants where a
# test was taken out). Installs cargo-mutants where it is absent. How: mutants/README.md.
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD
target=$(realpath -m "${CARGO_TARGET_DIR:-target}")/mutants
place=$target/place
tree=$target/tree
tool=$target/release/hooke-mutants
mkdir -p "$place"
unset RUSTFLAGS

command -v cargo-mutants >/dev/null || cargo install --locked cargo-mutants
cargo build --quiet --release --manifest-path tests/mutants/Cargo.toml --target-dir "$target"

sums() { git ls-files -z "$@" | xargs -0 sha256sum | sha256sum; }
core=$(sums core)
asked="$(sums tests/{exact,methods,oracle,properties,src} std-harness/src) $*"
if [ "$(cat "$place/core" 2>/dev/null)" != "$core" ]; then
    rm -rf "$place"
    mkdir -p "$place"
    cargo mutants --list --json -f 'core/src/**/*.rs' >"$place/list.json"
    echo "$core" >"$place/core"
fi

# The tree with the mutants in it. The replay of fuzz corpora and the programs are left out: they compile for long and judge little.
if [ "$(cat "$place/woven" 2>/dev/null)" != "$*" ]; then
    rm -rf "$tree" "$place/asked"
    mkdir -p "$tree"
    git ls-files -z | xargs -0 cp --parents -t "$tree"
    CARGO_TARGET_DIR=$target/woven "$tool" weave "$tree" "$place/list.json" "$place" "$@"
    echo "$*" >"$place/woven"
fi
if [ "$(cat "$place/asked" 2>/dev/null)" != "$asked" ]; then
    rm -rf "$tree"/{tests,std-harness} "$place/traces"
    git ls-files -z tests std-harness | xargs -0 cp --parents -t "$tree"
    rm -r "$tree/tests/src/bin"
    awk -v RS= -v ORS='\n\n' '!/replay/' tests/Cargo.toml | sed '/fuzz-bodies/d' >"$tree/tests/Cargo.toml"
    # Nothing of the workspace is optimized: with all mutants in it that takes too long.
    (cd "$tree" && RUSTFLAGS="--cap-lints warn" CARGO_PROFILE_DEV_DEBUG=false CARGO_PROFILE_DEV_OPT_LEVEL=0 CARGO_INCREMENTAL=0 \
        cargo test -p hooke-tests --no-run --target-dir "$target/woven" 2>&1) |
        tee "$place/build" | sed -n '/Executable [a-z]*\/main.rs/s/.*(\(.*\))$/\1/p' >"$place/binaries"
    [ -s "$place/binaries" ] || { tail -n 20 "$place/build" >&2; exit 1; }
    # What a test noticed stays noticed; what lives is asked anew.
    [ ! -f "$place/verdicts.tsv" ] || sed -i -n '/^[0-9]*\t\(caught\|timed out\)\t/p' "$place/verdicts.tsv"
    echo "$asked" >"$place/asked"
fi

# Frames that are not optimized, with all mutants in them, are large.
export RUST_MIN_STACK=100000000
# The quick tests first, which notice most. A test that never ends for a mutant may also eat all memory.
for seconds in 1 inf; do
    (cd "$tree/tests" && ulimit -v 8000000 && "$tool" judge "$place/list.json" "$place" "$seconds" "$@")
done
{
    sed '/^<!-- mutants -->$/q' tests/MUTANTS.md
    echo
    "$tool" page "$root" "$place/list.json" "$place" tests/mutants/reasons.txt
} >"$place/MUTANTS.md"
mv "$place/MUTANTS.md" tests/MUTANTS.md
