//! A solver that counts what is asked of it, also in steps that fail and so have no report.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use hooke::solver::{Answer, Island, Problem};
use hooke::{Force, Law, Real, Solve, Solver, StepError, Stop};

/// What solvers were asked to do; shared by the copies of one.
#[derive(Debug, Clone, Default)]
pub struct Work {
    solves: Arc<AtomicU64>,
    iterations: Arc<AtomicU64>,
}

impl Work {
    /// Linear systems.
    pub fn solves(&self) -> u64 {
        self.solves.load(Ordering::Relaxed)
    }

    /// Iterations of them, each one product with the matrix, or solves with a factor; but for those that a solver makes where
    /// it also assembles (`euler`), which are in the reports alone.
    pub fn iterations(&self) -> u64 {
        self.iterations.load(Ordering::Relaxed)
    }

    fn add(&self, iterations: u32) {
        self.solves.fetch_add(1, Ordering::Relaxed);
        self.iterations.fetch_add(u64::from(iterations), Ordering::Relaxed);
    }
}

/// The solver, and what it was asked to do.
#[derive(Debug, Clone)]
pub struct Counted<S> {
    solver: S,
    work: Work,
}

impl<S> Counted<S> {
    /// A solver that adds to this.
    pub fn new(solver: S, work: Work) -> Self {
        Self { solver, work }
    }

    fn counted<T>(&self, solve: Result<Solve<T>, StepError>) -> Result<Solve<T>, StepError> {
        self.work.add(solve.as_ref().map_or(0, |solve| solve.iterations));
        solve
    }
}

impl<T: Real, S: Solver<T>> Solver<T> for Counted<S> {
    fn begin(&mut self) {
        self.solver.begin();
    }

    fn repeat(&mut self) {
        self.solver.repeat();
    }

    fn answer<F: Force<T>, L: Law>(
        &mut self,
        to: Island<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Answer<T>, StepError> {
        self.work.add(0);
        self.solver.answer::<F, L>(to, stop)
    }

    fn solve<F: Force<T>>(
        &mut self,
        problem: Problem<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        let solve = self.solver.solve(problem, stop);
        self.counted(solve)
    }

    fn again<F: Force<T>>(
        &mut self,
        problem: Problem<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        let solve = self.solver.again(problem, stop);
        self.counted(solve)
    }
}
