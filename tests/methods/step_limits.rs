//! The limits of explicit methods: what they are, that they hold, and what substeps do.

use hooke::{Drag, PointSpring, Spring, SpringDamping, StepError, SymplecticEuler, Verlet};
use hooke_tests::data::SceneData;
use hooke_tests::methods::{Method, options};
use hooke_tests::vec_memory::VecScene;
use hooke_tests::{allowed, build, generate};

/// A wall, 2 kg, 3 kg in a row, springs of 50 and 70 N/m: λ and d by hand.
fn row() -> SceneData {
    let mut data = SceneData::default();
    for (i, m) in [1.0, 2.0, 3.0].into_iter().enumerate() {
        data.particle([i as f64, 0.1 * i as f64, 0.0], m);
    }
    data.pinned[0] = true;
    data.spring(0, 1, 50.0);
    data.spring(1, 2, 70.0);
    data.velocity[2] = [0.3, 0.1, -0.2];
    data
}

/// (50 + 2·70)/2 is larger than 2·70/3.
const LAMBDA: f64 = 95.0;
/// c = 4: (4 + 2·4)/2 = 6 is larger than 2·4/3; drag of 0.25/s more.
const DAMPING: f64 = 6.25;

fn near(found: f64, expected: f64) {
    assert!((found / expected - 1.0).abs() <= 8.0 * allowed::U64, "{found} is not {expected}");
}

#[test]
fn the_limits_are_those_of_lambda_and_d() {
    let mut scene = build::scene::<f64>(&row());
    near(Verlet::new(1.0).limit(&mut scene), 2.0 / LAMBDA.sqrt());
    near(SymplecticEuler::new(1.0).limit(&mut scene), 2.0 / LAMBDA.sqrt());
    let (damping, drag) = (SpringDamping(4.0), Drag(0.25));
    let root = (DAMPING * DAMPING + 4.0 * LAMBDA).sqrt();
    near(SymplecticEuler::new(1.0).with(damping).with(drag).limit(&mut scene), (root - DAMPING) / LAMBDA);
    near(Verlet::new(1.0).with(damping).with(drag).limit(&mut scene), 2.0 / LAMBDA.sqrt());
    // Where damping is the faster: d = 25·6 + 0.25.
    near(Verlet::new(1.0).with(SpringDamping(100.0)).with(drag).limit(&mut scene), 2.0 / 150.25);
    let point = PointSpring::new(1, [5.0, 0.0, 0.0], 20.0);
    near(Verlet::new(1.0).with(point).limit(&mut scene), 2.0 / (LAMBDA + 10.0).sqrt());
}

#[test]
fn the_limit_does_not_depend_on_the_state_however_compressed_springs_and_point_springs_are() {
    let mut scene = build::scene::<f64>(&row());
    let point = PointSpring::new(1, [1.0, 0.1, 0.0], 20.0).rest_length(3.0);
    let mut verlet = Verlet::new(1.0).with(point);
    let expected = 2.0 / (LAMBDA + 10.0).sqrt();
    for x in [0.001, 0.5, 1.0, 1.01, 4.0, 9.0] {
        scene.set_position(1, [x, 0.1, 0.0]).unwrap();
        near(verlet.limit(&mut scene), expected);
    }
}

#[test]
fn a_scene_without_springs_has_no_limit_and_one_of_endless_stiffness_no_step() {
    let mut scene = VecScene::<f64>::empty();
    scene.particle([0.0; 3], 1.0).unwrap();
    assert_eq!(Verlet::new(1.0).limit(&mut scene), f64::INFINITY);
    assert_eq!(SymplecticEuler::new(1.0).limit(&mut scene), f64::INFINITY);
    for i in 1..5 {
        scene.particle([f64::from(i), 0.0, 0.0], 1.0).unwrap();
        scene.spring(0, i as usize, f64::MAX).unwrap();
    }
    for substeps in [1, u32::MAX] {
        let error = scene.step(&mut Verlet::new(1e-3).substeps_at_most(substeps)).unwrap_err();
        assert!(matches!(error, StepError::StepLimit(_)), "{error:?}");
    }
    assert!(matches!(scene.step(&mut SymplecticEuler::new(1e-3)), Err(StepError::StepLimit(_))));
}

