//! Block SSOR and block D-ILU.

use hooke::{BlockIlu, Solve, Solver, Ssor, StepError, Stop, solver::Problem};

use crate::shared::*;

type Sweeps<'a, T> = Ssor<&'a mut [T]>;
type Ilu<'a, T> = BlockIlu<&'a mut [T]>;

crate::entry_point::entry_points! {
    Ssor::new<'a>(workspace: &'a mut [T]) -> Sweeps<'a, T> { Ssor::new(workspace) }
    Ssor::needs(particles: usize, _unused: T) -> usize { Ssor::needs(particles) }
    Ssor::apply(
        solver: &mut Sweeps<'_, T>, system: &Whole<'_, T>, blocks: &mut [[T; 6]], r: &[V<T>], z: &mut [V<T>],
    ) -> Result<T, StepError> {
        solver.apply(system, blocks, r, z)
    }
    Solver::solve[ssor](
        solver: &mut Sweeps<'_, T>, problem: Problem<'_, '_, T, All<'_, T>>, stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        solver.solve(problem, stop)
    }
    BlockIlu::new<'a>(workspace: &'a mut [T]) -> Ilu<'a, T> { BlockIlu::new(workspace) }
    BlockIlu::needs(particles: usize, _unused: T) -> usize { BlockIlu::needs(particles) }
    BlockIlu::apply(
        solver: &mut Ilu<'_, T>, system: &Whole<'_, T>, blocks: &mut [[T; 6]], r: &[V<T>], z: &mut [V<T>],
    ) -> Result<T, StepError> {
        solver.apply(system, blocks, r, z)
    }
    Solver::solve[ilu](
        solver: &mut Ilu<'_, T>, problem: Problem<'_, '_, T, All<'_, T>>, stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        solver.solve(problem, stop)
    }
}
