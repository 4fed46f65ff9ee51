//! Whole trajectories against the dense and the sparse oracle.

use hooke_tests::build::{self, Forces};
use hooke_tests::data::SceneData;
use hooke_tests::dense::Dense;
use hooke_tests::{allowed, generate, sparse};

/// Runs the kernel; answers final positions, velocities and springs clamped in all.
fn run(data: &SceneData, h: f64, steps: usize, relative: f64) -> sparse::Outcome {
    let mut scene = build::scene::<f64>(data);
    let mut forces = Forces::<f64>::new(data);
    let mut euler = forces.euler(h).tolerance(relative);
    let mut clamped = 0;
    for _ in 0..steps {
        clamped += scene.step(&mut euler).unwrap().clamped as usize;
    }
    sparse::Outcome { position: build::positions(&scene), velocity: build::velocities(&scene), clamped }
}

/// The kernel against the sparse oracle; answers how many springs were clamped.
fn follows_the_oracle(
    name: &str,
    data: &SceneData,
    h: f64,
    steps: usize,
    relative: f64,
    allowed: f64,
) -> usize {
    let ours = run(data, h, steps, relative);
    let oracle = sparse::simulate(data, h, steps);
    let off = build::farthest(&ours.position, &oracle.position);
    let off_v = build::farthest(&ours.velocity, &oracle.velocity);
    let moved = build::farthest(&oracle.position, &data.position);
    println!(
        "{name}: {off:.1e} m and {off_v:.1e} m/s from the oracle after {moved:.2} m; {} clamped",
        ours.clamped
    );
    assert_eq!(ours.clamped, oracle.clamped);
    assert!(off <= allowed, "{name}: {off:e} m off, {allowed:e} allowed");
    assert!(moved > 100.0 * allowed, "{name} hardly moved: {moved:e} m");
    ours.clamped
}

#[test]
fn a_rope_follows_the_dense_oracle() {
    let data = generate::rope(12);
    let h = 1.0 / 60.0;
    let mut oracle = data.clone();
    for _ in 0..30 {
        oracle = Dense::new(&oracle).step(h, &[]).0;
    }
    let ours = run(&data, h, 30, 1e-12);
    let off = build::farthest(&ours.position, &oracle.position);
    println!("rope: {off:.1e} m from the dense oracle");
    assert!(off <= allowed::TRAJECTORY, "{off:e} m");
}

#[test]
fn a_rope_follows_the_sparse_oracle() {
    follows_the_oracle("rope:40", &generate::rope(40), 1.0 / 60.0, 30, 1e-12, allowed::TRAJECTORY);
}

#[test]
fn a_chain_follows_the_sparse_oracle() {
    follows_the_oracle("chain:64", &generate::chain(64), 1.0 / 60.0, 20, 1e-12, allowed::TRAJECTORY);
}

/// A blob kicked so that it shears and turns.
fn kicked(cells: usize) -> SceneData {
    let mut data = generate::blob(cells, 1);
    println!("blob: {} particles, {} springs", data.len(), data.springs.len());
    assert!(data.pinned.contains(&true));
    for i in 0..data.len() {
        if !data.pinned[i] {
            data.velocity[i] = [3.0, 1.0, -2.0];
        }
    }
    data
}

#[test]
fn a_kicked_blob_of_tetrahedra_follows_the_sparse_oracle() {
    let data = kicked(6);
    assert!((120..260).contains(&data.len()));
    let clamped = follows_the_oracle("blob", &data, 0.005, 30, 1e-12, allowed::TRAJECTORY);
    assert!(clamped > 0, "a kick like this needs clamping");
}

#[test]
fn a_kicked_blob_as_large_as_the_bunny_follows_the_sparse_oracle() {
    let data = kicked(10);
    assert!((600..900).contains(&data.len()));
    let steps = if cfg!(debug_assertions) { 3 } else { 20 };
    let start = std::time::Instant::now();
    let oracle = sparse::simulate(&data, 0.005, steps);
    println!("{steps} steps of the sparse oracle: {:.2} s", start.elapsed().as_secs_f64());
    let ours = run(&data, 0.005, steps, 1e-12);
    assert_eq!(ours.clamped, oracle.clamped);
    let off = build::farthest(&ours.position, &oracle.position);
    assert!(off <= allowed::TRAJECTORY, "{off:e} m");
}

#[test]
fn a_damped_network_with_everything_in_it_follows_the_sparse_oracle() {
    for seed in 0..5 {
        let data = generate::gentle_network(seed, 20);
        follows_the_oracle("network", &data, 1.0 / 60.0, 30, 1e-12, allowed::TRAJECTORY);
    }
}

#[test]
fn cloth_8_follows_the_oracle_and_is_certified_throughout() {
    let clamped =
        follows_the_oracle("cloth:8", &generate::cloth(8), 1.0 / 60.0, 30, 1e-12, allowed::TRAJECTORY);
    assert_eq!(clamped, 0);
}

#[test]
fn cloth_16_follows_the_oracle_and_clamps_52_springs_in_15_steps() {
    let clamped =
        follows_the_oracle("cloth:16", &generate::cloth(16), 1.0 / 60.0, 15, 1e-12, allowed::CLOTH_16);
    assert_eq!(clamped, 52);
}

#[test]
fn cloth_32_at_small_steps_follows_the_oracle_and_is_certified_throughout() {
    let steps = if cfg!(debug_assertions) { 20 } else { 60 };
    let clamped =
        follows_the_oracle("cloth:32", &generate::cloth(32), 0.001, steps, 1e-12, allowed::SMALL_STEPS);
    assert_eq!(clamped, 0);
}

/// The reference scene `bunny`, from the user's file; the blobs above are its twins on data of our own.
#[test]
fn the_bunny_follows_the_sparse_oracle_where_its_mesh_is_at_hand() {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/meshes/coarse_bunny.mesh");
    if !file.exists() {
        println!("skipped: there is no shared/meshes/coarse_bunny.mesh beside the project");
        return;
    }
    let mesh = hooke_harness::mesh::load(&file).unwrap();
    let lowest = mesh.points.iter().map(|x| x[1]).fold(f64::INFINITY, f64::min);
    let n = mesh.points.len();
    let spring = |[a, b]: [usize; 2]| {
        let l0 = hooke_tests::data::distance(mesh.points[a], mesh.points[b]);
        hooke_tests::data::SpringData { a, b, k: 1e5, l0, c: 0.0 }
    };
    let mut data = SceneData {
        position: mesh.points.clone(),
        velocity: vec![[0.0; 3]; n],
        mass: vec![1.0; n],
        pinned: mesh.points.iter().map(|x| x[1] <= lowest + 3.0).collect(),
        springs: mesh.edges().into_iter().map(spring).collect(),
        gravity: [0.0, -9.8, 0.0],
        ..SceneData::default()
    };
    let free = data.pinned.iter().filter(|p| !**p).count();
    assert_eq!((n, data.springs.len(), free), (699, 3521, 682));
    let steps = if cfg!(debug_assertions) { 2 } else { 20 };
    for kick in [0.0, 50.0] {
        for (v, pinned) in data.velocity.iter_mut().zip(&data.pinned) {
            *v = if *pinned { [0.0; 3] } else { [kick, 0.0, 0.0] };
        }
        assert_eq!(follows_the_oracle("bunny", &data, 0.005, steps, 1e-12, allowed::BUNNY), 0);
    }
}
