//! Forces other than the springs' own: each its own small type, composed into a set by pairing.
//!
//! A set of forces is a type: `()`, `((), Gravity)`, `(((), Gravity), Drag)` …, built by
//! [`crate::LinearlyImplicitEuler::gravity`] and [`crate::LinearlyImplicitEuler::with`]. What a program does not name is not in
//! its type, so it costs no flash and no RAM. The last one added is `.1`, the ones before it are in `.0`.

mod damping;
mod drag;
mod gravity;
mod point_force;
mod point_spring;

pub use damping::{Coefficients, SpringDamping};
pub use drag::Drag;
pub use gravity::Gravity;
pub use point_force::PointForce;
pub use point_spring::PointSpring;

use crate::error::StepError;
use crate::hessian::{Hessian, Scaling};
use crate::network::State;
use crate::real::Real;
use crate::vec3::Vec3;

/// A run of consecutive rows (an island's, or a single particle's) and the state they belong to.
#[derive(Debug, Clone, Copy)]
pub struct Rows<'a, T> {
    /// Slot of the first row.
    pub(crate) first: usize,
    /// The particle of each row.
    pub(crate) particle: &'a [u32],
    /// Where all particles are.
    pub(crate) state: &'a State<'a, T>,
}

impl<'a, T: Real> Rows<'a, T> {
    /// The row of a particle among these, or `None` if it is not one of them.
    #[inline]
    pub fn row(&self, particle: usize) -> Option<usize> {
        let slot = (self.state.slot.get(particle)? & !crate::selection::MARK) as usize;
        slot.checked_sub(self.first).filter(|row| self.particle.get(*row) == Some(&(particle as u32)))
    }

    /// The particles of these rows, in order.
    #[inline]
    pub fn particles(&self) -> impl Iterator<Item = usize> + use<'a, T> {
        self.particle.iter().map(|i| *i as usize)
    }

    /// The whole state.
    #[inline]
    pub fn state(&self) -> State<'a, T> {
        *self.state
    }
}

/// A force, or a set of forces. Every method has a default that does nothing; the constants say which ones a force
/// needs, so that loops over the others are never compiled. [`Force::add`] is asked once a step; [`Force::hessians`] at
/// every product, in the islands that hold one of its rows.
pub trait Force<T: Real> {
    /// Does [`Force::drag`] answer anything but 0?
    const DRAGS: bool = false;
    /// Does [`Force::damping`] answer anything but 0?
    const DAMPS: bool = false;
    /// Does [`Force::hessians`] visit anything?
    const ANCHORS: bool = false;

    /// Refuses values that are infinite, NaN or of the wrong sign, and particles that do not exist. Called before
    /// anything of a step is computed.
    ///
    /// # Errors
    /// [`StepError::Field`], [`StepError::Force`], [`StepError::Damping`], [`StepError::NoParticle`].
    fn check(&self, particles: usize, springs: usize) -> Result<(), StepError>;

    /// f += the force on each of the rows, N, drag and damping left out (they are implicit).
    fn add(&self, rows: &Rows<'_, T>, f: &mut [Vec3<T>]) {
        let _ = (rows, f);
    }

    /// Linear drag coefficient of a particle, N·s/m, not negative: the force is −d q̇ᵢ.
    fn drag(&self, particle: usize, mass: T) -> T {
        let _ = (particle, mass);
        T::ZERO
    }

    /// Damping coefficient along a spring, N·s/m.
    fn damping(&self, spring: usize) -> T {
        let _ = spring;
        T::ZERO
    }

    /// Prepares [`Force::hessians`] at the present state, scaled for a step; answers how many of them had to be
    /// replaced because the length is 0 and the rest length is not.
    fn linearize(&mut self, rows: &Rows<'_, T>, scaling: Scaling<T>) -> u32 {
        let _ = (rows, scaling);
        0
    }

    /// Clamps the Hessians with a negative α on rows that `fails`; answers how many it changed. A force that leaves one
    /// negative there makes the step an error ([`StepError::NotCertified`]), not a wrong bound.
    fn clamp(&mut self, rows: &Rows<'_, T>, scaling: Scaling<T>, fails: impl Fn(usize) -> bool) -> u32 {
        let _ = (rows, scaling, fails);
        0
    }

    /// Visits the Hessian blocks that the force adds to the diagonal of A, with their rows.
    fn hessians(&self, rows: &Rows<'_, T>, visit: &mut impl FnMut(usize, Hessian<T>)) {
        let _ = (rows, visit);
    }

    /// V of the force on these rows, J, by which [`crate::Newton`] searches: −∂V/∂q is what [`Force::add`] adds. A force that
    /// is constant over a step has −fᵀq. 0 unless said; then a step of a force that does add something may not converge.
    fn potential(&self, rows: &Rows<'_, T>) -> T {
        let _ = rows;
        T::ZERO
    }

