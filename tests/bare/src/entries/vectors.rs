//! Vectors of ℝ³, and the selection E_j.

use hooke::{selection, vec3};

use crate::shared::*;

crate::entry_point::entry_points! {
    vec3::add(a: V<T>, b: V<T>) -> V<T> { vec3::add(a, b) }
    vec3::sub(a: V<T>, b: V<T>) -> V<T> { vec3::sub(a, b) }
    vec3::scale(s: T, a: V<T>) -> V<T> { vec3::scale(s, a) }
    vec3::add_scaled(a: V<T>, s: T, b: V<T>) -> V<T> { vec3::add_scaled(a, s, b) }
    vec3::dot(a: V<T>, b: V<T>) -> T { vec3::dot(a, b) }
    vec3::cross(a: V<T>, b: V<T>) -> V<T> { vec3::cross(a, b) }
    vec3::is_finite(a: V<T>) -> bool { vec3::is_finite(a) }
    selection::difference(a: usize, b: usize, q: &[V<T>]) -> V<T> { selection::difference(a, b, q) }
    selection::scatter(a: usize, b: usize, f: V<T>, y: &mut [V<T>]) { selection::scatter(a, b, f, y) }
}
