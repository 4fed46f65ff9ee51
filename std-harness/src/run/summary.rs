//! The summary at the end of a run: what a person wants to read.

use std::fmt::Write;

use super::integrator::Integrator;
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

/// Six significant digits, without an exponent where that is short.
fn figure(x: f64) -> String {
    let size = x.abs();
    if size != 0.0 && !(1e-4..1e7).contains(&size) {
        return format!("{x:.5e}");
    }
    let before = if size < 1.0 { 1 } else { size.log10().floor() as usize + 1 };
    format!("{x:.*}", 6usize.saturating_sub(before).max(1))
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
    let method = plan.integrator.title();
    if plan.integrator.is_explicit() {
        line("method", format!("{method}, {precision}"));
    } else {
        line("method", format!("{method}, {}, {precision}", plan.method));
    }
    if let Some(reason) = &o.integrator_reason {
        match plan.integrator {
            Integrator::Auto => line("", reason.clone()),
            name => line("", format!("auto took {}: {reason}", name.name())),
        }
    }
    if let Some(reason) = &plan.reason {
        line("", format!("auto took {}: {reason}", plan.method.name()));
    }
    if let Some(failure) = &o.failure {
        line("failed", failure.to_string());
    }
    let made = count(o.steps as usize, "step", "steps");
    match &o.chosen {
        None => line("time", format!("{made} of {:.4} ms = {:.4} s", o.dt * 1e3, o.dt * o.steps as f64)),
        Some(chosen) => {
            let (from, to) = (chosen.shortest * 1e3, chosen.longest * 1e3);
            let rejected = count(chosen.rejected as usize, "other", "others");
            line(
                "time",
                format!(
                    "{made} of {from:.4} to {to:.4} ms = {:.4} s; {rejected} rejected",
                    o.dt * o.steps as f64
                ),
            );
            line(
                "error",
                format!(
                    "at most {:.1e} J a step are estimated; all position errors together {:.1e} m",
                    chosen.error_j, chosen.error_m
                ),
            );
        }
    }
    if o.steps == 0 {
        return s;
    }
    line("took", format!("{:.2} s; {:.3} ms a step (median)", o.wall_s, o.step_ms));
    if !plan.integrator.is_explicit() {
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
                "the worst is off by an energy between {:.1e} and {:.1e} J",
                o.error_lower_j, o.error_bound_j
            ),
        );
        let certified = o.steps - o.uncertified_steps;
        let clamped = match o.clamped {
            0 => "nothing clamped".into(),
            n => format!("{} clamped in the others", count(n as usize, "spring", "springs")),
        };
        line(
            "projection",
            format!("{} of {} steps certified to need none; {clamped}", grouped(certified), grouped(o.steps)),
        );
    }
    let mut skipped = Vec::new();
    if o.untouched_islands > 0 {
        let solves = count(o.untouched_islands as usize, "island solve", "island solves");
        skipped.push(format!("{solves} took no iteration"));
    }
    if o.asleep_islands > 0 {
        let solves = grouped(o.asleep_islands);
        let at_end = count(o.asleep_at_end as usize, "island", "islands");
        skipped.push(format!("{solves} of them asleep, {at_end} at the end"));
    }
    if o.springs_skipped > 0 {
        let springs = count(o.springs_skipped as usize, "spring", "springs");
        skipped.push(format!("{springs} needed by no island"));
    }
    if !skipped.is_empty() {
        line("skipped", skipped.join("; "));
    }
    for (name, steps, what) in [
        ("note", o.at_floor, "solved to the floor of rounding: as exact as the precision allows"),
        ("note", o.fallback_steps, "too ill-conditioned for the direct solver: block-Jacobi PCG answered"),
        ("attention", o.capped_steps, "used up --max-iterations: see the bound above"),
        ("attention", o.stalled_steps, "stalled above the floor: see the bound above"),
    ] {
        if steps > 0 {
            line(name, format!("{} {what}", count(steps as usize, "step", "steps")));
        }
    }
    let e = &o.energy;
    line("energy", format!("{} J → {} J", figure(o.energy_start), figure(o.energy_end)));
    let parts = [e.kinetic, e.springs, e.gravity].map(figure);
    line("", format!("kinetic {}, springs {}, gravity {} J", parts[0], parts[1], parts[2]));
    line("fastest", format!("{} m/s", figure(o.speed_max)));
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
