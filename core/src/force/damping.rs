//! Damping along springs: f_A = −c (u·(q̇_A − q̇_B)) u = −f_B. It resists only the change of length, so rigid motion is
//! free of it. In A it only lengthens w: w = u√(s(k − α) + θh c). A slack cable does not damp.

use super::Force;
use crate::error::StepError;
use crate::real::Real;

/// Where the coefficients of [`SpringDamping`] come from.
pub trait Coefficients<T> {
    /// c of a spring, N·s/m.
    fn coefficient(&self, spring: usize) -> T;
    /// The first spring, of this many, whose coefficient is negative, infinite or NaN.
    fn invalid(&self, springs: usize) -> Option<usize>;
}

fn valid<T: Real>(c: T) -> bool {
    c.is_finite() && c >= T::ZERO
}

/// One coefficient for all springs.
impl<T: Real> Coefficients<T> for T {
    #[inline]
    fn coefficient(&self, _: usize) -> T {
        *self
    }
    fn invalid(&self, _: usize) -> Option<usize> {
        if valid(*self) { None } else { Some(0) }
    }
}

/// One coefficient per spring; 0 past the end.
impl<T: Real> Coefficients<T> for &[T] {
    #[inline]
    fn coefficient(&self, spring: usize) -> T {
        self.get(spring).copied().unwrap_or(T::ZERO)
    }
    fn invalid(&self, springs: usize) -> Option<usize> {
        self.iter().take(springs).position(|c| !valid(*c))
    }
}

/// Viscous damping along every spring, coefficients c ≥ 0 in N·s/m. Cost: one multiplication and one addition per
/// spring and step; no memory of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpringDamping<C>(pub C);

impl<T: Real, C: Coefficients<T>> Force<T> for SpringDamping<C> {
    const DAMPS: bool = true;

    fn check(&self, _: usize, springs: usize) -> Result<(), StepError> {
        match self.0.invalid(springs) {
            None => Ok(()),
            Some(j) => Err(StepError::Damping(j)),
        }
    }

    #[inline]
    fn damping(&self, spring: usize) -> T {
        self.0.coefficient(spring)
    }
}
