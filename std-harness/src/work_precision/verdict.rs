//! Which method gets to an error first: for every decade of errors the time that each curve needs, interpolated between its
//! points in logarithms.

use serde::Serialize;

use super::curve::Curve;
use super::row::Row;
use super::study::Study;
use crate::run::integrator::Integrator;

/// How a curve gets to an error.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Reach {
    /// The curve.
    pub curve: String,
    /// The time that it takes, ms.
    pub ms: f64,
    /// Its step there, s.
    pub dt: f64,
    /// Might it be less? So it is where that is its coarsest run, or the run beyond is more accurate than the reference can tell.
    pub at_most: bool,
}

/// A decade of errors.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Decade {
    /// The error, m.
    #[serde(rename = "error_m")]
    pub error: f64,
    /// The curve that gets there first.
    pub best: Reach,
    /// The next one.
    pub second: Option<Reach>,
    /// The first implicit one.
    pub implicit: Option<Reach>,
    /// The first explicit one.
    pub explicit: Option<Reach>,
}

/// Judges every decade that some curve reaches, from large errors to small ones.
pub fn verdict(study: &Study, rows: &[Row], certain_from: f64) -> Vec<Decade> {
    let errors = || rows.iter().filter_map(|row| row.point()).map(|(_, error)| error.log10());
    let (low, high) = errors().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), e| (l.min(e), h.max(e)));
    if !(low <= high) {
        return Vec::new();
    }
    // As far off as a tenth of the scene is no answer; what is smaller than what is of interest was not looked for.
    let most = (0.1 * study.size).log10().floor();
    let (from, to) = (if high.floor() < most { high.floor() } else { most }, low.ceil());
    let least = (study.smallest.log10() - 1e-9).ceil();
    let to = if to < least { least } else { to };
    let (from, to) = (if from < to { to as i32 } else { from as i32 }, to as i32);
    (to..=from).rev().filter_map(|power| decade(study, rows, certain_from, 10_f64.powi(power))).collect()
}

fn decade(study: &Study, rows: &[Row], certain_from: f64, error: f64) -> Option<Decade> {
    let of = |curve: &Curve| {
        let name = curve.name();
        let own: Vec<&Row> = rows.iter().filter(|row| row.curve == name).collect();
        reach(&own, certain_from, error).map(|reach| (curve.method, reach))
    };
    let mut all: Vec<(Integrator, Reach)> = study.curves.iter().filter_map(of).collect();
    all.sort_by(|a, b| a.1.ms.total_cmp(&b.1.ms));
    let first = |wanted: &dyn Fn(Integrator) -> bool| {
        all.iter().find(|(method, _)| wanted(*method)).map(|(_, reach)| reach.clone())
    };
    Some(Decade {
        error,
        best: first(&|_| true)?,
        second: all.get(1).map(|(_, reach)| reach.clone()),
        implicit: first(&|method| !method.is_explicit() && method != Integrator::Auto),
        explicit: first(&Integrator::is_explicit),
    })
}

/// The least time of a curve, its runs from coarse to fine, for an error.
fn reach(rows: &[&Row], certain_from: f64, error: f64) -> Option<Reach> {
    let mut best: Option<Reach> = None;
    let mut offer = |curve: &str, ms: f64, dt: f64, at_most: bool| {
        if best.as_ref().is_none_or(|best| ms < best.ms) {
            best = Some(Reach { curve: curve.to_string(), ms, dt, at_most });
        }
    };
    let mut before: Option<(f64, f64, f64)> = None;
    for row in rows {
        // Of a run that is more accurate than the reference can tell, that much is known.
        let point = row.point().or(row.ms.filter(|_| row.dropped).map(|ms| (ms, certain_from)));
        let (Some((ms, found)), Some(dt)) = (point, row.dt) else {
            before = None;
            continue;
        };
        match before {
            Some((ms0, found0, dt0)) if found0 > error && found <= error => {
                let s = (found0 / error).ln() / (found0 / found).ln();
                let between = |a: f64, b: f64| a * (b / a).powf(s);
                offer(&row.curve, between(ms0, ms), between(dt0, dt), row.dropped);
            }
            _ if found <= error => offer(&row.curve, ms, dt, row.dropped || before.is_none()),
            _ => {}
        }
        before = Some((ms, found, dt));
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::work_precision::curve::{Setting, Steps};

    fn curve(points: &[(f64, f64)]) -> Vec<Row> {
        let curve = Curve { method: Integrator::Midpoint, steps: Steps::Fixed };
        let row = |(steps, (ms, error)): (u64, &(f64, f64))| {
            let row = Row::without(curve, Setting::Steps(steps), 1.0, String::new());
            Row { ms: Some(*ms), error: (*error > 0.0).then_some(*error), ..row }
        };
        (1..).zip(points).map(row).collect()
    }

    fn reached(points: &[(f64, f64)], error: f64) -> Option<(f64, bool)> {
        let rows = curve(points);
        reach(&rows.iter().collect::<Vec<_>>(), 0.0, error).map(|reach| (reach.ms, reach.at_most))
    }

    #[test]
    fn between_two_runs_time_and_error_are_powers_of_each_other() {
        let points = [(1.0, 1e-2), (10.0, 1e-4)];
        let (ms, at_most) = reached(&points, 1e-3).unwrap();
        assert!((ms - 10_f64.sqrt()).abs() < 1e-12 && !at_most);
        assert_eq!(reached(&points, 1e-5), None);
    }

    #[test]
    fn the_coarsest_run_is_only_a_bound() {
        assert_eq!(reached(&[(1.0, 1e-2), (10.0, 1e-4)], 0.1), Some((1.0, true)));
    }

    #[test]
    fn nothing_is_interpolated_over_a_run_without_an_end() {
        assert_eq!(reached(&[(1.0, 1e-1), (2.0, 0.0), (4.0, 1e-3)], 1e-2), Some((4.0, true)));
    }

    #[test]
    fn an_error_that_grows_again_does_not_hide_that_it_was_small() {
        assert_eq!(reached(&[(1.0, 1e-3), (2.0, 1e-1), (4.0, 1e-3)], 1e-3), Some((1.0, true)));
    }
}
