//! How tight the bounds must be, from the matrix alone, where rounding plays no part.
//!
//! With νᵢ = m̃ᵢ + Σ c_e (max(0, αₑ) + |wₑ|²): diag(μ) ⪯ A ⪯ diag(ν), so ½rᵀdiag(ν)⁻¹r ≤ ½‖e‖²_A ≤ ½rᵀdiag(μ)⁻¹r, whose ratio
//! is at most T = max νᵢ/μᵢ. Hence
//!
//! - upper/true ≤ T for every solver,
//! - upper/lower ≤ T where the lower bound is the one with ν (direct solvers),
//! - upper/lower ≤ 2T for block Jacobi: with z = D⁻¹r, (rᵀz)²/zᵀAz ≥ rᵀD⁻¹r/2 since A ⪯ 2D (2D − A has x_A + x_B where A
//!   has x_A − x_B, and is positive for the same reason), and D ⪯ diag(ν).
//!
//! That holds *clear of rounding*. With ε = 2⁻⁶: Σδᵢ²/μᵢ ≤ ε² Σ|rᵢ|²/νᵢ, which leaves (1 + 2ε)² above and
//! (1 − 2ε)²(1 − ε)² below; 16·T·u·(3n + k + 32) ≤ ε, k the springs of the longest row, which bounds the rounding of z, Az and
//! the sums by ε·rᵀz; and λ(3n + 16) ≤ ε Σ|rᵢ|²/νᵢ for underflow. All together less than [`SLACK`].

use hooke::Real;

use super::stored::Stored;

/// How a residual of an answer stands to its own rounding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Standing {
    /// ½Σδᵢ²/μᵢ is below 2⁻¹⁰ of the error's energy: there is an error to be recognised
    pub above: bool,
    /// Clear of rounding, as said above
    pub clear: bool,
}

/// (1 + 2ε)³/((1 − 2ε)²(1 − ε)²) = 1.21 for ε = 2⁻⁶
pub const SLACK: f64 = 1.25;
const EPSILON: f64 = 1.0 / 64.0;

/// T and what rounding is judged by.
#[derive(Debug, Clone)]
pub struct Limits {
    /// T = max νᵢ/μᵢ
    pub ratio: f64,
    /// Springs of the longest row
    springs: f64,
    nu: Vec<f64>,
    /// |α| + |w|² of each spring, its row, its other row
    sizes: Vec<(f64, usize, Option<usize>)>,
}

impl Limits {
    /// Of a matrix.
    pub fn new<T: Real>(stored: &Stored<T>) -> Self {
        let mut nu: Vec<f64> = stored.inertia.iter().map(|m| m.to_f64()).collect();
        let mut springs = vec![0.0f64; nu.len()];
        let mut sizes = Vec::new();
        for tie in &stored.ties {
            let (alpha, w) = (tie.used.alpha.to_f64(), tie.used.w.map(Real::to_f64));
            let along: f64 = w.iter().map(|w| w * w).sum();
            let c = if tie.other.is_some() { 2.0 } else { 1.0 };
            for row in [Some(tie.row), tie.other].into_iter().flatten() {
                nu[row] += c * (alpha.max(0.0) + along);
                springs[row] += 1.0;
            }
            sizes.push((alpha.abs() + along, tie.row, tie.other));
        }
        let ratios = nu.iter().zip(&stored.mu).map(|(nu, mu)| nu / mu.to_f64());
        let ratio = ratios.fold(1.0, f64::max);
        Self { ratio, springs: springs.into_iter().fold(0.0, f64::max), nu, sizes }
    }

    /// Where this residual of this answer, whose error has this energy, stands.
    pub fn standing<T: Real>(&self, stored: &Stored<T>, x: &[f64], r: &[f64], energy: f64) -> Standing {
        let unit = T::UNIT_ROUNDOFF.to_f64();
        let least = T::MIN_POSITIVE.to_f64();
        let n = self.nu.len() as f64;
        let at = |row: usize| [0, 1, 2].map(|d| x[3 * row + d].abs());
        let norm = |a: [f64; 3]| a.iter().map(|a| a * a).sum::<f64>().sqrt();
        let mut size: Vec<f64> = (0..self.nu.len())
            .map(|i| stored.inertia[i].to_f64() * norm(at(i)) + norm([0, 1, 2].map(|d| r[3 * i + d])))
            .collect();
        for (most, row, other) in &self.sizes {
            let apart = norm(at(*row)) + other.map_or(0.0, |other| norm(at(other)));
            for row in [Some(*row), *other].into_iter().flatten() {
                size[row] += most * apart;
            }
        }
        let (mut rounding, mut left) = (0.0, 0.0);
        for i in 0..self.nu.len() {
            // Each of k + 2 sums and a term's own 7 lose u of the sizes so far at most.
            let delta = 1.1 * unit * (self.springs + 9.0) * size[i] + 2.0 * least;
            rounding += 3.0 * delta * (delta / stored.mu[i].to_f64());
            left += (0..3).map(|d| r[3 * i + d] * (r[3 * i + d] / self.nu[i])).sum::<f64>();
        }
        let sums = 3.0 * n + 16.0;
        let clear = 16.0 * self.ratio * unit * (sums + self.springs + 16.0) <= EPSILON
            && rounding <= EPSILON * EPSILON * left
            && sums * least <= EPSILON * left;
        Standing { above: 0.5 * rounding + sums * least <= energy / 1024.0, clear }
    }
}
