//! The errors that the kernel's scalar quantities may have, one table. `exact/ulps.rs` measures them against 62 digits on random,
//! adversarial and scene inputs; `bin/ulps.rs` does so on more inputs and writes `ULPS.md`; `gappa/` proves three of them (with 3.001 for 3, since it counts u² too).
//!
//! Errors are in units of u times what stands under *unit*, all for the floats that a spring is given: Δx as stored, k, l₀, and
//! s, θh, c of the step. ŝ = l − l₀ is the strain. A unit like u·k(l + |l − l₀|) where the quantity is k(l − l₀) says: where l ≈ l₀
//! the error is that of l, not of the difference.

pub mod inputs;
pub mod quantities;
pub mod rows;

/// How an allowed error is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Known {
    /// By Gappa, in this file of `gappa/`
    Proved(&'static str),
    /// By counting roundings, as said beside it
    Derived,
    /// Seen, with a margin
    Measured,
}

/// One quantity.
#[derive(Debug, Clone, Copy)]
pub struct Quantity {
    /// What
    pub name: &'static str,
    /// In units of u times
    pub unit: &'static str,
    /// So many units at most
    pub allowed: f64,
    /// Why
    pub known: Known,
}

const fn row(name: &'static str, unit: &'static str, allowed: f64, known: Known) -> Quantity {
    Quantity { name, unit, allowed, known }
}

/// How many there are.
pub const COUNT: usize = 14;

/// The table. Places are those of [`quantities::errors`] and [`rows::errors`].
pub const QUANTITIES: [Quantity; COUNT] = [
    row("Δx·Δx", "|Δx|²", 3.001, Known::Proved("length.g")),
    // 3u/2 and one more; squares of the errors are below 0.01.
    row("length l", "l", 2.52, Known::Proved("length.g")),
    // Each square loses u·λ more by underflow, and the sum is at least λ: 6u, and half of that.
    row("l where |Δx|² is near the smallest normal number", "l", 4.1, Known::Derived),
    // Strain, and two products, at the stored l (2 + 2); l itself 2.52 on k|ŝ|l, and its square.
    row("energy V", "V + k|ŝ|l + u·kl²", 4.1, Known::Derived),
    // l 2.52 on kl, strain and product 2 on k|ŝ|.
    row("tension k(l − l₀)", "k(l + |ŝ|)", 2.6, Known::Derived),
    // Strain and product 2, one division: at the stored l.
    row("k(l − l₀)/l at the stored l", "k|ŝ|/l", 3.01, Known::Proved("stretch.g")),
    // Tension's 2.6; 1/l 3.52, u one more, the product one more.
    row("gradient, a component", "k(l + |ŝ|)|u|", 7.6, Known::Derived),
    // Tension/l 2.52 on k and 2 on k|ŝ|/l; 1/l 3.52, the product 1, s 1.
    row("α", "s·k(1 + |ŝ|/l)", 7.6, Known::Derived),
    // k·l₀/l 5.52, s 1, c's 1, their sum 1: halved, the root 1, u 4.52, the product 1.
    row("w, a component", "|w|", 10.4, Known::Derived),
    // s·k 1, c's 1 and the sum 1, halved, the root 1, u 4.52, the product 1.
    row("w clamped, a component", "|w|", 7.6, Known::Derived),
    // m and two additions and a product for each of k springs: 2k + 1 roundings are one unit.
    row("diagonal block, an entry", "(2k + 1)(m + Σ|α| + |w||w|)", 1.0, Known::Derived),
    // Pivots of condition κ: 3 divisions, 9 products deep at most.
    row("inverse of a block, an entry", "κ·‖D⁻¹‖₂", 8.0, Known::Measured),
    // (k + 2) sums and 7 in a term, as in the theorem of the certificate.
    row("A x, a row's component", "(k + 9)(|m̃x| + Σ|α||d| + |w|(|w|·|d|))", 1.0, Known::Derived),
    // One more sum.
    row("b − A x, a row's component", "(k + 10)(the same + |b|)", 1.0, Known::Derived),
];
