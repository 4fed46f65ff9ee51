//! `hooke rest`: where a scene comes to rest under its forces, and how far from it the answer is, in newtons.
//!
//! Dynamic relaxation with kinetic damping, by steps of [`hooke::Newton`]: the scene swings, backward Euler damps it, and all
//! velocities are dropped whenever the potential has risen. The step grows by half each time, up to a thousand of the scene's
//! own, and is cut to an eighth where it fails; in long steps Newton's method is one on V itself. Where springs are compressed
//! there are many equilibria (wrinkles): what is found is one of them. It ends where no free particle feels more than the wanted
//! force.
//!
//! Source: Barnes 1999, *Form finding and analysis of tension structures by dynamic relaxation* (kinetic damping).

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use serde::Serialize;

use super::RunError;
use super::plan::Plan;
use super::simulation::Simulation;
use super::summary::grouped;
use crate::cli::{Overrides, Precision, Renumber, RunArgs};
use crate::error::InputError;
use crate::output::safe;
use crate::scene::graph::{Graph, NOWHERE};

/// Options of `hooke rest`.
#[derive(Debug, Clone, Default, Args)]
pub struct RestArgs {
    /// A scene's name, a mesh file or a scene .toml [default: curtain]
    pub scene: Option<String>,
    /// The force that may be left on a particle, N [default: a millionth of the heaviest particle's weight, or of 1 N]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub force: Option<f64>,
    /// Linear solver, as in hooke run
    #[arg(long, value_name = "NAME", default_value = "auto")]
    pub solver: String,
    /// What of the scene is to be otherwise.
    #[command(flatten)]
    pub overrides: Overrides,
    /// The state at rest as CSV, for hooke run --from [default: out/rest.csv]
    #[arg(long = "final", value_name = "FILE", help_heading = "Output")]
    pub final_csv: Option<PathBuf>,
    /// What was found, as JSON
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub json: Option<PathBuf>,
    /// No progress and no summary
    #[arg(long, help_heading = "Output")]
    pub quiet: bool,
}

/// No more steps than these.
const STEPS: u32 = 2000;
/// The longest step, in those of the scene.
const LONGEST: f64 = 1e3;
/// Of Newton's iterations: the next step goes on where this one leaves off.
const TOLERANCE: f64 = 1e-2;

/// What was found.
#[derive(Debug, Clone, Serialize)]
struct Found {
    scene: String,
    particles: usize,
    free: usize,
    springs: usize,
    steps: u32,
    iterations: u64,
    /// The largest force that is left on a free particle, N
    residual_force_n: f64,
    /// On which
    particle: usize,
    /// What was wanted, N
    force_n: f64,
    potential_start: f64,
    potential_end: f64,
    wall_s: f64,
}

/// Finds it; answers the summary to print.
pub fn rest(args: &RestArgs) -> Result<String, RunError> {
    let plan = plan(args)?;
    let wanted = wanted(args, &plan)?;
    has_somewhere_to_rest(&plan)?;
    let mut simulation = Simulation::<f64>::new(&plan)?;
    plan.prepare_outputs()?;
    let began = Instant::now();
    simulation.stop();
    let start = simulation.energy(0.0);
    let (mut dt, mut steps, mut iterations) = (plan.dt, 0, 0);
    let (mut left, mut potential) = (simulation.left(), start.springs + start.gravity);
    let bar =
        if plan.quiet { indicatif::ProgressBar::hidden() } else { indicatif::ProgressBar::new_spinner() };
    while left.1 > wanted && steps < STEPS {
        match simulation.relax(dt) {
            Ok(report) => {
                iterations += u64::from(report.iterations);
                let now = simulation.energy(0.0);
                let now = now.springs + now.gravity;
                if now > potential {
                    simulation.stop();
                }
                potential = now;
                dt = if 1.5 * dt < LONGEST * plan.dt { 1.5 * dt } else { LONGEST * plan.dt };
            }
            Err(_) if dt > 1e-6 * plan.dt => dt *= 0.125,
            Err(error) => return Err(RunError::Failed(format!("step {}: {error}", steps + 1))),
        }
        steps += 1;
        left = simulation.left();
        bar.set_message(format!(
            "{}: step {steps}, {:.2e} N left, {wanted:.1e} wanted",
            plan.model.name, left.1
        ));
        bar.tick();
    }
    simulation.stop();
    bar.finish_and_clear();
    let end = simulation.energy(0.0);
    let found = Found {
        scene: plan.model.name.clone(),
        particles: plan.model.mass.len(),
        free: simulation.scene.free_particles(),
        springs: plan.model.springs.len(),
        steps,
        iterations,
        residual_force_n: left.1,
        particle: left.0,
        force_n: wanted,
        potential_start: start.springs + start.gravity,
        potential_end: end.springs + end.gravity,
        wall_s: began.elapsed().as_secs_f64(),
    };
    let lost = |error: std::io::Error| RunError::Failed(format!("cannot write: {error}"));
    if let Some(file) = &plan.final_csv {
        simulation.write_final(file).map_err(lost)?;
    }
    if let Some(file) = &plan.json {
        let write = |to: &mut dyn std::io::Write| {
            serde_json::to_writer_pretty(&mut *to, &found)?;
            to.write_all(b"\n")
        };
        safe::write_file(file, write).map_err(lost)?;
    }
    if left.1 > wanted {
        return Err(RunError::Failed(format!(
            "not at rest after {steps} steps: {:.2e} N are left on particle {}, {wanted:.1e} are wanted; what there is was written",
            left.1, left.0
        )));
    }
    Ok(if plan.quiet { String::new() } else { text(&plan, &found) })
}

