//! Codes from outside on the same equations of motion, in the same diagram: explicit Runge–Kutta methods of orders 5 and 8 with
//! error control, of the crate `ode_solvers` (after Hairer, Nørsett & Wanner, *Solving Ordinary Differential Equations I*).
//!
//! Their right side is written out here from the textbook, for particles in one array and springs in another, and shares no
//! code with the kernel.

use std::io::Write;
use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;
use cpu_time::ThreadTime;
use hooke_harness::error::InputError;
use hooke_harness::run::RunError;
use hooke_harness::run::integrator::Integrator;
use hooke_harness::scene::Model;
use hooke_harness::work_precision::arguments::Arguments;
use hooke_harness::work_precision::curve::{Curve, Setting, Steps};
use hooke_harness::work_precision::diagram::Diagram;
use hooke_harness::work_precision::progress::Progress;
use hooke_harness::work_precision::reference::{self, Reference, farthest};
use hooke_harness::work_precision::row::Row;
use hooke_harness::work_precision::study::Study;
use hooke_harness::work_precision::{self, sweep};
use ode_solvers::dop_shared::OutputType;
use ode_solvers::{DVector, Dop853, Dopri5, System};

/// `hooke work-precision` with dopri5 and dop853 of the crate ode_solvers beside Hooke's methods.
#[derive(Debug, Parser)]
#[command(name = "outside", max_term_width = 110)]
struct Command {
    #[command(flatten)]
    arguments: Arguments,
}

/// The program.
pub fn main() -> ExitCode {
    let said = match compared(&Command::parse().arguments) {
        Ok(text) => (std::io::stdout().write_all(text.as_bytes()), 0),
        Err(RunError::Input(error)) => (writeln!(std::io::stderr(), "outside: {error}"), 2),
        Err(RunError::Failed(why)) => (writeln!(std::io::stderr(), "outside: {why}"), 1),
    };
    ExitCode::from(said.1)
}

fn compared(arguments: &Arguments) -> Result<String, RunError> {
    let study = Study::new(arguments)?;
    if study.plan.model.moving.iter().any(|moving| !moving.particles.is_empty()) {
        return Err(InputError::new("outside: not for scenes with moving pins").into());
    }
    study.prepare_outputs()?;
    let progress = Progress::new(&study);
    let found = reference::find(&study, &progress);
    let found = found.inspect_err(|_| progress.ends()).map_err(RunError::Failed)?;
    let mut runs = sweep::sweep(&study, &found, &progress);
    runs.extend(rows(&study, &found));
    progress.ends();
    let diagram = Diagram::new(&study, found, runs);
    let lost = |error: std::io::Error| RunError::Failed(format!("cannot write: {error}"));
    let [csv, svg] = &study.files;
    work_precision::table::write(csv, &diagram.runs).map_err(lost)?;
    work_precision::plot::write(svg, &study, &diagram).map_err(lost)?;
    if let Some(json) = &study.json {
        diagram.write(json).map_err(lost)?;
    }
    Ok(if study.quiet { String::new() } else { diagram.text(&study) })
}

/// Relative and absolute tolerances that are tried.
const TOLERANCES: [f64; 6] = [1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10];
/// A curve ends with a run that takes more, s.
const LONG: f64 = 20.0;

/// q̈ = M⁻¹f(q, q̇) as a system of first order in the free particles' q, then their q̇.
#[derive(Clone)]
struct Motion<'m> {
    model: &'m Model,
    /// The free particles, and where each particle is among them.
    free: Vec<usize>,
    place: Vec<Option<usize>>,
}

impl<'m> Motion<'m> {
    fn new(model: &'m Model) -> Self {
        let free: Vec<usize> = (0..model.mass.len()).filter(|i| !model.pinned[*i]).collect();
        let mut place = vec![None; model.mass.len()];
        free.iter().enumerate().for_each(|(k, i)| place[*i] = Some(k));
        Self { model, free, place }
    }

    fn start(&self) -> DVector<f64> {
        let model = self.model;
        let numbers = self.free.iter().flat_map(|i| model.position[*i]);
        let numbers = numbers.chain(self.free.iter().flat_map(|i| model.velocity[*i]));
        DVector::from_iterator(6 * self.free.len(), numbers)
    }

