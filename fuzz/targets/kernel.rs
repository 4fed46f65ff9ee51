//! The kernel's API as a sequence of calls.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| hooke_fuzz_bodies::kernel::kernel(data));
