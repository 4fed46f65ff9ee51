//! Assembly in lanes, by the formulas of [`crate::assembly`]: Hessians, b and the charges of μ.
//!
//! Each spring is computed once, at its lower end; what it adds to b waits in *pulls*, and rows gather: first from the
//! farthest row above, last from the farthest below. That is the order of the scene's own assembly where each row's springs
//! come in the order of their other ends, and then the bits are the same.

use crate::hessian::{Hessian, Scaling};
use crate::law::Law;
use crate::real::Real;
use crate::vec3::{self, Vec3};
use crate::wide::eight::{Eight, all, choose, load, store, where_positive};
use crate::wide::layout::Layout;
use crate::wide::work::{Front, Workshop, hessians, of_run, put_of_run};

/// What is known of eight springs at the present state.
struct Stretched<T> {
    stiffness: Eight<T>,
    rest_length: Eight<T>,
    /// θh c
    damping: Eight<T>,
    length: Eight<T>,
    inverse: Eight<T>,
    direction: Vec3<Eight<T>>,
    /// Δq̇
    speed: Vec3<Eight<T>>,
    /// 1, or 0 where the spring is slack
    taut: Eight<T>,
}

impl<T: Real> Stretched<T> {
    /// The springs of a run at eight places.
    #[inline(always)]
    fn new<L: Law, const DAMPED: bool>(
        layout: &Layout,
        front: &Front<'_, T>,
        workshop: &Workshop<'_, T>,
        scaling: Scaling<T>,
        [run, at, far]: [usize; 3],
    ) -> Self {
        let n = layout.plane();
        let (stiffness, rest_length, damping) = if DAMPED {
            let [k, l0, c] = of_run(front.springs, n, run, at);
            (k, l0, all(scaling.damping) * c)
        } else {
            let [k, l0] = of_run(front.springs, n, run, at);
            (k, l0, all(T::ZERO))
        };
        let delta = vec3::sub(workshop.position.load(at), workshop.position.load(far));
        let speed = vec3::sub(workshop.velocity.load(at), workshop.velocity.load(far));
        let squared = vec3::dot(delta, delta);
        let length = squared.sqrt().zip(
            squared,
            #[inline(always)]
            |length, squared| if squared < T::MIN_POSITIVE { T::ZERO } else { length },
        );
        let inverse = length.map(
            #[inline(always)]
            |length| if length == T::ZERO { T::ZERO } else { T::ONE / length },
        );
        let direction = vec3::scale(inverse, delta);
        let (rest_length, taut) = if slackens::<L>() {
            let slack = length.zip(
                rest_length,
                #[inline(always)]
                |length, rest| if rest < T::ZERO && length < -rest { T::ZERO } else { T::ONE },
            );
            (rest_length.abs(), slack)
        } else {
            (rest_length, all(T::ONE))
        };
        Self { stiffness, rest_length, damping, length, inverse, direction, speed, taut }
    }

    #[inline(always)]
    fn tension(&self) -> Eight<T> {
        self.stiffness * (self.length - self.rest_length)
    }

    /// See [`Hessian::new`].
    #[inline(always)]
    fn hessian(&self, scaling: Scaling<T>) -> Hessian<Eight<T>> {
        let s = all(scaling.stiffness);
        let across = self.stiffness * self.rest_length * self.inverse;
        let w = (s * across + self.damping).sqrt();
        let alpha = (s * (self.tension() * self.inverse)).zip(
            self.length,
            #[inline(always)]
            |alpha, length| if length == T::ZERO { T::ZERO } else { alpha },
        );
        let instead = (s * self.stiffness).zip(
            self.length,
            #[inline(always)]
            |alpha, length| if length == T::ZERO { alpha } else { T::ZERO },
        );
        Hessian { alpha: alpha + instead, w: vec3::scale(w, self.direction) }
    }

    /// See [`Hessian::clamped`].
    #[inline(always)]
    fn clamped(&self, scaling: Scaling<T>) -> Hessian<Eight<T>> {
        let w = (all(scaling.stiffness) * self.stiffness + self.damping).sqrt();
        Hessian { alpha: all(T::ZERO), w: vec3::scale(w, self.direction) }
    }

    /// How many have no length, but a rest length.
    #[inline(always)]
    fn replaced(&self) -> Eight<T> {
        self.length.zip(
            self.rest_length,
            #[inline(always)]
            |length, rest| if length == T::ZERO && rest > T::ZERO { T::ONE } else { T::ZERO },
        )
    }
}

/// The springs' Hessians and pulls h f − H Δq̇. Answers how many Hessians are replacements.
#[inline(always)]
pub(crate) fn linearize<T: Real, L: Law, const DAMPED: bool>(
    layout: &Layout,
    front: &mut Front<'_, T>,
    workshop: &mut Workshop<'_, T>,
    h: T,
    scaling: Scaling<T>,
) -> u32 {
    let n = layout.plane();
    let mut replaced = all(T::ZERO);
    for (run, d) in layout.distances().iter().enumerate() {
        for at in layout.tiles() {
            let spring =
                Stretched::new::<L, DAMPED>(layout, front, workshop, scaling, [run, at, at + *d as usize]);
            let (mut hessian, mut push) = (spring.hessian(scaling), -spring.tension());
            let mut changed = spring.replaced();
            if slackens::<L>() {
                let taut = spring.taut;
                let alpha = taut.positive_then(hessian.alpha);
                hessian = Hessian { alpha, w: where_positive(taut, hessian.w) };
                (push, changed) = (taut.positive_then(push), taut.positive_then(changed));
            }
            let force = vec3::scale(push, spring.direction);
            let pull = vec3::sub(vec3::scale(all(h), force), hessian.mul(spring.speed));
            replaced = replaced + changed;
            let Hessian { alpha, w: [x, y, z] } = hessian;
            put_of_run(front.hessians, n, run, at, [alpha, x, y, z]);
            put_of_run(workshop.pulls, n, run, at, pull);
        }
    }
    count(replaced)
}

