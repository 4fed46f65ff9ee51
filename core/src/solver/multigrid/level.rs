//! One level of the hierarchy, in spring form: rows with a mass each, edges between them with a symmetric 3×3 block H each,
//! and per row the sum of the blocks of springs to pins and points (*held*), kept apart:
//!
//! (A x)_i = m_i x_i + held_i x_i + Σ_{edges (i, j)} H (x_i − x_j).
//!
//! So the diagonal of every level is a sum of positive terms without cancellation. What lies beyond the rows is zero, so that
//! a tile may reach past the end.

use super::block::{FULL, Kind, TIED};
use super::planes::{LINE, Planes, plane};
use super::strips::{Extent, Strips};
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
    pub(super) strips: Strips<'a>,
    /// Both ends of the loose edges, NONE where there is none
    pub(super) loose: [&'a mut [u32]; 2],
    /// Each row's row on the next level
    pub(super) aggregate: &'a mut [u32],
    /// Scratch: which rows have held blocks that are not zero
    pub(super) held_rows: &'a mut [u32],
    /// Where blocks of edges between aggregates lie, and the two places on the next level where they are summed
    pub(super) from: &'a mut [u32],
    pub(super) to: &'a mut [[u32; 2]],
}

impl<'a> Pattern<'a> {
    pub(super) fn carve(pool: &mut &'a mut [u32], size: Size) -> Option<Self> {
        let loose = WIDTH * size.extent.loose;
        let first = take(pool, size.rows.div_ceil(WIDTH) + 1)?;
        Some(Self {
            size,
            strips: Strips { first, offset: take(pool, size.extent.strips)? },
            loose: [take(pool, loose)?, take(pool, loose)?],
            aggregate: take(pool, size.rows)?,
            held_rows: take(pool, size.rows)?,
            from: take(pool, size.cross)?,
            to: take(pool, 2 * size.cross)?.as_chunks_mut().0,
        })
    }
}

/// A level as it is in one step.
pub(super) struct Level<'a> {
    pub(super) pattern: Pattern<'a>,
    /// Are the blocks of strips αI + wwᵀ?
    pub(super) tied: bool,
    /// How many rows are held
    pub(super) held_count: usize,
    /// The strips' numbers
    pub(super) blocks: &'a mut [f32],
    /// The loose edges' blocks
    pub(super) loose: &'a mut [Tile6],
    pub(super) mass: &'a mut [f32],
    pub(super) held: &'a mut [[f32; 6]],
    /// Inverses of the diagonal blocks
    pub(super) inverse: &'a mut [Tile6],
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
        let blocks = take(pool, per_place * WIDTH * size.extent.strips)?;
        let inverse =
            take(pool, FULL * WIDTH * size.rows.div_ceil(WIDTH))?.as_chunks_mut().0.as_chunks_mut().0;
        let mut next = || take(pool, n);
        let mass = next()?;
        let mut three = || Some(Planes([next()?, next()?, next()?]));
        let (x, r, d) = (three()?, three()?, [three()?, three()?]);
        let loose = take(pool, FULL * WIDTH * size.extent.loose)?.as_chunks_mut().0.as_chunks_mut().0;
        let held = take(pool, FULL * size.rows)?.as_chunks_mut().0;
        let pattern = Pattern::carve(words, size)?;
        Some(Self { pattern, tied, held_count: 0, blocks, loose, mass, held, inverse, x, r, d })
    }
}

/// The tiles from one on, so many: of each the offsets and blocks of its strips.
#[inline(always)]
pub(super) fn tiles<'l, K: Kind<Blocks: 'l>>(
    strips: &'l Strips<'_>,
    blocks: &'l [f32],
    [tile, count]: [usize; 2],
) -> impl Iterator<Item = impl Iterator<Item = (&'l u32, &'l K::Blocks)>> {
    let (offsets, blocks) = (&*strips.offset, K::strips(blocks));
    strips.first.get(tile..tile + count + 1).unwrap_or_default().windows(2).map(
        #[inline(always)]
        move |first| {
            let range = match first {
                [first, end] => *first as usize..*end as usize,
                _ => 0..0,
            };
            let offsets = offsets.get(range.clone()).unwrap_or_default();
            offsets.iter().zip(blocks.get(range).unwrap_or_default())
        },
    )
}
