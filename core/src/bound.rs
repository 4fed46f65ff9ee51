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
//! Cost: one product with its rounding at each check of a solve (most have one), one more at its end; in lanes half a product there. Valid for rows of up to 2¹⁷ springs in f32, 2⁴⁶ in f64.
//!
//! The theorem, with its conditions, its proof and where that has gaps: `CERTIFICATE.md` in this crate's folder.
//!
//! Sources: Higham, *Accuracy and Stability of Numerical Algorithms*, §3.3 (running error analysis); Greenbaum 1997.

use crate::force::Force;
use crate::hessian::Hessian;
use crate::lanes::Lanes;
use crate::real::{Number, Real};
use crate::system::System;
use crate::vec3::{self, Vec3};

/// u·(1 + 2⁻⁴): a running sum times this, plus what underflow can lose, is δ.
pub(crate) fn unit<T: Real>() -> T {
    let sixteenth = T::HALF * T::HALF * T::HALF * T::HALF;
    T::UNIT_ROUNDOFF * (T::ONE + sixteenth)
}

/// δ of one row from its running sum.
#[inline(always)]
fn delta<T: Real>(g: Vec3<T>) -> Vec3<T> {
    vec3::map(g, |g| unit::<T>() * g + T::MIN_POSITIVE)
}

/// |a| by component.
#[inline(always)]
fn magnitude<T: Real>(a: Vec3<T>) -> Vec3<T> {
    vec3::map(a, T::abs)
}

