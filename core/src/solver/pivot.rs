//! The 3×3 pivots of a block LDLᵀ, and what an eliminated block does to another.
//!
//! S⁻¹ from S = [x cᵀ; c B]: l = c/x, the Schur block Σ = B − l cᵀ (2×2), Σ⁻¹ by its determinant, and
//!
//! S⁻¹ = [1/x + lᵀΣ⁻¹l, −lᵀΣ⁻¹; −Σ⁻¹l, Σ⁻¹].
//!
//! Two divisions follow each other where [`Sym3::inverse`] has three: along a chain these waits are most of the time. The
//! determinant of a 2×2 cancels no more than the second pivot of its elimination would.

use crate::real::Real;
use crate::sym3::Sym3;

/// S⁻¹, or `None` where rounding leaves a pivot that is not positive.
#[inline(always)]
pub(crate) fn inverse<T: Real>(s: Sym3<T>) -> Option<Sym3<T>> {
    let [xx, yy, zz, xy, xz, yz] = s.0;
    let first = T::ONE / xx;
    let (l_y, l_z) = (xy * first, xz * first);
    let (s_yy, s_zz, s_yz) = (yy - l_y * xy, zz - l_z * xz, yz - l_y * xz);
    let determinant = s_yy * s_zz - s_yz * s_yz;
    let second = T::ONE / determinant;
    let (i_yy, i_zz, i_yz) = (s_zz * second, s_yy * second, -(s_yz * second));
    let (m_y, m_z) = (i_yy * l_y + i_yz * l_z, i_yz * l_y + i_zz * l_z);
    let i_xx = first + (l_y * m_y + l_z * m_z);
    let positive = (xx > T::ZERO) & (s_yy > T::ZERO) & (determinant > T::ZERO) & second.is_finite();
    positive.then_some(Sym3([i_xx, i_yy, i_zz, -m_y, -m_z, i_yz]))
}
