//! Oracles and helpers that the tests share. No oracle shares code with the kernel: they are written from the lecture's
//! definitions, in other data structures and in other arithmetic.
//!
//! Where a check goes, how to run one, and where its allowed error stands: `README.md` beside this crate.

// Indices are those of the formulas.
#![allow(clippy::needless_range_loop)]

pub mod allowed;
pub mod build;
pub mod certified;
pub mod data;
pub mod dense;
pub mod direct;
pub mod envelope;
pub mod generate;
pub mod lanes;
pub mod methods;
pub mod multigrid;
pub mod precise;
pub mod random;
pub mod scaled;
pub mod side_by_side;
pub mod sparse;
pub mod textbook;
pub mod triangular;
pub mod ulps;
pub mod vec_memory;
