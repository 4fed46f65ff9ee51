//! A force on one particle, constant over a step: a thruster, a finger, a load.

use super::{Force, Rows};
use crate::error::StepError;
use crate::real::Real;
use crate::vec3::{self, Vec3};

/// A force on one particle, N. On a pinned particle it does nothing but change the reaction at the pin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointForce<T> {
    /// Which particle.
    pub particle: usize,
    /// N
    pub force: Vec3<T>,
}

impl<T: Real> Force<T> for PointForce<T> {
    fn check(&self, particles: usize, _: usize) -> Result<(), StepError> {
        if self.particle >= particles {
            return Err(StepError::NoParticle(self.particle));
        }
        if vec3::is_finite(self.force) { Ok(()) } else { Err(StepError::Force(self.particle)) }
    }

    #[inline]
    fn add(&self, rows: &Rows<'_, T>, f: &mut [Vec3<T>]) {
        if let Some(f) = rows.row(self.particle).and_then(|row| f.get_mut(row)) {
            *f = vec3::add(*f, self.force);
        }
    }
    fn potential(&self, rows: &Rows<'_, T>) -> T {
        let here = rows.row(self.particle).and_then(|_| rows.state.position.get(self.particle));
        here.map_or(T::ZERO, |x| -vec3::dot(self.force, *x))
    }
}
