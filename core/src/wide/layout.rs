//! Offset runs: a cloth's springs join particles i and i + d for a few distances d. Stored per distance as arrays over i,
//! zero where there is no spring, a product needs no index and no scatter.
//!
//! A row's place is its particle's number counted from the island's first, so pins leave holes of zeros instead of
//! shifting what comes after them. The layout is found from the numbering and kept while it stands.

use crate::parts::Matrix;
use crate::real::Real;
use crate::wide::tile::TILE;

/// At most so many distances.
pub(crate) const MOST_RUNS: usize = 16;
/// The word of a spring that ends at a pin.
pub(crate) const ANCHOR: u32 = u32::MAX;

/// Where an island's rows and springs lie.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Layout {
    /// The distances, ascending; the first `runs` are in use
    distance: [u32; MOST_RUNS],
    pub(crate) runs: usize,
    /// Number of places, rounded up to whole tiles
    pub(crate) places: usize,
    /// Zeros before and behind them: the farthest distance, rounded up
    pub(crate) pad: usize,
    /// What the layout was found from
    fingerprint: [u32; 4],
}

impl Layout {
    /// Of nothing.
    pub(crate) const fn none() -> Self {
        Self { distance: [0; MOST_RUNS], runs: 0, places: 0, pad: 0, fingerprint: [0; 4] }
    }

    /// Numbers in a plane.
    #[inline(always)]
    pub(crate) fn plane(&self) -> usize {
        self.places + 2 * self.pad
    }

    /// The distances in use.
    #[inline(always)]
    pub(crate) fn distances(&self) -> &[u32] {
        self.distance.get(..self.runs).unwrap_or_default()
    }

    /// Does it still belong to this island?
    pub(crate) fn fits<T: Real>(&self, matrix: &Matrix<'_, T>) -> bool {
        self.fingerprint == fingerprint(matrix)
    }

    /// Are there not too many distances? (No memory is needed to see that.)
    pub(crate) fn is_conceivable<T: Real>(matrix: &Matrix<'_, T>) -> bool {
        let mut layout = Self::none();
        let rows = matrix.own.len();
        each_spring(matrix, |row, other, _| {
            if other >= rows {
                return Some(());
            }
            layout.meet(place(matrix, other)?.checked_sub(place(matrix, row)?)? as u32)
        })
        .is_some()
    }

    /// Finds the layout, and in `run` which run each spring belongs to. `None` if the springs have too many distances,
    /// or the runs would be mostly zeros.
    pub(crate) fn find<T: Real>(matrix: &Matrix<'_, T>, run: &mut [u32]) -> Option<Self> {
        let mut layout = Self { fingerprint: fingerprint(matrix), ..Self::none() };
        let rows = matrix.own.len();
        let last = place(matrix, rows.checked_sub(1)?)?;
        let mut pairs = 0;
        each_spring(matrix, |row, other, edge| {
            let far = if other < rows { place(matrix, other)?.checked_sub(place(matrix, row)?)? } else { 0 };
            *run.get_mut(edge)? = if other < rows { far as u32 } else { ANCHOR };
            if other < rows {
                pairs += 1;
                layout.meet(far as u32)?;
            }
            Some(())
        })?;
        let farthest = layout.distances().last().copied().unwrap_or(0) as usize;
        layout.places = (last + 1).next_multiple_of(TILE);
        layout.pad = farthest.next_multiple_of(TILE);
        // Two springs of the same distance cannot start at the same row.
        let mut twice = false;
        let mut from = 0;
        for own in matrix.own {
            let mine = run.get_mut(from..from + *own as usize)?;
            from += *own as usize;
            let mut seen = 0u32;
            for run in mine.iter_mut().filter(|run| **run != ANCHOR) {
                let index = layout.distances().iter().position(|d| d == run)? as u32;
                twice |= seen & (1 << index) != 0;
                seen |= 1 << index;
                *run = index;
            }
        }
        let worth_it = layout.runs * layout.places <= 2 * pairs + 64 && layout.places <= 2 * rows + 64;
        (worth_it && !twice).then_some(layout)
    }

    /// Adds a distance, in order.
    fn meet(&mut self, d: u32) -> Option<()> {
        let at = self.distances().iter().position(|have| *have >= d).unwrap_or(self.runs);
        if self.distances().get(at) == Some(&d) {
            return Some(());
        }
        if self.runs == MOST_RUNS {
            return None;
        }
        let mut carried = d;
        for place in self.distance.iter_mut().take(self.runs + 1).skip(at) {
            core::mem::swap(place, &mut carried);
        }
        self.runs += 1;
        Some(())
    }
}

/// The place of a row.
#[inline(always)]
pub(crate) fn place<T>(matrix: &Matrix<'_, T>, row: usize) -> Option<usize> {
    let particles = matrix.rows.particle;
    particles.get(row)?.checked_sub(*particles.first()?).map(|place| place as usize)
}

/// Visits the springs in their order: (row, other end, place in the lists).
#[inline(always)]
pub(crate) fn each_spring<T>(
    matrix: &Matrix<'_, T>,
    mut visit: impl FnMut(usize, usize, usize) -> Option<()>,
) -> Option<()> {
    let mut others = matrix.other.iter().enumerate();
    for (row, own) in matrix.own.iter().enumerate() {
        for (edge, other) in others.by_ref().take(*own as usize) {
            visit(row, *other as usize, edge)?;
        }
    }
    Some(())
}

/// What a layout depends on, in a few words. Two numberings with the same words would make the lanes solve another
/// system than the scene's; the certificate, which knows nothing of lanes, would say so.
fn fingerprint<T: Real>(matrix: &Matrix<'_, T>) -> [u32; 4] {
    let sum = |words: &[u32]| {
        let term =
            |(i, word): (usize, &u32)| word.wrapping_add(1).wrapping_mul((i as u32).wrapping_mul(2) | 1);
        words.iter().enumerate().map(term).fold(0, u32::wrapping_add)
    };
    let Matrix { rows, own, other, .. } = matrix;
    [sum(own), sum(other), sum(rows.particle), (own.len() as u32) ^ (other.len() as u32).rotate_left(16)]
}
