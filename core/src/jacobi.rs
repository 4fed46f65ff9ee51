//! The block-Jacobi preconditioner: z = D⁻¹r, D the 3×3 diagonal blocks of A.
//!
//! Dᵢ = m̃ᵢI + Σ_{e∋i} Hₑ ⪰ μᵢI, so it is positive wherever A is certified or clamped. A block that rounding still makes
//! indefinite (condition above 1/u) is replaced by its largest diagonal entry: slower there, never wrong.
//!
//! Cost: 12 numbers' worth of adds per spring and one inversion per particle to build; 15 flops per particle to apply.
//! Memory: 6 numbers per particle.

use crate::force::Force;
use crate::lanes::Lanes;
use crate::real::{Real, larger};
use crate::sym3::Sym3;
use crate::system::System;
use crate::vec3::{self, Vec3};

/// Something that approximates A⁻¹ by a symmetric positive operator.
pub trait Preconditioner<T: Real> {
    /// z = D⁻¹ r; answers rᵀz.
    fn apply(&self, r: &[Vec3<T>], z: &mut [Vec3<T>]) -> T;
}

/// The inverses of A's diagonal blocks, in borrowed memory.
pub struct Jacobi<'a, T> {
    inverse: &'a [[T; 6]],
}

impl<'a, T: Real> Jacobi<'a, T> {
    /// Builds the inverses in `blocks`, one per row of the system.
    #[inline(never)]
    pub fn new<F: Force<T>>(system: &System<'_, T, F>, blocks: &'a mut [[T; 6]]) -> Self {
        system.diagonal(blocks);
        for block in blocks.iter_mut() {
            let [xx, yy, zz, ..] = *block;
            let inverse = Sym3(*block).inverse();
            *block = inverse.unwrap_or_else(|| Sym3::scalar(T::ONE / larger(larger(xx, yy), zz))).0;
        }
        Self { inverse: blocks }
    }
}

impl<T: Real> Preconditioner<T> for Jacobi<'_, T> {
    #[inline]
    fn apply(&self, r: &[Vec3<T>], z: &mut [Vec3<T>]) -> T {
        let mut rz = Lanes::new();
        for (i, ((z, r), inverse)) in z.iter_mut().zip(r).zip(self.inverse).enumerate() {
            *z = Sym3(*inverse).mul(*r);
            rz.add(i, vec3::dot(*r, *z));
        }
        rz.sum()
    }
}
