//! Vectors of ℝ³ as plain arrays `[T; 3]`, by hand, so that the order of every sum is written down.
//!
//! a·b = (a₀b₀ + a₁b₁) + a₂b₂, always in this order: |fl(a·b) − a·b| ≤ 3u |a|·|b|, and for a·a within 3u relatively.

use crate::real::{Number, Real};

/// A point, velocity or force: three components, in the caller's axes.
pub type Vec3<T> = [T; 3];

/// a + b
#[inline(always)]
pub fn add<T: Number>(a: Vec3<T>, b: Vec3<T>) -> Vec3<T> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// a − b
#[inline(always)]
pub fn sub<T: Number>(a: Vec3<T>, b: Vec3<T>) -> Vec3<T> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// s·a
#[inline(always)]
pub fn scale<T: Number>(s: T, a: Vec3<T>) -> Vec3<T> {
    [s * a[0], s * a[1], s * a[2]]
}

/// a + s·b
#[inline(always)]
pub fn add_scaled<T: Number>(a: Vec3<T>, s: T, b: Vec3<T>) -> Vec3<T> {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

/// a·b, summed left to right
#[inline(always)]
pub fn dot<T: Number>(a: Vec3<T>, b: Vec3<T>) -> T {
    (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]
}

/// a × b
#[inline(always)]
pub fn cross<T: Number>(a: Vec3<T>, b: Vec3<T>) -> Vec3<T> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Every component finite
#[inline(always)]
pub fn is_finite<T: Real>(a: Vec3<T>) -> bool {
    a[0].is_finite() && a[1].is_finite() && a[2].is_finite()
}

/// f of each component, written out: an array's own `map` is a loop through memory where code is to be small.
#[inline(always)]
pub(crate) fn map<T: Number>(a: Vec3<T>, f: impl Fn(T) -> T) -> Vec3<T> {
    [f(a[0]), f(a[1]), f(a[2])]
}
