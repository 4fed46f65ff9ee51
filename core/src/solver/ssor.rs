//! Block SSOR: PCG with M = (P + L) P⁻¹ (P + Lᵀ), P = D/ω, by [Eisenstat's trick](super::eisenstat).
//!
//! D are the 3×3 diagonal blocks of A, L is what is below them, ω = 6/5. M is symmetric and positive for every ω > 0. Dᵢ
//! is positive wherever A is certified; should rounding make one indefinite (condition above 1/u), the island is left to
//! [`BlockJacobi`], and the report says so.
//!
//! E = D − P = (ω − 1) P, so E p costs no memory.

use crate::error::StepError;
use crate::force::Force;
use crate::real::Real;
use crate::report::Solve;
use crate::solver::eisenstat::{Eisenstat, Excess};
use crate::solver::{BlockJacobi, Problem, Solver, Stop, pcg};
use crate::sym3::Sym3;
use crate::system::System;
use crate::vec3::{self, Vec3};

/// S
#[derive(Debug, Clone, Copy)]
pub struct Ssor<B> {
    workspace: B,
}

impl Ssor<()> {
    /// How many numbers an island of so many free particles needs. Islands share the workspace: the largest need counts.
    pub const fn needs(particles: usize) -> usize {
        particles.saturating_mul(9)
    }
}

impl<B> Ssor<B> {
    /// new
    pub const fn new(workspace: B) -> Self {
        Self { workspace }
    }
}

/// ω
fn relaxation<T: Real>() -> T {
    T::from_count(6) / T::from_count(5)
}

/// E = (ω − 1) P
struct Relaxed<T>(T);

impl<T: Real> Excess<T> for Relaxed<T> {
    #[inline(always)]
    fn times(&self, _: usize, _: Vec3<T>, pivot_times_p: Vec3<T>) -> Vec3<T> {
        vec3::scale(self.0, pivot_times_p)
    }
}

/// P⁻¹; `false` if a block of D is not positive.
#[inline(never)]
fn invert<T: Real, F: Force<T>>(system: &System<'_, T, F>, blocks: &mut [[T; 6]]) -> bool {
    system.diagonal(blocks);
    for block in blocks.iter_mut() {
        let Some(inverse) = Sym3(*block).inverse() else { return false };
        *block = inverse.0.map(|x| relaxation::<T>() * x);
    }
    true
}

impl<T: Real, B: AsMut<[T]>> Solver<T> for Ssor<B> {
    fn solve<F: Force<T>>(
        &mut self,
        problem: Problem<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        let numbers = Ssor::needs(problem.system.particles());
        let Some(workspace) = self.workspace.as_mut().get_mut(..numbers) else {
            return Err(StepError::Workspace { numbers, words: 0 });
        };
        let Problem { system, vectors, block, free } = problem;
        if !invert(&system, block) {
            let solve = BlockJacobi.solve(Problem { system, vectors, block, free }, stop)?;
            return Ok(Solve { fallback: true, ..solve });
        }
        let sums = workspace.as_chunks_mut().0.as_chunks_mut().0;
        let excess = Relaxed(relaxation::<T>() - T::ONE);
        let mut by = Eisenstat { inverse: block, excess, sums };
        Ok(pcg::solve_by(&system, &mut by, vectors, stop, free))
    }
}
