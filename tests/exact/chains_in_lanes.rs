//! Chains factored in lanes: which registers they run in touches no bit, and they solve what the scalar solver solves.

use hooke::{
    BandedLdl, BlockJacobi, Dispatch, Ending, IslandReport, Portable, Real, Report, Solver, StepError, Wide,
};
use hooke_harness::host::Host;
use hooke_tests::build::{self, Forces};
use hooke_tests::data::{PointData, SceneData};
use hooke_tests::vec_memory::VecScene;
use hooke_tests::{allowed, direct, generate};

const H: f64 = 1.0 / 60.0;

type Lanes<T, D> = Wide<Vec<T>, Vec<u32>, D, BandedLdl<Vec<T>>>;

/// The solver with just the workspace that the scene needs; what lies in it before does not matter.
fn lanes<T: Real, D: Dispatch>(scene: &mut VecScene<T>, dispatch: D) -> Lanes<T, D> {
    let (own, (numbers, words)) = BandedLdl::needs_in_lanes_of(scene, true);
    let nan = T::from_f64(f64::NAN);
    Wide::new(vec![nan; numbers], vec![7; words], dispatch).around(BandedLdl::new(vec![nan; own]))
}

fn run<T: Real>(
    data: &SceneData,
    scene: &mut VecScene<T>,
    solver: &mut impl Solver<T>,
    relative: f64,
    steps: usize,
) -> (Vec<[u64; 6]>, Report<T>, Vec<IslandReport<T>>) {
    let mut forces = Forces::<T>::new(data);
    let mut euler = forces.euler(T::from_f64(H)).tolerance(T::from_f64(relative)).solver(solver);
    let (mut last, mut islands) = (None, Vec::new());
    for _ in 0..steps {
        islands.clear();
        last = Some(scene.step_watched(&mut euler, &[], |island| islands.push(*island)).unwrap());
    }
    (build::bits(scene), last.unwrap(), islands)
}

/// A chain with damping, drag and springs to two points.
fn held(n: usize) -> SceneData {
    let mut data = generate::chain(n);
    data.drag = 0.1;
    for (j, spring) in data.springs.iter_mut().enumerate() {
        spring.c = 0.01 * (j % 3) as f64;
    }
    for particle in [n / 3, n - 2] {
        data.points.push(PointData { particle, target: [0.3, 0.4, 0.1], k: 40.0, l0: 0.1 });
    }
    data
}

/// Chains of many lengths, held and pinned in many ways.
fn chains() -> Vec<SceneData> {
    let mut all: Vec<_> = [64, 65, 71, 72, 127, 200].map(generate::chain).into();
    all.push(held(100));
    let mut pins = generate::chain(300);
    // Islands of which some are long enough for lanes, some not; one ends at a pin on either side.
    for i in [0, 20, 110, 299] {
        pins.pinned[i] = true;
        pins.velocity[i] = [0.0; 3];
    }
    all.push(pins);
    let mut free = generate::chain(90);
    free.pinned.fill(false);
    all.push(free);
    all
}

fn the_same_bits_in_any_registers<T: Real>(relative: f64) {
    for data in chains() {
        let (mut one, mut other) = (build::scene::<T>(&data), build::scene::<T>(&data));
        let (mut portable, mut host) = (lanes(&mut one, Portable), lanes(&mut other, Host::new()));
        let found = run(&data, &mut one, &mut portable, relative, 10);
        assert!(portable.in_lanes(), "{} particles", data.len());
        assert_eq!(run(&data, &mut other, &mut host, relative, 10), found);
    }
}

#[test]
fn wider_instructions_give_the_same_bits() {
    the_same_bits_in_any_registers::<f64>(1e-10);
    the_same_bits_in_any_registers::<f32>(1e-4);
}

#[test]
fn lanes_solve_what_the_scalar_solver_solves() {
    // Five steps: the chain held at points is crumpled, and after fifteen the scalar banded and sparse solvers are 3e-11 m apart.
    for data in chains() {
        let (mut plain, mut wide) = (build::scene::<f64>(&data), build::scene::<f64>(&data));
        let mut solver = lanes(&mut wide, Host::new());
        let (_, expected, _) = run(&data, &mut plain, &mut direct::banded(&data), 1e-12, 5);
        let (_, found, _) = run(&data, &mut wide, &mut solver, 1e-12, 5);
        assert!(solver.in_lanes());
        assert_eq!(found.fallbacks, 0);
        assert_eq!((found.clamped, found.certified), (expected.clamped, expected.certified));
        assert!(found.lower <= found.upper && found.upper < 1e-15, "{found:?}");
        let far = build::farthest(&build::positions(&plain), &build::positions(&wide));
        assert!(far <= allowed::TRAJECTORY, "{} particles: {far}", data.len());
    }
}

#[test]
fn twelve_digits_take_two_solves_at_most_or_end_at_the_floor() {
    for data in chains() {
        let mut scene = build::scene::<f64>(&data);
        let mut solver = lanes(&mut scene, Host::new());
        for _ in 0..10 {
            let (_, report, islands) = run(&data, &mut scene, &mut solver, 1e-12, 1);
            assert_eq!(report.fallbacks, 0);
            let ends = |end| matches!(end, Ending::Converged | Ending::Floor | Ending::Untouched);
            let well = |island: &IslandReport<f64>| ends(island.solve.ending) && island.solve.iterations <= 2;
            assert!(islands.iter().all(well), "{islands:?}");
        }
        let mut single = build::scene::<f32>(&data);
        let mut solver = lanes(&mut single, Host::new());
        let (_, report, islands) = run(&data, &mut single, &mut solver, 1e-12, 5);
        assert_eq!(report.fallbacks, 0);
        assert!(islands.iter().all(|island| island.solve.ending == Ending::Floor), "{islands:?}");
    }
}

