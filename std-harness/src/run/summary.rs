//! The summary at the end of a run: what a person wants to read.

use std::fmt::Write;

use super::outcome::Outcome;
use super::plan::Plan;
use super::recorder::Recorder;
use crate::cli::Precision;

/// 1234567 → 1,234,567.
pub fn grouped(n: impl Into<u128>) -> String {
    let digits = n.into().to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i) % 3 == 0 {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

fn count(n: usize, one: &str, many: &str) -> String {
    format!("{} {}", grouped(n as u128), if n == 1 { one } else { many })
}

/// The whole text, empty if the run is quiet.
pub fn text(plan: &Plan, outcome: &Outcome, recorder: &Recorder<'_>) -> String {
    let mut s = String::new();
    if plan.quiet {
        return s;
    }
    let o = outcome;
    let precision = if plan.precision == Precision::F64 { "f64" } else { "f32" };
    let steps = o.steps.max(1) as f64;
    // Writing to a String cannot fail.
    let mut line = |name: &str, value: String| _ = writeln!(s, "  {name:<11}{value}");
    line("scene", o.scene.clone());
    line(
        "size",
        format!(
            "{} ({} free), {}, {}",
            count(o.particles, "particle", "particles"),
            grouped(o.free as u128),
            count(o.springs, "spring", "springs"),
            count(o.islands, "island", "islands")
        ),
    );
    for note in &plan.model.notes {
        line("note", note.clone());
    }
    line("method", format!("linearly-implicit Euler, block-Jacobi PCG, {precision}"));
    line(
        "time",
        format!("{} steps of {:.4} ms = {:.4} s", grouped(o.steps), o.dt * 1e3, o.dt * o.steps as f64),
    );
    line("took", format!("{:.2} s; {:.3} ms a step (median)", o.wall_s, o.step_ms));
    line(
        "solves",
        format!(
            "{:.1} iterations a step, at most {}",
            o.iterations as f64 / steps,
            grouped(o.iterations_max)
        ),
    );
    line(
        "",
        format!(
            "energy of the worst solve's error between {:.1e} and {:.1e} J",
            o.error_lower_j, o.error_bound_j
        ),
    );
    let certified = o.steps - o.uncertified_steps;
    let clamped = match o.clamped {
        0 => "nothing clamped".into(),
        n => format!("{} springs clamped in the others", grouped(n)),
    };
    line(
        "projection",
        format!("{} of {} steps certified to need none; {clamped}", grouped(certified), grouped(o.steps)),
    );
    let mut skipped = Vec::new();
    if o.untouched_islands > 0 {
        skipped.push(format!("{} island solves took no iteration", grouped(o.untouched_islands)));
    }
    if o.springs_skipped > 0 {
        skipped.push(format!("{} springs needed by no island", grouped(o.springs_skipped)));
    }
    if !skipped.is_empty() {
        line("skipped", skipped.join("; "));
    }
    for (steps, what) in [
        (o.at_floor, "ended at the floor of their rounding: as exact as the precision allows"),
        (o.capped_steps, "used up --max-iterations: see the bound above"),
        (o.stalled_steps, "stalled above the floor: see the bound above"),
    ] {
        if steps > 0 {
            line("attention", format!("{} steps {what}", grouped(steps)));
        }
    }
    let e = &o.energy;
    line("energy", format!("{:.6} J → {:.6} J", o.energy_start, o.energy_end));
    line("", format!("kinetic {:.6}, springs {:.6}, gravity {:.6} J", e.kinetic, e.springs, e.gravity));
    if let Some(drift) = o.momentum_drift {
        line("momentum", format!("kept to {drift:.1e} kg m/s"));
    }
    line("memory", format!("{} bytes for state and solver", grouped(o.workspace_bytes as u128)));
    if let Some(dir) = recorder.dir() {
        line("wrote", format!("{}: {}", dir.display(), count(recorder.frames, "frame", "frames")));
        for file in &recorder.written {
            line("", file.display().to_string());
        }
    }
    for file in [&plan.final_csv, &plan.json].into_iter().flatten() {
        line("wrote", file.display().to_string());
    }
    s
}
