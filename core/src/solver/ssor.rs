//! Block SSOR: PCG with M = (P + L) P⁻¹ (P + Lᵀ), P = D/ω, by Eisenstat's trick ([`super::eisenstat`]).
//!
//! D are the 3×3 diagonal blocks of A, L what is below them, ω = 6/5. M is symmetric and positive for every ω > 0. Dᵢ
//! is positive wherever A is certified; should rounding make one indefinite (condition above 1/u), the island is left to
//! [`BlockJacobi`], and [`Solve::fallback`] says so.
//!
//! E = D − P = (ω − 1) P, so E p takes no memory.
//!
//! Rows follow each other in the particles' order; another order is another M. They wait for each other, so nothing runs
//! side by side.
//!
//! For bodies and meshes: on the bunny of the design 13 iterations and 0.48 ms a step where block Jacobi takes 31 and 0.75.
//! Not for cloths and nets numbered in rows, where lanes run side by side: on cloth:64 165 iterations and 20.6 ms, block
//! Jacobi 351 and 37.6, but that in lanes ([`crate::WideJacobi`]) 17.0, and [`crate::Multigrid`] 6.5. Not for chains
//! ([`crate::BandedLdl`]). (R = 1e-6; `cargo run --release -p hooke-benches --bin compare -- cloth:64`, and with the mesh.)
//!
//! Cost: of D⁻¹ as in [`BlockJacobi`]; of an iteration see [`super::eisenstat`]. Memory: 6 numbers per particle.
//!
//! Source: Axelsson 1972; Eisenstat 1981.

use crate::error::StepError;
use crate::force::Force;
use crate::real::Real;
use crate::report::Solve;
use crate::solver::eisenstat::{Eisenstat, Excess};
use crate::solver::{BlockJacobi, Jacobi, Preconditioner, Problem, Solver, Stop, pcg};
use crate::sym3::Sym3;
use crate::system::System;
use crate::vec3::{self, Vec3};

/// Block-SSOR PCG in a workspace of the caller's: an array, a borrowed slice, a vector.
///
/// ```
/// use hooke::{LinearlyImplicitEuler, Scene, Ssor};
/// const ROOM: usize = Ssor::needs(40);
/// let mut rope = Box::new(Scene::<f32, 40, 39>::new());
/// for i in 0..40 {
///     rope.particle([0.1 * i as f32, 0.0, 0.0], 0.010)?;
/// }
/// for i in 1..40 {
///     rope.spring(i - 1, i, 1_000.0)?;
/// }
/// rope.pin(0)?;
/// let mut euler =
///     LinearlyImplicitEuler::new(1.0 / 60.0).gravity([0.0, -9.81, 0.0]).solver(Ssor::new([0.0; ROOM]));
/// let report = rope.step(&mut euler)?;
/// assert_eq!((report.capped, report.stalled, report.fallbacks), (0, 0, 0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Ssor<B> {
    workspace: B,
}

impl Ssor<()> {
    /// How many numbers an island of so many free particles needs, whatever its springs: 6 per particle. Islands share the
    /// workspace: the largest need counts.
    pub const fn needs(particles: usize) -> usize {
        particles.saturating_mul(6)
    }
}

impl<B> Ssor<B> {
    /// A solver in this workspace; [`Ssor::needs`] says how large it is to be. If it is too small, a step fails with
    /// [`StepError::Workspace`], which says so too.
    pub const fn new(workspace: B) -> Self {
        Self { workspace }
    }

    /// z = M⁻¹ r for a system's A; answers rᵀz. `blocks` is room for a block per row. For tests and for other iterations.
    ///
    /// # Errors
    /// [`StepError::Workspace`] if the workspace is too small.
    pub fn apply<T: Real, F: Force<T>>(
        &mut self,
        system: &System<'_, T, F>,
        blocks: &mut [[T; 6]],
        r: &[Vec3<T>],
        z: &mut [Vec3<T>],
    ) -> Result<T, StepError>
    where
        B: AsMut<[T]>,
    {
        Ok(match prepare(system, blocks, self.workspace.as_mut())? {
            Some(mut by) => by.apply(system, r, z),
            None => Jacobi::new(system, blocks).apply(r, z),
        })
    }
}

/// E = (ω − 1) P
struct Relaxed<T>(T);

impl<T: Real> Excess<T> for Relaxed<T> {
    #[inline(always)]
    fn times(&self, _: usize, _: Vec3<T>, pivot_times_p: Vec3<T>) -> Vec3<T> {
        vec3::scale(self.0, pivot_times_p)
    }
}

/// The iteration with P⁻¹ = ω D⁻¹ in `blocks`; `None` if a block of D is not positive.
#[inline(never)]
fn prepare<'a, T: Real, F: Force<T>>(
    system: &System<'_, T, F>,
    blocks: &'a mut [[T; 6]],
    workspace: &'a mut [T],
) -> Result<Option<Eisenstat<'a, T, Relaxed<T>>>, StepError> {
    let numbers = Ssor::needs(system.particles());
    let lacks = StepError::Workspace { numbers, words: 0 };
    let workspace = workspace.get_mut(..numbers).ok_or(lacks)?;
    let relaxation = T::from_count(6) / T::from_count(5);
    system.diagonal(blocks);
    for block in blocks.iter_mut() {
        let Some(inverse) = Sym3(*block).inverse() else { return Ok(None) };
        *block = inverse.0.map(|x| relaxation * x);
    }
    let excess = Relaxed(relaxation - T::ONE);
    Ok(Some(Eisenstat { inverse: blocks, excess, sums: workspace.as_chunks_mut().0.as_chunks_mut().0 }))
}

impl<T: Real, B: AsMut<[T]>> Solver<T> for Ssor<B> {
    fn solve<F: Force<T>>(
        &mut self,
        problem: Problem<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        let Problem { system, vectors, block, free } = problem;
        if let Some(mut by) = prepare(&system, block, self.workspace.as_mut())? {
            return Ok(pcg::solve_by(&system, &mut by, vectors, stop, free));
        }
        let solve = BlockJacobi.solve(Problem { system, vectors, block, free }, stop)?;
        Ok(Solve { fallback: true, ..solve })
    }
}
