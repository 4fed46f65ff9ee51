//! The coarsest level, solved directly: A = L Δ Lᵀ of at most 72 unknowns, in columns, so that both solves run down columns
//! a tile at a time. Zeros stand on and above the diagonal of L. A pivot that is not positive (f32 can round the matrix of
//! a level to that) makes the level be smoothed instead.

use super::sizes::UNKNOWNS;
use super::tile::{add, mul, sub};
use crate::wide::Dispatch;

/// Unknowns in a tile.
const WIDTH: usize = 8;

/// Factors of a matrix of `unknowns`, a multiple of eight at most 72.
pub(super) struct Dense<'a> {
    unknowns: usize,
    /// `UNKNOWNS` numbers for each column
    columns: &'a mut [[f32; UNKNOWNS]],
    inverse: [f32; UNKNOWNS],
    /// Are there factors?
    pub(super) sound: bool,
}

impl<'a> Dense<'a> {
    /// An empty matrix in so many numbers as it may need.
    pub(super) fn new(buffer: &'a mut [f32], rows: usize) -> Self {
        let columns = buffer.as_chunks_mut().0;
        Self { unknowns: 3 * rows, columns, inverse: [0.0; UNKNOWNS], sound: false }
    }

    /// Zero.
    pub(super) fn clear(&mut self) {
        self.columns.iter_mut().for_each(|column| column.fill(0.0));
    }

    /// Adds a block at rows (a, b).
    pub(super) fn add(&mut self, a: usize, b: usize, [xx, yy, zz, xy, xz, yz]: [f32; 6]) {
        let block = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
        for (k, column) in block.iter().enumerate() {
            for (i, entry) in column.iter().enumerate() {
                let place = self.columns.get_mut(3 * b + k).and_then(|column| column.get_mut(3 * a + i));
                if let Some(place) = place {
                    *place += *entry;
                }
            }
        }
    }

    /// Factors in place.
    #[inline(never)]
    pub(super) fn factor(&mut self, dispatch: impl Dispatch) {
        dispatch.run(
            #[inline(always)]
            || self.factor_in_lanes(),
        );
    }

    /// Right-looking: column k leaves the columns behind it.
    #[inline(always)]
    fn factor_in_lanes(&mut self) {
        self.sound = false;
        let n = self.unknowns;
        let mut rest = self.columns.get_mut(..n).unwrap_or_default();
        for k in 0..n {
            let Some((column, behind)) = rest.split_first_mut() else { return };
            let pivot = column.get(k).copied().unwrap_or(0.0);
            let inverse = 1.0 / pivot;
            if !(pivot > 0.0 && inverse > 0.0 && inverse.is_finite()) {
                return;
            }
            for entry in column.iter_mut().take(k + 1) {
                *entry = 0.0;
            }
            // Only whole tiles from the one that holds k + 1.
            let from = (k + 1) / WIDTH;
            for (j, later) in behind.iter_mut().enumerate() {
                let factor = column.get(k + 1 + j).copied().unwrap_or(0.0) * inverse;
                let tiles = later.as_chunks_mut::<WIDTH>().0.iter_mut().zip(column.as_chunks::<WIDTH>().0);
                for (later, column) in tiles.skip(from) {
                    *later = sub(*later, mul([factor; WIDTH], *column));
                }
            }
            for entry in column.iter_mut() {
                *entry *= inverse;
            }
            if let Some(place) = self.inverse.get_mut(k) {
                *place = inverse;
            }
            rest = behind;
        }
        self.sound = true;
    }

    /// y ← A⁻¹ y
    #[inline(never)]
    pub(super) fn solve(&self, y: &mut [f32; UNKNOWNS], dispatch: impl Dispatch) {
        dispatch.run(
            #[inline(always)]
            || self.solve_in_lanes(y),
        );
    }

    #[inline(always)]
    fn solve_in_lanes(&self, y: &mut [f32; UNKNOWNS]) {
        let columns = self.columns.get(..self.unknowns).unwrap_or_default();
        let y_tiles = self.unknowns.div_ceil(WIDTH);
        for (k, column) in columns.iter().enumerate() {
            let value = y.get(k).copied().unwrap_or(0.0);
            let tiles = y.as_chunks_mut::<WIDTH>().0.iter_mut().zip(column.as_chunks::<WIDTH>().0);
            for (y, column) in tiles.take(y_tiles).skip((k + 1) / WIDTH) {
                *y = sub(*y, mul([value; WIDTH], *column));
            }
        }
        for (y, inverse) in y.iter_mut().zip(&self.inverse) {
            *y *= inverse;
        }
        for (k, column) in columns.iter().enumerate().rev() {
            let mut sums = [0.0; WIDTH];
            let tiles = y.as_chunks::<WIDTH>().0.iter().zip(column.as_chunks::<WIDTH>().0);
            for (y, column) in tiles.take(y_tiles).skip((k + 1) / WIDTH) {
                sums = add(sums, mul(*y, *column));
            }
            let [a, b, c, d, e, f, g, h] = sums;
            if let Some(y) = y.get_mut(k) {
                *y -= ((a + e) + (c + g)) + ((b + f) + (d + h));
            }
        }
    }
}
