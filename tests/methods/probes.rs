//! The length of a step: what a controller makes of an error, and attempts that look for a length without a step.

use hooke::{
    Adaptive, Course, Embedded, LocalError, Motion, Rosenbrock2, Rosenbrock3, Spring, StepError, Verlet,
};
use hooke_tests::data::SceneData;
use hooke_tests::methods::{Method, options};
use hooke_tests::vec_memory::VecScene;
use hooke_tests::{allowed, build, generate};

/// A spring that swings, far from the limits of an explicit step: ω² = 2.
fn swinging() -> VecScene<f64> {
    let mut scene = VecScene::<f64>::empty();
    for x in [0.0, 1.5] {
        scene.particle([x, 0.0, 0.0], 1.0).unwrap();
    }
    scene.spring_with(0, 1, Spring { stiffness: 1.0, rest_length: 1.0 }).unwrap();
    scene
}

const DT: f64 = 0.125;

/// The error of one attempt, which leaves the scene as it is.
fn error<I: Embedded<f64>>(
    mut method: I,
    scene: &mut VecScene<f64>,
    dt: f64,
    accuracy: f64,
) -> LocalError<f64> {
    method.attempt(&mut scene.parts(), dt, Course::rest(), accuracy / 4096.0, &mut |_| {}).unwrap().1
}

#[test]
fn an_attempt_changes_nothing_and_asks_for_nine_tenths_of_the_fourth_root_of_j_over_e_bit_for_bit() {
    // Verlet has no solve, so that its error does not depend on J, and J may be any power of two of it.
    let found = error(Verlet::new(1.0), &mut swinging(), DT, 1.0).energy;
    assert!(found > 0.0);
    let lengths = [
        // J/E, the factor, and whether the length was right within a factor of 2
        (1.0, 0.9, true),
        (16.0, 1.8, true),
        (256.0, 0.9 * 4.0, false),
        (65_536.0, 0.9 * 16.0, false),
        (1_048_576.0, 20.0, false),
        (1e30, 20.0, false),
        (1.0 / 16.0, 0.45, false),
        (1.0 / 256.0, 0.9 * 0.25, false),
        (1.0 / 1_048_576.0, 0.05, false),
        (1e-30, 0.05, false),
    ];
    for (ratio, factor, right) in lengths {
        let mut scene = swinging();
        let before = build::bits(&scene);
        let mut method = Adaptive::new(Verlet::new(1.0), DT, found * ratio);
        let hooke::Probed { report, settled, dt, .. } = method.probe(&mut scene, &[]).unwrap();
        assert_eq!((method.dt(), dt, settled), (DT * factor, DT * factor, right), "J/E = {ratio}");
        assert_eq!((report.islands, build::bits(&scene)), (1, before));
    }
}

#[test]
fn an_attempt_of_order_3_asks_for_j_over_e_to_three_sixteenths() {
    let data = generate::cloth(5);
    for accuracy in [1e-3, 1e-6, 1e-9] {
        let mut forces = build::Forces::<f64>::new(&data);
        let memory = vec![[0.0; 3]; Rosenbrock3::<f64, ()>::needs(data.len())];
        let method = Rosenbrock3::new(1.0, memory).with(forces.all()).tolerance(1e-12);
        let mut scene = build::scene::<f64>(&data);
        let mut method = Adaptive::new(method, 0.004, accuracy);
        let report =
            method.method.attempt(&mut scene.parts(), 0.004, Course::rest(), accuracy / 4096.0, &mut |_| {});
        let (report, error) = report.unwrap();
        assert_eq!(method.probe(&mut scene, &[]).unwrap().report, report);
        let factor = 0.9 * (accuracy / error.energy).powf(3.0 / 16.0);
        let expected = 0.004 * factor.clamp(0.05, 20.0);
        println!("{accuracy:e} J: {:e} J at 4 ms, next {} s", error.energy, method.dt());
        assert!((method.dt() / expected - 1.0).abs() <= allowed::ROOTS * allowed::U64, "{expected}");
    }
}

#[test]
fn no_attempt_is_longer_than_a_step_that_is_stable_and_there_the_length_is_right() {
    // At rest nothing has an error: a step may be as long as its method has a stable one.
    let mut scene = VecScene::<f64>::empty();
    for x in [0.0, 1.0] {
        scene.particle([x, 0.0, 0.0], 1.0).unwrap();
    }
    scene.spring_with(0, 1, Spring { stiffness: 8.0, rest_length: 1.0 }).unwrap();
    // λ = 16, so that a substep is below a half, and eight of nine tenths of that are a step.
    let longest = 0.9 * 8.0 * 0.5;
    for (dt, next, right) in [
        (longest / 64.0, longest / 64.0 * 20.0, false),
        (longest / 16.0, longest, true),
        (longest, longest, true),
        (10.0 * longest, longest, true),
    ] {
        let mut method = Adaptive::new(Verlet::new(1.0), dt, 1e-6);
        assert_eq!(method.probe(&mut scene, &[]).unwrap().settled, right, "{dt} s");
        assert_eq!(method.dt(), next, "{dt} s");
    }
    let mut method = Adaptive::new(Verlet::new(1.0).with(hooke::Drag(f64::INFINITY)), 1.0, 1e-6);
    assert!(method.probe(&mut scene, &[]).is_err());
}

