//! Block-Jacobi PCG in lanes.

use hooke::solver::Problem;
use hooke::{
    BandedLdl, Dispatch, Multigrid, Portable, SingleJacobi, Solve, Solver, StepError, Stop, WideJacobi,
};

use crate::shared::*;

/// The solver in borrowed memory.
type Wide<'a, T> = WideJacobi<&'a mut [T], &'a mut [u32]>;
/// Multigrid in borrowed memory.
type Grid<'a> = Multigrid<&'a mut [f32], &'a mut [u32]>;
/// The solver around it.
type Around<'a, T> = hooke::Wide<&'a mut [T], &'a mut [u32], Portable, Grid<'a>>;
/// Iterations in f32, in borrowed memory.
type InSingle<'a> = SingleJacobi<&'a mut [f32]>;
/// The solver with these.
type AroundSingle<'a, T> = hooke::Wide<&'a mut [T], &'a mut [u32], Portable, InSingle<'a>>;
/// The banded solver in lanes.
type Chains<'a, T> = hooke::Wide<&'a mut [T], &'a mut [u32], Portable, BandedLdl<&'a mut [T]>>;
/// A step by it.
type Step<'a, T, P> = hooke::LinearlyImplicitEuler<T, All<'a, T>, P>;

crate::entry_point::entry_points! {
    Wide::new<'a>(numbers: &'a mut [T], words: &'a mut [u32]) -> Wide<'a, T> {
        WideJacobi::new(numbers, words, Portable)
    }
    Wide::needs_of(s: &mut S<T>, damped: bool) -> (usize, usize) { WideJacobi::needs_of(s, damped) }
    Wide::runs_of(s: &mut S<T>) -> bool { WideJacobi::runs_of(s) }
    Wide::in_lanes(wide: &Wide<'_, T>) -> bool { wide.in_lanes() }
    Solver::solve[wide](
        wide: &mut Wide<'_, T>, problem: Problem<'_, '_, T, All<'_, T>>, stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        wide.solve(problem, stop)
    }
    Wide::around<'a>(wide: Wide<'a, T>, grid: Grid<'a>) -> Around<'a, T> { wide.around(grid) }
    Solver::answer[wide](s: &mut S<T>, euler: &mut Step<'_, T, Wide<'_, T>>) -> Stepped<T> { s.step(euler) }
    Preconditions::solve_in_lanes[multigrid](
        s: &mut S<T>, euler: &mut Step<'_, T, Around<'_, T>>,
    ) -> Stepped<T> {
        s.step(euler)
    }
    Preconditions::solve_in_lanes[banded](
        s: &mut S<T>, euler: &mut Step<'_, T, Chains<'_, T>>,
    ) -> Stepped<T> {
        s.step(euler)
    }
    SingleJacobi::new<'a>(numbers: &'a mut [f32], _unused: T) -> InSingle<'a> { SingleJacobi::new(numbers) }
    SingleJacobi::needs_of(s: &mut S<T>) -> usize { SingleJacobi::needs_of(s) }
    Solver::solve[single_jacobi](
        single: &mut InSingle<'_>, problem: Problem<'_, '_, T, All<'_, T>>, stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        single.solve(problem, stop)
    }
    Preconditions::solve_in_lanes[single](
        s: &mut S<T>, euler: &mut Step<'_, T, AroundSingle<'_, T>>,
    ) -> Stepped<T> {
        s.step(euler)
    }
    BandedLdl::needs_in_lanes_of(s: &mut S<T>, damped: bool) -> (usize, (usize, usize)) {
        BandedLdl::needs_in_lanes_of(s, damped)
    }
    Dispatch::run(x: T) -> T { Portable.run(|| x + x) }
}
