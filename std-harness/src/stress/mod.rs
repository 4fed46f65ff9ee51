//! `hooke stress`: scenes that are hard on methods, tried with all of them, and judged by what must hold whatever the scene.
//!
//! Decide ([`suite`]), build the [`mod@cases`], make every [`trial`] by the path that `hooke run` takes, let the [`judge`] look at
//! every step, put trials together in a [`row`] and write the [`table`]. No clock is asked: that a method cannot hang is shown by
//! counting its solves, iterations and rejections.

pub mod arguments;
pub mod bodies;
pub mod case;
pub mod cases;
pub mod judge;
pub mod kept;
pub mod method;
pub mod mirror;
pub mod progress;
pub mod row;
pub mod start;
pub mod suite;
pub mod table;
pub mod trial;
pub mod worst;

use std::fmt::Write;
use std::fs;
use std::io::Write as _;

use crate::output::safe;
use crate::run::RunError;
use arguments::Arguments;
use suite::Suite;

/// Tries what the options say; answers the text to print.
pub fn run(args: &Arguments) -> Result<String, RunError> {
    if args.list {
        return Ok(list());
    }
    let suite = Suite::new(args)?;
    let trials = suite.trials();
    let rows = row::rows(&trials);
    let lost = |error: std::io::Error| RunError::Failed(format!("cannot write: {error}"));
    if let Some(file) = &suite.json {
        let write = |to: &mut dyn std::io::Write| {
            serde_json::to_writer_pretty(&mut *to, &trials)?;
            to.write_all(b"\n")
        };
        safe::write_file(file, write).map_err(lost)?;
    }
    if let Some(file) = &suite.out {
        let tables = table::markdown(&suite.cases, &rows, suite.size, &suite.command(args));
        let text = table::placed(fs::read_to_string(file).ok(), &tables);
        safe::write_file(file, |to| to.write_all(text.as_bytes())).map_err(lost)?;
    }
    let mut text = table::text(&suite.cases, &rows);
    for file in suite.out.iter().chain(&suite.json) {
        // Writing to a String cannot fail.
        _ = writeln!(text, "  wrote      {}", file.display());
    }
    if suite.quiet {
        text.clear();
    }
    if rows.iter().any(|row| !row.broken.is_empty()) {
        // A closed pipe must not hide the failure behind a panic.
        _ = std::io::stdout().write_all(text.as_bytes());
        return Err(RunError::Failed(table::total(&rows, suite.cases.len())));
    }
    Ok(text)
}

/// What there is.
fn list() -> String {
    let mut text = String::from("Cases:\n");
    for case in cases::all() {
        _ = writeln!(text, "  {:<24} {}", case.name, case.what);
    }
    text += "Methods:\n";
    for method in method::METHODS {
        let chosen = if method.chosen { ", its steps chosen by their error" } else { "" };
        _ = writeln!(text, "  {:<24} {}{chosen}", method.name, method.integrator.title());
    }
    text
}
