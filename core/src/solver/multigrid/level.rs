//! One level of the hierarchy, in spring form: rows with a mass each, edges between them with a symmetric 3×3 block H each,
//! and per row the sum of the blocks of springs to pins and points (*held*), kept apart:
//!
//! (A x)_i = m_i x_i + held_i x_i + Σ_{edges (i, j)} H (x_i − x_j).
//!
//! So the diagonal of every level is a sum of positive terms without cancellation. What lies beyond the rows is zero, so that
//! a tile may reach past the end.

use super::block::{FULL, Kind, TIED};
use super::planes::{LINE, Planes, Planes6, plane};
use super::runs::{Extent, Run, length};
use super::tile::{Tile6, WIDTH};
use super::words::{align, take};

/// Planes of a level: mass; inverse diagonal blocks; x, r, twice d.
const PLANES: usize = 1 + 6 + 12;

/// Numbers of a level but for its blocks; of several, if rows are those of all of them, `numbers(WIDTH - 1)` more for each.
pub(super) const fn numbers(rows: usize) -> usize {
    let plain = WIDTH * (rows.div_ceil(WIDTH) + 2);
    PLANES * (plain + plain / 4) + FULL * rows + WIDTH + LINE
}

/// Sizes of a level.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Size {
    pub(super) rows: usize,
    pub(super) extent: Extent,
    /// Edges between rows of two aggregates
    pub(super) cross: usize,
}

/// What depends on the pattern only.
pub(super) struct Pattern<'a> {
    pub(super) size: Size,
    pub(super) runs: &'a mut [Run],
    /// Both ends of the loose edges, NONE where there is none
    pub(super) loose: [&'a mut [u32]; 2],
    /// Each row's row on the next level
    pub(super) aggregate: &'a mut [u32],
    /// Scratch: which rows have held blocks that are not zero
    pub(super) held_rows: &'a mut [u32],
    /// Where blocks of edges between aggregates lie, and where on the next level they are summed
    pub(super) from: &'a mut [u32],
    pub(super) to: &'a mut [u32],
}

impl<'a> Pattern<'a> {
    pub(super) fn carve(pool: &mut &'a mut [u32], size: Size) -> Option<Self> {
        let loose = WIDTH * size.extent.loose;
        Some(Self {
            size,
            runs: take(pool, 3 * size.extent.runs)?.as_chunks_mut().0,
            loose: [take(pool, loose)?, take(pool, loose)?],
            aggregate: take(pool, size.rows)?,
            held_rows: take(pool, size.rows)?,
            from: take(pool, size.cross)?,
            to: take(pool, size.cross)?,
        })
    }
}

/// A level as it is in one step.
pub(super) struct Level<'a> {
    pub(super) pattern: Pattern<'a>,
    /// Are the blocks of runs αI + wwᵀ?
    pub(super) tied: bool,
    /// How many rows are held
    pub(super) held_count: usize,
    /// The runs' numbers
    pub(super) blocks: &'a mut [f32],
    /// The loose edges' blocks
    pub(super) loose: &'a mut [Tile6],
    pub(super) mass: &'a mut [f32],
    pub(super) held: &'a mut [[f32; 6]],
    /// Inverses of the diagonal blocks
    pub(super) inverse: Planes6<'a>,
    pub(super) x: Planes<'a>,
    pub(super) r: Planes<'a>,
    /// The last change of x, and room for the next
    pub(super) d: [Planes<'a>; 2],
}

impl<'a> Level<'a> {
    pub(super) fn carve(
        words: &mut &'a mut [u32],
        pool: &mut &'a mut [f32],
        size: Size,
        tied: bool,
    ) -> Option<Self> {
        align(pool, LINE)?;
        let n = plane(size.rows);
        let per_place = if tied { TIED } else { FULL };
        let blocks = take(pool, per_place * size.extent.places + WIDTH)?;
        let mut next = || take(pool, n);
        let mass = next()?;
        let inverse = Planes6([next()?, next()?, next()?, next()?, next()?, next()?]);
        let mut three = || Some(Planes([next()?, next()?, next()?]));
        let (x, r, d) = (three()?, three()?, [three()?, three()?]);
        let loose = take(pool, FULL * WIDTH * size.extent.loose)?.as_chunks_mut().0.as_chunks_mut().0;
        let held = take(pool, FULL * size.rows)?.as_chunks_mut().0;
        let pattern = Pattern::carve(words, size)?;
        Some(Self { pattern, tied, held_count: 0, blocks, loose, mass, held, inverse, x, r, d })
    }
}

/// Visits the runs with their numbers.
#[inline(always)]
pub(super) fn each_run<K: Kind>(runs: &[Run], blocks: &[f32], mut visit: impl FnMut(Run, &[f32])) {
    let mut rest = blocks;
    for run in runs {
        let size = K::NUMBERS * length(run[2] as usize);
        // With the zeros behind, which the next run begins with.
        let numbers = rest.get(..size + WIDTH).unwrap_or_default();
        rest = rest.get(size..).unwrap_or_default();
        visit(*run, numbers);
    }
}

/// Where a run meets the rows from i on, `n` of them, both multiples of a tile: first row, place of its block and number of
/// rows of those whose edges go up, and of those whose edges go down.
#[inline(always)]
pub(super) fn meet([first, offset, tiles]: Run, i: usize, n: usize) -> [[usize; 3]; 2] {
    let (first, offset, rows) = (first as usize, offset as usize, WIDTH * tiles as usize);
    let upper = |a: usize, b: usize| if a > b { a } else { b };
    let lower = |a: usize, b: usize| if a < b { a } else { b };
    let (begin, end) = (upper(i, first), lower(i + n, first + rows));
    let up = [begin, (begin + WIDTH).wrapping_sub(first), end.saturating_sub(begin)];
    // Whole tiles of rows, of which some at either end may have no edge.
    let from = first + offset;
    let (begin, end) = (upper(i, from - from % WIDTH), lower(i + n, (from + rows).next_multiple_of(WIDTH)));
    let down = [begin, (begin + WIDTH).wrapping_sub(from), end.saturating_sub(begin)];
    [up, down]
}
