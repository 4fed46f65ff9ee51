//! What a run did, in figures: the keys of `--json`.

use std::fmt::{self, Display};
use std::io;
use std::path::Path;
use std::time::Duration;

use hooke::{Real, Report, StepError};
use serde::Serialize;

use super::plan::Plan;
use super::simulation::Simulation;
use crate::output::{Energy, safe};

/// The figures of a run.
#[derive(Debug, Clone, Serialize)]
pub struct Outcome {
    /// The scene's name.
    pub scene: String,
    /// Number of particles.
    pub particles: usize,
    /// Number of springs.
    pub springs: usize,
    /// Number of free particles.
    pub free: usize,
    /// Number of islands.
    pub islands: usize,
    /// Time step, s.
    pub dt: f64,
    /// How the scene was moved on in time.
    pub integrator: &'static str,
    /// Why, if that was left to the program.
    pub integrator_reason: Option<String>,
    /// Error allowed per step, J; null where the step is fixed.
    #[serde(rename = "accuracy_J")]
    pub accuracy_j: Option<f64>,
    /// Where steps are chosen: how many were rejected, their shortest and longest, s, the largest estimate of a step's error,
    /// J, and the sum of the estimates of their position errors, m.
    pub chosen: Option<ChosenSteps>,
    /// How the linear systems were solved.
    pub solver: &'static str,
    /// Why, if that was left to the program.
    pub solver_reason: Option<String>,
    /// Steps made.
    pub steps: u64,
    /// Wall-clock time of the run, outputs included, s.
    pub wall_s: f64,
    /// Median time of a step, ms.
    pub step_ms: f64,
    /// PCG iterations, or solves with a direct solver's factors, in all.
    pub iterations: u64,
    /// The most iterations of a step.
    pub iterations_max: u64,
    /// Springs clamped or replaced, in all steps together.
    pub clamped: u64,
    /// Steps in which some node was not certified without projection.
    pub uncertified_steps: u64,
    /// Steps in which some island ended at the floor of its rounding.
    pub at_floor: u64,
    /// Steps in which some island used up its iterations.
    pub capped_steps: u64,
    /// Steps in which some island stalled above the floor.
    pub stalled_steps: u64,
    /// Steps in which a direct solver broke down somewhere and PCG answered.
    pub fallback_steps: u64,
    /// Island solves that took 0 iterations, in all steps together.
    pub untouched_islands: u64,
    /// Of these, how many of islands asleep: neither assembled nor solved.
    pub asleep_islands: u64,
    /// Islands asleep in the last step.
    pub asleep_at_end: u32,
    /// Springs that no step needed: both ends pinned.
    pub springs_skipped: u32,
    /// Total energy at the start, J (kinetic, springs, gravity).
    pub energy_start: f64,
    /// Total energy at the end, J.
    pub energy_end: f64,
    /// |p(end) − p(0)|, kg m/s; null unless nothing is pinned and no force acts.
    pub momentum_drift: Option<f64>,
    /// The largest upper bound on the energy of a solve's error, J.
    #[serde(rename = "error_bound_J")]
    pub error_bound_j: f64,
    /// The largest lower bound, J.
    #[serde(rename = "error_lower_J")]
    pub error_lower_j: f64,
    /// Bytes of the scene's lists, of the solver's own scratch, and of what sleeping remembers.
    pub workspace_bytes: usize,
    /// Did the harness renumber the particles?
    pub renumbered: bool,
    /// Speed of the fastest particle at the end of any step, m/s.
    pub speed_max: f64,
    /// Which step failed, if one did.
    #[serde(skip)]
    pub failure: Option<Failure>,
    /// Energies at the end.
    #[serde(skip)]
    pub energy: Energy,
    #[serde(skip)]
    momentum_start: Option<[f64; 3]>,
    #[serde(skip)]
    step_times: Vec<Duration>,
}

/// What became of steps that were chosen.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct ChosenSteps {
    /// Rejected steps.
    pub rejected: u64,
    /// The shortest step taken, s.
    pub shortest: f64,
    /// The longest step taken, s.
    pub longest: f64,
    /// The largest estimate of a step's error, J.
    #[serde(rename = "error_J")]
    pub error_j: f64,
    /// The sum of all estimates of position errors, m.
    pub error_m: f64,
}

/// A step that failed.
#[derive(Debug, Clone)]
pub struct Failure {
    /// Counted from 1.
    pub step: u64,
    /// Time at its beginning, s.
    pub time: f64,
    /// Why.
    pub error: StepError,
    /// If no step was short enough for the accuracy: the least error that was reached, J.
    pub attained: Option<f64>,
}

