//! P, b and the islands: which particles are unknowns, in what order, and which of them can be solved apart.
//!
//! q = Pᵀq̂ + b: P drops the pinned particles' rows, b holds their positions. P is never stored as a matrix; it is a
//! numbering. Free particles get *slots* 0, 1, …, grouped by island and ascending within it; pinned ones come after.
//! An island is a connected component over springs whose two ends are free (two ropes on one pin are two islands).
//!
//! A row *owns* the springs whose lower free end it is, in their order: island after island, row after row. A spring's
//! other end is a row further down, or a pin. So a product meets each row once, and every sum over springs has one
//! order, whatever order the springs were added in between. Springs between two pins belong to no row: nothing in a
//! step needs them.
//!
//! Everything of an island is contiguous, from its first particle, and its indices are local: {A, B} gives A the bits
//! of A alone. Cost: O(n + springs·log n) once after a change of pins or springs; no scratch: union–find and the
//! counting sorts run in the lists that they fill.

use core::ops::Range;

use crate::memory::{List, Memory, part, part_mut};
use crate::network::Network;
use crate::selection::{Ends, MARK};

/// The numbering: derived from a network, valid until its pins or springs change.
pub(crate) struct Islands<M: Memory> {
    /// Slot → particle
    pub(crate) particle: M::Particles<u32>,
    /// One entry per island; the first `count` are in use
    pub(crate) list: M::Particles<[u32; 5]>,
    /// How many springs each slot's row owns
    pub(crate) own: M::Particles<u32>,
    /// Where their other ends are: slots, counted from the island's first. What lies past its last row is a pin
    pub(crate) other: M::Springs<u32>,
    /// Which springs these are
    pub(crate) spring: M::Springs<u32>,
    /// Number of islands
    pub(crate) count: usize,
    /// Number of free particles
    pub(crate) free: usize,
    /// Number of springs with at least one free end
    pub(crate) edges: usize,
    /// Does the numbering belong to the network as it is?
    pub(crate) current: bool,
}

/// One island's place in the lists.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Island {
    pub(crate) first: usize,
    pub(crate) particles: usize,
    pub(crate) first_edge: usize,
    /// Springs that its rows own
    pub(crate) edges: usize,
    /// How many of these end at a pin
    pub(crate) anchors: usize,
}

/// Which words of an island's entry count what.
const PARTICLES: usize = 1;
const EDGES: usize = 3;
const ANCHORS: usize = 4;

impl Island {
    pub(crate) fn unpack(words: [u32; 5]) -> Self {
        let [first, particles, first_edge, edges, anchors] = words.map(|word| word as usize);
        Self { first, particles, first_edge, edges, anchors }
    }

    /// Its slots.
    #[inline(always)]
    pub(crate) fn slots(&self) -> Range<usize> {
        self.first..self.first + self.particles
    }

    /// Where its springs are.
    #[inline(always)]
    pub(crate) fn springs(&self) -> Range<usize> {
        self.first_edge..self.first_edge + self.edges
    }
}

impl<M: Memory> Islands<M> {
    /// Renews the numbering from the network's pins and springs.
    pub(crate) fn renew(&mut self, network: &mut Network<M>) {
        let slot: &mut [u32] = &mut network.slot;
        let springs: &[[u32; 2]] = &network.ends;
        connect(slot, springs);
        let islands = name_islands(slot, &mut self.particle, &mut self.list);
        let list = part_mut(&mut self.list, 0..islands);
        let (free, edges) = count(slot, springs, list);
        place_particles(slot, list, free, &mut self.particle);
        place_springs(slot, springs, &mut self.own, &mut self.other, &mut self.spring);
        localise(list, &mut self.other);
        self.count = islands;
        self.free = free as usize;
        self.edges = edges as usize;
        self.current = true;
    }

    pub(crate) fn islands(&self) -> &[[u32; 5]] {
        part(&self.list, 0..self.count)
    }

    /// Room for one more particle in the derived lists.
    pub(crate) fn push_particle(&mut self) -> bool {
        self.particle.push(0) && self.list.push([0; 5]) && self.own.push(0)
    }

    /// Room for one more spring in the derived lists.
    pub(crate) fn push_spring(&mut self) -> bool {
        self.other.push(0) && self.spring.push(0)
    }
}

/// Union–find over free particles: afterwards following slot[i] leads to the smallest particle of i's island. Pinned
/// particles hold only [`MARK`].
fn connect(slot: &mut [u32], springs: &[[u32; 2]]) {
    for (i, parent) in slot.iter_mut().enumerate() {
        *parent = if *parent & MARK != 0 { MARK } else { i as u32 };
    }
    for pair in springs {
        let e = Ends::unpack(*pair);
        if !e.broken && get(slot, e.a) != MARK && get(slot, e.b) != MARK {
            let (a, b) = (root(slot, e.a as u32), root(slot, e.b as u32));
            let (low, high) = if a < b { (a, b) } else { (b, a) };
            set(slot, high as usize, low);
        }
    }
}