#[test]
fn no_attempt_is_longer_than_a_motion_and_one_without_an_end_is_refused() {
    let mut scene = swinging();
    let i = scene.particle([3.0, 0.0, 0.0], 1.0).unwrap();
    scene.pin(i).unwrap();
    let motion = [Motion { particle: i, position: [4.0, 0.0, 0.0], velocity: [1.0, 0.0, 0.0] }];
    let found = error(Verlet::new(1.0), &mut scene, DT, 1.0).energy;
    let mut method = Adaptive::new(Verlet::new(1.0), 2.0 * DT, 256.0 * found);
    let before = build::bits(&scene);
    assert_eq!(method.probe(&mut scene, &motion).unwrap_err(), StepError::Motion(i));
    assert_eq!(method.dt(), 2.0 * DT);
    // The attempt is as long as the motion, and nothing longer is known to be right.
    method.end_after(DT);
    assert!(method.probe(&mut scene, &motion).unwrap().settled);
    assert_eq!((method.dt(), build::bits(&scene)), (DT * (0.9 * 4.0), before));
    // Without a motion an end cuts nothing: what is asked is how long a step may be.
    let mut method = Adaptive::new(Verlet::new(1.0), DT, 256.0 * found);
    method.end_after(DT / 2.0);
    assert!(!method.probe(&mut scene, &[]).unwrap().settled);
    assert_eq!(method.dt(), DT * (0.9 * 4.0));
}

#[test]
fn after_an_attempt_that_leaves_the_numbers_the_next_is_twenty_times_shorter() {
    let mut scene = VecScene::<f32>::empty();
    let i = scene.particle([0.0; 3], 1.0).unwrap();
    let j = scene.particle([1.0, 0.0, 0.0], 1.0).unwrap();
    scene.spring_with(i, j, Spring { stiffness: 1e-30, rest_length: 1.0 }).unwrap();
    scene.set_velocity(i, [1e30, 0.0, 0.0]).unwrap();
    let before = build::bits(&scene);
    let mut method = Adaptive::new(Verlet::new(1.0), 1e10, 1e-6f32);
    let failed = method.probe(&mut scene, &[]);
    assert!(matches!(failed, Err(StepError::NotFinite(_))), "{failed:?}");
    assert_eq!((method.dt(), build::bits(&scene)), (1e10 * 0.05f64 as f32, before));
}

#[test]
fn a_few_attempts_find_a_length_that_a_step_takes_from_far_above_and_from_far_below() {
    // Well after it was let go: as long as nothing is strained an error goes with no power of the step.
    let mut data = generate::cloth(5);
    let moved = Method::Euler.run::<f64>(&data, options(1.0 / 60.0, 1e-8), 20);
    build::read_back(&moved, &mut data);
    let find = |dt: f64| {
        let mut forces = build::Forces::<f64>::new(&data);
        let mut scene = build::scene::<f64>(&data);
        let memory = vec![[0.0; 3]; Rosenbrock2::<f64, ()>::needs(data.len())];
        let mut method = Adaptive::new(Rosenbrock2::new(1.0, memory).with(forces.all()), dt, 1e-5);
        let attempts = (1..20).find(|_| method.probe(&mut scene, &[]).unwrap().settled).expect("a length");
        let length = method.dt();
        scene.step(&mut method).unwrap();
        assert!(method.made().error.energy <= 1e-5 && method.made().rejections <= 1, "{:?}", method.made());
        println!("from {dt} s: {attempts} attempts, {length} s");
        length
    };
    let [below, above] = [1e-6, 10.0].map(find);
    assert!(below / above < 2.0 && above / below < 2.0, "{below} {above}");
}

/// One step of a scene that swings, with its length before, its error, and the length after.
fn stepped(ratio: f64) -> (f64, Adaptive<Verlet<f64>, f64>, VecScene<f64>) {
    let found = error(Verlet::new(1.0), &mut swinging(), DT, 1.0).energy;
    let mut scene = swinging();
    let mut method = Adaptive::new(Verlet::new(1.0), DT, found * ratio);
    scene.step(&mut method).unwrap();
    (found, method, scene)
}

#[test]
fn a_first_step_asks_for_nine_tenths_of_j_over_e_to_three_sixteenths_but_five_times_at_most_bit_for_bit() {
    for (ratio, factor) in [(1.0, 0.9), (65_536.0, 5.0)] {
        let (found, method, _) = stepped(ratio);
        assert_eq!((method.made().dt, method.made().rejections, method.dt()), (DT, 0, DT * factor));
        assert_eq!(method.made().error.energy, found);
    }
}