impl Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "step {} failed at t = {} s: {}; the outputs up to there are kept",
            self.step, self.time, self.error
        )?;
        match self.attained {
            Some(joules) if joules > 0.0 => write!(f, "; attainable here is about {joules:.1e} J a step"),
            _ => Ok(()),
        }
    }
}

impl Outcome {
    /// The start of a run.
    pub fn new<T: Real + Display>(plan: &Plan, simulation: &mut Simulation<T>) -> Self {
        let energy = simulation.energy(0.0);
        Self {
            scene: plan.model.name.clone(),
            particles: plan.model.position.len(),
            springs: plan.model.springs.len(),
            free: simulation.scene.free_particles(),
            islands: simulation.scene.islands(),
            dt: plan.dt,
            integrator: plan.integrator.name(),
            integrator_reason: plan.integrator_reason.clone(),
            accuracy_j: plan.accuracy,
            chosen: None,
            solver: plan.method.name(),
            solver_reason: plan.reason.clone(),
            steps: 0,
            wall_s: 0.0,
            step_ms: 0.0,
            iterations: 0,
            iterations_max: 0,
            clamped: 0,
            uncertified_steps: 0,
            at_floor: 0,
            capped_steps: 0,
            stalled_steps: 0,
            fallback_steps: 0,
            untouched_islands: 0,
            asleep_islands: 0,
            asleep_at_end: 0,
            springs_skipped: 0,
            energy_start: energy.total,
            energy_end: energy.total,
            momentum_drift: None,
            error_bound_j: 0.0,
            error_lower_j: 0.0,
            workspace_bytes: simulation.workspace_bytes(),
            renumbered: plan.numbering.is_some(),
            speed_max: simulation.fastest().1,
            failure: None,
            energy,
            momentum_start: plan.model.is_free_of_force().then(|| simulation.momentum()),
            step_times: Vec::new(),
        }
    }

    /// Adds a step, or those that were chosen on the way to the next output.
    pub fn add<T: Real + Display>(
        &mut self,
        simulation: &Simulation<T>,
        reports: &[Report<T>],
        took: Duration,
    ) {
        self.speed_max = self.speed_max.max(simulation.fastest().1);
        for report in reports {
            self.count(report);
            self.step_times.push(took / reports.len() as u32);
        }
    }

    fn count<T: Real>(&mut self, report: &Report<T>) {
        self.steps += 1;
        self.iterations += u64::from(report.iterations);
        self.iterations_max = self.iterations_max.max(u64::from(report.iterations));
        self.clamped += u64::from(report.clamped);
        self.uncertified_steps += u64::from(!report.is_certified());
        self.at_floor += u64::from(report.at_floor > 0);
        self.capped_steps += u64::from(report.capped > 0);
        self.stalled_steps += u64::from(report.stalled > 0);
        self.fallback_steps += u64::from(report.fallbacks > 0);
        self.untouched_islands += u64::from(report.untouched);
        self.asleep_islands += u64::from(report.asleep);
        self.asleep_at_end = report.asleep;
        self.springs_skipped = report.springs_skipped;
        self.error_bound_j = self.error_bound_j.max(report.upper.to_f64());
        self.error_lower_j = self.error_lower_j.max(report.lower.to_f64());
    }

    /// The end of a run.
    pub fn finish<T: Real + Display>(&mut self, simulation: &mut Simulation<T>, wall: Duration) {
        self.wall_s = wall.as_secs_f64();
        self.step_times.sort_unstable();
        if let Some(median) = self.step_times.get(self.step_times.len() / 2) {
            self.step_ms = median.as_secs_f64() * 1e3;
        }
        let time = simulation.reached().unwrap_or(self.steps as f64 * self.dt);
        if let Some(told) = simulation.told() {
            self.integrator_reason = Some(told);
        }
        if let Some(steps) = simulation.chosen() {
            self.dt = if steps.taken > 0 { time / steps.taken as f64 } else { 0.0 };
            self.chosen = Some(ChosenSteps {
                rejected: steps.rejected,
                shortest: steps.shortest,
                longest: steps.longest,
                error_j: steps.energy,
                error_m: steps.distance,
            });
        }
        self.energy = simulation.energy(time);
        self.energy_end = self.energy.total;
        self.momentum_drift = self.momentum_start.map(|start| {
            let now = simulation.momentum();
            (0..3).map(|c| (now[c] - start[c]).powi(2)).sum::<f64>().sqrt()
        });
    }

    /// Writes the JSON file.
    pub fn write(&self, file: &Path) -> io::Result<()> {
        safe::write_file(file, |to| {
            serde_json::to_writer_pretty(&mut *to, self)?;
            to.write_all(b"\n")
        })
    }
}
