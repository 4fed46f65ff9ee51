//! The two precisions: everything in this crate is generic over [`Real`], which is `f32` or `f64`.
//!
//! Only + − × ÷ √, comparison and select are used where the state is computed, so that the same ordered scene gives
//! the same bits on every target. `sqrt` is IEEE 754's correctly rounded root (in software where the hardware has
//! none); there is no fused multiply-add, no trigonometry and no float `max`/`min`, whose answer for (0, −0) differs
//! between builds.

use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

/// What has a sum, a difference, a product and a negative: a [`Real`], or several side by side.
pub trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
}

impl<X: Copy + Add<Output = X> + Sub<Output = X> + Mul<Output = X> + Neg<Output = X>> Number for X {}

/// A floating-point precision: `f32` or `f64` (sealed).
pub trait Real:
    sealed::Sealed
    + Copy
    + Debug
    + Default
    + PartialEq
    + PartialOrd
    + Add<Output = Self>
    + AddAssign
    + Sub<Output = Self>
    + SubAssign
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + 'static
{
    /// 0
    const ZERO: Self;
    /// Eight zeros.
    #[doc(hidden)]
    const ZEROS: &'static [Self; 8];
    /// ½
    const HALF: Self;
    /// 1
    const ONE: Self;
    /// 2
    const TWO: Self;
    /// Unit roundoff u: |fl(x) − x| ≤ u |x|; 2⁻²⁴ or 2⁻⁵³.
    const UNIT_ROUNDOFF: Self;
    /// The smallest positive normal number.
    const MIN_POSITIVE: Self;
    /// Default relative tolerance R of a solve: 1e-4 in `f32`, 1e-6 in `f64`.
    const DEFAULT_TOLERANCE: Self;

    /// √self, correctly rounded.
    fn sqrt(self) -> Self;
    /// |self| (clears the sign bit).
    fn abs(self) -> Self;
    /// Neither infinite nor NaN.
    fn is_finite(self) -> bool;
    /// Nearest value of this precision (a constant of the caller, never part of a trajectory's arithmetic).
    fn from_f64(x: f64) -> Self;
    /// The same value in `f64`; exact.
    fn to_f64(self) -> f64;
    /// A count as a number, rounded.
    fn from_count(n: usize) -> Self;
}

/// The nearest number of another precision.
#[inline(always)]
pub(crate) fn to<T: Real, U: Real>(x: T) -> U {
    U::from_f64(x.to_f64())
}

/// The larger of two numbers by one comparison: `b` if `a < b`, else `a`. Unlike `max`, its bits are the same in every
/// build; a NaN in `a` stays.
#[inline(always)]
pub(crate) fn larger<T: Real>(a: T, b: T) -> T {
    if a < b { b } else { a }
}

#[cfg(not(feature = "std"))]
use libm::{sqrt, sqrtf};
/// The host's own root: the same bits (both are correctly rounded), but one instruction, in loops that the compiler can
/// widen.
#[cfg(feature = "std")]
mod host {
    extern crate std;
    #[inline(always)]
    pub(super) fn sqrt(x: f64) -> f64 {
        x.sqrt()
    }
    #[inline(always)]
    pub(super) fn sqrtf(x: f32) -> f32 {
        x.sqrt()
    }
}
#[cfg(feature = "std")]
use host::{sqrt, sqrtf};

macro_rules! real {
    ($t:ty, $sqrt:path, $tolerance:expr) => {
        impl Real for $t {
            const ZERO: Self = 0.0;
            const ZEROS: &'static [Self; 8] = &[0.0; 8];
            const HALF: Self = 0.5;
            const ONE: Self = 1.0;
            const TWO: Self = 2.0;
            const UNIT_ROUNDOFF: Self = <$t>::EPSILON / 2.0;
            const MIN_POSITIVE: Self = <$t>::MIN_POSITIVE;
            const DEFAULT_TOLERANCE: Self = $tolerance;

            #[inline(always)]
            fn sqrt(self) -> Self {
                $sqrt(self)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                <$t>::abs(self)
            }
            #[inline(always)]
            fn is_finite(self) -> bool {
                <$t>::is_finite(self)
            }
            #[inline(always)]
            fn from_f64(x: f64) -> Self {
                x as $t
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                self as f64
            }
            #[inline(always)]
            fn from_count(n: usize) -> Self {
                n as $t
            }
        }
    };
}

real!(f32, sqrtf, 1e-4);
real!(f64, sqrt, 1e-6);
