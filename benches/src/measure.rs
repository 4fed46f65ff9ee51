//! All contenders on one scene: the same states, turn by turn, so that what disturbs the machine disturbs all of them.
//!
//! In a simulation a step follows a step of the same solver. So in its turn a contender solves twice, and the second is timed: the
//! first brings what it works on back into the caches, from which the others have driven it. (Without it a chain's step of 36 µs
//! took 43 to 69, by who came before.) Not where a solve is so long that it does not matter ([`LONG`]).
//!
//! Per state and contender the median over repeats (three at least, more while they are cheap; one where a single solve
//! takes seconds); over the states the median and the worst. Whoever needed more than `patience` to get ready at state 0
//! is not asked again: that one answer is its line.

use hooke::Force;
use hooke_harness::run::solver::Method;
use indicatif::ProgressBar;

use crate::contender::{Answer, Contender};
use crate::judge::{Judge, Quality};
use crate::median::{median, worst};
use crate::methods;
use crate::pattern::{Part, Pattern};
use crate::peers::PEERS;
use crate::row::{self, Row};
use crate::scenario::Scenario;

/// Repeats go on until a contender has used this much time at a state, s ...
const BUDGET: f64 = 0.1;
/// ... but not beyond so many; ...
const MOST_REPEATS: usize = 15;
/// ... three there are, unless they would take longer than this, s.
const DEAR: f64 = 2.0;
/// A solve that takes longer than this is timed without another before it, s.
const LONG: f64 = 0.05;

/// Who is measured, and how long anybody is waited for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Request<'a> {
    pub(crate) methods: &'a [Method],
    pub(crate) tolerances: &'a [f64],
    /// Seconds of a first solve beyond which there is no second.
    pub(crate) patience: f64,
}

/// What one contender did at one state.
struct Sample {
    seconds: f64,
    answer: Answer,
    quality: Quality,
}

/// The rows of a scene, and which methods were skipped and why.
pub(crate) struct Measured {
    pub(crate) rows: Vec<Row>,
    pub(crate) skipped: Vec<String>,
}

/// Is one more repeat worth its time?
fn again(times: &[f64]) -> bool {
    let spent: f64 = times.iter().sum();
    times.is_empty() || (times.len() < 3 && spent < DEAR) || (times.len() < MOST_REPEATS && spent < BUDGET)
}

/// Everybody who can be made ready, the peers first.
fn contenders<'a, F: Force<f64> + Clone>(
    scenario: &mut Scenario<F>,
    patterns: &'a [Pattern; 2],
    request: &Request<'_>,
    progress: &ProgressBar,
) -> (Vec<Contender<'a, F>>, Vec<String>) {
    let (mut ready, mut skipped) = (Vec::new(), Vec::new());
    let mut take = |name: &str, tolerances: &[f64], make: &mut dyn FnMut(f64) -> Result<_, String>| {
        for &tolerance in tolerances {
            progress.set_message(format!("{name} gets ready"));
            match make(tolerance) {
                Ok(contender) => ready.push(contender),
                Err(why) => {
                    skipped.push(format!("{name} skipped: {why}"));
                    break;
                }
            }
        }
    };
    let scene = scenario.name.clone();
    for entry in &PEERS {
        let pattern = &patterns[usize::from(entry.part == Part::Full)];
        let own: &[f64] = if entry.iterates { request.tolerances } else { &[0.0] };
        take(&format!("{scene}: {}", entry.name), own, &mut |r| Contender::peer(entry, pattern, r, scenario));
    }
    for &method in request.methods {
        let name = format!("{scene}: {}", methods::name(method));
        take(&name, request.tolerances, &mut |r| Contender::hooke(method, r, scenario));
    }
    (ready, skipped)
}

