//! The solver's numbers in planes: one list per component, so that rows lie side by side.

use crate::real::Real;
use crate::vec3::Vec3;
use crate::wide::layout::Layout;
use crate::wide::tile::{TILE, Tile, tile, tile_mut};

/// A vector per row, by component.
pub(crate) struct Planes<'a, T>(pub(crate) [&'a mut [T]; 3]);

/// All of an island's numbers.
pub(crate) struct Work<'a, T> {
    pub(crate) x: Planes<'a, T>,
    pub(crate) r: Planes<'a, T>,
    pub(crate) p: Planes<'a, T>,
    pub(crate) y: Planes<'a, T>,
    pub(crate) inertia: &'a mut [T],
    /// 1/μ
    pub(crate) weight: &'a mut [T],
    /// D⁻¹
    pub(crate) inverse: [&'a mut [T]; 6],
    /// α and w of the springs of each run, planes one after the other
    pub(crate) runs: &'a mut [T],
}

/// Planes besides the runs'.
const PLANES: usize = 20;

/// Numbers of a layout.
pub(crate) fn needs(layout: &Layout) -> usize {
    (PLANES + 4 * layout.runs) * layout.plane()
}

impl<'a, T: Real> Work<'a, T> {
    /// Cuts a buffer; `None` if it is too small.
    pub(crate) fn cut(mut buffer: &'a mut [T], layout: &Layout) -> Option<Self> {
        let n = layout.plane();
        let mut plane = || {
            let (front, rest) = core::mem::take(&mut buffer).split_at_mut_checked(n)?;
            buffer = rest;
            Some(front)
        };
        let mut planes = || Some(Planes([plane()?, plane()?, plane()?]));
        let (x, r, p, y) = (planes()?, planes()?, planes()?, planes()?);
        let (inertia, weight) = (plane()?, plane()?);
        let inverse = [plane()?, plane()?, plane()?, plane()?, plane()?, plane()?];
        let runs = buffer.get_mut(..4 * layout.runs * n)?;
        Some(Self { x, r, p, y, inertia, weight, inverse, runs })
    }
}

impl<T: Real> Planes<'_, T> {
    /// A tile of each component.
    #[inline(always)]
    pub(crate) fn tiles(&self, at: usize) -> [&Tile<T>; 3] {
        let [x, y, z] = &self.0;
        [tile(x, at), tile(y, at), tile(z, at)]
    }

    /// Writes a tile of each component.
    #[inline(always)]
    pub(crate) fn put_tiles(&mut self, at: usize, tiles: [Tile<T>; 3]) {
        for (plane, tile) in self.0.iter_mut().zip(tiles) {
            if let Some(place) = tile_mut(plane, at) {
                *place = tile;
            }
        }
    }

    /// One row.
    #[inline]
    pub(crate) fn row(&self, at: usize) -> Vec3<T> {
        let [x, y, z] = &self.0;
        let value = |plane: &[T]| plane.get(at).copied().unwrap_or(T::ZERO);
        [value(x), value(y), value(z)]
    }

    /// Writes one row.
    #[inline]
    pub(crate) fn put(&mut self, at: usize, row: Vec3<T>) {
        for (plane, value) in self.0.iter_mut().zip(row) {
            if let Some(place) = plane.get_mut(at) {
                *place = value;
            }
        }
    }

    /// All zeros.
    pub(crate) fn clear(&mut self) {
        for plane in &mut self.0 {
            plane.fill(T::ZERO);
        }
    }
}

/// Where the tiles begin.
#[inline(always)]
pub(crate) fn tiles(layout: &Layout) -> impl Iterator<Item = usize> + use<> {
    let pad = layout.pad;
    (0..layout.places / TILE).map(move |k| pad + k * TILE)
}
