//! PCG in f32 for a system in the scene's precision: the iterations of [`crate::solver::pcg`] for A c = r, where x + c is what x
//! is to become.
//!
//! f32 loses what c is made of after some iterations, so c is handed out when Σ|rᵢ|²/μᵢ has fallen by [`FALL`], and r comes anew,
//! computed outside in the precision of the scene. The direction p stays, so few iterations are lost. r comes divided by the
//! largest component that it had at first, since f32 would lose a small one, 1/μ by the largest, and A times 1/σ.
//!
//! [`FALL`] from 1e-3 to 1e-9 makes no difference that is not chance; this one asks for no new residual before R = 1e-3 is
//! reached.
//!
//! Source: van der Vorst & Ye 2000, *Residual replacement strategies for Krylov subspace iterative methods*.

use crate::real::{Real, larger};

/// Of Σ|rᵢ|²/μᵢ, until c is handed out.
const FALL: f32 = 1e-7;

/// What iterates in f32, and what it iterates for.
pub(crate) trait Refines<T> {
    /// 1/σ
    fn scale(&self) -> T;
    /// The largest component of r.
    fn most(&mut self) -> T;
    /// The largest 1/μ.
    fn heaviest(&mut self) -> T;
    /// Weights `lighter`/μ, p = 0.
    fn begin(&mut self, lighter: T);
    /// r · `down`, c = 0; answers Σ|rᵢ|²/μᵢ.
    fn residual(&mut self, down: T) -> f32;
    /// Iterates; answers Σ|rᵢ|²/μᵢ and whether it broke down (rᵀz or pᵀAp ≤ 0 or NaN).
    fn iterate(&mut self, group: Group, rz: &mut f32, iterations: &mut u32) -> (f32, bool);
    /// x += `up` · c
    fn hand_out(&mut self, up: T);
    /// r −= A · what was handed out last.
    fn renew(&mut self);
    /// p = 0
    fn forget(&mut self);
}

/// Some iterations: from this Σ|rᵢ|²/μᵢ to that one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Group {
    pub(crate) beta: f32,
    pub(crate) goal: f32,
    pub(crate) max_iterations: u32,
}

/// How it ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Refinement {
    /// The target is reached or the iterations are used up; r is that of f32.
    Done,
    /// f32 does not get nearer; r is up to date.
    Spent,
    /// The numbers are not for f32, or the first iteration broke down; r is up to date.
    Broken,
}

/// Iterates as [`crate::solver::pcg::Iterates::iterate`] says.
#[inline(always)]
pub(crate) fn refine<T: Real>(
    of: &mut impl Refines<T>,
    target: T,
    max_iterations: u32,
    iterations: &mut u32,
) -> Refinement {
    let (most, heaviest) = (of.most(), of.heaviest());
    let (down, up, lighter) = (T::ONE / most, most * of.scale(), T::ONE / heaviest);
    if !(most > T::ZERO && down.is_finite() && up.is_finite() && lighter.is_finite()) {
        return Refinement::Broken;
    }
    // ½ Σ|rᵢ|²/μᵢ of what is 1 here; where that is below or beyond the numbers, no target is known and FALL alone ends a group.
    let unit = T::HALF * (most * heaviest) * most;
    let known = unit > T::ZERO && unit.is_finite();
    let target = if known { (target / unit).to_f64() as f32 } else { 0.0 };
    of.begin(lighter);
    let (mut rz, mut before) = (0.0, f32::INFINITY);
    loop {
        let beta = of.residual(down);
        // What was handed out has not helped by much: the limit of this precision is near.
        if !(beta < 0.5 * before) {
            return Refinement::Spent;
        }
        before = beta;
        let first = *iterations;
        let group = Group { beta, goal: larger(target, FALL * beta), max_iterations };
        let (beta, broken) = of.iterate(group, &mut rz, iterations);
        if *iterations == first {
            return if broken { Refinement::Broken } else { Refinement::Done };
        }
        of.hand_out(up);
        if !(beta > target) || *iterations >= max_iterations {
            return Refinement::Done;
        }
        of.renew();
        if broken {
            of.forget();
            rz = 0.0;
        }
    }
}
