//! The figures of the README: runs the scenes, prints the table, and writes it between the marks of README.md, or with
//! `--check` says whether what stands there is what the code gives. All of them are counts and bounds that do not
//! depend on the machine.
//!
//! `cargo run --release -p hooke-tests --bin figures [-- --check]`

use std::error::Error;
use std::path::Path;
use std::{fs, process};

use hooke::SceneIn;
use hooke_harness::cli::RunArgs;
use hooke_harness::run;
use serde_json::Value;

const BEGIN: &str = "<!-- figures: cargo run --release -p hooke-tests --bin figures -->\n";
const END: &str = "<!-- end of figures -->";

/// Scene, dt, steps, tolerance.
const RUNS: [(&str, f64, u64, f64); 7] = [
    ("curtain", 1.0 / 120.0, 120, 1e-6),
    ("cloth:16", 1.0 / 60.0, 60, 1e-12),
    ("cloth:32", 1.0 / 60.0, 60, 1e-6),
    ("cloth:32", 1.0 / 1000.0, 400, 1e-6),
    ("cloth:64", 1.0 / 60.0, 60, 1e-6),
    ("chain:200", 1.0 / 200.0, 160, 1e-6),
    ("lattice:8x8x8", 1.0 / 60.0, 60, 1e-6),
];

fn main() -> Result<(), Box<dyn Error>> {
    let text = table()?;
    let readme = Path::new(env!("CARGO_MANIFEST_DIR")).join("../README.md");
    let old = fs::read_to_string(&readme)?;
    let (head, rest) = old.split_once(BEGIN).ok_or("README.md has lost the mark where the figures begin")?;
    let (_, tail) = rest.split_once(END).ok_or("README.md has lost the mark where the figures end")?;
    let new = format!("{head}{BEGIN}{text}{END}{tail}");
    print!("{text}");
    if std::env::args().any(|argument| argument == "--check") {
        if new != old {
            eprintln!("the figures in README.md are not those of the code; run the command in its mark");
            process::exit(1);
        }
    } else {
        fs::write(&readme, new)?;
    }
    Ok(())
}

fn table() -> Result<String, Box<dyn Error>> {
    let mut text = String::from(
        "| scene | particles | springs | dt, ms | steps | R | iterations a step | steps certified | springs clamped | \
         worst solve's error is between, J |\n| --- | --: | --: | --: | --: | --: | --: | --: | --: | --- |\n",
    );
    let json = std::env::temp_dir().join(format!("hooke-figures-{}.json", process::id()));
    for (scene, dt, steps, tolerance) in RUNS {
        let args = RunArgs {
            scene: Some(scene.into()),
            dt: Some(dt),
            steps: Some(steps),
            tolerance: Some(tolerance),
            integrator: "euler".into(),
            solver: "jacobi".into(),
            json: Some(json.clone()),
            quiet: true,
            ..RunArgs::default()
        };
        run::run(&args).map_err(|error| format!("{scene}: {error:?}"))?;
        let outcome: Value = serde_json::from_str(&fs::read_to_string(&json)?)?;
        let count = |key: &str| outcome[key].as_u64().ok_or(format!("{key} is no count"));
        let number = |key: &str| outcome[key].as_f64().ok_or(format!("{key} is no number"));
        text.push_str(&format!(
            "| {scene} | {} | {} | {:.3} | {steps} | {tolerance:e} | {:.1} | {} | {} | {:.0e} and {:.0e} |\n",
            count("particles")?,
            count("springs")?,
            dt * 1e3,
            count("iterations")? as f64 / steps as f64,
            steps - count("uncertified_steps")?,
            count("clamped")?,
            number("error_lower_J")?,
            number("error_bound_J")?,
        ));
    }
    fs::remove_file(&json)?;
    let bytes = |size: usize, particles, springs| {
        let (reals, words) = SceneIn::<f64>::needs(particles, springs);
        reals * size + words * 4
    };
    text.push_str(&format!(
        "\nMemory of a scene with its solver: {} bytes per particle and {} per spring in f32, {} and {} in f64.\n",
        bytes(4, 1, 0),
        bytes(4, 0, 1),
        bytes(8, 1, 0),
        bytes(8, 0, 1),
    ));
    Ok(text)
}
