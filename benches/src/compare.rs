//! `compare`: scenes in, one table out.

use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

use hooke::{Drag, Force, Gravity, LinearlyImplicitEuler, SpringDamping};
use hooke_harness::error::InputError;
use hooke_harness::output::safe;
use hooke_harness::run::plan::Plan;
use indicatif::{ProgressBar, ProgressStyle};

use crate::args::Args;
use crate::bandwidth::{self, Level};
use crate::iteration::{self, Iteration};
use crate::measure::{self, Measured, Request};
use crate::operator::{self, Product};
use crate::scenario::{Euler, Scenario};
use crate::{choose, growth, memory, methods, output, summary, table};

/// How it can go wrong.
pub(crate) enum Wrong {
    /// Bad input: exit code 2.
    Input(InputError),
    /// A run that failed: exit code 1.
    Failed(String),
}

impl From<InputError> for Wrong {
    fn from(error: InputError) -> Self {
        Self::Input(error)
    }
}

/// Work on a scene, whatever its forces.
pub(crate) trait Job {
    type Output;
    fn run<F: Force<f64> + Clone>(self, scenario: Scenario<F>) -> Result<Self::Output, Wrong>;
}

/// Builds the scene with only the forces that it has, and does the job: what a scene does not name costs it nothing.
pub(crate) fn with_scene<J: Job>(plan: &Plan, job: J) -> Result<J::Output, Wrong> {
    let model = &*plan.ordered();
    let euler: Euler<_> = LinearlyImplicitEuler::new(plan.dt).with(Gravity(model.gravity));
    if model.drag == 0.0 && !model.is_damped() {
        return job.run(Scenario::new(model, euler)?);
    }
    let damping: Vec<f64> = model.springs.iter().map(|spring| spring.damping).collect();
    let euler = euler.with(Drag(model.drag)).with(SpringDamping(damping.as_slice()));
    job.run(Scenario::new(model, euler)?)
}

/// A line that moves while something takes long; it draws only on a terminal.
pub(crate) fn progress() -> ProgressBar {
    let bar = ProgressBar::new_spinner();
    let style = ProgressStyle::with_template("{spinner} {elapsed} {msg}");
    bar.enable_steady_tick(Duration::from_millis(200));
    match style {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

/// Measures one scene.
struct Compare<'a> {
    states: usize,
    between: [f64; 2],
    request: Request<'a>,
    levels: &'a [Level; 4],
    progress: &'a ProgressBar,
}

impl Job for Compare<'_> {
    type Output = (Measured, Product, Vec<Iteration>);

    fn run<F: Force<f64> + Clone>(self, mut scenario: Scenario<F>) -> Result<Self::Output, Wrong> {
        let name = scenario.name.clone();
        let failed = |why: String| Wrong::Failed(format!("{name}: {why}"));
        memory::forget_peak();
        let steps = Scenario::<F>::steps(scenario.euler.dt(), self.states, self.between)?;
        let of = steps.last().copied().unwrap_or(0);
        let step = |step| self.progress.set_message(format!("{name}: trajectory, step {step}/{of}"));
        scenario.record(&steps, None, step).map_err(|error| failed(error.to_string()))?;
        let measured = measure::measure(&mut scenario, &self.request, self.progress).map_err(failed)?;
        let peak = memory::peak_resident();
        let product = Product { peak, ..operator::product(&mut scenario, self.levels) };
        let iterations = iteration::iterations(&mut scenario, self.request.methods, self.levels);
        Ok((measured, product, iterations))
    }
}

const SCENES: [&str; 3] = ["cloth:32", "cloth:64", "chain:1000"];
const STATES: usize = 6;
const TOLERANCES: [f64; 3] = [1e-3, 1e-6, 1e-10];
/// Whoever takes longer for a first solve is not asked for a second, s.
const PATIENCE: f64 = 5.0;

fn compare(args: &Args) -> Result<String, Wrong> {
    let tolerances = if args.tolerance.is_empty() { &TOLERANCES } else { args.tolerance.as_slice() };
    let methods = methods::named(&args.method, &methods::all())?;
    let (states, between) = (args.states.unwrap_or(STATES), args.between());
    let plans = args.plans(&SCENES)?;
    for plan in &plans {
        Scenario::<()>::steps(plan.dt, states, between)?;
    }
    if let Some(file) = &args.json {
        safe::prepare_file(file)?;
    }
    let progress = progress();
    progress.set_message("memory bandwidth");
    let levels = bandwidth::levels();
    let request = Request { methods: &methods, tolerances, patience: PATIENCE };
    let (mut rows, mut skipped) = (Vec::new(), Vec::new());
    let (mut products, mut iterations) = (Vec::new(), Vec::new());
    for plan in &plans {
        let job = Compare { states, between, request, levels: &levels, progress: &progress };
        let (measured, product, iteration) = with_scene(plan, job)?;
        rows.extend(measured.rows);
        skipped.extend(measured.skipped);
        products.push(product);
        iterations.extend(iteration);
    }
    progress.finish_and_clear();
    if let Some(file) = &args.json {
        output::json(file, &rows).map_err(Wrong::Failed)?;
    }
    let mut text = table::comparison(&rows);
    for line in &skipped {
        text += &format!("{line}\n");
    }
    text += &format!("\n{}", table::products(&products, &levels));
    text +=
        "peak MB: resident memory while a scene was measured, all methods at once, C++ peers left out\n\n";
    text += &table::iterations(&iterations);
    for &tolerance in tolerances {
        text += &format!("\n{}", table::summary(&summary::lines(&rows, tolerance), tolerance));
    }
    Ok(text)
}

/// The whole program.
pub fn main() -> ExitCode {
    let arguments = std::env::args_os().map(|argument| argument.to_string_lossy().into_owned());
    let args = match Args::parse_from(arguments) {
        Ok(args) => args,
        Err(Ok(help)) => return said(&help),
        Err(Err(error)) => return complained(&error.to_string(), 2),
    };
    let svg = args.svg.clone().unwrap_or_else(|| PathBuf::from("out/growth.svg"));
    let done = match (args.growth, args.choose) {
        (true, _) => growth::growth(&args, &svg),
        (_, true) => choose::choose(&args),
        _ => compare(&args),
    };
    match done {
        Ok(text) => said(&text),
        Err(Wrong::Input(error)) => complained(&error.to_string(), 2),
        Err(Wrong::Failed(why)) => complained(&why, 1),
    }
}

/// A reader that closed the pipe is no failure.
fn said(text: &str) -> ExitCode {
    let _ = std::io::stdout().write_all(text.as_bytes());
    ExitCode::SUCCESS
}

fn complained(message: &str, code: u8) -> ExitCode {
    let _ = writeln!(std::io::stderr(), "compare: {message}");
    ExitCode::from(code)
}
