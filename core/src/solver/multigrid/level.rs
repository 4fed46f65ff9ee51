//! One level of the hierarchy, in spring form: rows with a mass each, edges between them with a symmetric 3×3 block H each,
//! and per row the sum of the blocks of springs to pins and points (*held*), kept apart:
//!
//! (A x)_i = m_i x_i + held_i x_i + Σ_{edges (i, j)} H (x_i − x_j).
//!
//! So the diagonal of every level is a sum of positive terms without cancellation. Vectors are three planes each; a plane is
//! at least eight longer than there are rows, and what lies beyond the rows is zero, so that a tile may reach past the end.

use super::runs::{Extent, Run};
use super::tile::{Planes, Tile, WIDTH};
use super::words::{NONE, take};

/// Length of a plane.
pub(super) const fn plane(rows: usize) -> usize {
    (rows + 2 * WIDTH - 1) / WIDTH * WIDTH
}

/// Planes of a level: mass; inverse diagonal block; x, r, d.
pub(super) const PLANES: usize = 1 + 6 + 9;
/// Numbers of a tile of edges.
pub(super) const TILE: usize = 6 * WIDTH;
/// Numbers of held blocks per row.
pub(super) const HELD: usize = 6;

/// Sizes of a level.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Size {
    pub(super) rows: usize,
    pub(super) extent: Extent,
}

/// What depends on the pattern only.
pub(super) struct Pattern<'a> {
    pub(super) size: Size,
    /// See [`Run`]
    pub(super) runs: &'a mut [u32],
    /// Both ends of every slot
    pub(super) a: &'a mut [u32],
    pub(super) b: &'a mut [u32],
    /// Each slot's slot on the next level; NONE if its ends are one row there
    pub(super) coarse: &'a mut [u32],
    /// Each row's row on the next level
    pub(super) aggregate: &'a mut [u32],
    /// Scratch: which rows have held blocks that are not zero
    pub(super) held_rows: &'a mut [u32],
}

impl<'a> Pattern<'a> {
    pub(super) fn carve(pool: &mut &'a mut [u32], size: Size) -> Option<Self> {
        let slots = WIDTH * size.extent.tiles;
        Some(Self {
            size,
            runs: take(pool, 3 * size.extent.runs)?,
            a: take(pool, slots)?,
            b: take(pool, slots)?,
            coarse: take(pool, slots)?,
            aggregate: take(pool, size.rows)?,
            held_rows: take(pool, size.rows)?,
        })
    }
}

/// A level as it is in one step.
pub(super) struct Level<'a> {
    pub(super) pattern: Pattern<'a>,
    /// How many rows are held
    pub(super) held_count: usize,
    /// H of every slot, tile by tile: eight of xx, eight of yy, …
    pub(super) blocks: &'a mut [f32],
    pub(super) mass: &'a mut [f32],
    pub(super) held: &'a mut [[f32; 6]],
    /// Inverses of the diagonal blocks: six planes
    pub(super) inverse: [&'a mut [f32]; 6],
    pub(super) x: Planes<'a>,
    pub(super) r: Planes<'a>,
    pub(super) d: Planes<'a>,
}

impl<'a> Level<'a> {
    pub(super) fn carve(words: &mut &'a mut [u32], pool: &mut &'a mut [f32], size: Size) -> Option<Self> {
        let n = plane(size.rows);
        let mut next = || take(pool, n);
        let mass = next()?;
        let inverse = [next()?, next()?, next()?, next()?, next()?, next()?];
        let mut three = || Some(Planes([next()?, next()?, next()?]));
        let (x, r, d) = (three()?, three()?, three()?);
        let held = take(pool, HELD * size.rows)?.as_chunks_mut().0;
        let blocks = take(pool, TILE * size.extent.tiles)?;
        let pattern = Pattern::carve(words, size)?;
        Some(Self { pattern, held_count: 0, blocks, mass, held, inverse, x, r, d })
    }
}

/// A tile's blocks, entry by entry.
#[inline(always)]
pub(super) fn blocks(tile: &[f32; TILE]) -> [Tile; 6] {
    let [xx, yy, zz, xy, xz, yz] = tile.as_chunks::<WIDTH>().0 else { return [[0.0; WIDTH]; 6] };
    [*xx, *yy, *zz, *xy, *xz, *yz]
}

impl Pattern<'_> {
    /// The loose tiles with their ends.
    #[inline(always)]
    pub(super) fn each_loose_tile(
        &self,
        loose: &[f32],
        mut visit: impl FnMut(&[f32; TILE], &[u32; WIDTH], &[u32; WIDTH]),
    ) {
        let first = WIDTH * self.size.extent.run_tiles;
        let ends = |list: &'_ [u32]| -> usize { list.len().min(first) };
        let (a, b) = (self.a.get(ends(self.a)..), self.b.get(ends(self.b)..));
        let (a, b) = (a.unwrap_or_default().as_chunks().0, b.unwrap_or_default().as_chunks().0);
        for (tile, (a, b)) in loose.as_chunks::<TILE>().0.iter().zip(a.iter().zip(b)) {
            visit(tile, a, b);
        }
    }

    /// The runs.
    pub(super) fn runs(&self) -> &[Run] {
        self.runs.as_chunks().0
    }

    /// Every slot's ends, and whether it is in use.
    pub(super) fn is_edge(&self, slot: usize) -> bool {
        self.a.get(slot).is_some_and(|a| *a != NONE)
    }
}
