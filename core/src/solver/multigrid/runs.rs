//! Where a level's edges lie. An edge joins rows a < b; edges of one offset b − a and nearby a form a *run*: whole tiles of
//! rows a, a place for each row's edge to row a + d, places without an edge holding zeros. A run needs no indices: what
//! its edges do to their lower and to their upper ends is read in order, without any scatter. Edges whose runs would be
//! mostly empty are *loose* instead: tiles of any eight edges, with their ends. A cloth has a few runs on every level; a
//! bunny is mostly loose.
//!
//! A run's numbers lie in planes, one per number of a block, each with a tile of zeros in front; behind the last run there is
//! one more.

use super::planes::spread;
use super::tile::WIDTH;
use super::words::{NONE, get, set};

/// The largest gap inside a run: as long as a line of the second level of a large cloth, since lines of aggregates alternate.
const GAP: u32 = 64;
/// A run that takes more places per edge than this is loose.
pub(super) const SPARSE: usize = 4;

/// A run: first row (of a tile), offset, number of tiles.
pub(super) type Run = [u32; 3];

/// Places in a plane of a run.
#[inline(always)]
pub(super) const fn length(tiles: usize) -> usize {
    spread(WIDTH * (tiles + 1))
}

/// How much room an arrangement takes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Extent {
    /// Number of runs.
    pub(super) runs: usize,
    /// Places in one plane of every run.
    pub(super) places: usize,
    /// Tiles of loose edges.
    pub(super) loose: usize,
}

/// Where an edge's block lies: the first number's place, counted over the planes of all runs or, with this bit, over the
/// loose edges.
pub(super) const LOOSE: u32 = 1 << 31;

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
    /// A whole tile's
    first: u32,
    offset: u32,
    /// Number of tiles if it is to be a run.
    run: Option<usize>,
}

fn stretches(ends: [&[u32]; 2], mut sorted: &[u32], sparse: usize, mut visit: impl FnMut(&Stretch<'_>)) {
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
        let first = first - first % WIDTH as u32;
        let tiles = (last - first) as usize / WIDTH + 1;
        let run = (WIDTH * (tiles + 1) <= sparse * pairs).then_some(tiles);
        visit(&Stretch { edges: stretch, first, offset, run });
        sorted = rest;
    }
}

/// Lays the sorted edges out: calls `put(edge, where, is it the first there?)` for each, `run` for each run. Where `alone`,
/// an edge does not share its place with another between the same two rows.
pub(super) fn arrange(
    ends: [&[u32]; 2],
    sorted: &[u32],
    numbers: usize,
    alone: bool,
    sparse: usize,
    mut run: impl FnMut(Run),
    mut put: impl FnMut(u32, u32, bool),
) -> Extent {
    let mut extent = Extent::default();
    let mut loose = 0;
    stretches(ends, sorted, sparse, |stretch| {
        let mut before = NONE;
        for edge in stretch.edges {
            let a = get(ends[0], *edge as usize);
            let again = a == before;
            let place = match stretch.run {
                Some(_) if !(again && alone) => {
                    (numbers * extent.places + WIDTH) as u32 + (a - stretch.first)
                }
                _ => {
                    loose += u32::from(!again || alone);
                    (loose - 1) | LOOSE
                }
            };
            before = a;
            put(*edge, place, !again || alone);
        }
        if let Some(tiles) = stretch.run {
            run([stretch.first, stretch.offset, tiles as u32]);
            extent.runs += 1;
            extent.places += length(tiles);
        }
    });
    extent.loose = (loose as usize).div_ceil(WIDTH);
    extent
}
