//! Pins: fixed, moving, put on and released while the scene runs.

use hooke::{LinearlyImplicitEuler, Motion, Real};
use hooke_tests::build::{self, Forces};
use hooke_tests::generate;

fn fixed_pins_never_move<T: Real>() {
    let data = generate::gentle_network(3, 12);
    let mut scene = build::scene::<T>(&data);
    let mut forces = Forces::<T>::new(&data);
    let before = build::bits(&scene);
    let mut euler = forces.euler(T::from_f64(1.0 / 60.0));
    for _ in 0..50 {
        scene.step(&mut euler).unwrap();
    }
    let after = build::bits(&scene);
    assert!(data.pinned.contains(&true) && data.pinned.contains(&false));
    for (i, pinned) in data.pinned.iter().enumerate() {
        assert_eq!(before[i] == after[i], *pinned, "particle {i}");
        assert_eq!(scene.is_pinned(i), *pinned);
    }
}

#[test]
fn fixed_particles_never_move_bit_for_bit() {
    fixed_pins_never_move::<f64>();
    fixed_pins_never_move::<f32>();
}

#[test]
fn a_moving_pin_reaches_its_end_and_has_its_end_velocity_bit_for_bit() {
    let data = generate::rope(6);
    let mut scene = build::scene::<f64>(&data);
    let mut euler = LinearlyImplicitEuler::new(1.0 / 60.0).gravity(data.gravity);
    for n in 1..=30 {
        let t = f64::from(n) / 60.0;
        let motion = Motion {
            particle: 0,
            position: [0.3 * t.sin(), 0.1 * t, t * t],
            velocity: [0.3 * t.cos(), 0.1, 2.0 * t],
        };
        scene.step_moving(&mut euler, &[motion]).unwrap();
        assert_eq!((scene.positions()[0], scene.velocities()[0]), (motion.position, motion.velocity));
    }
    // A step that is told nothing finds the pin at rest.
    let at = scene.positions()[0];
    scene.step(&mut euler).unwrap();
    assert_eq!((scene.positions()[0], scene.velocities()[0]), (at, [0.0; 3]));
}

#[test]
fn a_scene_whose_pins_all_move_as_one_with_it_is_not_strained_bit_for_bit() {
    // p = (b⁺ − b)/h is the velocity that the free particles have already; dyadic, so nothing rounds.
    let (h, v) = (1.0 / 64.0, [0.5, -1.0, 0.25]);
    let mut scene = hooke_tests::vec_memory::VecScene::<f64>::empty();
    for x in 0..4 {
        let i = scene.particle([f64::from(x) * 0.25, 0.0, 0.0], 0.1).unwrap();
        scene.set_velocity(i, v).unwrap();
    }
    for i in 1..4 {
        scene.spring(i - 1, i, 1e4).unwrap();
    }
    scene.pin(0).unwrap();
    let mut euler = LinearlyImplicitEuler::new(h);
    for n in 1..=32 {
        let t = f64::from(n) * h;
        let position = v.map(|v| v * t);
        let report = scene.step_moving(&mut euler, &[Motion { particle: 0, position, velocity: v }]).unwrap();
        assert_eq!(report.iterations, 0);
        assert_eq!(scene.positions()[3], [0.75 + position[0], position[1], position[2]]);
        assert_eq!(scene.velocities(), [v; 4]);
    }
}

#[test]
fn a_released_pin_goes_on_with_the_velocity_it_had_as_a_pin() {
    let mut scene = hooke_tests::vec_memory::VecScene::<f64>::empty();
    let i = scene.particle([0.0; 3], 1.0).unwrap();
    scene.pin(i).unwrap();
    let mut euler = LinearlyImplicitEuler::new(0.5);
    let motion = Motion { particle: i, position: [1.0, 0.0, 0.0], velocity: [3.0, 2.0, 1.0] };
    scene.step_moving(&mut euler, &[motion]).unwrap();
    scene.release(i).unwrap();
    scene.step(&mut euler).unwrap();
    assert_eq!((scene.positions()[i], scene.velocities()[i]), ([2.5, 1.0, 0.5], [3.0, 2.0, 1.0]));
}

#[test]
fn pinning_and_releasing_while_running_equals_a_scene_built_so_bit_for_bit() {
    let data = generate::gentle_network(5, 12);
    let mut scene = build::scene::<f64>(&data);
    let mut forces = Forces::<f64>::new(&data);
    let mut euler = forces.euler(1.0 / 60.0);
    let (mut now, toggled) = (data.clone(), [1, 4, 4, 7, 1]);
    for i in toggled {
        for _ in 0..5 {
            scene.step(&mut euler).unwrap();
        }
        if scene.is_pinned(i) {
            scene.release(i).unwrap()
        } else {
            scene.pin(i).unwrap()
        }
        build::read_back(&scene, &mut now);
        now.pinned[i] = !now.pinned[i];
        let mut built = build::scene::<f64>(&now);
        assert_eq!(build::bits(&built), build::bits(&scene));
        for _ in 0..5 {
            assert_eq!(built.step(&mut euler), scene.step(&mut euler));
            assert_eq!(build::bits(&built), build::bits(&scene));
        }
    }
}

#[test]
fn pinning_twice_is_pinning_once() {
    let data = generate::rope(5);
    let (mut once, mut twice) = (build::scene::<f64>(&data), build::scene::<f64>(&data));
    once.pin(3).unwrap();
    twice.pin(3).unwrap();
    twice.pin(3).unwrap();
    let mut euler = LinearlyImplicitEuler::new(1.0 / 60.0).gravity(data.gravity);
    assert_eq!(once.step(&mut euler), twice.step(&mut euler));
    assert_eq!(build::bits(&once), build::bits(&twice));
}

#[test]
fn a_particle_that_is_pinned_stops_at_once_and_rests_when_released() {
    let mut scene = hooke_tests::vec_memory::VecScene::<f64>::empty();
    let i = scene.particle([1.0, 2.0, 3.0], 1.0).unwrap();
    scene.set_velocity(i, [4.0, 5.0, 6.0]).unwrap();
    scene.pin(i).unwrap();
    assert_eq!(scene.velocities()[i], [0.0; 3]);
    scene.release(i).unwrap();
    scene.step(&mut LinearlyImplicitEuler::new(0.5)).unwrap();
    assert_eq!((scene.positions()[i], scene.velocities()[i]), ([1.0, 2.0, 3.0], [0.0; 3]));
}
