//! f = −∂V/∂q and K = ∂f/∂q of all springs, true (nothing clamped), in the caller's numbering, pinned particles too.
//!
//! f = Σ E_jᵀ f_j, K = Σ E_jᵀ K_j E_j, K_j = −∂²V_j/∂q_j². K is symmetric, K·1 = 0 (translations), K(ω×x) = ω×f
//! (rotations). As an operator, and as 3×3 blocks for tests, export and comparison. Cost: O(springs), two roots each.
//!
//! Source: the mass-spring lecture (assembling force and stiffness).

use crate::energy::Energies;
use crate::hessian::{Hessian, Scaling};
use crate::law::Law;
use crate::real::Real;
use crate::selection::{self, Ends};
use crate::vec3::{self, Vec3};

impl<T: Real, L: Law> Energies<'_, T, L> {
    /// f += −∂V/∂q, N. Rows beyond the slice are left out.
    pub fn add_force(&self, f: &mut [Vec3<T>]) {
        for j in 0..self.state.springs() {
            if let (Some(ends), Some((spring, stretched))) = (self.state.live(j), self.loaded(j)) {
                let pull = -spring.tension(stretched.length);
                selection::scatter(ends.a, ends.b, vec3::scale(pull, stretched.direction), f);
            }
        }
    }

    /// y = K x, N for x in m.
    pub fn stiffness_product(&self, x: &[Vec3<T>], y: &mut [Vec3<T>]) {
        for y in y.iter_mut() {
            *y = [T::ZERO; 3];
        }
        self.each_hessian(|ends, h| {
            let product = h.mul(selection::difference(ends.a, ends.b, x));
            selection::scatter(ends.b, ends.a, product, y);
        });
    }

    /// Visits K's 3×3 blocks as (row, column, block), N/m; a block met twice is to be added. Four per spring.
    pub fn stiffness_blocks(&self, mut visit: impl FnMut(usize, usize, [[T; 3]; 3])) {
        self.each_hessian(|Ends { a, b, .. }, h| {
            let block = h.dense();
            let minus = block.map(|row| row.map(|x| -x));
            visit(a, a, minus);
            visit(a, b, block);
            visit(b, a, block);
            visit(b, b, minus);
        });
    }

    /// H = αI + w wᵀ of a spring, N/m: 0 for a slack cable; `None` if it is broken or out of range.
    pub fn hessian_of(&self, spring: usize) -> Option<Hessian<T>> {
        self.state.live(spring)?;
        Some(match self.loaded(spring) {
            Some((spring, stretched)) => Hessian::new(spring, stretched, T::ZERO, Scaling::unit()),
            None => Hessian { alpha: T::ZERO, w: [T::ZERO; 3] },
        })
    }

    /// The springs that carry: neither broken nor slack.
    fn each_hessian(&self, mut visit: impl FnMut(Ends, Hessian<T>)) {
        for j in 0..self.state.springs() {
            if let (Some(ends), Some((spring, stretched))) = (self.state.live(j), self.loaded(j)) {
                visit(ends, Hessian::new(spring, stretched, T::ZERO, Scaling::unit()));
            }
        }
    }
}
