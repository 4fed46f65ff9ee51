//! Forces, one function of each at a time, as a method of the user's own would call them.

use hooke::force::{Coefficients, Rows};
use hooke::{Force, Hessian, PointSpring, Scaling, State, StepError};

use crate::shared::*;

crate::entry_point::entry_points! {
    PointSpring::new(i: usize, target: V<T>, k: T) -> PointSpring<T> { PointSpring::new(i, target, k) }
    PointSpring::rest_length(spring: PointSpring<T>, l: T) -> PointSpring<T> { spring.rest_length(l) }
    Force::check(forces: &All<'_, T>, particles: usize, springs: usize) -> Result<(), StepError> {
        forces.check(particles, springs)
    }
    Force::check[of_none](springs: usize) -> Result<(), StepError> { Force::<T>::check(&(), 0, springs) }
    Force::check[of_many](forces: &&mut [PointSpring<T>], particles: usize) -> Result<(), StepError> {
        forces.check(particles, 0)
    }
    Force::add(forces: &All<'_, T>, rows: &Rows<'_, T>, f: &mut [V<T>]) { forces.add(rows, f) }
    Force::add[of_many](forces: &&mut [PointSpring<T>], rows: &Rows<'_, T>, f: &mut [V<T>]) { forces.add(rows, f) }
    Force::drag(forces: &All<'_, T>, i: usize, mass: T) -> T { forces.drag(i, mass) }
    Force::damping(forces: &All<'_, T>, j: usize) -> T { forces.damping(j) }
    Force::linearize(forces: &mut All<'_, T>, rows: &Rows<'_, T>, scaling: Scaling<T>) -> u32 {
        forces.linearize(rows, scaling)
    }
    Force::linearize[of_many](forces: &mut &mut [PointSpring<T>], rows: &Rows<'_, T>, scaling: Scaling<T>) -> u32 {
        forces.linearize(rows, scaling)
    }
    Force::clamp(forces: &mut All<'_, T>, rows: &Rows<'_, T>, scaling: Scaling<T>, from: usize) -> u32 {
        forces.clamp(rows, scaling, |row| row >= from)
    }
    Force::clamp[of_many](
        forces: &mut &mut [PointSpring<T>], rows: &Rows<'_, T>, scaling: Scaling<T>, from: usize,
    ) -> u32 {
        forces.clamp(rows, scaling, |row| row >= from)
    }
    Force::hessians(forces: &All<'_, T>, rows: &Rows<'_, T>, sum: &mut T) {
        forces.hessians(rows, &mut |_, h: Hessian<T>| *sum += h.alpha)
    }
    Force::potential_energy(forces: &All<'_, T>, state: State<'_, T>) -> T { forces.potential_energy(state) }
    Coefficients::coefficient(c: &[T], j: usize) -> T { c.coefficient(j) }
    Coefficients::invalid(c: &[T], springs: usize) -> Option<usize> { c.invalid(springs) }
    Rows::row(rows: &Rows<'_, T>, i: usize) -> Option<usize> { rows.row(i) }
    Rows::particles(rows: &Rows<'_, T>) -> usize { rows.particles().sum() }
    Rows::state[of_rows](rows: &Rows<'_, T>) -> usize { rows.state().springs() }
}
