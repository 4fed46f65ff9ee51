//! The integrator's settings: kept in the header, checked once when they are set.

use hooke::{Drag, Force, Gravity, LinearlyImplicitEuler, Real, SpringDamping};

use crate::status::Failure;
use crate::status::hooke_status::*;

/// How a scene is stepped. Begin with hooke_*_defaults.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Options<T> {
    /// Time step, s; positive.
    pub dt: T,
    /// Gravity, m/s^2.
    pub gravity: [T; 3],
    /// Drag rate d >= 0, 1/s: each particle feels -d m v.
    pub drag: T,
    /// Damping along every spring, N s/m; >= 0.
    pub damping: T,
    /// Relative tolerance of the solve.
    pub tolerance: T,
    /// Absolute tolerance of the solve, J: it also stops where the error's energy is at most this.
    pub absolute: T,
    /// At most so many iterations per island and step; the report tells the bound reached.
    pub max_iterations: u32,
}

/// Gravity, drag and damping, in the order in which they are added.
pub(crate) type Forces<T> = ((((), Gravity<T>), Drag<T>), SpringDamping<T>);

impl<T: Real> Options<T> {
    /// What a program that says nothing gets: no forces, the kernel's own tolerance, and no dt, which it must give.
    pub(crate) fn defaults() -> Self {
        Self {
            dt: T::ZERO,
            gravity: [T::ZERO; 3],
            drag: T::ZERO,
            damping: T::ZERO,
            tolerance: T::DEFAULT_TOLERANCE,
            absolute: T::ZERO,
            max_iterations: 10_000,
        }
    }

    /// dt is 0 in a header until options are set, and never after.
    pub(crate) fn integrator(&self) -> Result<LinearlyImplicitEuler<T, Forces<T>>, Failure> {
        if self.dt == T::ZERO {
            return Err(HOOKE_NO_OPTIONS.into());
        }
        let euler = LinearlyImplicitEuler::new(self.dt)
            .gravity(self.gravity)
            .with(Drag(self.drag))
            .with(SpringDamping(self.damping))
            .tolerance(self.tolerance)
            .absolute(self.absolute)
            .max_iterations(self.max_iterations);
        Ok(euler)
    }

    /// The checks of a step, made where the mistake is.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        let squared = self.dt * self.dt;
        if !(self.dt > T::ZERO && squared.is_finite() && squared > T::ZERO) {
            return Err(HOOKE_TIME_STEP.into());
        }
        for tolerance in [self.tolerance, self.absolute] {
            if !(tolerance >= T::ZERO && tolerance.is_finite()) {
                return Err(HOOKE_TOLERANCE.into());
            }
        }
        Ok(self.integrator()?.forces.check(0, 0)?)
    }
}
