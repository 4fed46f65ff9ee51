//! All contenders on one scene: the same states, turn by turn, so that what disturbs the machine disturbs all of them.
//!
//! Per state and contender the median over repeats (three at least, more while they are cheap; one where a single solve
//! takes seconds); over the states the median and the worst.

use hooke::Force;
use indicatif::ProgressBar;

use crate::contender::{Answer, Contender};
use crate::judge::{Judge, Quality};
use crate::median::{median, worst};
use crate::methods::methods;
use crate::pattern::{Part, Pattern};
use crate::peers::PEERS;
use crate::row::{self, Row};
use crate::scenario::Scenario;

/// Repeats go on until a contender has used this much time at a state, s ...
const BUDGET: f64 = 0.25;
/// ... but not beyond so many.
const MOST_REPEATS: usize = 15;

/// What one contender did at one state.
struct Sample {
    seconds: f64,
    answer: Answer,
    quality: Quality,
}

/// The rows of a scene, and which peers were skipped and why.
pub(crate) struct Measured {
    pub(crate) rows: Vec<Row>,
    pub(crate) skipped: Vec<String>,
}

/// Is one more repeat worth its time?
fn again(times: &[f64]) -> bool {
    let spent: f64 = times.iter().sum();
    times.is_empty()
        || (times.len() < 3 && spent < 8.0 * BUDGET)
        || (times.len() < MOST_REPEATS && spent < BUDGET)
}

/// Measures every contender at every state of a scene.
pub(crate) fn measure<F: Force<f64> + Clone>(
    scenario: &mut Scenario<F>,
    tolerances: &[f64],
    progress: &ProgressBar,
) -> Result<Measured, String> {
    let euler = scenario.euler.clone();
    scenario.put(0);
    let patterns = [Pattern::new(scenario, Part::Lower), Pattern::new(scenario, Part::Full)];
    let mut judge = Judge::new(scenario)?;
    let mut skipped = Vec::new();
    let mut contenders = Vec::new();
    for entry in &PEERS {
        let pattern = &patterns[usize::from(entry.part == Part::Full)];
        let own: &[f64] = if entry.iterates { tolerances } else { &[0.0] };
        for &tolerance in own {
            progress.set_message(format!("{}: {} gets ready", scenario.name, entry.name));
            match Contender::peer(entry, pattern, tolerance, scenario) {
                Ok(contender) => contenders.push(contender),
                Err(why) => {
                    skipped.push(format!("{}: {} skipped: {why}", scenario.name, entry.name));
                    break;
                }
            }
        }
    }
    for method in methods::<F>() {
        contenders.extend(tolerances.iter().map(|r| Contender::hooke(&method, &euler, *r, scenario)));
    }

    let mut samples: Vec<Vec<Sample>> = contenders.iter().map(|_| Vec::new()).collect();
    for k in 0..scenario.states() {
        scenario.put(k);
        judge.learn(scenario)?;
        let mut times = vec![Vec::new(); contenders.len()];
        let mut last: Vec<Option<Answer>> = contenders.iter().map(|_| None).collect();
        while times.iter().any(|times| again(times)) {
            for (c, contender) in contenders.iter_mut().enumerate() {
                if !again(&times[c]) {
                    continue;
                }
                let (name, of) = (&scenario.name, scenario.states());
                progress.set_message(format!("{name}: state {}/{of}, {}", k + 1, contender.name));
                progress.tick();
                scenario.put(k);
                let answer = contender
                    .run(scenario, k)
                    .map_err(|why| format!("{}: {}: {why}", scenario.name, contender.name))?;
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
    let mut rows: Vec<Row> = contenders.iter().zip(&samples).map(|(c, s)| sum_up(scenario, c, s)).collect();
    row::rate(&mut rows, tolerances);
    Ok(Measured { rows, skipped })
}

/// Medians and worst values over the states.
fn sum_up<F: Force<f64> + Clone>(
    scenario: &Scenario<F>,
    contender: &Contender<'_>,
    samples: &[Sample],
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
        bound: median(over(|s| s.quality.bound)),
        bound_worst: worst(over(|s| s.quality.bound)),
        reported_upper: if contender.is_peer { None } else { Some(upper) },
        reported_lower: if contender.is_peer { None } else { Some(lower) },
        error: median(over(|s| s.quality.error)),
        error_worst: worst(over(|s| s.quality.error)),
        bytes: contender.bytes,
        states: samples.len(),
        unfinished: samples.iter().filter(|s| s.answer.unfinished).count(),
        best_peer: None,
        ratio: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    #[test]
    fn every_contender_answers_and_direct_peers_agree_with_the_reference() {
        let mut scenario = testing::moving("cloth:5");
        let measured = measure(&mut scenario, &[1e-3, 1e-8], &ProgressBar::hidden()).unwrap();
        let hooke = methods::<testing::Forces>().len();
        // faer, nalgebra-sparse and sprs-ldl need nothing that could be missing.
        assert!(measured.rows.len() >= 3 * 2 + hooke * 2);
        for row in measured.rows {
            assert!(row.ms > 0.0 && row.bound >= 0.0 && row.bytes > 0, "{row:?}");
            if row.tolerance.is_none_or(|r| r < 1e-7) {
                assert!(row.error < 1e-6, "{row:?}");
            }
        }
    }
}
