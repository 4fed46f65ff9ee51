//! What `--solver auto` should choose: every solver on a grid of scenes, steps and tolerances, who wins, what auto takes, and
//! the weights that fit these times. Paste them into `std-harness/src/run/auto.rs`.
//!
//! A solver that is foretold to take [`HOPELESS`] times as long as another is not run, nor are its weights fitted there.

use cpu_time::ThreadTime;
use hooke::Force;
use hooke_harness::cli::Precision;
use hooke_harness::output::safe;
use hooke_harness::run::auto::Case;
use hooke_harness::run::plan::Plan;
use hooke_harness::run::solver::{AnySolver, METHODS, Method};
use hooke_harness::scene::Model;
use hooke_harness::scene::renumber::Numbering;
use indicatif::ProgressBar;
use serde::Serialize;

use crate::args::Args;
use crate::compare::{Job, Wrong, progress, with_scene};
use crate::median::median;
use crate::scenario::{Scenario, WINDOW};
use crate::weights::{self, Sample};
use crate::{output, table};

/// The grid, unless scenes, a step or tolerances are given. A scene after a `~` gets its particles shuffled and then
/// renumbered by rcm: an irregular mesh.
const SCENES: [&str; 17] = [
    "cloth:8",
    "cloth:16",
    "cloth:32",
    "cloth:64",
    "cloth:128",
    "net:32",
    "syrup:32",
    "curtain",
    "chain:40",
    "chain:1000",
    "lattice:4x4x4",
    "lattice:8x8x8",
    "lattice:16x16x16",
    "~cloth:16",
    "~cloth:48",
    "~lattice:5x5x5",
    "~lattice:9x9x9",
];
const STEPS: [f64; 2] = [1e-3, 1.0 / 60.0];
const TOLERANCES: [f64; 3] = [1e-3, 1e-6, 1e-10];
const STATES: usize = 3;
/// The tolerance of the trajectories.
const TRAJECTORY: f64 = 1e-4;
const HOPELESS: f64 = 30.0;
const MOST_ITERATIONS: u32 = 100_000;

/// A scene, a step and a tolerance: every solver's time.
#[derive(Debug, Serialize)]
pub(crate) struct Line {
    scene: String,
    particles: usize,
    dt: f64,
    tolerance: f64,
    /// By solver, in the order of the harness: ms, the median over the states; null if it was not run.
    ms: Vec<Option<f64>>,
    best: &'static str,
    auto: &'static str,
    /// Time of what auto takes / time of the best.
    loss: f64,
}

struct Choose<'a> {
    plan: &'a Plan,
    model: &'a Model,
    tolerances: &'a [f64],
    states: usize,
    progress: &'a ProgressBar,
}

impl Job for Choose<'_> {
    type Output = (Vec<Line>, Vec<Sample>);

    fn run<F: Force<f64> + Clone>(self, mut scenario: Scenario<F>) -> Result<Self::Output, Wrong> {
        let (name, dt) = (scenario.name.clone(), self.plan.dt);
        let failed = |why: String| Wrong::Failed(format!("{name}: {why}"));
        let steps = Scenario::<F>::steps(dt, self.states, WINDOW)?;
        let step = |step| self.progress.set_message(format!("{name}: dt {dt:.4}, trajectory, step {step}"));
        scenario.record(&steps, Some(TRAJECTORY), step).map_err(|error| failed(error.to_string()))?;
        let (mut lines, mut samples) = (Vec::new(), Vec::new());
        for &tolerance in self.tolerances {
            let case = Case::new(self.model, dt, Some(tolerance), Precision::F64);
            let foretold: Vec<_> = METHODS.iter().map(|(_, method)| case.work(*method)).collect();
            let least = foretold.iter().flatten().copied().fold(f64::INFINITY, f64::min);
            let mut ms = Vec::new();
            for ((solver, method), work) in METHODS.iter().zip(&foretold) {
                self.progress.set_message(format!("{name}: dt {dt:.4}, R {tolerance:e}, {solver}"));
                if !work.is_ok_and(|work| work <= HOPELESS * least) {
                    ms.push(None);
                    continue;
                }
                let (time, iterations) = self.time(&mut scenario, *method, tolerance).map_err(failed)?;
                ms.push(Some(time));
                samples.push(Sample { case: case.clone(), method: *method, ms: time, iterations });
            }
            let by = |values: &dyn Fn(usize) -> Option<f64>| {
                let there = (0..METHODS.len()).filter_map(|k| values(k).map(|value| (value, k)));
                there.min_by(|a, b| a.0.total_cmp(&b.0))
            };
            let Some((best_ms, best)) = by(&|k| ms[k]) else { continue };
            let auto = by(&|k| foretold[k].ok()).map_or(0, |(_, k)| k);
            let particles = self.model.position.len();
            let loss = ms[auto].map_or(f64::NAN, |ms| ms / best_ms);
            let (scene, best, auto) = (name.clone(), METHODS[best].0, METHODS[auto].0);
            lines.push(Line { scene, particles, dt, tolerance, ms, best, auto, loss });
        }
        Ok((lines, samples))
    }
}

