//! Arbitrary networks and every solver.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| hooke_fuzz_bodies::solvers::solvers(data));
