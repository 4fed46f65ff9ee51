//! A line of the comparison, and how it compares with the best peer.
//!
//! Solvers are compared at equal accuracy of the answer, not at equal relative residual, which promises different things
//! to each of them. The rule: a direct peer always counts; a peer that iterates counts, at the same tolerance, if its
//! median error is at most 3 times the line's own. `ratio` = time of the fastest peer that counts / own time: above 1,
//! the line is faster than anything a user would otherwise pick. (A peer counts for itself, so that its ratio is at most 1.)

use serde::Serialize;

/// How much less exact than a line an iterative peer may be to count.
const AS_EXACT: f64 = 3.0;

/// A method on a scene: medians (and worst values) over the states.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Row {
    pub(crate) scene: String,
    pub(crate) dt: f64,
    /// R. None for a direct peer until `rate`; after it, such a peer has a line per tolerance.
    pub(crate) tolerance: Option<f64>,
    pub(crate) method: String,
    pub(crate) peer: bool,
    /// Solves exactly, whatever the tolerance.
    pub(crate) direct: bool,
    pub(crate) ms: f64,
    pub(crate) ms_worst: f64,
    pub(crate) iterations: f64,
    pub(crate) iterations_worst: f64,
    #[serde(rename = "bound_J")]
    pub(crate) bound: f64,
    #[serde(rename = "bound_J_worst")]
    pub(crate) bound_worst: f64,
    /// What the kernel itself reports, J.
    #[serde(rename = "reported_upper_J")]
    pub(crate) reported_upper: Option<f64>,
    #[serde(rename = "reported_lower_J")]
    pub(crate) reported_lower: Option<f64>,
    #[serde(rename = "error_rel")]
    pub(crate) error: f64,
    #[serde(rename = "error_rel_worst")]
    pub(crate) error_worst: f64,
    #[serde(rename = "workspace_bytes")]
    pub(crate) bytes: usize,
    pub(crate) states: usize,
    /// Too slow for more than its first answer, at state 0.
    pub(crate) once: bool,
    /// States whose solve used up its iterations or stalled.
    pub(crate) unfinished: usize,
    pub(crate) best_peer: Option<String>,
    #[serde(rename = "ratio_to_best_peer")]
    pub(crate) ratio: Option<f64>,
}

/// Does `peer` give an answer at least about as exact as `row`'s?
fn counts(peer: &Row, row: &Row) -> bool {
    peer.peer && (peer.direct || (peer.tolerance == row.tolerance && peer.error <= AS_EXACT * row.error))
}

/// Fills in the ratios, and gives direct peers a line per tolerance, beside the lines they are compared with.
pub(crate) fn rate(rows: &mut Vec<Row>, tolerances: &[f64]) {
    for k in 0..rows.len() {
        let row = &rows[k];
        let best = rows.iter().filter(|peer| counts(peer, row)).min_by(|a, b| a.ms.total_cmp(&b.ms));
        let best = best.map(|peer| (peer.method.clone(), peer.ms / row.ms));
        if let Some((name, ratio)) = best {
            // What is NaN has no ratio.
            let valid = row.error.is_finite() && row.bound.is_finite();
            rows[k].ratio = Some(if valid { ratio } else { f64::NAN });
            rows[k].best_peer = Some(name);
        }
    }
    let all = std::mem::take(rows);
    for &tolerance in tolerances {
        let here = all.iter().filter(|row| row.tolerance.is_none_or(|own| own == tolerance));
        rows.extend(here.map(|row| Row { tolerance: Some(tolerance), ..row.clone() }));
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    pub(crate) fn row(method: &str, tolerance: Option<f64>, ms: f64, error: f64) -> Row {
        Row {
            scene: "s".into(),
            dt: 0.01,
            tolerance,
            method: method.into(),
            peer: !method.starts_with("hooke"),
            direct: tolerance.is_none(),
            ms,
            ms_worst: ms,
            iterations: 0.0,
            iterations_worst: 0.0,
            bound: 0.0,
            bound_worst: 0.0,
            reported_upper: None,
            reported_lower: None,
            error,
            error_worst: error,
            bytes: 0,
            states: 1,
            once: false,
            unfinished: 0,
            best_peer: None,
            ratio: None,
        }
    }

    fn ratio(cg_error: f64, hooke_error: f64) -> (Option<String>, Option<f64>) {
        let mut rows = vec![
            row("direct", None, 8.0, 1e-14),
            row("cg", Some(1e-3), 4.0, cg_error),
            row("hooke", Some(1e-3), 2.0, hooke_error),
        ];
        rate(&mut rows, &[1e-3]);
        (rows[2].best_peer.clone(), rows[2].ratio)
    }

    #[test]
    fn an_iterative_peer_counts_only_if_about_as_exact() {
        assert_eq!(ratio(2.9e-3, 1e-3), (Some("cg".into()), Some(2.0)));
        assert_eq!(ratio(3.1e-3, 1e-3), (Some("direct".into()), Some(4.0)));
        assert_eq!(ratio(f64::NAN, 1e-3), (Some("direct".into()), Some(4.0)));
    }

    #[test]
    fn an_answer_that_is_nan_has_no_ratio() {
        assert!(ratio(1e-3, f64::NAN).1.unwrap().is_nan());
    }

    #[test]
    fn a_direct_peer_stands_beside_every_tolerance() {
        let mut rows = vec![row("direct", None, 8.0, 1e-14), row("hooke", Some(1e-3), 2.0, 1e-3)];
        rate(&mut rows, &[1e-3, 1e-6]);
        let lines: Vec<_> = rows.iter().map(|row| (row.method.as_str(), row.tolerance)).collect();
        assert_eq!(lines, [("direct", Some(1e-3)), ("hooke", Some(1e-3)), ("direct", Some(1e-6))]);
    }
}
