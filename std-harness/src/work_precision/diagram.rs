//! All that a comparison found: the JSON, and the text that is printed.

use std::fmt::Write;
use std::io;
use std::path::Path;

use serde::Serialize;

use super::reference::Reference;
use super::row::Row;
use super::study::Study;
use super::table::{self, figure};
use super::verdict::{Decade, Reach, verdict};
use crate::output::safe;

/// What a comparison found.
#[derive(Debug, Clone, Serialize)]
pub struct Diagram {
    /// The scene's name.
    pub scene: String,
    /// Number of particles.
    pub particles: usize,
    /// Number of springs.
    pub springs: usize,
    /// When positions are compared, s.
    pub seconds: f64,
    /// Relative tolerance of the solves.
    pub tolerance: f64,
    /// How often a run was timed.
    pub repeats: u32,
    /// The scene's size, m.
    pub size_m: f64,
    /// What errors are measured against.
    pub reference: Reference,
    /// The runs.
    pub runs: Vec<Row>,
    /// How many of them are below what the reference is certain of.
    pub dropped: usize,
    /// Who is first, by decades.
    pub verdict: Vec<Decade>,
}

impl Diagram {
    /// Judges the runs.
    pub fn new(study: &Study, reference: Reference, runs: Vec<Row>) -> Self {
        let model = &study.plan.model;
        let verdict = verdict(study, &runs, reference.certain_from);
        Self {
            scene: model.name.clone(),
            particles: model.position.len(),
            springs: model.springs.len(),
            seconds: study.plan.seconds,
            tolerance: study.plan.tolerance.unwrap_or_default(),
            repeats: study.repeats,
            size_m: study.size,
            reference,
            dropped: runs.iter().filter(|row| row.dropped).count(),
            verdict,
            runs,
        }
    }

    /// Writes the JSON file.
    pub fn write(&self, file: &Path) -> io::Result<()> {
        safe::write_file(file, |to| {
            serde_json::to_writer_pretty(&mut *to, self)?;
            to.write_all(b"\n")
        })
    }

    /// What the reference is, in a line.
    pub fn certificate(&self) -> String {
        let Reference { method, steps: [coarse, fine], agreement, certain_from, .. } = &self.reference;
        format!(
            "{method} with {coarse} and {fine} steps, extrapolated; with half as many it is {agreement:.1e} m off, so errors \
             from {certain_from:.1e} m up are certain"
        )
    }

    /// What is printed.
    pub fn text(&self, study: &Study) -> String {
        let mut s = String::new();
        // Writing to a String cannot fail.
        let mut line = |name: &str, value: &str| _ = writeln!(s, "  {name:<11}{value}");
        let (particles, springs) = (self.particles, self.springs);
        line("scene", &format!("{}: {particles} particles, {springs} springs", self.scene));
        for note in &study.plan.model.notes {
            line("note", note);
        }
        line("compared", &format!("positions at t = {} s", self.seconds));
        line("reference", &self.certificate());
        if !self.reference.met {
            let most = format!("more than --effort {:?} s, or rounding, allows", study.effort);
            line(
                "",
                &format!("errors down to {:.1e} m would take {most}: the diagram is cut", study.smallest),
            );
        }
        if self.dropped > 0 {
            let why = "more accurate than the reference can tell: not in the diagram";
            line("", &format!("{} of {} runs are {why}", self.dropped, self.runs.len()));
        }
        line("solves", &format!("to the tolerance {:e}, so that their errors do not show", self.tolerance));
        line("time", &format!("of the steps alone, the thread's, the least of {}", self.repeats));
        let mut s = format!("{s}\n{}\n", table::text(&self.runs));
        for decade in &self.verdict {
            _ = writeln!(s, "  {}", sentence(decade));
        }
        if self.verdict.is_empty() {
            _ = writeln!(s, "  no verdict: no run has an error that is certain");
        }
        for file in study.files.iter().chain(&study.json) {
            _ = writeln!(s, "  wrote      {}", file.display());
        }
        s
    }
}

/// Who is first, and by how much.
fn sentence(decade: &Decade) -> String {
    let reach = |reach: &Reach| {
        let bound = if reach.at_most { "≤ " } else { "" };
        let (ms, dt) = (figure(Some(reach.ms)), figure(Some(1e3 * reach.dt)));
        format!("{} {bound}{ms} ms at dt {dt} ms", reach.curve)
    };
    let mut text = format!("{:.0e} m: {}", decade.error, reach(&decade.best));
    let others = [("next", &decade.second), ("implicit", &decade.implicit), ("explicit", &decade.explicit)];
    let mut told = vec![&decade.best];
    for (name, other) in others {
        let Some(other) = other else { continue };
        if !told.contains(&other) {
            _ = write!(text, "; {name}: {} ({:.1}×)", reach(other), other.ms / decade.best.ms);
            told.push(other);
        }
    }
    text
}
