//! How far from exact a solve can be: both bounds on the energy of its error, from a residual computed anew.
//!
//! With e = x − A⁻¹b and r = b − Ax:  ‖e‖²_A = rᵀA⁻¹r.
//!
//! - Above: A ⪰ diag(μ) gives ½‖e‖²_A ≤ ½ Σ |rᵢ|²/μᵢ.
//! - Below: rᵀz = −eᵀAz ≤ ‖e‖_A ‖z‖_A for *any* z, so ½‖e‖²_A ≥ ½ (rᵀz)²/(zᵀAz). With z = D⁻¹r this is what one more
//!   PCG step would gain, and never less than ½ rᵀU⁻¹r for z = U⁻¹r, A ⪯ U. An inexact D⁻¹ does no harm.
//!
//! x solves for a velocity, so both are in joules: the energy of the velocity error plus that of the position error it
//! causes. r is computed in rounded arithmetic; a running error analysis goes along and bounds |r̂ − r| ≤ δ
//! component by component, for the matrix *of the stored floats*; δ is added above and taken off below. (Sums of
//! Hestenes and Stiefel would bound an earlier iterate.)
//!
//! Cost: one product at each check of a solve (most have one), one more at its end. Valid for rows of up to 2¹⁷ springs in f32, 2⁴⁶ in f64.
//!
//! Sources: Higham, *Accuracy and Stability of Numerical Algorithms*, §3.3 (running error analysis); Greenbaum 1997.

use crate::force::Force;
use crate::hessian::Hessian;
use crate::lanes::Lanes;
use crate::real::Real;
use crate::system::System;
use crate::vec3::{self, Vec3};

/// δ of one row from its running sum: u·(1 + 2⁻⁴)·g plus what underflow can lose.
#[inline(always)]
fn delta<T: Real>(g: Vec3<T>) -> Vec3<T> {
    let sixteenth = T::HALF * T::HALF * T::HALF * T::HALF;
    let unit = T::UNIT_ROUNDOFF * (T::ONE + sixteenth);
    g.map(|g| unit * g + T::MIN_POSITIVE)
}

/// |a| by component.
#[inline(always)]
fn magnitude<T: Real>(a: Vec3<T>) -> Vec3<T> {
    a.map(T::abs)
}

/// 7·(|α||d| + |w|(|w|·|d|)) by component: what the rounding of one spring's term H·d cannot exceed, in units of u.
#[inline(always)]
fn term_error<T: Real>(h: &Hessian<T>, d: Vec3<T>) -> Vec3<T> {
    let (w, d) = (magnitude(h.w), magnitude(d));
    let along = vec3::dot(w, d) + T::MIN_POSITIVE;
    let seven = T::from_count(7);
    vec3::scale(seven, vec3::add_scaled(vec3::scale(h.alpha.abs(), d), along, w))
}

/// r = b − A x by the same sums as the operator's, and in `error` the bound δ on its rounding, by component.
#[inline(never)]
pub(crate) fn residual<T: Real, F: Force<T>>(
    system: &System<'_, T, F>,
    b: &[Vec3<T>],
    x: &[Vec3<T>],
    r: &mut [Vec3<T>],
    error: &mut [Vec3<T>],
) {
    for (((y, g), x), m) in r.iter_mut().zip(error.iter_mut()).zip(x).zip(system.inertia) {
        *y = vec3::scale(*m, *x);
        *g = magnitude(*y);
    }
    let mut add = |row: usize, product: Vec3<T>, rounding: Vec3<T>| {
        if let (Some(y), Some(g)) = (r.get_mut(row), error.get_mut(row)) {
            *y = vec3::add(*y, product);
            *g = vec3::add(vec3::add(*g, magnitude(*y)), rounding);
        }
    };
    for (a, b, h) in system.each_pair() {
        let d = crate::selection::difference(a, b, x);
        let (product, rounding) = (h.mul(d), term_error(&h, d));
        add(a, product, rounding);
        add(b, vec3::scale(-T::ONE, product), rounding);
    }
    system.each_anchor(|a, h| {
        if let Some(d) = x.get(a) {
            add(a, h.mul(*d), term_error(&h, *d));
        }
    });
    for ((y, g), b) in r.iter_mut().zip(error.iter_mut()).zip(b) {
        *y = vec3::sub(*b, *y);
        *g = delta(vec3::add(*g, magnitude(*y)));
    }
}

/// |r|²/μ of one row, `weight` = 1/μ. Multiplied in this order it neither underflows nor overflows where the square of
/// r would.
#[inline(always)]
pub(crate) fn square<T: Real>(r: Vec3<T>, weight: T) -> T {
    vec3::dot(vec3::scale(weight, r), r)
}

/// ½ Σ |rᵢ|²/μᵢ as the stopping rules use it: not rounded up.
#[inline(never)]
pub(crate) fn weighted<T: Real>(r: &[Vec3<T>], weight: &[T]) -> T {
    let mut sum = Lanes::new();
    for (i, (r, weight)) in r.iter().zip(weight).enumerate() {
        sum.add(i, square(*r, *weight));
    }
    T::HALF * sum.sum()
}

