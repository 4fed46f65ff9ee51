//! Block-Jacobi PCG in lanes.

use hooke::{Dispatch, Portable, Solve, Solver, StepError, Stop, WideJacobi, solver::Problem};

use crate::shared::*;

/// The solver in borrowed memory.
type Wide<'a, T> = WideJacobi<&'a mut [T], &'a mut [u32]>;

crate::entry_point::entry_points! {
    WideJacobi::new<'a>(numbers: &'a mut [T], words: &'a mut [u32]) -> Wide<'a, T> {
        WideJacobi::new(numbers, words, Portable)
    }
    WideJacobi::needs_of(s: &mut S<T>, scratch: &mut [u32]) -> (usize, usize) { WideJacobi::needs_of(s, scratch) }
    WideJacobi::in_lanes(wide: &Wide<'_, T>) -> bool { wide.in_lanes() }
    Solver::solve[wide](
        wide: &mut Wide<'_, T>, problem: Problem<'_, '_, T, All<'_, T>>, stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        wide.solve(problem, stop)
    }
    Dispatch::run(x: T) -> T { Portable.run(|| x + x) }
}
