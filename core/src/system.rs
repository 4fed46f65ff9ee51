//! A = M + θh D − sK of one island, restricted to its free particles, as an operator.
//!
//! A x = M̃x + Σ_j E_jᵀ(H_j Δ, −H_j Δ), Δ = x_A − x_B, with M̃ = M + θh D diagonal and H_j = αI + w wᵀ scaled by s. Each
//! spring belongs to the row of its lower free end. Row i of A x is
//!
//! ((0 − Σ_{rows a < i} H Δ) + m̃ᵢxᵢ) + Σ_{its own springs} H Δ,
//!
//! summed in this order, springs of a row in theirs; then point springs. That is the definition of its bits. It starts at
//! +0, so a term that is ±0 changes nothing, and a layout that has zeros where there is no spring gives the same bits.
//! xᵀAx comes with it: row i adds m̃ᵢ|xᵢ|² + Σ_{own} (α|Δ|² + (w·Δ)²), with α ≥ 0 a sum of non-negative terms, which
//! rounding cannot make ≤ 0.
//!
//! Cost per product: 17 flops per spring and 9 more for the form, 3 adds at each end; 12 per particle. Each point spring is
//! asked once in the islands that one holds. Memory: 4 numbers and an index per spring, 1 number and a count per
//! particle. Source: the mass-spring lecture (linearly-implicit time integration).

use crate::force::Force;
use crate::hessian::Hessian;
use crate::lanes::Lanes;
use crate::memory::{part, part_mut};
use crate::parts::Matrix;
use crate::real::{Real, larger};
use crate::sym3::Sym3;
use crate::vec3::{self, Vec3};

/// A symmetric positive operator on an island's unknowns.
pub trait Operator<T: Real> {
    /// y = A x; answers xᵀAx.
    fn apply(&self, x: &[Vec3<T>], y: &mut [Vec3<T>]) -> T;
}

/// A of one island, as assembled for one step.
pub struct System<'a, T, F> {
    pub(crate) matrix: &'a Matrix<'a, T>,
    /// Point springs, if the set of forces has any
    pub(crate) forces: &'a F,
    /// Does any of them hold this island?
    pub(crate) points: bool,
}

