//! The hierarchy of one island: what depends only on which springs there are. It is kept from step to step behind a
//! record in front of it and made anew when the pattern's fingerprint changes. Should two patterns share one, the
//! preconditioner is a bad one, and the certificate of PCG says what came of it.

use super::level::{HELD, PLANES, Pattern, Size, TILE};
use super::matching::{self, aggregate};
use super::runs::{Extent, arrange, extent, sort};
use super::tile::WIDTH;
use super::words::{NONE, get, set, take};
use crate::hessian::Hessian;
use crate::parts::Matrix;
use crate::real::Real;
use crate::vec3;

/// At most so many levels.
pub(super) const LEVELS: usize = 7;
/// An island or level of so few rows is solved by dense factors.
pub(super) const DENSE: usize = 24;
/// Unknowns of the largest dense matrix.
pub(super) const UNKNOWNS: usize = 3 * DENSE;
/// Passes of matching: aggregates of up to 2³.
const PASSES: usize = 3;

/// Words of the record: size in words, two of fingerprint, springs, levels, and of each level rows, runs and tiles.
const RECORD: usize = 5 + 4 * LEVELS;

/// Rows of all levels of an island.
const fn most_rows(rows: usize) -> usize {
    2 * rows + 8
}

/// Slots of all levels of an island.
const fn most_slots(springs: usize) -> usize {
    2 * springs + springs / 2 + WIDTH * LEVELS
}

/// Words that an island keeps.
pub(super) const fn words_kept(rows: usize, springs: usize) -> usize {
    // A run has a tile at least.
    let slots = most_slots(springs);
    RECORD + springs + 3 * slots + 3 * (slots / WIDTH) + 2 * most_rows(rows)
}

/// Words that the analysis of an island works in.
pub(super) const fn words_worked_in(rows: usize, springs: usize) -> usize {
    4 * (2 * springs + WIDTH) + 4 * rows + 2
}

/// Numbers that an island works in.
pub(super) const fn numbers(rows: usize, springs: usize) -> usize {
    let padding = 2 * WIDTH * LEVELS;
    UNKNOWNS * UNKNOWNS
        + PLANES * (most_rows(rows) + padding)
        + HELD * most_rows(rows)
        + TILE / WIDTH * most_slots(springs)
}

/// What is known of an island's hierarchy.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Shape {
    pub(super) levels: usize,
    pub(super) size: [Size; LEVELS],
}

/// Reads a record; `None` if it is of another pattern.
pub(super) fn recall(record: &[u32], fingerprint: [u32; 2], rows: usize, springs: usize) -> Option<Shape> {
    let mut words = record.iter().map(|word| *word as usize);
    let mut next = || words.next();
    let [low, high] = fingerprint.map(|word| word as usize);
    let same = next()? == low && next()? == high && next()? == springs;
    let mut shape = Shape { levels: next()?, ..Shape::default() };
    for size in &mut shape.size {
        let (rows, runs, run_tiles, tiles) = (next()?, next()?, next()?, next()?);
        *size = Size { rows, extent: Extent { runs, run_tiles, tiles } };
    }
    let [first, ..] = shape.size;
    (same && first.rows == rows && (1..=LEVELS).contains(&shape.levels)).then_some(shape)
}

fn remember(record: &mut [u32], fingerprint: [u32; 2], springs: usize, shape: &Shape) {
    let [low, high] = fingerprint;
    let head = [low, high, springs as u32, shape.levels as u32];
    let sizes = shape.size.iter().flat_map(|Size { rows, extent }| {
        [*rows, extent.runs, extent.run_tiles, extent.tiles].map(|word| word as u32)
    });
    for (place, word) in record.iter_mut().zip(head.into_iter().chain(sizes)) {
        *place = word;
    }
}

/// A hash of who is joined to whom, in eight lanes.
pub(super) fn fingerprint(own: &[u32], other: &[u32]) -> [u32; 2] {
    let mut lanes = [0x811C_9DC5_u32; WIDTH];
    for list in [own, other] {
        let (chunks, rest) = list.as_chunks::<WIDTH>();
        let mix = |lane: &mut u32, word: u32| *lane = (*lane ^ word).wrapping_mul(0x0100_0193).rotate_left(5);
        for chunk in chunks {
            for (lane, word) in lanes.iter_mut().zip(chunk) {
                mix(lane, *word);
            }
        }
        for (lane, word) in lanes.iter_mut().zip(rest) {
            mix(lane, *word);
        }
    }
    let mut sum = [0x9E37_79B9, own.len() as u32];
    for lane in lanes {
        for (word, factor) in sum.iter_mut().zip([0x85EB_CA6B, 0xC2B2_AE35]) {
            *word = (*word ^ lane).wrapping_mul(factor).rotate_left(13);
        }
    }
    sum
}

