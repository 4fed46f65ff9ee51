//! The blocks of a run's edges: on the finest level a spring's α and w, elsewhere a symmetric matrix; one plane per number.

use super::planes::cut;
use super::tile::{Tile, Tile3, Tile6, add, add3, dot, mul, scale, symmetric};

/// Numbers of αI + wwᵀ.
pub(super) const TIED: usize = 4;
/// Numbers of a symmetric matrix.
pub(super) const FULL: usize = 6;

/// How a run's blocks are kept.
pub(super) trait Kind {
    /// Numbers of a block
    const NUMBERS: usize;
    /// A tile of blocks
    type Blocks: Copy;

    /// A stretch of planes of this length, tile by tile.
    fn tiles(run: &[f32], length: usize, at: usize, n: usize) -> impl Iterator<Item = Self::Blocks>;

    /// Blocks times v.
    fn times(blocks: Self::Blocks, v: Tile3) -> Tile3;

    /// Blocks as matrices.
    fn matrices(blocks: Self::Blocks) -> Tile6;
}

/// α, w
pub(super) struct Tied;

impl Kind for Tied {
    const NUMBERS: usize = TIED;
    type Blocks = [Tile; TIED];

    #[inline(always)]
    fn tiles(run: &[f32], length: usize, at: usize, n: usize) -> impl Iterator<Item = [Tile; TIED]> {
        let w = vectors(run, length, at + length, n);
        cut(run, at, n).iter().zip(w).map(
            #[inline(always)]
            |(alpha, [x, y, z])| [*alpha, x, y, z],
        )
    }

    #[inline(always)]
    fn times([alpha, x, y, z]: [Tile; TIED], v: Tile3) -> Tile3 {
        let w = [x, y, z];
        add3(scale(alpha, v), scale(dot(w, v), w))
    }

    #[inline(always)]
    fn matrices([alpha, x, y, z]: [Tile; TIED]) -> Tile6 {
        let [xx, yy, zz] = [mul(x, x), mul(y, y), mul(z, z)];
        [add(alpha, xx), add(alpha, yy), add(alpha, zz), mul(x, y), mul(x, z), mul(y, z)]
    }
}

/// xx yy zz xy xz yz
pub(super) struct Full;

impl Kind for Full {
    const NUMBERS: usize = FULL;
    type Blocks = Tile6;

    #[inline(always)]
    fn tiles(run: &[f32], length: usize, at: usize, n: usize) -> impl Iterator<Item = Tile6> {
        vectors(run, length, at, n).zip(vectors(run, length, at + 3 * length, n)).map(
            #[inline(always)]
            |([xx, yy, zz], [xy, xz, yz])| [xx, yy, zz, xy, xz, yz],
        )
    }

    #[inline(always)]
    fn times(blocks: Tile6, v: Tile3) -> Tile3 {
        symmetric(blocks, v)
    }

    #[inline(always)]
    fn matrices(blocks: Tile6) -> Tile6 {
        blocks
    }
}

/// Three planes.
#[inline(always)]
fn vectors(run: &[f32], length: usize, at: usize, n: usize) -> impl Iterator<Item = Tile3> {
    let (x, y) = (cut(run, at, n), cut(run, at + length, n));
    x.iter().zip(y).zip(cut(run, at + 2 * length, n)).map(
        #[inline(always)]
        |((x, y), z)| [*x, *y, *z],
    )
}
