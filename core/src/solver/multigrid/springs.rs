//! The springs that a hierarchy is found from, and has its numbers from.

use super::block::TIED;
use super::words::{NONE, set};
use crate::force::Force;
use crate::hessian::Hessian;
use crate::parts::Matrix;
use crate::real::{Real, to};
use crate::system::System;
use crate::vec3;
use crate::wide::Dispatch;
use crate::wide::solve::Widened;

/// Where the numbers lie.
pub(super) trait Springs<T: Real, F: Force<T>> {
    /// The pattern, the masses and the point springs.
    fn system(&self) -> &System<'_, T, F>;
    /// σ, the largest mass or stiffness.
    fn largest(&self) -> T;
    /// The springs in their order: (row, other end, H).
    fn each_spring(&self, visit: impl FnMut(usize, usize, Hessian<T>));
}

impl<T: Real, F: Force<T>> Springs<T, F> for System<'_, T, F> {
    #[inline(always)]
    fn system(&self) -> &System<'_, T, F> {
        self
    }
    #[inline(always)]
    fn largest(&self) -> T {
        Self::largest(self)
    }
    #[inline(always)]
    fn each_spring(&self, visit: impl FnMut(usize, usize, Hessian<T>)) {
        Self::each_spring(self, visit);
    }
}

impl<T: Real, F: Force<T>, D: Dispatch> Springs<T, F> for Widened<'_, '_, T, F, D> {
    #[inline(always)]
    fn system(&self) -> &System<'_, T, F> {
        &self.system
    }
    #[inline(always)]
    fn largest(&self) -> T {
        Self::largest(self)
    }
    #[inline(always)]
    fn each_spring(&self, visit: impl FnMut(usize, usize, Hessian<T>)) {
        Self::each_spring(self, visit);
    }
}

/// H/σ = αI + wwᵀ, `by` = 1/σ and 1/√σ
#[inline(always)]
pub(super) fn tied<T: Real>(h: Hessian<T>, [scale, root]: [T; 2]) -> [f32; TIED] {
    let [x, y, z] = h.w.map(|w| to(w * root));
    [to(h.alpha * scale), x, y, z]
}

/// The ends of the springs between two rows, the lower first; NONE where a spring ends at a pin.
pub(super) fn ends_of_springs<T: Real>(matrix: &Matrix<'_, T>, [a, b]: &mut [&mut [u32]; 2]) {
    let (rows, mut others) = (matrix.own.len() as u32, matrix.other.iter().enumerate());
    for (row, own) in matrix.own.iter().enumerate() {
        for (spring, other) in others.by_ref().take(*own as usize) {
            let (row, other) = (row as u32, *other);
            let (low, high) = if row < other { (row, other) } else { (other, row) };
            let none = low == high || high >= rows;
            set(a, spring, if none { NONE } else { low });
            set(b, spring, if none { NONE } else { high });
        }
    }
}

/// α + |w|², relative to the largest.
#[inline(never)]
pub(super) fn weigh<T: Real, F: Force<T>>(springs: &impl Springs<T, F>, weight: &mut [f32]) {
    let of = |h: Hessian<T>| h.alpha + vec3::dot(h.w, h.w);
    let mut largest = T::ZERO;
    springs.each_spring(|_, _, h| largest = crate::real::larger(largest, of(h)));
    let mut weights = weight.iter_mut();
    springs.each_spring(|_, _, h| {
        let relative = to(of(h) / largest);
        if let Some(weight) = weights.next() {
            *weight = if f32::is_finite(relative) { relative } else { 0.0 };
        }
    });
}