#[test]
fn a_step_just_beyond_the_limit_is_refused_without_trace_and_names_the_particle_that_sets_it() {
    let data = row();
    for damping in [0.0, 4.0, 100.0] {
        let (mut tried, mut untouched) = (build::scene::<f64>(&data), build::scene::<f64>(&data));
        let force = SpringDamping(damping);
        let limits = [
            (Method::Verlet, Verlet::new(1.0).with(force).limit(&mut tried)),
            (Method::SymplecticEuler, SymplecticEuler::new(1.0).with(force).limit(&mut tried)),
        ];
        for (method, limit) in limits {
            let refused = method.step(&mut tried, options(1.001 * limit, 1e-6), force, &[]);
            assert_eq!(refused, Err(StepError::StepLimit(1)), "{method:?}");
            assert_eq!(build::bits(&tried), build::bits(&untouched));
            method.step(&mut tried, options(0.999 * limit, 1e-6), force, &[]).unwrap();
            method.step(&mut untouched, options(0.999 * limit, 1e-6), force, &[]).unwrap();
            assert_eq!(build::bits(&tried), build::bits(&untouched));
        }
    }
}

/// Two equal particles and a spring of rest length 0: linear, ω² = 2k/m, which is λ itself.
fn linear_pair() -> VecScene<f64> {
    let mut scene = VecScene::<f64>::empty();
    for side in [0.5, -0.5] {
        scene.particle([side, 0.0, 0.0], 1.0).unwrap();
    }
    scene.spring_with(0, 1, Spring { stiffness: 50.0, rest_length: 0.0 }).unwrap();
    scene
}

#[test]
fn the_limit_of_a_pair_is_where_it_becomes_unstable() {
    // ω = 10. Just below, positions stay within 1/√(1 − h²ω²/4); just above, which only this recurrence shows, they leave.
    let mut scene = linear_pair();
    let limit = Verlet::new(1.0).limit(&mut scene);
    near(limit, 0.2);
    let mut verlet = Verlet::new(0.999 * limit);
    let bound = 0.5 / (1.0 - 0.999f64 * 0.999).sqrt();
    for _ in 0..2000 {
        scene.step(&mut verlet).unwrap();
        assert!(scene.positions()[0][0].abs() <= bound * 1.0001);
    }
    let (mut x, mut v, h) = (0.5f64, 0.0f64, 1.001 * limit);
    for _ in 0..200 {
        v -= 50.0 * h * x;
        x += h * v;
        v -= 50.0 * h * x;
    }
    assert!(x.abs() > 0.5e3, "the recurrence is stable beyond the limit: {x}");
    // Symplectic Euler with damping: ω² = 100, the pair's rate d = 2c/m.
    let mut scene = linear_pair();
    let damping = SpringDamping(1.5);
    let limit = SymplecticEuler::new(1.0).with(damping).limit(&mut scene);
    scene.set_velocity(0, [0.1, 0.0, 0.0]).unwrap();
    for _ in 0..2000 {
        scene.step(&mut SymplecticEuler::new(0.999 * limit).with(damping)).unwrap();
    }
    assert!(scene.positions()[0][0].abs() < 50.0);
    let (mut x, mut v, h) = (1.0f64, 0.0f64, 1.001 * limit);
    for _ in 0..20_000 {
        v -= h * (100.0 * x + 3.0 * v);
        x += h * v;
    }
    assert!(x.abs() > 1e3, "{x}");
}

#[test]
fn substeps_are_equal_smaller_steps_bit_for_bit_where_h_over_n_is_exact() {
    let mut data = generate::gentle_network(5, 10);
    for damped in [false, true] {
        if !damped {
            (data.drag, data.springs) =
                (0.0, data.springs.iter().map(|s| hooke_tests::data::SpringData { c: 0.0, ..*s }).collect());
        }
        data.springs.iter_mut().for_each(|s| s.k = s.k.clamp(50.0, 200.0));
        let mut forces = build::Forces::<f64>::new(&data);
        let mut large = build::scene::<f64>(&data);
        let limit = Verlet::new(1.0).with(forces.all()).limit(&mut large);
        // dt = 3.2 limits makes four substeps; a power of two over four is exact.
        let h = (0.8 * limit).log2().floor().exp2();
        let n = (4.0 * h / (0.9 * limit)) as u32 + 1;
        let mut small = build::scene::<f64>(&data);
        for _ in 0..10 {
            let of = hooke_tests::methods::Options { substeps: 8, ..options(4.0 * h, 1e-6) };
            Method::Verlet.step(&mut large, of, forces.all(), &[]).unwrap();
            for _ in 0..n {
                let of = options(4.0 * h / f64::from(n), 1e-6);
                Method::Verlet.step(&mut small, of, forces.all(), &[]).unwrap();
            }
        }
        assert!(n > 1);
        assert_eq!(build::bits(&large), build::bits(&small), "{n} substeps");
        let too_few = hooke_tests::methods::Options { substeps: n - 1, ..options(4.0 * h, 1e-6) };
        let refused = Method::Verlet.step(&mut large, too_few, forces.all(), &[]);
        assert!(matches!(refused, Err(StepError::StepLimit(_))), "{refused:?}");
    }
}
