//! The C interface as a sequence of calls.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| hooke_fuzz_bodies::c_api::c_api(data));
