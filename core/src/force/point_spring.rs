//! A spring from a particle to a moving point: the course's mouse spring.
//!
//! V = ½k(l − l₀)², l = |x_i − p|. Only the diagonal block of particle i feels it: H = αI + w wᵀ as for any spring. Its
//! other end is no unknown, so it counts once (c_e = 1) in the certificate of A. Change `target` between steps; the
//! step treats the point as at rest.

use super::{Force, Rows};
use crate::error::StepError;
use crate::hessian::{Hessian, Scaling};
use crate::network::State;
use crate::real::Real;
use crate::spring::{Spring, Stretched};
use crate::vec3::{self, Vec3};

/// A spring between a particle and a point in space. On a pinned particle it does nothing but change the reaction.
#[derive(Debug, Clone, Copy)]
pub struct PointSpring<T> {
    /// Which particle.
    pub particle: usize,
    /// The point, m.
    pub target: Vec3<T>,
    /// k ≥ 0 N/m and l₀ ≥ 0 m.
    pub spring: Spring<T>,
    /// Scratch of a step: H at its beginning, scaled.
    hessian: Hessian<T>,
}

/// Equal if they are the same spring; the scratch of a step does not count.
impl<T: Real> PartialEq for PointSpring<T> {
    fn eq(&self, other: &Self) -> bool {
        (self.particle, self.target, self.spring) == (other.particle, other.target, other.spring)
    }
}

impl<T: Real> PointSpring<T> {
    /// A spring of rest length 0 that pulls `particle` to `target`.
    pub fn new(particle: usize, target: Vec3<T>, stiffness: T) -> Self {
        let spring = Spring { stiffness, rest_length: T::ZERO };
        Self { particle, target, spring, hessian: Hessian { alpha: T::ZERO, w: [T::ZERO; 3] } }
    }

    /// The same with a rest length, m.
    pub fn rest_length(mut self, rest_length: T) -> Self {
        self.spring.rest_length = rest_length;
        self
    }

    fn stretched(&self, state: &State<'_, T>) -> Option<Stretched<T>> {
        let x = state.position.get(self.particle)?;
        Some(Stretched::new(vec3::sub(*x, self.target)))
    }
}

impl<T: Real> Force<T> for PointSpring<T> {
    const ANCHORS: bool = true;

    fn check(&self, particles: usize, _: usize) -> Result<(), StepError> {
        if self.particle >= particles {
            return Err(StepError::NoParticle(self.particle));
        }
        let Spring { stiffness, rest_length } = self.spring;
        let valid = |x: T| x.is_finite() && x >= T::ZERO;
        if vec3::is_finite(self.target) && valid(stiffness) && valid(rest_length) {
            Ok(())
        } else {
            Err(StepError::Force(self.particle))
        }
    }

    fn add(&self, rows: &Rows<'_, T>, f: &mut [Vec3<T>]) {
        let Some(f) = rows.row(self.particle).and_then(|row| f.get_mut(row)) else { return };
        if let Some(stretched) = self.stretched(rows.state) {
            *f = vec3::add_scaled(*f, -self.spring.tension(stretched.length), stretched.direction);
        }
    }

    fn linearize(&mut self, rows: &Rows<'_, T>, scaling: Scaling<T>) -> u32 {
        if rows.row(self.particle).is_none() {
            return 0;
        }
        let Some(stretched) = self.stretched(rows.state) else { return 0 };
        self.hessian = Hessian::new(self.spring, stretched, T::ZERO, scaling);
        u32::from(stretched.length == T::ZERO && self.spring.rest_length > T::ZERO)
    }

    fn clamp(&mut self, rows: &Rows<'_, T>, scaling: Scaling<T>, fails: impl Fn(usize) -> bool) -> u32 {
        if !(self.hessian.alpha >= T::ZERO)
            && rows.row(self.particle).is_some_and(fails)
            && let Some(stretched) = self.stretched(rows.state)
        {
            self.hessian = Hessian::clamped(self.spring, stretched, T::ZERO, scaling);
            return 1;
        }
        0
    }

    #[inline]
    fn hessians(&self, rows: &Rows<'_, T>, visit: &mut impl FnMut(usize, Hessian<T>)) {
        if let Some(row) = rows.row(self.particle) {
            visit(row, self.hessian);
        }
    }

    fn potential(&self, rows: &Rows<'_, T>) -> T {
        match rows.row(self.particle).and_then(|_| self.stretched(rows.state)) {
            Some(stretched) => self.spring.potential_energy(stretched.length),
            None => T::ZERO,
        }
    }

    fn potential_energy(&self, state: State<'_, T>) -> T {
        match self.stretched(&state) {
            Some(stretched) => self.spring.potential_energy(stretched.length),
            None => T::ZERO,
        }
    }
}
