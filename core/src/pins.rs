//! Pins: particles whose motion is given. q = Pᵀq̂ + b: P drops their rows from the unknowns, b holds their positions.
//!
//! A pin rests unless the step is told its motion, and a motion is given *over* the step: where the pin is at its end
//! (b⁺) and how fast it then moves (ḃ⁺); b and ḃ at its beginning are the scene's own. Linearly-implicit Euler sees it
//! move with p = (b⁺ − b)/h; higher orders interpolate b and ḃ at both ends.
//!
//! Where steps are chosen ([`crate::Adaptive`]) a motion is given over the time until the end that is asked for, and a step may be
//! a part of it. Pins then move by the cubic of both ends, b and ḃ at a step's end being the cubic's there. What is left of a
//! cubic is the cubic of its own ends, so nothing need be remembered: the same motion, given again over the time that is left,
//! goes on along the same way.

use crate::error::EditError;
use crate::memory::Memory;
use crate::real::Real;
use crate::scene::MassSpring;
use crate::selection::MARK;
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

/// Motions over a time that a step is all of, or the beginning.
#[derive(Debug, Clone, Copy)]
pub struct Course<'a, T: Real> {
    /// Where pins are when that time is over; those that are not among them rest.
    pub motion: &'a [Motion<T>],
    /// How long it is, s; no step is longer. Nothing where all pins rest.
    pub over: T,
}

impl<T: Real> Course<'_, T> {
    /// All pins rest.
    pub const fn rest() -> Self {
        Self { motion: &[], over: T::ZERO }
    }

    /// Where a pin is and how fast, after the part `s` ∈ [0, 1] of a step of `dt`.
    pub(crate) fn at(&self, m: &Motion<T>, s: T, dt: T, b: Vec3<T>, rate: Vec3<T>) -> [Vec3<T>; 2] {
        m.at(s * (dt / self.over), self.over, b, rate)
    }

    /// The same at the end of the step: b⁺ and ḃ⁺ themselves, where it is the end of the motion too.
    pub(crate) fn end(&self, m: &Motion<T>, dt: T, b: Vec3<T>, rate: Vec3<T>) -> [Vec3<T>; 2] {
        if dt < self.over { self.at(m, T::ONE, dt, b, rate) } else { [m.position, m.velocity] }
    }
}

impl<M: Memory> MassSpring<M> {
    /// Sets ḃ of a pin, m/s: how fast it moves when the next motion begins. Without this a motion begins as the last one ended,
    /// and from rest where the last step was told none. It moves no pin.
    ///
    /// ```
    /// use hooke::{Adaptive, Motion, Scene, Verlet};
    /// let mut scene = Scene::<f64, 2, 1>::new();
    /// let (a, b) = (scene.particle([0.0; 3], 1.0)?, scene.particle([1.0, 0.0, 0.0], 1.0)?);
    /// scene.spring(a, b, 100.0)?;
    /// scene.pin(a)?;
    /// let mut method = Adaptive::new(Verlet::new(0.01), 0.01, 1e-6);
    /// // Off at once with 2 m/s, for half a second.
    /// let (velocity, mut time) = ([2.0, 0.0, 0.0], 0.0);
    /// scene.set_pin_velocity(a, velocity)?;
    /// let motion = Motion { particle: a, position: [1.0, 0.0, 0.0], velocity };
    /// while time < 0.5 {
    ///     method.end_after(0.5 - time);
    ///     scene.step_moving(&mut method, &[motion])?;
    ///     time += method.made().dt;
    /// }
    /// assert_eq!(scene.positions()[a], motion.position);
    /// // x = 1 + 2t − (v/ω) sin ωt, ω = 10/s, seen from the pin.
    /// let [x, ..] = scene.positions()[b];
    /// assert!((x - (2.0 - 0.2 * 5.0f64.sin())).abs() < 1e-3);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`EditError::NoParticle`], [`EditError::NotPinned`], [`EditError::NotFinite`].
    pub fn set_pin_velocity(&mut self, i: usize, velocity: Vec3<M::Real>) -> Result<(), EditError> {
        let slot = self.network.slot.get(i).ok_or(EditError::NoParticle(i))?;
        if slot & MARK == 0 {
            return Err(EditError::NotPinned(i));
        }
        if !vec3::is_finite(velocity) {
            return Err(EditError::NotFinite(i));
        }
        if let Some(rate) = self.network.velocity.get_mut(i) {
            *rate = velocity;
        }
        Ok(())
    }
}
