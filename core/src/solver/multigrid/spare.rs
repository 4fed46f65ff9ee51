//! The hierarchy, and block Jacobi for where it brings x no nearer: stiffnesses that differ by more than f32 can tell apart. In lanes
//! [`crate::wide::jacobi::OrDiagonal`] holds both.

use super::preconditioner::Preconditioner;
use crate::force::Force;
use crate::parts::Vectors;
use crate::real::Real;
use crate::solver::jacobi::Jacobi;
use crate::solver::pcg::{Iteration, Plain};
use crate::system::System;
use crate::wide::Dispatch;

/// One, and the other if it is needed.
pub(super) struct WithSpare<'p, 'a, 'b, T, D> {
    pub(super) hierarchy: &'p mut Preconditioner<'a, T, D>,
    /// Room for D⁻¹, until it lies there
    pub(super) block: &'b mut [[T; 6]],
    pub(super) jacobi: Option<Jacobi<'b, T>>,
}

impl<T: Real, D: Dispatch> Iteration<T> for WithSpare<'_, '_, '_, T, D> {
    fn iterate<F: Force<T>>(
        &mut self,
        system: &System<'_, T, F>,
        v: &mut Vectors<'_, T>,
        target: T,
        max_iterations: u32,
        iterations: &mut u32,
    ) -> bool {
        match &self.jacobi {
            Some(jacobi) => Plain(jacobi).iterate(system, v, target, max_iterations, iterations),
            None => self.hierarchy.iterate(system, v, target, max_iterations, iterations),
        }
    }

    fn precondition<F: Force<T>>(&mut self, system: &System<'_, T, F>, v: &mut Vectors<'_, T>) {
        match &self.jacobi {
            Some(jacobi) => Plain(jacobi).precondition(system, v),
            None => self.hierarchy.precondition(system, v),
        }
    }

    #[cold]
    fn fall_back<F: Force<T>>(&mut self, system: &System<'_, T, F>) -> bool {
        if self.jacobi.is_some() {
            return false;
        }
        self.jacobi = Some(Jacobi::new(system, core::mem::take(&mut self.block)));
        true
    }
}