/// b += Σ pulls, rows only.
#[inline(always)]
pub(crate) fn gather<T: Real>(layout: &Layout, front: &mut Front<'_, T>, pulls: &[T]) {
    let n = layout.plane();
    for at in layout.tiles() {
        let mut b = front.b.load(at);
        for (run, d) in layout.distances().iter().enumerate().rev() {
            b = vec3::sub(b, of_run(pulls, n, run, at - *d as usize));
        }
        for run in 0..layout.runs {
            b = vec3::add(b, of_run(pulls, n, run, at));
        }
        let m = load(front.inertia, at);
        front.b.store(at, where_positive(m, b));
    }
}

/// What compressed springs charge μ with, rounded up: see [`crate::certificate::charge`].
#[inline(always)]
pub(crate) fn charge<T: Real>(layout: &Layout, front: &mut Front<'_, T>) {
    let n = layout.plane();
    for at in layout.tiles() {
        let mut sum = all(T::ZERO);
        for (run, d) in layout.distances().iter().enumerate().rev() {
            let above = at - *d as usize;
            sum = charged(sum, load(front.hessians, 4 * run * n + above), load(front.inertia, above));
        }
        for (run, d) in layout.distances().iter().enumerate() {
            let below = at + *d as usize;
            sum = charged(sum, load(front.hessians, 4 * run * n + at), load(front.inertia, below));
        }
        store(front.mu, at, sum);
    }
}

/// A charge of c max(0, −α), c = 2 if the other end is a row too, else 1.
#[inline(always)]
fn charged<T: Real>(sum: Eight<T>, alpha: Eight<T>, other: Eight<T>) -> Eight<T> {
    let up = T::ONE + T::TWO * T::TWO * T::UNIT_ROUNDOFF;
    let c = other.map(
        #[inline(always)]
        |m| if m > T::ZERO { T::TWO } else { T::ONE },
    );
    let more = (sum - c * alpha) * all(up);
    let keep = alpha.map(
        #[inline(always)]
        |a| if a >= T::ZERO { T::ONE } else { T::ZERO },
    );
    choose(keep, sum, more)
}

/// μ from the charges, rounded down; answers whether every row is certified.
#[inline(always)]
pub(crate) fn certify<T: Real>(layout: &Layout, front: &mut Front<'_, T>) -> bool {
    let down = all(T::ONE - T::TWO * T::TWO * T::UNIT_ROUNDOFF);
    let mut failing = all(T::ZERO);
    for at in layout.tiles() {
        let m = load(front.inertia, at);
        let mu = (m - load(front.mu, at)) * down;
        failing = failing + fails(m, mu);
        store(front.mu, at, mu);
    }
    count(failing) == 0
}

/// 1 where there is a row whose μ is not positive (NaN too), else 0.
#[inline(always)]
pub(crate) fn fails<T: Real>(m: Eight<T>, mu: Eight<T>) -> Eight<T> {
    m.zip(
        mu,
        #[inline(always)]
        |m, mu| if !(mu > T::ZERO) && m != T::ZERO { T::ONE } else { T::ZERO },
    )
}

/// Clamps the compressed springs that meet a failing row. The pulls become what that changes in b. Answers how many.
#[inline(always)]
pub(crate) fn clamp<T: Real, L: Law, const DAMPED: bool>(
    layout: &Layout,
    front: &mut Front<'_, T>,
    workshop: &mut Workshop<'_, T>,
    scaling: Scaling<T>,
) -> u32 {
    let n = layout.plane();
    let mut clamped = 0;
    for (run, d) in layout.distances().iter().enumerate() {
        for at in layout.tiles() {
            let far = at + *d as usize;
            let near_fails = fails(load(front.inertia, at), load(front.mu, at));
            let met = near_fails + fails(load(front.inertia, far), load(front.mu, far));
            let old = hessians(front.hessians, n, run, at);
            let hit = met.zip(
                old.alpha,
                #[inline(always)]
                |met, alpha| if met > T::ZERO && !(alpha >= T::ZERO) { T::ONE } else { T::ZERO },
            );
            let hits = count(hit);
            let mut change = [all(T::ZERO); 3];
            if hits > 0 {
                clamped += hits;
                let spring = Stretched::new::<L, DAMPED>(layout, front, workshop, scaling, [run, at, far]);
                let new = spring.clamped(scaling);
                change = where_positive(hit, vec3::sub(old.mul(spring.speed), new.mul(spring.speed)));
                let ([a, b, c], [x, y, z]) = (old.w, new.w);
                let chosen = [
                    choose(hit, new.alpha, old.alpha),
                    choose(hit, x, a),
                    choose(hit, y, b),
                    choose(hit, z, c),
                ];
                put_of_run(front.hessians, n, run, at, chosen);
            }
            put_of_run(workshop.pulls, n, run, at, change);
        }
    }
    clamped
}

/// May any spring go slack?
#[inline(always)]
fn slackens<L: Law>() -> bool {
    L::slackens(true) || L::slackens(false)
}

/// How many ones.
#[inline(always)]
fn count<T: Real>(ones: Eight<T>) -> u32 {
    ones.0.iter().fold(T::ZERO, |sum, one| sum + *one).to_f64() as u32
}
