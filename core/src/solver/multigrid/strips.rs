//! Where a level's edges lie. A *strip* is a tile of rows i and one offset d: the blocks of the edges between i and i + d, lane
//! by lane, zero where there is no edge. A product reads strips in order, needs no index but d, and scatters nothing: every edge
//! lies in two strips, that of its lower and that of its upper row, and is computed twice. Edges whose strips would be mostly
//! empty are *loose* instead: tiles of any edges, each once, with their ends. A cloth has eight strips a tile on its finest
//! level; a bunny is mostly loose.
//!
//! A tile's strips come one after another, by ascending d: so every row's sum is in the order of the other ends, whatever the
//! width of a tile.

use super::tile::WIDTH;
use super::words::{NONE, get, set};

/// The largest gap inside a stretch of edges: as long as a line of the second level of a large cloth, since lines of
/// aggregates alternate.
const GAP: u32 = 64;
/// A stretch whose strips have more places per edge than this is loose; on coarser levels four times as many, if there is room.
pub(super) const SPARSE: usize = 4;

/// How much room an arrangement takes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Extent {
    /// Number of strips
    pub(super) strips: usize,
    /// The largest |d|
    pub(super) farthest: usize,
    /// Tiles of loose edges
    pub(super) loose: usize,
}

/// With this bit a place is one among the loose edges. Else it is WIDTH times the strip plus the lane.
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
    add_up(count);
    for edge in from {
        let key = key(*edge) as usize;
        let place = get(count, key);
        set(to, place as usize, *edge);
        set(count, key, place.wrapping_add(1));
    }
}

/// Each number becomes the sum of those before it.
fn add_up(count: &mut [u32]) {
    let mut first = 0;
    for count in count.iter_mut() {
        (*count, first) = (first, first + *count);
    }
}

/// A level's edges, and how they are to lie.
#[derive(Clone, Copy)]
pub(super) struct Edges<'e> {
    pub(super) ends: [&'e [u32]; 2],
    pub(super) sorted: &'e [u32],
    /// An edge shares no place with another between the same rows: all but the first are loose
    pub(super) alone: bool,
    /// See [`SPARSE`]
    pub(super) sparse: usize,
}

/// Calls `visit(edge, is it the first between its rows?, is it loose?)` for the sorted edges.
fn classify(edges: Edges<'_>, mut visit: impl FnMut(u32, bool, bool)) {
    let Edges { ends: [a, b], mut sorted, alone, sparse } = edges;
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
        let tiles = (last as usize / WIDTH) - (first as usize / WIDTH) + 1;
        let dense = WIDTH * (tiles + 1) <= sparse * pairs;
        let mut before = NONE;
        for edge in stretch {
            let new = get(a, *edge as usize) != before;
            before = get(a, *edge as usize);
            visit(*edge, new || alone, !dense || (alone && !new));
        }
        sorted = rest;
    }
}

/// Tells when a list of rows, in order, comes to another tile or another offset.
struct Steps(u32, u32);

impl Steps {
    const fn new() -> Self {
        Self(NONE, NONE)
    }

    fn new_at(&mut self, row: u32, offset: u32) -> bool {
        let at = (row / WIDTH as u32, offset);
        let new = at != (self.0, self.1);
        (self.0, self.1) = at;
        new
    }
}

/// How much room the sorted edges take, and how many pairs of rows they join.
pub(super) fn measure(edges: Edges<'_>) -> (Extent, usize) {
    let Edges { ends, .. } = edges;
    let (mut extent, mut loose, mut pairs) = (Extent::default(), 0, 0);
    let (mut lower, mut upper) = (Steps::new(), Steps::new());
    classify(edges, |edge, new, is_loose| {
        pairs += usize::from(new);
        if is_loose {
            loose += usize::from(new);
            return;
        }
        let [a, b] = ends.map(|ends| get(ends, edge as usize));
        let offset = b.wrapping_sub(a);
        extent.farthest = core::cmp::max(extent.farthest, offset as usize);
        extent.strips += usize::from(lower.new_at(a, offset)) + usize::from(upper.new_at(b, offset));
    });
    extent.loose = loose.div_ceil(WIDTH);
    (extent, pairs)
}

/// Where strips begin and what they are.
pub(super) struct Strips<'p> {
    /// Of each tile the first strip; at the end the number of all
    pub(super) first: &'p mut [u32],
    /// d of each strip, modulo 2³²
    pub(super) offset: &'p mut [u32],
}

/// Lays the sorted edges out. Each edge's two places go to `places`; `put(edge, its first place, is it the first between its
/// rows?)` is called for all in order. `next` is scratch, as long as the list of tiles.
pub(super) fn arrange(
    edges: Edges<'_>,
    strips: &mut Strips<'_>,
    next: &mut [u32],
    places: &mut [[u32; 2]],
    mut put: impl FnMut(u32, u32, bool),
) {
    let Edges { ends, sorted, .. } = edges;
    // How many strips each tile has. Meanwhile an edge's first place says whether it is loose, and which; its second, whether
    // it is the first between its rows.
    let Strips { first, offset: offsets } = strips;
    first.fill(0);
    let mut count = |row: u32| {
        let tile = row as usize / WIDTH;
        set(first, tile, get(first, tile).wrapping_add(1));
    };
    let (mut lower, mut upper, mut loose) = (Steps::new(), Steps::new(), 0);
    classify(edges, |edge, new, is_loose| {
        loose += u32::from(is_loose && new);
        let [a, b] = ends.map(|ends| get(ends, edge as usize));
        if let Some(place) = places.get_mut(edge as usize) {
            *place = [if is_loose { (loose - 1) | LOOSE } else { 0 }, u32::from(new)];
        }
        if !is_loose {
            let offset = b.wrapping_sub(a);
            if lower.new_at(a, offset) {
                count(a);
            }
            if upper.new_at(b, offset) {
                count(b);
            }
        }
    });
    add_up(first);
    for (next, first) in next.iter_mut().zip(first.iter()) {
        *next = *first;
    }
    // The farthest below first ...
    let mut place_of = |steps: &mut Steps, row: u32, offset: u32, sign: u32| {
        let tile = row as usize / WIDTH;
        if steps.new_at(row, offset) {
            let strip = get(next, tile);
            set(offsets, strip as usize, offset.wrapping_mul(sign));
            set(next, tile, strip.wrapping_add(1));
        }
        (get(next, tile).wrapping_sub(1)).wrapping_mul(WIDTH as u32) + row % WIDTH as u32
    };
    let mut steps = Steps::new();
    for edge in sorted.iter().rev() {
        let [a, b] = ends.map(|ends| get(ends, *edge as usize));
        if let Some([place, second]) = places.get_mut(*edge as usize)
            && *place & LOOSE == 0
        {
            *place = *second;
            *second = place_of(&mut steps, b, b.wrapping_sub(a), u32::MAX);
        }
    }
    // ... the farthest above last.
    let mut steps = Steps::new();
    for edge in sorted {
        let [a, b] = ends.map(|ends| get(ends, *edge as usize));
        let Some([place, second]) = places.get_mut(*edge as usize) else { continue };
        let mut new = *second == 1;
        if *place & LOOSE == 0 {
            new = *place == 1;
            *place = place_of(&mut steps, a, b.wrapping_sub(a), 1);
        }
        put(*edge, *place, new);
    }
}