fn text(plan: &Plan, found: &Found) -> String {
    let mut text = format!(
        "  scene      {}\n  size       {} particles ({} free), {} springs\n  at rest    {:.2e} N are left on particle {}, at \
         most {:.1e} were wanted\n  took       {} steps, {} iterations, {:.2} s\n  energy     potential {:.6e} J → {:.6e} J\n",
        found.scene,
        grouped(found.particles as u128),
        grouped(found.free as u128),
        grouped(found.springs as u128),
        found.residual_force_n,
        found.particle,
        found.force_n,
        found.steps,
        grouped(found.iterations),
        found.wall_s,
        found.potential_start,
        found.potential_end
    );
    for file in [&plan.final_csv, &plan.json].into_iter().flatten() {
        text += &format!("  wrote      {}\n", file.display());
    }
    if let Some(file) = &plan.final_csv {
        text += &format!("  go on with hooke run {} --from {}\n", found.scene, file.display());
    }
    text
}

/// The run that it is made of.
fn plan(args: &RestArgs) -> Result<Plan, InputError> {
    let run = RunArgs {
        scene: args.scene.clone(),
        steps: Some(0),
        integrator: "newton".into(),
        tolerance: Some(TOLERANCE),
        solver: args.solver.clone(),
        overrides: args.overrides.clone(),
        final_csv: Some(args.final_csv.clone().unwrap_or_else(|| PathBuf::from("out/rest.csv"))),
        json: args.json.clone(),
        quiet: args.quiet,
        renumber: Renumber::None,
        precision: Precision::F64,
        ..RunArgs::default()
    };
    if args.final_csv.is_none() {
        safe::prepare_dir(std::path::Path::new("out"))?;
    }
    Plan::new(&run)
}

fn wanted(args: &RestArgs, plan: &Plan) -> Result<f64, InputError> {
    let size = |x: [f64; 3]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
    let heaviest = plan.model.mass.iter().copied().fold(0.0, f64::max) * size(plan.model.gravity);
    let usual = 1e-6 * if heaviest > 0.0 { heaviest } else { 1.0 };
    match args.force {
        Some(force) if force.is_finite() && force > 0.0 => Ok(force),
        Some(force) => Err(InputError::new(format!("--force {force}: not a positive finite number"))),
        None => Ok(usual),
    }
}

/// A part that nothing holds falls for ever.
fn has_somewhere_to_rest(plan: &Plan) -> Result<(), InputError> {
    let model = &plan.model;
    if model.gravity == [0.0; 3] {
        return Ok(());
    }
    let (graph, n) = (Graph::new(model), model.pinned.len());
    let mut anchored = vec![false; n];
    for [a, b] in model.springs.iter().map(|spring| spring.ends) {
        anchored[a] |= model.pinned[b];
        anchored[b] |= model.pinned[a];
    }
    let starts: Vec<usize> = (0..n).filter(|i| anchored[*i] && !model.pinned[*i]).collect();
    let (mut level, mut order) = (vec![NOWHERE; n], Vec::new());
    graph.walk(&starts, &mut level, &mut order);
    match (0..n).find(|i| level[*i] == NOWHERE && !model.pinned[*i]) {
        None => Ok(()),
        Some(i) => Err(InputError::new(format!(
            "{}: nothing holds particle {i}, it falls for ever; --pin something, or --gravity 0,0,0",
            model.name
        ))),
    }
}
