//! The system A x = b of a step as the kernel shows it ([`LinearlyImplicitEuler::inspect`]), solved once more in f64 by dense
//! Cholesky, and how far the solver's x may be from it.
//!
//! E = ‖x̂ − x̃‖_A for x̂ = v⁺ − v and the reference x̃. Against the true ‖x − A⁻¹b‖_A that is wrong by no more than s, the sum of
//!
//! - ‖δ‖_A for the rounding of v⁺ = v + x: |δᵢ| ≤ u|vᵢ⁺|, and twice that for the difference taken here;
//! - the reference's own error: √Σ|rᵢ|²/μᵢ of r = b − Ax̃, since A ⪰ diag(μ), with r's rounding γ(|A||x̃| + |b|), |A| the sum of the sizes of its terms;
//! - for solvers in lanes, which add b up in another order: the same norm of |Δb| ≤ 2(D + 10)u·S, S the sum of the sizes of b's
//!   terms, D the most springs at a particle.
//!
//! So √(2·lower) ≤ E + s and E ≤ √(2·upper) + s must hold, and E's own rounding is γ√(|e|ᵀ|A||e|). γ = (N + 8)·2⁻⁵² for sums of
//! N terms. Where A has numbers beyond 10^±100, whose products leave f64's range, nothing is judged.

use hooke::{Force, LinearlyImplicitEuler, Real, Report};

use super::Heaped;

/// More unknowns than these take too long for a fuzzer at every step, and more than those at all.
const MOST: usize = 90;
const MOST_ONCE: usize = 300;

/// A step's system.
pub struct Reference {
    /// Rows of A, by particle and axis
    matrix: Vec<f64>,
    /// The same of its terms' absolute values
    sizes: Vec<f64>,
    right: Vec<f64>,
    mu: Vec<f64>,
    /// Coordinates of the rows
    rows: Vec<usize>,
    velocity: Vec<f64>,
    /// Of b's terms, for each row
    terms: Vec<f64>,
    busiest: f64,
}

impl Reference {
    /// What the next step of this scene is to solve; none if it is too large, too wild, or refused.
    pub fn of<T: Real, F: Force<T>>(
        scene: &mut Heaped<T>,
        euler: &mut LinearlyImplicitEuler<T, F>,
        once: bool,
    ) -> Option<Self> {
        let size = 3 * scene.free_particles();
        if size == 0 || size > if once { MOST_ONCE } else { MOST } {
            return None;
        }
        let h = euler.dt().to_f64();
        let mut found = Self {
            matrix: vec![0.0; size * size],
            sizes: vec![0.0; size * size],
            right: Vec::new(),
            mu: Vec::new(),
            rows: Vec::new(),
            velocity: flat(scene.velocities()),
            terms: Vec::new(),
            busiest: 0.0,
        };
        let seen = euler.inspect(scene.parts(), &[], |system, b, mu| {
            let first = found.rows.len();
            for (row, (b, mu)) in b.iter().zip(mu).enumerate() {
                let particle = system.particle(row).unwrap_or_default();
                found.rows.extend((0..3).map(|axis| 3 * particle + axis));
                found.right.extend(b.iter().map(|x| x.to_f64()));
                found.mu.extend([mu.to_f64(); 3]);
            }
            system.blocks(|i, j, block| {
                for (k, x) in block.as_flattened().iter().enumerate() {
                    let (row, column) = (first + 3 * i + k / 3, first + 3 * j + k % 3);
                    found.matrix[row * size + column] += x.to_f64();
                    found.sizes[row * size + column] += x.to_f64().abs();
                }
            });
        });
        seen.ok()?;
        let tame = |x: &f64| (1e-100..1e100).contains(&x.abs());
        let all = found.matrix.iter().chain(&found.right).chain(&found.velocity);
        if !found.mu.iter().all(tame) || !all.filter(|x| **x != 0.0).all(tame) {
            return None;
        }
        found.add_terms(scene, h);
        Some(found)
    }

