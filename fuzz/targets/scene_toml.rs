//! Scene files.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| hooke_fuzz_bodies::scene_toml::scene_toml(data));