/// Makes an island's hierarchy: record, springs' slots and levels go to `kept`. `None` if the room is too small.
#[inline(never)]
pub(super) fn analyse<T: Real>(
    matrix: &Matrix<'_, T>,
    fingerprint: [u32; 2],
    kept: &mut [u32],
    scratch: &mut [u32],
    mut numbers: &mut [f32],
) -> Option<Shape> {
    let (rows, springs) = (matrix.own.len(), matrix.other.len());
    let mut kept = kept;
    let record = take(&mut kept, RECORD)?;
    let mut slot_of = take(&mut kept, springs)?;
    let tie = take(&mut numbers, rows)?;
    let mut weight = take(&mut numbers, springs)?;
    weigh(matrix, weight);
    let edges = 2 * springs + WIDTH;
    let mut shape = Shape::default();
    let mut size = Size { rows, extent: Extent::default() };
    let (mut all_rows, mut all_slots) = (0, 0);
    let mut pool = &mut *scratch;
    let mut ends = [take(&mut pool, edges)?, take(&mut pool, edges)?];
    let count = ends_of_springs(matrix, &mut ends);
    let mut from = count;
    for place in &mut shape.size {
        let mut pool = &mut *scratch;
        let mut part = |n| take(&mut pool, n);
        let [a, b] = [part(edges)?, part(edges)?];
        let [order, other, count] = [part(edges)?, part(edges)?, part(size.rows + 1)?];
        let ends = [a.get(..from)?, b.get(..from)?];
        let sorted = sort(size.rows, ends, order, other, count);
        size.extent = extent(ends, sorted);
        all_rows += size.rows;
        all_slots += WIDTH * size.extent.tiles;
        if all_rows > most_rows(rows) || all_slots > most_slots(springs) {
            break;
        }
        let pattern = Pattern::carve(&mut kept, size)?;
        arrange(ends, sorted, size.extent, slot_of, pattern.runs, [pattern.a, pattern.b]);
        let slots = pattern.a.len();
        let sums = take(&mut numbers, slots)?;
        sums.fill(0.0);
        for (slot, weight) in slot_of.iter().zip(weight.iter()) {
            if let Some(sum) = sums.get_mut(*slot as usize) {
                *sum += *weight;
            }
        }
        weight = sums;
        *place = size;
        shape.levels += 1;
        if size.rows <= DENSE {
            break;
        }
        let ends = [&*pattern.a, &*pattern.b];
        let mut pool = &mut *scratch;
        let mut part = |n| take(&mut pool, n);
        let mut lists = matching::Scratch {
            first: part(size.rows + 1)?,
            touching: part(2 * slots)?,
            group: part(size.rows)?,
            next: part(size.rows)?,
            taken: part(size.rows)?,
            tie: tie.get_mut(..size.rows)?,
        };
        let coarse = aggregate(PASSES, ends, weight, pattern.aggregate, &mut lists);
        if 3 * coarse > 2 * size.rows {
            break;
        }
        let mut pool = &mut *scratch;
        let mut coarse_ends = [take(&mut pool, edges)?, take(&mut pool, edges)?];
        let up = |row: u32| get(pattern.aggregate, row as usize);
        for (edge, (a, b)) in ends[0].iter().zip(ends[1]).enumerate() {
            put(&mut coarse_ends, edge, if *a == NONE { [NONE; 2] } else { [up(*a), up(*b)] });
        }
        from = slots;
        size.rows = coarse;
        slot_of = pattern.coarse;
    }
    remember(record, fingerprint, springs, &shape);
    Some(shape)
}

/// Writes an edge's ends, the lower first; nothing is an edge between a row and itself.
fn put([a, b]: &mut [&mut [u32]; 2], edge: usize, [x, y]: [u32; 2]) {
    let (low, high) = if x < y { (x, y) } else { (y, x) };
    let none = low == high || high == NONE;
    set(a, edge, if none { NONE } else { low });
    set(b, edge, if none { NONE } else { high });
}

/// The ends of the springs between two rows; answers how many springs there are.
fn ends_of_springs<T: Real>(matrix: &Matrix<'_, T>, ends: &mut [&mut [u32]; 2]) -> usize {
    let (rows, mut others) = (matrix.own.len() as u32, matrix.other.iter().enumerate());
    for (row, own) in matrix.own.iter().enumerate() {
        for (spring, other) in others.by_ref().take(*own as usize) {
            put(ends, spring, [row as u32, if *other < rows { *other } else { NONE }]);
        }
    }
    matrix.other.len()
}

/// α + |w|², relative to the largest.
fn weigh<T: Real>(matrix: &Matrix<'_, T>, weight: &mut [f32]) {
    let of = |h: &[T; 4]| {
        let Hessian { alpha, w } = Hessian::unpack(*h);
        alpha + vec3::dot(w, w)
    };
    let largest = matrix.hessian.iter().map(of).fold(T::ZERO, crate::real::larger);
    for (weight, h) in weight.iter_mut().zip(matrix.hessian.iter()) {
        let relative = (of(h) / largest).to_f64() as f32;
        *weight = if relative.is_finite() { relative } else { 0.0 };
    }
}

/// Leaves the record and the springs' slots; what follows are the levels' patterns.
pub(super) fn skip_record<'a>(kept: &mut &'a mut [u32], springs: usize) -> Option<&'a mut [u32]> {
    take(kept, RECORD)?;
    take(kept, springs)
}
