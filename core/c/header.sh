#!/usr/bin/env bash
# Writes src/double.rs from src/single.rs and include/hooke.h from both; with --check compares instead. The header needs
# cbindgen, which is installed into the target folder where it is absent.
set -euo pipefail
cd "$(dirname "$0")"
source ./tools.sh
new=$(mktemp -d)
trap 'rm -r "$new"' EXIT

sed -e '1,3s/ in single precision; `double.rs` is this file with another precision, written by `header.sh`/ in double precision: `header.sh` writes this file from `single.rs`, which is the one to change/' \
    -e 's/in single precision/in double precision/; s/f32/f64/g' src/single.rs >"$new/double.rs"
settle() { # made, kept
    if [ "${check:-}" ]; then
        cmp -s "$1" "$2" || { echo "c: $2 is not what header.sh writes: run core/c/header.sh"; exit 1; }
    elif ! cmp -s "$1" "$2"; then
        cp "$1" "$2"
    fi
}
[ "${1:-}" != --check ] || check=1
settle "$new/double.rs" src/double.rs

if ! cbindgen_here; then
    skipped "the header needs cbindgen"
    exit
fi
cbindgen --quiet --config cbindgen.toml --output "$new/hooke.h" .
# cbindgen names the instances of generic structs itself: give them the names that their aliases have.
sed -E -i -e '/^typedef struct (Options|Report|Motion|Energies)_f(32|64) hooke_/d' \
    -e 's/\b(Options|Report|Motion|Energies)_(f32|f64)\b/hooke_\2_\L\1/g' "$new/hooke.h"
settle "$new/hooke.h" include/hooke.h
[ -z "${check:-}" ] || echo "c: header and double.rs are those of single.rs"
