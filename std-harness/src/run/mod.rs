//! `hooke run`: plan, simulate, record, sum up.

pub mod auto;
pub mod choice;
pub mod counted;
pub mod integrator;
pub mod outcome;
pub mod plan;
pub mod recorder;
pub mod rest;
pub mod simulation;
pub mod solver;
pub mod structure;
pub mod summary;

use hooke::Real;
use std::fmt::Display;
use std::io::Write;
use std::time::Instant;

use crate::cli::{Precision, RunArgs};
use crate::error::InputError;
use outcome::{Failure, Outcome};
use plan::Plan;
use recorder::Recorder;
use simulation::Simulation;

/// How a run can go wrong.
#[derive(Debug)]
pub enum RunError {
    /// Bad input: nothing was written. Exit code 2.
    Input(InputError),
    /// A step failed, or an output could not be written any more; what there was is kept. Exit code 1.
    Failed(String),
}

impl From<InputError> for RunError {
    fn from(error: InputError) -> Self {
        Self::Input(error)
    }
}

/// Runs what the options say; answers the summary to print.
pub fn run(args: &RunArgs) -> Result<String, RunError> {
    let plan = Plan::new(args)?;
    match plan.precision {
        Precision::F64 => run_in::<f64>(&plan),
        Precision::F32 => run_in::<f32>(&plan),
    }
}

fn run_in<T: Real + Display>(plan: &Plan) -> Result<String, RunError> {
    let mut simulation = Simulation::<T>::new(plan)?;
    plan.prepare_outputs()?;
    let lost = |error: std::io::Error| RunError::Failed(format!("cannot write: {error}"));
    let mut recorder = Recorder::new(plan, &simulation).map_err(lost)?;
    let mut outcome = Outcome::new(plan, &mut simulation);

    let start = Instant::now();
    let progress = progress(plan);
    for step in 1..=plan.steps {
        let began = Instant::now();
        let report = simulation.step(step);
        let took = began.elapsed();
        match report {
            Ok(reports) => outcome.add(&simulation, &reports, took),
            Err(error) => {
                let time = simulation.reached().unwrap_or(plan.dt * (step - 1) as f64);
                let attained = simulation.attained().filter(|_| error == hooke::StepError::Accuracy);
                outcome.failure = Some(Failure { step, time, error, attained });
                break;
            }
        }
        recorder.after(step, &simulation).map_err(lost)?;
        progress.inc(1);
    }
    progress.finish_and_clear();
    outcome.finish(&mut simulation, start.elapsed());

    recorder.finish().map_err(lost)?;
    if let Some(file) = &plan.final_csv {
        simulation.write_final(file).map_err(lost)?;
    }
    if let Some(file) = &plan.json {
        outcome.write(file).map_err(lost)?;
    }
    let text = summary::text(plan, &outcome, &recorder);
    match &outcome.failure {
        None => Ok(text),
        Some(failure) => {
            if !plan.quiet {
                // A closed pipe must not hide the failure behind a panic.
                let _ = std::io::stdout().write_all(text.as_bytes());
            }
            Err(RunError::Failed(failure.to_string()))
        }
    }
}

/// A bar with the time left; it draws only on a terminal.
fn progress(plan: &Plan) -> indicatif::ProgressBar {
    if plan.quiet {
        return indicatif::ProgressBar::hidden();
    }
    let style = "{prefix} {wide_bar} {pos}/{len} steps, {per_sec}, {eta} left";
    let bar = indicatif::ProgressBar::new(plan.steps).with_prefix(plan.model.name.clone());
    match indicatif::ProgressStyle::with_template(style) {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}
