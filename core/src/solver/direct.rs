//! What direct solvers share: factors of A are used as often as it takes, and the answer is certified like PCG's.
//!
//! x ← x + (LDLᵀ)⁻¹(b − Ax), r computed anew each time (iterative refinement). It stops by the rules of [`super::pcg`];
//! one round is the rule. Where the factors break down (a pivot that rounding makes ≤ 0, or no progress above the floor)
//! block-Jacobi PCG answers instead and the report says so.
//!
//! What is left after a direct solve is rounding, so the lower bound is the cheap one: A ⪯ diag(ν), νᵢ = m̃ᵢ + Σ_{e∋i}
//! c_e(max(0, αₑ) + |wₑ|²) (c_e as in the certificate) gives ½‖e‖²_A ≥ ½ Σ |rᵢ|²/νᵢ, without another product.
//!
//! Source: Higham, *Accuracy and Stability of Numerical Algorithms*, chapter 12 (iterative refinement).

use crate::bound;
use crate::force::Force;
use crate::hessian::Hessian;
use crate::lanes::Lanes;
use crate::parts::Vectors;
use crate::real::{Real, larger};
use crate::report::{Ending, Solve};
use crate::solver::{Jacobi, Problem, Stop, invert, pcg};
use crate::system::System;
use crate::vec3::{self, Vec3};

/// Factors of a matrix, made anew for each system.
pub(crate) trait Factors<T: Real> {
    /// Factors A; the inverted pivots may go to `pivots`, one per row. `false` if a pivot is not positive.
    fn factor<F: Force<T>>(&mut self, system: &System<'_, T, F>, pivots: &mut [[T; 6]]) -> bool;

    /// x ← (LDLᵀ)⁻¹ x.
    fn solve(&mut self, pivots: &[[T; 6]], x: &mut [Vec3<T>]);

    /// Goes on from x and r, at most until β ≤ `target` or the number of iterations is used up: here, once.
    #[inline(always)]
    fn advance<F: Force<T>>(
        &mut self,
        on: On<'_, '_, T, F>,
        v: &mut Vectors<'_, T>,
        target: T,
        max_iterations: u32,
        iterations: &mut u32,
    ) {
        let _ = (target, max_iterations);
        refine(self, on.pivots, v, iterations);
    }
}

/// x += (LDLᵀ)⁻¹ r
#[inline(always)]
pub(crate) fn refine<T: Real>(
    factors: &mut (impl Factors<T> + ?Sized),
    pivots: &[[T; 6]],
    v: &mut Vectors<'_, T>,
    iterations: &mut u32,
) {
    copy(v.r, v.y);
    factors.solve(pivots, v.y);
    for (x, y) in v.x.iter_mut().zip(v.y.iter()) {
        *x = vec3::add(*x, *y);
    }
    *iterations += 1;
}

/// What a solve goes on with.
pub(crate) struct On<'s, 'p, T, F> {
    pub(crate) system: &'s System<'p, T, F>,
    pub(crate) pivots: &'s [[T; 6]],
}

/// What a solver knows of the factors it has: whether they are those of the matrix it was last given, and whether it is given
/// that matrix again, with 1/μ in place of μ.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Kept {
    again: bool,
    factored: bool,
}

impl Kept {
    /// The next solve is of another matrix.
    pub(crate) const fn nothing() -> Self {
        Self { again: false, factored: false }
    }

    /// The next solve is of the same matrix.
    pub(crate) fn again(&mut self) {
        self.again = true;
    }
}

