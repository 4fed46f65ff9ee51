//! Block-Jacobi PCG in lanes: which registers it runs in touches no bit, and it solves what the plain one solves.

use hooke::{
    BlockJacobi, Dispatch, Hookean, Law, Mixed, Multigrid, Portable, Real, Report, Solver, Spring, StepError,
    WideJacobi,
};
use hooke_harness::host::Host;
use hooke_tests::build::{self, Forces};
use hooke_tests::data::{SceneData, distance};
use hooke_tests::vec_memory::VecScene;
use hooke_tests::{allowed, generate, lanes};

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
pub(crate) fn run<T: Real, L: Law, S: Solver<T>>(
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
pub(crate) fn cloth(n: usize) -> SceneData {
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

/// A mesh whose springs join particles at many distances, kicked, with the same in it as [`cloth`].
pub(crate) fn mesh(cells: usize) -> SceneData {
    let mut data = generate::blob(cells, 1);
    let middle = data.len() / 2;
    data.pinned[middle] = true;
    for (velocity, pinned) in data.velocity.iter_mut().zip(&data.pinned) {
        *velocity = if *pinned { [0.0; 3] } else { [5.0, 0.0, 0.0] };
    }
    data.drag = 0.1;
    for (j, spring) in data.springs.iter_mut().enumerate() {
        spring.c = (j % 3) as f64;
    }
    data.points.push(hooke_tests::data::PointData {
        particle: middle + 1,
        target: [0.3, 0.4, 0.1],
        k: 40.0,
        l0: 0.1,
    });
    data
}

fn the_same_bits_in_any_registers<T: Real>(data: &SceneData, r: f64) {
    let (mut one, mut other) = (scene::<T>(data), scene::<T>(data));
    let (mut portable, mut host) = (wide(&mut one, Portable), wide(&mut other, Host::new()));
    let found = run(data, &mut one, &mut portable, r, 20);
    assert!(portable.in_lanes() && found.1.clamped > 0 && found.1.iterations > 10, "{:?}", found.1);
    assert_eq!(run(data, &mut other, &mut host, r, 20), found);
}

#[test]
fn wider_instructions_give_the_same_bits() {
    for data in [cloth(16), mesh(6)] {
        the_same_bits_in_any_registers::<f64>(&data, 1e-8);
        the_same_bits_in_any_registers::<f32>(&data, 1e-4);
    }
}

#[test]
fn lanes_solve_what_the_plain_solver_solves() {
    [cloth(12), mesh(6)].iter().for_each(lanes_solve_what_the_plain_one_solves);
}

fn lanes_solve_what_the_plain_one_solves(data: &SceneData) {
    let (mut plain, mut lanes) = (scene::<f64>(data), scene::<f64>(data));
    let mut solver = wide(&mut lanes, Portable);
    let (_, expected) = run(data, &mut plain, &mut BlockJacobi, 1e-12, 15);
    let (_, found) = run(data, &mut lanes, &mut solver, 1e-12, 15);
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

fn lanes_give_the_plain_solvers_bits<T: Real, L: Law>(
    data: &SceneData,
    add: Add<T, L>,
    r: f64,
    steps: usize,
) -> u32 {
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
    let expected = run(data, &mut plain, &mut BlockJacobi, r, steps).0;
    let (found, report) = run(data, &mut lanes, &mut solver, r, steps);
    assert!(solver.in_lanes() && report.clamped > 0, "{report:?}");
    assert_eq!(found, expected);
    report.iterations
}

#[test]
fn where_springs_come_in_order_lanes_give_the_plain_solvers_bits() {
    let data = in_order(13);
    assert!(lanes_give_the_plain_solvers_bits::<f64, Hookean>(&data, springs_only, 1e-8, 20) > 10);
    assert!(lanes_give_the_plain_solvers_bits::<f32, Hookean>(&data, springs_only, 1e-4, 20) > 10);
    assert!(lanes_give_the_plain_solvers_bits::<f64, Mixed>(&data, every_third_a_cable, 1e-8, 20) > 10);
}

/// Two rails of n particles with rungs between them: springs at distances 1 and n, pressed to nine tenths of their lengths.
fn ladder(n: usize) -> SceneData {
    let mut data = SceneData { gravity: [0.0, -9.81, 0.0], ..SceneData::default() };
    for i in 0..2 * n {
        data.particle([0.1 * (i % n) as f64, 0.01 * (i % 7) as f64, 0.1 * (i / n) as f64], 0.01);
    }
    for i in 0..2 * n {
        let along = (i % n + 1 < n).then_some(i + 1);
        for other in along.into_iter().chain((i < n).then_some(i + n)) {
            data.spring_with(i, other, 100.0, distance(data.position[i], data.position[other]) / 0.9);
        }
    }
    data.pinned[2 * n - 1] = true;
    data
}

/// Springs are computed 1024 rows at a time, or as many as the farthest spring reaches over.
#[test]
fn nets_of_several_stretches_of_rows_have_the_plain_solvers_bits() {
    let mut sheet = in_order(48);
    sheet.springs.iter_mut().for_each(|spring| spring.l0 *= 1.1);
    for data in [sheet, ladder(700), ladder(1100), ladder(3000)] {
        assert!(lanes_give_the_plain_solvers_bits::<f64, Hookean>(&data, springs_only, 1e-6, 1) > 5);
        assert!(lanes_give_the_plain_solvers_bits::<f32, Hookean>(&data, springs_only, 1e-5, 1) > 5);
        assert!(lanes_give_the_plain_solvers_bits::<f64, Mixed>(&data, every_third_a_cable, 1e-6, 1) > 5);
    }
}

#[test]
fn lanes_around_multigrid_solve_what_it_solves_and_in_any_registers() {
    [cloth(16), mesh(6)].iter().for_each(lanes_around_multigrid);
}

fn lanes_around_multigrid(data: &SceneData) {
    let around = |scene: &mut VecScene<f64>, dispatch| {
        let (numbers, words) = Multigrid::needs(data.len(), data.springs.len());
        let multigrid = Multigrid::new(vec![0.0; numbers], vec![0; words], Portable);
        (wide(scene, dispatch).around(multigrid.clone()), multigrid)
    };
    let mut scenes = [scene::<f64>(data), scene(data), scene(data)];
    let [alone, portable, host] = &mut scenes;
    let (mut lanes, mut multigrid) = around(portable, Portable);
    let (numbers, words) = WideJacobi::needs_of(host, true);
    let mut wider =
        WideJacobi::new(vec![0.0; numbers], vec![0; words], Host::new()).around(multigrid.clone());
    let (_, expected) = run(data, alone, &mut multigrid, 1e-12, 15);
    let found = run(data, portable, &mut lanes, 1e-12, 15);
    assert!(lanes.in_lanes());
    assert_eq!(run(data, host, &mut wider, 1e-12, 15), found);
    assert_eq!((found.1.clamped, found.1.certified), (expected.clamped, expected.certified));
    assert!(build::farthest(&build::positions(alone), &build::positions(portable)) <= allowed::TRAJECTORY);
}

/// Sheets of rows, each tied to two of the next by permutations, the last to pins: springs at many distances, and every row
/// owns two and ends as many, so that slots keep the rows' order.
fn layered(sheets: usize, n: usize) -> SceneData {
    let mut data = SceneData { gravity: [0.0, -9.8, 0.0], ..SceneData::default() };
    for i in 0..(sheets + 1) * n {
        let (sheet, k) = (i / n, i % n);
        let angle = 7.0 * k as f64;
        data.particle([angle.sin(), -0.3 * sheet as f64, angle.cos()], 0.1 + 0.001 * k as f64);
    }
    for i in 0..sheets * n {
        let (next, k) = (i / n * n + n, i % n);
        for shift in [3, 10] {
            data.spring(i, next + (7 * k + shift) % n, 2000.0);
        }
    }
    data.pinned[sheets * n..].fill(true);
    for (j, spring) in data.springs.iter_mut().enumerate() {
        spring.c = 0.01 * (j % 3) as f64;
        spring.l0 *= 1.1;
    }
    data
}

fn slots_give_the_plain_solvers_bits<T: Real>(r: f64) {
    let data = layered(4, 41);
    let (mut plain, mut lanes) = (scene::<T>(&data), scene::<T>(&data));
    assert!(!WideJacobi::runs_of(&mut lanes));
    let mut solver = wide(&mut lanes, Host::new());
    let expected = run(&data, &mut plain, &mut BlockJacobi, r, 20);
    let found = run(&data, &mut lanes, &mut solver, r, 20);
    assert!(solver.in_lanes() && found.1.islands == 1 && found.1.iterations > 10, "{:?}", found.1);
    assert_eq!(found.0, expected.0);
}

#[test]
fn where_rows_come_in_the_order_of_the_slots_these_give_the_plain_solvers_bits() {
    slots_give_the_plain_solvers_bits::<f64>(1e-8);
    slots_give_the_plain_solvers_bits::<f32>(1e-4);
}

/// One particle that holds all others: slots for it would be mostly zeros.
pub(crate) fn star(n: usize) -> SceneData {
    let mut data = SceneData { gravity: [0.0, -9.8, 0.0], ..SceneData::default() };
    for i in 0..n {
        data.particle([i as f64 * 0.1, 0.0, (i * i) as f64 * 0.01], 0.1);
    }
    (1..n).for_each(|i| data.spring(0, i, 100.0));
    data.pinned[n - 1] = true;
    data
}

#[test]
fn springs_that_fill_neither_runs_nor_slots_are_left_to_the_plain_solver() {
    let data = star(40);
    let (mut plain, mut lanes) = (scene::<f64>(&data), scene::<f64>(&data));
    let mut solver = wide(&mut lanes, Portable);
    let expected = run(&data, &mut plain, &mut BlockJacobi, 1e-8, 5);
    assert_eq!(run(&data, &mut lanes, &mut solver, 1e-8, 5), expected);
    let mut single = lanes::single::<f64>(&data);
    assert_eq!(run(&data, &mut scene(&data), &mut single, 1e-8, 5), expected);
    assert!(!solver.in_lanes() && !single.in_lanes());
}

#[test]
fn after_a_change_of_pins_or_springs_the_layout_is_found_anew() {
    for (data, pin) in [(cloth(9), data_pin(9)), (mesh(6), mesh(6).len() / 2)] {
        the_layout_is_found_anew(&data, pin);
    }
}

fn the_layout_is_found_anew(data: &SceneData, pin: usize) {
    let mut scene = scene::<f64>(data);
    // Room for the changes to come.
    let mut kept = WideJacobi::new(vec![0.0; 100_000], vec![0; 10_000], Portable);
    type Change<'c> = &'c dyn Fn(&mut VecScene<f64>);
    let changes: [Change<'_>; 4] =
        [&|_| {}, &|scene| scene.break_spring(40).unwrap(), &|scene| scene.pin(30).unwrap(), &|scene| {
            scene.release(pin).unwrap()
        }];
    let mut made: Vec<Change<'_>> = Vec::new();
    for change in changes {
        change(&mut scene);
        made.push(change);
        let mut copy = self::scene::<f64>(data);
        made.iter().for_each(|change| change(&mut copy));
        for i in 0..data.len() {
            copy.set_position(i, scene.positions()[i]).unwrap();
            if !copy.is_pinned(i) {
                copy.set_velocity(i, scene.velocities()[i]).unwrap();
            }
        }
        let mut solver = wide(&mut copy, Portable);
        let expected = run(data, &mut copy, &mut solver, 1e-8, 3);
        assert_eq!(run(data, &mut scene, &mut kept, 1e-8, 3), expected);
        assert!(kept.in_lanes() && solver.in_lanes());
    }
}

/// A pin in the midst of [`cloth`].
fn data_pin(n: usize) -> usize {
    n * n / 2
}

#[test]
fn too_little_workspace_is_an_error_that_says_how_much_is_needed_and_changes_nothing() {
    [cloth(9), mesh(6)].iter().for_each(too_little_workspace_is_an_error);
}

fn too_little_workspace_is_an_error(data: &SceneData) {
    let mut scene = scene::<f64>(data);
    let needs = WideJacobi::needs_of(&mut scene, true);
    let before = build::bits(&scene);
    let mut forces = Forces::new(data);
    let small = WideJacobi::new(vec![0.0; needs.0 - 1], vec![0; needs.1], Portable);
    let error = scene.step(&mut forces.euler(0.01).solver(small)).unwrap_err();
    assert_eq!(error, StepError::Workspace { numbers: needs.0, words: needs.1 });
    assert_eq!(build::bits(&scene), before);
    let small = WideJacobi::new(vec![0.0; needs.0], vec![0; needs.1 - 1], Portable);
    let error = scene.step(&mut forces.euler(0.01).solver(small)).unwrap_err();
    assert_eq!(error, StepError::Workspace { numbers: needs.0, words: needs.1 });
    let enough = WideJacobi::new(vec![0.0; needs.0], vec![0; needs.1], Portable);
    scene.step(&mut forces.euler(0.01).solver(enough)).unwrap();
}