    /// The sizes of what b is a sum of: tensions, gravity, and what velocities are multiplied with.
    fn add_terms<T: Real>(&mut self, scene: &Heaped<T>, h: f64) {
        let (state, springs) = (scene.state(), scene.springs());
        let mut terms: Vec<f64> = state.mass.iter().map(|m| 10.0 * h * m.to_f64()).collect();
        let mut degree = vec![0.0_f64; terms.len()];
        for j in 0..state.springs() {
            let Some((a, b)) = state.ends(j) else { continue };
            for i in [a, b] {
                terms[i] += h * springs.tension_of(j).to_f64().abs();
                degree[i] += 1.0;
            }
        }
        self.busiest = degree.into_iter().fold(0.0, f64::max);
        // |A||v| with |v| of all particles: a spring to a pin has its block on the diagonal, and pins rest or are in |v|.
        let fastest = self.velocity.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        let size = self.rows.len();
        self.terms = (0..size)
            .map(|row| {
                let sum: f64 = self.sizes[row * size..(row + 1) * size].iter().sum();
                terms[self.rows[row] / 3] + 2.0 * fastest * sum
            })
            .collect();
    }

    /// Is the step's error within its bounds?
    pub fn judge<T: Real>(&self, scene: &Heaped<T>, report: &Report<T>, lanes: bool) {
        let size = self.rows.len();
        let Some(reference) = self.solved() else { return };
        let now = flat(scene.velocities());
        let unit = T::UNIT_ROUNDOFF.to_f64();
        let gamma = (size as f64 + 8.0) * f64::EPSILON;
        let mut commit = Vec::new();
        let error: Vec<f64> = (0..size)
            .map(|row| {
                let (v, next) = (self.velocity[self.rows[row]], now[self.rows[row]]);
                commit.push(unit * next.abs() + f64::EPSILON * (next - v).abs());
                next - v - reference[row]
            })
            .collect();
        let (energy, sizes) = self.form(&error, &error);
        let (_, commit) = self.form(&commit, &commit);
        let mut own = 0.0;
        for row in 0..size {
            let (mut r, mut sum) = (self.right[row], self.right[row].abs());
            for (k, x) in reference.iter().enumerate() {
                r -= self.matrix[row * size + k] * x;
                sum += self.sizes[row * size + k] * x.abs();
            }
            let mut wrong = r.abs() + gamma * sum;
            if lanes {
                wrong += 2.0 * (self.busiest + 10.0) * unit * self.terms[row];
            }
            own += wrong * wrong / self.mu[row];
        }
        let distance = energy.max(0.0).sqrt();
        let slack = 1.001 * (commit.sqrt() + own.sqrt() + (gamma * sizes).sqrt()) + 1e-150;
        let [lower, upper] = [report.lower, report.upper].map(|x| (2.0 * x.to_f64()).sqrt());
        assert!(
            lower <= distance + slack && distance <= upper + slack,
            "the error {distance:e} ± {slack:e} is outside of {lower:e} … {upper:e} (roots of 2J): {report:?}"
        );
    }

    /// xᵀAy and |x|ᵀ|A||y|
    fn form(&self, x: &[f64], y: &[f64]) -> (f64, f64) {
        let (mut sum, mut sizes, columns) = (0.0, 0.0, y.len());
        for (i, x) in x.iter().enumerate() {
            for (k, y) in y.iter().enumerate() {
                sum += x * self.matrix[i * columns + k] * y;
                sizes += self.sizes[i * columns + k] * (x * y).abs();
            }
        }
        (sum, sizes)
    }

    /// A⁻¹b by LLᵀ; none if a pivot is not positive.
    fn solved(&self) -> Option<Vec<f64>> {
        let n = self.rows.len();
        let mut l = self.matrix.clone();
        for j in 0..n {
            for i in j..n {
                let (above, row) = l.split_at(i * n);
                let left = if i == j { &row[..j] } else { &above[j * n..j * n + j] };
                let dot: f64 = row[..j].iter().zip(left).map(|(a, b)| a * b).sum();
                let value = l[i * n + j] - dot;
                l[i * n + j] = if i > j {
                    value / l[j * n + j]
                } else if value > 0.0 {
                    value.sqrt()
                } else {
                    return None;
                };
            }
        }
        let mut x = self.right.clone();
        for i in 0..n {
            let dot: f64 = l[i * n..i * n + i].iter().zip(&x).map(|(a, b)| a * b).sum();
            x[i] = (x[i] - dot) / l[i * n + i];
        }
        for i in (0..n).rev() {
            let dot: f64 = (i + 1..n).map(|k| l[k * n + i] * x[k]).sum();
            x[i] = (x[i] - dot) / l[i * n + i];
        }
        Some(x)
    }
}

fn flat<T: Real>(vectors: &[[T; 3]]) -> Vec<f64> {
    vectors.as_flattened().iter().map(|x| x.to_f64()).collect()
}
