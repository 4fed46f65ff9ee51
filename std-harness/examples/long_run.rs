//! Does a long run slow down, and does its energy drift? Thread time and iterations per step and |E − E₀|, in units of the most
//! that was in motion and springs so far, for each tenth of a run by itself: what grows with the number of steps shows from
//! tenth to tenth.
//!
//! `cargo run --release -p hooke-harness --example long_run -- SCENE INTEGRATOR DT STEPS [TOLERANCE]`, as the options of
//! `hooke run`; verlet makes as many substeps as its limit asks for.

use std::error::Error;

use cpu_time::ThreadTime;
use hooke_harness::cli::RunArgs;
use hooke_harness::run::plan::Plan;
use hooke_harness::run::simulation::Simulation;

fn main() -> Result<(), Box<dyn Error>> {
    let given: Vec<String> = std::env::args().skip(1).collect();
    let [scene, integrator, dt, steps, tolerance @ ..] = &given[..] else {
        return Err("SCENE INTEGRATOR DT STEPS [TOLERANCE]".into());
    };
    let steps: u64 = steps.parse()?;
    let plan = Plan::new(&RunArgs {
        scene: Some(scene.clone()),
        dt: Some(dt.parse()?),
        steps: Some(steps),
        integrator: integrator.clone(),
        solver: "auto".into(),
        substeps: (integrator == "verlet").then_some(1_000_000),
        tolerance: tolerance.first().map(|tolerance| tolerance.parse()).transpose()?,
        json: Some("unused".into()),
        quiet: true,
        ..RunArgs::default()
    })?;
    let mut simulation = Simulation::<f64>::new(&plan)?;
    let (start, momentum) = (simulation.energy(0.0), simulation.momentum());
    println!("{scene}, {integrator}, dt {dt} s, {steps} steps; E at the start {:.6e} J", start.total);
    println!("{:>10} {:>12} {:>12} {:>12} {:>12}", "steps", "µs a step", "iterations", "E, J", "|E − E₀|");
    let mut held = start.kinetic + start.springs;
    let mut first = 1;
    for tenth in 1..=10 {
        let last = steps * tenth / 10;
        let (mut iterations, mut worst, mut passed) = (0, 0.0, 0.0);
        // The energy is asked for a thousand times a tenth, and not timed.
        let every = ((last + 1 - first) / 1000).max(1);
        let mut step = first;
        while step <= last {
            let until = (step + every - 1).min(last);
            let clock = ThreadTime::now();
            for step in step..=until {
                let reports = simulation.step(step).map_err(|error| format!("step {step}: {error}"))?;
                iterations += reports.iter().map(|report| u64::from(report.iterations)).sum::<u64>();
            }
            passed += clock.elapsed().as_secs_f64();
            step = until + 1;
            let now = simulation.energy(0.0);
            held = if now.kinetic + now.springs > held { now.kinetic + now.springs } else { held };
            let off = (now.total - start.total).abs() / held;
            worst = if off > worst { off } else { worst };
        }
        let made = (last + 1 - first) as f64;
        let energy = simulation.energy(0.0).total;
        let (time, iterations) = (1e6 * passed / made, iterations as f64 / made);
        println!("{last:>10} {time:>12.3} {iterations:>12.2} {energy:>12.4e} {worst:>12.2e}");
        first = last + 1;
    }
    let now = simulation.momentum();
    let off = (0..3).map(|c| (now[c] - momentum[c]).powi(2)).sum::<f64>().sqrt();
    println!("linear momentum changed by {off:.2e} kg m/s");
    Ok(())
}
