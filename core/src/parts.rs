//! A scene as slices: what the algorithms work on, whoever owns the memory.

use crate::force::Rows;
use crate::islands::{Island, Islands};
use crate::memory::{Memory, part, part_mut};
use crate::network::{Network, State};
use crate::real::Real;
use crate::scene::WorkLists;
use crate::vec3::Vec3;

/// All of a scene for one step, opaque: only this crate's integrators look inside.
pub struct Parts<'a, M: Memory> {
    pub(crate) network: &'a mut Network<M>,
    pub(crate) islands: &'a Islands<M>,
    pub(crate) work: &'a mut WorkLists<M>,
}

impl<M: Memory> Parts<'_, M> {
    /// The same for a while.
    pub(crate) fn reborrow(&mut self) -> Parts<'_, M> {
        Parts { network: self.network, islands: self.islands, work: self.work }
    }
}

/// One island of a scene: its rows of every list. Opaque, and named only here.
pub struct IslandParts<'a, T> {
    pub(crate) matrix: Matrix<'a, T>,
    pub(crate) vectors: Vectors<'a, T>,
    /// For the preconditioner
    pub(crate) block: &'a mut [[T; 6]],
    /// The particle of every slot from the island's first on, pins included
    pub(crate) particle: &'a [u32],
    /// Which springs the rows own
    pub(crate) spring: &'a [u32],
    /// How many of them end at a pin
    pub(crate) anchors: usize,
    /// Velocities of all pins over this step, and where the first of them is counted from the island's first slot
    pub(crate) pin_velocity: &'a [Vec3<T>],
    pub(crate) first_pin: usize,
}

/// The lists that A consists of.
pub(crate) struct Matrix<'a, T> {
    pub(crate) rows: Rows<'a, T>,
    /// M + θh D, one number per row
    pub(crate) inertia: &'a mut [T],
    /// How many springs each row owns
    pub(crate) own: &'a [u32],
    /// Their other ends: rows, or past the last row a pin
    pub(crate) other: &'a [u32],
    /// Their compressed Hessians
    pub(crate) hessian: &'a mut [[T; 4]],
}

/// The vectors of a solve, one entry per row. Opaque, and named only here.
pub struct Vectors<'a, T> {
    /// Right side; scratch after the solve
    pub(crate) b: &'a mut [Vec3<T>],
    /// Solution
    pub(crate) x: &'a mut [Vec3<T>],
    /// Residual
    pub(crate) r: &'a mut [Vec3<T>],
    /// Direction; at a check, δ
    pub(crate) p: &'a mut [Vec3<T>],
    /// A p; after that, z
    pub(crate) y: &'a mut [Vec3<T>],
    /// μ, A ⪰ diag(μ); for the solve 1/μ
    pub(crate) mu: &'a mut [T],
}

impl<M: Memory> Islands<M> {
    /// The rows of all islands together.
    pub(crate) fn all_rows<'a>(&'a self, state: &'a State<'a, M::Real>) -> Rows<'a, M::Real> {
        Rows { first: 0, particle: part(&self.particle, 0..self.free), state }
    }

    /// Island k; an empty one past the last.
    #[inline(always)]
    pub(crate) fn island<'a>(
        &'a self,
        k: usize,
        work: &'a mut WorkLists<M>,
        state: &'a State<'a, M::Real>,
    ) -> IslandParts<'a, M::Real> {
        let island = Island::unpack(self.islands().get(k).copied().unwrap_or_default());
        let Island { first, anchors, .. } = island;
        let (unknowns, pin_velocity) = work.x.split_at_mut_checked(self.free).unwrap_or_default();
        IslandParts {
            matrix: Matrix {
                rows: Rows { first, particle: part(&self.particle, island.slots()), state },
                inertia: part_mut(&mut work.inertia, island.slots()),
                own: part(&self.own, island.slots()),
                other: part(&self.other, island.springs()),
                hessian: part_mut(&mut work.hessian, island.springs()),
            },
            vectors: Vectors {
                b: part_mut(&mut work.b, island.slots()),
                x: part_mut(unknowns, island.slots()),
                r: part_mut(&mut work.r, island.slots()),
                p: part_mut(&mut work.p, island.slots()),
                y: part_mut(&mut work.y, island.slots()),
                mu: part_mut(&mut work.mu, island.slots()),
            },
            block: part_mut(&mut work.block, island.slots()),
            particle: self.particle.get(first..).unwrap_or_default(),
            spring: part(&self.spring, island.springs()),
            anchors,
            pin_velocity,
            // Whoever damages the lists of a scene in a buffer gets wrong numbers, not a panic.
            first_pin: self.free.saturating_sub(first),
        }
    }
}

impl<T: Real> IslandParts<'_, T> {
    /// q and q̇ at a slot counted from the island's first; of a pin its velocity over this step.
    #[inline]
    pub(crate) fn end(&self, local: usize) -> End<T> {
        let particle = self.particle.get(local).map_or(usize::MAX, |i| *i as usize);
        let velocity = match local.checked_sub(self.first_pin) {
            Some(pin) => self.pin_velocity.get(pin),
            None => self.matrix.rows.state.velocity.get(particle),
        };
        let value = |v: Option<&Vec3<T>>| v.copied().unwrap_or([T::ZERO; 3]);
        End { position: value(self.matrix.rows.state.position.get(particle)), velocity: value(velocity) }
    }
}

/// One end of a spring.
pub(crate) struct End<T> {
    pub(crate) position: Vec3<T>,
    pub(crate) velocity: Vec3<T>,
}
