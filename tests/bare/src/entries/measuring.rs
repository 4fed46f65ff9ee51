//! Reading a scene: energies, tensions, momenta, reactions, forces and stiffness.

use hooke::{Energies, Hessian, Mixed, Spring, State};

use crate::shared::*;

/// Energies of a scene with cables.
type E<'a, T> = Energies<'a, T, Mixed>;

crate::entry_point::entry_points! {
    MassSpring::state(s: &S<T>) -> State<'_, T> { s.state() }
    MassSpring::springs(s: &S<T>) -> E<'_, T> { s.springs() }
    MassSpring::positions(s: &S<T>) -> &[V<T>] { s.positions() }
    MassSpring::velocities(s: &S<T>) -> &[V<T>] { s.velocities() }
    MassSpring::islands(s: &mut S<T>) -> usize { s.islands() }
    MassSpring::free_particles(s: &mut S<T>) -> usize { s.free_particles() }
    MassSpring::reaction(s: &S<T>, i: usize, forces: &All<'_, T>) -> Option<V<T>> { s.reaction(i, forces) }

    State::springs(state: &State<'_, T>) -> usize { state.springs() }
    State::spring(state: &State<'_, T>, j: usize) -> Spring<T> { state.spring(j) }
    State::ends(state: &State<'_, T>, j: usize) -> Option<(usize, usize)> { state.ends(j) }
    State::is_pinned(state: &State<'_, T>, i: usize) -> bool { state.is_pinned(i) }
    State::linear_momentum(state: &State<'_, T>) -> V<T> { state.linear_momentum() }
    State::angular_momentum(state: &State<'_, T>) -> V<T> { state.angular_momentum() }
    State::centre_of_mass(state: &State<'_, T>) -> V<T> { state.centre_of_mass() }

    Energies::kinetic_energy_of(e: &E<'_, T>, i: usize) -> T { e.kinetic_energy_of(i) }
    Energies::kinetic_energy(e: &E<'_, T>) -> T { e.kinetic_energy() }
    Energies::potential_energy_of(e: &E<'_, T>, j: usize) -> T { e.potential_energy_of(j) }
    Energies::potential_energy(e: &E<'_, T>) -> T { e.potential_energy() }
    Energies::lagrangian(e: &E<'_, T>) -> T { e.lagrangian() }
    Energies::tension_of(e: &E<'_, T>, j: usize) -> T { e.tension_of(j) }
    Energies::strain_of(e: &E<'_, T>, j: usize) -> Option<T> { e.strain_of(j) }
    Energies::stretch_factor_of(e: &E<'_, T>, j: usize) -> Option<T> { e.stretch_factor_of(j) }
    Energies::length_of(e: &E<'_, T>, j: usize) -> Option<T> { e.length_of(j) }
    Energies::add_force(e: &E<'_, T>, f: &mut [V<T>]) { e.add_force(f) }
    Energies::stiffness_product(e: &E<'_, T>, x: &[V<T>], y: &mut [V<T>]) { e.stiffness_product(x, y) }
    Energies::stiffness_blocks(e: &E<'_, T>, sum: &mut T) {
        e.stiffness_blocks(|row, column, block| *sum += block[0][0] * (row + column) as T)
    }
    Energies::hessian_of(e: &E<'_, T>, j: usize) -> Option<Hessian<T>> { e.hessian_of(j) }
}
