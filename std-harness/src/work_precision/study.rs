//! What a comparison will do, decided and checked before anything is simulated or written.

use std::ffi::OsString;
use std::path::PathBuf;

use super::arguments::Arguments;
use super::curve::{Curve, Setting, Steps, curves};
use crate::cli::{Precision, RunArgs};
use crate::error::InputError;
use crate::output::safe;
use crate::run::auto;
use crate::run::plan::{Plan, positive, resolved};
use crate::run::simulation::Simulation;
use crate::run::solver::Method;

/// The most steps a run may have.
pub const MOST_STEPS: f64 = 1e9;

/// A comparison, decided.
#[derive(Debug, Clone)]
pub struct Study {
    /// The scene with its overrides, tolerances and solver, of which the runs are made.
    pub plan: Plan,
    /// The curves, in the order of the table.
    pub curves: Vec<Curve>,
    /// Numbers of equal steps to try; chosen while it runs, if none are given.
    pub steps: Vec<u64>,
    /// Accuracies to try, J, the largest first.
    pub accuracies: Vec<f64>,
    /// Are instructions to be counted?
    pub instructions: bool,
    /// The program's own options, for a call of itself.
    pub options: Vec<OsString>,
    /// Is the solver chosen for every step anew?
    pub auto: bool,
    /// How often a run is timed.
    pub repeats: u32,
    /// The scene's size: the diagonal of its box, m.
    pub size: f64,
    /// The smallest error of interest, m.
    pub smallest: f64,
    /// The most time for the reference, s.
    pub effort: f64,
    /// Table and plot.
    pub files: [PathBuf; 2],
    /// The folder they are in.
    pub out: PathBuf,
    /// All of it.
    pub json: Option<PathBuf>,
    /// No progress, nothing printed.
    pub quiet: bool,
}

impl Study {
    /// Decides a comparison from its options.
    pub fn new(args: &Arguments) -> Result<Self, InputError> {
        let seconds = positive("--seconds", args.seconds)?;
        let accuracies = accuracies(&args.accuracy)?;
        let mut curves = curves(&args.methods, &accuracies)?;
        if args.repeats == 0 {
            return Err(InputError::new("--repeats 0: at least 1"));
        }
        if !args.dt.is_empty() {
            // Rows as they were asked for.
            curves.retain(|curve| curve.steps != Steps::Cut);
        }
        let auto = args.solver == "auto";
        let mut plan = Plan::new(&RunArgs {
            scene: args.scene.clone(),
            integrator: "euler".into(),
            solver: if auto { "jacobi".into() } else { args.solver.clone() },
            tolerance: Some(args.tolerance),
            overrides: args.overrides.clone(),
            ..RunArgs::default()
        })?;
        (plan.seconds, plan.quiet) = (seconds, args.quiet);
        // What the kernel refuses of the scene is bad input, not a row of the table.
        Simulation::<f64>::new(&plan)?;
        let size = size(&plan.model.position);
        Ok(Self {
            steps: steps(&args.dt, seconds)?,
            smallest: positive(
                "--smallest",
                args.smallest.unwrap_or(10_f64.powf((1e-6 * size).log10().floor())),
            )?,
            effort: positive("--effort", args.effort)?,
            files: ["work-precision.csv", "work-precision.svg"].map(|name| args.out.join(name)),
            out: args.out.clone(),
            json: args.json.clone(),
            quiet: args.quiet,
            repeats: args.repeats,
            instructions: args.instructions,
            options: std::env::args_os().skip(1).filter(|option| option != "--instructions").collect(),
            plan,
            curves,
            accuracies,
            auto,
            size,
        })
    }

    /// The plan of one run.
    pub fn plan_of(&self, curve: Curve, setting: Setting) -> Plan {
        let mut plan = Plan { integrator: curve.method, ..self.plan.clone() };
        match setting {
            Setting::Steps(steps) => {
                (plan.steps, plan.dt) = (steps, plan.seconds / steps as f64);
                plan.first = plan.dt;
            }
            Setting::Accuracy(joules) => {
                (plan.steps, plan.dt, plan.accuracy) = (1, plan.seconds, Some(joules));
                plan.first = if plan.model.dt < plan.seconds { plan.model.dt } else { plan.seconds };
            }
        }
        if curve.steps == Steps::Cut {
            plan.substeps = MOST_STEPS as u32;
        }
        if curve.method.is_explicit() {
            plan.method = Method::Jacobi;
        } else if self.auto {
            plan.method = auto::choose(&plan.model, plan.first, plan.tolerance, Precision::F64).method;
        }
        plan
    }

    /// Is energy to be kept? Not where something damps or drives.
    pub fn keeps_energy(&self) -> bool {
        let model = &self.plan.model;
        model.drag == 0.0 && !model.is_damped() && model.moving.iter().all(|m| m.particles.is_empty())
    }

    /// Makes sure that every output can be written, before the first run.
    pub fn prepare_outputs(&self) -> Result<(), InputError> {
        let inputs: Vec<PathBuf> = self.plan.inputs.iter().map(|input| resolved(input)).collect();
        for file in self.files.iter().chain(&self.json) {
            if inputs.contains(&resolved(file)) {
                let why = "cannot write here: the scene is read from this file; choose another name";
                return Err(InputError::in_file(file, why));
            }
        }
        if let Some(json) = &self.json {
            if self.files.iter().any(|file| resolved(file) == resolved(json)) {
                let why = "cannot write here: --out writes this file itself; choose another name";
                return Err(InputError::in_file(json, why));
            }
            // A file in the folder that --out is about to make is checked once that is there.
            if json.parent() != Some(&self.out) {
                safe::prepare_file(json)?;
            }
        }
        safe::prepare_dir(&self.out)?;
        self.files.iter().chain(&self.json).try_for_each(|file| safe::prepare_file(file))
    }
}

/// How many steps of at most dt it takes; a hair more than a whole number is that number.
pub fn steps_of(seconds: f64, dt: f64) -> f64 {
    let steps = (seconds / dt - 1e-9).ceil();
    if steps > 1.0 { steps } else { 1.0 }
}

fn steps(dts: &[f64], seconds: f64) -> Result<Vec<u64>, InputError> {
    let mut all = Vec::new();
    for dt in dts {
        let steps = steps_of(seconds, positive("--dt", *dt)?);
        if *dt > seconds {
            return Err(InputError::new(format!("--dt {dt:?}: longer than --seconds {seconds:?}")));
        }
        if steps > MOST_STEPS {
            let most = format!("the most is {MOST_STEPS:e}");
            return Err(InputError::new(format!("--dt {dt:?}: {steps:e} steps are too many; {most}")));
        }
        all.push(steps as u64);
    }
    all.sort_unstable();
    all.dedup();
    Ok(all)
}

fn accuracies(joules: &[f64]) -> Result<Vec<f64>, InputError> {
    let mut all: Vec<f64> =
        joules.iter().map(|joules| positive("--accuracy", *joules)).collect::<Result<_, _>>()?;
    all.sort_by(|a, b| b.total_cmp(a));
    all.dedup();
    Ok(all)
}

/// The diagonal of the box that the particles are in, m; 1 where they are all in one place.
fn size(position: &[[f64; 3]]) -> f64 {
    let side = |c: usize| {
        let (low, high) = position
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x[c]), high.max(x[c])));
        high - low
    };
    let diagonal = (0..3).map(|c| side(c).powi(2)).sum::<f64>().sqrt();
    if diagonal > 0.0 && diagonal.is_finite() { diagonal } else { 1.0 }
}
