//! Block-Jacobi PCG in lanes: which registers it runs in touches no bit, and it solves what the plain one solves.

use hooke::{
    BlockJacobi, Dispatch, Hookean, Law, Mixed, Multigrid, Portable, Real, Report, Solver, Spring, StepError,
    WideJacobi,
};
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
    let (numbers, words) = WideJacobi::needs_of(scene, true);
    // What lies in the workspace before does not matter.
    WideJacobi::new(vec![T::ONE; numbers], vec![7; words], dispatch)
}

/// Bits of the scene and the report after some steps.
fn run<T: Real, L: Law, S: Solver<T>>(
    data: &SceneData,
    scene: &mut VecScene<T, L>,
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

/// A sheet whose springs come in the order of their rows and other ends, with a pin at the end of the numbering only: its
/// places are its rows.
fn in_order(n: usize) -> SceneData {
    let mut data = generate::cloth(n);
    data.pinned.fill(false);
    data.pinned[n * n - 1] = true;
    data.springs.sort_by_key(|s| (s.a.min(s.b), s.a.max(s.b)));
    for (j, spring) in data.springs.iter_mut().enumerate() {
        spring.c = 0.01 * (j % 3) as f64;
        // Without length, with a rest length.
        if j == 70 {
            data.position[spring.b] = data.position[spring.a];
        }
    }
    data
}

/// Adds spring j.
type Add<T, L> = fn(&mut VecScene<T, L>, usize, [usize; 2], Spring<T>);

fn springs_only<T: Real, L: Law>(
    scene: &mut VecScene<T, L>,
    _: usize,
    [a, b]: [usize; 2],
    spring: Spring<T>,
) {
    scene.spring_with(a, b, spring).unwrap();
}

fn every_third_a_cable(scene: &mut VecScene<f64, Mixed>, j: usize, [a, b]: [usize; 2], spring: Spring<f64>) {
    let add = if j.is_multiple_of(3) { VecScene::cable } else { VecScene::spring_with };
    add(scene, a, b, spring).unwrap();
}

fn lanes_give_the_plain_solvers_bits<T: Real, L: Law>(add: Add<T, L>, r: f64) {
    let data = in_order(13);
    let build = || {
        let mut scene = VecScene::<T, L>::empty();
        for i in 0..data.len() {
            scene.particle(build::real3(data.position[i]), T::from_f64(data.mass[i])).unwrap();
        }
        for (j, s) in data.springs.iter().enumerate() {
            let spring = Spring { stiffness: T::from_f64(s.k), rest_length: T::from_f64(s.l0) };
            add(&mut scene, j, [s.a, s.b], spring);
        }
        scene.pin(data.len() - 1).unwrap();
        scene
    };
    let (mut plain, mut lanes) = (build(), build());
    let (numbers, words) = WideJacobi::needs_of(&mut lanes, true);
    let mut solver = WideJacobi::new(vec![T::ONE; numbers], vec![7; words], Host::new());
    let expected = run(&data, &mut plain, &mut BlockJacobi, r, 20).0;
    let (found, report) = run(&data, &mut lanes, &mut solver, r, 20);
    assert!(solver.in_lanes() && report.clamped > 0 && report.iterations > 10, "{report:?}");
    assert_eq!(found, expected);
}

#[test]
fn where_springs_come_in_order_lanes_give_the_plain_solvers_bits() {
    lanes_give_the_plain_solvers_bits::<f64, Hookean>(springs_only, 1e-8);
    lanes_give_the_plain_solvers_bits::<f32, Hookean>(springs_only, 1e-4);
    lanes_give_the_plain_solvers_bits::<f64, Mixed>(every_third_a_cable, 1e-8);
}

#[test]
fn lanes_around_multigrid_solve_what_it_solves_and_in_any_registers() {
    let data = cloth(16);
    let around = |scene: &mut VecScene<f64>, dispatch| {
        let (numbers, words) = Multigrid::needs(data.len(), data.springs.len());
        let multigrid = Multigrid::new(vec![0.0; numbers], vec![0; words], Portable);
        (wide(scene, dispatch).around(multigrid.clone()), multigrid)
    };
    let mut scenes = [scene::<f64>(&data), scene(&data), scene(&data)];
    let [alone, portable, host] = &mut scenes;
    let (mut lanes, mut multigrid) = around(portable, Portable);
    let (numbers, words) = WideJacobi::needs_of(host, true);
    let mut wider =
        WideJacobi::new(vec![0.0; numbers], vec![0; words], Host::new()).around(multigrid.clone());
    let (_, expected) = run(&data, alone, &mut multigrid, 1e-12, 15);
    let found = run(&data, portable, &mut lanes, 1e-12, 15);
    assert!(lanes.in_lanes());
    assert_eq!(run(&data, host, &mut wider, 1e-12, 15), found);
    assert_eq!((found.1.clamped, found.1.certified), (expected.clamped, expected.certified));
    assert!(build::farthest(&build::positions(alone), &build::positions(portable)) <= allowed::TRAJECTORY);
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
    let needs = WideJacobi::needs_of(&mut scene, true);
    let before = build::bits(&scene);
    let mut forces = Forces::new(&data);
    let small = WideJacobi::new(vec![0.0; needs.0 - 1], vec![0; needs.1], Portable);
    let error = scene.step(&mut forces.euler(0.01).solver(small)).unwrap_err();
    assert_eq!(error, StepError::Workspace { numbers: needs.0, words: needs.1 });
    assert_eq!(build::bits(&scene), before);
    let enough = WideJacobi::new(vec![0.0; needs.0], vec![0; needs.1], Portable);
    scene.step(&mut forces.euler(0.01).solver(enough)).unwrap();
}
