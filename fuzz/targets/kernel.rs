//! The kernel's API as a sequence of calls.
#![no_main]

#[path = "../bodies/kernel.rs"]
mod body;

libfuzzer_sys::fuzz_target!(|data: &[u8]| body::kernel(data));
