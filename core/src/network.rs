//! The network: what a scene *is*. Particles (generalized coordinates q, velocities q̇, masses M, pins) and springs
//! (index pairs E_j, stiffness k, rest length l₀). Everything else in a scene is derived from this or scratch; a
//! snapshot is a copy of it.

use crate::memory::{self, List, Memory};
use crate::real::Real;
use crate::selection::{self, Ends, MARK};
use crate::spring::Spring;
use crate::vec3::Vec3;

/// The lists of a network, in the caller's numbering.
pub(crate) struct Network<M: Memory> {
    /// q, m
    pub(crate) position: M::Particles<[M::Real; 3]>,
    /// q̇, m/s
    pub(crate) velocity: M::Particles<[M::Real; 3]>,
    /// The diagonal of M, kg: M is block-diagonal, Mᵢ = mᵢ I₃
    pub(crate) mass: M::Particles<M::Real>,
    /// Where the particle's row is among the unknowns (derived), and in the top bit whether it is pinned (given)
    pub(crate) slot: M::Particles<u32>,
    /// (A, B), packed
    pub(crate) ends: M::Springs<[u32; 2]>,
    /// k, N/m
    pub(crate) stiffness: M::Springs<M::Real>,
    /// l₀, m
    pub(crate) rest_length: M::Springs<M::Real>,
}

/// A network whose lists are all made by the same expression (not a function: it must be usable in a `const fn` for any
/// owner of memory).
macro_rules! network {
    ($particles:expr, $springs:expr) => {
        Network {
            position: $particles,
            velocity: $particles,
            mass: $particles,
            slot: $particles,
            ends: $springs,
            stiffness: $springs,
            rest_length: $springs,
        }
    };
}
pub(crate) use network;

impl<M: Memory> Network<M> {
    /// A read-only view for the algorithms.
    pub(crate) fn state(&self) -> State<'_, M::Real> {
        State {
            position: &self.position,
            velocity: &self.velocity,
            mass: &self.mass,
            slot: &self.slot,
            ends: &self.ends,
            stiffness: &self.stiffness,
            rest_length: &self.rest_length,
        }
    }

    /// Copies all of `from`; `false` if it has more particles or springs than there is room for, and then no change.
    pub(crate) fn copy_from<N: Memory<Real = M::Real>>(&mut self, from: &Network<N>) -> bool {
        if from.mass.len() > self.mass.room() || from.ends.len() > self.ends.room() {
            return false;
        }
        memory::copy(&mut self.position, &from.position)
            && memory::copy(&mut self.velocity, &from.velocity)
            && memory::copy(&mut self.mass, &from.mass)
            && memory::copy(&mut self.slot, &from.slot)
            && memory::copy(&mut self.ends, &from.ends)
            && memory::copy(&mut self.stiffness, &from.stiffness)
            && memory::copy(&mut self.rest_length, &from.rest_length)
    }
}

/// A read-only view of particles and springs, whatever owns them.
#[derive(Debug, Clone, Copy)]
pub struct State<'a, T> {
    /// q, m
    pub position: &'a [Vec3<T>],
    /// q̇, m/s
    pub velocity: &'a [Vec3<T>],
    /// mᵢ, kg
    pub mass: &'a [T],
    pub(crate) slot: &'a [u32],
    pub(crate) ends: &'a [[u32; 2]],
    pub(crate) stiffness: &'a [T],
    pub(crate) rest_length: &'a [T],
}

impl<T: Real> State<'_, T> {
    /// Number of springs ever added, the broken ones included.
    pub fn springs(&self) -> usize {
        self.ends.len()
    }

    /// The constants of spring j; zeros out of range.
    #[inline(always)]
    pub fn spring(&self, j: usize) -> Spring<T> {
        match (self.stiffness.get(j), self.rest_length.get(j)) {
            (Some(k), Some(l0)) => Spring { stiffness: *k, rest_length: *l0 },
            _ => Spring { stiffness: T::ZERO, rest_length: T::ZERO },
        }
    }

    /// The pair (A, B) of spring j, or `None` if there is none or it is broken.
    pub fn ends(&self, j: usize) -> Option<(usize, usize)> {
        self.live(j).map(|ends| (ends.a, ends.b))
    }

    /// Is particle i pinned?
    pub fn is_pinned(&self, i: usize) -> bool {
        self.slot.get(i).is_some_and(|slot| slot & MARK != 0)
    }

    #[inline(always)]
    pub(crate) fn live(&self, j: usize) -> Option<Ends> {
        self.ends.get(j).map(|pair| Ends::unpack(*pair)).filter(|ends| !ends.broken)
    }

    /// Δx of a spring.
    #[inline(always)]
    pub(crate) fn delta(&self, ends: Ends) -> Vec3<T> {
        selection::difference(ends.a, ends.b, self.position)
    }
}
