//! Gravity: f_i = m_i g, V_g = −Σ m_i gᵀx_i (zero at the origin).

use super::{Force, Rows};
use crate::error::StepError;
use crate::network::State;
use crate::real::Real;
use crate::vec3::{self, Vec3};

/// A uniform field g, m/s². Cost: 3 multiplications and 3 additions per particle and step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gravity<T>(pub Vec3<T>);

impl<T: Real> Force<T> for Gravity<T> {
    fn check(&self, _: usize, _: usize) -> Result<(), StepError> {
        if vec3::is_finite(self.0) { Ok(()) } else { Err(StepError::Field) }
    }

    #[inline]
    fn add(&self, rows: &Rows<'_, T>, f: &mut [Vec3<T>]) {
        for (f, i) in f.iter_mut().zip(rows.particles()) {
            if let Some(m) = rows.state.mass.get(i) {
                *f = vec3::add_scaled(*f, *m, self.0);
            }
        }
    }

    fn potential(&self, rows: &Rows<'_, T>) -> T {
        rows.particles().fold(T::ZERO, |energy, i| {
            let (m, x) = (rows.state.mass.get(i), rows.state.position.get(i));
            energy - m.map_or(T::ZERO, |m| *m) * x.map_or(T::ZERO, |x| vec3::dot(self.0, *x))
        })
    }

    fn potential_energy(&self, state: State<'_, T>) -> T {
        let mut energy = T::ZERO;
        for (m, x) in state.mass.iter().zip(state.position) {
            energy -= *m * vec3::dot(self.0, *x);
        }
        energy
    }
}
