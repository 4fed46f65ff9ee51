//! Steps of a chosen length while pins move: what a step leaves, rejected, refused or taken, and what ends it.

use hooke::{Adaptive, Course, EditError, Embedded, Motion, Rosenbrock2, Rosenbrock3, StepError, Verlet};
use hooke_tests::build::{self, Forces};
use hooke_tests::generate;
use hooke_tests::methods::options;

use super::moving_pins::{SPAN, end, memory, scene};
use super::orders::cloth;

#[test]
fn a_step_after_rejections_is_the_step_of_its_length_bit_for_bit_so_they_left_no_trace() {
    let data = cloth(true);
    let mut forces = Forces::<f64>::new(&data);
    let motion = [end(&data, 0)];
    let course = Course { motion: &motion, over: SPAN };
    let mut seen = 0;
    for accuracy in [1e-7, 1e-9, 1e-11] {
        let mut tried = scene::<f64>(&data);
        let method = Rosenbrock3::new(1.0, memory(&data)).with(forces.all());
        let mut method = Adaptive::new(method, SPAN, accuracy);
        method.end_after(SPAN);
        tried.step_moving(&mut method, &motion).unwrap();
        let (dt, rejections) = (method.made().dt, method.made().rejections);
        seen += rejections;
        let mut at_once = scene::<f64>(&data);
        let mut plain = Rosenbrock3::new(1.0, memory(&data)).with(forces.all());
        plain.attempt(&mut at_once.parts(), dt, course, accuracy / 4096.0, &mut |_| {}).unwrap();
        plain.accept(at_once.parts(), course).unwrap();
        assert_eq!(build::bits(&tried), build::bits(&at_once), "{accuracy:e} J, {dt} s");
    }
    assert!(seen >= 3, "{seen} rejections");
}

#[test]
fn what_is_refused_while_pins_move_leaves_the_scene_and_its_pins_as_they_were() {
    let data = cloth(true);
    let refused = |accuracy: f64, over: f64, motion: Motion<f64>| {
        let [first, second] = [true, false].map(|explicit| {
            let mut forces = Forces::<f64>::new(&data);
            let mut scene = scene::<f64>(&data);
            let before = build::bits(&scene);
            macro_rules! step {
                ($method:expr) => {{
                    let mut method = Adaptive::new($method.with(forces.all()), SPAN, accuracy);
                    method.end_after(over);
                    scene.step_moving(&mut method, &[motion])
                }};
            }
            let made =
                if explicit { step!(Verlet::new(1.0)) } else { step!(Rosenbrock3::new(1.0, memory(&data))) };
            assert_eq!(build::bits(&scene), before);
            made.unwrap_err()
        });
        assert_eq!(first, second);
        first
    };
    let motion = end(&data, 0);
    assert_eq!(refused(1e-40, SPAN, motion), StepError::Accuracy);
    // A motion has no length without an end.
    for over in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(refused(1e-6, over, motion), StepError::Motion(0));
    }
    assert_eq!(refused(1e-6, SPAN, Motion { particle: 9, ..motion }), StepError::NotPinned(9));
    assert_eq!(refused(1e-6, SPAN, Motion { velocity: [f64::NAN; 3], ..motion }), StepError::Motion(0));
}

#[test]
fn in_single_precision_too_a_pin_ends_exactly_where_it_is_told() {
    let data = cloth(true);
    let mut forces = Forces::<f32>::new(&data);
    let mut scene = scene::<f32>(&data);
    let real = |x: [f64; 3]| x.map(|x| x as f32);
    let motion = Motion { particle: 0, position: real(end(&data, 0).position), velocity: [0.25, 0.5, 1.0] };
    let memory = vec![[f32::NAN; 3]; Rosenbrock3::<f32, ()>::needs(data.len())];
    let method = Rosenbrock3::new(1.0, memory).with(forces.all());
    let mut method = Adaptive::new(method, SPAN as f32, 1e-6);
    let (mut left, mut steps) = (SPAN as f32, 0);
    while left > 0.0 {
        method.end_after(left);
        scene.step_moving(&mut method, &[motion]).unwrap();
        (left, steps) = (left - method.made().dt, steps + 1);
    }
    assert!(steps > 1);
    assert_eq!((scene.positions()[0], scene.velocities()[0]), (motion.position, motion.velocity));
}

#[test]
fn the_velocity_of_a_pin_is_refused_where_there_is_none_and_moves_nothing() {
    let data = generate::rope(4);
    let mut scene = build::scene::<f64>(&data);
    let before = build::bits(&scene);
    assert_eq!(scene.set_pin_velocity(4, [0.0; 3]), Err(EditError::NoParticle(4)));
    assert_eq!(scene.set_pin_velocity(1, [0.0; 3]), Err(EditError::NotPinned(1)));
    assert_eq!(scene.set_pin_velocity(0, [0.0, f64::INFINITY, 0.0]), Err(EditError::NotFinite(0)));
    assert_eq!(build::bits(&scene), before);
    // Without a motion the pin rests, whatever it was told: the same bits after a step.
    for method in hooke_tests::methods::ALL {
        let (mut told, mut untold) = (build::scene::<f64>(&data), build::scene::<f64>(&data));
        told.set_pin_velocity(0, [1.0, 2.0, 3.0]).unwrap();
        for scene in [&mut told, &mut untold] {
            let mut forces = Forces::<f64>::new(&data);
            method.step(scene, options(1e-3, 1e-9), forces.all(), &[]).unwrap();
        }
        assert_eq!(build::bits(&told), build::bits(&untold), "{method:?}");
    }
}

#[test]
fn a_probe_goes_no_farther_than_the_motion_is_known_and_leaves_the_scene_as_it_was() {
    let data = cloth(true);
    let mut forces = Forces::<f64>::new(&data);
    let mut scene = scene::<f64>(&data);
    let (before, motion) = (build::bits(&scene), [end(&data, 0)]);
    let method = Rosenbrock2::new(1.0, memory(&data)).with(forces.all());
    let mut method = Adaptive::new(method, 1.0, 1e-6);
    assert_eq!(method.probe(&mut scene, &motion).unwrap_err(), StepError::Motion(0));
    method.end_after(SPAN / 1024.0);
    let probed = method.probe(&mut scene, &motion).unwrap();
    assert!(probed.settled, "there is no longer one to try");
    // What it asks for may be longer than that, within its twentyfold.
    let asked = method.dt();
    assert_eq!(asked, probed.dt);
    assert!(asked > SPAN / 1024.0 && asked <= 20.0 * SPAN / 1024.0, "{asked}");
    assert_eq!(build::bits(&scene), before);
}

#[test]
fn a_pin_that_would_leave_the_numbers_on_its_way_is_refused_also_where_nothing_hangs_on_it() {
    let mut data = generate::rope(2);
    data.springs.clear();
    let motion = [Motion { particle: 0, position: [1.0; 3], velocity: [1e306; 3] }];
    for explicit in [true, false] {
        let mut scene = build::scene::<f64>(&data);
        let before = build::bits(&scene);
        macro_rules! step {
            ($method:expr) => {{
                let mut method = Adaptive::new($method, 1.0, 1e-6);
                method.end_after(1e3);
                scene.step_moving(&mut method, &motion)
            }};
        }
        let made =
            if explicit { step!(Verlet::new(1.0)) } else { step!(Rosenbrock3::new(1.0, memory(&data))) };
        assert_eq!(made, Err(StepError::Motion(0)));
        assert_eq!(build::bits(&scene), before);
    }
}
