//! One trial: a case by a method in a precision with a solver, by the path that `hooke run` takes.

use std::fmt::Display;
use std::panic::{AssertUnwindSafe, catch_unwind};

use hooke::{Real, StepError};
use serde::Serialize;

use super::case::{Case, Fact, Size, most_iterations, steps};
use super::judge::{Judge, Stepped};
use super::method::Method;
use super::mirror::{Mirror, Snapshot, rounded, unrepresentable};
use super::start::{Options, Start};
use super::worst::Worst;
use crate::cli::Precision;
use crate::scene::Model;

/// How a trial ended.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Ended {
    /// All steps were made.
    Finished,
    /// A step failed.
    Failed {
        /// What kind of error it was.
        error: String,
        /// At which step, counted from 1.
        step: u64,
    },
    /// The run was refused before its first step, as bad input is.
    Refused(String),
}

/// A trial.
#[derive(Debug, Clone, Serialize)]
pub struct Trial {
    /// The case.
    pub case: &'static str,
    /// The method.
    pub method: &'static str,
    /// f64 or f32.
    pub precision: &'static str,
    /// The solver; null if the method solves nothing.
    pub solver: Option<String>,
    /// How it ended.
    pub ended: Ended,
    /// Of an explicit method whose limit is below the case's step: the limit, s. That step was refused, as it must be, and what
    /// is told is of 0.9 of the limit.
    #[serde(rename = "limit_s")]
    pub limit: Option<f64>,
    /// Steps made.
    pub steps: u64,
    /// Solves that ended before they met their tolerance: at the most iterations, or stalled.
    pub unmet: u64,
    /// The worst that was seen.
    pub worst: Worst,
    /// What does not hold.
    pub broken: Vec<String>,
}

/// A case of a certain size, ready to be tried.
pub struct Prepared {
    /// The case.
    pub case: Case,
    /// Its scene, where the case has it.
    pub model: Model,
    /// The same at the origin, if the case has it elsewhere.
    origin: Option<Model>,
    size: Size,
}

impl Prepared {
    /// Builds the scene.
    pub fn new(case: Case, size: Size) -> Self {
        let mut model = (case.scene)(size);
        model.name = case.name.into();
        let mut origin = None;
        if let Fact::Offset(by) = case.fact {
            origin = Some(model.clone());
            model.position.iter_mut().flatten().for_each(|x| *x += by);
        }
        Self { case, model, origin, size }
    }

    /// How many steps are made.
    pub fn steps(&self) -> u64 {
        steps(&self.model, self.size)
    }

    /// Tries it. A panic is what must not be, and is said.
    pub fn tried(&self, method: Method, precision: Precision, solver: &str) -> Trial {
        let trial = || match precision {
            Precision::F64 => self.tried_in::<f64>(method, precision, solver),
            Precision::F32 => self.tried_in::<f32>(method, precision, solver),
        };
        catch_unwind(AssertUnwindSafe(trial)).unwrap_or_else(|_| {
            let mut trial = self.blank(method, precision, solver);
            trial.broken.push("panicked".into());
            trial
        })
    }

    fn blank(&self, method: Method, precision: Precision, solver: &str) -> Trial {
        Trial {
            case: self.case.name,
            method: method.name,
            precision: if precision == Precision::F64 { "f64" } else { "f32" },
            solver: method.solves().then(|| solver.to_string()),
            ended: Ended::Finished,
            limit: None,
            steps: 0,
            unmet: 0,
            worst: Worst::default(),
            broken: Vec::new(),
        }
    }

