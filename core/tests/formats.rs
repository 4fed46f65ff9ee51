//! With feature `defmt`, whatever a call answers can be logged: a statement that the compiler proves.

use defmt::Format;
use hooke::{EditError, Ending, IslandReport, Report, Solve, StepError};

fn can_be_logged<F: Format>() {}

#[test]
fn every_error_and_every_report_has_a_format() {
    can_be_logged::<EditError>();
    can_be_logged::<StepError>();
    can_be_logged::<Result<Report<f32>, StepError>>();
    can_be_logged::<Report<f64>>();
    can_be_logged::<(IslandReport<f32>, IslandReport<f64>)>();
    can_be_logged::<(Solve<f32>, Solve<f64>, Ending)>();
}
