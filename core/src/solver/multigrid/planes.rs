//! Planes: a number per row, row 0 at place [`WIDTH`], with a tile of zeros in front and behind, so that a stretch that is a
//! whole number of tiles long may begin and end a little outside.

use super::tile::{Tile, Tile3, WIDTH};

/// Length of a plane.
pub(super) const fn plane(rows: usize) -> usize {
    spread(WIDTH * (rows.div_ceil(WIDTH) + 2))
}

/// A length no smaller, at most a quarter larger, so that the same row of many planes after one another lies in different sets
/// of a cache. (Rows are often a power of two: then all planes would fight for a few sets. A cycle on cloth:64 took a tenth
/// longer, a solve on cloth:128 a fifth.)
pub(super) const fn spread(n: usize) -> usize {
    let lines = n.div_ceil(LINE);
    let (period, rest) = match lines {
        0..64 => return n,
        64..256 => (16, 11),
        _ => (64, 27),
    };
    LINE * (lines + (rest + period - lines % period) % period)
}

/// Numbers in a line of the cache.
pub(super) const LINE: usize = 16;

/// `n` numbers of a plane from a place on, in tiles; none if it has not so many.
#[inline(always)]
pub(super) fn cut(plane: &[f32], at: usize, n: usize) -> &[Tile] {
    plane.get(at..at + n).unwrap_or_default().as_chunks().0
}

#[inline(always)]
fn cut_mut(plane: &mut [f32], at: usize, n: usize) -> &mut [Tile] {
    plane.get_mut(at..at + n).unwrap_or_default().as_chunks_mut().0
}

/// Vectors: x y z of every row.
pub(super) struct Planes<'a>(pub(super) [&'a mut [f32]; 3]);

impl Planes<'_> {
    /// A stretch, tile by tile.
    #[inline(always)]
    pub(super) fn tiles(&self, at: usize, n: usize) -> impl Iterator<Item = Tile3> {
        let [x, y, z] = &self.0;
        let (x, y, z) = (cut(x, at, n), cut(y, at, n), cut(z, at, n));
        x.iter().zip(y).zip(z).map(
            #[inline(always)]
            |((x, y), z)| [*x, *y, *z],
        )
    }

    /// The same, to be written.
    #[inline(always)]
    pub(super) fn tiles_mut(&mut self, at: usize, n: usize) -> impl Iterator<Item = [&mut Tile; 3]> {
        let [x, y, z] = &mut self.0;
        let (x, y, z) = (cut_mut(x, at, n), cut_mut(y, at, n), cut_mut(z, at, n));
        x.iter_mut().zip(y).zip(z).map(
            #[inline(always)]
            |((x, y), z)| [x, y, z],
        )
    }

    /// One row.
    #[inline(always)]
    pub(super) fn at(&self, row: usize) -> [f32; 3] {
        let [x, y, z] = &self.0;
        let of = |plane: &[f32]| plane.get(row.saturating_add(WIDTH)).copied().unwrap_or(0.0);
        [of(x), of(y), of(z)]
    }

    /// Writes one row.
    #[inline(always)]
    pub(super) fn put(&mut self, row: usize, v: [f32; 3]) {
        for (plane, v) in self.0.iter_mut().zip(v) {
            if let Some(place) = plane.get_mut(row.saturating_add(WIDTH)) {
                *place = v;
            }
        }
    }

    /// Adds to one row.
    #[inline(always)]
    pub(super) fn add(&mut self, row: usize, v: [f32; 3]) {
        for (plane, v) in self.0.iter_mut().zip(v) {
            if let Some(place) = plane.get_mut(row.saturating_add(WIDTH)) {
                *place += v;
            }
        }
    }

    pub(super) fn clear(&mut self) {
        for plane in &mut self.0 {
            plane.fill(0.0);
        }
    }
}

#[inline(always)]
pub(super) fn read([x, y, z]: &[&mut Tile; 3]) -> Tile3 {
    [**x, **y, **z]
}

#[inline(always)]
pub(super) fn write([x, y, z]: [&mut Tile; 3], [tx, ty, tz]: Tile3) {
    *x = tx;
    *y = ty;
    *z = tz;
}

/// Three planes of one length, known to be so: a stretch that is in one is in all.
#[derive(Clone, Copy)]
pub(super) struct Windows<'p>([&'p [f32]; 3]);

impl<'p> Windows<'p> {
    #[inline(always)]
    pub(super) fn of(Planes([x, y, z]): &'p Planes<'_>) -> Self {
        let n = x.len();
        match (y.get(..n), z.get(..n)) {
            (Some(y), Some(z)) => Self([x, y, z]),
            _ => Self([&[]; 3]),
        }
    }

    /// The rows from a place on, anywhere.
    #[inline(always)]
    pub(super) fn at(self, place: usize) -> Option<Tile3> {
        let Self([x, y, z]) = self;
        let rows = place..place.wrapping_add(WIDTH);
        let (x, y, z) = (x.get(rows.clone())?, y.get(rows.clone())?, z.get(rows)?);
        Some([*x.first_chunk()?, *y.first_chunk()?, *z.first_chunk()?])
    }
}
