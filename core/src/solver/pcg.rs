//! Preconditioned conjugate gradients for A x = b from x = 0, with a certified end.
//!
//! x_{k+1} = x_k + a p, r_{k+1} = r_k − a A p, a = rᵀz/pᵀAp, z = D⁻¹r, p ← z + (r₊ᵀz₊/rᵀz) p.
//!
//! Iterations stop on β = ½ Σ|rᵢ|²/μᵢ, the upper bound on the error's energy: at the first of β ≤ R²β₀, β ≤ J,
//! β ≤ its own rounding (*at the floor*: success; that of r, or where nothing improves any more that of x as well), or
//! the maximal number of iterations. The recurrence's r
//! drifts from b − Ax; so once it says "done", r is computed anew with its rounding bound, and if the true β does not
//! agree, iterations go on from the true residual. Every exit reports the bounds of the x it leaves.
//!
//! (A test |r| ≤ tol·|b| with a warm start would be a trap: at small dt b is about Mq̇, one iteration passes, and a
//! smaller dt gives a worse answer. Hence from zero, for the *change* of velocity.)
//!
//! Cost per iteration: one product, one sweep over the vectors that applies D⁻¹ on the way, one update of p. Memory: x, r,
//! b, p, y.
//!
//! Source: Hestenes & Stiefel 1952.

use crate::bound;
use crate::force::Force;
use crate::parts::Vectors;
use crate::real::{Real, larger};
use crate::report::{Ending, Solve};
use crate::solver::Preconditioner;
use crate::system::System;
use crate::vec3::{self, Vec3};

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop<T> {
    /// R: β ≤ R²β₀.
    pub relative: T,
    /// J, joules: β ≤ J.
    pub absolute: T,
    /// At most so many iterations per island.
    pub max_iterations: u32,
}

impl<T: Real> Stop<T> {
    /// R = 1e-6 (f64) or 1e-4 (f32), J = 0, at most 10,000 iterations.
    pub const fn new() -> Self {
        Self { relative: T::DEFAULT_TOLERANCE, absolute: T::ZERO, max_iterations: 10_000 }
    }
}

impl<T: Real> Default for Stop<T> {
    fn default() -> Self {
        Self::new()
    }
}

/// Solves A x = b. On an island that nothing holds (`free`), the sum of the momentum equations is repaired at the start
/// and at every check, so that momentum is kept to rounding even when iterations are cut short. Of the vectors b and μ
/// come in; x and 1/μ go out.
#[inline]
pub(crate) fn solve<T: Real, F: Force<T>>(
    system: &System<'_, T, F>,
    preconditioner: &impl Preconditioner<T>,
    v: &mut Vectors<'_, T>,
    stop: &Stop<T>,
    free: bool,
) -> Solve<T> {
    solve_by(system, &mut Plain(preconditioner), v, stop, free)
}

/// What is done between two checks; everything else of a solve is the same however the iterations are made.
pub(crate) trait Iteration<T: Real> {
    /// Iterates from x and r until β ≤ target or the number of iterations is used up; answers whether it broke down
    /// (pᵀAp ≤ 0 or NaN).
    fn iterate<F: Force<T>>(
        &mut self,
        system: &System<'_, T, F>,
        v: &mut Vectors<'_, T>,
        target: T,
        max_iterations: u32,
        iterations: &mut u32,
    ) -> bool;

    /// z = D⁻¹ r into y.
    fn precondition<F: Force<T>>(&mut self, system: &System<'_, T, F>, v: &mut Vectors<'_, T>);
}

/// As [`solve`], with the iterations made by `by`.
#[inline(never)] // Once a step and island: frames of their own keep the stack shallow.
pub(crate) fn solve_by<T: Real, F: Force<T>>(
    system: &System<'_, T, F>,
    by: &mut impl Iteration<T>,
    v: &mut Vectors<'_, T>,
    stop: &Stop<T>,
    free: bool,
) -> Solve<T> {
    for mu in v.mu.iter_mut() {
        *mu = T::ONE / *mu;
    }
    if v.start() {
        return Solve {
            iterations: 0,
            upper: T::ZERO,
            lower: T::ZERO,
            ending: Ending::Untouched,
            fallback: false,
        };
    }
    let mut from = bound::weighted(v.r, v.mu);
    // No goal is relative to what has overflowed.
    let relative = if from.is_finite() { stop.relative * stop.relative * from } else { T::ZERO };
    let goal = larger(relative, stop.absolute);
    if free {
        // What acts on the island as a whole it follows as a whole, whatever the tolerance.
        from = v.check(system, true);
    }
    let (mut iterations, mut stuck) = (0, false);
    let mut ending = if from <= goal && from.is_finite() { Some(Ending::Untouched) } else { None };
    let mut reached = from;
    while ending.is_none() {
        // Below 16u of where it set out the recurrence measures only its own rounding.
        let blind = T::from_count(16) * T::UNIT_ROUNDOFF;
        let (target, before) = (larger(goal, blind * blind * from), iterations);
        if iterations < stop.max_iterations {
            stuck = by.iterate(system, v, target, stop.max_iterations, &mut iterations);
            reached = v.check(system, free);
        }
        ending = if reached <= goal {
            Some(Ending::Converged)
        } else if reached <= bound::weighted(v.p, v.mu) {
            Some(Ending::Floor)
        } else if iterations >= stop.max_iterations {
            Some(Ending::Capped)
        } else if stuck || !(reached < T::HALF * from) {
            let rounding = bound::attainable(system, v.x, v.p, iterations - before, v.mu, v.y);
            Some(if reached <= rounding { Ending::Floor } else { Ending::Stalled })
        } else {
            None
        };
        from = reached;
    }
    let upper = bound::upper(v.r, v.p, v.mu);
    by.precondition(system, v);
    let lower = bound::lower(system, v.r, v.y, v.b, v.p);
    Solve { iterations, upper, lower, ending: ending.unwrap_or(Ending::Stalled), fallback: false }
}

