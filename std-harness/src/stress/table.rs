//! The tables: a summary of every case, a row for every case and method, and what does not hold.

use std::fmt::Write;

use super::case::{Case, Size};
use super::row::Row;
use super::worst::Worst;

/// What stands before and after the tables in a file.
pub const MARKS: [&str; 2] = ["<!-- stress: ", "<!-- end of stress -->\n"];

/// Numbers of trials, and how they ended.
fn counted(rows: &[Row]) -> (usize, [usize; 3]) {
    let zero = (0, [0; 3]);
    rows.iter()
        .fold(zero, |(n, count), row| (n + row.trials, std::array::from_fn(|k| count[k] + row.count[k])))
}

/// In a sentence.
pub fn total(rows: &[Row], cases: usize) -> String {
    let (trials, [finished, failed, refused]) = counted(rows);
    let broken: usize = rows.iter().map(|row| row.broken.len()).sum();
    format!(
        "{trials} trials of {cases} cases: {finished} finished, {failed} ended with a typed error, {refused} were refused as \
         bad input; {} what must hold broken",
        if broken == 0 { "nothing of".into() } else { format!("{broken} times") }
    )
}

/// The cases with their rows.
fn of<'a>(cases: &'a [Case], rows: &'a [Row]) -> impl Iterator<Item = (&'a Case, &'a [Row])> {
    cases.iter().map(|case| {
        let from = rows.iter().position(|row| row.case == case.name).unwrap_or(0);
        let own = rows[from..].iter().take_while(|row| row.case == case.name).count();
        (case, &rows[from..from + own])
    })
}

fn worst(rows: &[Row]) -> Worst {
    rows.iter().map(|row| row.worst).fold(Worst::default(), Worst::with)
}

/// A figure of two digits, nothing for 0.
fn figure(x: f64) -> String {
    if x == 0.0 {
        String::new()
    } else if (0.01..1000.0).contains(&x) {
        format!("{x:.2}")
    } else {
        format!("{x:.1e}")
    }
}

fn count(x: u64) -> String {
    if x == 0 { String::new() } else { x.to_string() }
}

/// For a terminal: a line for each case, and what does not hold.
pub fn text(cases: &[Case], rows: &[Row]) -> String {
    let width = cases.iter().map(|case| case.name.len()).max().unwrap_or(0);
    let head = ["trials", "finished", "error", "refused", "solves", "iterations", "momentum"];
    let mut s = format!("  {:<width$}", "");
    // Writing to a String cannot fail.
    head.iter().for_each(|name| _ = write!(s, " {name:>10}"));
    s.push('\n');
    for (case, rows) in of(cases, rows) {
        let ((trials, ends), worst) = (counted(rows), worst(rows));
        _ = write!(s, "  {:<width$} {trials:>10}", case.name);
        ends.iter().for_each(|n| _ = write!(s, " {:>10}", count(*n as u64)));
        let last = [count(worst.solves), count(worst.iterations), figure(worst.momentum)];
        last.iter().for_each(|figure| _ = write!(s, " {figure:>10}"));
        s = s.trim_end().to_string() + "\n";
    }
    s += "  solves and iterations are the most of a step; momentum is in what rounding may make of it\n";
    for broken in rows.iter().flat_map(|row| &row.broken) {
        _ = writeln!(s, "  BROKEN {broken}");
    }
    _ = writeln!(s, "  {}", total(rows, cases.len()));
    s
}

/// For a file.
pub fn markdown(cases: &[Case], rows: &[Row], size: Size, command: &str) -> String {
    let mut s = format!("{}{command} -->\n{}.\n\n", MARKS[0], total(rows, cases.len()));
    s += "| case | what | finished | typed error | refused | solves | iterations | rejections | bound, J | momentum | potential |\n";
    s += "| --- | --- | --: | --: | --: | --: | --: | --: | --: | --: | --: |\n";
    for (case, rows) in of(cases, rows) {
        let ((_, [finished, failed, refused]), w) = (counted(rows), worst(rows));
        let ends = [finished, failed, refused].map(|n| count(n as u64)).join(" | ");
        _ = writeln!(
            s,
            "| `{}` | {} | {ends} | {} | {} | {} | {} | {} | {} |",
            case.name,
            case.what,
            count(w.solves),
            count(w.iterations),
            count(w.rejections.into()),
            figure(w.upper),
            figure(w.momentum),
            figure(w.potential)
        );
    }
    for (case, rows) in of(cases, rows) {
        let model = (case.scene)(size);
        _ = writeln!(
            s,
            "\n**`{}`**: {}. {} particles, {} springs, dt {:.4e} s, {} steps, at most {} iterations a solve.\n",
            case.name,
            case.what,
            model.position.len(),
            model.springs.len(),
            model.dt,
            super::case::steps(&model, size),
            super::case::most_iterations(&model)
        );
        s += "| integrator | f64 | f32 | steps | solves | iterations | not met | rejections | bound, J | energy, J | momentum |";
        let loss = rows.iter().any(|row| row.worst.loss > 0.0);
        s += if loss { " lost digits, u·offset |\n" } else { "\n" };
        s += "| --- | --- | --- | --: | --: | --: | --: | --: | --: | --: | --: |";
        s += if loss { " --: |\n" } else { "\n" };
        for row in rows {
            let steps: Vec<String> = row.steps.iter().flatten().map(u64::to_string).collect();
            let w = row.worst;
            _ = write!(
                s,
                "| `{}` | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |",
                row.method,
                row.outcome[0],
                row.outcome[1],
                steps.join(", "),
                count(w.solves),
                count(w.iterations),
                count(row.unmet),
                count(w.rejections.into()),
                figure(w.upper),
                figure(w.energy),
                figure(w.momentum)
            );
            s += &if loss { format!(" {} |\n", figure(w.loss)) } else { "\n".into() };
        }
    }
    let broken: Vec<&String> = rows.iter().flat_map(|row| &row.broken).collect();
    if !broken.is_empty() {
        s += "\nBroken:\n\n";
        broken.iter().for_each(|broken| _ = writeln!(s, "- {broken}"));
    }
    s + MARKS[1]
}

/// A file's text with the tables in it: between the marks that it has, or as all of it.
pub fn placed(old: Option<String>, tables: &str) -> String {
    let parts = old.as_deref().and_then(|old| {
        let (head, rest) = old.split_once(MARKS[0])?;
        let (_, tail) = rest.split_once(MARKS[1])?;
        Some(format!("{head}{tables}{tail}"))
    });
    parts.unwrap_or_else(|| tables.to_string())
}
