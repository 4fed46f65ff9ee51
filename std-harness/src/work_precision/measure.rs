//! One run of a scene, counted and timed: only its steps, by the time of their thread.

use std::fmt;
use std::time::{Duration, Instant};

use cpu_time::ThreadTime;
use hooke::StepError;

use crate::output::Energy;
use crate::run::plan::Plan;
use crate::run::simulation::Simulation;

/// A run that got to its end.
pub struct Done {
    /// As it is there.
    pub simulation: Simulation<f64>,
    /// Steps taken.
    pub steps: u64,
    /// Iterations of all of them.
    pub iterations: u64,
    /// Springs clamped, in all steps together.
    pub clamped: u64,
    /// Steps that did not meet their tolerance.
    pub unmet: u64,
    /// Time of the thread.
    pub cpu: Duration,
    /// Time that passed.
    pub wall: Duration,
    /// Energies at the start, J.
    pub energy: Energy,
    /// Linear momentum at the start, kg m/s.
    pub momentum: [f64; 3],
}

/// Why a run did not get there.
#[derive(Debug, Clone, PartialEq)]
pub enum Stopped {
    /// It cannot be, or a step failed.
    Failed(String),
    /// It would have taken so many seconds.
    TooLong(f64),
}

impl fmt::Display for Stopped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Failed(why) => write!(f, "{why}"),
            Self::TooLong(seconds) => write!(f, "skipped: would take about {seconds:.0} s"),
        }
    }
}

/// Makes all steps of a plan, unless they would take more than so many seconds.
pub fn simulate(plan: &Plan, most: f64) -> Result<Done, Stopped> {
    let simulation = Simulation::<f64>::new(plan).map_err(|error| Stopped::Failed(error.to_string()))?;
    let (energy, momentum) = (simulation.energy(0.0), simulation.momentum());
    let zero = Duration::ZERO;
    let mut done = Done {
        simulation,
        energy,
        momentum,
        steps: 0,
        iterations: 0,
        clamped: 0,
        unmet: 0,
        cpu: zero,
        wall: zero,
    };
    let (cpu, wall) = (ThreadTime::now(), Instant::now());
    walk(plan, most, &mut done, cpu)?;
    (done.cpu, done.wall) = (cpu.elapsed(), wall.elapsed());
    Ok(done)
}

/// All steps; `cpu` has run since before the first. What [`super::instructions`] counts.
#[inline(never)]
pub fn walk(plan: &Plan, most: f64, done: &mut Done, cpu: ThreadTime) -> Result<(), Stopped> {
    let mut first = Duration::ZERO;
    for step in 1..=plan.steps {
        let reports = done.simulation.step(step).map_err(|error| failed(plan, done, step, error))?;
        for report in &reports {
            done.steps += 1;
            done.iterations += u64::from(report.iterations);
            done.clamped += u64::from(report.clamped);
            done.unmet += u64::from(report.capped + report.stalled > 0);
        }
        if step.is_power_of_two() {
            let so_far = cpu.elapsed();
            if step == 1 {
                // It also orders, colours and analyses what all others use.
                first = so_far;
            }
            let foretold = foretold(first, so_far, step, plan.steps);
            // The first few steps of a short run tell nothing.
            if so_far.as_secs_f64() > 0.002 * most && foretold > most {
                return Err(Stopped::TooLong(foretold));
            }
        }
    }
    Ok(())
}

/// The time of all steps, s.
fn foretold(first: Duration, so_far: Duration, made: u64, all: u64) -> f64 {
    let each = match made {
        0 | 1 => 0.0,
        made => (so_far - first).as_secs_f64() / (made - 1) as f64,
    };
    first.as_secs_f64() + each * (all - 1) as f64
}

fn failed(plan: &Plan, done: &Done, step: u64, error: StepError) -> Stopped {
    let time = done.simulation.reached().unwrap_or(plan.dt * (step - 1) as f64);
    let step = if plan.accuracy.is_some() { "a step".into() } else { format!("step {step}") };
    let attained = done.simulation.attained().filter(|joules| error == StepError::Accuracy && *joules > 0.0);
    let least =
        attained.map_or(String::new(), |joules| format!("; attainable is about {joules:.1e} J a step"));
    Stopped::Failed(format!("{step} failed at t = {time:.4} s: {error}{least}"))
}
