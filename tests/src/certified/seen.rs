//! What a run has seen.

use std::collections::BTreeMap;

use hooke::Ending;

use super::case::{Case, Cut, Family};
use super::projection::{BINS, Bin};
use super::solvers::Method;

/// One solve of one system.
#[derive(Debug, Clone, Copy)]
pub struct Record {
    /// By what
    pub method: Method,
    /// In `f32`?
    pub single: bool,
    /// ⌊log₁₀ κ(A)⌋
    pub decade: usize,
    /// How it ended
    pub ending: Ending,
    /// Did factors break down?
    pub fallback: bool,
    /// Was it (its step's last island) solved in lanes?
    pub in_lanes: bool,
    /// Reported, J
    pub lower: f64,
    /// Reported, J
    pub upper: f64,
    /// ½‖e‖²_A, J, rounded
    pub energy: f64,
    /// Is it outside?
    pub violated: bool,
    /// Is the error above what rounding can leave?
    pub above: bool,
    /// Is the residual clear of rounding ([`super::rounding`])?
    pub clear: bool,
    /// Clear of rounding, and yet farther apart than is known
    pub loose: bool,
    /// 2T, what is known of upper/lower
    pub known: f64,
}

impl Record {
    /// Is upper/lower known beforehand to be at most 2T ([`super::rounding`])?
    pub fn is_bounded(&self) -> bool {
        self.method.is_direct() || matches!(self.method, Method::Jacobi | Method::Lanes)
    }

    /// upper/lower; infinite without a lower bound; 1 where both are 0.
    pub fn ratio(&self) -> f64 {
        if self.upper == 0.0 { 1.0 } else { self.upper / self.lower }
    }
}

/// All of a run.
#[derive(Debug, Clone, Default)]
pub struct Seen {
    /// Systems by family, precision and decade of κ
    pub systems: BTreeMap<(Family, bool, usize), usize>,
    /// Every solve
    pub solves: Vec<Record>,
    /// Errors by precision and name
    pub refused: BTreeMap<(bool, String), usize>,
    /// Violations of any kind, in words
    pub wrong: Vec<String>,
    /// Systems whose A ⪰ diag(μ) was checked
    pub mu_checked: usize,
    /// The certificate without projection, by compression
    pub projection: [Bin; BINS.len()],
    /// Solves judged in 125 digits too
    pub compared: usize,
    /// The largest relative difference that made
    pub difference: f64,
}

impl Seen {
    /// One more system.
    pub fn system(&mut self, family: Family, single: bool, decade: usize) {
        *self.systems.entry((family, single, decade)).or_default() += 1;
    }

    /// An error in place of an answer.
    pub fn refuse(&mut self, single: bool, name: &str) {
        *self.refused.entry((single, name.to_owned())).or_default() += 1;
    }

    /// Something that must not be.
    pub fn wrong(&mut self, what: &str, case: &Case) {
        self.wrong.push(format!("{what}: {case:?}"));
    }

    /// An error outside its bounds.
    pub fn violation(&mut self, case: &Case, cut: Cut, record: &Record) {
        self.wrong.push(format!(
            "{:e} J not in [{:e}, {:e}]: {record:?}, {cut:?}, {case:?}",
            record.energy, record.lower, record.upper
        ));
    }

    /// A second opinion.
    pub fn agree(&mut self, difference: f64) {
        self.compared += 1;
        self.difference = self.difference.max(difference);
    }

    /// How many systems.
    pub fn count(&self) -> usize {
        self.systems.values().sum()
    }

    /// Joins what others have seen.
    pub fn merge(&mut self, other: Self) {
        for (key, n) in other.systems {
            *self.systems.entry(key).or_default() += n;
        }
        for (key, n) in other.refused {
            *self.refused.entry(key).or_default() += n;
        }
        self.solves.extend(other.solves);
        self.wrong.extend(other.wrong);
        self.mu_checked += other.mu_checked;
        for (bin, other) in self.projection.iter_mut().zip(other.projection) {
            bin.systems += other.systems;
            bin.positive += other.positive;
            bin.certified += other.certified;
            bin.wrong += other.wrong;
        }
        self.compared += other.compared;
        self.difference = self.difference.max(other.difference);
    }
}

/// The value below which so large a part lies. Sorts.
pub fn quantile(values: &mut [f64], part: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let last = values.len().saturating_sub(1);
    values.get(((part * values.len() as f64) as usize).min(last)).copied().unwrap_or(f64::NAN)
}
