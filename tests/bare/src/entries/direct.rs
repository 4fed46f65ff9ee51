//! Direct solvers: made, fitted, and in a step.

use hooke::{
    BandedLdl, Numbers, Portable, Single, Solve, Solver, SparseLdl, StepError, Stop, solver::Problem,
};

use crate::shared::*;

type Banded<'a, T> = BandedLdl<&'a mut [T]>;
type Sparse<'a, T> = SparseLdl<&'a [u32], &'a mut [T], &'a mut [u32]>;
type Half<'a> = SparseLdl<&'a [u32], Single<&'a mut [f32]>, &'a mut [u32]>;

crate::entry_point::entry_points! {
    BandedLdl::new<'a>(workspace: &'a mut [T]) -> Banded<'a, T> { BandedLdl::new(workspace) }
    BandedLdl::needs(particles: usize, half_bandwidth: usize) -> usize { BandedLdl::needs(particles, half_bandwidth) }
    BandedLdl::needs_of(scene: &mut S<T>) -> usize { BandedLdl::needs_of(scene) }
    SparseLdl::new<'a>(order: &'a [u32], numbers: &'a mut [T], words: &'a mut [u32]) -> Sparse<'a, T> {
        SparseLdl::new(order, numbers, words)
    }
    SparseLdl::dispatched_by<'a>(solver: Sparse<'a, T>) -> Sparse<'a, T> { solver.dispatched_by(Portable) }
    Numbers::numbers<'a>(room: &'a mut Single<&'a mut [f32]>, _x: T) -> &'a mut [f32] { Numbers::<T>::numbers(room) }
    SparseLdl::prepare(solver: &mut Sparse<'_, T>, scene: &mut S<T>) -> Result<(), StepError> { solver.prepare(scene) }
    Solver::solve[banded](
        solver: &mut Banded<'_, T>, problem: Problem<'_, '_, T, All<'_, T>>, stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        solver.solve(problem, stop)
    }
    Solver::solve[sparse](
        solver: &mut Sparse<'_, T>, problem: Problem<'_, '_, T, All<'_, T>>, stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        solver.solve(problem, stop)
    }
    Solver::solve[single](
        solver: &mut Half<'_>, problem: Problem<'_, '_, T, All<'_, T>>, stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        solver.solve(problem, stop)
    }
    Solver::again[banded](
        solver: &mut Banded<'_, T>, problem: Problem<'_, '_, T, All<'_, T>>, stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        solver.again(problem, stop)
    }
    Solver::repeat(solver: &mut Sparse<'_, T>) { Solver::<T>::repeat(solver) }
    Solver::again[sparse](
        solver: &mut Sparse<'_, T>, problem: Problem<'_, '_, T, All<'_, T>>, stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        solver.again(problem, stop)
    }
}
