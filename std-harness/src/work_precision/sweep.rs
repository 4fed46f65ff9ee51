//! Which runs are made: those that are asked for, or steps halved as long as that tells something.

use super::curve::{Curve, Setting, Steps};
use super::progress::Progress;
use super::reference::Reference;
use super::row::{self, Row};
use super::study::{MOST_STEPS, Study, steps_of};
use crate::run::integrator::Integrator;
use crate::run::simulation::Simulation;

/// How close to its limit an explicit method begins.
const NEAR: f64 = 0.95;
/// A curve has at least so many points before it may end for being slow.
const LEAST: usize = 4;
/// It ends there where so many times less time gives no larger error.
const SLOWER: f64 = 10.0;
/// No curve has more points than this.
const MOST: usize = 14;

/// The limit of an explicit method for this scene, s.
pub fn limit(study: &Study, method: Integrator) -> Result<f64, String> {
    // With steps that no limit refuses.
    let curve = Curve { method, steps: Steps::Fixed };
    let plan = study.plan_of(curve, Setting::Steps(MOST_STEPS as u64));
    let mut simulation = Simulation::<f64>::new(&plan).map_err(|error| error.to_string())?;
    simulation.limit().filter(|limit| *limit > 0.0).ok_or(format!("{} has no limit", method.name()))
}

/// Makes all runs. Explicit methods go first: they tell the others when they are too slow to go on.
pub fn sweep(study: &Study, reference: &Reference, progress: &Progress) -> Vec<Row> {
    let mut order: Vec<usize> = (0..study.curves.len()).collect();
    order.sort_by_key(|place| !study.curves[*place].method.is_explicit());
    let mut rows: Vec<(usize, Row)> = Vec::new();
    for place in order {
        let curve = study.curves[place];
        let mut made = 0;
        let mut next = first(study, curve, 0);
        while let Some(setting) = next.take() {
            let row = match &setting {
                Ok(setting) => {
                    progress.says(&said(study, curve, *setting));
                    row::run(study, reference, curve, *setting)
                }
                Err(why) => Row::without(curve, Setting::Steps(1), study.plan.seconds, why.clone()),
            };
            progress.counts();
            made += 1;
            let over = row.too_long || ends(study, reference, &rows, &row, made);
            next = match setting {
                Ok(Setting::Steps(steps)) if curve.steps == Steps::Fixed && study.steps.is_empty() => {
                    let next = 2 * steps;
                    (!over && made < MOST && next as f64 <= MOST_STEPS).then_some(Ok(Setting::Steps(next)))
                }
                _ if row.too_long => None,
                _ => first(study, curve, made),
            };
            rows.push((place, row));
        }
    }
    rows.sort_by_key(|(place, _)| *place);
    rows.into_iter().map(|(_, row)| row).collect()
}

/// The runs of a curve that are known beforehand: the given ones, or the first.
fn first(study: &Study, curve: Curve, made: usize) -> Option<Result<Setting, String>> {
    let seconds = study.plan.seconds;
    match curve.steps {
        Steps::Chosen => study.accuracies.get(made).map(|joules| Ok(Setting::Accuracy(*joules))),
        Steps::Cut
            if made > 0 || !limit(study, curve.method).is_ok_and(|most| most < study.plan.model.dt) =>
        {
            None
        }
        Steps::Cut => Some(Ok(Setting::Steps(steps_of(seconds, study.plan.model.dt) as u64))),
        Steps::Fixed if !study.steps.is_empty() => {
            study.steps.get(made).map(|steps| Ok(Setting::Steps(*steps)))
        }
        Steps::Fixed if made > 0 => None,
        Steps::Fixed => Some(if curve.method.is_explicit() {
            limit(study, curve.method).and_then(|limit| {
                let steps = steps_of(seconds, NEAR * limit);
                let too_many = || format!("its limit is {limit:.1e} s: {steps:.1e} steps are too many");
                if steps <= MOST_STEPS { Ok(Setting::Steps(steps as u64)) } else { Err(too_many()) }
            })
        } else {
            Ok(Setting::Steps(steps_of(seconds, study.plan.model.dt) as u64))
        }),
    }
}

/// Does a curve end here? Its error is small enough, or others are so much faster that it will not matter.
fn ends(study: &Study, reference: &Reference, rows: &[(usize, Row)], row: &Row, made: usize) -> bool {
    let Some((ms, error)) = row.point() else { return row.dropped };
    if error <= study.smallest || error <= reference.certain_from {
        return true;
    }
    let beaten = |other: &Row| other.point().is_some_and(|(t, e)| e <= error && SLOWER * t < ms);
    // A step that gives no answer at all says nothing of the next.
    made >= LEAST && error < 0.1 * study.size && rows.iter().any(|(_, other)| beaten(other))
}

fn said(study: &Study, curve: Curve, setting: Setting) -> String {
    match setting {
        Setting::Steps(steps) => format!("{}, dt {:.3e} s", curve.name(), study.plan.seconds / steps as f64),
        Setting::Accuracy(joules) => format!("{}, {joules:.0e} J", curve.name()),
    }
}
