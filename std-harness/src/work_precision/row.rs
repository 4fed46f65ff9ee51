//! A run as a row of the table: what it cost, and how wrong it is.

use serde::Serialize;

use super::curve::{Curve, Setting, Steps};
use super::instructions;
use super::measure::{Done, Stopped, simulate};
use super::reference::{Reference, farthest};
use super::study::Study;
use crate::run::integrator::Integrator;
use crate::run::plan::Plan;

/// A run that would take more is skipped, s.
const MOST: f64 = 60.0;
/// A run that takes more is timed once, s.
const LONG: f64 = 1.0;
/// Farther off than so many sizes of the scene is no answer any more.
const LEFT: f64 = 10.0;

/// A run.
#[derive(Debug, Clone, Serialize)]
pub struct Row {
    /// The curve that it is on.
    pub curve: String,
    /// The method.
    pub method: &'static str,
    /// The linear solver; null if there is nothing to solve.
    pub solver: Option<&'static str>,
    /// The step, s; the mean one where they are chosen, null if there is none.
    pub dt: Option<f64>,
    /// Error allowed per step, J; null where steps are equal.
    #[serde(rename = "accuracy_J")]
    pub accuracy: Option<f64>,
    /// Steps taken.
    pub steps: u64,
    /// Steps rejected.
    pub rejected: u64,
    /// Linear systems of the steps taken; null where the method decides that as it goes.
    pub solves: Option<u64>,
    /// Iterations of the steps taken, or solves with a direct solver's factors.
    pub iterations: u64,
    /// Springs clamped, in all steps together.
    pub clamped: u64,
    /// Time of the thread for the steps alone, the least of the repeats, ms; null without an end.
    pub ms: Option<f64>,
    /// Time that passed, the least of the repeats, ms.
    pub wall_ms: Option<f64>,
    /// Instructions of the steps alone; null if they were not to be counted.
    pub instructions: Option<u64>,
    /// How far the worst particle is from the reference, m; null if that is not certain, or without an end.
    #[serde(rename = "error_m")]
    pub error: Option<f64>,
    /// |E(end) − E(0)| in units of the energy in motion and springs; null where something damps or drives.
    pub energy_drift: Option<f64>,
    /// |p(end) − p(0)|, kg m/s; null unless nothing is pinned and no force acts.
    pub momentum_drift: Option<f64>,
    /// Why there is no error, or what else is to be known.
    pub note: String,
    /// Is the error there, but below what the reference is certain of?
    pub dropped: bool,
    /// Did it end for want of time?
    #[serde(skip)]
    pub too_long: bool,
}

impl Row {
    /// A point of the diagram: ms and m.
    pub fn point(&self) -> Option<(f64, f64)> {
        match (self.ms, self.error) {
            (Some(ms), Some(error)) if ms > 0.0 && error > 0.0 => Some((ms, error)),
            _ => None,
        }
    }

    /// The row of a run that is not made.
    pub fn without(curve: Curve, setting: Setting, seconds: f64, note: String) -> Self {
        let (steps, accuracy) = match setting {
            Setting::Steps(steps) => (Some(steps), None),
            Setting::Accuracy(joules) => (None, Some(joules)),
        };
        Self {
            curve: curve.name(),
            method: curve.method.name(),
            solver: None,
            dt: steps.map(|steps| seconds / steps as f64),
            accuracy,
            steps: 0,
            rejected: 0,
            solves: None,
            iterations: 0,
            clamped: 0,
            ms: None,
            wall_ms: None,
            instructions: None,
            error: None,
            energy_drift: None,
            momentum_drift: None,
            note,
            dropped: false,
            too_long: false,
        }
    }
}

/// Makes a run, as often as it is to be timed.
pub fn run(study: &Study, reference: &Reference, curve: Curve, setting: Setting) -> Row {
    let plan = study.plan_of(curve, setting);
    let row = Row::without(curve, setting, plan.seconds, String::new());
    let solver = (!curve.method.is_explicit()).then(|| plan.method.name());
    let row = Row { solver, ..row };
    match simulate(&plan, MOST) {
        Ok(done) => {
            let times = repeated(study, &plan, &done);
            counted(study, setting, judged(study, reference, done, times, row, curve), curve)
        }
        Err(stopped) => {
            Row { note: stopped.to_string(), too_long: matches!(stopped, Stopped::TooLong(_)), ..row }
        }
    }
}

