//! What is being run, on a terminal.

use indicatif::{ProgressBar, ProgressStyle};

use super::study::Study;

/// A line that says what is being run, and for how long the comparison has been going on.
pub struct Progress(ProgressBar);

impl Progress {
    /// The line, hidden if the comparison is quiet.
    pub fn new(study: &Study) -> Self {
        if study.quiet {
            return Self(ProgressBar::hidden());
        }
        let bar = ProgressBar::new_spinner().with_prefix(study.plan.model.name.clone());
        Self(match ProgressStyle::with_template("{spinner} {prefix}: {pos} runs, {elapsed}; {wide_msg}") {
            Ok(style) => bar.with_style(style),
            Err(_) => bar,
        })
    }

    /// Says what is being run.
    pub fn says(&self, what: &str) {
        self.0.set_message(what.to_string());
        self.0.tick();
    }

    /// Counts a run of the table.
    pub fn counts(&self) {
        self.0.inc(1);
    }

    /// Takes the line away.
    pub fn ends(&self) {
        self.0.finish_and_clear();
    }
}
