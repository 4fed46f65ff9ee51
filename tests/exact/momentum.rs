//! Linear momentum of what nothing holds.

use hooke::{BlockJacobi, LinearlyImplicitEuler, Real, Solver, SpringDamping};
use hooke_tests::data::SceneData;
use hooke_tests::generate::{self, Ingredients};
use hooke_tests::random::Random;
use hooke_tests::triangular::{ilu, ssor};
use hooke_tests::vec_memory::VecScene;
use hooke_tests::{allowed, build, direct};

/// Σ m v in f64, and Σ m|v| (what rounding is relative to).
fn momentum<T: Real>(scene: &VecScene<T>) -> ([f64; 3], f64) {
    let (mut sum, mut size) = ([0.0; 3], 0.0);
    for (m, v) in scene.state().mass.iter().zip(build::velocities(scene)) {
        for d in 0..3 {
            sum[d] += m.to_f64() * v[d];
            size += m.to_f64() * v[d].abs();
        }
    }
    (sum, size)
}

fn free_network(seed: u64) -> SceneData {
    let with = Ingredients { compressed: true, moving: true, ..Ingredients::default() };
    generate::network(&mut Random::new(seed), 12, with)
}

/// Every step of every network with this many iterations at most; every change of momentum against its rounding.
fn kept<T: Real, S: Solver<T>>(max_iterations: u32, unit: f64, solver: impl Fn(&SceneData) -> S) {
    let mut largest: f64 = 0.0;
    for seed in 0..30 {
        let data = free_network(seed);
        let mut scene = build::scene::<T>(&data);
        let mut euler = LinearlyImplicitEuler::new(T::from_f64(1.0 / 60.0))
            .with(SpringDamping(T::from_f64(0.1)))
            .max_iterations(max_iterations)
            .solver(solver(&data));
        for step in 0..10 {
            let (before, size) = momentum(&scene);
            let impulses = build::impulses(&scene, 1.0 / 60.0, 0.1);
            scene.step(&mut euler).unwrap();
            let (after, size_after) = momentum(&scene);
            let allowed = allowed::MOMENTUM * unit * (size + size_after + impulses);
            for d in 0..3 {
                let change = (after[d] - before[d]).abs();
                largest = largest.max(change / allowed);
                assert!(change <= allowed, "seed {seed}, step {step}: {change:e} of {allowed:e} kg m/s");
            }
        }
    }
    println!("{max_iterations} iterations: at most {largest:.2} of what is allowed");
}

#[test]
fn momentum_of_a_free_island_is_kept_to_rounding() {
    kept::<f64, _>(10_000, allowed::U64, |_| BlockJacobi);
    kept::<f32, _>(10_000, allowed::U32, |_| BlockJacobi);
}

#[test]
fn momentum_of_a_free_island_is_kept_to_rounding_by_direct_solvers() {
    kept::<f64, _>(10_000, allowed::U64, direct::banded);
    kept::<f32, _>(10_000, allowed::U32, direct::banded);
    kept::<f64, _>(10_000, allowed::U64, direct::sparse);
    kept::<f32, _>(10_000, allowed::U32, direct::sparse);
    kept::<f64, _>(10_000, allowed::U64, direct::single);
}

#[test]
fn momentum_of_a_free_island_is_kept_to_rounding_by_ssor_and_d_ilu_even_when_cut_short() {
    for cut in [1, 3, 10_000] {
        kept::<f64, _>(cut, allowed::U64, ssor);
        kept::<f32, _>(cut, allowed::U32, ssor);
        kept::<f64, _>(cut, allowed::U64, ilu);
        kept::<f32, _>(cut, allowed::U32, ilu);
    }
}

#[test]
fn momentum_of_a_free_island_is_kept_to_rounding_even_when_the_solve_is_cut_short() {
    for cut in [1, 2, 3, 7] {
        kept::<f64, _>(cut, allowed::U64, |_| BlockJacobi);
        kept::<f32, _>(cut, allowed::U32, |_| BlockJacobi);
    }
}

#[test]
fn momentum_under_gravity_grows_by_weight_times_h_even_after_one_iteration() {
    let data = SceneData { gravity: [0.0, -10.0, 0.0], ..free_network(50) };
    let mut scene = build::scene::<f64>(&data);
    let h = 1.0 / 64.0;
    let mut euler = LinearlyImplicitEuler::new(h).gravity(data.gravity).max_iterations(1);
    let mass: f64 = data.mass.iter().sum();
    for _ in 0..10 {
        let (before, size) = momentum(&scene);
        let impulses = build::impulses(&scene, h, 0.0);
        scene.step(&mut euler).unwrap();
        let (after, size_after) = momentum(&scene);
        let allowed = allowed::MOMENTUM * allowed::U64 * (size + size_after + impulses);
        assert!((after[1] - before[1] + 10.0 * mass * h).abs() <= allowed);
        assert!((after[0] - before[0]).abs() <= allowed);
    }
}

#[test]
fn the_kernels_momenta_and_centre_of_mass_are_their_sums() {
    let data = generate::lattice(3, 2, 2);
    let scene = build::scene::<f64>(&data);
    let state = scene.state();
    let (p, size) = momentum(&scene);
    for (ours, theirs) in p.iter().zip(state.linear_momentum()) {
        assert!((ours - theirs).abs() <= 24.0 * allowed::U64 * size);
    }
    // A spinning box about its centre: p = 0, c in the middle, L_z = ω Σ m(x² + y²), 2 rad/s.
    let c = state.centre_of_mass();
    for (c, middle) in c.iter().zip([0.1, 0.05, 0.05]) {
        assert!((c - middle).abs() <= 24.0 * allowed::U64);
    }
    let inertia: f64 =
        data.position.iter().map(|x| 0.01 * ((x[0] - 0.1).powi(2) + (x[1] - 0.05).powi(2))).sum();
    let l = state.angular_momentum();
    assert!((l[2] - 2.0 * inertia).abs() <= 64.0 * allowed::U64 * 0.12, "{} for {}", l[2], 2.0 * inertia);
    assert_eq!(VecScene::<f64>::empty().state().centre_of_mass(), [0.0; 3]);
}

#[test]
fn a_body_that_nothing_holds_falls_however_loose_the_tolerance_and_without_an_iteration() {
    for (absolute, iterations) in [(1e9, 100), (0.0, 0)] {
        let mut scene = hooke::Scene::<f64, 3, 2>::new();
        for x in [0.0, 1.0, 2.0] {
            scene.particle([x, 0.0, 0.0], 0.5).unwrap();
        }
        scene.spring(0, 1, 100.0).unwrap();
        scene.spring(1, 2, 100.0).unwrap();
        let mut euler = hooke::LinearlyImplicitEuler::new(0.125)
            .gravity([0.0, -8.0, 0.0])
            .absolute(absolute)
            .max_iterations(iterations);
        for step in 1..=4 {
            let report = scene.step(&mut euler).unwrap();
            assert_eq!(report.iterations, 0);
            assert!(report.upper < 1e-28, "a rigid fall is exact: {report:?}");
            assert!(scene.velocities().iter().all(|v| *v == [0.0, -f64::from(step), 0.0]));
        }
    }
}
