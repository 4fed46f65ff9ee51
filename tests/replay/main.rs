//! The fuzz targets' bodies on stable: over the checked-in corpora, and over a fixed pseudo-random stream.

use std::fs;
use std::path::Path;

use hooke_fuzz_bodies::{c_api, kernel, mesh, scene_toml, solvers};

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

/// What a target does with bytes.
type Body = fn(&[u8]);

/// Every file of a target's corpus, and every one with some bytes changed and cut short.
fn replay(target: &str, body: Body) {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/corpus").join(target);
    let mut files = 0;
    for entry in fs::read_dir(&corpus).expect("the corpus is checked in") {
        let mut content = fs::read(entry.expect("a readable entry").path()).expect("a readable file");
        files += 1;
        body(&content);
        let mut next = stream(content.len() as u64 + 1);
        for _ in 0..8 {
            if !content.is_empty() {
                let place = usize::from(next()) * content.len() / 256;
                content[place] ^= next();
            }
            body(&content);
        }
        content.truncate(content.len() / 2);
        body(&content);
    }
    assert!(files > 0, "an empty corpus in {corpus:?} would replay nothing");
}

/// So many pseudo-random inputs of up to so many bytes.
fn play(body: Body, inputs: u64, longest: usize) {
    for seed in 1..=inputs {
        let mut next = stream(seed);
        let length = usize::from(next()) * longest / 255;
        body(&(0..length).map(|_| next()).collect::<Vec<_>>());
    }
}

#[test]
fn any_sequence_of_calls_leaves_a_valid_scene() {
    replay("kernel", kernel::kernel);
    play(kernel::kernel, 2_000, 900);
}

#[test]
fn any_network_is_solved_within_its_bounds_by_any_solver() {
    replay("solvers", solvers::solvers);
    play(solvers::solvers, 2_000, 200);
}

#[test]
fn any_sequence_of_calls_from_c_does_what_it_does_from_rust() {
    replay("c_api", c_api::c_api);
    play(c_api::c_api, 2_000, 900);
}

#[test]
fn any_bytes_are_a_mesh_or_an_error() {
    let targets: [(&str, Body); 7] = [
        ("mesh_obj", mesh::obj),
        ("mesh_medit", mesh::medit),
        ("mesh_gmsh", mesh::gmsh),
        ("mesh_ply", mesh::ply),
        ("mesh_stl", mesh::stl),
        ("mesh_vtk", mesh::vtk),
        ("mesh_vtk_xml", mesh::vtk_xml),
    ];
    for (target, body) in targets {
        replay(target, body);
        play(body, 100, 300);
    }
}

#[test]
fn any_bytes_are_a_scene_or_an_error() {
    replay("scene_toml", scene_toml::scene_toml);
    play(scene_toml::scene_toml, 100, 300);
}
