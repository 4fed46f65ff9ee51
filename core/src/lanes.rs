//! Sums over an island: eight partial sums, folded in one fixed tree. This *is* the definition of every dot product
//! here, on every target, so that a host may keep the lanes in vector registers and still give a microcontroller's
//! bits. Item i of the island (its i-th unknown, or its i-th spring) goes to lane i mod 8.

use crate::real::Real;

/// Number of partial sums.
pub(crate) const LANES: usize = 8;

/// Eight running sums of non-related items.
#[derive(Clone, Copy)]
pub(crate) struct Lanes<T>([T; LANES]);

impl<T: Real> Lanes<T> {
    #[inline(always)]
    pub(crate) fn new() -> Self {
        Self([T::ZERO; LANES])
    }

    /// Sums that were kept side by side.
    #[inline(always)]
    pub(crate) fn of(sums: [T; LANES]) -> Self {
        Self(sums)
    }

    /// Adds eight terms at once: of items 8k … 8k + 7.
    #[inline(always)]
    pub(crate) fn add_lane(&mut self, terms: [T; LANES]) {
        for (lane, term) in self.0.iter_mut().zip(&terms) {
            *lane += *term;
        }
    }

    /// Adds `term` of item `i`.
    #[inline(always)]
    pub(crate) fn add(&mut self, i: usize, term: T) {
        if let Some(lane) = self.0.get_mut(i % LANES) {
            *lane += term;
        }
    }

    /// ((0+4)+(2+6)) + ((1+5)+(3+7))
    #[inline(always)]
    pub(crate) fn sum(self) -> T {
        let [a, b, c, d, e, f, g, h] = self.0;
        ((a + e) + (c + g)) + ((b + f) + (d + h))
    }
}
