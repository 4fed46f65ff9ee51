//! Pins: particles whose motion is given. q = Pᵀq̂ + b: P drops their rows from the unknowns, b holds their positions.
//!
//! A pin rests unless the step is told its motion, and a motion is given *over* the step: where the pin is at its end
//! (b⁺) and how fast it then moves (ḃ⁺); b and ḃ at its beginning are the scene's own. Linearly-implicit Euler sees it
//! move with p = (b⁺ − b)/h; higher orders interpolate b and ḃ at both ends.

use crate::real::Real;
use crate::vec3::Vec3;

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
