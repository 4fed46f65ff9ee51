//! The block-Jacobi preconditioner: z = D⁻¹r, D the 3×3 diagonal blocks of A.
//!
//! Dᵢ = m̃ᵢI + Σ_{e∋i} Hₑ ⪰ μᵢI, so it is positive wherever A is certified or clamped. A block that rounding still makes
//! indefinite (condition above 1/u) is replaced by its largest diagonal entry: slower there, never wrong.
//!
//! Cost: 12 numbers' worth of adds per spring and one inversion per particle to build; 15 flops per particle to apply,
//! 42 for all that a PCG iteration does with its vectors in the same sweep.
//! Memory: 6 numbers per particle.

use crate::bound::square;
use crate::error::StepError;
use crate::force::Force;
use crate::lanes::Lanes;
use crate::real::{Real, larger};
use crate::report::Solve;
use crate::solver::{Problem, Solver, Stop, pcg};
use crate::sym3::Sym3;
use crate::system::System;
use crate::vec3::{self, Vec3};

/// Something that approximates A⁻¹ by a symmetric positive operator.
pub trait Preconditioner<T: Real> {
    /// z = D⁻¹ r; answers rᵀz.
    fn apply(&self, r: &[Vec3<T>], z: &mut [Vec3<T>]) -> T;

    /// What a PCG iteration does with its vectors after the product y = A p, in one sweep:
    /// x += a p, r −= a y, and then y = z = D⁻¹ r. Answers Σ|rᵢ|²/μᵢ and rᵀz; `weight` is 1/μ.
    fn sweep(&self, a: T, vectors: [&mut [Vec3<T>]; 4], weight: &[T]) -> (T, T);
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

    #[inline(never)] // One copy, with a frame of its own.
    fn sweep(&self, a: T, vectors: [&mut [Vec3<T>]; 4], weight: &[T]) -> (T, T) {
        let [x, r, p, y] = vectors;
        let (mut beta, mut rz) = (Lanes::new(), Lanes::new());
        let vectors = x.iter_mut().zip(r.iter_mut()).zip(p.iter()).zip(y.iter_mut());
        for (i, ((((x, r), p), y), (weight, inverse))) in
            vectors.zip(weight.iter().zip(self.inverse)).enumerate()
        {
            *x = vec3::add_scaled(*x, a, *p);
            *r = vec3::add_scaled(*r, -a, *y);
            beta.add(i, square(*r, *weight));
            *y = Sym3(*inverse).mul(*r);
            rz.add(i, vec3::dot(*r, *y));
        }
        (beta.sum(), rz.sum())
    }
}

/// PCG with the block-Jacobi preconditioner, in the scene's own memory: the solver that a step has unless it is told
/// another.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct BlockJacobi;

impl<T: Real> Solver<T> for BlockJacobi {
    #[inline]
    fn solve<F: Force<T>>(
        &mut self,
        problem: Problem<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        let Problem { system, vectors, block, free } = problem;
        Ok(pcg::solve(&system, &Jacobi::new(&system, block), vectors, stop, free))
    }
}
