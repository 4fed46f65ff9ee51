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

/// The vectors of a solve, wherever they lie, and what is done to them. How a solve goes on and when it ends is the same
/// for all ([`drive`]).
pub(crate) trait Iterates<T: Real> {
    /// x = 0 and so r = b, exactly: δ = 0; μ becomes 1/μ. Answers whether there is nothing to solve.
    fn start(&mut self) -> bool;
    /// ½ Σ|rᵢ|²/μᵢ
    fn beta(&mut self) -> T;
    /// r = b − A x computed anew with δ; on a `free` island the momentum equations are repaired first. Answers β.
    fn check(&mut self, free: bool) -> T;
    /// β of δ
    fn rounding(&mut self) -> T;
    /// β that so many updates of x can leave.
    fn attainable(&mut self, updates: u32) -> T;
    /// Iterates from x and r until β ≤ target or the number of iterations is used up; answers whether it broke down
    /// (pᵀAp ≤ 0 or NaN).
    fn iterate(&mut self, target: T, max_iterations: u32, iterations: &mut u32) -> bool;
    /// Is there a more robust way to iterate? If so, [`Iterates::iterate`] takes it from now on.
    #[inline(always)]
    fn fall_back(&mut self) -> bool {
        false
    }
    /// Nothing that ½‖e‖²_A can exceed.
    fn upper(&mut self) -> T;
    /// ½‖e‖²_A is at least this. Spoils all vectors but x.
    fn lower(&mut self) -> T;
}

/// What is done between two checks in the scene's own vectors.
pub(crate) trait Iteration<T: Real> {
    /// See [`Iterates::iterate`].
    fn iterate<F: Force<T>>(
        &mut self,
        system: &System<'_, T, F>,
        v: &mut Vectors<'_, T>,
        target: T,
        max_iterations: u32,
        iterations: &mut u32,
    ) -> bool;

    /// z into y, D⁻¹ r or near it: for the lower bound, which takes any z.
    fn precondition<F: Force<T>>(&mut self, system: &System<'_, T, F>, v: &mut Vectors<'_, T>);

    /// See [`Iterates::fall_back`].
    #[inline(always)]
    fn fall_back<F: Force<T>>(&mut self, _: &System<'_, T, F>) -> bool {
        false
    }
}

/// As [`solve`], with the iterations made by `by`.
#[inline(always)]
pub(crate) fn solve_by<T: Real, F: Force<T>>(
    system: &System<'_, T, F>,
    by: &mut impl Iteration<T>,
    v: &mut Vectors<'_, T>,
    stop: &Stop<T>,
    free: bool,
) -> Solve<T> {
    drive(&mut InVectors { system, by, v }, stop, free)
}

/// Iterates, checks, and certifies: every solve by iterations.
#[inline(never)] // Once a step and island: frames of their own keep the stack shallow.
pub(crate) fn drive<T: Real>(v: &mut impl Iterates<T>, stop: &Stop<T>, free: bool) -> Solve<T> {
    if v.start() {
        return Solve {
            iterations: 0,
            upper: T::ZERO,
            lower: T::ZERO,
            ending: Ending::Untouched,
            fallback: false,
        };
    }
    let mut from = v.beta();
    // No goal is relative to what has overflowed.
    let relative = if from.is_finite() { stop.relative * stop.relative * from } else { T::ZERO };
    let goal = larger(relative, stop.absolute);
    if free {
        // What acts on the island as a whole it follows as a whole, whatever the tolerance.
        from = v.check(true);
    }
    let (mut iterations, mut stuck, mut fallback) = (0, false, false);
    let mut ending = if from <= goal && from.is_finite() { Some(Ending::Untouched) } else { None };
    let mut reached = from;
    while ending.is_none() {
        // Below 16u of where it set out the recurrence measures only its own rounding.
        let blind = T::from_count(16) * T::UNIT_ROUNDOFF;
        let (target, before) = (larger(goal, blind * blind * from), iterations);
        if iterations < stop.max_iterations {
            stuck = v.iterate(target, stop.max_iterations, &mut iterations);
            reached = v.check(free);
        }
        ending = if reached <= goal {
            Some(Ending::Converged)
        } else if reached <= v.rounding() {
            Some(Ending::Floor)
        } else if iterations >= stop.max_iterations {
            Some(Ending::Capped)
        } else if stuck || !(reached < T::HALF * from) {
            let rounding = v.attainable(iterations - before);
            if reached <= rounding {
                Some(Ending::Floor)
            } else if v.fall_back() {
                fallback = true;
                None
            } else {
                Some(Ending::Stalled)
            }
        } else {
            None
        };
        from = reached;
    }
    let (upper, lower) = (v.upper(), v.lower());
    Solve { iterations, upper, lower, ending: ending.unwrap_or(Ending::Stalled), fallback }
}

/// The scene's own vectors, and what iterates in them.
struct InVectors<'s, 'a, T, F, I> {
    system: &'s System<'s, T, F>,
    by: &'s mut I,
    v: &'s mut Vectors<'a, T>,
}

impl<T: Real, F: Force<T>, I: Iteration<T>> Iterates<T> for InVectors<'_, '_, T, F, I> {
    #[inline]
    fn start(&mut self) -> bool {
        for mu in self.v.mu.iter_mut() {
            *mu = T::ONE / *mu;
        }
        self.v.start()
    }
    #[inline]
    fn beta(&mut self) -> T {
        bound::weighted(self.v.r, self.v.mu)
    }
    #[inline]
    fn check(&mut self, free: bool) -> T {
        self.v.check(self.system, free)
    }
    #[inline]
    fn rounding(&mut self) -> T {
        bound::weighted(self.v.p, self.v.mu)
    }
    #[inline]
    fn attainable(&mut self, updates: u32) -> T {
        let v = &mut *self.v;
        bound::attainable(self.system, v.x, v.p, updates, v.mu, v.y)
    }
    #[inline]
    fn iterate(&mut self, target: T, max_iterations: u32, iterations: &mut u32) -> bool {
        self.by.iterate(self.system, self.v, target, max_iterations, iterations)
    }
    #[inline]
    fn fall_back(&mut self) -> bool {
        self.by.fall_back(self.system)
    }
    #[inline]
    fn upper(&mut self) -> T {
        bound::upper(self.v.r, self.v.p, self.v.mu)
    }
    #[inline]
    fn lower(&mut self) -> T {
        self.by.precondition(self.system, self.v);
        bound::lower(self.system, self.v.r, self.v.y, self.v.b, self.v.p)
    }
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
pub(crate) struct Plain<'a, P>(pub(crate) &'a P);

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
