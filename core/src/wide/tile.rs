//! Tiles: thirty-two rows side by side. What is done to a tile is written as one loop over its rows, each row by itself, so
//! the compiler may take as many rows at once as the target's registers hold, and the bits are the same.

use crate::lanes::{LANES, Lanes};
use crate::real::Real;
use crate::vec3::Vec3;

/// Rows in a tile.
pub(crate) const TILE: usize = 32;
/// A number per row.
pub(crate) type Tile<T> = [T; TILE];

/// A tile of a list; zeros where it has not so many.
#[inline(always)]
pub(crate) fn tile<T: Real>(list: &[T], at: usize) -> &Tile<T> {
    list.get(at..).and_then(|list| list.first_chunk()).unwrap_or(T::ZEROS)
}

/// A tile of a list, to be written.
#[inline(always)]
pub(crate) fn tile_mut<T: Real>(list: &mut [T], at: usize) -> Option<&mut Tile<T>> {
    list.get_mut(at..).and_then(|list| list.first_chunk_mut())
}

/// Row i of three tiles.
#[inline(always)]
pub(crate) fn row<T: Real>(tiles: [&Tile<T>; 3], i: usize) -> Vec3<T> {
    let [x, y, z] = tiles;
    #[expect(clippy::indexing_slicing)] // i < TILE in every loop here; the link proves that none can panic.
    [x[i], y[i], z[i]]
}

/// Adds a tile of terms to partial sums.
#[inline(always)]
pub(crate) fn add_terms<T: Real>(sums: &mut Lanes<T>, terms: &Tile<T>) {
    for terms in terms.as_chunks::<LANES>().0 {
        sums.add_lane(*terms);
    }
}