impl Choose<'_> {
    /// Median time of a whole step over the states, ms, and its median iterations.
    fn time<F: Force<f64> + Clone>(
        &self,
        scenario: &mut Scenario<F>,
        method: Method,
        tolerance: f64,
    ) -> Result<(f64, f64), String> {
        scenario.put(0);
        let solver = AnySolver::new(method, &mut scenario.scene, self.model);
        let euler = scenario.euler.clone().tolerance(tolerance).max_iterations(MOST_ITERATIONS);
        let mut euler = euler.solver(solver);
        let (mut ms, mut iterations) = (Vec::new(), Vec::new());
        for k in 0..scenario.states() {
            let mut times: Vec<f64> = Vec::new();
            while times.len() < 2 || (times.len() < 7 && times.iter().sum::<f64>() < 50.0) {
                scenario.put(k);
                let began = ThreadTime::now();
                let report = scenario.scene.step(&mut euler).map_err(|error| error.to_string())?;
                times.push(1e3 * began.elapsed().as_secs_f64());
                if times.len() == 1 {
                    iterations.push(f64::from(report.iterations));
                }
            }
            ms.push(median(times));
        }
        Ok((median(ms), median(iterations)))
    }
}

/// Measures, prints, fits.
pub(crate) fn choose(args: &Args) -> Result<String, Wrong> {
    let names: Vec<&str> =
        if args.scenes.is_empty() { SCENES.into() } else { args.scenes.iter().map(String::as_str).collect() };
    let tolerances = if args.tolerance.is_empty() { &TOLERANCES } else { args.tolerance.as_slice() };
    let states = args.states.unwrap_or(STATES);
    let mut plans: Vec<Plan> = Vec::new();
    for name in names {
        let mut plan = crate::args::plan(name.trim_start_matches('~'), &args.flags, None)?;
        if name.starts_with('~') {
            plan.model = irregular(&plan.model, name);
        }
        for dt in if args.dt.is_empty() { &STEPS[..] } else { &args.dt } {
            Scenario::<()>::steps(*dt, states, WINDOW)?;
            plans.push(Plan { dt: *dt, ..plan.clone() });
        }
    }
    if let Some(file) = &args.json {
        safe::prepare_file(file)?;
    }
    let progress = progress();
    let (mut lines, mut samples) = (Vec::new(), Vec::new());
    for plan in &plans {
        let job = Choose { plan, model: &plan.ordered(), tolerances, states, progress: &progress };
        let (more_lines, more_samples) = with_scene(plan, job)?;
        lines.extend(more_lines);
        samples.extend(more_samples);
    }
    progress.finish_and_clear();
    if let Some(file) = &args.json {
        output::json(file, &lines).map_err(Wrong::Failed)?;
    }
    Ok(text(&lines) + &weights::text(&samples))
}

/// The scene as if a mesh generator had numbered it and rcm had put that in order.
fn irregular(model: &Model, name: &str) -> Model {
    let mut order: Vec<usize> = (0..model.position.len()).collect();
    let mut random = 1u64;
    for k in (1..order.len()).rev() {
        // Knuth's multiplier; the upper bits are the random ones.
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        order.swap(k, (random >> 33) as usize % (k + 1));
    }
    let mut shuffled = Numbering::new(model, order).model(model);
    shuffled.name = name.into();
    Numbering::reverse_cuthill_mckee(&shuffled).model(&shuffled)
}

fn text(lines: &[Line]) -> String {
    let mut header = vec!["scene", "particles", "dt", "R"];
    header.extend(METHODS.iter().map(|(name, _)| *name));
    header.extend(["best", "auto", "auto/best"]);
    let rows = lines.iter().map(|line| {
        let mut row = vec![
            line.scene.rsplit(['/', '\\']).next().unwrap_or(&line.scene).into(),
            line.particles.to_string(),
            format!("{:.4}", line.dt),
            format!("{:e}", line.tolerance),
        ];
        row.extend(line.ms.iter().map(|ms| ms.map_or("-".into(), table::short)));
        row.extend([line.best.into(), line.auto.into(), table::short(line.loss)]);
        row
    });
    let mut text = String::from("ms a step, the thread's own time; -: hopeless or impossible, not run\n");
    text += &table::table(&header, 1, rows);
    let losses: Vec<f64> = lines.iter().map(|line| line.loss).collect();
    let right = losses.iter().filter(|loss| **loss <= 1.0).count();
    text += &format!(
        "\nauto takes the fastest in {right} of {}; where not, it takes at worst {} times as long; on average {}\n",
        losses.len(),
        table::short(crate::median::worst(losses.iter().copied())),
        table::short(losses.iter().sum::<f64>() / losses.len() as f64)
    );
    text
}
