//! One spring: its potential energy and gradient.
//!
//! l = √(ΔxᵀΔx), Δx = x_A − x_B, V = ½k(l − l₀)², ∂V/∂x_A = k(l − l₀)u = kσΔx, ∂V/∂x_B = −∂V/∂x_A, with u = Δx/l and
//! the stretch factor σ = 1 − l₀/l. Shapes: Δx, u in ℝ³; units m, N/m, J, N.
//!
//! Rounding: l within 2.52u of the root of the stored Δx; the tension k(l − l₀) loses u·l₀·k absolutely where l ≈ l₀.
//! Where ΔxᵀΔx is below the smallest normal number l counts as 0, and then u = 0, so f = 0: no direction is preferred.
//!
//! Source: the mass-spring lecture (potential energy of a spring; generalized force).

use crate::real::Real;
use crate::vec3::{self, Vec3};

/// The constants of one spring. Stiffness k ≥ 0 in N/m, rest length l₀ ≥ 0 in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spring<T> {
    /// k, N/m
    pub stiffness: T,
    /// l₀, m
    pub rest_length: T,
}

/// Length and direction of Δx: computed once, used by energy, gradient and Hessian.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretched<T> {
    /// l = |Δx|, m
    pub length: T,
    /// 1/l, or 0 where l = 0
    pub inverse: T,
    /// u = Δx/l, or 0 where l = 0
    pub direction: Vec3<T>,
}

impl<T: Real> Stretched<T> {
    /// l, 1/l and u of Δx = x_A − x_B. One root, one division.
    #[inline(always)]
    pub fn new(delta: Vec3<T>) -> Self {
        let squared = vec3::dot(delta, delta);
        if squared < T::MIN_POSITIVE {
            return Self { length: T::ZERO, inverse: T::ZERO, direction: [T::ZERO; 3] };
        }
        let length = squared.sqrt();
        let inverse = T::ONE / length;
        Self { length, inverse, direction: vec3::scale(inverse, delta) }
    }
}

impl<T: Real> Spring<T> {
    /// V = ½k(l − l₀)², J.
    ///
    /// ```
    /// let spring = hooke::Spring { stiffness: 100.0, rest_length: 1.0 };
    /// assert_eq!(spring.potential_energy(1.5), 12.5);
    /// ```
    #[inline(always)]
    pub fn potential_energy(&self, length: T) -> T {
        let strain = length - self.rest_length;
        T::HALF * self.stiffness * strain * strain
    }

    /// Tension dV/dl = k(l − l₀), N: positive pulls the ends together.
    #[inline(always)]
    pub fn tension(&self, length: T) -> T {
        self.stiffness * (length - self.rest_length)
    }

    /// ∂V/∂q_j = (∂V/∂x_A, ∂V/∂x_B), N; the second is minus the first, bit for bit. Forces are its negative.
    pub fn gradient(&self, a: Vec3<T>, b: Vec3<T>) -> [Vec3<T>; 2] {
        let stretched = Stretched::new(vec3::sub(a, b));
        let g = vec3::scale(self.tension(stretched.length), stretched.direction);
        [g, vec3::scale(-T::ONE, g)]
    }
}
