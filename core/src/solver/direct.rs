//! What direct solvers share: factors of A are used as often as it takes, and the answer is certified like PCG's.
//!
//! x ← x + (LDLᵀ)⁻¹(b − Ax), r computed anew each time (iterative refinement). It stops by the rules of [`super::pcg`];
//! one round is the rule. Where the factors break down (a pivot that rounding makes ≤ 0, or no progress above the floor)
//! block-Jacobi PCG answers instead and the report says so.
//!
//! The lower bound is nearly the error itself: z = (LDLᵀ)⁻¹r gives (rᵀz)²/(zᵀAz) ≈ rᵀA⁻¹r. Where |r| ≤ δ throughout, no z
//! gives anything above 0, and none is looked for.
//!
//! Source: Higham, *Accuracy and Stability of Numerical Algorithms*, chapter 12 (iterative refinement).

use crate::bound;
use crate::force::Force;
use crate::real::{Real, larger};
use crate::report::{Ending, Solve};
use crate::solver::{Jacobi, Preconditioner, Problem, Stop, pcg};
use crate::system::System;
use crate::vec3::{self, Vec3};

/// Factors of a matrix, made anew for each system.
pub(crate) trait Factors<T: Real> {
    /// Factors A; the inverted pivots may go to `pivots`, one per row. `false` if a pivot is not positive.
    fn factor<F: Force<T>>(&mut self, system: &System<'_, T, F>, pivots: &mut [[T; 6]]) -> bool;

    /// x ← (LDLᵀ)⁻¹ x.
    fn solve(&mut self, pivots: &[[T; 6]], x: &mut [Vec3<T>]);
}

/// Solves A x = b. Of the vectors b and μ come in; x and 1/μ go out.
#[inline(never)]
pub(crate) fn solve<T: Real, F: Force<T>, D: Factors<T>>(
    problem: Problem<'_, '_, T, F>,
    stop: &Stop<T>,
    factors: &mut D,
) -> Solve<T> {
    let Problem { system, vectors: v, block, free } = problem;
    invert(v.mu);
    let nothing = v.start();
    if nothing {
        let none = T::ZERO;
        return Solve { iterations: 0, upper: none, lower: none, ending: Ending::Untouched, fallback: false };
    }
    let mut from = bound::weighted(v.r, v.mu);
    // No goal is relative to what has overflowed.
    let relative = if from.is_finite() { stop.relative * stop.relative * from } else { T::ZERO };
    let goal = larger(relative, stop.absolute);
    if free {
        from = v.check(&system, true);
    }
    let untouched = from <= goal && from.is_finite();
    let mut ending = if untouched { Some(Ending::Untouched) } else { None };
    let mut sound = untouched || factors.factor(&system, block);
    let mut iterations = 0;
    while sound && ending.is_none() {
        if iterations >= stop.max_iterations {
            ending = Some(Ending::Capped);
            break;
        }
        copy(v.r, v.y);
        factors.solve(block, v.y);
        for (x, y) in v.x.iter_mut().zip(v.y.iter()) {
            *x = vec3::add(*x, *y);
        }
        iterations += 1;
        let reached = v.check(&system, free);
        if reached <= goal {
            ending = Some(Ending::Converged);
        } else if reached <= bound::weighted(v.p, v.mu) {
            ending = Some(Ending::Floor);
        } else if !(reached < T::HALF * from) {
            let rounding = bound::attainable(&system, v.x, v.p, iterations, v.mu, v.y);
            sound = reached <= rounding;
            ending = Some(Ending::Floor);
        }
        from = reached;
    }
    let Some(ending) = ending.filter(|_| sound) else {
        // Twice inverted, μ is off by two roundings: the bounds' cover has room for more.
        invert(v.mu);
        let left = Stop { max_iterations: stop.max_iterations.saturating_sub(iterations), ..*stop };
        let solve = pcg::solve(&system, &Jacobi::new(&system, block), v, &left, free);
        return Solve { iterations: solve.iterations.saturating_add(iterations), fallback: true, ..solve };
    };
    let upper = bound::upper(v.r, v.p, v.mu);
    let lower = if within(v.r, v.p) {
        T::ZERO
    } else {
        if untouched {
            Jacobi::new(&system, block).apply(v.r, v.y);
        } else {
            copy(v.r, v.y);
            factors.solve(block, v.y);
        }
        bound::lower(&system, v.r, v.y, v.b, v.p)
    };
    Solve { iterations, upper, lower, ending, fallback: false }
}

/// μ → 1/μ
fn invert<T: Real>(mu: &mut [T]) {
    for mu in mu.iter_mut() {
        *mu = T::ONE / *mu;
    }
}

/// y = r. The sum is not taken for a copy, for which a library routine would be linked.
fn copy<T: Real>(r: &[Vec3<T>], y: &mut [Vec3<T>]) {
    for (y, r) in y.iter_mut().zip(r) {
        *y = vec3::add([T::ZERO; 3], *r);
    }
}

/// |r| ≤ δ in every component.
fn within<T: Real>(r: &[Vec3<T>], error: &[Vec3<T>]) -> bool {
    let mut within = true;
    for (r, e) in r.iter().zip(error) {
        within &= r[0].abs() <= e[0] && r[1].abs() <= e[1] && r[2].abs() <= e[2];
    }
    within
}
