//! Aggregation multigrid.

use hooke::{Multigrid, Portable, Solve, Solver, StepError, Stop, solver::Problem};

use crate::shared::*;

/// The solver in borrowed memory.
type Borrowed<'a> = Multigrid<&'a mut [f32], &'a mut [u32]>;

crate::entry_point::entry_points! {
    Multigrid::new<'a>(numbers: &'a mut [f32], words: &'a mut [u32], _unused: T) -> Borrowed<'a> {
        Multigrid::new(numbers, words, Portable)
    }
    Multigrid::needs(particles: usize, springs: usize, _unused: T) -> (usize, usize) {
        Multigrid::needs(particles, springs)
    }
    Multigrid::apply(
        grid: &mut Borrowed<'_>, system: &Whole<'_, T>, r: &[V<T>], z: &mut [V<T>],
    ) -> Result<T, StepError> {
        grid.apply(system, r, z)
    }
    Multigrid::inspect(grid: &mut Borrowed<'_>, system: &Whole<'_, T>, seen: &mut usize) -> Result<T, StepError> {
        grid.inspect(system, |level, _| *seen += level)
    }
    Solver::solve[multigrid](
        grid: &mut Borrowed<'_>, problem: Problem<'_, '_, T, All<'_, T>>, stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        grid.solve(problem, stop)
    }
}
