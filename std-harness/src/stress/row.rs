//! Trials put together for people: a row for each case and method, with both precisions and all solvers in it.

use super::trial::{Ended, Trial};
use super::worst::Worst;

/// A row.
pub struct Row {
    /// The case.
    pub case: &'static str,
    /// The method.
    pub method: &'static str,
    /// What came out in f64 and in f32; empty where that was not tried.
    pub outcome: [String; 2],
    /// The fewest steps made in each of them; none where that was not tried.
    pub steps: [Option<u64>; 2],
    /// How many trials it is made of.
    pub trials: usize,
    /// How many of them finished, ended with an error, were refused.
    pub count: [usize; 3],
    /// Solves that ended before they met their tolerance.
    pub unmet: u64,
    /// The worst of all.
    pub worst: Worst,
    /// What does not hold, and where.
    pub broken: Vec<String>,
}

const PRECISIONS: [&str; 2] = ["f64", "f32"];

/// Rows of trials, which are in the order of cases and methods.
pub fn rows(trials: &[Trial]) -> Vec<Row> {
    let same = |a: &Trial, b: &Trial| (a.case, a.method) == (b.case, b.method);
    trials.chunk_by(same).map(row).collect()
}

fn row(trials: &[Trial]) -> Row {
    let (case, method) = trials.first().map_or(("", ""), |trial| (trial.case, trial.method));
    let of = |precision: &'static str| trials.iter().filter(move |trial| trial.precision == precision);
    let ended = |like: fn(&Ended) -> bool| trials.iter().filter(|trial| like(&trial.ended)).count();
    let broken = |trial: &Trial| {
        let solver = trial.solver.as_deref().unwrap_or("no solver");
        let place = format!("{} by {} in {}, {solver}", trial.case, trial.method, trial.precision);
        trial.broken.iter().map(|what| format!("{place}: {what}")).collect::<Vec<_>>()
    };
    Row {
        case,
        method,
        outcome: PRECISIONS.map(|precision| outcome(&of(precision).collect::<Vec<_>>())),
        steps: PRECISIONS.map(|precision| of(precision).map(|trial| trial.steps).min()),
        trials: trials.len(),
        count: [
            ended(|e| matches!(e, Ended::Finished)),
            ended(|e| matches!(e, Ended::Failed { .. })),
            ended(|e| matches!(e, Ended::Refused(_))),
        ],
        unmet: trials.iter().map(|trial| trial.unmet).sum(),
        worst: trials.iter().map(|trial| trial.worst).fold(Worst::default(), Worst::with),
        broken: trials.iter().flat_map(broken).collect(),
    }
}

/// What came out, once if all solvers agree.
fn outcome(trials: &[&Trial]) -> String {
    let told: Vec<(String, &str)> =
        trials.iter().map(|trial| (said(trial), trial.solver.as_deref().unwrap_or_default())).collect();
    let Some((first, _)) = told.first() else { return String::new() };
    if told.iter().all(|(said, _)| said == first) {
        return first.clone();
    }
    let mut parts: Vec<(&str, Vec<&str>)> = Vec::new();
    for (said, solver) in &told {
        match parts.iter_mut().find(|(known, _)| known == said) {
            Some((_, solvers)) => solvers.push(solver),
            None => parts.push((said, vec![solver])),
        }
    }
    let part = |(said, solvers): (&str, Vec<&str>)| format!("{}: {said}", solvers.join(", "));
    parts.into_iter().map(part).collect::<Vec<_>>().join("; ")
}

fn said(trial: &Trial) -> String {
    let limit =
        trial.limit.map_or(String::new(), |limit| format!("refused, its limit is {limit:.1e} s; below: "));
    let end = match &trial.ended {
        _ if !trial.broken.is_empty() => "**broken**".into(),
        Ended::Finished => "finished".into(),
        Ended::Failed { error, step } => format!("{error} at step {step}"),
        Ended::Refused(why) => format!("refused: {why}"),
    };
    limit + &end
}