/// 7·(|α||d| + |w|(|w|·|d|)) by component: what the rounding of one spring's term H·d cannot exceed, in units of u.
#[inline(always)]
pub(crate) fn term_error<T: Real>(h: &Hessian<T>, d: Vec3<T>) -> Vec3<T> {
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
    for (y, g) in r.iter_mut().zip(error.iter_mut()) {
        (*y, *g) = ([T::ZERO; 3], [T::ZERO; 3]);
    }
    let add = |(y, g): (&mut Vec3<T>, &mut Vec3<T>), term: Vec3<T>, rounding: Vec3<T>| {
        *y = vec3::add(*y, term);
        *g = vec3::add(vec3::add(*g, magnitude(*y)), rounding);
    };
    let mut springs = system.matrix.other.iter().zip(system.matrix.hessian.iter());
    for (row, ((own, m), x_a)) in
        system.matrix.own.iter().zip(system.matrix.inertia.iter()).zip(x).enumerate()
    {
        let (Some(mut y), Some(mut g)) = (r.get(row).copied(), error.get(row).copied()) else { continue };
        let inertia = vec3::scale(*m, *x_a);
        add((&mut y, &mut g), inertia, magnitude(inertia));
        for (other, h) in springs.by_ref().take(*own as usize) {
            let (other, h) = (*other as usize, Hessian::unpack(*h));
            let d = x.get(other).map_or(*x_a, |x_b| vec3::sub(*x_a, *x_b));
            let (product, rounding) = (h.mul(d), term_error(&h, d));
            add((&mut y, &mut g), product, rounding);
            if let (Some(y), Some(g)) = (r.get_mut(other), error.get_mut(other)) {
                add((y, g), vec3::map(product, T::neg), rounding);
            }
        }
        if let (Some(row_y), Some(row_g)) = (r.get_mut(row), error.get_mut(row)) {
            (*row_y, *row_g) = (y, g);
        }
    }
    system.each_point(|row, h| {
        if let (Some(d), Some(y), Some(g)) = (x.get(row), r.get_mut(row), error.get_mut(row)) {
            add((y, g), h.mul(*d), term_error(&h, *d));
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
pub(crate) fn square<T: Number>(r: Vec3<T>, weight: T) -> T {
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
    for ((size, x), m) in size.iter_mut().zip(x).zip(system.matrix.inertia.iter()) {
        *size = vec3::scale(*m, magnitude(*x));
    }
    let at = |i: usize| x.get(i).map_or([T::ZERO; 3], |x| magnitude(*x));
    let mut add = |row: usize, h: &Hessian<T>, x: Vec3<T>| {
        if let Some(size) = size.get_mut(row) {
            *size = vec3::add_scaled(*size, h.alpha.abs() + vec3::dot(h.w, h.w), x);
        }
    };
    system.each_spring(|row, other, h| {
        let x = vec3::add(at(row), at(other));
        for end in [row, other] {
            add(end, &h, x);
        }
    });
    system.each_point(|row, h| add(row, &h, at(row)));
    let unit = T::from_count(updates as usize) * T::UNIT_ROUNDOFF;
    for (size, error) in size.iter_mut().zip(error) {
        *size = vec3::add_scaled(*error, unit, *size);
    }
    weighted(size, weight)
}

/// A factor and a term that cover the rounding and underflow of a sum of `n` non-negative terms.
pub(crate) fn cover<T: Real>(n: usize) -> (T, T) {
    let n = T::from_count(n + 16);
    (T::ONE + T::TWO * n * T::UNIT_ROUNDOFF, n * T::MIN_POSITIVE)
}

/// ½ Σ (|rᵢ| + δᵢ)²/μᵢ, rounded up: nothing that ½‖e‖²_A can exceed.
#[inline(never)]
pub(crate) fn upper<T: Real>(r: &[Vec3<T>], error: &[Vec3<T>], weight: &[T]) -> T {
    let mut sum = Lanes::new();
    for (i, ((r, error), weight)) in r.iter().zip(error).zip(weight).enumerate() {
        sum.add(i, square(vec3::add(magnitude(*r), *error), *weight));
    }
    let (factor, term) = cover(3 * r.len());
    T::HALF * sum.sum() * factor + term
}

/// Σ xᵀz over rows; Σ |x|ᵀ|z|, which its rounding is measured by: at most (3n + 4)u of it; and Σ eᵀ|z|.
#[inline(never)]
fn products<T: Real>(x: &[Vec3<T>], error: &[Vec3<T>], z: &[Vec3<T>]) -> [T; 3] {
    let (mut sum, mut size, mut loss) = (Lanes::new(), Lanes::new(), Lanes::new());
    for (i, ((x, e), z)) in x.iter().zip(error).zip(z).enumerate() {
        sum.add(i, vec3::dot(*x, *z));
        let z = magnitude(*z);
        size.add(i, vec3::dot(magnitude(*x), z));
        loss.add(i, vec3::dot(*e, z));
    }
    [sum.sum(), size.sum(), loss.sum()]
}

/// ½ (rᵀz − Σδ|z|)²/(zᵀAz), rounded down: ½‖e‖²_A is at least this. zᵀAz = zᵀr − zᵀ(r − Az), the last by
/// [`residual`] with its own rounding bound. Leaves r − Az in `t` and that bound in `error`, which comes in as δ.
#[inline(never)]
pub(crate) fn lower<T: Real, F: Force<T>>(
    system: &System<'_, T, F>,
    r: &[Vec3<T>],
    z: &[Vec3<T>],
    t: &mut [Vec3<T>],
    error: &mut [Vec3<T>],
) -> T {
    let of_r = products(r, error, z);
    residual(system, r, z, t, error);
    gain(r.len(), of_r, products(t, error, z))
}

/// The same from the sums of [`products`] over n rows, of r with δ and of t = r − Az with its own.
pub(crate) fn gain<T: Real>(n: usize, of_r: [T; 3], of_t: [T; 3]) -> T {
    let ([rz, rz_size, loss], [tz, tz_size, spread]) = (of_r, of_t);
    let (factor, term) = cover(3 * n);
    let unit = factor - T::ONE;
    let gain = rz - (loss * factor + unit * rz_size + term);
    let form = (rz - tz) + (spread * factor + unit * (rz_size + tz_size) + term);
    over(gain, form * factor, factor)
}

/// The same from the sums of [`products`] of r with δ over n rows, and zᵀAz as a sum of m̃|z|² and α|d|² + (w·d)² over so many
/// rows and springs, beside it that of m̃|z|² and |α||d|² + (|w|·|d|)².
pub(crate) fn gain_by_form<T: Real>(n: usize, of_r: [T; 3], terms: usize, [form, size]: [T; 2]) -> T {
    let [rz, rz_size, loss] = of_r;
    let (factor, term) = cover(3 * n);
    let gain = rz - (loss * factor + (factor - T::ONE) * rz_size + term);
    let (more, term) = cover(terms);
    let form = form + ((more - T::ONE) * size * more + term);
    over(gain, form * more, factor)
}

/// ½ gain²/form, rounded down.
fn over<T: Real>(gain: T, form: T, factor: T) -> T {
    if gain > T::ZERO && form > T::ZERO { T::HALF * (gain / form) * gain / factor } else { T::ZERO }
}
