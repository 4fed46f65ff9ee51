//! Block Jacobi in lanes with its iterations in f32: the answers of the same in the scene's precision, to which it goes back where
//! f32 gets no nearer.

use hooke::{Dispatch, Portable, Real, Report, SingleJacobi, Solver, StepError, Wide};
use hooke_harness::host::Host;
use hooke_tests::allowed;
use hooke_tests::build::{self, Forces};
use hooke_tests::data::SceneData;
use hooke_tests::lanes::{single, wide};
use hooke_tests::scaled::{Factors, ONE, scaled};

use crate::wide::{cloth, mesh, run};

const H: f64 = 1.0 / 60.0;

/// Eight steps on, then stopped, so that v⁺ is the answer itself; every `each`th spring `by` times stiffer.
pub(crate) fn stopped(mut data: SceneData, each: usize, by: f64) -> SceneData {
    build::walk_on(&mut data, H, 8);
    data.velocity.fill([0.0; 3]);
    data.springs.iter_mut().step_by(each).for_each(|s| s.k *= by);
    data
}

pub(crate) type Answer = (Vec<[f64; 3]>, Report<f64>);

pub(crate) fn step(data: &SceneData, r: f64, most: u32, solver: impl Solver<f64>) -> Answer {
    let (mut scene, mut forces) = (build::scene::<f64>(data), Forces::<f64>::new(data));
    let mut euler = forces.euler(H).tolerance(r).max_iterations(most).solver(solver);
    let report = scene.step(&mut euler).unwrap();
    (build::velocities(&scene), report)
}

/// Iterations in f32, and in the scene's precision.
fn both(data: &SceneData, r: f64) -> [Answer; 2] {
    let mut solver = single::<f64>(data);
    let found = step(data, r, 10_000, &mut solver);
    assert!(solver.in_lanes());
    [found, step(data, r, 10_000, wide(data))]
}

/// ‖a − b‖_A is no more than both bounds, √(2 upper), say; NaN is more.
pub(crate) fn within_the_bounds(data: &SceneData, a: &Answer, b: &Answer) {
    let apart = build::apart(data, H, &a.0, &b.0);
    let bounds = (2.0 * a.1.upper).sqrt() + (2.0 * b.1.upper).sqrt();
    assert!(apart <= bounds * (1.0 + allowed::FORM), "{apart:e} of {bounds:e}: {:?}, {:?}", a.1, b.1);
}

#[test]
fn answers_are_those_of_the_scenes_precision_within_both_bounds_in_hardly_more_iterations() {
    for data in [cloth(16), cloth(30), mesh(6)].map(|data| stopped(data, 1, 1.0)) {
        for r in [1e-3, 1e-6, 1e-10] {
            let [found, expected] = both(&data, r);
            within_the_bounds(&data, &found, &expected);
            let (told, plain) = (found.1, expected.1);
            assert_eq!((told.clamped, told.certified), (plain.clamped, plain.certified));
            assert_eq!(told.at_floor + told.capped + told.stalled + told.fallbacks, 0, "{told:?}");
            let [more, share] = if r < 1e-6 { allowed::SINGLE_REFINED } else { allowed::SINGLE };
            let most = more + (1.0 + share) * f64::from(plain.iterations);
            assert!(f64::from(told.iterations) <= most, "R = {r:e}: {told:?}, {plain:?}");
        }
    }
}

/// Steps with so many numbers to spare, all of them `dirty`, and if any, after those of another net.
fn run_in<T: Real>(data: &SceneData, r: f64, spare: usize, dirty: f32, on: impl Dispatch) -> Run<T> {
    let (mut scene, other) = (build::scene::<T>(data), mesh(5));
    let (numbers, words) = Wide::needs_of(&mut scene, true);
    let own = SingleJacobi::new(vec![dirty; SingleJacobi::needs_of(&mut scene) + spare]);
    let numbers = vec![T::from_f64(f64::from(dirty)); numbers + spare];
    let mut solver = Wide::new(numbers, vec![7; words + spare], on).around(own);
    if spare > 0 {
        run(&other, &mut build::scene::<T>(&other), &mut solver, r, 2);
    }
    let found = run(data, &mut scene, &mut solver, r, 12);
    assert!(solver.in_lanes() && found.1.iterations > 10, "{:?}", found.1);
    found
}

type Run<T> = (Vec<[u64; 6]>, Report<T>);

