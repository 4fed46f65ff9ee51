//! Methods that know how wrong a step is before it is taken.
//!
//! The local error (δq, δq̇) is measured as an energy, ½‖δq̇‖²_M + ½δqᵀ(M/h² − K̃)δq, joules: what moves and what is
//! strained by it, and M/h² because K̃ alone is blind to translation; and as a distance, the farthest |δqᵢ|, m.

use super::Integrator;
use crate::error::StepError;
use crate::force::Force;
use crate::lanes::Lanes;
use crate::memory::Memory;
use crate::parts::Parts;
use crate::pins::Course;
use crate::real::Real;
use crate::report::{IslandReport, Report};
use crate::system::System;
use crate::vec3::{self, Vec3};

/// An estimate of what one step adds to the error.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LocalError<T> {
    /// ½‖δq̇‖²_M + ½δqᵀ(M/h² − K̃)δq, J
    pub energy: T,
    /// The farthest |δqᵢ|, m
    pub distance: T,
}

/// A method with an estimate of its local error. A step is made in two halves, and only the second changes the scene.
pub trait Embedded<T: Real>: Integrator<T> {
    /// The order of the lower of the two answers whose difference is the estimate: the energy of the estimate goes with
    /// the power 2(this + 1) of the step.
    const LOWER_ORDER: u32;

    /// No longer step is stable for the scene as it is, s; infinite unless said.
    fn longest<M: Memory<Real = T>>(&mut self, parts: &mut Parts<'_, M>) -> T {
        let _ = parts;
        T::ONE / T::ZERO
    }

    /// Makes a step of `dt`, the beginning of the pins' `course` or all of it, with solves exact to `absolute` joules, beside
    /// the scene.
    ///
    /// # Errors
    /// [`StepError`], and then nothing has changed.
    fn attempt<M: Memory<Real = T>>(
        &mut self,
        parts: &mut Parts<'_, M>,
        dt: T,
        course: Course<'_, T>,
        absolute: T,
        watch: &mut impl FnMut(&IslandReport<T>),
    ) -> Result<(Report<T>, LocalError<T>), StepError>;

    /// Takes the step that was attempted last. The scene must be as it was then, and the course the same.
    ///
    /// # Errors
    /// [`StepError::NotFinite`], [`StepError::Motion`], and then nothing has changed.
    fn accept<M: Memory<Real = T>>(
        &mut self,
        parts: Parts<'_, M>,
        course: Course<'_, T>,
    ) -> Result<(), StepError>;
}

/// ½‖δq̇‖²_M + ½ dᵀ(share·M − sK̃)d with A = M + θhD − sK̃. Drag in A counts as mass, damping along springs as stiffness.
pub(crate) fn energy<T: Real, F: Force<T>>(
    system: &System<'_, T, F>,
    d: &[Vec3<T>],
    velocity: &[Vec3<T>],
    share: T,
) -> T {
    let mut sum = Lanes::new();
    for (row, ((d, v), m)) in d.iter().zip(velocity).zip(system.matrix.inertia.iter()).enumerate() {
        sum.add(row, *m * (vec3::dot(*v, *v) + share * vec3::dot(*d, *d)));
    }
    let at = |i: usize| d.get(i).copied().unwrap_or([T::ZERO; 3]);
    system.each_spring(|row, other, h| sum.add(row, h.mul_and_form(vec3::sub(at(row), at(other))).1));
    system.each_point(|row, h| sum.add(row, h.mul_and_form(at(row)).1));
    T::HALF * sum.sum()
}
