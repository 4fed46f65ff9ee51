//! Building a scene, and changing it while it runs.

use hooke::{EditError, Spring};

use crate::shared::*;

crate::entry_point::entry_points! {
    MassSpring::particle(s: &mut S<T>, x: V<T>, m: T) -> Result<usize, EditError> { s.particle(x, m) }
    MassSpring::spring(s: &mut S<T>, a: usize, b: usize, k: T) -> Result<usize, EditError> { s.spring(a, b, k) }
    MassSpring::spring_with(s: &mut S<T>, a: usize, b: usize, spring: Spring<T>) -> Result<usize, EditError> {
        s.spring_with(a, b, spring)
    }
    MassSpring::cable(s: &mut S<T>, a: usize, b: usize, spring: Spring<T>) -> Result<usize, EditError> {
        s.cable(a, b, spring)
    }
    MassSpring::pin(s: &mut S<T>, i: usize) -> Result<(), EditError> { s.pin(i) }
    MassSpring::release(s: &mut S<T>, i: usize) -> Result<(), EditError> { s.release(i) }
    MassSpring::is_pinned(s: &S<T>, i: usize) -> bool { s.is_pinned(i) }
    MassSpring::break_spring(s: &mut S<T>, j: usize) -> Result<(), EditError> { s.break_spring(j) }
    MassSpring::set_stiffness(s: &mut S<T>, j: usize, k: T) -> Result<(), EditError> { s.set_stiffness(j, k) }
    MassSpring::set_rest_length(s: &mut S<T>, j: usize, l: T) -> Result<(), EditError> { s.set_rest_length(j, l) }
    MassSpring::set_mass(s: &mut S<T>, i: usize, m: T) -> Result<(), EditError> { s.set_mass(i, m) }
    MassSpring::set_position(s: &mut S<T>, i: usize, x: V<T>) -> Result<(), EditError> { s.set_position(i, x) }
    MassSpring::set_velocity(s: &mut S<T>, i: usize, v: V<T>) -> Result<(), EditError> { s.set_velocity(i, v) }
    MassSpring::set_pin_velocity(s: &mut S<T>, i: usize, v: V<T>) -> Result<(), EditError> { s.set_pin_velocity(i, v) }
    MassSpring::impulse(s: &mut S<T>, i: usize, p: V<T>) -> Result<(), EditError> { s.impulse(i, p) }
}