/// Measures every contender at every state of a scene.
pub(crate) fn measure<F: Force<f64> + Clone>(
    scenario: &mut Scenario<F>,
    request: &Request<'_>,
    progress: &ProgressBar,
) -> Result<Measured, String> {
    scenario.put(0);
    let patterns = [Pattern::new(scenario, Part::Lower), Pattern::new(scenario, Part::Full)];
    let mut judge = Judge::new(scenario)?;
    let (mut contenders, skipped) = contenders(scenario, &patterns, request, progress);
    let slow = |contender: &Contender<'_, F>| {
        contender.first.as_ref().is_some_and(|first| first.seconds > request.patience)
    };
    let slow: Vec<bool> = contenders.iter().map(slow).collect();

    let mut samples: Vec<Vec<Sample>> = contenders.iter().map(|_| Vec::new()).collect();
    for k in 0..scenario.states() {
        scenario.put(k);
        judge.learn(scenario)?;
        let mut times = vec![Vec::new(); contenders.len()];
        let mut last: Vec<Option<Answer>> = contenders.iter().map(|_| None).collect();
        for (c, contender) in contenders.iter_mut().enumerate().filter(|(c, _)| slow[*c] && k == 0) {
            last[c] = contender.first.take();
            times[c].extend(last[c].as_ref().map(|first| first.seconds));
        }
        while times.iter().zip(&slow).any(|(times, slow)| !slow && again(times)) {
            for (c, contender) in contenders.iter_mut().enumerate() {
                if slow[c] || !again(&times[c]) {
                    continue;
                }
                let (name, of) = (&scenario.name, scenario.states());
                progress.set_message(format!("{name}: state {}/{of}, {}", k + 1, contender.name));
                progress.tick();
                let mut run = || {
                    scenario.put(k);
                    contender
                        .run(scenario, k)
                        .map_err(|why| format!("{}: {}: {why}", scenario.name, contender.name))
                };
                let mut answer = run()?;
                if answer.seconds < LONG {
                    answer = run()?;
                }
                times[c].push(answer.seconds);
                last[c] = Some(answer);
            }
        }
        scenario.put(k);
        for ((samples, times), answer) in samples.iter_mut().zip(times).zip(last) {
            let Some(answer) = answer else { continue };
            let quality = judge.judge(scenario, &answer.x);
            samples.push(Sample { seconds: median(times), answer, quality });
        }
    }
    let rows = contenders.iter().zip(&samples).zip(&slow);
    let mut rows: Vec<Row> = rows.map(|((c, s), slow)| sum_up(scenario, c, s, *slow)).collect();
    row::rate(&mut rows, request.tolerances);
    Ok(Measured { rows, skipped })
}

/// Medians and worst values over the states.
fn sum_up<F: Force<f64> + Clone>(
    scenario: &Scenario<F>,
    contender: &Contender<'_, F>,
    samples: &[Sample],
    once: bool,
) -> Row {
    let over = |value: fn(&Sample) -> f64| samples.iter().map(value);
    let ms = |s: &Sample| 1e3 * s.seconds;
    let reported = samples.iter().filter_map(|s| s.answer.reported);
    let [upper, lower] = [0, 1].map(|which| median(reported.clone().map(|bounds| bounds[which])));
    Row {
        scene: scenario.name.clone(),
        dt: scenario.euler.dt(),
        tolerance: contender.tolerance,
        method: contender.name.into(),
        peer: contender.is_peer,
        direct: contender.tolerance.is_none(),
        ms: median(over(ms)),
        ms_worst: worst(over(ms)),
        iterations: median(over(|s| f64::from(s.answer.iterations))),
        iterations_worst: worst(over(|s| f64::from(s.answer.iterations))),
        bound: median(over(|s| s.quality.bound)),
        bound_worst: worst(over(|s| s.quality.bound)),
        reported_upper: if contender.is_peer { None } else { Some(upper) },
        reported_lower: if contender.is_peer { None } else { Some(lower) },
        error: median(over(|s| s.quality.error)),
        error_worst: worst(over(|s| s.quality.error)),
        bytes: contender.bytes,
        states: samples.len(),
        once,
        unfinished: samples.iter().filter(|s| s.answer.unfinished).count(),
        best_peer: None,
        ratio: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    fn measured(states: usize, patience: f64) -> Measured {
        let mut scenario = testing::in_states("cloth:5", states);
        let methods = methods::all();
        let request = Request { methods: &methods, tolerances: &[1e-3, 1e-8], patience };
        measure(&mut scenario, &request, &ProgressBar::hidden()).unwrap()
    }

    #[test]
    fn every_contender_answers_and_direct_peers_agree_with_the_reference() {
        let measured = measured(1, f64::INFINITY);
        // faer, nalgebra-sparse and sprs-ldl need nothing that could be missing.
        assert!(measured.rows.len() >= 3 * 2 + methods::all().len() * 2);
        for row in measured.rows {
            assert!(row.ms > 0.0 && row.bound >= 0.0 && row.bytes > 0 && !row.once, "{row:?}");
            if row.tolerance.is_none_or(|r| r < 1e-7) {
                assert!(row.error < 1e-6, "{row:?}");
            }
        }
    }

    #[test]
    fn whoever_is_too_slow_to_get_ready_is_judged_by_that_one_answer() {
        for (patience, states, once) in [(0.0, 1, true), (f64::INFINITY, 2, false)] {
            for row in measured(2, patience).rows {
                assert_eq!((row.states, row.once), (states, once), "{row:?}");
                assert!(row.ms > 0.0 && row.error.is_finite(), "{row:?}");
            }
        }
    }
}
