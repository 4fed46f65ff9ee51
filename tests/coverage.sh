#!/usr/bin/env bash
# tests/coverage.sh: which lines and branches of core/src the tests of hooke-tests and of core itself run, and the page COVERAGE.md
# anew. Installs a nightly compiler (stable counts no branches), its LLVM tools and cargo-llvm-cov where they are absent.
set -euo pipefail
cd "$(dirname "$0")/.."
target=$(realpath -m "${CARGO_TARGET_DIR:-target}")/coverage
cargo +nightly --version >/dev/null 2>&1 || rustup toolchain install nightly --profile minimal
rustup component list --toolchain nightly --installed | grep -q llvm-tools || rustup component add llvm-tools --toolchain nightly
command -v cargo-llvm-cov >/dev/null || cargo install --locked cargo-llvm-cov
mkdir -p "$target"
# Unoptimized: the quicker build outweighs the slower tests.
CARGO_TARGET_DIR=$target CARGO_PROFILE_DEV_OPT_LEVEL=0 cargo +nightly llvm-cov --branch --quiet -p hooke-tests -p hooke --lcov --output-path "$target/lcov" >"$target/log" 2>&1 ||
    { tail -n 20 "$target/log"; exit 1; }
{
    sed '/^<!-- coverage -->$/q' tests/COVERAGE.md
    echo
    tests/coverage.awk "$target/lcov"
} >"$target/COVERAGE.md"
mv "$target/COVERAGE.md" tests/COVERAGE.md
