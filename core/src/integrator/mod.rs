//! Time integration: one file per method, one trait.

mod linearly_implicit_euler;

pub use linearly_implicit_euler::LinearlyImplicitEuler;

use crate::error::StepError;
use crate::memory::Memory;
use crate::parts::Parts;
use crate::pins::Motion;
use crate::real::Real;
use crate::report::{IslandReport, Report};

/// A method that advances a scene by one step.
pub trait Integrator<T: Real> {
    /// Advances all of a scene by one step, or fails and leaves it untouched. `watch` sees each island's report.
    /// Called by [`crate::MassSpring::step`] and its relatives, which prepare the parts.
    ///
    /// # Errors
    /// [`StepError`], and then nothing has changed but the scratch of forces.
    fn advance<M: Memory<Real = T>>(
        &mut self,
        parts: Parts<'_, M>,
        motion: &[Motion<T>],
        watch: &mut impl FnMut(&IslandReport<T>),
    ) -> Result<Report<T>, StepError>;
}
