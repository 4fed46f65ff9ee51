//! Time integration: one file per method, one trait.

mod adaptive;
mod embedded;
mod energy_momentum;
mod explicit;
mod limit;
mod linearly_implicit_euler;
mod midpoint;
mod newton;
mod ros2;
mod ros3;
mod rosenbrock;
mod stage;
mod stepper;
mod symplectic_euler;
mod trial;
mod verlet;

pub use adaptive::{Adaptive, Made, Probed};
pub use embedded::{Embedded, LocalError};
pub use energy_momentum::{Conserving, EnergyMomentum};
pub use limit::Stiffest;
pub use linearly_implicit_euler::{LinearizedOnce, LinearlyImplicitEuler};
pub use midpoint::{AtTheMiddle, Midpoint};
pub use newton::{Minimized, Newton};
pub use ros2::{Ros2, Rosenbrock2};
pub use ros3::{Ros34Pw2, Rosenbrock3};
pub use rosenbrock::{Combination, Stage, Staged, Tableau};
pub use stepper::Stepper;
pub use symplectic_euler::{KickDrift, SymplecticEuler};
pub use verlet::{KickDriftKick, Verlet};

use crate::error::StepError;
use crate::memory::Memory;
use crate::parts::Parts;
use crate::pins::Motion;
use crate::real::{Real, larger};
use crate::report::{Ending, IslandReport, Report, Solve};

/// The solves of one island in one step, told as one: iterations added, the largest bounds, the worst ending.
pub(crate) fn merge<T: Real>(before: Option<Solve<T>>, next: Solve<T>) -> Solve<T> {
    let Some(before) = before else { return next };
    let rank = |ending| match ending {
        Ending::Untouched => 0,
        Ending::Converged => 1,
        Ending::Floor => 2,
        Ending::Capped => 3,
        Ending::Stalled => 4,
    };
    // What is not finite stays so, a NaN too: the step is refused for it.
    let worse = before.upper.is_finite() && !(next.upper <= before.upper);
    Solve {
        iterations: before.iterations.saturating_add(next.iterations),
        upper: if worse { next.upper } else { before.upper },
        lower: larger(before.lower, next.lower),
        ending: if rank(before.ending) < rank(next.ending) { next.ending } else { before.ending },
        fallback: before.fallback || next.fallback,
    }
}

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