#[test]
fn a_step_that_is_rejected_is_made_anew_with_nine_tenths_of_the_fourth_root_between_a_tenth_and_a_half() {
    for (ratio, factor) in [(0.5, 0.5), (0.999, 0.5), (1.0 / 16.0, 0.45), (1.0 / 1_048_576.0, 0.1)] {
        let (_, method, _) = stepped(ratio);
        let made = method.made();
        assert!(made.rejections >= 1);
        if made.rejections == 1 {
            assert_eq!(made.dt, DT * factor, "J/E = {ratio}");
        }
        // Had it been rejected again it would be shorter still.
        assert!(made.dt <= DT * factor);
        assert!(ratio < 1e-3 || made.rejections == 1, "{ratio}: {made:?}");
    }
}

#[test]
fn a_step_after_another_divides_by_the_eighth_root_of_the_one_before() {
    let (found, mut method, mut scene) = stepped(4.0);
    let accuracy = 4.0 * found;
    for _ in 0..20 {
        let before = accuracy / method.made().error.energy;
        scene.step(&mut method).unwrap();
        let made = method.made();
        if made.rejections > 0 {
            continue;
        }
        let now = accuracy / made.error.energy;
        let factor = (0.9 * now.powf(3.0 / 16.0) / before.powf(1.0 / 8.0)).clamp(0.2, 5.0);
        assert!((method.dt() / (made.dt * factor) - 1.0).abs() <= allowed::ROOTS * allowed::U64);
    }
}

#[test]
fn of_order_3_a_first_step_asks_for_the_eighth_root_and_the_next_divides_by_a_sixteenth() {
    let data: SceneData = generate::cloth(5);
    let mut forces = build::Forces::<f64>::new(&data);
    let mut scene = build::scene::<f64>(&data);
    let memory = vec![[0.0; 3]; Rosenbrock3::<f64, ()>::needs(data.len())];
    let accuracy = 1e-8;
    let mut method = Adaptive::new(Rosenbrock3::new(1.0, memory).with(forces.all()), 0.001, accuracy);
    let mut before = 1.0;
    let mut judged = 0;
    for _ in 0..20 {
        scene.step(&mut method).unwrap();
        let made = method.made();
        let now = (accuracy / made.error.energy).clamp(1e-8, 1e8);
        let factor = (0.9 * now.powf(0.125) / f64::powf(before, 0.0625)).clamp(0.2, 5.0);
        assert!((method.dt() / (made.dt * factor) - 1.0).abs() <= allowed::ROOTS * allowed::U64, "{made:?}");
        judged += u32::from(factor > 0.2 && factor < 5.0);
        before = now;
    }
    assert!(judged >= 10, "{judged}");
}

#[test]
fn the_error_foretold_goes_with_the_fourth_or_the_sixth_power_of_the_length() {
    // J is far above the error, or below: the next length is another one.
    for share in [1e-3, 1e5] {
        let near = |probed: hooke::Probed<f64>, found: f64, power: i32| {
            let expected = found * (probed.dt / DT).powi(power);
            let off = (probed.energy / expected - 1.0).abs();
            assert!(probed.dt != DT && off <= 16.0 * allowed::U64, "{probed:?}, not {expected:e} J");
        };
        let memory = || vec![[0.0; 3]; 64];
        let found = error(Verlet::new(1.0), &mut swinging(), DT, 1.0).energy;
        let mut method = Adaptive::new(Verlet::new(1.0), DT, share * found);
        near(method.probe(&mut swinging(), &[]).unwrap(), found, 4);
        let first = error(Rosenbrock3::new(1.0, memory()), &mut swinging(), DT, 1e-12).energy;
        let found = error(Rosenbrock3::new(1.0, memory()), &mut swinging(), DT, share * first).energy;
        let mut method = Adaptive::new(Rosenbrock3::new(1.0, memory()), DT, share * first);
        near(method.probe(&mut swinging(), &[]).unwrap(), found, 6);
    }
}

#[test]
fn a_first_length_beyond_the_limit_is_tried_at_the_limit() {
    let ask = |dt: f64| Adaptive::new(Verlet::new(1.0), dt, 1e-3).probe(&mut swinging(), &[]).unwrap();
    let limit = Verlet::new(1.0).longest(&mut swinging().parts());
    assert!(limit > 0.0 && limit < 1e3);
    assert_eq!(ask(1e3), ask(limit));
    assert_ne!(ask(limit), ask(0.5 * limit));
}

#[test]
fn where_no_step_is_stable_none_is_tried() {
    // Springs whose stiffnesses have no finite sum.
    let mut scene = VecScene::<f64>::empty();
    for i in 0..4 {
        scene.particle([f64::from(i), 0.0, 0.0], 1.0).unwrap();
    }
    for i in 1..4 {
        scene.spring(0, i, f64::MAX).unwrap();
    }
    let mut method = Adaptive::new(Verlet::new(1.0), 1e-3, 1.0);
    assert_eq!(method.probe(&mut scene, &[]).unwrap_err(), StepError::Accuracy);
    assert_eq!(scene.step(&mut method).unwrap_err(), StepError::Accuracy);
}
