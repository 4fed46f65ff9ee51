//! The fuzz targets' bodies on stable: over the checked-in corpus, and over a fixed pseudo-random stream.

#[path = "../../fuzz/bodies/kernel.rs"]
mod kernel;
#[path = "../../fuzz/bodies/mesh.rs"]
mod mesh;

use std::fs;
use std::path::Path;

/// xorshift64*: the same stream on every machine.
fn stream(seed: u64) -> impl FnMut() -> u8 {
    let mut state = seed;
    move || {
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        (state.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 56) as u8
    }
}

fn replay(target: &str, body: fn(&[u8]), inputs: u64, longest: usize) {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/corpus").join(target);
    let mut files = 0;
    for entry in fs::read_dir(&corpus).expect("the corpus is checked in") {
        body(&fs::read(entry.expect("a readable entry").path()).expect("a readable file"));
        files += 1;
    }
    assert!(files > 0, "an empty corpus in {corpus:?} would replay nothing");
    for seed in 1..=inputs {
        let mut next = stream(seed);
        let length = usize::from(next()) * longest / 255;
        body(&(0..length).map(|_| next()).collect::<Vec<_>>());
    }
}

#[test]
fn any_sequence_of_calls_leaves_a_valid_scene() {
    replay("kernel", kernel::kernel, 3_000, 900);
}

#[test]
fn any_bytes_are_a_mesh_or_an_error() {
    replay("mesh", mesh::mesh, 700, 300);
}
