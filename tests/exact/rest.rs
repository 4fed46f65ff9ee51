//! No force, v = 0, l = l₀: nothing moves.

use hooke::{Drag, LinearlyImplicitEuler, Real, SpringDamping};
use hooke_tests::data::SceneData;
use hooke_tests::random::Random;
use hooke_tests::vec_memory::VecScene;
use hooke_tests::{build, generate, lanes};

fn rests<T: Real>() {
    let mut random = Random::new(1);
    for pins in [false, true] {
        let mut scene = VecScene::<T>::empty();
        for i in 0..30 {
            scene.particle(build::real3(random.vector(1.0)), T::from_f64(random.decade(1e-3, 1.0))).unwrap();
            if pins && i % 10 == 0 {
                scene.pin(i).unwrap();
            }
        }
        for i in 1..30 {
            scene.spring(i, random.below(i), T::from_f64(random.decade(1.0, 1e6))).unwrap();
        }
        let before = build::bits(&scene);
        let mut euler = LinearlyImplicitEuler::new(T::from_f64(1.0 / 60.0))
            .with(Drag(T::from_f64(0.5)))
            .with(SpringDamping(T::ONE));
        for _ in 0..50 {
            let report = scene.step(&mut euler).unwrap();
            assert_eq!((report.iterations, report.clamped), (0, 0));
            assert_eq!((report.untouched, report.certified), (report.islands, report.islands));
            assert_eq!((report.upper, report.lower), (T::ZERO, T::ZERO));
        }
        assert_eq!(build::bits(&scene), before);
        assert_eq!(scene.springs().potential_energy(), T::ZERO);
    }
}

#[test]
fn without_force_at_rest_and_at_rest_length_nothing_moves_bit_for_bit() {
    rests::<f64>();
    rests::<f32>();
}

#[test]
fn where_nothing_acts_lanes_iterate_nothing_in_either_precision() {
    let data = SceneData { gravity: [0.0; 3], ..generate::cloth(9) };
    let rest = |solver: &mut dyn FnMut(&mut VecScene<f64>) -> hooke::Report<f64>| {
        let mut scene = build::scene::<f64>(&data);
        let (before, report) = (build::bits(&scene), solver(&mut scene));
        assert_eq!((report.iterations, report.untouched, report.upper, report.lower), (0, 1, 0.0, 0.0));
        assert_eq!(build::bits(&scene), before);
    };
    let (mut wide, mut single) = (lanes::wide::<f64>(&data), lanes::single::<f64>(&data));
    rest(&mut |scene| scene.step(&mut LinearlyImplicitEuler::new(0.01).solver(&mut wide)).unwrap());
    rest(&mut |scene| scene.step(&mut LinearlyImplicitEuler::new(0.01).solver(&mut single)).unwrap());
    assert!(wide.in_lanes() && single.in_lanes());
}

#[test]
fn a_cloth_without_gravity_stays_flat_bit_for_bit() {
    let data = generate::cloth(8);
    let mut scene = build::scene::<f64>(&data);
    let before = build::bits(&scene);
    let mut euler = LinearlyImplicitEuler::new(1.0 / 60.0);
    for _ in 0..20 {
        scene.step(&mut euler).unwrap();
    }
    assert_eq!(build::bits(&scene), before);
}

#[test]
fn a_free_scene_moving_as_one_goes_on_at_the_same_velocity_bit_for_bit() {
    // Dyadic positions and velocity: Δx does not change, so no spring ever pulls.
    let mut scene = VecScene::<f64>::empty();
    for x in [[0.0, 0.0, 0.0], [0.5, 0.25, 0.0], [1.0, 0.0, 0.75]] {
        let i = scene.particle(x, 0.3).unwrap();
        scene.set_velocity(i, [0.5, -1.0, 2.0]).unwrap();
    }
    for (a, b) in [(0, 1), (1, 2), (2, 0)] {
        scene.spring(a, b, 1e4).unwrap();
    }
    let mut euler = LinearlyImplicitEuler::new(1.0 / 64.0).with(SpringDamping(3.0));
    for n in 1..=100 {
        assert_eq!(scene.step(&mut euler).unwrap().iterations, 0);
        let t = f64::from(n) / 64.0;
        assert_eq!(scene.positions()[1], [0.5 + 0.5 * t, 0.25 - t, 2.0 * t]);
        assert!(scene.velocities().iter().all(|v| *v == [0.5, -1.0, 2.0]));
    }
}
