//! Symmetric 3×3 blocks: the diagonal blocks of A, and their inverses in the block-Jacobi preconditioner.
//!
//! Six numbers, xx yy zz xy xz yz. The inverse goes through D = L Δ Lᵀ (pivots δ₁ δ₂ δ₃): D⁻¹ = L⁻ᵀ Δ⁻¹ L⁻¹ is a sum
//! of three positive outer products, so with positive pivots it stays positive where cofactors would cancel.

use core::ops::Div;

use crate::real::{Number, Real};
use crate::vec3::Vec3;

/// A symmetric 3×3 matrix: xx, yy, zz, xy, xz, yz.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sym3<T>(pub [T; 6]);

impl<T: Number> Sym3<T> {
    /// self + s·I
    #[inline(always)]
    pub fn plus_scalar(self, s: T) -> Self {
        let [xx, yy, zz, xy, xz, yz] = self.0;
        Self([xx + s, yy + s, zz + s, xy, xz, yz])
    }

    /// self + w wᵀ
    #[inline(always)]
    pub fn plus_outer(self, w: Vec3<T>) -> Self {
        let [xx, yy, zz, xy, xz, yz] = self.0;
        Self([
            xx + w[0] * w[0],
            yy + w[1] * w[1],
            zz + w[2] * w[2],
            xy + w[0] * w[1],
            xz + w[0] * w[2],
            yz + w[1] * w[2],
        ])
    }

    /// self·v
    #[inline(always)]
    pub fn mul(&self, v: Vec3<T>) -> Vec3<T> {
        let [xx, yy, zz, xy, xz, yz] = self.0;
        [
            (xx * v[0] + xy * v[1]) + xz * v[2],
            (xy * v[0] + yy * v[1]) + yz * v[2],
            (xz * v[0] + yz * v[1]) + zz * v[2],
        ]
    }
}

impl<T: Real> Sym3<T> {
    /// s·I
    #[inline(always)]
    pub fn scalar(s: T) -> Self {
        Self([s, s, s, T::ZERO, T::ZERO, T::ZERO])
    }

    /// As a dense matrix, rows first.
    pub fn dense(&self) -> [[T; 3]; 3] {
        let [xx, yy, zz, xy, xz, yz] = self.0;
        [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
    }

    /// The inverse through L Δ Lᵀ, or `None` where rounding leaves a pivot that is not positive.
    #[inline]
    pub fn inverse(&self) -> Option<Self> {
        let (inverse, pivots) = self.inverse_and_pivots(T::ONE);
        pivots.iter().all(|pivot| *pivot > T::ZERO).then_some(inverse)
    }
}

impl<T: Number + Div<Output = T>> Sym3<T> {
    /// The inverse without a branch, and the pivots: it holds where all three are positive.
    #[inline(always)]
    pub(crate) fn inverse_and_pivots(&self, one: T) -> (Self, [T; 3]) {
        let [xx, yy, zz, xy, xz, yz] = self.0;
        let i1 = one / xx;
        let (l21, l31) = (xy * i1, xz * i1);
        let p2 = yy - l21 * xy;
        let i2 = one / p2;
        let s32 = yz - l31 * xy;
        let l32 = s32 * i2;
        let p3 = (zz - l31 * xz) - l32 * s32;
        let i3 = one / p3;
        // L⁻¹ = [1; −l21 1; m31 −l32 1], so D⁻¹ = Σ_k i_k ρ_k ρ_kᵀ over its rows ρ_k.
        let m31 = l21 * l32 - l31;
        let inverse = Self([
            (i1 + i2 * (l21 * l21)) + i3 * (m31 * m31),
            i2 + i3 * (l32 * l32),
            i3,
            -(i2 * l21) - i3 * (m31 * l32),
            i3 * m31,
            -(i3 * l32),
        ]);
        (inverse, [xx, p2, p3])
    }
}
