//! `hooke work-precision`: methods compared on a scene by what they cost and how wrong they are.
//!
//! Decide ([`study`]), find a reference ([`mod@reference`]), make the runs ([`sweep`], each a [`row`]), judge ([`verdict`]), write
//! ([`table`], [`plot`], [`diagram`]).

pub mod arguments;
pub mod curve;
pub mod diagram;
pub mod instructions;
pub mod measure;
pub mod plot;
pub mod progress;
pub mod reference;
pub mod row;
pub mod study;
pub mod sweep;
pub mod table;
pub mod verdict;

use crate::error::InputError;
use crate::run::RunError;
use arguments::Arguments;
use diagram::Diagram;
use progress::Progress;
use study::Study;

/// Compares what the options say; answers the text to print.
pub fn run(args: &Arguments) -> Result<String, RunError> {
    let study = Study::new(args)?;
    if let Some(name) = &args.count_run {
        let (curve, setting) =
            instructions::named(name).ok_or(InputError::new(format!("--count-run {name}: no such run")))?;
        let done = measure::simulate(&study.plan_of(curve, setting), f64::INFINITY);
        return done.map(|_| String::new()).map_err(|stopped| RunError::Failed(stopped.to_string()));
    }
    if args.instructions {
        instructions::ready()?;
    }
    study.prepare_outputs()?;
    let progress = Progress::new(&study);
    let found = reference::find(&study, &progress);
    let found = found.inspect_err(|_| progress.ends()).map_err(RunError::Failed)?;
    let rows = sweep::sweep(&study, &found, &progress);
    progress.ends();

    let diagram = Diagram::new(&study, found, rows);
    let lost = |error: std::io::Error| RunError::Failed(format!("cannot write: {error}"));
    let [csv, svg] = &study.files;
    table::write(csv, &diagram.runs).map_err(lost)?;
    plot::write(svg, &study, &diagram).map_err(lost)?;
    if let Some(json) = &study.json {
        diagram.write(json).map_err(lost)?;
    }
    Ok(if study.quiet { String::new() } else { diagram.text(&study) })
}
