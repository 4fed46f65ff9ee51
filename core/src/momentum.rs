//! Linear and angular momentum, and the centre of mass.
//!
//! p = Σ mᵢq̇ᵢ (kg m/s), L = Σ mᵢ xᵢ × q̇ᵢ about the origin (kg m²/s). Springs cannot change either: f_A = −f_B bit for bit,
//! along Δx. Linearly-implicit Euler keeps p to rounding on an island that nothing holds (the solver repairs the sum of
//! the momentum equations even when it is cut short); L it keeps only to first order in h.

use crate::network::State;
use crate::real::Real;
use crate::vec3::{self, Vec3};

impl<T: Real> State<'_, T> {
    /// Σ mᵢq̇ᵢ, kg m/s
    pub fn linear_momentum(&self) -> Vec3<T> {
        let mut sum = [T::ZERO; 3];
        for (m, v) in self.mass.iter().zip(self.velocity) {
            sum = vec3::add_scaled(sum, *m, *v);
        }
        sum
    }

    /// Σ mᵢ xᵢ × q̇ᵢ about the origin, kg m²/s
    pub fn angular_momentum(&self) -> Vec3<T> {
        let mut sum = [T::ZERO; 3];
        for ((m, x), v) in self.mass.iter().zip(self.position).zip(self.velocity) {
            sum = vec3::add_scaled(sum, *m, vec3::cross(*x, *v));
        }
        sum
    }

    /// Σ mᵢxᵢ / Σ mᵢ, m; the origin for an empty scene
    pub fn centre_of_mass(&self) -> Vec3<T> {
        let (mut sum, mut mass) = ([T::ZERO; 3], T::ZERO);
        for (m, x) in self.mass.iter().zip(self.position) {
            sum = vec3::add_scaled(sum, *m, *x);
            mass += *m;
        }
        if mass > T::ZERO { vec3::map(sum, |s| s / mass) } else { sum }
    }
}
