//! How time and memory of a step grow with the number of particles: dt 1/60 unless said, medians over states at t = 0.25–0.5 s of a
//! trajectory solved to R = 1e-3 (a finer one would take hours on the largest scenes), and the exponent of a power law
//! through each family of scenes. (One state would not do: at t = 0.25 s a cloth of 512×512 has hardly begun to move, and
//! its solve takes a third of the iterations of one of 256×256.)

use std::path::Path;
use std::time::Instant;

use hooke::Force;
use hooke_harness::output::safe;
use hooke_harness::run::plan::Plan;
use hooke_harness::run::solver::Method;
use indicatif::ProgressBar;

use crate::args::Args;
use crate::compare::{Job, Wrong, progress, with_scene};
use crate::contender::Contender;
use crate::family::{Family, Point, families};
use crate::median::median;
use crate::scenario::{Scenario, WINDOW};
use crate::{growth_plot, memory, methods, output, table};

const SCENES: [&str; 10] = [
    "cloth:32",
    "cloth:64",
    "cloth:128",
    "cloth:256",
    "cloth:512",
    "lattice:8x8x8",
    "lattice:13x13x13",
    "lattice:20x20x20",
    "lattice:30x30x30",
    "lattice:43x43x43",
];
/// The tolerance unless one is given, and that of every trajectory.
const TOLERANCE: f64 = 1e-3;
/// The methods unless some are named.
const METHODS: [Method; 2] = [Method::Jacobi, Method::Multigrid];
const STATES: usize = 3;
const STEP: f64 = 1.0 / 60.0;

struct Grow<'a> {
    states: usize,
    methods: &'a [Method],
    tolerances: &'a [f64],
    progress: &'a ProgressBar,
}

impl Job for Grow<'_> {
    type Output = (Vec<Point>, Vec<String>);

    fn run<F: Force<f64> + Clone>(self, mut scenario: Scenario<F>) -> Result<Self::Output, Wrong> {
        let name = scenario.name.clone();
        let failed = |why: String| Wrong::Failed(format!("{name}: {why}"));
        let steps = Scenario::<F>::steps(scenario.euler.dt(), self.states, WINDOW)?;
        let of = steps.last().copied().unwrap_or(0);
        let step = |step| self.progress.set_message(format!("{name}: trajectory, step {step}/{of}"));
        scenario.record(&steps, Some(TOLERANCE), step).map_err(|error| failed(error.to_string()))?;
        let (mut points, mut skipped) = (Vec::new(), Vec::new());
        for &method in self.methods {
            for &tolerance in self.tolerances {
                self.progress.set_message(format!("{name}: {} at {tolerance:e}", methods::name(method)));
                let mut contender = match Contender::hooke(method, tolerance, &mut scenario) {
                    Ok(contender) => contender,
                    Err(why) => {
                        skipped.push(format!("{name}: {} skipped: {why}\n", methods::name(method)));
                        break;
                    }
                };
                let (mut ms, mut iterations) = (Vec::new(), Vec::new());
                for k in 0..scenario.states() {
                    let mut times = Vec::new();
                    let began = Instant::now();
                    while times.is_empty() || (times.len() < 9 && began.elapsed().as_secs_f64() < 0.5) {
                        scenario.put(k);
                        let answer = contender.run(&mut scenario, k).map_err(failed)?;
                        times.push(1e3 * answer.seconds);
                        if times.len() == 1 {
                            iterations.push(f64::from(answer.iterations));
                        }
                    }
                    ms.push(median(times));
                }
                points.push(Point {
                    scene: name.clone(),
                    dt: scenario.euler.dt(),
                    tolerance,
                    method: contender.name.into(),
                    particles: scenario.scene.positions().len(),
                    springs: scenario.scene.state().springs(),
                    ms: median(ms),
                    iterations: median(iterations),
                    workspace_bytes: contender.bytes,
                });
            }
        }
        Ok((points, skipped))
    }
}

/// Measures, prints, plots.
pub(crate) fn growth(args: &Args, svg: &Path) -> Result<String, Wrong> {
    let methods = methods::named(&args.method, &METHODS)?;
    let tolerances = if args.tolerance.is_empty() { &[TOLERANCE] } else { args.tolerance.as_slice() };
    let states = args.states.unwrap_or(STATES);
    let mut plans: Vec<Plan> = args.plans(&SCENES)?;
    for plan in &mut plans {
        if args.dt.is_empty() {
            plan.dt = STEP;
        }
        Scenario::<()>::steps(plan.dt, states, WINDOW)?;
    }
    if let Some(file) = &args.json {
        safe::prepare_file(file)?;
    }
    if let Some(dir) = svg.parent().filter(|dir| !dir.as_os_str().is_empty()) {
        safe::prepare_dir(dir)?;
    }
    safe::prepare_file(svg)?;
    let progress = progress();
    let (mut points, mut skipped) = (Vec::new(), Vec::new());
    for plan in &plans {
        let job = Grow { states, methods: &methods, tolerances, progress: &progress };
        let (more, without) = with_scene(plan, job)?;
        points.extend(more);
        skipped.extend(without);
    }
    progress.finish_and_clear();
    let families = families(&points);
    let picture = growth_plot::svg(&families).map_err(|error| Wrong::Failed(format!("plot: {error}")))?;
    safe::write_file(svg, |out| out.write_all(picture.as_bytes()))
        .map_err(|error| Wrong::Failed(error.to_string()))?;
    if let Some(file) = &args.json {
        output::json(file, &points).map_err(Wrong::Failed)?;
    }
    let said = text(&points, &families) + &skipped.concat();
    Ok(said + &format!("plot: {}\n", svg.display()))
}

fn text(points: &[Point], families: &[Family]) -> String {
    let header = ["scene", "dt", "R", "method", "particles", "springs", "ms", "iter", "MB"];
    let lines = points.iter().map(|p| {
        vec![
            p.scene.clone(),
            format!("{:.4}", p.dt),
            format!("{:e}", p.tolerance),
            p.method.clone(),
            p.particles.to_string(),
            p.springs.to_string(),
            table::short(p.ms),
            p.iterations.to_string(),
            table::short(p.workspace_bytes as f64 / 1e6),
        ]
    });
    let power = |p: Option<f64>| p.map_or("-".into(), |p| format!("n^{p:.2}"));
    let fits = families.iter().map(|f| vec![f.label.clone(), power(f.time), power(f.memory)]);
    let mut text = table::table(&header, 4, lines);
    text += &format!("\n{}", table::table(&["family", "time", "memory"], 1, fits));
    if let Some(bytes) = memory::peak_resident() {
        text += &format!("\npeak resident memory of all this: {} MB\n", bytes / 1_000_000);
    }
    text
}
