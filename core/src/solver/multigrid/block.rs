//! The blocks of a strip's edges: on the finest level a spring's α and w, elsewhere a symmetric matrix.

use super::tile::{Tile, Tile3, Tile6, add, add3, dot, mul, scale, symmetric};

/// Numbers of αI + wwᵀ.
pub(super) const TIED: usize = 4;
/// Numbers of a symmetric matrix.
pub(super) const FULL: usize = 6;

/// How a strip's blocks are kept.
pub(super) trait Kind {
    /// A strip's blocks
    type Blocks: Copy;

    /// The strips whose numbers lie there.
    fn strips(numbers: &[f32]) -> &[Self::Blocks];

    /// Blocks times v.
    fn times(blocks: Self::Blocks, v: Tile3) -> Tile3;

    /// Blocks as matrices.
    fn matrices(blocks: Self::Blocks) -> Tile6;
}

/// α, w
pub(super) struct Tied;

impl Kind for Tied {
    type Blocks = [Tile; TIED];

    #[inline(always)]
    fn strips(numbers: &[f32]) -> &[[Tile; TIED]] {
        numbers.as_chunks().0.as_chunks().0
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
    type Blocks = Tile6;

    #[inline(always)]
    fn strips(numbers: &[f32]) -> &[Tile6] {
        numbers.as_chunks().0.as_chunks().0
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
