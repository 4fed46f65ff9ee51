//! The 8×8 cloth by each solver that is not the default, in a workspace of its own: every one has its golden bits.

use hooke::{
    BandedLdl, BlockIlu, Hookean, LinearlyImplicitEuler, MassSpring, Memory, Multigrid, Portable, Real,
    Scene, Single, SingleJacobi, Solver, SparseLdl, Ssor, WideJacobi,
};
use static_cell::ConstStaticCell;

use crate::job::Job;
use crate::outcome::{Outcome, expect};
use crate::scenes::{self, cloth_springs, dt, gravity};
use crate::trace::Trace;

const SIDE: usize = 8;
const PARTICLES: usize = SIDE * SIDE;
const SPRINGS: usize = cloth_springs(SIDE);
type Cloth<T> = Scene<T, PARTICLES, SPRINGS, Hookean>;

/// The farthest that a spring of the cloth reaches, and what that needs.
const BANDED: usize = BandedLdl::needs(PARTICLES, SIDE + 1);
const SSOR: usize = Ssor::needs(PARTICLES);
const ILU: usize = BlockIlu::needs(PARTICLES);
const GRID: (usize, usize) = Multigrid::needs(PARTICLES, SPRINGS);
/// Numbers and words of the others: more than they need.
const NUMBERS: usize = 12288;
const WORDS: usize = 4096;

/// A static list of zeros.
macro_rules! zeros {
    ($t:ty, $n:expr) => {{
        static LIST: ConstStaticCell<[$t; $n]> = ConstStaticCell::new([0 as $t; $n]);
        LIST.take().as_mut_slice()
    }};
}

macro_rules! job {
    ($job:ident, $t:ident, $name:literal, $solver:expr) => {
        #[doc = concat!("The solver ", $name, " in `", stringify!($t), "`.")]
        pub const $job: Job = {
            static SCENE: ConstStaticCell<Cloth<$t>> = ConstStaticCell::new(Scene::new());
            Job { name: $name, precision: stringify!($t), start: |trace| run(SCENE.take(), $solver, trace) }
        };
    };
}

job!(BANDED_F32, f32, "banded", BandedLdl::new(zeros!(f32, BANDED)));
job!(BANDED_F64, f64, "banded", BandedLdl::new(zeros!(f64, BANDED)));
job!(SPARSE_F32, f32, "sparse", SparseLdl::new(backwards(), zeros!(f32, NUMBERS), zeros!(u32, WORDS)));
job!(SPARSE_F64, f64, "sparse", SparseLdl::new(backwards(), zeros!(f64, NUMBERS), zeros!(u32, WORDS)));
job!(
    SINGLE_F32,
    f32,
    "single",
    SparseLdl::new(backwards(), Single(zeros!(f32, NUMBERS)), zeros!(u32, WORDS))
);
job!(
    SINGLE_F64,
    f64,
    "single",
    SparseLdl::new(backwards(), Single(zeros!(f32, NUMBERS)), zeros!(u32, WORDS))
);
job!(SSOR_F32, f32, "ssor", Ssor::new(zeros!(f32, SSOR)));
job!(SSOR_F64, f64, "ssor", Ssor::new(zeros!(f64, SSOR)));
job!(ILU_F32, f32, "ilu", BlockIlu::new(zeros!(f32, ILU)));
job!(ILU_F64, f64, "ilu", BlockIlu::new(zeros!(f64, ILU)));
job!(WIDE_F32, f32, "wide", WideJacobi::new(zeros!(f32, NUMBERS), zeros!(u32, WORDS), Portable));
job!(WIDE_F64, f64, "wide", WideJacobi::new(zeros!(f64, NUMBERS), zeros!(u32, WORDS), Portable));
job!(MULTIGRID_F32, f32, "multigrid", Multigrid::new(zeros!(f32, GRID.0), zeros!(u32, GRID.1), Portable));
job!(MULTIGRID_F64, f64, "multigrid", Multigrid::new(zeros!(f32, GRID.0), zeros!(u32, GRID.1), Portable));

/// A rope long enough for lanes, factored in pieces; and a net without few distances, whose rows lie in slots.
const ROPE: usize = 80;
const CHAIN: usize = 40 * ROPE;
const NET: usize = 64;

