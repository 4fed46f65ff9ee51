//! One system, solved by every solver, and each answer judged: ½‖e‖²_A = ½ rᵀA⁻¹r in 62 digits against [lower, upper].
//!
//! 62 digits are enough where κ·2⁻²⁰⁸ is far below u; every fiftieth system is judged once more in 125 digits, and the
//! largest relative difference is kept.

use std::collections::BTreeSet;

use hooke::{IslandReport, Real};

use super::case::{Case, Cut};
use super::condition::condition;
use super::projection;
use super::rounding::{Limits, SLACK, Standing};
use super::seen::{Record, Seen};
use super::solvers::{METHODS, Method, Solved};
use super::stored::{Stored, islands};
use crate::precise::{BITS, Big, Factor, big, small};
use crate::random::Random;

/// What upper/lower cannot exceed clear of rounding; `None` where nothing is known beforehand.
fn known_ratio(method: Method, fallback: bool, limits: &Limits) -> Option<f64> {
    match method {
        _ if method.is_direct() && !fallback => Some(SLACK * limits.ratio),
        Method::Jacobi | Method::Lanes => Some(2.0 * SLACK * limits.ratio),
        _ if method.is_direct() => Some(2.0 * SLACK * limits.ratio),
        _ => None,
    }
}

/// A system with what its judge needs.
struct Judge<'s, T> {
    stored: &'s Stored<T>,
    matrix: Vec<Vec<Big>>,
    factor: Factor,
    limits: Limits,
    decade: usize,
    bits: usize,
}

impl<'s, T: Real> Judge<'s, T> {
    /// `None` if A is not positive definite.
    fn new(stored: &'s Stored<T>, bits: usize) -> Option<Self> {
        let matrix = stored.matrix(bits);
        let factor = Factor::new(&matrix)?;
        let decade = condition(&matrix, &factor).log10().max(0.0) as usize;
        Some(Self { stored, matrix, factor, limits: Limits::new(stored), decade, bits })
    }

    fn residual(&self, velocity: &[[f64; 3]]) -> (Vec<f64>, Vec<Big>) {
        let x: Vec<f64> = self.stored.particles.iter().flat_map(|i| velocity[*i]).collect();
        let r = self.stored.residual(&self.matrix, &x, self.bits);
        (x, r)
    }

    fn energy(&self, r: &[Big]) -> Big {
        big(0.5) * self.factor.inverse_form(r)
    }

    fn record(&self, method: Method, report: &IslandReport<T>, solved: &Solved<T>) -> Record {
        let (x, r) = self.residual(&solved.velocity);
        let energy = self.energy(&r);
        let (lower, upper) = (report.solve.lower.to_f64(), report.solve.upper.to_f64());
        let small_r: Vec<f64> = r.iter().map(small).collect();
        let energy_small = small(&energy);
        let Standing { above, clear } = self.limits.standing(self.stored, &x, &small_r, energy_small);
        let fallback = report.solve.fallback;
        let loose = clear
            && (!(upper <= SLACK * self.limits.ratio * energy_small)
                || known_ratio(method, fallback, &self.limits)
                    .is_some_and(|known| !(upper <= known * lower)));
        Record {
            method,
            single: T::UNIT_ROUNDOFF.to_f64() > 1e-10,
            decade: self.decade,
            ending: report.solve.ending,
            fallback,
            in_lanes: solved.in_lanes,
            lower,
            upper,
            energy: energy_small,
            violated: !(big(lower) <= energy && energy <= big(upper)),
            above,
            clear,
            loose,
            known: 2.0 * self.limits.ratio,
        }
    }
}

/// Solves a case by every solver and adds what is found.
pub fn judge(case: &Case, random: &mut Random, number: usize, seen: &mut Seen) {
    if case.single {
        judge_in::<f32>(case, random, number, seen);
    } else {
        judge_in::<f64>(case, random, number, seen);
    }
}

fn judge_in<T: Real>(case: &Case, random: &mut Random, number: usize, seen: &mut Seen) {
    let cuts = METHODS.map(|method| (method, Cut::new(random)));
    let systems = match islands::<T>(case) {
        Ok(systems) => systems,
        Err(name) => return seen.refuse(case.single, &format!("assembly: {name}")),
    };
    let mut judges = Vec::new();
    for stored in &systems {
        let Some(judge) = Judge::new(stored, BITS) else {
            seen.wrong("A is not positive definite", case);
            return;
        };
        seen.system(case.family, case.single, judge.decade);
        if number.is_multiple_of(5) || stored.clamped > 0 {
            seen.mu_checked += 1;
            let positive = stored.mu.iter().all(|mu| *mu > T::ZERO);
            if !positive || Factor::new(&stored.beyond_mu(&judge.matrix, BITS)).is_none() {
                seen.wrong("A ⪰ diag(μ) > 0 does not hold", case);
            }
        }
        judges.push(judge);
    }
    let mut asked = BTreeSet::new();
    for (method, cut) in cuts {
        let solved = match method.solve::<T>(case, cut) {
            Ok(solved) => solved,
            Err(error) => {
                let name = format!("{error:?}");
                seen.refuse(case.single, &format!("solve: {}", name.split('(').next().unwrap_or_default()));
                continue;
            }
        };
        assert_eq!(judges.len(), solved.reports.len());
        for (k, (judge, report)) in judges.iter().zip(&solved.reports).enumerate() {
            if judge.stored.clamped != report.clamped as usize {
                // In lanes μ is summed in another order: another matrix where it is 0 but for rounding.
                seen.refuse(case.single, &format!("{}: clamped otherwise", method.name()));
                continue;
            }
            if asked.insert(k) {
                projection::judge(judge.stored, report.certified, seen);
            }
            let record = judge.record(method, report, &solved);
            if record.violated {
                seen.violation(case, cut, &record);
            }
            if number.is_multiple_of(50) {
                seen.agree(difference(judge, &solved.velocity));
            }
            seen.solves.push(record);
        }
    }
}

/// |E₆₂ − E₁₂₅|/E₁₂₅
fn difference<T: Real>(judge: &Judge<'_, T>, velocity: &[[f64; 3]]) -> f64 {
    let Some(finer) = Judge::new(judge.stored, 2 * BITS) else { return f64::INFINITY };
    let (coarse, fine) =
        (judge.energy(&judge.residual(velocity).1), finer.energy(&finer.residual(velocity).1));
    if fine == big(0.0) { small(&coarse) } else { small(&((&coarse - &fine) / &fine)).abs() }
}
