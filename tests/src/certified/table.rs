//! Tables of what was seen, as markdown and as CSV.

use std::fmt::Write as _;

use super::case::FAMILIES;
use super::projection::BINS;
use super::seen::{Record, Seen, quantile};
use super::solvers::METHODS;

/// Decades of κ from this one on share a row.
pub const LAST: usize = 16;

/// The row of a decade.
pub fn row(decade: usize) -> usize {
    decade.min(LAST)
}

/// Median, nine in ten and worst.
fn spread(of: &[&Record], value: impl Fn(&Record) -> f64) -> [f64; 3] {
    let mut all: Vec<f64> = of.iter().map(|record| value(record)).collect();
    [0.5, 0.9, 1.0].map(|part| quantile(&mut all, part))
}

fn number(x: f64) -> String {
    match x {
        x if x.is_nan() => String::new(),
        x if x.is_infinite() => "∞".into(),
        x if x < 1e4 => format!("{x:.1}"),
        x => format!("{x:.0e}"),
    }
}

fn precision(single: bool) -> &'static str {
    if single { "f32" } else { "f64" }
}

/// A group's line: solves; those whose error is above rounding, of these without a lower bound, upper/lower (infinite
/// without a lower bound), upper/true, true/lower; the median of what is known of upper/lower.
fn line(of: &[&Record]) -> String {
    let above: Vec<&Record> = of.iter().copied().filter(|r| r.above).collect();
    let none = above.iter().filter(|r| r.lower == 0.0).count();
    let [median, most, worst] = spread(&above, Record::ratio).map(number);
    let over = number(spread(&above, |r| r.upper / r.energy)[0]);
    let under = number(spread(&above, |r| r.energy / r.lower)[0]);
    let known = number(spread(&above, |r| r.known)[0]);
    format!(
        "{} | {} | {none} | {median} | {most} | {worst} | {over} | {under} | {known} |",
        of.len(),
        above.len()
    )
}

const COLUMNS: &str = "solves | error above rounding | lower = 0 | upper/lower: median | 90 % | worst | upper/true: median | \
                       true/lower: median | 2T: median |\n";
const RULE: &str = "| --- | --- | --: | --: | --: | --: | --: | --: | --: | --: | --: | --: |\n";

/// Everything.
pub fn markdown(seen: &Seen) -> String {
    let mut text = String::new();
    let out = &mut text;
    let violations = seen.solves.iter().filter(|r| r.violated).count();
    let loose = seen.solves.iter().filter(|r| r.loose).count();
    let clear = seen.solves.iter().filter(|r| r.clear).count();
    _ = writeln!(
        out,
        "{} systems, {} solves. The true error outside [lower, upper]: **{violations}**. Farther apart than is known beforehand, \
         of {clear} solves clear of rounding: **{loose}**. A ⪰ diag(μ) > 0: checked on {} systems, never wrong. {} solves judged \
         in 125 digits too: the energy differs by {:.0e} of itself at most.\n",
        seen.count(),
        seen.solves.len(),
        seen.mu_checked,
        seen.compared,
        seen.difference,
    );
    _ = write!(out, "| κ(A) | | systems | {COLUMNS}{RULE}");
    for single in [false, true] {
        for decade in 0..=LAST {
            let systems = seen.systems.iter().filter(|((_, s, d), _)| *s == single && row(*d) == decade);
            let systems: usize = systems.map(|(_, n)| n).sum();
            let of: Vec<&Record> =
                seen.solves.iter().filter(|r| r.single == single && row(r.decade) == decade).collect();
            if of.is_empty() {
                continue;
            }
            let to = if decade == LAST { "up".into() } else { format!("1e{}", decade + 1) };
            _ = writeln!(out, "| 1e{decade} … {to} | {} | {systems} | {}", precision(single), line(&of));
        }
    }
    _ = write!(out, "\n| solver | | in lanes / fallback | {COLUMNS}{RULE}");
    for method in METHODS {
        for single in [false, true] {
            let of: Vec<&Record> =
                seen.solves.iter().filter(|r| r.single == single && r.method == method).collect();
            let fallback = of.iter().filter(|r| r.fallback).count();
            let in_lanes = of.iter().filter(|r| r.in_lanes).count();
            _ = writeln!(
                out,
                "| {} | {} | {in_lanes} / {fallback} | {}",
                method.name(),
                precision(single),
                line(&of)
            );
        }
    }
    families(out, seen);
    projection(out, seen);
    text
}

fn families(out: &mut String, seen: &Seen) {
    _ = write!(out, "\n| systems | f64 | f32 |\n| --- | --: | --: |\n");
    for family in FAMILIES {
        let [double, single] = [false, true].map(|single| {
            let of = seen.systems.iter().filter(|((f, s, _), _)| (*f, *s) == (family, single));
            of.map(|(_, n)| n).sum::<usize>()
        });
        _ = writeln!(out, "| {family:?} | {double} | {single} |");
    }
    _ = write!(out, "\n| an error in place of an answer | | how often |\n| --- | --- | --: |\n");
    for ((single, name), n) in &seen.refused {
        _ = writeln!(out, "| {name} | {} | {n} |", precision(*single));
    }
}

fn projection(out: &mut String, seen: &Seen) {
    out.push_str(
        "\n| ξ at most | raw systems | positive definite | certified at every node | accepted of these | certified and not \
         positive definite |\n| --- | --: | --: | --: | --: | --: |\n",
    );
    for (end, bin) in BINS.iter().zip(&seen.projection) {
        let end = if end.is_infinite() { "∞".into() } else { format!("{end}") };
        let part = 100.0 * (bin.certified - bin.wrong) as f64 / bin.positive.max(1) as f64;
        _ = writeln!(
            out,
            "| {end} | {} | {} | {} | {part:.1} % | {} |",
            bin.systems, bin.positive, bin.certified, bin.wrong
        );
    }
}

/// A row per decade and precision.
pub fn csv(seen: &Seen) -> String {
    let mut text = String::from(
        "precision,decade,solves,above_rounding,no_lower,median,ninety,worst,upper_to_true,true_to_lower,known\n",
    );
    for single in [false, true] {
        for decade in 0..=LAST {
            let of = |r: &&Record| r.single == single && row(r.decade) == decade;
            let of: Vec<&Record> = seen.solves.iter().filter(of).collect();
            let above: Vec<&Record> = of.iter().copied().filter(|r| r.above).collect();
            let none = above.iter().filter(|r| r.lower == 0.0).count();
            let [median, most, worst] = spread(&above, Record::ratio);
            let over = spread(&above, |r| r.upper / r.energy)[0];
            let under = spread(&above, |r| r.energy / r.lower)[0];
            let known = spread(&above, |r| r.known)[0];
            _ = writeln!(
                text,
                "{},{decade},{},{},{none},{median:e},{most:e},{worst:e},{over:e},{under:e},{known:e}",
                precision(single),
                of.len(),
                above.len(),
            );
        }
    }
    text
}
