#!/usr/bin/env bash
# The kernel's examples for firmware, on a Cortex-M4F under QEMU: they must print what they print here, digit for digit.
set -euo pipefail
cd "$(dirname "$0")"
examples=(fixed_rate sensor_pin haptic)
export CARGO_TERM_COLOR=never
here=$(mktemp -d)
trap 'rm -r "$here"' EXIT
for example in "${examples[@]}"; do
    cargo run --quiet -p hooke --manifest-path ../../Cargo.toml --example "$example" >"$here/$example"
done

export CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-$PWD/../../target/firmware}
export out=$CARGO_TARGET_DIR/examples
source ./install.sh
source ./run.sh
programs() { echo "${examples[@]}"; }
install_tools
build_target m4f
for example in "${examples[@]}"; do
    emulate m4f "$example" | diff "$here/$example" - || { echo "examples: $example differs on the board (here: <)"; exit 1; }
done
echo "examples: ${examples[*]} print on a Cortex-M4F what they print here"
