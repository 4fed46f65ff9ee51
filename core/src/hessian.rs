//! One spring's Hessian, compressed to four numbers.
//!
//! ∂²V_j/∂q_j² = [H −H; −H H] with H = αI + w wᵀ, α = kσ = k(l − l₀)/l, w = u√(k − α), k − α = k l₀/l ≥ 0 (computed in
//! that form: no cancellation). Eigenvalues of H: k along u, α twice across it; of the 6×6: 2k, 2α, 2α, 0, 0, 0.
//!
//! What is stored for a step is already scaled: sH + θh c uuᵀ, that is α ← sα and w ← u√(s k l₀/l + θh c), c the damping
//! along the spring (N·s/m), s = θ²h². Units then kg.
//!
//! *Clamped* means α ← 0 and w from the clamped α, so H = k uuᵀ with eigenvalues k, 0, 0. (With the old w the axial
//! stiffness would become k l₀/l and diverge as l → 0.)
//!
//! l = 0: H = kI. That is exact for l₀ = 0; for l₀ > 0 it is a replacement (0 ⪯ H ⪯ kI) and counts as projected.
//!
//! Source: the mass-spring lecture (Hessian of a spring).

use crate::real::{Number, Real};
use crate::spring::{Spring, Stretched};
use crate::vec3::{self, Vec3};

/// H = αI + w wᵀ, the 3×3 block of one spring's Hessian.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Hessian<T> {
    /// α: the eigenvalue across the spring (twice)
    pub alpha: T,
    /// w = u√(k − α): what the direction u adds
    pub w: Vec3<T>,
}

/// The factors of a step's matrix A = M + θh D − sK.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scaling<T> {
    /// s = θ²h², s²: multiplies stiffness
    pub stiffness: T,
    /// θh, s: multiplies damping
    pub damping: T,
}

impl<T: Real> Scaling<T> {
    /// s = 1, θh = 0: the bare Hessian.
    pub fn unit() -> Self {
        Self { stiffness: T::ONE, damping: T::ZERO }
    }
}

impl<T: Real> Hessian<T> {
    /// As stored: α, w.
    #[inline(always)]
    pub(crate) fn pack(self) -> [T; 4] {
        [self.alpha, self.w[0], self.w[1], self.w[2]]
    }

    #[inline(always)]
    pub(crate) fn unpack([alpha, x, y, z]: [T; 4]) -> Self {
        Self { alpha, w: [x, y, z] }
    }

    /// The true block H of a spring stretched to `stretched`, scaled. `damping` is c in N·s/m.
    #[inline(always)]
    pub fn new(spring: Spring<T>, stretched: Stretched<T>, damping: T, scaling: Scaling<T>) -> Self {
        if stretched.length == T::ZERO {
            return Self { alpha: scaling.stiffness * spring.stiffness, w: [T::ZERO; 3] };
        }
        let alpha = spring.tension(stretched.length) * stretched.inverse;
        let across = spring.stiffness * spring.rest_length * stretched.inverse;
        let w = (scaling.stiffness * across + scaling.damping * damping).sqrt();
        Self { alpha: scaling.stiffness * alpha, w: vec3::scale(w, stretched.direction) }
    }

    /// The block with α ← 0 and w from it: k uuᵀ (plus the damping), scaled.
    #[inline(always)]
    pub fn clamped(spring: Spring<T>, stretched: Stretched<T>, damping: T, scaling: Scaling<T>) -> Self {
        let w = (scaling.stiffness * spring.stiffness + scaling.damping * damping).sqrt();
        Self { alpha: T::ZERO, w: vec3::scale(w, stretched.direction) }
    }

    /// H as a dense 3×3 matrix.
    pub fn dense(&self) -> [[T; 3]; 3] {
        crate::sym3::Sym3::scalar(self.alpha).plus_outer(self.w).dense()
    }
}

impl<T: Number> Hessian<T> {
    /// H·d: one dot, one scatter.
    #[inline(always)]
    pub fn mul(&self, d: Vec3<T>) -> Vec3<T> {
        self.mul_and_form(d).0
    }

    /// H·d and dᵀHd = α dᵀd + (w·d)².
    #[inline(always)]
    pub fn mul_and_form(&self, d: Vec3<T>) -> (Vec3<T>, T) {
        let along = vec3::dot(self.w, d);
        let product = [
            self.alpha * d[0] + self.w[0] * along,
            self.alpha * d[1] + self.w[1] * along,
            self.alpha * d[2] + self.w[2] * along,
        ];
        (product, self.alpha * vec3::dot(d, d) + along * along)
    }
}

impl<T: Real> Spring<T> {
    /// H = αI + w wᵀ at ends a, b, unscaled, N/m.
    pub fn hessian(&self, a: Vec3<T>, b: Vec3<T>) -> Hessian<T> {
        Hessian::new(*self, Stretched::new(vec3::sub(a, b)), T::ZERO, Scaling::unit())
    }

    /// ∂²V_j/∂q_j² = [H −H; −H H] as four dense 3×3 blocks, N/m. The stiffness matrix of the spring is its negative.
    pub fn dense_hessian(&self, a: Vec3<T>, b: Vec3<T>) -> [[[[T; 3]; 3]; 2]; 2] {
        let h = self.hessian(a, b).dense();
        let minus = h.map(|row| row.map(|x| -x));
        [[h, minus], [minus, h]]
    }
}
