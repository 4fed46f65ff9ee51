//! The half of A below its diagonal, L, row by row: −H of each spring between two rows, at the later one.
//!
//! A row owns its springs to later rows. So a sweep through rows descending can take Lᵀp from them, and one through rows
//! ascending can leave −Lz with them; nothing of L is stored but the springs.

use crate::hessian::Hessian;
use crate::parts::Matrix;
use crate::real::Real;
use crate::sym3::Sym3;
use crate::vec3::{self, Vec3};

/// Some rows' own springs, in their order.
#[derive(Clone, Copy)]
pub(crate) struct Springs<'m, T> {
    others: &'m [u32],
    hessians: &'m [[T; 4]],
}

impl<'m, T: Real> Springs<'m, T> {
    /// All of an island.
    pub(crate) fn of(matrix: &'m Matrix<'_, T>) -> Self {
        Self { others: matrix.other, hessians: matrix.hessian }
    }

    /// Takes the first `own` of them out.
    #[inline(always)]
    pub(crate) fn first(&mut self, own: u32) -> Self {
        self.split(own as usize, true)
    }

    /// Takes the last `own` of them out.
    #[inline(always)]
    pub(crate) fn last(&mut self, own: u32) -> Self {
        self.split(self.others.len().saturating_sub(own as usize), false)
    }

    #[inline(always)]
    fn split(&mut self, at: usize, first: bool) -> Self {
        let (others, later_others) = self.others.split_at_checked(at).unwrap_or_default();
        let (hessians, later_hessians) = self.hessians.split_at_checked(at).unwrap_or_default();
        let early = Self { others, hessians };
        let late = Self { others: later_others, hessians: later_hessians };
        let (taken, rest) = if first { (early, late) } else { (late, early) };
        *self = rest;
        taken
    }

    /// Σ H p of the other ends: −Lᵀp of a row with these springs.
    #[inline(always)]
    pub(crate) fn gather(&self, p: &[Vec3<T>]) -> Vec3<T> {
        let mut sum = [T::ZERO; 3];
        for (other, h) in self.others.iter().zip(self.hessians).rev() {
            if let Some(p) = p.get(*other as usize) {
                sum = vec3::add(sum, Hessian::unpack(*h).mul(*p));
            }
        }
        sum
    }

    /// Visits each other end that is a row with H z: −Lz of a row with these springs.
    #[inline(always)]
    pub(crate) fn scatter<X>(&self, z: Vec3<T>, to: &mut [X], mut add: impl FnMut(&mut X, Vec3<T>)) {
        for (other, h) in self.others.iter().zip(self.hessians) {
            if let Some(to) = to.get_mut(*other as usize) {
                add(to, Hessian::unpack(*h).mul(z));
            }
        }
    }

    /// Visits each other end that is a row: (row, H).
    #[inline(always)]
    pub(crate) fn blocks(&self, rows: usize, mut visit: impl FnMut(usize, Sym3<T>)) {
        for (other, h) in self.others.iter().zip(self.hessians).filter(|(other, _)| (**other as usize) < rows)
        {
            let h = Hessian::unpack(*h);
            visit(*other as usize, Sym3::scalar(h.alpha).plus_outer(h.w));
        }
    }
}
