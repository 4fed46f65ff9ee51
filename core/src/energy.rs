//! T, V and L: kinetic energy, potential energy and the Lagrangian, per particle, per spring and in total.
//!
//! T = ½ q̇ᵀMq̇ = Σ ½ mᵢ|q̇ᵢ|², V = Σ ½ k(l − l₀)², L = T − V; joules. M is block-diagonal, Mᵢ = mᵢI₃, so it is kept as
//! one number per particle. V is of positions only, unchanged by rigid motion, and least at l = l₀. Sums run in order.
//!
//! Source: the mass-spring lecture (variational mechanics). Cost: O(particles), O(springs); nothing is kept.

use core::marker::PhantomData;

use crate::law::Law;
use crate::network::State;
use crate::real::Real;
use crate::selection::Ends;
use crate::spring::{Spring, Stretched};
use crate::vec3;

/// A view of a state that knows its law: what energies and tensions are computed from.
pub struct Energies<'a, T, L> {
    pub(crate) state: State<'a, T>,
    pub(crate) law: PhantomData<L>,
}

impl<T: Real, L: Law> Energies<'_, T, L> {
    /// ½ mᵢ|q̇ᵢ|², J; 0 out of range.
    pub fn kinetic_energy_of(&self, particle: usize) -> T {
        match (self.state.mass.get(particle), self.state.velocity.get(particle)) {
            (Some(m), Some(v)) => T::HALF * *m * vec3::dot(*v, *v),
            _ => T::ZERO,
        }
    }

    /// T, J
    pub fn kinetic_energy(&self) -> T {
        (0..self.state.mass.len()).fold(T::ZERO, |sum, i| sum + self.kinetic_energy_of(i))
    }

    /// V_j, J; 0 for a slack cable, a broken spring, or out of range.
    pub fn potential_energy_of(&self, spring: usize) -> T {
        match self.loaded(spring) {
            Some((spring, stretched)) => spring.potential_energy(stretched.length),
            None => T::ZERO,
        }
    }

    /// V of all springs, J
    pub fn potential_energy(&self) -> T {
        (0..self.state.springs()).fold(T::ZERO, |sum, j| sum + self.potential_energy_of(j))
    }

    /// L = T − V, J (of the springs; a force's own potential is its `potential_energy`)
    pub fn lagrangian(&self) -> T {
        self.kinetic_energy() - self.potential_energy()
    }

    /// Tension k(l − l₀) of a spring, N: positive pulls. 0 for a slack cable, a broken spring, or out of range.
    pub fn tension_of(&self, spring: usize) -> T {
        match self.loaded(spring) {
            Some((spring, stretched)) => spring.tension(stretched.length),
            None => T::ZERO,
        }
    }

    /// The constants and the stretch of a spring that carries: neither broken nor slack.
    pub(crate) fn loaded(&self, j: usize) -> Option<(Spring<T>, Stretched<T>)> {
        let ends = self.state.live(j)?;
        let spring = self.state.spring(j);
        let stretched = self.stretched(ends);
        let slack = L::slackens(ends.cable) && stretched.length < spring.rest_length;
        if slack { None } else { Some((spring, stretched)) }
    }

    fn stretched(&self, ends: Ends) -> Stretched<T> {
        Stretched::new(self.state.delta(ends))
    }

    /// Strain l − l₀ of a spring, m: positive where it is stretched; `None` if it is broken or out of range.
    pub fn strain_of(&self, spring: usize) -> Option<T> {
        Some(self.length_of(spring)? - self.state.spring(spring).rest_length)
    }

    /// Stretch factor σ = 1 − l₀/l < 1 of a spring; `None` if it is broken, of length 0, or out of range.
    pub fn stretch_factor_of(&self, spring: usize) -> Option<T> {
        let length = self.length_of(spring).filter(|length| *length > T::ZERO)?;
        Some((length - self.state.spring(spring).rest_length) / length)
    }

    /// Length l of a spring, m; `None` if it is broken or out of range.
    pub fn length_of(&self, spring: usize) -> Option<T> {
        Some(self.stretched(self.state.live(spring)?).length)
    }
}
