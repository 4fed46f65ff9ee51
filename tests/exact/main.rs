//! Exact identities: each test is named as a statement. Most compare bits; where rounding enters, the allowed error is in
//! `allowed.rs` with its derivation.

// Indices are those of the formulas.
#![allow(clippy::needless_range_loop)]

mod analysis;
mod batch;
mod block_ilu;
mod cables;
mod catenary;
mod chains_in_lanes;
mod claims;
mod coincident;
mod counters;
mod damaged;
mod damping;
mod direct;
mod edits;
mod energy;
mod errors;
mod extremes;
mod forces;
mod hierarchy;
mod in_lanes;
mod in_place;
mod islands;
mod matrices;
mod memory;
mod modes;
mod momentum;
mod multigrid;
mod one_spring;
mod pins;
mod preconditioned;
mod renewed_residuals;
mod rest;
mod same_bits;
mod same_steps;
mod scalings;
mod single;
mod sleeping;
mod snapshots;
mod ssor;
mod stiffness;
mod theorem;
mod ulps;
mod waking;
mod wide;