macro_rules! lanes {
    ($job:ident, $t:ident, $name:literal, $particles:expr, $springs:expr, $build:path, $wide:expr) => {
        #[doc = concat!("The lanes ", $name, " in `", stringify!($t), "`.")]
        pub const $job: Job = {
            static SCENE: ConstStaticCell<Scene<$t, $particles, $springs, Hookean>> =
                ConstStaticCell::new(Scene::new());
            let start: fn(&mut Trace<'_>) -> Outcome = |trace| {
                let (scene, mut solver) = (SCENE.take(), $wide);
                $build(scene)?;
                steps(scene, &mut solver, trace)?;
                expect(solver.in_lanes(), "lanes")
            };
            Job { name: $name, precision: stringify!($t), start }
        };
    };
}

lanes!(
    CHAIN_F32,
    f32,
    "chain",
    ROPE,
    { ROPE - 1 },
    rope,
    WideJacobi::new(zeros!(f32, NUMBERS), zeros!(u32, WORDS), Portable)
        .around(BandedLdl::new(zeros!(f32, CHAIN)))
);
lanes!(
    CHAIN_F64,
    f64,
    "chain",
    ROPE,
    { ROPE - 1 },
    rope,
    WideJacobi::new(zeros!(f64, NUMBERS), zeros!(u32, WORDS), Portable)
        .around(BandedLdl::new(zeros!(f64, CHAIN)))
);
lanes!(
    SLOTS_F32,
    f32,
    "slots",
    NET,
    { 3 * NET },
    tangle,
    WideJacobi::new(zeros!(f32, NUMBERS), zeros!(u32, WORDS), Portable)
);
lanes!(
    SLOTS_F64,
    f64,
    "slots",
    NET,
    { 3 * NET },
    tangle,
    WideJacobi::new(zeros!(f64, NUMBERS), zeros!(u32, WORDS), Portable)
);

/// Numbers of [`SingleJacobi`] for the cloth, and those and words of the lanes around it: more than they need.
const IN_SINGLE: usize = 4096;
const AROUND_SINGLE: (usize, usize) = (4608, 1024);

lanes!(
    WIDE_SINGLE_F32,
    f32,
    "wide-single",
    PARTICLES,
    SPRINGS,
    hung_cloth,
    WideJacobi::new(zeros!(f32, AROUND_SINGLE.0), zeros!(u32, AROUND_SINGLE.1), Portable)
        .around(SingleJacobi::new(zeros!(f32, IN_SINGLE)))
);
lanes!(
    WIDE_SINGLE_F64,
    f64,
    "wide-single",
    PARTICLES,
    SPRINGS,
    hung_cloth,
    WideJacobi::new(zeros!(f64, AROUND_SINGLE.0), zeros!(u32, AROUND_SINGLE.1), Portable)
        .around(SingleJacobi::new(zeros!(f32, IN_SINGLE)))
);

fn rope<M: Memory>(scene: &mut MassSpring<M>) -> Outcome {
    scenes::hang(scene, ROPE)
}

/// A rope whose particles are also tied crosswise, at as many distances as there are.
fn tangle<M: Memory>(scene: &mut MassSpring<M>) -> Outcome {
    scenes::hang(scene, NET)?;
    for i in 0..NET {
        for other in [(5 * i + 11) % NET, (i * i + 7) % NET] {
            if other > i + 1 {
                scene.spring(i, other, M::Real::from_count(200))?;
            }
        }
    }
    Ok(())
}

/// An order that is not the particles' own.
fn backwards() -> [u32; PARTICLES] {
    let mut order = [0; PARTICLES];
    for (place, particle) in order.iter_mut().zip((0..PARTICLES as u32).rev()) {
        *place = particle;
    }
    order
}

fn run<M: Memory, S: Solver<M::Real>>(
    scene: &mut MassSpring<M>,
    solver: S,
    trace: &mut Trace<'_>,
) -> Outcome {
    hung_cloth(scene)?;
    steps(scene, solver, trace)
}

fn hung_cloth<M: Memory>(scene: &mut MassSpring<M>) -> Outcome {
    scenes::cloth(scene, SIDE)?;
    scene.pin(0)?;
    scene.pin(SIDE - 1)?;
    Ok(())
}

fn steps<M: Memory, S: Solver<M::Real>>(
    scene: &mut MassSpring<M>,
    solver: S,
    trace: &mut Trace<'_>,
) -> Outcome {
    let mut euler = LinearlyImplicitEuler::new(dt()).gravity(gravity()).solver(solver);
    for _ in 0..6 {
        let report = scene.step(&mut euler)?;
        expect(report.fallbacks == 0, "the solver's own answer")?;
        trace.step(scene, &report)?;
    }
    Ok(())
}
