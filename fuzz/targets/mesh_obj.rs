//! Wavefront OBJ.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| hooke_fuzz_bodies::mesh::obj(data));
