//! The reaction at a pin: minus the sum of all forces on the pinned particle, the rows of f that P drops.
//!
//! R_i = −(Σ_j ±(tension + c l̇)u + m g + …) at the present q, q̇. On demand: a step does not pay for it. For a scene at
//! rest the reactions add up to its weight.

use crate::energy::Energies;
use crate::force::{Force, Rows};
use crate::law::Law;
use crate::real::Real;
use crate::selection;
use crate::vec3::{self, Vec3};

pub(crate) fn reaction<T: Real, L: Law, F: Force<T>>(
    springs: &Energies<'_, T, L>,
    i: usize,
    forces: &F,
) -> Option<Vec3<T>> {
    let state = springs.state;
    let (mass, v) = (*state.mass.get(i)?, *state.velocity.get(i)?);
    let slot = (*state.slot.get(i)? & !selection::MARK) as usize;
    let mut f = [[T::ZERO; 3]];
    let particle = [i as u32];
    forces.add(&Rows { first: slot, particle: &particle, state: &state }, &mut f);
    let [mut f] = f;
    if F::DRAGS {
        f = vec3::add_scaled(f, -forces.drag(i, mass), v);
    }
    for j in 0..state.springs() {
        let (Some(ends), Some((spring, stretched))) = (state.live(j), springs.loaded(j)) else { continue };
        let toward = match (ends.a == i, ends.b == i) {
            (true, false) => -T::ONE,
            (false, true) => T::ONE,
            _ => continue,
        };
        let mut pull = spring.tension(stretched.length);
        if F::DAMPS {
            let rate = vec3::dot(selection::difference(ends.a, ends.b, state.velocity), stretched.direction);
            pull += forces.damping(j) * rate;
        }
        f = vec3::add_scaled(f, toward * pull, stretched.direction);
    }
    Some(vec3::scale(-T::ONE, f))
}