/// With its instructions, if they are to be counted and will not take too long.
fn counted(study: &Study, setting: Setting, mut row: Row, curve: Curve) -> Row {
    if study.instructions && row.error.is_some() {
        let short = row.ms.is_some_and(|ms| ms < 1e3 * instructions::MOST);
        let found =
            if short { instructions::count(study, curve, setting) } else { Err("too long to count".into()) };
        match found {
            Ok(n) => row.instructions = Some(n),
            Err(why) if row.note.is_empty() => row.note = why,
            Err(why) => row.note = format!("{}; {why}", row.note),
        }
    }
    row
}

/// The least times, ms: of the thread, and passed.
fn repeated(study: &Study, plan: &Plan, first: &Done) -> (f64, f64) {
    let times = |done: &Done| (done.cpu.as_nanos() as f64 / 1e6, done.wall.as_nanos() as f64 / 1e6);
    let mut least = times(first);
    for _ in 1..study.repeats {
        if first.cpu.as_secs_f64() > LONG {
            break;
        }
        let Ok(done) = simulate(plan, MOST) else { break };
        let (cpu, wall) = times(&done);
        least = (if cpu < least.0 { cpu } else { least.0 }, if wall < least.1 { wall } else { least.1 });
    }
    least
}

/// The row of a run that got to its end.
fn judged(
    study: &Study,
    reference: &Reference,
    mut done: Done,
    (ms, wall_ms): (f64, f64),
    row: Row,
    curve: Curve,
) -> Row {
    let (particle, error) = farthest(&done.simulation.positions(), &reference.positions);
    let chosen = done.simulation.chosen();
    let mut row = Row {
        steps: done.steps,
        rejected: chosen.map_or(0, |steps| steps.rejected),
        solves: stages(curve.method).map(|stages| stages * done.steps),
        iterations: done.iterations,
        clamped: done.clamped,
        ms: Some(ms),
        wall_ms: Some(wall_ms),
        ..row
    };
    if chosen.is_some() {
        row.dt = Some(study.plan.seconds / done.steps as f64);
    }
    if let (Steps::Cut, Some(dt), Some(limit)) = (curve.steps, row.dt, done.simulation.limit()) {
        row.note = format!("each step in substeps of {:.3e} s", dt / (dt / (0.9 * limit)).ceil());
    }
    if !(error <= LEFT * study.size) {
        row.note = format!("left the scene: particle {particle} is off by {error:.1e} m");
        return row;
    }
    if done.unmet > 0 {
        row.note = format!("not converged: {} steps did not meet --tolerance", done.unmet);
        return row;
    }
    let (energy, momentum) = (done.simulation.energy(study.plan.seconds), done.simulation.momentum());
    row.energy_drift = (study.keeps_energy() && reference.energy > 0.0)
        .then(|| (energy.total - done.energy.total).abs() / reference.energy);
    row.momentum_drift = study
        .plan
        .model
        .is_free_of_force()
        .then(|| (0..3).map(|c| (momentum[c] - done.momentum[c]).powi(2)).sum::<f64>().sqrt());
    row.dropped = error < reference.certain_from;
    match row.dropped {
        true => {
            row.note =
                format!("error below {:.1e} m, where the reference is not certain", reference.certain_from)
        }
        false => row.error = Some(error),
    }
    row
}

/// Linear systems of a step.
fn stages(method: Integrator) -> Option<u64> {
    match method {
        Integrator::Euler | Integrator::Midpoint => Some(1),
        Integrator::Ros2 => Some(2),
        Integrator::Ros3 => Some(4),
        Integrator::Verlet | Integrator::SymplecticEuler => Some(0),
        Integrator::Newton | Integrator::EnergyMomentum | Integrator::Auto => None,
    }
}
