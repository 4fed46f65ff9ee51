//! Block-Jacobi PCG in lanes: which registers it runs in touches no bit, and it solves what the plain one solves.

use hooke::{BlockJacobi, Dispatch, Portable, Real, Report, Solver, StepError, WideJacobi};
use hooke_harness::host::Host;
use hooke_tests::build::{self, Forces};
use hooke_tests::data::SceneData;
use hooke_tests::vec_memory::VecScene;
use hooke_tests::{allowed, generate};

type Wide<T, D = Portable> = WideJacobi<Vec<T>, Vec<u32>, D>;

fn scene<T: Real>(data: &SceneData) -> VecScene<T> {
    let mut scene = VecScene::empty();
    build::fill(&mut scene, data).unwrap();
    scene
}

/// The solver with just the workspace that the scene needs.
fn wide<T: Real, D: Dispatch>(scene: &mut VecScene<T>, dispatch: D) -> Wide<T, D> {
    let (numbers, words) = WideJacobi::needs_of(scene, &mut vec![0; scene.state().springs()]);
    // What lies in the workspace before does not matter.
    WideJacobi::new(vec![T::ONE; numbers], vec![7; words], dispatch)
}

/// Bits of the scene and the report after some steps.
fn run<T: Real, S: Solver<T>>(
    data: &SceneData,
    scene: &mut VecScene<T>,
    solver: &mut S,
    r: f64,
    steps: usize,
) -> (Vec<[u64; 6]>, Report<T>) {
    let mut forces = Forces::<T>::new(data);
    let mut euler = forces.euler(T::from_f64(1.0 / 60.0)).tolerance(T::from_f64(r)).solver(solver);
    let mut last = None;
    for _ in 0..steps {
        last = Some(scene.step(&mut euler).unwrap());
    }
    (build::bits(scene), last.unwrap())
}

/// A cloth with pins in its midst, a point spring, drag and damping.
fn cloth(n: usize) -> SceneData {
    let mut data = generate::cloth(n);
    for i in [n / 2, data_pin(n), data_pin(n) + 1] {
        data.pinned[i] = true;
        data.velocity[i] = [0.0; 3];
    }
    data.drag = 0.1;
    for (j, spring) in data.springs.iter_mut().enumerate() {
        spring.c = 0.01 * (j % 3) as f64;
    }
    data.points.push(hooke_tests::data::PointData {
        particle: n + 1,
        target: [0.3, 0.4, 0.1],
        k: 40.0,
        l0: 0.1,
    });
    data
}

fn the_same_bits_in_any_registers<T: Real>(r: f64) {
    let data = cloth(16);
    let (mut one, mut other) = (scene::<T>(&data), scene::<T>(&data));
    let (mut portable, mut host) = (wide(&mut one, Portable), wide(&mut other, Host::new()));
    let found = run(&data, &mut one, &mut portable, r, 20);
    assert!(portable.in_lanes() && found.1.clamped > 0 && found.1.iterations > 10, "{:?}", found.1);
    assert_eq!(run(&data, &mut other, &mut host, r, 20), found);
}

#[test]
fn wider_instructions_give_the_same_bits() {
    the_same_bits_in_any_registers::<f64>(1e-8);
    the_same_bits_in_any_registers::<f32>(1e-4);
}

#[test]
fn lanes_solve_what_the_plain_solver_solves() {
    let data = cloth(12);
    let (mut plain, mut lanes) = (scene::<f64>(&data), scene::<f64>(&data));
    let mut solver = wide(&mut lanes, Portable);
    let (_, expected) = run(&data, &mut plain, &mut BlockJacobi, 1e-12, 15);
    let (_, found) = run(&data, &mut lanes, &mut solver, 1e-12, 15);
    assert!(solver.in_lanes());
    assert_eq!((found.clamped, found.certified), (expected.clamped, expected.certified));
    for (a, b) in plain.positions().iter().zip(lanes.positions()) {
        for (a, b) in a.iter().zip(b) {
            assert!((a - b).abs() <= allowed::TRAJECTORY, "{a} {b}");
        }
    }
}

#[test]
fn springs_at_too_many_distances_are_left_to_the_plain_solver() {
    let data = generate::blob(3, 1);
    let (mut plain, mut lanes) = (scene::<f64>(&data), scene::<f64>(&data));
    let mut solver = wide(&mut lanes, Portable);
    let expected = run(&data, &mut plain, &mut BlockJacobi, 1e-8, 5);
    assert_eq!(run(&data, &mut lanes, &mut solver, 1e-8, 5), expected);
    assert!(!solver.in_lanes());
}

#[test]
fn after_a_change_of_pins_or_springs_the_layout_is_found_anew() {
    let data = cloth(9);
    let mut scene = scene::<f64>(&data);
    // Room for the changes to come.
    let mut kept = WideJacobi::new(vec![0.0; 100_000], vec![0; 10_000], Portable);
    type Change = fn(&mut VecScene<f64>);
    let changes: [Change; 4] = [
        |_| {},
        |scene| scene.break_spring(40).unwrap(),
        |scene| scene.pin(30).unwrap(),
        |scene| scene.release(data_pin(9)).unwrap(),
    ];
    let mut made: Vec<Change> = Vec::new();
    for change in changes {
        change(&mut scene);
        made.push(change);
        let mut copy = self::scene::<f64>(&data);
        made.iter().for_each(|change| change(&mut copy));
        for i in 0..data.len() {
            copy.set_position(i, scene.positions()[i]).unwrap();
            if !copy.is_pinned(i) {
                copy.set_velocity(i, scene.velocities()[i]).unwrap();
            }
        }
        let mut solver = wide(&mut copy, Portable);
        let expected = run(&data, &mut copy, &mut solver, 1e-8, 3);
        assert_eq!(run(&data, &mut scene, &mut kept, 1e-8, 3), expected);
        assert!(kept.in_lanes() && solver.in_lanes());
    }
}

/// A pin in the midst of [`cloth`].
fn data_pin(n: usize) -> usize {
    n * n / 2
}

#[test]
fn too_little_workspace_is_an_error_that_says_how_much_is_needed_and_changes_nothing() {
    let data = cloth(9);
    let mut scene = scene::<f64>(&data);
    let needs = WideJacobi::needs_of(&mut scene, &mut vec![0; data.springs.len()]);
    let before = build::bits(&scene);
    let mut forces = Forces::new(&data);
    let small = WideJacobi::new(vec![0.0; needs.0 - 1], vec![0; needs.1], Portable);
    let error = scene.step(&mut forces.euler(0.01).solver(small)).unwrap_err();
    assert_eq!(error, StepError::Workspace { numbers: needs.0, words: needs.1 });
    assert_eq!(build::bits(&scene), before);
    let enough = WideJacobi::new(vec![0.0; needs.0], vec![0; needs.1], Portable);
    scene.step(&mut forces.euler(0.01).solver(enough)).unwrap();
}
