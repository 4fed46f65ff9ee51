//! How a job ends when it does not end well.

use hooke::{EditError, StepError};

/// Why a job failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Failure {
    /// An edit was refused.
    Edit(EditError),
    /// A step failed.
    Step(StepError),
    /// What the job is there to show did not happen.
    Missing(&'static str),
    /// The trace could not be written.
    Output,
}

/// What a job answers.
pub type Outcome = Result<(), Failure>;

/// Fails, naming what is missing, unless it holds.
pub fn expect(holds: bool, what: &'static str) -> Outcome {
    if holds { Ok(()) } else { Err(Failure::Missing(what)) }
}

impl From<EditError> for Failure {
    fn from(error: EditError) -> Self {
        Self::Edit(error)
    }
}

impl From<StepError> for Failure {
    fn from(error: StepError) -> Self {
        Self::Step(error)
    }
}

impl From<core::fmt::Error> for Failure {
    fn from(_: core::fmt::Error) -> Self {
        Self::Output
    }
}
