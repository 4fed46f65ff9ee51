//! The runs as CSV, and as a table for people.

use std::fmt::{Display, Write};
use std::io;
use std::path::Path;

use super::row::Row;
use crate::output::safe;

/// The columns of the CSV.
pub const HEADER: &str = "curve,method,solver,dt_s,accuracy_J,steps,rejected,solves,iterations,clamped,ms,wall_ms,instructions,error_m,\
                          energy_drift,momentum_drift,note";

/// Writes a row per run; what is not known is empty.
pub fn write(path: &Path, rows: &[Row]) -> io::Result<()> {
    safe::write_file(path, |out| {
        writeln!(out, "{HEADER}")?;
        for row in rows {
            let fields = [
                quoted(&row.curve),
                row.method.into(),
                row.solver.unwrap_or_default().into(),
                shown(row.dt),
                shown(row.accuracy),
                row.steps.to_string(),
                row.rejected.to_string(),
                shown(row.solves),
                row.iterations.to_string(),
                row.clamped.to_string(),
                shown(row.ms),
                shown(row.wall_ms),
                shown(row.instructions),
                shown(row.error),
                shown(row.energy_drift),
                shown(row.momentum_drift),
                quoted(&row.note),
            ];
            writeln!(out, "{}", fields.join(","))?;
        }
        Ok(())
    })
}

fn shown(value: Option<impl Display>) -> String {
    value.map_or(String::new(), |value| value.to_string())
}

/// In quotes if a reader would take it apart.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.into() }
}

/// The runs, a line each.
pub fn text(rows: &[Row]) -> String {
    let name = rows.iter().map(|row| row.curve.len()).max().unwrap_or(0);
    let counted = rows.iter().any(|row| row.instructions.is_some());
    let free = rows.iter().any(|row| row.momentum_drift.is_some());
    let mut s = String::new();
    // Writing to a String cannot fail.
    _ = write!(s, "  {:<name$} {:>9} {:>9} {:>9} {:>8}", "", "dt, ms", "error, m", "ms", "steps");
    _ = write!(s, " {:>8} {:>10} {:>9} {:>9}", "rejected", "iterations", "clamped", "ΔE/E");
    if counted {
        _ = write!(s, " {:>12}", "instructions");
    }
    _ = writeln!(s, "{}  solver", if free { format!(" {:>9}", "Δp, kgm/s") } else { String::new() });
    let mut last = "";
    for row in rows {
        let curve = if row.curve == last { "" } else { &row.curve };
        last = &row.curve;
        let short = |value: Option<f64>| value.map_or("–".into(), |value| format!("{value:.1e}"));
        _ = write!(s, "  {curve:<name$} {:>9} {:>9}", figure(row.dt.map(|dt| 1e3 * dt)), short(row.error));
        _ = write!(s, " {:>9} {:>8} {:>8}", figure(row.ms), row.steps, row.rejected);
        _ = write!(s, " {:>10} {:>9} {:>9}", row.iterations, row.clamped, short(row.energy_drift));
        if counted {
            _ = write!(s, " {:>12}", figure(row.instructions.map(|n| n as f64)));
        }
        if free {
            _ = write!(s, " {:>9}", short(row.momentum_drift));
        }
        let accuracy = row.accuracy.map_or(String::new(), |joules| format!("{joules:.0e} J"));
        let words = [row.solver.unwrap_or_default(), &accuracy, &row.note];
        let words: Vec<&str> = words.into_iter().filter(|word| !word.is_empty()).collect();
        _ = writeln!(s, "  {}", words.join("; "));
    }
    s.lines().map(|line| format!("{}\n", line.trim_end())).collect()
}

/// Four significant digits.
pub fn figure(value: Option<f64>) -> String {
    let Some(x) = value else { return "–".into() };
    let size = x.abs();
    if size != 0.0 && !(1e-4..1e7).contains(&size) {
        return format!("{x:.2e}");
    }
    let before = if size < 1.0 { (size.log10().floor() + 1.0) as i32 } else { size.log10() as i32 + 1 };
    format!("{x:.*}", (4 - before).clamp(0, 9) as usize)
}