impl<T: Real> Vectors<'_, T> {
    /// x = 0 and so r = b, exactly: δ = 0. Answers whether there is nothing to solve.
    #[inline(never)]
    pub(crate) fn start(&mut self) -> bool {
        let mut nothing = true;
        for (((x, r), p), b) in
            self.x.iter_mut().zip(self.r.iter_mut()).zip(self.p.iter_mut()).zip(self.b.iter())
        {
            (*x, *p) = ([T::ZERO; 3], [T::ZERO; 3]);
            // b itself; but the sum is not taken for a copy, for which a library routine of 1.5 KiB would be linked.
            *r = vec3::add([T::ZERO; 3], *b);
            nothing &= *b == [T::ZERO; 3];
        }
        nothing
    }

    /// r = b − A x computed anew, δ into p; on a `free` island the momentum equations are repaired first. Answers β.
    #[inline(never)]
    pub(crate) fn check<F: Force<T>>(&mut self, system: &System<'_, T, F>, free: bool) -> T {
        if free {
            keep_momentum(system.matrix.inertia, self.b, self.x);
        }
        bound::residual(system, self.b, self.x, self.r, self.p);
        bound::weighted(self.r, self.mu)
    }
}

/// In the scene's own vectors, with any preconditioner.
struct Plain<'a, P>(&'a P);

impl<T: Real, P: Preconditioner<T>> Iteration<T> for Plain<'_, P> {
    #[inline(never)]
    fn iterate<F: Force<T>>(
        &mut self,
        system: &System<'_, T, F>,
        v: &mut Vectors<'_, T>,
        target: T,
        max_iterations: u32,
        iterations: &mut u32,
    ) -> bool {
        for (p, y) in v.p.iter_mut().zip(v.y.iter_mut()) {
            (*p, *y) = ([T::ZERO; 3], [T::ZERO; 3]);
        }
        // The first sweep has no step to make: it finds z.
        let (mut step, mut rz) = (T::ZERO, T::ZERO);
        loop {
            let (beta, next) = self.0.sweep(step, [v.x, v.r, v.p, v.y], v.mu);
            if !(T::HALF * beta > target) || *iterations >= max_iterations {
                return false;
            }
            let ratio = if rz > T::ZERO { next / rz } else { T::ZERO };
            for (p, y) in v.p.iter_mut().zip(v.y.iter_mut()) {
                *p = vec3::add_scaled(*y, ratio, *p);
                *y = [T::ZERO; 3];
            }
            let curvature = system.add_product(v.p, v.y);
            if !(curvature > T::ZERO) {
                return true;
            }
            step = next / curvature;
            rz = next;
            *iterations += 1;
        }
    }

    #[inline]
    fn precondition<F: Force<T>>(&mut self, _: &System<'_, T, F>, v: &mut Vectors<'_, T>) {
        self.0.apply(v.r, v.y);
    }
}

/// x += c with c = Σ(b − m̃x)/Σm̃: the sum of all rows of A x = b then holds, since internal springs cancel in it. It is
/// a Galerkin correction: the error's A-norm cannot grow.
#[inline(never)]
fn keep_momentum<T: Real>(inertia: &[T], b: &[Vec3<T>], x: &mut [Vec3<T>]) {
    let (mut missing, mut mass) = ([T::ZERO; 3], T::ZERO);
    for ((b, x), m) in b.iter().zip(x.iter()).zip(inertia) {
        missing = vec3::add(missing, vec3::add_scaled(*b, -*m, *x));
        mass += *m;
    }
    if mass > T::ZERO {
        let c = vec3::scale(T::ONE / mass, missing);
        for x in x.iter_mut() {
            *x = vec3::add(*x, c);
        }
    }
}
