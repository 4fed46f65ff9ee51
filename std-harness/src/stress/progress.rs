//! What is being tried, on a terminal.

use indicatif::{ProgressBar, ProgressStyle};

use super::suite::Suite;

/// A bar of cases with the trial that is being made.
pub struct Progress(ProgressBar);

impl Progress {
    /// The bar, hidden if the suite is quiet.
    pub fn new(suite: &Suite) -> Self {
        if suite.quiet {
            return Self(ProgressBar::hidden());
        }
        let bar = ProgressBar::new(suite.cases.len() as u64);
        Self(match ProgressStyle::with_template("{wide_bar} {pos}/{len} cases, {eta} left; {msg}") {
            Ok(style) => bar.with_style(style),
            Err(_) => bar,
        })
    }

    /// Says what is being tried.
    pub fn says(&self, what: &str) {
        self.0.set_message(what.to_string());
        self.0.tick();
    }

    /// Counts a case.
    pub fn counts(&self) {
        self.0.inc(1);
    }

    /// Takes the bar away.
    pub fn ends(&self) {
        self.0.finish_and_clear();
    }
}
