//! P, b and the islands: which particles are unknowns, in what order, and which of them can be solved apart.
//!
//! q = Pᵀq̂ + b: P drops the pinned particles' rows, b holds their positions. P is never stored as a matrix; it is a
//! numbering. Free particles get *slots* 0, 1, …, grouped by island and ascending within it; pinned ones come after.
//! An island is a connected component over springs whose two ends are free (two ropes on one pin are two islands).
//! Its springs are *pairs* (both ends free) and *anchors* (the other end pinned); springs between two pinned particles
//! belong to no island: nothing in a step needs them.
//!
//! Everything of an island is contiguous, from its first particle, and its indices are local: {A, B} gives A the bits
//! of A alone. Cost: O(n + springs·log n) once after a change of pins or springs; no scratch (union–find runs in the
//! lists that it fills).

use crate::memory::{List, Memory, part};
use crate::network::Network;
use crate::selection::{Ends, MARK};

/// The numbering: derived from a network, valid until its pins or springs change.
pub(crate) struct Islands<M: Memory> {
    /// Slot → particle
    pub(crate) particle: M::Particles<u32>,
    /// One entry per island; the first `count` are in use
    pub(crate) list: M::Particles<[u32; 5]>,
    /// Local ends of the islands' springs: for pairs (a, b), a < b, both local slots; for anchors (local slot, slot of
    /// the pinned particle)
    pub(crate) ends: M::Springs<[u32; 2]>,
    /// The spring's own index
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Island {
    pub(crate) first: usize,
    pub(crate) particles: usize,
    pub(crate) first_edge: usize,
    pub(crate) pairs: usize,
    pub(crate) anchors: usize,
}

impl Island {
    pub(crate) fn unpack(words: [u32; 5]) -> Self {
        let [first, particles, first_edge, pairs, anchors] = words.map(|word| word as usize);
        Self { first, particles, first_edge, pairs, anchors }
    }
}

/// The root of i's tree; halves the path on the way. Roots are the smallest index of their tree.
fn root(parent: &mut [u32], mut i: u32) -> u32 {
    while let Some(&up) = parent.get(i as usize) {
        if up == i {
            break;
        }
        let above = parent.get(up as usize).copied().unwrap_or(up);
        if let Some(place) = parent.get_mut(i as usize) {
            *place = above;
        }
        i = above;
    }
    i
}

fn set<X>(list: &mut [X], i: usize, value: X) {
    if let Some(place) = list.get_mut(i) {
        *place = value;
    }
}

fn get(list: &[u32], i: usize) -> u32 {
    list.get(i).copied().unwrap_or(MARK)
}

/// Which fields of an island's entry count what.
const PARTICLES: usize = 1;
const PAIRS: usize = 3;
const ANCHORS: usize = 4;

/// Adds one to a field of island k and returns what it was.
fn count(list: &mut [[u32; 5]], k: u32, field: usize) -> u32 {
    match list.get_mut(k as usize).and_then(|island| island.get_mut(field)) {
        Some(n) => {
            *n += 1;
            *n - 1
        }
        None => 0,
    }
}

impl<M: Memory> Islands<M> {
    /// Renews the numbering from the network's pins and springs.
    pub(crate) fn renew(&mut self, network: &mut Network<M>) {
        let Self { particle, list, ends, spring, .. } = self;
        let slot: &mut [u32] = &mut network.slot;
        let (particle, list): (&mut [u32], &mut [[u32; 5]]) = (particle, list);
        let (edge_ends, edge_spring): (&mut [[u32; 2]], &mut [u32]) = (ends, spring);
        let springs: &[[u32; 2]] = &network.ends;
        let n = slot.len() as u32;

        // Union–find over free particles; while it runs, the parent of i is slot[i], and pinned ones keep only MARK.
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

        // Islands are numbered by their first particle; a root is met before the rest of its tree. From here on
        // slot[i] is the island of i; `particle` holds the island of each root meanwhile.
        let mut islands = 0;
        for i in 0..n {
            if get(slot, i as usize) == MARK {
                continue;
            }
            let r = root(slot, i);
            if r == i {
                set(particle, i as usize, islands);
                set(list, islands as usize, [0; 5]);
                islands += 1;
            }
        }
        for i in 0..n {
            if get(slot, i as usize) != MARK {
                let r = root(slot, i);
                // Roots are written last of all below, so that the trees above them stay readable.
                count(list, get(particle, r as usize), PARTICLES);
            }
        }
        for i in (0..n).rev() {
            if get(slot, i as usize) != MARK {
                let r = root(slot, i);
                let island = get(particle, r as usize);
                set(slot, i as usize, island);
            }
        }
        let island_of = |slot: &[u32], pair: [u32; 2]| {
            let e = Ends::unpack(pair);
            let (a, b) = (get(slot, e.a), get(slot, e.b));
            match (e.broken, a == MARK, b == MARK) {
                (false, false, false) => Some((a, PAIRS)),
                (false, false, true) => Some((a, ANCHORS)),
                (false, true, false) => Some((b, ANCHORS)),
                _ => None,
            }
        };
        for pair in springs {
            if let Some((k, field)) = island_of(slot, *pair) {
                count(list, k, field);
            }
        }

        // Counts to places; then count up again while filling in.
        let (mut first, mut first_edge) = (0, 0);
        for island in list.iter_mut().take(islands as usize) {
            let [_, particles, _, pairs, anchors] = *island;
            *island = [first, 0, first_edge, 0, 0];
            first += particles;
            first_edge += pairs + anchors;
        }
        for wanted in [PAIRS, ANCHORS] {
            for (j, pair) in springs.iter().enumerate() {
                let Some((k, field)) = island_of(slot, *pair).filter(|(_, field)| *field == wanted) else {
                    continue;
                };
                let within = count(list, k, field);
                let Some(island) = list.get(k as usize).map(|words| Island::unpack(*words)) else { continue };
                let before = if wanted == ANCHORS { island.pairs } else { 0 };
                let place = island.first_edge + before + within as usize;
                let e = Ends::unpack(*pair);
                let local = if get(slot, e.a) == MARK { [e.b, e.a] } else { [e.a, e.b] };
                set(edge_ends, place, local.map(|i| i as u32));
                set(edge_spring, place, j as u32);
            }
        }
        let mut pinned = first;
        for i in 0..n {
            let k = get(slot, i as usize);
            let place = if k == MARK {
                pinned += 1;
                pinned - 1
            } else {
                let within = count(list, k, PARTICLES);
                list.get(k as usize).map_or(0, |island| island[0]) + within
            };
            set(particle, place as usize, i);
            set(slot, i as usize, if k == MARK { place | MARK } else { place });
        }

        // Ends were particles so far; make them local slots.
        for words in list.iter().take(islands as usize) {
            let island = Island::unpack(*words);
            let edges = island.pairs + island.anchors;
            let range = crate::memory::part_mut(edge_ends, island.first_edge, edges);
            for (e, ends) in range.iter_mut().enumerate() {
                let [a, b] = ends.map(|i| get(slot, i as usize) & !MARK);
                let a = a - words[0];
                *ends = if e < island.pairs {
                    let b = b - words[0];
                    if a < b { [a, b] } else { [b, a] }
                } else {
                    [a, b]
                };
            }
        }
        self.count = islands as usize;
        self.free = first as usize;
        self.edges = first_edge as usize;
        self.current = true;
    }

    pub(crate) fn islands(&self) -> &[[u32; 5]] {
        part(&self.list, 0, self.count)
    }

    /// Room for one more particle or spring in the derived lists.
    pub(crate) fn push_particle(&mut self) -> bool {
        self.particle.push(0) && self.list.push([0; 5])
    }

    pub(crate) fn push_spring(&mut self) -> bool {
        self.ends.push([0; 2]) && self.spring.push(0)
    }
}
