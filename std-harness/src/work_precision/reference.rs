//! The reference that certifies itself: the final positions by one method with n, 2n, 4n, … steps, two by two extrapolated.
//!
//! Of a method of order p the errors of h and h/2 are as 2ᵖ to 1 but for smaller terms, so that
//!
//! x = x(h/2) + (x(h/2) − x(h)) / (2ᵖ − 1)
//!
//! is better than both (Richardson). As certain as a reference is taken what its last two x differ by, over all particles; the steps
//! are halved until that is a hundredth of the smallest error that will be seen, until it shrinks no more, or until the effort is
//! spent. Verlet has the first half of it: where steps have to be small anyway nothing is cheaper. Where that does not do,
//! `ros3` has the rest, and the one that got further is taken.
//!
//! That tells how far a method is from its own limit, not that it solves the right equations: for that the other methods'
//! curves go down towards the same reference.
//!
//! Source: Hairer, Nørsett & Wanner, *Solving Ordinary Differential Equations I*, II.9.

use serde::Serialize;

use super::curve::{Curve, Setting, Steps};
use super::measure::{Done, Stopped, simulate};
use super::progress::Progress;
use super::study::{Study, steps_of};
use super::sweep::limit;
use crate::run::integrator::Integrator;

/// Shown are errors so many times as large as what is uncertain.
pub const DIGITS: f64 = 100.0;
/// Where a halving goes past the smallest error of interest, it goes past it by this at most, if the order is at most 4.
const PAST: f64 = 16.0;
/// Relative tolerance of the solves.
const TOLERANCE: f64 = 1e-12;

/// Positions that are farther apart than so many sizes of the scene do not agree.
const NEAR: f64 = 1e-2;

/// The reference.
#[derive(Debug, Clone, Serialize)]
pub struct Reference {
    /// The method.
    pub method: &'static str,
    /// The numbers of steps that the positions are extrapolated from.
    pub steps: [u64; 2],
    /// How far these positions are from those with twice the steps' lengths, m.
    #[serde(rename = "agreement_m")]
    pub agreement: f64,
    /// Errors below this are not shown, m.
    #[serde(rename = "certain_from_m")]
    pub certain_from: f64,
    /// Is it as certain as the smallest error of interest asks for?
    pub met: bool,
    /// What energy drifts are measured in: the most that motion and springs hold at the start or the end, J.
    #[serde(rename = "energy_scale_J")]
    pub energy: f64,
    /// Where the particles are at the end, m.
    #[serde(skip)]
    pub positions: Vec<[f64; 3]>,
}

/// The largest distance of two particles of the same id, and which it is.
pub fn farthest(a: &[[f64; 3]], b: &[[f64; 3]]) -> (usize, f64) {
    let distance = |(x, y): (&[f64; 3], &[f64; 3])| (0..3).map(|c| (x[c] - y[c]).powi(2)).sum::<f64>().sqrt();
    let all = a.iter().zip(b).map(distance).enumerate();
    // A NaN is as far as can be.
    all.fold((0, 0.0), |most, (i, d)| if !(d <= most.1) { (i, d) } else { most })
}

/// Finds the reference; `Err` says why there is none.
pub fn find(study: &Study, progress: &Progress) -> Result<Reference, String> {
    let (half, mut spent) = (0.5 * study.effort, 0.0);
    let verlet = ladder(study, Integrator::Verlet, half, &mut spent, progress);
    if let Ok(found) = &verlet
        && found.met
    {
        return verlet;
    }
    let ros3 = ladder(study, Integrator::Ros3, study.effort - spent, &mut spent, progress);
    match (verlet, ros3) {
        (Ok(a), Ok(b)) => Ok(if a.agreement < b.agreement { a } else { b }),
        (Ok(found), _) | (_, Ok(found)) => Ok(found),
        (Err(a), Err(b)) => Err(format!("no reference within --effort {:?}: {a}; {b}", study.effort)),
    }
}

