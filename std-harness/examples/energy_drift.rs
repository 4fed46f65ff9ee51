//! How the energy of a scene that nothing damps drifts: every method, the same step, up to 10⁵ steps; |E/E₀ − 1| over the number
//! of steps, log–log, as energy_drift.csv and energy_drift.svg in a folder.
//!
//! `cargo run --release -p hooke-harness --example energy_drift -- [SCENE] [DT] [STEPS] [DIR]`, `pair 0.01 100000 out` unless said.

use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use hooke_harness::cli::RunArgs;
use hooke_harness::run::integrator::{INTEGRATORS, Integrator};
use hooke_harness::run::plan::Plan;
use hooke_harness::run::simulation::Simulation;
use plotters::prelude::*;

/// A method's samples: (step, |E/E₀ − 1|).
type Curve = (&'static str, Vec<(u64, f64)>);

fn main() -> Result<(), Box<dyn Error>> {
    let mut given = std::env::args().skip(1);
    let scene = given.next().unwrap_or("pair".into());
    let dt: f64 = given.next().unwrap_or("0.01".into()).parse()?;
    let steps: u64 = given.next().unwrap_or("100000".into()).parse()?;
    let dir = given.next().unwrap_or("out".into());
    let mut curves: Vec<Curve> = Vec::new();
    for (name, _) in INTEGRATORS.into_iter().filter(|(_, integrator)| *integrator != Integrator::Auto) {
        match drift(&scene, name, dt, steps) {
            Ok(samples) => {
                let worst = samples.iter().fold(0.0, |most: f64, s| if s.1 > most { s.1 } else { most });
                println!("{name:<18} at most {worst:.2e}, at the end {:.2e}", samples[samples.len() - 1].1);
                curves.push((name, samples));
            }
            Err(why) => println!("{name:<18} {why}"),
        }
    }
    fs::create_dir_all(&dir)?;
    let mut csv = String::from("method,step,drift\n");
    for (name, samples) in &curves {
        for (step, drift) in samples {
            writeln!(csv, "{name},{step},{drift}")?;
        }
    }
    fs::write(Path::new(&dir).join("energy_drift.csv"), csv)?;
    let title = format!("{scene}, dt {dt} s: drift of the energy");
    plot(&Path::new(&dir).join("energy_drift.svg"), &title, &curves)
}

/// Samples at 1, 2, 5, 10, 20 … steps: the worst since the sample before.
fn drift(scene: &str, integrator: &str, dt: f64, steps: u64) -> Result<Vec<(u64, f64)>, Box<dyn Error>> {
    let plan = Plan::new(&RunArgs {
        scene: Some(scene.into()),
        dt: Some(dt),
        steps: Some(steps),
        integrator: integrator.into(),
        solver: "auto".into(),
        // energy-momentum keeps energy to this.
        tolerance: Some(1e-14),
        json: Some("unused".into()),
        quiet: true,
        ..RunArgs::default()
    })?;
    let mut simulation = Simulation::<f64>::new(&plan)?;
    let start = simulation.energy(0.0).total;
    let (mut samples, mut next, mut worst) = (Vec::new(), 1, 0.0);
    for step in 1..=steps {
        simulation.step(step).map_err(|error| format!("failed at step {step}: {error}"))?;
        let off = (simulation.energy(0.0).total / start - 1.0).abs();
        worst = if off > worst { off } else { worst };
        if step == next || step == steps {
            // Rounding alone is 1e-16; zero has no logarithm.
            samples.push((step, if worst > 1e-17 { worst } else { 1e-17 }));
            worst = 0.0;
            let leading = next / 10u64.pow(next.ilog10());
            next = if leading == 2 { next / 2 * 5 } else { next * 2 };
        }
    }
    Ok(samples)
}

fn plot(file: &Path, title: &str, curves: &[Curve]) -> Result<(), Box<dyn Error>> {
    let last = curves.iter().flat_map(|curve| curve.1.last()).map(|sample| sample.0).max().unwrap_or(10);
    let root = SVGBackend::new(file, (960, 600)).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&root)
        .margin(16)
        .caption(title, ("sans-serif", 22))
        .x_label_area_size(44)
        .y_label_area_size(70)
        .build_cartesian_2d((1f64..last as f64 * 1.2).log_scale(), (1e-17..10f64).log_scale())?;
    chart
        .configure_mesh()
        .x_desc("steps")
        .y_desc("|E/E₀ − 1|, the worst since the point before")
        .y_label_formatter(&|y| format!("{y:.0e}"))
        .x_label_formatter(&|x| format!("{x:.0e}"))
        .light_line_style(WHITE)
        .draw()?;
    for (k, (name, samples)) in curves.iter().enumerate() {
        let colour = Palette99::pick(k).to_rgba();
        let points = || samples.iter().map(|(step, drift)| (*step as f64, *drift));
        chart
            .draw_series(LineSeries::new(points(), colour.stroke_width(2)))?
            .label(*name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 24, y)], colour.stroke_width(2)));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::MiddleRight)
        .background_style(WHITE)
        .border_style(BLACK.mix(0.2))
        .label_font(("sans-serif", 14))
        .legend_area_size(30)
        .draw()?;
    root.present()?;
    Ok(())
}
