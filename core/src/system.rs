//! A = M + θh D − sK of one island, restricted to its free particles, as an operator.
//!
//! A x = M̃x + Σ_j E_jᵀ(H_j Δ, −H_j Δ), Δ = x_A − x_B, with M̃ = M + θh D diagonal and H_j = αI + w wᵀ scaled by s. Row i
//! starts with m̃ᵢ xᵢ and adds its springs in their order: pairs, then anchors, then points; that is the definition of
//! its bits. xᵀAx comes with it as Σ m̃ x² + Σ (α Δ² + (w·Δ)²): with α ≥ 0 a sum of non-negative terms, which rounding
//! cannot make ≤ 0.
//!
//! Cost per product: a difference, a dot and a scatter per spring (23 flops, and 9 for the form), 9 per particle; each
//! point spring is asked once in the islands that one holds. Memory: 4 numbers and 2 indices per spring, 1 number per
//! particle. Source: the mass-spring lecture (linearly-implicit time
//! integration).

use crate::force::{Force, Rows};
use crate::hessian::Hessian;
use crate::lanes::Lanes;
use crate::real::Real;
use crate::sym3::Sym3;
use crate::vec3::{self, Vec3};

/// A symmetric positive operator on an island's unknowns.
pub trait Operator<T: Real> {
    /// y = A x; answers xᵀAx.
    fn apply(&self, x: &[Vec3<T>], y: &mut [Vec3<T>]) -> T;
}

/// A of one island, as assembled for one step.
pub struct System<'a, T, F> {
    /// M + θh D, one number per row
    pub(crate) inertia: &'a [T],
    /// Local (a, b), a < b, of springs with two free ends
    pub(crate) pairs: &'a [[u32; 2]],
    pub(crate) pair_hessians: &'a [[T; 4]],
    /// (a, –) of springs with one free end
    pub(crate) anchors: &'a [[u32; 2]],
    pub(crate) anchor_hessians: &'a [[T; 4]],
    /// Point springs, if the set of forces has any
    pub(crate) forces: &'a F,
    /// Does any of them hold this island?
    pub(crate) points: bool,
    pub(crate) rows: Rows<'a, T>,
}

impl<'a, T: Real, F: Force<T>> System<'a, T, F> {
    /// The operator over what assembling left in an island's lists.
    pub(crate) fn new(
        rows: Rows<'a, T>,
        [pairs, anchors]: [&'a [[u32; 2]]; 2],
        inertia: &'a [T],
        hessians: &'a [[T; 4]],
        forces: &'a F,
        points: bool,
    ) -> Self {
        let (pair_hessians, anchor_hessians) =
            hessians.split_at_checked(pairs.len()).unwrap_or((hessians, &[]));
        Self { inertia, pairs, pair_hessians, anchors, anchor_hessians, forces, points, rows }
    }

    /// The springs with two free ends: (a, b, H).
    #[inline(always)]
    pub(crate) fn each_pair(&self) -> impl Iterator<Item = (usize, usize, Hessian<T>)> {
        self.pairs
            .iter()
            .zip(self.pair_hessians)
            .map(|(&[a, b], h)| (a as usize, b as usize, Hessian::unpack(*h)))
    }

    /// What adds to one diagonal block only: springs with one free end, and point springs.
    #[inline(always)]
    pub(crate) fn each_anchor(&self, mut visit: impl FnMut(usize, Hessian<T>)) {
        for (&[a, _], h) in self.anchors.iter().zip(self.anchor_hessians) {
            visit(a as usize, Hessian::unpack(*h));
        }
        if F::ANCHORS && self.points {
            self.forces.hessians(&self.rows, &mut visit);
        }
    }

    /// Writes the 3×3 blocks of A's diagonal: M̃ + Σ H.
    pub(crate) fn diagonal(&self, blocks: &mut [[T; 6]]) {
        for (block, m) in blocks.iter_mut().zip(self.inertia) {
            *block = Sym3::scalar(*m).0;
        }
        let mut add = |row: usize, h: Hessian<T>| {
            if let Some(block) = blocks.get_mut(row) {
                *block = Sym3(*block).plus_scalar(h.alpha).plus_outer(h.w).0;
            }
        };
        for (a, b, h) in self.each_pair() {
            add(a, h);
            add(b, h);
        }
        self.each_anchor(add);
    }

    /// Number of unknown particles.
    pub fn particles(&self) -> usize {
        self.inertia.len()
    }

    /// The particle (in the caller's numbering) of a row.
    pub fn particle(&self, row: usize) -> Option<usize> {
        self.rows.particle.get(row).map(|i| *i as usize)
    }

    /// Visits the 3×3 blocks of A as (row, column, block), local rows; a block met twice is to be added. For export,
    /// tests and comparison with assembled solvers: 4 blocks per spring and one per particle.
    pub fn blocks(&self, mut visit: impl FnMut(usize, usize, [[T; 3]; 3])) {
        for (i, m) in self.inertia.iter().enumerate() {
            visit(i, i, Sym3::scalar(*m).dense());
        }
        for (a, b, h) in self.each_pair() {
            let block = h.dense();
            let minus = block.map(|row| row.map(|x| -x));
            visit(a, a, block);
            visit(a, b, minus);
            visit(b, a, minus);
            visit(b, b, block);
        }
        self.each_anchor(|a, h| visit(a, a, h.dense()));
    }
}

impl<T: Real, F: Force<T>> Operator<T> for System<'_, T, F> {
    #[inline]
    fn apply(&self, x: &[Vec3<T>], y: &mut [Vec3<T>]) -> T {
        let mut form = Lanes::new();
        for (i, ((y, x), m)) in y.iter_mut().zip(x).zip(self.inertia).enumerate() {
            *y = vec3::scale(*m, *x);
            form.add(i, vec3::dot(*x, *y));
        }
        for (e, (a, b, h)) in self.each_pair().enumerate() {
            let (Some(x_a), Some(x_b)) = (x.get(a), x.get(b)) else { continue };
            let (product, energy) = h.mul_and_form(vec3::sub(*x_a, *x_b));
            form.add(e, energy);
            crate::selection::scatter(a, b, product, y);
        }
        let mut e = self.pairs.len();
        self.each_anchor(|a, h| {
            let (Some(x), Some(y)) = (x.get(a), y.get_mut(a)) else { return };
            let (product, energy) = h.mul_and_form(*x);
            *y = vec3::add(*y, product);
            form.add(e, energy);
            e += 1;
        });
        form.sum()
    }
}
