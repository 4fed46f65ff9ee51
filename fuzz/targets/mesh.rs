//! The mesh loaders on arbitrary bytes.
#![no_main]

#[path = "../bodies/mesh.rs"]
mod body;

libfuzzer_sys::fuzz_target!(|data: &[u8]| body::mesh(data));