    fn positions(&self, y: &DVector<f64>) -> Vec<[f64; 3]> {
        (0..self.model.mass.len()).map(|i| self.at(y, i, 0)).collect()
    }

    /// q or q̇ of a particle; a pin rests where it is.
    fn at(&self, y: &DVector<f64>, i: usize, half: usize) -> [f64; 3] {
        match (self.place[i], half) {
            (Some(k), _) => std::array::from_fn(|c| y[3 * (half * self.free.len() + k) + c]),
            (None, 0) => self.model.position[i],
            (None, _) => [0.0; 3],
        }
    }
}

impl System<f64, DVector<f64>> for Motion<'_> {
    fn system(&self, _: f64, y: &DVector<f64>, dy: &mut DVector<f64>) {
        let (model, n) = (self.model, self.free.len());
        for k in 0..n {
            for c in 0..3 {
                dy[3 * k + c] = y[3 * (n + k) + c];
                dy[3 * (n + k) + c] = model.gravity[c] - model.drag * y[3 * (n + k) + c];
            }
        }
        for spring in &model.springs {
            let [a, b] = spring.ends;
            let (qa, qb, va, vb) = (self.at(y, a, 0), self.at(y, b, 0), self.at(y, a, 1), self.at(y, b, 1));
            let d: [f64; 3] = std::array::from_fn(|c| qa[c] - qb[c]);
            let l = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
            if l == 0.0 || (spring.cable && l < spring.rest_length) {
                continue;
            }
            let rate = (0..3).map(|c| d[c] * (va[c] - vb[c])).sum::<f64>() / l;
            let tension = spring.stiffness * (l - spring.rest_length) + spring.damping * rate;
            for (end, sign) in [(a, -1.0), (b, 1.0)] {
                if let Some(k) = self.place[end] {
                    for c in 0..3 {
                        dy[3 * (n + k) + c] += sign * tension * d[c] / l / model.mass[end];
                    }
                }
            }
        }
    }
}

/// Rows of both codes, a curve each.
pub(crate) fn rows(study: &Study, reference: &Reference) -> Vec<Row> {
    let mut rows = Vec::new();
    for name in ["dopri5", "dop853"] {
        for tolerance in TOLERANCES {
            let row = row(study, reference, name, tolerance);
            let long = row.ms.is_some_and(|ms| ms > 1e3 * LONG);
            rows.push(row);
            if long {
                break;
            }
        }
    }
    rows
}

fn row(study: &Study, reference: &Reference, name: &'static str, tolerance: f64) -> Row {
    let motion = Motion::new(&study.plan.model);
    let (end, start) = (study.plan.seconds, motion.start());
    let (began, thread) = (Instant::now(), ThreadTime::now());
    macro_rules! solved {
        ($code:ident) => {{
            let mut code = $code::new(motion.clone(), 0.0, end, end, start, tolerance, tolerance);
            // Every step's end: between steps, version 0.6.2 answers the end of the run by extrapolating an earlier step.
            code.set_output(OutputType::Sparse);
            code.integrate().map(|stats| {
                let last = code.y_out().last().cloned().unwrap_or_default();
                (last, stats.accepted_steps, stats.rejected_steps, stats.num_eval)
            })
        }};
    }
    let result = if name == "dopri5" { solved!(Dopri5) } else { solved!(Dop853) };
    let (ms, wall_ms) = (1e3 * thread.elapsed().as_secs_f64(), 1e3 * began.elapsed().as_secs_f64());
    let curve = Curve { method: Integrator::Verlet, steps: Steps::Chosen };
    let row = Row::without(curve, Setting::Accuracy(tolerance), end, String::new());
    let mut row = Row { curve: format!("{name} of ode_solvers"), method: name, accuracy: None, ..row };
    match result {
        Ok((y, accepted, rejected, evaluations)) => {
            row.dt = Some(end / f64::from(accepted));
            (row.steps, row.rejected) = (u64::from(accepted), u64::from(rejected));
            (row.ms, row.wall_ms) = (Some(ms), Some(wall_ms));
            row.note = format!("tolerance {tolerance:e}, {evaluations} forces");
            let (_, error) = farthest(&motion.positions(&y), &reference.positions);
            row.dropped = error < reference.certain_from;
            row.error = (!row.dropped && error.is_finite()).then_some(error);
        }
        Err(error) => row.note = format!("tolerance {tolerance:e}: {error}"),
    }
    row
}