    fn tried_in<T: Real + Display>(&self, method: Method, precision: Precision, solver: &str) -> Trial {
        let mut trial = self.blank(method, precision, solver);
        let options = Options { method, precision, solver, most: most_iterations(&self.model) };
        let refusal = unrepresentable::<T>(&self.model);
        let (mut simulation, limit) = match options.start::<T>(&self.model) {
            Ok(Start::Ready(simulation, limit)) => (*simulation, limit),
            Ok(Start::Never(why)) => {
                trial.ended = Ended::Refused(why.into());
                return trial;
            }
            Err(error) => {
                if refusal.is_none() {
                    trial.broken.push(format!("refused, though nothing is beyond its range: {error}"));
                }
                trial.ended = Ended::Refused(refusal.map_or(error.to_string(), Into::into));
                return trial;
            }
        };
        if let Some(why) = refusal {
            trial.broken.push(format!("not refused, though {why}"));
        }
        trial.limit = limit;
        let model = rounded::<T>(&self.model);
        let mirror = match Mirror::new(&model) {
            Ok(mirror) => mirror,
            Err(error) => {
                trial.broken.push(format!("no mirror: {error}"));
                return trial;
            }
        };
        let at_rest = self.case.fact == Fact::AtRest;
        let mut judge = Judge::new::<T>(&model, method, mirror, options.most, at_rest);
        if limit.is_some() {
            options.is_refused_beyond_the_limit(&self.model, &mut simulation, &mut judge);
        }
        let mut twin = self.origin.as_ref().and_then(|origin| {
            // Its step is the same: the limit is of k, m and pins alone.
            match options.start::<T>(origin) {
                Ok(Start::Ready(simulation, _)) => Some(simulation),
                _ => None,
            }
        });
        let mut before = Snapshot::of(&simulation.scene);
        for step in 1..=self.steps() {
            let (solves, iterations) = (simulation.work().solves(), simulation.work().iterations());
            let result = simulation.once(step);
            let after = Snapshot::of(&simulation.scene);
            let asked = simulation.work();
            let reported = result.as_ref().map_or(0, |(report, _)| u64::from(report.iterations));
            judge.worked(asked.solves() - solves, reported.max(asked.iterations() - iterations));
            match result {
                Ok((report, rejections)) => {
                    trial.steps = step;
                    trial.unmet += u64::from(report.capped + report.stalled);
                    judge.made(&before, &after, &Stepped { dt: simulation.made(), report, rejections });
                    let energy = simulation.energy(0.0);
                    judge.energy(&after, energy.kinetic, energy.springs);
                }
                Err(error) => {
                    judge.failed(&before, &after, error);
                    trial.ended = Ended::Failed { error: kind(error).into(), step };
                    break;
                }
            }
            if let (Some(at_origin), Fact::Offset(by)) = (&mut twin, self.case.fact) {
                match at_origin.once(step) {
                    Ok(_) => {
                        let apart = farthest(&after, &Snapshot::of(&at_origin.scene), by);
                        let unit = T::UNIT_ROUNDOFF.to_f64() * by;
                        judge.worst.loss = judge.worst.loss.max(apart / unit);
                    }
                    Err(_) => twin = None,
                }
            }
            before = after;
        }
        (trial.worst, trial.broken) = (judge.worst, [trial.broken, judge.broken].concat());
        trial
    }
}

/// The name of an error's kind: whose fault it was depends on the scene.
fn kind(error: StepError) -> &'static str {
    match error {
        StepError::TimeStep => "time step",
        StepError::Tolerance => "tolerance",
        StepError::Field => "field",
        StepError::Force(_) => "force",
        StepError::Damping(_) => "damping",
        StepError::NoParticle(_) => "no particle",
        StepError::NotPinned(_) => "not pinned",
        StepError::Motion(_) => "pin too far",
        StepError::NotCertified(_) => "not certified",
        StepError::NotFinite(_) => "out of range",
        StepError::StepLimit(_) => "beyond the limit",
        StepError::NotConverged(_) => "not converged",
        StepError::Accuracy => "accuracy",
        StepError::Workspace { .. } => "workspace",
    }
}

/// The largest distance of a particle from where the other has it, moved by so much along each axis, m.
fn farthest(here: &Snapshot, there: &Snapshot, by: f64) -> f64 {
    let apart =
        |(x, y): (&[f64; 3], &[f64; 3])| (0..3).map(|c| (x[c] - (y[c] + by)).abs()).fold(0.0, f64::max);
    here.position.iter().zip(&there.position).map(apart).fold(0.0, f64::max)
}
