#!/usr/bin/env bash
# Links every public function of the kernel without std and without an allocator, at three optimisation levels, and asks
# the linker whether a panic is reachable. Then does the same with one entry point that can panic, alone, which must be
# caught (one among all the others: tests/sabotage). Fails too if core has a public function that no wrapper here calls.
set -euo pipefail
cd "$(dirname "$0")"
target=${CARGO_TARGET_DIR:-../../target/bare}
nm=$(command -v llvm-nm-22 || command -v llvm-nm || command -v nm)
source ./entries.sh

symbols() { # profile, features
    cargo rustc --quiet --profile "$1" --features "$2" --target-dir "$target" --lib
    local dir=$1
    # Old readers complain about members of compiler-builtins that they do not know; the entry points are counted below.
    "$nm" "$target/$dir/libhooke_bare.a" 2>/dev/null || true
}

# The functions that call something of core::panicking, by their relocations.
culprits() {
    local objdump
    objdump=$(command -v llvm-objdump-22 || command -v llvm-objdump || command -v objdump)
    "$objdump" -drC "$target/$1/libhooke_bare.a" 2>/dev/null |
        awk '/^[0-9a-f]+ <.*>:$/ { f = $2 } /R_.*panicking/ && f !~ /panicking/ { gsub(/^<|>:$/, "", f); print f }' |
        sed -E 's/::h[0-9a-f]{16}$//' | sort -u | tr '\n' ' '
}

# How many wrappers the sources have, in both precisions.
written=$((2 * $(cat src/entries/*.rs | grep -cE '^    [A-Za-z0-9]+::[a-z0-9_]+.*\(')))
for profile in s o2 release; do
    all=$(symbols "$profile" "")
    entries=$(grep -cE ' T f(32|64)::' <<<"$all" || true)
    [ "$entries" = "$written" ] ||
        { echo "bare: $entries of $written entry points linked at $profile: the check would prove nothing"; exit 1; }
    forgotten "$all"
    if grep -q hooke_panicked <<<"$all"; then
        echo "bare: a panic is reachable at $profile, from $(culprits "$profile")"
        exit 1
    fi
    if ! grep -q hooke_panicked <<<"$(symbols "$profile" sabotage)"; then
        echo "bare: the sabotaged entry point was not caught at $profile: the check is blind"
        exit 1
    fi
    echo "bare: $entries entry points, no std, no alloc, no panic at $profile; sabotage caught"
done
echo "bare: they cover all $(functions | wc -l) public functions of core but $(exceptions | wc -l)"
