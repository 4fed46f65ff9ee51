#!/usr/bin/env bash
# tests/sanitizers.sh [CHECK…]: memory errors and leaks, one line a check, exit code 1 if one finds anything. The kernel has no unsafe
# code and no allocator: what is looked at is the harness, what it depends on, and the C interface.
#
#   address    tests/exact and the replay of the fuzz corpora (with the C interface's own code) under the address sanitizer, which
#              also looks for leaks; nightly
#   memcheck   the release program and the C interface's test programs under valgrind
set -euo pipefail
cd "$(dirname "$0")/.."
target=$(realpath -m "${CARGO_TARGET_DIR:-target}")
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
failed=0
unset RUSTFLAGS

# A name, and a command: its output is shown only where it fails.
check() {
    local name=$1 before=$SECONDS
    shift
    if "$@" >"$work/said" 2>&1; then
        echo "sanitizers: $name: clean ($((SECONDS - before)) s)"
    else
        tail -n 40 "$work/said"
        echo "sanitizers: $name: FAILS"
        failed=1
    fi
}

address() {
    cargo +nightly --version >/dev/null 2>&1 || rustup toolchain install nightly --profile minimal
    export RUSTFLAGS=-Zsanitizer=address ASAN_OPTIONS=detect_leaks=1:detect_stack_use_after_return=1
    local host
    host=$(rustc -vV | sed -n 's/^host: //p')
    # A leak, made on purpose, must be seen: else this says nothing.
    mkdir -p "$work/control"
    echo 'fn main() { std::hint::black_box(Box::leak(Box::new([1u8; 99]))); }' >"$work/control/main.rs"
    rustc +nightly -Zsanitizer=address --target "$host" -o "$work/control/main" "$work/control/main.rs"
    check "a leak made on purpose is seen" bash -c "! '$work/control/main' && true"
    # One test overflows the stack of a child on purpose and looks for the words of a program without a sanitizer.
    for test in exact replay; do
        check "address and leaks: $test" cargo +nightly test --quiet --target-dir "$target/address" --target "$host" \
            -p hooke-tests --test "$test" -- --test-threads 1 --skip the_same_scene_built_by_value_overflows
    done
    unset RUSTFLAGS ASAN_OPTIONS
}

memcheck() {
    command -v valgrind >/dev/null || { apt-get update -qq && apt-get install -y -qq --no-install-recommends valgrind; } >/dev/null
    cargo build --quiet --release -p hooke-harness
    local see=(valgrind --quiet --error-exitcode=9 --leak-check=full --errors-for-leak-kinds=definite,possible)
    local run=("${see[@]}" "$target/release/hooke" run --quiet --steps 5 --final "$work/end.csv")
    for solver in jacobi wide wide32 multigrid ssor ilu banded ldl ldl32 auto; do
        check "valgrind: cloth:16 by $solver" "${run[@]}" --solver "$solver" cloth:16
    done
    for method in midpoint ros3 newton energy-momentum symplectic-euler; do
        check "valgrind: cloth:16 by $method" "${run[@]}" --integrator "$method" --dt 0.0005 cloth:16
    done
    check "valgrind: lattice:6x6x6 in f32" "${run[@]}" --precision f32 --solver wide lattice:6x6x6
    check "valgrind: a scene with files" "${run[@]}" std-harness/examples/bridge.toml
    for mesh in medit/tetrahedron:mesh obj/quad_and_line:obj gmsh/binary_4:msh ply/edges_big_endian:ply stl/binary:stl vtk/grid:vtk \
        vtk_xml/grid:vtu vtk_xml/poly:vtp; do
        cp "fuzz/corpus/mesh_${mesh%:*}" "$work/mesh.${mesh#*:}"
        check "valgrind: info of ${mesh%:*}" "${see[@]}" "$target/release/hooke" info "$work/mesh.${mesh#*:}"
    done
    check "valgrind: the C interface" core/c/tests/check.sh
}

[ $# -gt 0 ] || set -- address memcheck
for part in "$@"; do "$part"; done
exit $failed
