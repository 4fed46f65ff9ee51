//! E_j, the selection of spring j: q_j = E_j q = (x_A, x_B), and its transpose, which scatters a spring's force.
//!
//! E_j is 6×3n with two identity blocks; it is never stored as a matrix: the pair (A, B) is all of it. A product with
//! E_j is two loads, one with E_jᵀ two adds. The sum over springs Σ E_jᵀ f_j runs in the order of the springs, so each
//! row's sum is a fixed sequence whatever lays the springs out in memory.
//!
//! The top bits of the pair are spare (there are fewer than 2³¹ particles) and hold two marks: *cable* (see
//! [`crate::Mixed`]) and *broken*.

use crate::real::Real;
use crate::vec3::{self, Vec3};

/// Set in the top bit of a spare-bit index.
pub(crate) const MARK: u32 = 1 << 31;

/// The pair (A, B) of a spring: which particles E_j selects.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Ends {
    pub(crate) a: usize,
    pub(crate) b: usize,
    /// Added as a cable.
    pub(crate) cable: bool,
    /// Broken: selects nothing any more.
    pub(crate) broken: bool,
}

impl Ends {
    /// As stored: two words.
    #[inline(always)]
    pub(crate) fn pack(self) -> [u32; 2] {
        let mark = |set| if set { MARK } else { 0 };
        [self.a as u32 | mark(self.cable), self.b as u32 | mark(self.broken)]
    }

    #[inline(always)]
    pub(crate) fn unpack([a, b]: [u32; 2]) -> Self {
        Self { a: (a & !MARK) as usize, b: (b & !MARK) as usize, cable: a & MARK != 0, broken: b & MARK != 0 }
    }
}

/// B E_j q = x_A − x_B; 0 if an index is out of range.
#[inline(always)]
pub fn difference<T: Real>(a: usize, b: usize, q: &[Vec3<T>]) -> Vec3<T> {
    match (q.get(a), q.get(b)) {
        (Some(x_a), Some(x_b)) => vec3::sub(*x_a, *x_b),
        _ => [T::ZERO; 3],
    }
}

/// y += E_jᵀ(f, −f): adds f at A and subtracts it at B, so that nothing is added in total.
#[inline(always)]
pub fn scatter<T: Real>(a: usize, b: usize, f: Vec3<T>, y: &mut [Vec3<T>]) {
    if let Some(row) = y.get_mut(a) {
        *row = vec3::add(*row, f);
    }
    if let Some(row) = y.get_mut(b) {
        *row = vec3::sub(*row, f);
    }
}