/// Halves the steps of one method as long as that helps.
fn ladder(
    study: &Study,
    method: Integrator,
    effort: f64,
    spent: &mut f64,
    progress: &Progress,
) -> Result<Reference, String> {
    let (name, curve) = (method.name(), Curve { method, steps: Steps::Fixed });
    let (weight, longest) = match method {
        Integrator::Verlet => (3.0, 0.5 * limit(study, method).map_err(|why| format!("{name}: {why}"))?),
        _ => (7.0, study.plan.model.dt),
    };
    let wanted = study.smallest / (PAST * DIGITS);
    let mut steps = steps_of(study.plan.seconds, longest).max(8.0);
    let (mut levels, mut better) = (Vec::<Vec<[f64; 3]>>::new(), Vec::<Vec<[f64; 3]>>::new());
    let (mut best, mut left, mut last, mut vain): (Option<Reference>, _, _, _) = (None, effort, 0.0, 0);
    let mut why = "the steps would be too many".to_string();
    while steps <= super::study::MOST_STEPS && 2.0 * last <= left {
        progress.says(&format!("reference, {name}, {steps} steps"));
        let mut plan = study.plan_of(curve, Setting::Steps(steps as u64));
        plan.tolerance = Some(TOLERANCE);
        let done = match simulate(&plan, left) {
            Ok(done) => done,
            Err(Stopped::TooLong(seconds)) => {
                why = format!("{steps} steps would take about {seconds:.0} s");
                break;
            }
            // What a coarse step cannot, a finer one may.
            Err(Stopped::Failed(reason)) => {
                (why, levels, better) = (reason, Vec::new(), Vec::new());
                vain += 1;
                if vain > 4 {
                    break;
                }
                steps *= 2.0;
                continue;
            }
        };
        last = done.cpu.as_secs_f64();
        (left, *spent) = (left - last, *spent + last);
        levels.push(done.simulation.positions().to_vec());
        if let [.., coarse, fine] = &levels[..] {
            better.push(extrapolated(coarse, fine, weight));
        }
        why = format!("{steps} steps are too few");
        if let ([.., a, b], [.., x, y, z]) = (&better[..], &levels[..]) {
            let (agreement, contracts) = (farthest(a, b).1, farthest(y, z).1 < 0.5 * farthest(x, y).1);
            // What by chance agrees before it converges is no reference; nor do rounding errors converge.
            // Two runs that have both left the scene agree about nothing.
            let close = agreement < NEAR * study.size;
            if close
                && (contracts || best.is_some())
                && best.as_ref().is_none_or(|best| agreement < best.agreement)
            {
                vain = 0;
                best = Some(Reference {
                    method: name,
                    steps: [steps as u64 / 2, steps as u64],
                    agreement,
                    certain_from: DIGITS * agreement,
                    met: agreement <= wanted,
                    energy: energy(study, &done),
                    positions: b.clone(),
                });
            } else if best.is_some() {
                vain += 1;
            }
            if best.as_ref().is_some_and(|best| best.met) || vain > 1 {
                break;
            }
        }
        steps *= 2.0;
    }
    best.ok_or(format!("{name}: {why}"))
}

fn extrapolated(coarse: &[[f64; 3]], fine: &[[f64; 3]], weight: f64) -> Vec<[f64; 3]> {
    let at = |(x, y): (&[f64; 3], &[f64; 3])| std::array::from_fn(|c| y[c] + (y[c] - x[c]) / weight);
    coarse.iter().zip(fine).map(at).collect()
}

fn energy(study: &Study, done: &Done) -> f64 {
    let (start, end) = (done.energy, done.simulation.energy(study.plan.seconds));
    let moving = |e: &crate::output::Energy| e.kinetic + e.springs;
    if moving(&start) > moving(&end) { moving(&start) } else { moving(&end) }
}
