//! What must hold after every step, whatever the scene: a list of what does not.
//!
//! - The state is finite; after an error it has the bits that it had before the step, and the error is one that the method
//!   may end with.
//! - A report's bounds are numbers, 0 ≤ lower ≤ upper < ∞, and its counts fit the scene.
//! - No more solves, iterations and rejections than the method's limits allow: it cannot hang.
//! - Islands that nothing holds keep their momentum, but for gravity's part hMg:
//!   |Δp − hMg| ≤ (n + 2D + 16)u(Σm(|v| + |v⁺|) + hΣm|g| + 2Σ_e J_e) + √(2·upper·M),
//!   J_e = h|tension| at both ends of the step + h²k|v_A − v_B| of both + hc|…|: rows add up D springs, D the most at a particle,
//!   twice (b and Ax), the sum over an island's n particles is the kernel's, 16 for products and quotients. Springs themselves
//!   cancel bit for bit. The last term is for methods that iterate: ½|Σb|²/M ≤ ½Σ|b|²/μ, which they report as `upper`.
//! - `newton`: ½‖v⁺ − v‖²_M + V(q⁺) ≤ ½‖v‖²_M + V(q), gravity in V, where nothing damps, drags or is moved, but for rounding:
//!   each of 200 iterations may raise it by 2u of (springs + particles + 16) such sums and of Σ|tension|·reach, which its line
//!   search allows, and rounded positions by Σ ½k(2u·reach)², reach = |x_A| + |x_B| + l₀.
//! - Where no force acts and nothing moves, no bit changes.
//! - Energies are numbers, and finite unless they are beyond the precision's range.

use hooke::{Real, Report, StepError};

use super::bodies::{Body, bodies};
use super::method::{Method, REJECTIONS};
use super::mirror::{Mirror, Snapshot};
use super::worst::Worst;
use crate::scene::Model;

/// What a step did.
pub struct Stepped<T> {
    /// How long it was, s.
    pub dt: f64,
    /// Its report.
    pub report: Report<T>,
    /// Longer ones that were rejected.
    pub rejections: u32,
}

/// Judges the steps of one trial.
pub struct Judge<'a> {
    pub(super) model: &'a Model,
    pub(super) method: Method,
    pub(super) mirror: Mirror,
    pub(super) unit: f64,
    /// The largest number of the precision
    range: f64,
    most_iterations: u64,
    at_rest: bool,
    pub(super) bodies: Vec<Body>,
    islands: usize,
    pub(super) busiest: f64,
    /// What does not hold, a line each.
    pub broken: Vec<String>,
    /// The worst that was seen.
    pub worst: Worst,
}

impl<'a> Judge<'a> {
    /// Of a model in the numbers of `T`, and a method whose solves may take so many iterations.
    pub fn new<T: Real>(
        model: &'a Model,
        method: Method,
        mirror: Mirror,
        most_iterations: u32,
        at_rest: bool,
    ) -> Self {
        let (bodies, islands) = bodies(model);
        let mut degree = vec![0.0; model.pinned.len()];
        model.springs.iter().flat_map(|spring| spring.ends).for_each(|i| degree[i] += 1.0);
        Self {
            model,
            method,
            mirror,
            unit: T::UNIT_ROUNDOFF.to_f64(),
            range: if size_of::<T>() == 4 { f64::from(f32::MAX) } else { f64::MAX },
            most_iterations: u64::from(most_iterations),
            at_rest,
            bodies,
            islands,
            busiest: degree.into_iter().fold(0.0, f64::max),
            broken: Vec::new(),
            worst: Worst::default(),
        }
    }

    pub(super) fn breaks(&mut self, what: String) {
        // The first of a kind is enough to find the rest.
        if self.broken.len() < 8 {
            self.broken.push(what);
        }
    }

    /// A step that failed.
    pub fn failed(&mut self, before: &Snapshot, after: &Snapshot, error: StepError) {
        if let Some(i) = before.differs(after) {
            self.breaks(format!("the step failed ({error}), but particle {i} has changed"));
        }
        if !self.method.may_end_with(error, !self.model.moving.is_empty()) {
            self.breaks(format!("an error that {} must not end with: {error}", self.method.name));
        }
    }

    /// What a step, failed or not, has asked of the solver.
    pub fn worked(&mut self, solves: u64, iterations: u64) {
        let most = self.method.most_solves * self.islands as u64;
        if solves > most {
            self.breaks(format!("{solves} solves in a step, {most} are the most"));
        }
        if iterations > most * self.most_iterations {
            self.breaks(format!("{iterations} iterations in a step of {solves} solves"));
        }
        self.worst.solves = self.worst.solves.max(solves);
        self.worst.iterations = self.worst.iterations.max(iterations);
    }

    /// A step that was made.
    pub fn made<T: Real>(&mut self, before: &Snapshot, after: &Snapshot, step: &Stepped<T>) {
        self.reported(step);
        if let Some(i) = after.not_finite() {
            let (x, v) = (after.position[i], after.velocity[i]);
            return self.breaks(format!("particle {i} is at {x:?} with {v:?}: not finite"));
        }
        if self.at_rest
            && let Some(i) = before.differs(after)
        {
            self.breaks(format!("nothing acts, but particle {i} has moved"));
        }
        let (dt, upper) = (step.dt, step.report.upper.to_f64());
        self.keeps_momentum(before, after, dt, upper);
        self.goes_downhill(before, after);
    }

    /// Energies as the precision itself computes them.
    pub fn energy(&mut self, state: &Snapshot, kinetic: f64, springs: f64) {
        let (exact_springs, exact_kinetic) = self.mirror.energies(state, |i| state.velocity[i]);
        for (name, found, exact) in
            [("kinetic", kinetic, exact_kinetic), ("potential", springs, exact_springs)]
        {
            if found.is_nan() || (!found.is_finite() && exact < 1e-3 * self.range) {
                self.breaks(format!("{name} energy is {found:e} J, in f64 {exact:e} J"));
            }
        }
        self.worst.energy = self.worst.energy.max(kinetic + springs);
    }

    fn reported<T: Real>(&mut self, step: &Stepped<T>) {
        let r = &step.report;
        let (lower, upper) = (r.lower.to_f64(), r.upper.to_f64());
        if !(lower >= 0.0 && lower <= upper && upper.is_finite()) {
            self.breaks(format!("bounds from {lower:e} to {upper:e} J"));
        }
        let (islands, springs) = (self.islands, self.model.springs.len() as u64);
        if r.islands as usize != islands || r.certified > r.islands || r.untouched > r.islands {
            self.breaks(format!(
                "{} islands, {} certified, {} untouched of {islands}",
                r.islands, r.certified, r.untouched
            ));
        }
        if u64::from(r.clamped) > springs {
            self.breaks(format!("{} springs clamped of {springs}", r.clamped));
        }
        if step.rejections > REJECTIONS {
            self.breaks(format!("{} rejections of a step", step.rejections));
        }
        self.worst.rejections = self.worst.rejections.max(step.rejections);
        self.worst.upper = self.worst.upper.max(upper);
    }
}
