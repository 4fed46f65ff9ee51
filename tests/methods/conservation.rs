//! What methods keep over many steps: momentum, angular momentum, energy.

use hooke::{Real, SpringDamping};
use hooke_tests::data::SceneData;
use hooke_tests::generate::{self, Ingredients};
use hooke_tests::methods::{self, Method, Method::*, options};
use hooke_tests::random::Random;
use hooke_tests::vec_memory::VecScene;
use hooke_tests::{allowed, build};
use nalgebra::Vector3;

fn free_network(seed: u64) -> SceneData {
    let with = Ingredients { compressed: true, moving: true, ..Ingredients::default() };
    let mut net = generate::network(&mut Random::new(seed), 12, with);
    net.mass.iter_mut().for_each(|m| *m = m.clamp(0.05, 1.0));
    net
}

/// Σ mv and Σ m|v|; Σ m x×v and Σ m|x||v|
fn momenta<T: Real>(scene: &VecScene<T>) -> [(Vector3<f64>, f64); 2] {
    let mut sums = [(Vector3::zeros(), 0.0); 2];
    let both = build::positions(scene).into_iter().zip(build::velocities(scene));
    for (m, (x, v)) in scene.state().mass.iter().zip(both) {
        let (x, p) = (Vector3::from(x), Vector3::from(v) * m.to_f64());
        for (sum, (of, size)) in sums.iter_mut().zip([(p, p.norm()), (x.cross(&p), x.norm() * p.norm())]) {
            *sum = (sum.0 + of, sum.1 + size);
        }
    }
    sums
}

/// How long a step is: half of Verlet's limit.
fn below_the_limit(scene: &mut VecScene<f64>) -> f64 {
    0.5 * hooke::Verlet::new(1.0).limit(scene)
}

fn linear<T: Real>(unit: f64) {
    for method in methods::ALL {
        let mut largest = 0.0f64;
        for seed in 0..20 {
            let data = free_network(seed);
            let h = below_the_limit(&mut build::scene::<f64>(&data)).min(1.0 / 60.0);
            let mut scene = build::scene::<T>(&data);
            for step in 0..10 {
                let [(before, size), _] = momenta(&scene);
                let impulses = build::impulses(&scene, h, 0.1);
                let damping = SpringDamping(T::from_f64(0.1));
                method.step(&mut scene, options(h, 1e-2), damping, &[]).unwrap();
                let [(after, size_after), _] = momenta(&scene);
                let off = (after - before).norm() / (unit * (size + size_after + impulses));
                largest = largest.max(off);
                assert!(off <= allowed::MOMENTUM_OF_METHODS, "{method:?}, seed {seed}, step {step}: {off}");
            }
        }
        println!("{method:?}: momentum to {largest:.2} units of rounding");
    }
}

#[test]
fn linear_momentum_of_a_free_island_is_kept_to_rounding_by_every_method_however_loose_its_solves() {
    linear::<f64>(allowed::U64);
    linear::<f32>(allowed::U32);
}

#[test]
fn angular_momentum_is_kept_to_rounding_by_verlet_and_symplectic_euler_and_to_its_tolerance_by_energy_momentum()
 {
    for method in [Verlet, SymplecticEuler, EnergyMomentum] {
        let mut largest = 0.0f64;
        for seed in 0..20 {
            let data = free_network(seed);
            let mut scene = build::scene::<f64>(&data);
            let h = below_the_limit(&mut scene);
            for step in 0..10 {
                let [_, (before, size)] = momenta(&scene);
                method.step(&mut scene, options(h, 1e-14), (), &[]).unwrap();
                let [_, (after, size_after)] = momenta(&scene);
                let impulses = build::impulses(&scene, h, 0.0);
                let off = (after - before).norm() / (allowed::U64 * (size + size_after + impulses));
                largest = largest.max(off);
                assert!(off <= allowed::ANGULAR_MOMENTUM, "{method:?}, seed {seed}, step {step}: {off}");
            }
        }
        println!("{method:?}: angular momentum to {largest:.2} units of rounding");
    }
}

