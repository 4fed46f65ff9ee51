//! The certificate that A needs no projection, against the exact inertia of the raw matrix M + hD − h²K.
//!
//! Certified means μᵢ > 0 at every node before any clamping. Then the raw matrix must be positive definite: never wrong. The
//! other way round it is only sufficient: of the raw matrices that are positive definite it accepts a part, the smaller the
//! more compressed the springs are, here by ξ = max −αₑ/min(m̃ of its free ends), where −αₑ is h²k(l₀/l − 1).
//!
//! The inertia is that of L Δ Lᵀ in 62 digits: a pivot's sign is certain unless λ_min/λ_max is below about n·2⁻²⁰⁸.

use hooke::Real;

use super::seen::Seen;
use super::stored::Stored;
use crate::precise::{BITS, Factor};

/// Upper ends of the bins of ξ.
pub const BINS: [f64; 8] = [0.0, 0.1, 0.2, 0.3, 0.5, 1.0, 10.0, f64::INFINITY];

/// Raw matrices of a bin.
#[derive(Debug, Clone, Copy, Default)]
pub struct Bin {
    /// How many
    pub systems: usize,
    /// Of these, positive definite
    pub positive: usize,
    /// Certified at every node
    pub certified: usize,
    /// Certified and not positive definite
    pub wrong: usize,
}

/// ξ
pub fn compression<T: Real>(stored: &Stored<T>) -> f64 {
    let one = |tie: &super::stored::Tie<T>| {
        let ends = [Some(tie.row), tie.other].into_iter().flatten();
        let least = ends.map(|row| stored.inertia[row].to_f64()).fold(f64::INFINITY, f64::min);
        (-tie.raw.alpha.to_f64()).max(0.0) / least
    };
    stored.ties.iter().map(one).fold(0.0, f64::max)
}

/// Judges one system's certificate.
pub fn judge<T: Real>(stored: &Stored<T>, certified: bool, seen: &mut Seen) {
    let xi = compression(stored);
    let bin = BINS.iter().position(|end| xi <= *end).unwrap_or(BINS.len() - 1);
    let positive = Factor::new(&stored.raw_matrix(BITS)).is_some();
    let bin = &mut seen.projection[bin];
    bin.systems += 1;
    bin.positive += usize::from(positive);
    bin.certified += usize::from(certified);
    bin.wrong += usize::from(certified && !positive);
}