/// Solves A x = b. Of the vectors b and μ come in; x and 1/μ go out.
#[inline(never)]
pub(crate) fn solve<T: Real, F: Force<T>, D: Factors<T>>(
    problem: Problem<'_, '_, T, F>,
    stop: &Stop<T>,
    factors: &mut D,
    kept: &mut Kept,
) -> Solve<T> {
    let Problem { system, vectors: v, block, free } = problem;
    let factored = kept.again && kept.factored;
    if !kept.again {
        invert(v.mu);
    }
    *kept = Kept { again: false, factored };
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
    let mut sound = untouched || factored || factors.factor(&system, block);
    kept.factored = factored || (sound && !untouched);
    let mut iterations = 0;
    while sound && ending.is_none() {
        if iterations >= stop.max_iterations {
            ending = Some(Ending::Capped);
            break;
        }
        // Below 16u of where it set out a recurrence measures only its own rounding.
        let blind = T::from_count(16) * T::UNIT_ROUNDOFF;
        let on = On { system: &system, pivots: &*block };
        factors.advance(on, v, larger(goal, blind * blind * from), stop.max_iterations, &mut iterations);
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
        kept.factored = false;
        // Twice inverted, μ is off by two roundings: the bounds' cover has room for more.
        invert(v.mu);
        let left = Stop { max_iterations: stop.max_iterations.saturating_sub(iterations), ..*stop };
        let solve = pcg::solve(&system, &Jacobi::new(&system, block), v, &left, free);
        return Solve { iterations: solve.iterations.saturating_add(iterations), fallback: true, ..solve };
    };
    let upper = bound::upper(v.r, v.p, v.mu);
    let lower = lower(&system, v.r, v.p, v.b);
    Solve { iterations, upper, lower, ending, fallback: false }
}

/// y = r. The sum is not taken for a copy, for which a library routine would be linked.
pub(crate) fn copy<T: Real>(r: &[Vec3<T>], y: &mut [Vec3<T>]) {
    for (y, r) in y.iter_mut().zip(r) {
        *y = vec3::add([T::ZERO; 3], *r);
    }
}

/// ½ Σ (|rᵢ| − δᵢ)²₊/νᵢ, rounded down: ½‖e‖²_A is at least this. `scratch` is for ν.
#[inline(never)]
fn lower<T: Real, F: Force<T>>(
    system: &System<'_, T, F>,
    r: &[Vec3<T>],
    error: &[Vec3<T>],
    scratch: &mut [Vec3<T>],
) -> T {
    let beyond = |r: T, e: T| larger(r.abs() - e, T::ZERO);
    let beyond = |r: &Vec3<T>, e: &Vec3<T>| [beyond(r[0], e[0]), beyond(r[1], e[1]), beyond(r[2], e[2])];
    if r.iter().zip(error).all(|(r, e)| beyond(r, e) == [T::ZERO; 3]) {
        return T::ZERO;
    }
    for (nu, m) in scratch.iter_mut().zip(system.matrix.inertia.iter()) {
        *nu = [*m; 3];
    }
    let mut charge = |row: usize, c: T, h: &Hessian<T>| {
        if let Some(nu) = scratch.get_mut(row) {
            nu[0] += c * (larger(h.alpha, T::ZERO) + vec3::dot(h.w, h.w));
        }
    };
    let rows = r.len();
    system.each_spring(|row, other, h| {
        let c = if other < rows { T::TWO } else { T::ONE };
        charge(row, c, &h);
        charge(other, c, &h);
    });
    system.each_point(|row, h| charge(row, T::ONE, &h));
    let mut sum = Lanes::new();
    for (i, ((r, e), [nu, ..])) in r.iter().zip(error).zip(scratch.iter()).enumerate() {
        let beyond = beyond(r, e);
        sum.add(i, vec3::dot(vec3::scale(T::ONE / *nu, beyond), beyond));
    }
    // The roundings of ν (of a row with all springs, at worst) and of the sum, twice over.
    let n = T::from_count(system.matrix.other.len() + 3 * rows + 32);
    // Underflow rounds to nearest, up as well as down.
    let bound = T::HALF * sum.sum() * (T::ONE - T::TWO * n * T::UNIT_ROUNDOFF) - n * T::MIN_POSITIVE;
    if bound > T::ZERO { bound } else { T::ZERO }
}