/// ½ Σ (δᵢ + k u (|A||x|)ᵢ)²/μᵢ: the β that rounding alone can leave after k updates of x, each of which rounds x by
/// u|x| at most. What is stuck below it is as exact as the precision allows (Greenbaum 1997, attainable accuracy).
/// `size` is scratch.
#[inline(never)]
pub(crate) fn attainable<T: Real, F: Force<T>>(
    system: &System<'_, T, F>,
    x: &[Vec3<T>],
    error: &[Vec3<T>],
    updates: u32,
    weight: &[T],
    size: &mut [Vec3<T>],
) -> T {
    for ((size, x), m) in size.iter_mut().zip(x).zip(system.inertia) {
        *size = vec3::scale(*m, magnitude(*x));
    }
    let stiffest = |h: &Hessian<T>| h.alpha.abs() + vec3::dot(h.w, h.w);
    let at = |i: usize| x.get(i).map_or([T::ZERO; 3], |x| magnitude(*x));
    for (a, b, h) in system.each_pair() {
        let term = vec3::scale(stiffest(&h), vec3::add(at(a), at(b)));
        for row in [a, b] {
            if let Some(size) = size.get_mut(row) {
                *size = vec3::add(*size, term);
            }
        }
    }
    system.each_anchor(|a, h| {
        if let Some(size) = size.get_mut(a) {
            *size = vec3::add_scaled(*size, stiffest(&h), at(a));
        }
    });
    let unit = T::from_count(updates as usize) * T::UNIT_ROUNDOFF;
    for (size, error) in size.iter_mut().zip(error) {
        *size = vec3::add_scaled(*error, unit, *size);
    }
    weighted(size, weight)
}

/// A factor and a term that cover the rounding and underflow of a sum of `n` non-negative terms.
fn cover<T: Real>(n: usize) -> (T, T) {
    let n = T::from_count(n + 16);
    (T::ONE + T::TWO * n * T::UNIT_ROUNDOFF, n * T::MIN_POSITIVE)
}

/// ½ Σ (|rᵢ| + δᵢ)²/μᵢ, rounded up: nothing that ½‖e‖²_A can exceed.
#[inline(never)]
pub(crate) fn upper<T: Real>(r: &[Vec3<T>], error: Option<&[Vec3<T>]>, weight: &[T]) -> T {
    let mut sum = Lanes::new();
    for (i, (r, weight)) in r.iter().zip(weight).enumerate() {
        let delta = error.and_then(|error| error.get(i)).copied().unwrap_or([T::ZERO; 3]);
        sum.add(i, square(vec3::add(magnitude(*r), delta), *weight));
    }
    let (factor, term) = cover(3 * r.len());
    T::HALF * sum.sum() * factor + term
}

/// ½ (rᵀz − Σδ|z|)²/(zᵀA⁺z), rounded down: ½‖e‖²_A is at least this. A⁺ ⪰ A drops the negative α.
#[inline(never)]
pub(crate) fn lower<T: Real, F: Force<T>>(
    system: &System<'_, T, F>,
    r: &[Vec3<T>],
    error: Option<&[Vec3<T>]>,
    z: &[Vec3<T>],
) -> T {
    let (mut product, mut loss, mut form) = (Lanes::new(), Lanes::new(), Lanes::new());
    for (i, ((r, z), m)) in r.iter().zip(z).zip(system.inertia).enumerate() {
        let delta = error.and_then(|error| error.get(i)).copied().unwrap_or([T::ZERO; 3]);
        product.add(i, vec3::dot(*r, *z));
        loss.add(i, vec3::dot(delta, magnitude(*z)));
        // The rounding of the dot product itself is at most (n + 4)u times the sum of its magnitudes.
        form.add(i, *m * vec3::dot(*z, *z));
    }
    let mut magnitudes = Lanes::new();
    for (i, (r, z)) in r.iter().zip(z).enumerate() {
        magnitudes.add(i, vec3::dot(magnitude(*r), magnitude(*z)));
    }
    let plus = |h: Hessian<T>, d: Vec3<T>| {
        let along = vec3::dot(magnitude(h.w), magnitude(d));
        let exact = vec3::dot(h.w, d);
        // (w·d)² with the rounding of w·d, at most 4u|w|·|d|, added first.
        let safe = exact.abs() + T::from_count(4) * T::UNIT_ROUNDOFF * along;
        let alpha = if h.alpha > T::ZERO { h.alpha } else { T::ZERO };
        alpha * vec3::dot(d, d) + safe * safe
    };
    for (e, (a, b, h)) in system.each_pair().enumerate() {
        form.add(e, plus(h, crate::selection::difference(a, b, z)));
    }
    let mut e = system.pairs.len();
    system.each_anchor(|a, h| {
        if let Some(d) = z.get(a) {
            form.add(e, plus(h, *d));
            e += 1;
        }
    });
    let terms = T::from_count(r.len() + e + 16);
    let (factor, term) = cover(r.len() + e);
    let gain = product.sum() - loss.sum() * factor - terms * T::UNIT_ROUNDOFF * magnitudes.sum() - term;
    let form = form.sum() * factor + term;
    if gain > T::ZERO && form > T::ZERO { T::HALF * (gain / form) * gain / factor } else { T::ZERO }
}
