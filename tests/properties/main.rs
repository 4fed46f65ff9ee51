//! Properties over generated data. Seeds are fixed, so that a run can be repeated; `HOOKE_RANDOM=1` picks one at random and
//! prints it.

// Indices are those of the formulas.
#![allow(clippy::needless_range_loop)]

mod edits;
mod physics;
mod solves;

use hooke_tests::random::Random;
use proptest::test_runner::{Config, RngSeed};

/// So many cases from this seed, or from one of the clock.
pub fn config(seed: u64, cases: u32) -> Config {
    Config {
        cases,
        rng_seed: RngSeed::Fixed(Random::seed(seed)),
        failure_persistence: None,
        ..Config::default()
    }
}
