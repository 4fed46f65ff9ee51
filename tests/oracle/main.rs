//! The kernel against oracles that share no code with it: dense, sparse and multi-precision.

// Indices are those of the formulas.
#![allow(clippy::needless_range_loop)]

mod bounds;
mod one_step;
mod oracles;
mod stopping;
mod trajectories;
