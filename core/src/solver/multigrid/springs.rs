//! What the hierarchy is found from: the springs' ends and weights.

use super::words::{NONE, set};
use crate::hessian::Hessian;
use crate::parts::Matrix;
use crate::real::Real;
use crate::vec3;

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
pub(super) fn weigh<T: Real>(matrix: &Matrix<'_, T>, weight: &mut [f32]) {
    let of = |h: &[T; 4]| {
        let Hessian { alpha, w } = Hessian::unpack(*h);
        alpha + vec3::dot(w, w)
    };
    let largest = matrix.hessian.iter().map(of).fold(T::ZERO, crate::real::larger);
    for (weight, h) in weight.iter_mut().zip(matrix.hessian.iter()) {
        let relative = (of(h) / largest).to_f64() as f32;
        *weight = if relative.is_finite() { relative } else { 0.0 };
    }
}
