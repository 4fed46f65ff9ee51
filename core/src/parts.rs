//! A scene as slices: what the algorithms work on, whoever owns the memory.

use core::marker::PhantomData;

use crate::force::Rows;
use crate::islands::Island;
use crate::memory::{part, part_mut};
use crate::network::State;
use crate::real::Real;
use crate::vec3::Vec3;

/// All of a scene for one step, opaque: only this crate's integrators look inside.
pub struct Parts<'a, T, L> {
    pub(crate) position: &'a mut [Vec3<T>],
    pub(crate) velocity: &'a mut [Vec3<T>],
    pub(crate) mass: &'a [T],
    pub(crate) slot: &'a [u32],
    pub(crate) spring_ends: &'a [[u32; 2]],
    pub(crate) stiffness: &'a [T],
    pub(crate) rest_length: &'a [T],
    /// Slot → particle
    pub(crate) particle: &'a [u32],
    pub(crate) islands: &'a [[u32; 5]],
    /// Local ends of the islands' springs, and which springs these are
    pub(crate) ends: &'a [[u32; 2]],
    pub(crate) spring: &'a [u32],
    /// How many slots are unknowns
    pub(crate) free: usize,
    pub(crate) edges: usize,
    /// Change of velocity of the unknowns; behind them the velocities of the pins over this step
    pub(crate) x: &'a mut [Vec3<T>],
    pub(crate) work: Work<'a, T>,
    pub(crate) law: PhantomData<L>,
}

/// The solver's own lists, one entry per slot (the Hessians: per island spring).
pub(crate) struct Work<'a, T> {
    pub(crate) r: &'a mut [Vec3<T>],
    pub(crate) b: &'a mut [Vec3<T>],
    pub(crate) p: &'a mut [Vec3<T>],
    pub(crate) y: &'a mut [Vec3<T>],
    pub(crate) inertia: &'a mut [T],
    pub(crate) mu: &'a mut [T],
    pub(crate) block: &'a mut [[T; 6]],
    pub(crate) hessian: &'a mut [[T; 4]],
}

impl<T> Work<'_, T> {
    /// So many rows and springs of every list.
    fn part(&mut self, first: usize, n: usize, first_edge: usize, edges: usize) -> Work<'_, T> {
        Work {
            r: part_mut(self.r, first, n),
            b: part_mut(self.b, first, n),
            p: part_mut(self.p, first, n),
            y: part_mut(self.y, first, n),
            inertia: part_mut(self.inertia, first, n),
            mu: part_mut(self.mu, first, n),
            block: part_mut(self.block, first, n),
            hessian: part_mut(self.hessian, first_edge, edges),
        }
    }
}

/// One island of a scene: its rows of every list.
pub(crate) struct IslandParts<'a, T> {
    pub(crate) rows: Rows<'a, T>,
    /// Local ends: pairs first, then anchors
    pub(crate) pairs: &'a [[u32; 2]],
    pub(crate) anchors: &'a [[u32; 2]],
    /// Which springs these are
    pub(crate) spring: &'a [u32],
    pub(crate) x: &'a mut [Vec3<T>],
    /// Velocities of all pins over this step, by slot after the last unknown
    pub(crate) pin_velocity: &'a [Vec3<T>],
    pub(crate) free: usize,
    /// The particle of every slot, pins included
    pub(crate) particle: &'a [u32],
    pub(crate) work: Work<'a, T>,
}

/// One spring of an island.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Edge {
    /// Which spring
    pub(crate) spring: usize,
    /// Row of its first end
    pub(crate) row: usize,
    /// Its other end
    pub(crate) other: Other,
    /// The two ends as particles
    pub(crate) a: usize,
    pub(crate) b: usize,
}

/// Where the other end of an island's spring is.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Other {
    /// A row of the same island
    Row(usize),
    /// A pin, by slot
    Pin(usize),
}

impl<'a, T: Real> IslandParts<'a, T> {
    /// The island's springs in the order of its lists: pairs, then anchors.
    #[inline(always)]
    pub(crate) fn edges(&self) -> impl Iterator<Item = Edge> + Clone + use<'a, T> {
        let (mine, all) = (self.rows.particle, self.particle);
        let of =
            |particles: &[u32], slot: u32| particles.get(slot as usize).map_or(usize::MAX, |i| *i as usize);
        let pairs = self.pairs.iter().map(move |&[a, b]| (a, Other::Row(b as usize), of(mine, b)));
        let anchors = self.anchors.iter().map(move |&[a, b]| (a, Other::Pin(b as usize), of(all, b)));
        let ends = pairs.chain(anchors).zip(self.spring);
        ends.map(move |((a, other, b), spring)| Edge {
            spring: *spring as usize,
            row: a as usize,
            other,
            a: of(mine, a),
            b,
        })
    }
}

impl<T: Real, L> Parts<'_, T, L> {
    /// The rows of all islands together.
    pub(crate) fn all_rows(&mut self) -> (Rows<'_, T>, Work<'_, T>) {
        let free = self.free;
        let Self {
            position, velocity, mass, slot, spring_ends, stiffness, rest_length, particle, work, ..
        } = self;
        let state = State { position, velocity, mass, slot, ends: spring_ends, stiffness, rest_length };
        let rows = Rows { first: 0, particle: part(particle, 0, free), state };
        (rows, work.part(0, free, 0, 0))
    }

    /// Island k, or `None` past the last.
    pub(crate) fn island(&mut self, k: usize) -> Option<IslandParts<'_, T>> {
        let island = Island::unpack(*self.islands.get(k)?);
        let Island { first, particles: n, first_edge, pairs, anchors } = island;
        let edges = pairs + anchors;
        let state = State {
            position: self.position,
            velocity: self.velocity,
            mass: self.mass,
            slot: self.slot,
            ends: self.spring_ends,
            stiffness: self.stiffness,
            rest_length: self.rest_length,
        };
        let (unknowns, pin_velocity) = self.x.split_at_mut_checked(self.free)?;
        Some(IslandParts {
            rows: Rows { first, particle: part(self.particle, first, n), state },
            pairs: part(self.ends, first_edge, pairs),
            anchors: part(self.ends, first_edge + pairs, anchors),
            spring: part(self.spring, first_edge, edges),
            x: part_mut(unknowns, first, n),
            pin_velocity,
            free: self.free,
            particle: self.particle,
            work: self.work.part(first, n, first_edge, edges),
        })
    }
}
