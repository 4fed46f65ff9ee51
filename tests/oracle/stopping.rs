//! When a solve stops, and what it then says.

use hooke::{Ending, LinearlyImplicitEuler, Real, Report, Solve};
use hooke_tests::{allowed, build, generate};

/// The solve of a cloth's third step. The first two have the default tolerance, so that all see the same system.
fn third_step<T: Real>(relative: f64, absolute: f64, max_iterations: u32) -> (Report<T>, Solve<T>) {
    let data = generate::cloth(10);
    let mut scene = build::scene::<T>(&data);
    let h = T::from_f64(1.0 / 60.0);
    let mut first = LinearlyImplicitEuler::new(h).gravity(build::real3(data.gravity));
    scene.step(&mut first).unwrap();
    scene.step(&mut first).unwrap();
    let mut euler =
        first.tolerance(T::from_f64(relative)).absolute(T::from_f64(absolute)).max_iterations(max_iterations);
    let mut solves = Vec::new();
    let report = scene.step_watched(&mut euler, &[], |island| solves.push(island.solve)).unwrap();
    assert_eq!(solves.len(), 1);
    (report, solves[0])
}

/// β₀: the bound before any iteration.
fn start() -> f64 {
    third_step::<f64>(0.0, 0.0, 0).1.upper
}

#[test]
fn the_relative_rule_stops_at_the_first_iteration_that_reaches_r2_beta0() {
    for relative in [1e-1, 1e-2, 1e-4, 1e-6, 1e-8] {
        let goal = relative * relative * start();
        let (_, solve) = third_step::<f64>(relative, 0.0, 10_000);
        assert_eq!(solve.ending, Ending::Converged);
        assert!(
            solve.upper <= goal * (1.0 + allowed::STOPPING),
            "R = {relative:e}: {solve:?}, goal {goal:e}"
        );
        let (_, before) = third_step::<f64>(relative, 0.0, solve.iterations - 1);
        assert_eq!((before.ending, before.iterations), (Ending::Capped, solve.iterations - 1));
        assert!(
            before.upper >= goal * (1.0 - allowed::STOPPING),
            "one iteration less was enough: {before:?}"
        );
    }
}

#[test]
fn the_absolute_rule_stops_at_the_first_iteration_that_reaches_j() {
    let start = start();
    for joules in [start * 1e-1, start * 1e-4, start * 1e-9] {
        let (_, solve) = third_step::<f64>(0.0, joules, 10_000);
        assert_eq!(solve.ending, Ending::Converged);
        assert!(solve.upper <= joules * (1.0 + allowed::STOPPING));
        let (_, before) = third_step::<f64>(0.0, joules, solve.iterations - 1);
        assert!(before.upper >= joules * (1.0 - allowed::STOPPING));
    }
    let (report, solve) = third_step::<f64>(0.0, start * 2.0, 10_000);
    assert_eq!((solve.ending, solve.iterations, report.untouched), (Ending::Untouched, 0, 1));
    assert!(solve.upper <= start * 2.0);
}

#[test]
fn a_tolerance_beyond_f32_ends_at_the_floor_which_is_a_success() {
    let (report, solve) = third_step::<f32>(1e-12, 0.0, 10_000);
    assert_eq!((solve.ending, report.at_floor, report.capped, report.stalled), (Ending::Floor, 1, 0, 0));
    assert!(0.0 <= solve.lower && solve.lower <= solve.upper);
    // The floor is far below what the default tolerance leaves.
    assert!(solve.upper < 1e-2 * third_step::<f32>(1e-4, 0.0, 10_000).1.upper);
}

#[test]
fn tolerance_zero_ends_at_the_floor_of_f64() {
    let (report, solve) = third_step::<f64>(0.0, 0.0, 10_000);
    assert_eq!((solve.ending, report.at_floor), (Ending::Floor, 1));
    // |r| at its rounding: relative to β₀ some 1e-30.
    assert!(solve.upper <= 1e-26 * start(), "{solve:?}");
}

#[test]
fn running_out_of_iterations_is_reported_with_the_bound_reached() {
    let (mut last, start) = (f64::INFINITY, start());
    for cut in [1, 3, 10, 30] {
        let (report, solve) = third_step::<f64>(1e-12, 0.0, cut);
        assert_eq!((solve.ending, solve.iterations), (Ending::Capped, cut));
        assert_eq!((report.capped, report.iterations), (1, cut));
        assert!(0.0 < solve.lower && solve.lower <= solve.upper && solve.upper.is_finite());
        // The A-norm of the error falls at every iteration: no lower bound can exceed an earlier upper one.
        assert!(solve.lower <= last, "{} after {last}", solve.lower);
        last = solve.upper.min(last);
    }
    assert!(last < start);
}

#[test]
fn a_smaller_step_gives_a_better_answer_not_a_worse_one() {
    // A warm start with |r| ≤ tol·|b| passes after one iteration at small dt, and 100 times more steps are worse. Here the
    // error of the solves stays small against the motion.
    let data = generate::rope(20);
    for steps in [1, 10, 100] {
        let h = 1.0 / 60.0 / f64::from(steps);
        let mut loose = build::scene::<f64>(&data);
        let mut tight = build::scene::<f64>(&data);
        let mut euler = LinearlyImplicitEuler::new(h).gravity(data.gravity).tolerance(1e-3);
        let mut exact = LinearlyImplicitEuler::new(h).gravity(data.gravity).tolerance(1e-13);
        for _ in 0..12 * steps {
            loose.step(&mut euler).unwrap();
            tight.step(&mut exact).unwrap();
        }
        let off = build::farthest(&build::positions(&loose), &build::positions(&tight));
        let moved = build::farthest(&build::positions(&tight), &data.position);
        assert!(
            off <= allowed::LOOSE_TRAJECTORY * moved,
            "{steps} steps per frame: {off:e} m of {moved:e} m"
        );
    }
}
