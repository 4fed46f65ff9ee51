//! Changes while the scene runs: each equals a scene that was built so.

use hooke::{LinearlyImplicitEuler, Spring};
use hooke_tests::build::{self, Forces};
use hooke_tests::data::SceneData;
use hooke_tests::generate;
use hooke_tests::vec_memory::VecScene;

/// Runs, edits scene and data alike, and then compares with a scene built from the edited data.
fn equals_a_scene_built_so(edit: impl Fn(&mut VecScene<f64>), of_data: impl Fn(&mut SceneData)) {
    let data = generate::gentle_network(8, 12);
    let mut scene = build::scene::<f64>(&data);
    for _ in 0..5 {
        scene.step(&mut Forces::<f64>::new(&data).euler(1.0 / 60.0)).unwrap();
    }
    let mut edited = data;
    build::read_back(&scene, &mut edited);
    edit(&mut scene);
    of_data(&mut edited);
    let mut built = build::scene::<f64>(&edited);
    assert_eq!(build::bits(&built), build::bits(&scene));
    let mut forces = Forces::<f64>::new(&edited);
    let mut euler = forces.euler(1.0 / 60.0);
    for _ in 0..10 {
        let (a, b) = (built.step(&mut euler).unwrap(), scene.step(&mut euler).unwrap());
        // A broken spring is skipped and counted; in a scene built without it there is nothing to count.
        assert_eq!((a.iterations, a.upper, a.lower), (b.iterations, b.upper, b.lower));
        assert_eq!(build::bits(&built), build::bits(&scene));
    }
}

fn free_particle() -> usize {
    let data = generate::gentle_network(8, 12);
    data.pinned.iter().position(|pinned| !pinned).unwrap()
}

#[test]
fn changing_stiffness_while_running_equals_a_scene_built_so_bit_for_bit() {
    equals_a_scene_built_so(|scene| scene.set_stiffness(3, 555.0).unwrap(), |data| data.springs[3].k = 555.0);
}

#[test]
fn changing_rest_length_while_running_equals_a_scene_built_so_bit_for_bit() {
    equals_a_scene_built_so(
        |scene| scene.set_rest_length(2, 0.625).unwrap(),
        |data| data.springs[2].l0 = 0.625,
    );
}

#[test]
fn changing_mass_while_running_equals_a_scene_built_so_bit_for_bit() {
    equals_a_scene_built_so(|scene| scene.set_mass(4, 3.5).unwrap(), |data| data.mass[4] = 3.5);
}

#[test]
fn changing_position_while_running_equals_a_scene_built_so_bit_for_bit() {
    let x = [0.1, 0.2, 0.3];
    equals_a_scene_built_so(|scene| scene.set_position(5, x).unwrap(), |data| data.position[5] = x);
}

#[test]
fn changing_velocity_while_running_equals_a_scene_built_so_bit_for_bit() {
    let (i, v) = (free_particle(), [1.0, -2.0, 0.5]);
    equals_a_scene_built_so(|scene| scene.set_velocity(i, v).unwrap(), |data| data.velocity[i] = v);
}

#[test]
fn adding_a_particle_and_a_spring_while_running_equals_a_scene_built_so_bit_for_bit() {
    let (x, k, l0) = ([0.5, 0.5, 0.5], 80.0, 0.75);
    equals_a_scene_built_so(
        |scene| {
            let i = scene.particle(x, 1.5).unwrap();
            scene.spring_with(i, 0, Spring { stiffness: k, rest_length: l0 }).unwrap();
        },
        |data| {
            let i = data.particle(x, 1.5);
            data.spring_with(i, 0, k, l0);
        },
    );
}

#[test]
fn breaking_a_spring_while_running_equals_a_scene_built_without_it_bit_for_bit() {
    let data = generate::rope(9);
    let mut scene = build::scene::<f64>(&data);
    let mut euler = LinearlyImplicitEuler::new(1.0 / 60.0).gravity(data.gravity);
    for _ in 0..5 {
        scene.step(&mut euler).unwrap();
    }
    let mut without = data;
    build::read_back(&scene, &mut without);
    scene.break_spring(4).unwrap();
    without.springs.remove(4);
    let mut built = build::scene::<f64>(&without);
    for _ in 0..10 {
        built.step(&mut euler).unwrap();
        scene.step(&mut euler).unwrap();
        assert_eq!(build::bits(&built), build::bits(&scene));
    }
}

#[test]
fn a_broken_spring_has_no_length_no_tension_no_energy_and_the_others_keep_their_indices() {
    let data = generate::gentle_network(9, 6);
    let mut scene = build::scene::<f64>(&data);
    let before = scene.springs().potential_energy();
    let (energy, kept) = (scene.springs().potential_energy_of(1), scene.springs().potential_energy_of(2));
    assert!(energy > 0.0);
    scene.break_spring(1).unwrap();
    let springs = scene.springs();
    assert_eq!(
        (springs.length_of(1), springs.tension_of(1), springs.potential_energy_of(1)),
        (None, 0.0, 0.0)
    );
    assert_eq!(springs.potential_energy_of(2), kept);
    assert!(
        (springs.potential_energy() + energy - before).abs() <= 32.0 * hooke_tests::allowed::U64 * before
    );
    assert_eq!((scene.state().ends(1), scene.springs().hessian_of(1)), (None, None));
    assert_eq!(scene.state().ends(2), Some((data.springs[2].a, data.springs[2].b)));
}

#[test]
fn an_impulse_changes_velocity_by_impulse_over_mass_bit_for_bit() {
    let mut scene = VecScene::<f64>::empty();
    let i = scene.particle([0.0; 3], 4.0).unwrap();
    scene.set_velocity(i, [1.0, 0.0, 0.0]).unwrap();
    scene.impulse(i, [2.0, -6.0, 1.0]).unwrap();
    assert_eq!(scene.velocities()[i], [1.5, -1.5, 0.25]);
}

#[test]
fn a_point_force_over_a_step_is_an_impulse_of_force_times_h_bit_for_bit() {
    let (mut pushed, mut kicked) = (VecScene::<f64>::empty(), VecScene::<f64>::empty());
    for scene in [&mut pushed, &mut kicked] {
        scene.particle([0.0; 3], 2.0).unwrap();
    }
    let force = hooke::PointForce { particle: 0, force: [4.0, 8.0, -16.0] };
    pushed.step(&mut LinearlyImplicitEuler::new(0.25).with(force)).unwrap();
    kicked.impulse(0, [1.0, 2.0, -4.0]).unwrap();
    kicked.step(&mut LinearlyImplicitEuler::new(0.25)).unwrap();
    assert_eq!(build::bits(&pushed), build::bits(&kicked));
}

#[test]
fn a_spring_as_placed_is_as_long_as_the_distance_and_pulls_nothing() {
    let mut scene = VecScene::<f32>::empty();
    scene.particle([0.1, 0.2, 0.3], 1.0).unwrap();
    scene.particle([1.7, -0.4, 2.2], 1.0).unwrap();
    let j = scene.spring(0, 1, 1e5).unwrap();
    assert_eq!(Some(scene.state().spring(j).rest_length), scene.springs().length_of(j));
    assert_eq!(scene.springs().tension_of(j), 0.0);
}
