//! Pins: particles whose motion is given. q = Pᵀq̂ + b: P drops their rows from the unknowns, b holds their positions.
//!
//! A pin rests unless the step is told its motion, and a motion is given *over* the step: where the pin is at its end
//! (b⁺) and how fast it then moves (ḃ⁺); b and ḃ at its beginning are the scene's own. Linearly-implicit Euler sees it
//! move with p = (b⁺ − b)/h; higher orders interpolate b and ḃ at both ends.

use crate::real::Real;
use crate::vec3::{self, Vec3};

/// Where a pinned particle is at the end of a step. Laid out as in C, so that a list of them from there need not be copied.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Motion<T: Real> {
    /// Which particle; it must be pinned.
    pub particle: usize,
    /// b⁺, m
    pub position: Vec3<T>,
    /// ḃ⁺, m/s
    pub velocity: Vec3<T>,
}

impl<T: Real> Motion<T> {
    /// Where the pin is, and how fast it moves, after the part `s` ∈ [0, 1] of a step of `dt`: by the cubic that begins
    /// with b, ḃ and ends with b⁺, ḃ⁺ (Hermite).
    pub(crate) fn at(&self, s: T, dt: T, b: Vec3<T>, rate: Vec3<T>) -> [Vec3<T>; 2] {
        let (three, six) = (T::TWO + T::ONE, T::TWO * (T::TWO + T::ONE));
        let (left, square) = (T::ONE - s, s * s);
        let way = vec3::sub(self.position, b);
        let (begins, ends) = (vec3::scale(dt, rate), vec3::scale(dt, self.velocity));
        // q = b + (3s² − 2s³)way + s(1−s)²·hḃ − s²(1−s)·hḃ⁺, and its derivative.
        let position = vec3::add_scaled(b, square * (three - T::TWO * s), way);
        let position = vec3::add_scaled(position, s * left * left, begins);
        let position = vec3::add_scaled(position, -(square * left), ends);
        let velocity = vec3::scale(six * s * left, way);
        let velocity = vec3::add_scaled(velocity, left * (left - T::TWO * s), begins);
        let velocity = vec3::add_scaled(velocity, s * (three * s - T::TWO), ends);
        [position, vec3::map(velocity, |v| v / dt)]
    }
}
