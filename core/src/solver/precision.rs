//! In which precision a factor's numbers are kept: the scene's own, or `f32` for a scene in `f64`.
//!
//! Half the memory and twice the lanes. An `f32` factor of an `f64` matrix is no longer exact, only close (within about
//! κ·2⁻²⁴), so PCG goes around it and certifies the answer in the scene's precision: one to three iterations where a factor
//! in `f64` takes one.
//!
//! Source: Higham, *Accuracy and Stability of Numerical Algorithms*, chapter 12 (mixed precision refinement).

use crate::real::Real;

/// Room for numbers that say in which precision they are.
pub trait Numbers<T: Real> {
    /// The precision
    type Number: Real;
    /// Is it less than the scene's, so that a factor is a preconditioner only?
    #[doc(hidden)]
    const LESS: bool;
    /// The numbers.
    fn numbers(&mut self) -> &mut [Self::Number];
}

/// In the scene's own precision: an array, a borrowed slice, a vector.
impl<T: Real, N: AsMut<[T]>> Numbers<T> for N {
    type Number = T;
    const LESS: bool = false;
    #[inline(always)]
    fn numbers(&mut self) -> &mut [T] {
        self.as_mut()
    }
}

/// In `f32`, whatever the scene's precision.
#[derive(Debug, Clone, Copy, Default)]
pub struct Single<N>(
    /// The `f32`s: an array, a borrowed slice, a vector.
    pub N,
);

impl<T: Real, N: AsMut<[f32]>> Numbers<T> for Single<N> {
    type Number = f32;
    const LESS: bool = true;
    #[inline(always)]
    fn numbers(&mut self) -> &mut [f32] {
        self.0.as_mut()
    }
}
