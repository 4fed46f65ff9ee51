//! Block-Jacobi PCG in lanes with its iterations in f32, refined from outside ([`crate::solver::refinement`]): half the bytes
//! and half the registers of an iteration in f64.
//!
//! x, the residual that ends a solve and its bounds are in the scene's precision: f32 costs iterations where A is so
//! ill-conditioned that they go astray, never truth. Where they do not get nearer at all, block-Jacobi PCG in the scene's own
//! precision goes on from what they reached.
//!
//! Cost per iteration: as [`crate::WideJacobi`] in f32. Memory: 20 numbers (f32) per particle and 4 per particle and distance, in
//! slots 4 per end of a spring, on top of [`crate::Wide`]'s.
//!
//! Source: van der Vorst & Ye 2000.

use crate::error::StepError;
use crate::force::Force;
use crate::memory::Memory;
use crate::real::Real;
use crate::report::Solve;
use crate::scene::MassSpring;
use crate::solver::{BlockJacobi, Problem, Solver, Stop};
use crate::vec3::Vec3;
use crate::wide::dispatch::Dispatch;
use crate::wide::in_single::{InSingle, needs};
use crate::wide::jacobi::OrDiagonal;
use crate::wide::solve::Widened;
use crate::wide::{Preconditions, layouts_of};

/// For [`crate::Wide::around`]: block-Jacobi PCG whose iterations run in f32, in a workspace of the caller's. An island without lanes is
/// left to [`BlockJacobi`].
///
/// ```
/// use hooke::{LinearlyImplicitEuler, Portable, Scene, SingleJacobi, Wide};
/// let mut rope = Box::new(Scene::<f64, 40, 39>::new());
/// for i in 0..40 {
///     rope.particle([0.1 * i as f64, 0.0, 0.0], 0.010)?;
/// }
/// for i in 1..40 {
///     rope.spring(i - 1, i, 1_000.0)?;
/// }
/// rope.pin(0)?;
/// let (numbers, words) = Wide::needs_of(&mut rope, false);
/// let single = SingleJacobi::new(vec![0.0_f32; SingleJacobi::needs_of(&mut rope)]);
/// let solver = Wide::new(vec![0.0; numbers], vec![0; words], Portable).around(single);
/// let mut euler = LinearlyImplicitEuler::new(1e-3).gravity([0.0, -9.81, 0.0]).tolerance(1e-10).solver(solver);
/// let report = rope.step(&mut euler)?;
/// assert!((report.stalled, report.fallbacks) == (0, 0) && report.upper < 1e-20);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct SingleJacobi<N> {
    numbers: N,
}

impl SingleJacobi<()> {
    /// How many numbers (f32) a scene needs as its pins and springs are now. Islands share them.
    pub fn needs_of<M: Memory>(scene: &mut MassSpring<M>) -> usize {
        let mut numbers = 0;
        layouts_of(scene, |layout| numbers = core::cmp::max(numbers, needs(layout)));
        numbers
    }
}

impl<N> SingleJacobi<N> {
    /// In these numbers; [`SingleJacobi::needs_of`] says how many they are to be. If they are too few, a step fails with
    /// [`StepError::Workspace`], which says so too.
    pub const fn new(numbers: N) -> Self {
        Self { numbers }
    }
}

impl<T: Real, N: AsMut<[f32]>> Solver<T> for SingleJacobi<N> {
    fn solve<F: Force<T>>(
        &mut self,
        problem: Problem<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        BlockJacobi.solve(problem, stop)
    }
}

impl<T: Real, N: AsMut<[f32]>> Preconditions<T> for SingleJacobi<N> {
    fn solve_in_lanes<F: Force<T>, D: Dispatch>(
        &mut self,
        lanes: Widened<'_, '_, T, F, D>,
        x: &mut [Vec3<T>],
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        let short = StepError::Workspace { numbers: needs(lanes.layout), words: 0 };
        let numbers = self.numbers.as_mut().get_mut(..needs(lanes.layout)).ok_or(short)?;
        let mut single = InSingle::cut(numbers, &lanes).ok_or(short)?;
        Ok(lanes.solve(OrDiagonal::new(&mut single), x, stop))
    }
}
