//! Where a level's edges lie. An edge joins rows a < b; edges of one offset b − a and consecutive a form a *run*: tiles of
//! eight slots (a, a + d), (a + 1, a + 1 + d), …, a slot without an edge holding zeros. A run needs no indices and is read
//! in order. Runs that would be more than half empty are *loose* instead: tiles of any eight edges, with their ends. A
//! cloth has a few runs on every level; a bunny is mostly loose.
//!
//! Several edges between the same two rows share a slot, so the number of slots is at most twice that of edges, and 7.

use super::tile::WIDTH;
use super::words::{NONE, get, set};

/// The largest gap inside a run: what it takes to step over the end of a grid's line.
const GAP: u32 = 4;

/// A run: first row, offset, number of tiles.
pub(super) type Run = [u32; 3];

/// How much room an arrangement takes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Extent {
    /// Number of runs.
    pub(super) runs: usize,
    /// Tiles in runs; they come first.
    pub(super) run_tiles: usize,
    /// All tiles.
    pub(super) tiles: usize,
}

/// Sorts edges (`a`, `b`) with a < b < rows, those with NONE left out, by offset and then a: two counting sorts, each O(edges
/// + rows). The sorted list comes in `order`.
pub(super) fn sort<'o>(
    rows: usize,
    ends: [&[u32]; 2],
    order: &'o mut [u32],
    other: &mut [u32],
    count: &mut [u32],
) -> &'o [u32] {
    let [a, b] = ends;
    let mut edges = 0;
    for (edge, _) in a.iter().enumerate().filter(|(_, a)| **a != NONE) {
        set(order, edges, edge as u32);
        edges += 1;
    }
    let count = count.get_mut(..rows + 1).unwrap_or_default();
    let (order, other) =
        (order.get_mut(..edges).unwrap_or_default(), other.get_mut(..edges).unwrap_or_default());
    counting_sort(order, other, count, |edge| get(a, edge as usize));
    counting_sort(other, order, count, |edge| get(b, edge as usize).wrapping_sub(get(a, edge as usize)));
    order
}

fn counting_sort(from: &[u32], to: &mut [u32], count: &mut [u32], key: impl Fn(u32) -> u32) {
    count.fill(0);
    for edge in from {
        let key = key(*edge) as usize;
        set(count, key, get(count, key).wrapping_add(1));
    }
    let mut first = 0;
    for count in count.iter_mut() {
        (*count, first) = (first, first + *count);
    }
    for edge in from {
        let key = key(*edge) as usize;
        let place = get(count, key);
        set(to, place as usize, *edge);
        set(count, key, place.wrapping_add(1));
    }
}

/// A stretch of sorted edges of one offset without large gaps.
struct Stretch<'s> {
    edges: &'s [u32],
    first: u32,
    offset: u32,
    /// Number of tiles if it is to be a run.
    run: Option<usize>,
    /// Number of pairs of rows
    pairs: usize,
}

fn stretches(ends: [&[u32]; 2], mut sorted: &[u32], mut visit: impl FnMut(&Stretch<'_>)) {
    let [a, b] = ends;
    let key = |edge: u32| {
        let (a, b) = (get(a, edge as usize), get(b, edge as usize));
        (a, b.wrapping_sub(a))
    };
    while let Some(edge) = sorted.first() {
        let (first, offset) = key(*edge);
        let (mut last, mut pairs, mut edges) = (first, 1, 0);
        for edge in sorted {
            let (a, d) = key(*edge);
            if d != offset || a > last.saturating_add(GAP) {
                break;
            }
            pairs += usize::from(a != last);
            (last, edges) = (a, edges + 1);
        }
        let (stretch, rest) = sorted.split_at_checked(edges).unwrap_or_default();
        let tiles = ((last - first) as usize + WIDTH) / WIDTH;
        let run = (2 * pairs >= WIDTH * tiles).then_some(tiles);
        visit(&Stretch { edges: stretch, first, offset, run, pairs });
        sorted = rest;
    }
}

/// How much room the sorted edges take.
pub(super) fn extent(ends: [&[u32]; 2], sorted: &[u32]) -> Extent {
    let (mut extent, mut loose) = (Extent::default(), 0);
    stretches(ends, sorted, |stretch| match stretch.run {
        Some(tiles) => {
            extent.runs += 1;
            extent.run_tiles += tiles;
        }
        None => loose += stretch.pairs,
    });
    extent.tiles = extent.run_tiles + loose.div_ceil(WIDTH);
    extent
}

/// Gives every sorted edge its slot, and writes the runs and the ends of every slot (NONE: empty).
pub(super) fn arrange(
    ends: [&[u32]; 2],
    sorted: &[u32],
    extent: Extent,
    slot_of: &mut [u32],
    runs: &mut [u32],
    slot_ends: [&mut [u32]; 2],
) {
    let [a, b] = ends;
    let [slot_a, slot_b] = slot_ends;
    slot_of.fill(NONE);
    slot_a.fill(NONE);
    slot_b.fill(NONE);
    let mut runs = runs.as_chunks_mut::<3>().0.iter_mut();
    let (mut next_tile, mut next_loose) = (0, extent.run_tiles * WIDTH);
    stretches(ends, sorted, |stretch| {
        if let (Some(tiles), Some(run)) = (stretch.run, stretch.run.and_then(|_| runs.next())) {
            *run = [stretch.first, stretch.offset, tiles as u32];
        }
        let mut before = NONE;
        for edge in stretch.edges {
            let edge = *edge as usize;
            let (a, b) = (get(a, edge), get(b, edge));
            let slot = match stretch.run {
                Some(_) => next_tile * WIDTH + (a - stretch.first) as usize,
                None => {
                    next_loose += usize::from(a != before);
                    next_loose - 1
                }
            };
            before = a;
            set(slot_of, edge, slot as u32);
            set(slot_a, slot, a);
            set(slot_b, slot, b);
        }
        next_tile += stretch.run.unwrap_or(0);
    });
}
