//! Islands at rest.

use hooke::{BlockJacobi, LinearlyImplicitEuler, Rest, Sleeping, Solver};

use crate::shared::*;

/// The rule with a memory, in borrowed slices.
type Borrowed<'a, T> = Sleeping<T, &'a mut [T], &'a mut [u32]>;
/// A method that does so about islands at rest.
type Sleepy<'a, T, Z> = LinearlyImplicitEuler<T, All<'a, T>, BlockJacobi, Z>;

crate::entry_point::entry_points! {
    Sleeping::needs(particles: usize, springs: usize, _unused: T) -> (usize, usize) {
        Sleeping::needs(particles, springs)
    }
    Sleeping::new<'a>(joules: T, numbers: &'a mut [T], words: &'a mut [u32]) -> Borrowed<'a, T> {
        Sleeping::new(joules, numbers, words)
    }
    LinearlyImplicitEuler::sleeping<'a>(euler: Euler<T>, sleep: Borrowed<'a, T>) -> LinearlyImplicitEuler<T, (), BlockJacobi, Borrowed<'a, T>> {
        euler.sleeping(sleep)
    }
    Solver::begin(solver: &mut BlockJacobi, _unused: T) { Solver::<T>::begin(solver) }
    MassSpring::step[rest](s: &mut S<T>, euler: &mut Sleepy<'_, T, Rest<T>>) -> Stepped<T> { s.step(euler) }
    MassSpring::step[sleeping](s: &mut S<T>, euler: &mut Sleepy<'_, T, Borrowed<'_, T>>) -> Stepped<T> {
        s.step(euler)
    }
    MassSpring::step[maybe_sleeping](
        s: &mut S<T>, euler: &mut Sleepy<'_, T, Option<&mut Borrowed<'_, T>>>,
    ) -> Stepped<T> {
        s.step(euler)
    }
}
