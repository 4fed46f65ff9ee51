//! Multigrid: made, in a step, and looked into.

use hooke::{Multigrid, Portable, Solve, Solver, StepError, Stop, solver::LevelPart, solver::Problem};

use crate::shared::*;

type Own<'a> = Multigrid<&'a mut [f32], &'a mut [u32]>;

crate::entry_point::entry_points! {
    Multigrid::needs(particles: usize, springs: usize) -> (usize, usize) { Multigrid::needs(particles, springs) }
    Multigrid::new<'a>(numbers: &'a mut [f32], words: &'a mut [u32]) -> Own<'a> {
        Multigrid::new(numbers, words, Portable)
    }
    Multigrid::apply(
        solver: &mut Own<'_>, system: &Whole<'_, T>, r: &[V<T>], z: &mut [V<T>],
    ) -> Result<T, StepError> {
        solver.apply(system, r, z)
    }
    Multigrid::inspect(
        solver: &mut Own<'_>, system: &Whole<'_, T>, visit: &mut dyn FnMut(usize, LevelPart),
    ) -> Result<T, StepError> {
        solver.inspect(system, visit)
    }
    Solver::solve[multigrid](
        solver: &mut Own<'_>, problem: Problem<'_, '_, T, All<'_, T>>, stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        solver.solve(problem, stop)
    }
}
