//! What a step keeps: a free body's momentum, and that `newton`'s potential does not rise. The bounds are derived in
//! [`super::judge`].

use super::judge::Judge;
use super::mirror::Snapshot;
use crate::run::integrator::Integrator;

/// Newton's iterations, each of which may raise its potential by rounding.
const NEWTON: f64 = 200.0;

impl Judge<'_> {
    /// |Δp − hMg| of every free body.
    pub(super) fn keeps_momentum(&mut self, before: &Snapshot, after: &Snapshot, h: f64, upper: f64) {
        if self.model.drag > 0.0 || self.bodies.is_empty() {
            return;
        }
        let iterates = matches!(self.method.integrator, Integrator::Newton | Integrator::EnergyMomentum);
        let size = |x: [f64; 3]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let gravity = size(self.model.gravity);
        let mut tension = vec![0.0; self.model.springs.len()];
        for state in [before, after] {
            self.mirror.energies(state, |_| [0.0; 3]);
            tension.iter_mut().enumerate().for_each(|(j, t)| *t += h * self.mirror.tension(j).0);
        }
        let mut found = Vec::new();
        for body in &self.bodies {
            let (mut change, mut scale) = ([0.0; 3], h * body.mass * gravity);
            for &i in &body.particles {
                let (m, v, w) = (self.model.mass[i], before.velocity[i], after.velocity[i]);
                (0..3).for_each(|c| change[c] += m * (w[c] - v[c] - h * self.model.gravity[c]));
                scale += m * (size(v) + size(w));
            }
            for &j in &body.springs {
                let spring = self.model.springs[j];
                let [a, b] = spring.ends;
                let apart = |v: &[[f64; 3]]| size(std::array::from_fn(|c| v[a][c] - v[b][c]));
                let rate = apart(&before.velocity) + apart(&after.velocity);
                scale += 2.0 * (tension[j] + h * (h * spring.stiffness + spring.damping) * rate);
            }
            let sums = body.particles.len() as f64 + 2.0 * self.busiest + 16.0;
            let unsolved = if iterates { (2.0 * upper * body.mass).sqrt() } else { 0.0 };
            let allowed = sums * self.unit * scale + unsolved;
            found.push((size(change), allowed, body.particles[0]));
        }
        for (change, allowed, first) in found {
            if change > allowed {
                self.breaks(format!(
                    "the body of particle {first} gains {change:.2e} kg m/s, rounding may make {allowed:.2e}"
                ));
            }
            if allowed > 0.0 && allowed.is_finite() {
                self.worst.momentum = self.worst.momentum.max(change / allowed);
            }
        }
    }

    /// E(v⁺) ≤ E(0), E(0) what the step begins with.
    pub(super) fn goes_downhill(&mut self, before: &Snapshot, after: &Snapshot) {
        let model = self.model;
        if self.method.integrator != Integrator::Newton
            || model.is_damped()
            || model.drag > 0.0
            || !model.moving.is_empty()
        {
            return;
        }
        let weight = |state: &Snapshot| {
            let free = (0..state.position.len()).filter(|i| !model.pinned[*i]);
            let height = |x: [f64; 3]| (0..3).map(|c| model.gravity[c] * x[c]).sum::<f64>();
            free.fold((0.0, 0.0), |(sum, size), i| {
                let own = -model.mass[i] * height(state.position[i]);
                (sum + own, size + own.abs())
            })
        };
        let (v0, t0) = self.mirror.energies(before, |i| before.velocity[i]);
        let blur0 = self.blur(before).0;
        let (v1, t1) = self
            .mirror
            .energies(after, |i| std::array::from_fn(|c| after.velocity[i][c] - before.velocity[i][c]));
        let (blur1, moved) = self.blur(after);
        let (w0, w1) = (weight(before), weight(after));
        let rise = (t1 - t0) + (v1 - v0) + (w1.0 - w0.0);
        let terms = (model.springs.len() + model.mass.len() + 16) as f64;
        let sizes = t0 + t1 + v0 + v1 + w0.1 + w1.1;
        let allowed = NEWTON * 2.0 * self.unit * (terms * sizes + blur0 + blur1) + moved;
        if rise > allowed {
            self.breaks(format!("newton's potential rises by {rise:.2e} J, rounding may make {allowed:.2e}"));
        }
        if rise > 0.0 && allowed > 0.0 && allowed.is_finite() {
            self.worst.potential = self.worst.potential.max(rise / allowed);
        }
    }

    /// Σ|tension|·reach and Σ ½k(2u·reach)², where the mirror was last put.
    fn blur(&self, state: &Snapshot) -> (f64, f64) {
        let size = |i: usize| state.position[i].iter().map(|x| x.abs()).sum::<f64>();
        self.model.springs.iter().enumerate().fold((0.0, 0.0), |(first, second), (j, spring)| {
            let reach = size(spring.ends[0]) + size(spring.ends[1]) + spring.rest_length;
            let off = 2.0 * self.unit * reach;
            (first + self.mirror.tension(j).0 * reach, second + 0.5 * spring.stiffness * off * off)
        })
    }
}