#[test]
fn short_chains_and_nets_are_left_to_the_scalar_solver_bit_by_bit() {
    for data in [generate::chain(56), generate::cloth(9)] {
        let (mut plain, mut wide) = (build::scene::<f64>(&data), build::scene::<f64>(&data));
        let mut solver = lanes(&mut wide, Host::new());
        let expected = run(&data, &mut plain, &mut direct::banded(&data), 1e-6, 5);
        assert_eq!(run(&data, &mut wide, &mut solver, 1e-6, 5), expected);
        assert!(!solver.in_lanes());
        assert_eq!(BandedLdl::needs_in_lanes_of(&mut wide, true), (BandedLdl::needs_of(&mut plain), (0, 0)));
    }
}

#[test]
fn a_broken_spring_or_another_pin_is_found_anew() {
    let data = generate::chain(300);
    let (mut plain, mut wide) = (build::scene::<f64>(&data), build::scene::<f64>(&data));
    let mut solver =
        Wide::new(vec![0.0; 20_000], vec![0; 1_000], Portable).around(BandedLdl::new(vec![0.0; 10_000]));
    for k in 0..8 {
        for scene in [&mut plain, &mut wide] {
            match k {
                2 => scene.break_spring(99).unwrap(),
                4 => scene.pin(200).unwrap(),
                6 => scene.release(0).unwrap(),
                _ => (),
            }
        }
        run(&data, &mut plain, &mut direct::banded(&data), 1e-8, 1);
        let (_, report, _) = run(&data, &mut wide, &mut solver, 1e-8, 1);
        assert!(report.fallbacks == 0 && solver.in_lanes());
        let far = build::farthest(&build::positions(&plain), &build::positions(&wide));
        assert!(far <= allowed::TRAJECTORY, "step {k}: {far}");
    }
}

#[test]
fn a_pivot_that_rounding_makes_negative_is_told_and_pcg_in_lanes_answers() {
    // So stiff that in rounded arithmetic its matrix is as good as singular.
    let mut data = generate::chain(100);
    data.pinned.fill(false);
    data.mass.fill(1e-6);
    data.springs.iter_mut().for_each(|s| s.k = 1e12);
    for (k, v) in data.velocity.iter_mut().enumerate() {
        *v = [0.1 * k as f64, 0.0, 0.3];
    }
    let mut scene = build::scene::<f32>(&data);
    let mut solver = lanes(&mut scene, Host::new());
    let (_, report, islands) = run(&data, &mut scene, &mut solver, 1e-4, 1);
    assert!(solver.in_lanes() && report.fallbacks == 1 && islands[0].solve.fallback, "{report:?}");
    assert!(report.upper.is_finite() && report.lower <= report.upper, "{report:?}");
    assert!(build::velocities(&scene).iter().flatten().all(|v| v.is_finite()));
}

#[test]
fn the_certified_bounds_hold_the_error_of_the_answer() {
    for data in chains() {
        let (mut wide, mut exact) = (build::scene::<f64>(&data), build::scene::<f64>(&data));
        let mut solver = lanes(&mut wide, Host::new());
        let (_, report, _) = run(&data, &mut wide, &mut solver, 1e-6, 1);
        run(&data, &mut exact, &mut BlockJacobi, 1e-13, 1);
        let mass = |i: usize| if data.pinned[i] { 0.0 } else { data.mass[i] };
        let (a, b) = (build::velocities(&wide), build::velocities(&exact));
        let apart = |i: usize| (0..3).map(|c| (a[i][c] - b[i][c]).powi(2)).sum::<f64>();
        // A ⪰ M where nothing is compressed: the velocities' part alone of ½‖e‖²_A, twice for the other's own error.
        let energy: f64 = (0..data.len()).map(|i| 0.5 * mass(i) * apart(i)).sum();
        assert!(energy.is_finite() && report.lower <= report.upper, "{report:?}");
        assert!(energy <= 1e-18, "{energy} {report:?}");
    }
}

#[test]
fn too_little_workspace_is_an_error_that_says_how_much_is_needed_and_changes_nothing() {
    let data = generate::chain(100);
    let mut scene = build::scene::<f64>(&data);
    let (own, (numbers, words)) = BandedLdl::needs_in_lanes_of(&mut scene, false);
    let before = build::bits(&scene);
    let mut step = |own: usize, numbers: usize, words: usize| {
        let lanes = Wide::new(vec![0.0; numbers], vec![0; words], Portable);
        let mut euler = hooke::LinearlyImplicitEuler::new(H).gravity([0.0, -9.81, 0.0]);
        euler = euler.tolerance(1e-6);
        let result = scene.step(&mut euler.solver(lanes.around(BandedLdl::new(vec![0.0; own]))));
        (result, build::bits(&scene))
    };
    let short = StepError::Workspace { numbers: own, words: 0 };
    assert_eq!(step(own - 1, numbers, words), (Err(short), before.clone()));
    let (result, bits) = step(own, numbers - 1, words);
    assert!(matches!(result, Err(StepError::Workspace { words: w, .. }) if w == words), "{result:?}");
    assert_eq!(bits, before);
    assert!(step(own, numbers, words).0.is_ok());
}