#[test]
fn registers_room_to_spare_and_what_lies_in_it_touch_no_bit() {
    fn check<T: Real>(r: f64) {
        for data in [cloth(16), mesh(6)] {
            let expected = run_in::<T>(&data, r, 0, 0.0, Portable);
            assert_eq!(run_in(&data, r, 0, f32::NAN, Host::new()), expected);
            assert_eq!(run_in(&data, r, 100_000, f32::NAN, Portable), expected);
        }
    }
    check::<f64>(1e-8);
    check::<f32>(1e-4);
}

#[test]
fn masses_and_constants_times_a_power_of_four_however_large_change_no_bit_of_an_answer() {
    for data in [cloth(9), mesh(4)].map(|data| stopped(data, 1, 1.0)) {
        let [expected, _] = both(&data, 1e-8);
        for by in [-120, -1, 1, 120].map(|power| 4f64.powi(power)) {
            let data = scaled(&data, Factors { mass: by, stiffness: by, damping: by, ..ONE });
            let [found, _] = both(&data, 1e-8);
            assert_eq!((found.1.iterations, found.1.fallbacks), (expected.1.iterations, 0));
            assert_eq!(found.0, expected.0);
        }
    }
}

#[test]
fn where_f32_gets_no_nearer_the_scenes_precision_goes_on_and_the_most_iterations_are_of_both() {
    for (data, by) in [(cloth(16), 1e12), (mesh(4), 1e8), (mesh(4), 1e12), (mesh(4), 1e30)] {
        let data = stopped(data, 5, by);
        let [found, expected] = both(&data, 1e-6);
        assert_eq!((found.1.fallbacks, found.1.capped, found.1.stalled), (1, 0, 0), "{:?}", found.1);
        within_the_bounds(&data, &found, &expected);
        // Forty halvings to R² = 1e-12, each of which f32 is waited for so long; then those of the other.
        let waits = 40 * (32 + 2 * data.len().isqrt() as u32);
        assert!(found.1.iterations <= waits + expected.1.iterations, "{:?}, {:?}", found.1, expected.1);
    }
    let data = stopped(cloth(9), 5, 1e12);
    let [found, expected] = both(&data, 1e-6);
    assert_eq!((found.1.fallbacks, found.1.capped, found.1.stalled), (1, 0, 0), "{:?}", found.1);
    within_the_bounds(&data, &found, &expected);
    for (most, fallbacks) in [(0, 0), (1, 0), (found.1.iterations - 1, 1)] {
        let cut = step(&data, 1e-6, most, single(&data));
        assert_eq!((cut.1.iterations, cut.1.capped, cut.1.fallbacks), (most, 1, fallbacks), "{:?}", cut.1);
        within_the_bounds(&data, &cut, &expected);
    }
    // Over new residuals too.
    let data = stopped(cloth(16), 1, 1.0);
    for most in [1, 60, 100, 150] {
        let (_, cut) = step(&data, 1e-12, most, single(&data));
        assert_eq!((cut.iterations, cut.capped, cut.fallbacks), (most, 1, 0), "{cut:?}");
    }
}

#[test]
fn numbers_that_f32_cannot_hold_are_solved_as_in_the_scenes_precision_bit_by_bit() {
    let mut heavy = stopped(cloth(9), 1, 1.0);
    heavy.mass.iter_mut().step_by(7).for_each(|m| *m *= 1e60);
    for data in [heavy, stopped(cloth(9), 1, 1e60), stopped(mesh(4), 1, 1e60)] {
        let [found, expected] = both(&data, 1e-6);
        assert_eq!(found.0, expected.0);
        let of = |report: &Report<f64>| (report.iterations, report.upper, report.capped + report.stalled);
        assert_eq!((of(&found.1), found.1.fallbacks), (of(&expected.1), 1));
    }
}

#[test]
fn too_few_numbers_are_an_error_that_says_how_many_are_needed_and_changes_nothing() {
    for data in [cloth(9), mesh(6)] {
        let mut scene = build::scene::<f64>(&data);
        let (numbers, before) = (SingleJacobi::needs_of(&mut scene), build::bits(&scene));
        let result = Err(StepError::Workspace { numbers, words: 0 });
        for room in [0, numbers - 1] {
            let solver = wide::<f64>(&data).around(SingleJacobi::new(vec![0.0_f32; room]));
            assert_eq!(scene.step(&mut Forces::new(&data).euler(H).solver(solver)), result);
            assert_eq!(build::bits(&scene), before);
        }
    }
}
