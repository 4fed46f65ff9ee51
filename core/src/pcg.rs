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
//! Cost per iteration: one product, one application of D⁻¹, 9 flops per unknown. Memory: x, r, b, p, y.
//!
//! Source: Hestenes & Stiefel 1952.

use crate::bound;
use crate::force::Force;
use crate::jacobi::Preconditioner;
use crate::lanes::Lanes;
use crate::real::{Real, larger};
use crate::report::{Ending, Solve};
use crate::system::{Operator, System};
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

/// The vectors of a solve, one entry per row.
pub(crate) struct Vectors<'a, T> {
    /// Right side
    pub(crate) b: &'a [Vec3<T>],
    /// Solution
    pub(crate) x: &'a mut [Vec3<T>],
    /// Residual
    pub(crate) r: &'a mut [Vec3<T>],
    /// Direction; at a check, δ
    pub(crate) p: &'a mut [Vec3<T>],
    /// A p; after that, z
    pub(crate) y: &'a mut [Vec3<T>],
    /// 1/μ, A ⪰ diag(μ)
    pub(crate) weight: &'a [T],
}

/// Solves A x = b. On an island that nothing holds (`free`), the sum of the momentum equations is repaired at the start
/// and at every check, so that momentum is kept to rounding even when iterations are cut short.
#[inline(never)] // Once a step and island: frames of their own keep the stack shallow.
pub(crate) fn solve<T: Real, F: Force<T>>(
    system: &System<'_, T, F>,
    preconditioner: &impl Preconditioner<T>,
    v: Vectors<'_, T>,
    stop: &Stop<T>,
    free: bool,
) -> Solve<T> {
    let Vectors { b, x, r, p, y, weight } = v;
    for ((x, r), b) in x.iter_mut().zip(r.iter_mut()).zip(b) {
        *x = [T::ZERO; 3];
        *r = *b;
    }
    if r.iter().all(|r| *r == [T::ZERO; 3]) {
        return Solve { iterations: 0, upper: T::ZERO, lower: T::ZERO, ending: Ending::Untouched };
    }
    let mut start = bound::weighted(r, weight);
    // No goal is relative to what has overflowed.
    let relative = if start.is_finite() { stop.relative * stop.relative * start } else { T::ZERO };
    let goal = larger(relative, stop.absolute);
    if free {
        // What acts on the island as a whole it follows as a whole, whatever the tolerance.
        keep_momentum(system.inertia, b, x);
        bound::residual(system, b, x, r, p);
        start = bound::weighted(r, weight);
    }
    let met = start <= goal && start.is_finite();
    if met || stop.max_iterations == 0 {
        let ending = if met { Ending::Untouched } else { Ending::Capped };
        let error = if free { Some(&*p) } else { None };
        preconditioner.apply(r, y);
        let (upper, lower) = (bound::upper(r, error, weight), bound::lower(system, r, error, y));
        return Solve { iterations: 0, upper, lower, ending };
    }

    // Below 16u of where it set out the recurrence measures only its own rounding.
    let blind = T::from_count(16) * T::UNIT_ROUNDOFF;
    let (mut iterations, mut from) = (0, start);
    loop {
        let (target, before) = (larger(goal, blind * blind * from), iterations);
        let stuck = iterate(
            system,
            preconditioner,
            [x, r, p, y],
            weight,
            target,
            stop.max_iterations,
            &mut iterations,
        );
        if free {
            keep_momentum(system.inertia, b, x);
        }
        bound::residual(system, b, x, r, p);
        let reached = bound::weighted(r, weight);
        let floor = bound::weighted(p, weight);
        let ending = if reached <= goal {
            Ending::Converged
        } else if reached <= floor {
            Ending::Floor
        } else if iterations >= stop.max_iterations {
            Ending::Capped
        } else if stuck || !(reached < T::HALF * from) {
            let updates = iterations - before;
            let rounding = bound::attainable(system, x, p, updates, weight, y);
            if reached <= rounding { Ending::Floor } else { Ending::Stalled }
        } else {
            from = reached;
            continue;
        };
        let upper = bound::upper(r, Some(p), weight);
        preconditioner.apply(r, y);
        let lower = bound::lower(system, r, Some(p), y);
        return Solve { iterations, upper, lower, ending };
    }
}

/// Iterates until β ≤ target or the number of iterations is used up; answers whether it broke down (pᵀAp ≤ 0 or NaN).
#[inline(never)]
fn iterate<T: Real, F: Force<T>>(
    system: &System<'_, T, F>,
    preconditioner: &impl Preconditioner<T>,
    [x, r, p, y]: [&mut [Vec3<T>]; 4],
    weight: &[T],
    target: T,
    max_iterations: u32,
    iterations: &mut u32,
) -> bool {
    let mut rz = preconditioner.apply(r, p);
    while *iterations < max_iterations {
        let curvature = system.apply(p, y);
        if !(curvature > T::ZERO) {
            return true;
        }
        let step = rz / curvature;
        let mut beta = Lanes::new();
        for (i, ((((x, r), p), y), weight)) in
            x.iter_mut().zip(r.iter_mut()).zip(p.iter()).zip(y.iter()).zip(weight).enumerate()
        {
            *x = vec3::add_scaled(*x, step, *p);
            *r = vec3::add_scaled(*r, -step, *y);
            beta.add(i, bound::square(*r, *weight));
        }
        *iterations += 1;
        if !(T::HALF * beta.sum() > target) {
            return false;
        }
        let next = preconditioner.apply(r, y);
        let ratio = next / rz;
        for (p, z) in p.iter_mut().zip(y.iter()) {
            *p = vec3::add_scaled(*z, ratio, *p);
        }
        rz = next;
    }
    false
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
