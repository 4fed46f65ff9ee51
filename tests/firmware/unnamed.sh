# shellcheck shell=bash
# A feature that a program does not name costs it nothing: the minimal program is the same, byte for byte, when core has
# no trace of drag, spring damping, point forces, point springs, cables, snapshots, reactions, energies, momenta, the
# stiffness matrix, sleeping, the other integrators, the direct solvers, and SSOR and D-ILU; and the same functions without any solver but its own.
# Sourced by check.sh.

# Takes the features out of a copy of core's sources.
without_features() {
    local source=$1/core/src
    rm "$source"/{snapshot,reaction,energy,momentum,stiffness}.rs
    rm "$source"/force/{drag,damping,point_force,point_spring}.rs
    sed -i -E '/^(pub )?(mod|use) (snapshot|reaction|energy|momentum|stiffness)\b/d' "$source/lib.rs"
    sed -i -E 's/^(pub use force::).*$/\1{Force, Gravity};/' "$source/lib.rs"
    sed -i -E '/^(pub )?(mod|use) (drag|damping|point_force|point_spring)\b/d' "$source/force/mod.rs"
    rm "$source"/solver/{banded_ldl,chain,direct,elimination,elimination_tree,panel,pivot,precision,sparse_ldl,substitution,supernodes,update}.rs
    sed -i -E '/^(pub(\(crate\))? )?(mod|use) (banded_ldl|chain|direct|elimination|elimination_tree|panel|pivot|precision)\b/d' "$source/solver/mod.rs"
    sed -i -E '/^(pub )?(mod|use) (sparse_ldl|substitution|supernodes|update)\b/d' "$source/solver/mod.rs"
    rm "$source"/wide/{direct,last_rows,piece_rows,pieces}.rs
    sed -i -E '/^pub\(crate\) mod (direct|last_rows|piece_rows|pieces)\b/d' "$source/wide/mod.rs"
    rm "$source"/solver/{block_ilu,eisenstat,ssor,triangle}.rs
    sed -i -E '/^(pub )?(mod|use) (block_ilu|eisenstat|ssor|triangle)\b/d' "$source/solver/mod.rs"
    sed -i -E '/^pub use solver::\{BlockIlu/d' "$source/lib.rs"
    sed -i -E 's/^(pub use solver::).*$/\1{BlockJacobi, Jacobi, Multigrid, Preconditioner, Solver, Stop};/' "$source/lib.rs"
    rm "$source"/integrator/{adaptive,embedded,energy_momentum,explicit,limit,midpoint,newton,ros2,ros3,rosenbrock,stage,symplectic_euler,trial,verlet}.rs
    sed -i -E '/^(pub )?(mod|use) (adaptive|embedded|energy_momentum|explicit|limit|midpoint|newton|ros2|ros3|rosenbrock|stage|symplectic_euler|trial|verlet)\b/d' "$source/integrator/mod.rs"
    sed -i -E '/^pub use integrator::/d' "$source/lib.rs"
    echo 'pub use integrator::{Integrator, LinearizedOnce, LinearlyImplicitEuler, Stepper};' >>"$source/lib.rs"
    rm "$source"/sleeping/{asleep,pattern,rest}.rs
    sed -i -E '/^(pub )?(mod|use) (asleep|pattern|rest)\b/d' "$source/sleeping/mod.rs"
    sed -i -E 's/^(pub use sleeping::).*$/\1{Awake, Sleep};/' "$source/lib.rs"
    # Comments too: what they belong to is gone.
    sed -i -E '/^ *\/\/\//d; /^use crate::energy/d; /^    pub fn (springs|reaction)\b/,/^    }/d' "$source/scene.rs"
    sed -i -E '/^impl<M: Memory<Law = Mixed>>/,/^}/d; /^use crate::law::Mixed/d' "$source/edit.rs"
}

# Takes out the solvers for hosts as well. They hold code that is not generic; the linker drops it, but has it before it
# when it decides what to inline where, so the code of others can then differ by a few bytes either way (24 of 16,208 were seen,
# in `prepare` and `project`, which name no solver).
without_lanes() {
    local source=$1/core/src
    rm -r "$source"/{wide,solver/multigrid,solver/around.rs,solver/refinement.rs}
    sed -i -E '/^(pub(\(crate\))? )?(mod|use) (wide|multigrid|around|refinement)\b/d' "$source/lib.rs" "$source/solver/mod.rs"
    sed -i -E 's/^(pub use solver::).*$/\1{BlockJacobi, Jacobi, Preconditioner, Solver, Stop};/' "$source/lib.rs"
}

# The names of an image's functions and statics.
names() { nm "$1" | cut -c20- | sed -E 's/17h[0-9a-f]{16}E//' | sort -u; }

# The minimal program for the M4F over a copy of the sources.
minimal_of() {
    local compile=() copy=$1
    compiler_for thumbv7em-none-eabihf
    (cd "$copy/tests/firmware" && RUSTFLAGS="-L$PWD/boards/mps2 -Clink-arg=-Tlink.x -Awarnings --cap-lints=warn" "${compile[@]}" build \
        --quiet --profile image --target thumbv7em-none-eabihf -p firmware-image --bin minimal \
        --target-dir "$CARGO_TARGET_DIR/unnamed") || { echo "firmware: unnamed.sh does not know core as it is now"; return 1; }
    cp "$CARGO_TARGET_DIR/unnamed/thumbv7em-none-eabihf/image/minimal" "$2"
}

unnamed() {
    local copy=$out/copy
    mkdir -p "$copy/tests"
    cp ../../Cargo.toml "$copy/"
    cp -r ../../core "$copy/core"
    mkdir "$copy/tests/firmware"
    cp -r Cargo.toml Cargo.lock jobs host image wasm boards "$copy/tests/firmware/"
    # The jobs name every feature; the minimal program none of them.
    sed -i '/^firmware-jobs/d' "$copy/tests/firmware/image/Cargo.toml"
    sed -i '/^pub mod run;/d' "$copy/tests/firmware/image/src/lib.rs"
    minimal_of "$copy" "$out/minimal-with" || return 1
    without_features "$copy"
    minimal_of "$copy" "$out/minimal-without" || return 1
    cmp "$out/minimal-with" "$out/minimal-without" ||
        { echo "firmware: a feature that the minimal program does not name is in its image"; return 1; }
    echo "firmware: without the features that it does not name, the minimal program is the same, byte for byte"
    without_lanes "$copy"
    minimal_of "$copy" "$out/minimal-bare" || return 1
    local more
    more=$(($(bytes "$out/minimal-with" '.text .rodata .data .bss') - $(bytes "$out/minimal-bare" '.text .rodata .data .bss')))
    if ! diff <(names "$out/minimal-with") <(names "$out/minimal-bare") || [ "$more" -gt 32 ] || [ "$more" -lt -32 ]; then
        echo "firmware: a solver that the minimal program does not name is in its image ($more bytes)"
        return 1
    fi
    echo "firmware: without the solvers for hosts it has the same functions, and $more bytes less"
}