impl<T: Real, F: Force<T>> System<'_, T, F> {
    /// The point springs: (row, H).
    #[inline(always)]
    pub(crate) fn each_point(&self, mut visit: impl FnMut(usize, Hessian<T>)) {
        if F::ANCHORS && self.points {
            self.forces.hessians(&self.matrix.rows, &mut visit);
        }
    }

    /// y += A x, where y is +0; answers xᵀAx.
    #[inline(never)] // One copy, with a frame of its own.
    pub(crate) fn add_product(&self, x: &[Vec3<T>], y: &mut [Vec3<T>]) -> T {
        let mut form = Lanes::new();
        // One length for both, so that one comparison says where an end is.
        let rows = core::cmp::min(x.len(), y.len());
        let (x, y) = (part(x, 0..rows), part_mut(y, 0..rows));
        let mut springs = self.matrix.other.iter().zip(self.matrix.hessian.iter());
        for (row, ((own, m), x_a)) in
            self.matrix.own.iter().zip(self.matrix.inertia.iter()).zip(x).enumerate()
        {
            let mut energy = *m * vec3::dot(*x_a, *x_a);
            let mut sum = y.get(row).map_or([T::ZERO; 3], |y| vec3::add_scaled(*y, *m, *x_a));
            for _ in 0..*own {
                let Some((other, h)) = springs.next() else { break };
                let other = *other as usize;
                // A pin does not move.
                let delta = x.get(other).map_or(*x_a, |x_b| vec3::sub(*x_a, *x_b));
                let (product, form) = Hessian::unpack(*h).mul_and_form(delta);
                sum = vec3::add(sum, product);
                energy += form;
                if let Some(y) = y.get_mut(other) {
                    *y = vec3::sub(*y, product);
                }
            }
            if let Some(y) = y.get_mut(row) {
                *y = sum;
            }
            form.add(row, energy);
        }
        self.each_point(|row, h| {
            if let (Some(x), Some(y)) = (x.get(row), y.get_mut(row)) {
                let (product, energy) = h.mul_and_form(*x);
                *y = vec3::add(*y, product);
                form.add(row, energy);
            }
        });
        form.sum()
    }

    /// xᵀAx alone, by the same sum.
    #[inline(never)]
    pub(crate) fn form(&self, x: &[Vec3<T>]) -> T {
        let mut form = Lanes::new();
        for (row, (m, x)) in self.matrix.inertia.iter().zip(x).enumerate() {
            form.add(row, *m * vec3::dot(*x, *x));
        }
        let at = |i: usize| x.get(i).copied().unwrap_or([T::ZERO; 3]);
        self.each_spring(|row, other, h| form.add(row, h.mul_and_form(vec3::sub(at(row), at(other))).1));
        self.each_point(|row, h| form.add(row, h.mul_and_form(at(row)).1));
        form.sum()
    }

    /// Writes the 3×3 blocks of A's diagonal: M̃ + Σ H.
    #[inline(never)]
    pub(crate) fn diagonal(&self, blocks: &mut [[T; 6]]) {
        for (block, m) in blocks.iter_mut().zip(self.matrix.inertia.iter()) {
            *block = Sym3::scalar(*m).0;
        }
        let mut add = |row: usize, h: Hessian<T>| {
            if let Some(block) = blocks.get_mut(row) {
                *block = Sym3(*block).plus_scalar(h.alpha).plus_outer(h.w).0;
            }
        };
        self.each_spring(|row, other, h| {
            for end in [row, other] {
                add(end, h);
            }
        });
        self.each_point(add);
    }

    /// The largest mass or stiffness: a scale of A for arithmetic in `f32`.
    pub(crate) fn largest(&self) -> T {
        let mut most = T::ZERO;
        for m in self.matrix.inertia.iter() {
            most = larger(most, *m);
        }
        for h in self.matrix.hessian.iter() {
            let Hessian { alpha, w } = Hessian::unpack(*h);
            most = larger(most, alpha + vec3::dot(w, w));
        }
        most
    }

    /// The springs in their order: (row, other end, H).
    #[inline(always)]
    pub(crate) fn each_spring(&self, mut visit: impl FnMut(usize, usize, Hessian<T>)) {
        let mut springs = self.matrix.other.iter().zip(self.matrix.hessian.iter());
        for (row, own) in self.matrix.own.iter().enumerate() {
            for (other, h) in springs.by_ref().take(*own as usize) {
                visit(row, *other as usize, Hessian::unpack(*h));
            }
        }
    }

    /// Number of unknown particles.
    pub fn particles(&self) -> usize {
        self.matrix.inertia.len()
    }

    /// The particle (in the caller's numbering) of a row.
    pub fn particle(&self, row: usize) -> Option<usize> {
        self.matrix.rows.particle.get(row).map(|i| *i as usize)
    }

    /// Visits the 3×3 blocks of A as (row, column, block), local rows; a block met twice is to be added. For export,
    /// tests and comparison with assembled solvers: 4 blocks per spring and one per particle.
    pub fn blocks(&self, mut visit: impl FnMut(usize, usize, [[T; 3]; 3])) {
        for (i, m) in self.matrix.inertia.iter().enumerate() {
            visit(i, i, Sym3::scalar(*m).dense());
        }
        self.each_spring(|a, b, h| {
            let block = h.dense();
            visit(a, a, block);
            if b < self.particles() {
                let minus = block.map(|row| row.map(|x| -x));
                visit(a, b, minus);
                visit(b, a, minus);
                visit(b, b, block);
            }
        });
        self.each_point(|a, h| visit(a, a, h.dense()));
    }
}

impl<T: Real, F: Force<T>> Operator<T> for System<'_, T, F> {
    #[inline]
    fn apply(&self, x: &[Vec3<T>], y: &mut [Vec3<T>]) -> T {
        for y in y.iter_mut() {
            *y = [T::ZERO; 3];
        }
        self.add_product(x, y)
    }
}