#[test]
fn implicit_methods_that_do_not_claim_it_lose_angular_momentum() {
    let data = free_network(3);
    for method in [Euler, Midpoint, Ros2, Ros3, Newton] {
        let mut scene = build::scene::<f64>(&data);
        let h = below_the_limit(&mut scene);
        let [_, (before, size)] = momenta(&scene);
        method.step(&mut scene, options(h, 1e-14), (), &[]).unwrap();
        let [_, (after, _)] = momenta(&scene);
        assert!(
            (after - before).norm() > 1e-9 * size,
            "{method:?}: the measure of the test above would see nothing"
        );
    }
}

/// Two particles of 1 kg, k = 100 N/m, l₀ = 0.8 m at 1 m, turning and swinging.
fn pair() -> SceneData {
    let mut data = SceneData::default();
    for side in [1.0, -1.0] {
        let i = data.particle([0.5 * side, 0.0, 0.0], 1.0);
        data.velocity[i] = [0.0, 0.5 * side, 0.0];
    }
    data.spring_with(0, 1, 100.0, 0.8);
    data
}

fn energy(scene: &VecScene<f64>) -> f64 {
    scene.springs().kinetic_energy() + scene.springs().potential_energy()
}

/// The largest |E/E₀ − 1| over the steps.
fn drift(method: Method, h: f64, steps: usize) -> f64 {
    let mut scene = build::scene::<f64>(&pair());
    let start = energy(&scene);
    let mut worst = 0.0f64;
    for _ in 0..steps {
        method.step(&mut scene, options(h, 1e-14), (), &[]).unwrap();
        worst = worst.max((energy(&scene) / start - 1.0).abs());
    }
    worst
}

const STEPS: usize = if cfg!(debug_assertions) { 10_000 } else { 100_000 };

#[test]
fn energy_momentum_keeps_the_energy_of_the_pair_to_1e_11_in_ten_thousand_steps() {
    for h in [0.01, 0.1] {
        let drift = drift(EnergyMomentum, h, STEPS);
        println!("energy-momentum, {STEPS} steps of {h} s: energy within {drift:.1e}");
        // What R = 1e-14 leaves unsolved has one sign, so it adds up.
        assert!(drift <= 1e-11 * (STEPS as f64 / 1e4), "{drift:e}");
        assert!(h > 0.05 || drift <= 1e-11, "{drift:e} over all steps");
    }
}

#[test]
fn energy_under_verlet_and_symplectic_euler_stays_near_with_an_error_of_their_order_and_does_not_drift() {
    // ω of the pair is √(2k/m) = 14; the limit is h = 2/ω = 0.141 s.
    for (method, order) in [(Verlet, 2), (SymplecticEuler, 1)] {
        let [large, small] = [0.02, 0.01].map(|h| drift(method, h, STEPS / 4));
        let longer = drift(method, 0.02, STEPS);
        println!(
            "{method:?}: {large:.1e} at 0.02 s, {small:.1e} at 0.01 s, {longer:.1e} in four times the time"
        );
        assert!(longer <= 1.05 * large, "{method:?} drifts: {longer} after {large}");
        let observed = (large / small).log2();
        assert!((observed - f64::from(order)).abs() <= 0.15, "{method:?}: order {observed}");
    }
}

#[test]
fn midpoint_does_not_keep_the_energy_of_the_pair() {
    assert!(drift(Midpoint, 0.02, 1000) > 1e-6);
}

/// Does the energy of the pair stay within the part?
fn stays(method: Method, h: f64, data: &SceneData) -> bool {
    let mut scene = build::scene::<f64>(data);
    let start = energy(&scene);
    (0..STEPS / 10).all(|_| {
        method.step(&mut scene, options(h, 1e-12), (), &[]).unwrap();
        energy(&scene) < 4.0 * start
    })
}

#[test]
fn energy_stays_bounded_below_verlets_limit_also_when_springs_are_compressed() {
    for seed in 0..5 {
        let mut data = free_network(seed);
        data.springs.iter_mut().for_each(|s| s.k = s.k.min(100.0));
        let h = hooke::Verlet::new(1.0).limit(&mut build::scene::<f64>(&data));
        assert!(stays(Verlet, 0.5 * h, &data), "seed {seed}");
    }
}
