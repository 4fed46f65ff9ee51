//! The lecture's equations, one spring at a time; 3×3 blocks.

use hooke::{Cables, Hessian, Law, Real, Scaling, Spring, Stretched, Sym3};

use crate::shared::*;

crate::entry_point::entry_points! {
    Stretched::new(delta: V<T>) -> Stretched<T> { Stretched::new(delta) }
    Spring::potential_energy(spring: &Spring<T>, l: T) -> T { spring.potential_energy(l) }
    Spring::tension(spring: &Spring<T>, l: T) -> T { spring.tension(l) }
    Spring::gradient(spring: &Spring<T>, a: V<T>, b: V<T>) -> [V<T>; 2] { spring.gradient(a, b) }
    Spring::hessian(spring: &Spring<T>, a: V<T>, b: V<T>) -> Hessian<T> { spring.hessian(a, b) }
    Spring::dense_hessian(spring: &Spring<T>, a: V<T>, b: V<T>) -> [[[[T; 3]; 3]; 2]; 2] {
        spring.dense_hessian(a, b)
    }
    Law::slackens(marked: bool, x: T) -> bool { Cables::slackens(marked) && x > 0.0 }

    Scaling::unit() -> Scaling<T> { Scaling::unit() }
    Hessian::new(spring: Spring<T>, stretched: Stretched<T>, damping: T, scaling: Scaling<T>) -> Hessian<T> {
        Hessian::new(spring, stretched, damping, scaling)
    }
    Hessian::clamped(spring: Spring<T>, stretched: Stretched<T>, damping: T, scaling: Scaling<T>) -> Hessian<T> {
        Hessian::clamped(spring, stretched, damping, scaling)
    }
    Hessian::mul(h: &Hessian<T>, d: V<T>) -> V<T> { h.mul(d) }
    Hessian::mul_and_form(h: &Hessian<T>, d: V<T>) -> (V<T>, T) { h.mul_and_form(d) }
    Hessian::dense(h: &Hessian<T>) -> [[T; 3]; 3] { h.dense() }

    Sym3::scalar(s: T) -> Sym3<T> { Sym3::scalar(s) }
    Sym3::plus_scalar(a: Sym3<T>, s: T) -> Sym3<T> { a.plus_scalar(s) }
    Sym3::plus_outer(a: Sym3<T>, w: V<T>) -> Sym3<T> { a.plus_outer(w) }
    Sym3::mul(a: &Sym3<T>, v: V<T>) -> V<T> { a.mul(v) }
    Sym3::dense(a: &Sym3<T>) -> [[T; 3]; 3] { a.dense() }
    Sym3::inverse(a: &Sym3<T>) -> Option<Sym3<T>> { a.inverse() }

    Real::sqrt(x: T) -> T { Real::sqrt(x) }
    Real::abs(x: T) -> T { Real::abs(x) }
    Real::is_finite(x: T) -> bool { Real::is_finite(x) }
    Real::from_f64(x: f64) -> T { Real::from_f64(x) }
    Real::to_f64(x: T) -> f64 { Real::to_f64(x) }
    Real::from_count(n: usize) -> T { Real::from_count(n) }
}
