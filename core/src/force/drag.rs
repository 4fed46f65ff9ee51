//! Linear drag: f_i = −d m_i q̇_i. It enters A's diagonal, D_i = d m_i, so it never limits the step.

use super::Force;
use crate::error::StepError;
use crate::real::Real;

/// Drag proportional to mass and velocity; the rate d ≥ 0 in 1/s. Cost: one number per particle and step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drag<T>(pub T);

impl<T: Real> Force<T> for Drag<T> {
    const DRAGS: bool = true;

    fn check(&self, _: usize, _: usize) -> Result<(), StepError> {
        if self.0.is_finite() && self.0 >= T::ZERO { Ok(()) } else { Err(StepError::Field) }
    }

    #[inline]
    fn drag(&self, _: usize, mass: T) -> T {
        self.0 * mass
    }
}