    /// Potential energy of the force at a state, J; 0 for forces that have none.
    fn potential_energy(&self, state: State<'_, T>) -> T {
        let _ = state;
        T::ZERO
    }
}

/// No forces but the springs'.
impl<T: Real> Force<T> for () {
    fn check(&self, _: usize, _: usize) -> Result<(), StepError> {
        Ok(())
    }
}

/// Both.
impl<T: Real, F: Force<T>, G: Force<T>> Force<T> for (F, G) {
    const DRAGS: bool = F::DRAGS || G::DRAGS;
    const DAMPS: bool = F::DAMPS || G::DAMPS;
    const ANCHORS: bool = F::ANCHORS || G::ANCHORS;

    fn check(&self, particles: usize, springs: usize) -> Result<(), StepError> {
        self.0.check(particles, springs)?;
        self.1.check(particles, springs)
    }
    #[inline]
    fn add(&self, rows: &Rows<'_, T>, f: &mut [Vec3<T>]) {
        self.0.add(rows, f);
        self.1.add(rows, f);
    }
    #[inline]
    fn drag(&self, particle: usize, mass: T) -> T {
        match (F::DRAGS, G::DRAGS) {
            (true, true) => self.0.drag(particle, mass) + self.1.drag(particle, mass),
            (true, false) => self.0.drag(particle, mass),
            _ => self.1.drag(particle, mass),
        }
    }
    #[inline]
    fn damping(&self, spring: usize) -> T {
        match (F::DAMPS, G::DAMPS) {
            (true, true) => self.0.damping(spring) + self.1.damping(spring),
            (true, false) => self.0.damping(spring),
            _ => self.1.damping(spring),
        }
    }
    #[inline]
    fn linearize(&mut self, rows: &Rows<'_, T>, scaling: Scaling<T>) -> u32 {
        self.0.linearize(rows, scaling) + self.1.linearize(rows, scaling)
    }
    #[inline]
    fn clamp(&mut self, rows: &Rows<'_, T>, scaling: Scaling<T>, fails: impl Fn(usize) -> bool) -> u32 {
        self.0.clamp(rows, scaling, &fails) + self.1.clamp(rows, scaling, &fails)
    }
    #[inline]
    fn hessians(&self, rows: &Rows<'_, T>, visit: &mut impl FnMut(usize, Hessian<T>)) {
        self.0.hessians(rows, visit);
        self.1.hessians(rows, visit);
    }
    fn potential(&self, rows: &Rows<'_, T>) -> T {
        self.0.potential(rows) + self.1.potential(rows)
    }
    fn potential_energy(&self, state: State<'_, T>) -> T {
        self.0.potential_energy(state) + self.1.potential_energy(state)
    }
}

/// Many of one kind, in a borrowed slice (so that they can be changed between steps).
impl<T: Real, F: Force<T>> Force<T> for &mut [F] {
    const DRAGS: bool = F::DRAGS;
    const DAMPS: bool = F::DAMPS;
    const ANCHORS: bool = F::ANCHORS;

    fn check(&self, particles: usize, springs: usize) -> Result<(), StepError> {
        self.iter().try_for_each(|force| force.check(particles, springs))
    }
    fn add(&self, rows: &Rows<'_, T>, f: &mut [Vec3<T>]) {
        for force in self.iter() {
            force.add(rows, f);
        }
    }
    fn drag(&self, particle: usize, mass: T) -> T {
        self.iter().fold(T::ZERO, |sum, force| sum + force.drag(particle, mass))
    }
    fn damping(&self, spring: usize) -> T {
        self.iter().fold(T::ZERO, |sum, force| sum + force.damping(spring))
    }
    fn linearize(&mut self, rows: &Rows<'_, T>, scaling: Scaling<T>) -> u32 {
        self.iter_mut().fold(0, |sum, force| sum + force.linearize(rows, scaling))
    }
    fn clamp(&mut self, rows: &Rows<'_, T>, scaling: Scaling<T>, fails: impl Fn(usize) -> bool) -> u32 {
        self.iter_mut().fold(0, |sum, force| sum + force.clamp(rows, scaling, &fails))
    }
    fn hessians(&self, rows: &Rows<'_, T>, visit: &mut impl FnMut(usize, Hessian<T>)) {
        for force in self.iter() {
            force.hessians(rows, visit);
        }
    }
    fn potential(&self, rows: &Rows<'_, T>) -> T {
        self.iter().fold(T::ZERO, |sum, force| sum + force.potential(rows))
    }
    fn potential_energy(&self, state: State<'_, T>) -> T {
        self.iter().fold(T::ZERO, |sum, force| sum + force.potential_energy(state))
    }
}
