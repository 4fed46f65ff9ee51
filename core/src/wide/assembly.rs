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
use crate::wide::layout::{Layout, eights};
use crate::wide::neighbours::{Neighbours, alike, of_springs};
use crate::wide::work::{Front, Workshop};

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
    /// Eight springs, their rows and other ends.
    #[inline(always)]
    fn new<L: Law, N: Neighbours, const DAMPED: bool>(
        neighbours: N,
        Workshop { position, velocity, springs, .. }: &Workshop<'_, T>,
        scaling: Scaling<T>,
        (spring, at, ends): (N::Spring, usize, N::Ends),
    ) -> Self {
        let (stiffness, rest_length, damping) = if DAMPED {
            let [k, l0, c] = of_springs(neighbours, springs, spring);
            (k, l0, all(scaling.damping) * c)
        } else {
            let [k, l0] = of_springs(neighbours, springs, spring);
            (k, l0, all(T::ZERO))
        };
        let delta = vec3::sub(position.load(at), neighbours.vector(alike(position), ends));
        let speed = vec3::sub(velocity.load(at), neighbours.vector(alike(velocity), ends));
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

/// Eight springs' Hessians.
#[inline(always)]
fn put<T: Real, N: Neighbours>(neighbours: N, planes: &mut [T], spring: N::Spring, h: Hessian<Eight<T>>) {
    let Hessian { alpha, w: [x, y, z] } = h;
    for (k, value) in [alpha, x, y, z].into_iter().enumerate() {
        store(planes, neighbours.place::<4>(spring, k), value);
    }
}

#[inline(always)]
fn put_pull<T: Real, N: Neighbours>(neighbours: N, pulls: &mut [T], spring: N::Spring, pull: Vec3<Eight<T>>) {
    for (k, value) in pull.into_iter().enumerate() {
        store(pulls, neighbours.pull(spring, k), value);
    }
}

/// The Hessians and pulls h f − H Δq̇ of some rows' own springs. Answers how many Hessians are replacements.
#[inline(always)]
pub(crate) fn linearize<T: Real, L: Law, N: Neighbours, const DAMPED: bool>(
    neighbours: N,
    rows: [usize; 2],
    front: &mut Front<'_, T>,
    workshop: &mut Workshop<'_, T>,
    h: T,
    scaling: Scaling<T>,
) -> u32 {
    let mut replaced = all(T::ZERO);
    neighbours.each_spring(
        rows,
        #[inline(always)]
        |springs, at, ends| {
            let spring = Stretched::new::<L, N, DAMPED>(neighbours, workshop, scaling, (springs, at, ends));
            let (mut hessian, mut push) = (spring.hessian(scaling), -spring.tension());
            let mut changed = spring.replaced();
            if slackens::<L>() {
                let taut = spring.taut;
                let alpha = taut.positive_then(hessian.alpha);
                hessian = Hessian { alpha, w: where_positive(taut, hessian.w) };
                (push, changed) = (taut.positive_then(push), taut.positive_then(changed));
            }
            let force = vec3::scale(push, spring.direction);
            let surely = surely_clamped(neighbours, front.inertia, hessian.alpha, at, ends);
            let mut in_b = hessian;
            if count(surely) > 0 {
                let Hessian { alpha, w } = spring.clamped(scaling);
                in_b = Hessian { alpha: choose(surely, alpha, in_b.alpha), w: chosen(surely, w, in_b.w) };
            }
            let pull = vec3::sub(vec3::scale(all(h), force), in_b.mul(spring.speed));
            replaced = replaced + changed;
            put(neighbours, front.hessians, springs, hessian);
            put_pull(neighbours, workshop.pulls, springs, pull);
        },
    );
    neighbours.share(front.hessians);
    count(replaced)
}

/// 1 where a spring alone takes an end's certificate away: see [`crate::assembly`].
#[inline(always)]
fn surely_clamped<T: Real, N: Neighbours>(
    neighbours: N,
    inertia: &[T],
    alpha: Eight<T>,
    at: usize,
    ends: N::Ends,
) -> Eight<T> {
    let compressed = alpha.any(
        #[inline(always)]
        |alpha| alpha < T::ZERO,
    );
    if !compressed {
        return all(T::ZERO);
    }
    let (near, far) = (load(inertia, at), neighbours.number(inertia, ends));
    // Places without a row have no mass; either end may be one.
    let both = near.zip(
        far,
        #[inline(always)]
        |near, far| if near > T::ZERO && far > T::ZERO { T::TWO } else { T::ONE },
    );
    let charge = -(both * alpha);
    let takes = |m: Eight<T>| {
        charge.zip(
            m,
            #[inline(always)]
            |charge, m| if charge > T::ZERO && m > T::ZERO && charge >= m { T::ONE } else { T::ZERO },
        )
    };
    let (near, far) = (takes(near), takes(far));
    near.zip(
        far,
        #[inline(always)]
        |near, far| if near > T::ZERO { near } else { far },
    )
}

#[inline(always)]
fn chosen<T: Real>(first: Eight<T>, [a, b, c]: Vec3<Eight<T>>, [x, y, z]: Vec3<Eight<T>>) -> Vec3<Eight<T>> {
    [choose(first, a, x), choose(first, b, y), choose(first, c, z)]
}

/// b += Σ pulls of some rows.
#[inline(always)]
pub(crate) fn gather<T: Real, N: Neighbours>(
    neighbours: N,
    rows: [usize; 2],
    front: &mut Front<'_, T>,
    pulls: &[T],
) {
    for at in eights(rows) {
        let mut b = front.b.load(at);
        for pull in neighbours.pulls_above(pulls, at) {
            b = vec3::sub(b, pull);
        }
        for pull in neighbours.pulls_own(pulls, at) {
            b = vec3::add(b, pull);
        }
        let m = load(front.inertia, at);
        front.b.store(at, where_positive(m, b));
    }
}

/// What compressed springs charge some rows' μ with, rounded up: see [`crate::certificate::charge`].
#[inline(always)]
pub(crate) fn charge<T: Real, N: Neighbours>(neighbours: N, rows: [usize; 2], front: &mut Front<'_, T>) {
    for at in eights(rows) {
        let mut sum = all(T::ZERO);
        for (h, ends) in neighbours.above(front.hessians, at).chain(neighbours.own(front.hessians, at)) {
            sum = charged(sum, h.alpha, neighbours.number(front.inertia, ends));
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

/// Clamps the compressed ones of some rows' own springs that meet a failing row. The pulls become what that changes in b.
/// Answers how many.
#[inline(always)]
pub(crate) fn clamp<T: Real, L: Law, N: Neighbours, const DAMPED: bool>(
    neighbours: N,
    rows: [usize; 2],
    front: &mut Front<'_, T>,
    workshop: &mut Workshop<'_, T>,
    scaling: Scaling<T>,
) -> u32 {
    let mut clamped = 0;
    neighbours.each_spring(
        rows,
        #[inline(always)]
        |spring, at, ends| {
            let near_fails = fails(load(front.inertia, at), load(front.mu, at));
            let far = [neighbours.number(front.inertia, ends), neighbours.number(front.mu, ends)];
            let met = near_fails + fails(far[0], far[1]);
            let alpha = load(front.hessians, neighbours.place::<4>(spring, 0));
            let hit = met.zip(
                alpha,
                #[inline(always)]
                |met, alpha| if met > T::ZERO && !(alpha >= T::ZERO) { T::ONE } else { T::ZERO },
            );
            let hits = count(hit);
            let mut change = [all(T::ZERO); 3];
            if hits > 0 {
                clamped += hits;
                let [_, x, y, z] = of_springs(neighbours, front.hessians, spring);
                let old = Hessian { alpha, w: [x, y, z] };
                let springs = (spring, at, ends);
                let stretched = Stretched::new::<L, N, DAMPED>(neighbours, workshop, scaling, springs);
                let (new, speed) = (stretched.clamped(scaling), stretched.speed);
                let surely = surely_clamped(neighbours, front.inertia, old.alpha, at, ends);
                let changes = choose(surely, all(T::ZERO), hit);
                change = where_positive(changes, vec3::sub(old.mul(speed), new.mul(speed)));
                let w = chosen(hit, new.w, old.w);
                put(
                    neighbours,
                    front.hessians,
                    spring,
                    Hessian { alpha: choose(hit, new.alpha, old.alpha), w },
                );
            }
            put_pull(neighbours, workshop.pulls, spring, change);
        },
    );
    neighbours.share(front.hessians);
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