/// Numbers the islands by their first particle; slot[i] becomes the island of i. `of_root` is scratch. Answers how many
/// there are.
fn name_islands(slot: &mut [u32], of_root: &mut [u32], list: &mut [[u32; 5]]) -> usize {
    let mut islands = 0;
    for i in 0..slot.len() as u32 {
        if get(slot, i as usize) != MARK && root(slot, i) == i {
            set(of_root, i as usize, islands);
            set(list, islands as usize, [0; 5]);
            islands += 1;
        }
    }
    // Downwards: the way from i to its root passes only smaller particles, whose parents still stand.
    for i in (0..slot.len() as u32).rev() {
        if get(slot, i as usize) != MARK {
            let island = get(of_root, root(slot, i) as usize);
            set(slot, i as usize, island);
        }
    }
    islands as usize
}

/// Counts each island's particles and springs and turns the counts into places; that of the particles is left at 0, to
/// be counted up again while filling in. slot[i] must be the island of i. Answers the totals.
fn count(slot: &[u32], springs: &[[u32; 2]], list: &mut [[u32; 5]]) -> (u32, u32) {
    for k in slot.iter().filter(|k| **k != MARK) {
        next(list, *k, PARTICLES);
    }
    for pair in springs {
        if let Some((k, anchored)) = owner(slot, *pair) {
            next(list, k, EDGES);
            if anchored & MARK != 0 {
                next(list, k, ANCHORS);
            }
        }
    }
    let (mut first, mut first_edge) = (0, 0);
    for island in list {
        let [_, particles, _, edges, anchors] = *island;
        *island = [first, 0, first_edge, edges, anchors];
        first += particles;
        first_edge += edges;
    }
    (first, first_edge)
}

/// Slots: free particles by island and ascending, then the pinned ones.
fn place_particles(slot: &mut [u32], list: &mut [[u32; 5]], free: u32, particle: &mut [u32]) {
    let mut pinned = free;
    for (i, slot) in slot.iter_mut().enumerate() {
        let (place, mark) = if *slot == MARK {
            pinned += 1;
            (pinned - 1, MARK)
        } else {
            let within = next(list, *slot, PARTICLES);
            (list.get(*slot as usize).map_or(0, |island| island[0]) + within, 0)
        };
        set(particle, place as usize, i as u32);
        *slot = place | mark;
    }
}

/// Places the springs by the row that owns them, in their order: a counting sort. Other ends are still whole slots.
fn place_springs(slot: &[u32], springs: &[[u32; 2]], own: &mut [u32], other: &mut [u32], spring: &mut [u32]) {
    own.fill(0);
    for pair in springs {
        if let Some((row, _)) = owner(slot, *pair) {
            set(own, row as usize, get(own, row as usize) + 1);
        }
    }
    let mut first = 0;
    for own in own.iter_mut() {
        (*own, first) = (first, first + *own);
    }
    for (j, pair) in springs.iter().enumerate() {
        if let Some((row, far)) = owner(slot, *pair) {
            let place = get(own, row as usize);
            set(other, place as usize, far & !MARK);
            set(spring, place as usize, j as u32);
            set(own, row as usize, place + 1);
        }
    }
    // What is left are the rows' ends: back to counts.
    let mut before = 0;
    for own in own.iter_mut() {
        (*own, before) = (*own - before, *own);
    }
}

/// Other ends count from the first slot of the island.
fn localise(list: &[[u32; 5]], other: &mut [u32]) {
    for words in list {
        let island = Island::unpack(*words);
        for far in part_mut(other, island.springs()) {
            // An end that a damaged buffer says is no particle is no slot either, nor any place that a slot could have.
            *far = far.wrapping_sub(words[0]);
        }
    }
}

/// Which end of a spring owns it, and the other end: what `slot` says of them, the lower one first if both are free;
/// `None` if the spring is broken or both ends are pinned.
fn owner(slot: &[u32], pair: [u32; 2]) -> Option<(u32, u32)> {
    let e = Ends::unpack(pair);
    let (a, b) = (get(slot, e.a), get(slot, e.b));
    let (low, high) = if a < b { (a, b) } else { (b, a) };
    (!e.broken && low & MARK == 0).then_some((low, high))
}

/// The root of i's tree, which is the tree's smallest index; halves the path on the way.
fn root(parent: &mut [u32], mut i: u32) -> u32 {
    while let Some(&up) = parent.get(i as usize) {
        if up == i {
            break;
        }
        let above = get(parent, up as usize);
        set(parent, i as usize, above);
        i = above;
    }
    i
}

/// Adds one to a count of island k and answers what it was.
fn next(list: &mut [[u32; 5]], k: u32, field: usize) -> u32 {
    match list.get_mut(k as usize).and_then(|island| island.get_mut(field)) {
        Some(n) => {
            *n += 1;
            *n - 1
        }
        None => 0,
    }
}

fn set<X>(list: &mut [X], i: usize, value: X) {
    if let Some(place) = list.get_mut(i) {
        *place = value;
    }
}

fn get(list: &[u32], i: usize) -> u32 {
    list.get(i).copied().unwrap_or(MARK)
}
