//! Making a method, and reading its report.

use hooke::{
    BlockJacobi, Drag, Gravity, Integrator, Motion, Parts, Report, Solve, Solver, StepError, Stop,
    solver::Problem,
};

use crate::shared::*;

crate::entry_point::entry_points! {
    Stepper::new(dt: T) -> Euler<T> { Euler::new(dt) }
    Stepper::with(euler: Euler<T>, rate: T) -> Euler<T, ((), Drag<T>)> { euler.with(Drag(rate)) }
    Stepper::gravity(euler: Euler<T>, g: V<T>) -> Euler<T, ((), Gravity<T>)> { euler.gravity(g) }
    Stepper::tolerance(euler: Euler<T>, r: T) -> Euler<T> { euler.tolerance(r) }
    Stepper::absolute(euler: Euler<T>, joules: T) -> Euler<T> { euler.absolute(joules) }
    Stepper::max_iterations(euler: Euler<T>, n: u32) -> Euler<T> { euler.max_iterations(n) }
    Stepper::solver(euler: Euler<T>) -> Euler<T> { euler.solver(BlockJacobi) }
    Stepper::dt(euler: &Euler<T>) -> T { euler.dt() }
    Stepper::set_dt(euler: &mut Euler<T>, dt: T) { euler.set_dt(dt) }
    LinearlyImplicitEuler::inspect(
        euler: &mut Euler<T, All<'_, T>>, parts: Parts<'_, Owner<T>>, motion: &[Motion<T>], sum: &mut T,
    ) -> bool {
        let seen = euler.inspect(parts, motion, |system, b, mu| {
            *sum += b.iter().zip(mu).fold(0.0, |sum, (b, mu)| sum + b[0] * mu) + system.particles() as T;
        });
        seen.is_ok()
    }
    Integrator::advance(
        euler: &mut Euler<T, All<'_, T>>, parts: Parts<'_, Owner<T>>, motion: &[Motion<T>], seen: &mut u32,
    ) -> Stepped<T> {
        euler.advance(parts, motion, &mut |island| *seen += island.solve.iterations)
    }
    Solver::solve(problem: Problem<'_, '_, T, All<'_, T>>, stop: &Stop<T>) -> Result<Solve<T>, StepError> {
        BlockJacobi.solve(problem, stop)
    }
    Report::is_certified(report: &Report<T>) -> bool { report.is_certified() }
    Stop::new() -> Stop<T> { Stop::new() }
}
