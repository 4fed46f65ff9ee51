//! The certificate that A needs no projection, node by node, and the clamping where it does.
//!
//! α|x_A − x_B|² ≥ 2α(|x_A|² + |x_B|²) for α < 0, so with c_e = 2 (1 where the other end is pinned or a point)
//!
//! A ⪰ diag(μ),  μᵢ = m̃ᵢ − Σ_{e∋i} c_e max(0, −αₑ)   (α already scaled by s).
//!
//! μᵢ > 0 for all i proves A positive definite: *certified*. At the nodes that fail, the compressed springs that meet
//! there are clamped (see [`crate::Hessian`]); clamping only raises μ, so one pass is enough. μ is rounded down: what
//! it claims holds for the matrix of the stored floats. O(compressed springs). The bound is |x_A − x_B|² ≤ 2(|x_A|² + |x_B|²).

use crate::hessian::Hessian;
use crate::real::Real;

/// Adds c·max(0, −α) of a spring to a node's sum, rounded up; a NaN stays one, and fails.
#[inline(always)]
pub(crate) fn charge<T: Real>(sum: &mut [T], row: usize, c: T, h: &Hessian<T>) {
    if !(h.alpha >= T::ZERO)
        && let Some(sum) = sum.get_mut(row)
    {
        let up = T::ONE + T::TWO * T::TWO * T::UNIT_ROUNDOFF;
        *sum = (*sum - c * h.alpha) * up;
    }
}

/// μ from the sums, in place, rounded down; answers whether every node is certified.
#[inline]
pub(crate) fn certify<T: Real>(inertia: &[T], sum: &mut [T]) -> bool {
    let down = T::ONE - T::TWO * T::TWO * T::UNIT_ROUNDOFF;
    let mut certified = true;
    for (mu, m) in sum.iter_mut().zip(inertia) {
        *mu = (*m - *mu) * down;
        certified &= *mu > T::ZERO;
    }
    certified
}

/// Does a node's μ fail? (Also when it is NaN.)
#[inline(always)]
pub(crate) fn fails<T: Real>(mu: &[T], row: usize) -> bool {
    mu.get(row).is_none_or(|mu| !(*mu > T::ZERO))
}
