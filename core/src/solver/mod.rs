//! How a step's linear system is solved: one file per method, one trait. A solver is a value that owns the scratch it
//! needs beyond the scene's own vectors; one that a program does not name costs it nothing.

mod around;
mod banded_ldl;
mod block_ilu;
mod chain;
mod direct;
mod eisenstat;
mod elimination;
mod elimination_tree;
pub(crate) mod jacobi;
mod multigrid;
mod panel;
pub(crate) mod pcg;
pub(crate) mod pivot;
mod precision;
pub(crate) mod refinement;
mod sparse_ldl;
mod ssor;
mod substitution;
mod supernodes;
mod triangle;
mod update;

pub use banded_ldl::BandedLdl;
pub use block_ilu::BlockIlu;
pub use jacobi::{BlockJacobi, Jacobi, Preconditioner};
pub use multigrid::{LevelPart, Multigrid};
pub use pcg::Stop;
pub use precision::{Numbers, Single};
pub use sparse_ldl::SparseLdl;
pub use ssor::Ssor;

use crate::assembly::{Assembled, Same, assemble};
use crate::error::StepError;
use crate::force::Force;
use crate::hessian::Scaling;
use crate::law::Law;
use crate::parts::{IslandParts, Vectors};
use crate::real::Real;
use crate::report::Solve;
use crate::system::System;

/// One island's A Δq̇ = b with A's certificate μ, and the scene's vectors to solve it in; opaque: only this crate's
/// solvers look inside.
pub struct Problem<'p, 'a, T, F> {
    pub(crate) system: System<'p, T, F>,
    /// b and μ come in; x goes out
    pub(crate) vectors: &'p mut Vectors<'a, T>,
    /// Room for a block per row
    pub(crate) block: &'p mut [[T; 6]],
    /// Nothing holds this island: its momentum is to be kept
    pub(crate) free: bool,
}

/// One island of a step before it is assembled, opaque: only this crate's solvers look inside.
pub struct Island<'p, 'a, T, F> {
    pub(crate) island: &'p mut IslandParts<'a, T>,
    pub(crate) forces: &'p mut F,
    pub(crate) h: T,
    pub(crate) scaling: Scaling<T>,
}

/// What became of it: the scene's x holds Δq̇.
pub struct Answer<T> {
    pub(crate) clamped: u32,
    pub(crate) certified: bool,
    pub(crate) solve: Solve<T>,
}

/// μ → 1/μ
pub(crate) fn invert<T: Real>(mu: &mut [T]) {
    for mu in mu.iter_mut() {
        *mu = T::ONE / *mu;
    }
}

/// A method for A x = b.
pub trait Solver<T: Real> {
    /// A step begins, whose islands are about to come in their order; those that need no solve do not.
    #[inline(always)]
    fn begin(&mut self) {}

    /// The next system is of the same island as the last one, with other numbers.
    #[inline(always)]
    fn repeat(&mut self) {}

    /// Assembles one island's system and solves it. A solver with a layout of its own may assemble in its own way; the
    /// others have it done in the scene's lists.
    ///
    /// # Errors
    /// As [`Solver::solve`], and [`StepError::NotCertified`].
    fn answer<F: Force<T>, L: Law>(
        &mut self,
        to: Island<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Answer<T>, StepError> {
        let Island { island, forces, h, scaling } = to;
        let Assembled { clamped, certified, points, free } =
            assemble::<T, F, L, _>(island, forces, h, scaling, &Same)?;
        let IslandParts { matrix, vectors, block, .. } = island;
        let system = System { matrix, forces: &*forces, points };
        let solve = self.solve(Problem { system, vectors, block, free }, stop)?;
        Ok(Answer { clamped, certified, solve })
    }

    /// Solves one island's system until `stop` says enough, and certifies the answer.
    ///
    /// # Errors
    /// [`StepError::Workspace`] if the solver's scratch is too small.
    fn solve<F: Force<T>>(
        &mut self,
        problem: Problem<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError>;

    /// Solves with the matrix of the last [`Solver::solve`] and another right side: 1/μ is then in place of μ. A solver
    /// that keeps what it has made of the matrix uses it; the others make it anew.
    ///
    /// # Errors
    /// As [`Solver::solve`].
    fn again<F: Force<T>>(
        &mut self,
        problem: Problem<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        self.repeat();
        invert(problem.vectors.mu);
        self.solve(problem, stop)
    }
}

/// A solver that outlives the integrator which uses it: what it keeps between steps stays with it.
impl<T: Real, S: Solver<T>> Solver<T> for &mut S {
    fn answer<F: Force<T>, L: Law>(
        &mut self,
        to: Island<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Answer<T>, StepError> {
        (**self).answer::<F, L>(to, stop)
    }

    #[inline]
    fn begin(&mut self) {
        (**self).begin();
    }

    #[inline]
    fn repeat(&mut self) {
        (**self).repeat();
    }

    fn solve<F: Force<T>>(
        &mut self,
        problem: Problem<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        (**self).solve(problem, stop)
    }

    fn again<F: Force<T>>(
        &mut self,
        problem: Problem<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        (**self).again(problem, stop)
    }
}
