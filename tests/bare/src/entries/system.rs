//! The system that a step solves, as a solver of the user's own would use it.

use hooke::{Jacobi, Operator, Parts, Preconditioner};

use crate::shared::*;

crate::entry_point::entry_points! {
    MassSpring::parts(s: &mut S<T>) -> Parts<'_, Owner<T>> { s.parts() }
    System::particles(system: &Whole<'_, T>) -> usize { system.particles() }
    System::particle(system: &Whole<'_, T>, row: usize) -> Option<usize> { system.particle(row) }
    System::blocks(system: &Whole<'_, T>, sum: &mut T) {
        system.blocks(|row, column, block| *sum += block[0][0] * (row + column) as T)
    }
    Operator::apply(system: &Whole<'_, T>, x: &[V<T>], y: &mut [V<T>]) -> T { system.apply(x, y) }
    Jacobi::new<'a>(system: &Whole<'_, T>, blocks: &'a mut [[T; 6]]) -> Jacobi<'a, T> { Jacobi::new(system, blocks) }
    Preconditioner::apply(jacobi: &Jacobi<'_, T>, r: &[V<T>], z: &mut [V<T>]) -> T { jacobi.apply(r, z) }
    Preconditioner::sweep(
        jacobi: &Jacobi<'_, T>, a: T, x: &mut [V<T>], r: &mut [V<T>], p: &mut [V<T>], y: &mut [V<T>], weight: &[T],
    ) -> (T, T) {
        jacobi.sweep(a, [x, r, p, y], weight)
    }
}
