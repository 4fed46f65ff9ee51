//! Steps as long as an accuracy allows.

use std::cell::Cell;

use hooke::{
    Adaptive, Embedded, Force, LocalError, Motion, Rosenbrock2, Rosenbrock3, Spring, StepError, Verlet,
    force::Rows,
};
use hooke_tests::data::SceneData;
use hooke_tests::vec_memory::VecScene;
use hooke_tests::{build, generate};

type Memory = Vec<[f64; 3]>;

fn memory(data: &SceneData) -> Memory {
    vec![[f64::NAN; 3]; Rosenbrock3::<f64, ()>::needs(data.len())]
}

/// A cloth that falls into its pins, and a stiff network.
fn scenes() -> [SceneData; 2] {
    let mut stiff = generate::gentle_network(9, 12);
    stiff.springs.iter_mut().for_each(|s| s.k *= 10.0);
    [generate::cloth(5), stiff]
}

/// Steps to `seconds`; (dt, error, rejections, upper) of each.
fn run<I: Embedded<f64>>(
    scene: &mut VecScene<f64>,
    method: &mut Adaptive<I, f64>,
    seconds: f64,
) -> Vec<(f64, LocalError<f64>, u32, f64)> {
    let (mut time, mut steps) = (0.0, Vec::new());
    while time < seconds {
        let left = seconds - time;
        method.end_after(left);
        let report = scene.step(method).unwrap();
        let made = method.made();
        assert!(made.dt > 0.0 && made.dt <= left);
        time = if made.dt == left { seconds } else { time + made.dt };
        steps.push((made.dt, made.error, made.rejections, report.upper));
        assert!(steps.len() < 100_000);
    }
    steps
}

#[test]
fn every_step_that_is_taken_has_an_error_of_at_most_j_and_the_last_ends_exactly_at_the_end() {
    for data in scenes() {
        for accuracy in [1e-2, 1e-5] {
            let mut forces = build::Forces::<f64>::new(&data);
            let mut scene = build::scene::<f64>(&data);
            let method = Rosenbrock2::new(1.0, memory(&data)).with(forces.all());
            let steps = run(&mut scene, &mut Adaptive::new(method, 0.01, accuracy), 0.1);
            let mut again = build::scene::<f64>(&data);
            let method = Rosenbrock3::new(1.0, memory(&data)).with(forces.all());
            let third = run(&mut again, &mut Adaptive::new(method, 0.01, accuracy), 0.1);
            println!("{accuracy:.0e} J: {} steps of ros2, {} of ros3", steps.len(), third.len());
            for (dt, error, rejections, _) in steps.iter().chain(&third) {
                assert!(error.energy <= accuracy, "{error:?} at {dt} s");
                assert!(error.distance >= 0.0 && error.distance.is_finite());
                assert!(*rejections < 24);
            }
        }
    }
}

#[test]
fn what_solves_leave_undone_is_at_most_a_4096th_of_j_a_solve_whatever_the_relative_tolerance() {
    let data = generate::cloth(5);
    for accuracy in [1e-4, 1e-8, 1e-12] {
        let mut forces = build::Forces::<f64>::new(&data);
        let mut scene = build::scene::<f64>(&data);
        let method = Rosenbrock3::new(1.0, memory(&data)).with(forces.all()).tolerance(1e-2);
        for (_, _, _, upper) in run(&mut scene, &mut Adaptive::new(method, 0.001, accuracy), 0.02) {
            // The bound of a solve that stops at J/4096 adds the rounding of its residual.
            assert!(upper <= 1.01 * accuracy / 4096.0, "{upper:e} J of {accuracy:e}");
        }
    }
}

#[test]
fn a_smaller_j_takes_more_steps_and_ends_closer() {
    let data = generate::cloth(5);
    let mut forces = build::Forces::<f64>::new(&data);
    let mut answers = Vec::new();
    for accuracy in [1e-5, 1e-7, 1e-9, 1e-13] {
        let mut scene = build::scene::<f64>(&data);
        let method = Rosenbrock3::new(1.0, memory(&data)).with(forces.all());
        let steps = run(&mut scene, &mut Adaptive::new(method, 1e-3, accuracy), 0.1).len();
        answers.push((steps, build::positions(&scene)));
    }
    let exact = answers.pop().unwrap().1;
    let off: Vec<f64> = answers.iter().map(|(_, x)| build::farthest(x, &exact)).collect();
    println!("{off:?} m in {:?} steps", answers.iter().map(|a| a.0).collect::<Vec<_>>());
    assert!(off.windows(2).all(|two| two[1] < two[0] / 2.0), "{off:?}");
    assert!(answers.windows(2).all(|two| two[1].0 > two[0].0));
}

#[test]
fn two_runs_have_the_same_bits_and_steps() {
    let [data, _] = scenes();
    let once = || {
        let mut forces = build::Forces::<f64>::new(&data);
        let mut scene = build::scene::<f64>(&data);
        let method = Rosenbrock2::new(1.0, memory(&data)).with(forces.all());
        let steps = run(&mut scene, &mut Adaptive::new(method, 0.01, 1e-6), 0.1);
        (build::bits(&scene), steps)
    };
    assert_eq!(once(), once());
}

/// Counts how often it is asked to be valid: once an attempt.
struct Counted<'a>(&'a Cell<u32>);

impl Force<f64> for Counted<'_> {
    fn check(&self, _: usize, _: usize) -> Result<(), StepError> {
        self.0.set(self.0.get() + 1);
        Ok(())
    }
    fn add(&self, _: &Rows<'_, f64>, _: &mut [[f64; 3]]) {}
}

#[test]
fn an_accuracy_below_rounding_ends_after_few_attempts_with_the_scene_untouched_and_says_what_was_attained() {
    for data in scenes() {
        for (dt, accuracy) in [(0.01, 1e-40), (0.01, 1e-200), (1.0, 1e-250), (1e-6, 1e-300)] {
            let attempts = Cell::new(0);
            let mut forces = build::Forces::<f64>::new(&data);
            let mut scene = build::scene::<f64>(&data);
            let before = build::bits(&scene);
            let method = Rosenbrock2::new(1.0, memory(&data)).with(forces.all()).with(Counted(&attempts));
            let mut method = Adaptive::new(method, dt, accuracy);
            assert_eq!(scene.step(&mut method), Err(StepError::Accuracy), "{dt} s, {accuracy:e} J");
            // Rounding alone is more, so that none need be made.
            assert!(attempts.get() <= 24, "{} attempts", attempts.get());
            assert!(method.attained() > accuracy, "{}", method.attained());
            assert_eq!(build::bits(&scene), before);
            method.set_accuracy(1e9);
            scene.step(&mut method).unwrap();
        }
    }
}

#[test]
fn in_single_precision_a_scene_that_leaves_the_range_is_never_an_error_of_dt_however_short_the_step() {
    let mut scene = build::scene::<f32>(&generate::rope(3));
    scene.set_velocity(1, [f32::MAX / 2.0, 0.0, 0.0]).unwrap();
    let memory = vec![[0.0; 3]; Rosenbrock2::<f32, ()>::needs(3)];
    let before = build::bits(&scene);
    let made = scene.step(&mut Adaptive::new(Rosenbrock2::new(1.0, memory), 1e-2, 1e-6));
    assert!(matches!(made, Err(StepError::Accuracy | StepError::NotFinite(1))), "{made:?}");
    assert_eq!(build::bits(&scene), before);
}

#[test]
fn a_motion_without_an_end_is_refused_and_so_are_an_accuracy_a_step_or_memory_that_are_not_valid() {
    let data = generate::rope(4);
    let refused = |dt: f64, accuracy: f64, memory: Memory, motion: &[Motion<f64>]| {
        let mut scene = build::scene::<f64>(&data);
        let before = build::bits(&scene);
        let error =
            scene.step_moving(&mut Adaptive::new(Rosenbrock2::new(1.0, memory), dt, accuracy), motion);
        assert_eq!(build::bits(&scene), before);
        error.unwrap_err()
    };
    let motion = Motion { particle: 0, position: [0.0; 3], velocity: [0.0; 3] };
    assert_eq!(refused(0.01, 1e-6, memory(&data), &[motion]), StepError::Motion(0));
    for accuracy in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(refused(0.01, accuracy, memory(&data), &[]), StepError::Tolerance);
    }
    for dt in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(refused(dt, 1e-6, memory(&data), &[]), StepError::TimeStep);
    }
    let needs = Rosenbrock2::<f64, ()>::needs(4);
    let short = refused(0.01, 1e-6, vec![[0.0; 3]; needs - 1], &[]);
    assert_eq!(short, StepError::Workspace { numbers: needs, words: 0 });
}

#[test]
fn a_step_that_the_end_cuts_short_does_not_shorten_those_after_it() {
    let data = generate::cloth(5);
    let mut forces = build::Forces::<f64>::new(&data);
    let mut scene = build::scene::<f64>(&data);
    let method = Rosenbrock2::new(1.0, memory(&data)).with(forces.all());
    let mut method = Adaptive::new(method, 1e-3, 1e-6);
    for _ in 0..20 {
        scene.step(&mut method).unwrap();
    }
    let before = method.dt();
    method.end_after(before / 1024.0);
    scene.step(&mut method).unwrap();
    assert_eq!(method.made().dt, before / 1024.0);
    assert!(method.dt() >= before);
    method.end_after(0.0);
    scene.step(&mut method).unwrap();
    assert!(method.made().dt > before / 4.0);
}

#[test]
fn the_estimate_of_free_fall_and_of_rest_is_nothing_and_steps_grow_fivefold() {
    let mut scene = VecScene::<f64>::empty();
    let i = scene.particle([0.0; 3], 1.0).unwrap();
    scene.set_velocity(i, [1.0, 2.0, 3.0]).unwrap();
    let mut method = Adaptive::new(Rosenbrock3::new(1.0, vec![[0.0; 3]; 5]), 1e-3, 1e-9);
    for n in 0..5 {
        scene.step(&mut method).unwrap();
        assert!(method.made().error.energy < 1e-25, "{:?}", method.made());
        println!("step {n}: {} s", method.made().dt);
    }
    assert!(method.dt() > 0.05);
    // A spring at rest.
    let mut scene = VecScene::<f64>::empty();
    let (a, b) = (scene.particle([0.0; 3], 1.0).unwrap(), scene.particle([1.0, 0.0, 0.0], 1.0).unwrap());
    scene.spring_with(a, b, Spring { stiffness: 1e5, rest_length: 1.0 }).unwrap();
    let mut method = Adaptive::new(Rosenbrock2::new(1.0, vec![[0.0; 3]; 6]), 1e-3, 1e-9);
    scene.step(&mut method).unwrap();
    assert_eq!(method.made().error, LocalError { energy: 0.0, distance: 0.0 });
}

/// dt once grew until its square was no number, and then every step was refused for it.
#[test]
fn where_nothing_ever_has_an_error_steps_stay_in_range_however_many_there_are() {
    let mut scene = VecScene::<f32>::empty();
    scene.particle([0.0; 3], 1.0).unwrap();
    scene.pin(0).unwrap();
    let mut method = Adaptive::new(Verlet::new(0.01), 0.01, 1e-6);
    for step in 0..200 {
        let made = scene.step(&mut method);
        assert!(made.is_ok(), "step {step} of {:e} s: {made:?}", method.dt());
    }
    assert!(method.dt() > 1e18);
    // So do attempts.
    let mut method = Adaptive::new(Verlet::new(0.01), 0.01, 1e-6);
    for attempt in 0..200 {
        let made = method.probe(&mut scene, &[]);
        assert!(made.is_ok(), "attempt {attempt} of {:e} s: {made:?}", method.dt());
    }
    assert!(method.dt() > 1e17);
}

/// A rate of damping so high that the longest stable step has no square: the caller's dt was valid.
#[test]
fn a_limit_below_the_numbers_is_an_accuracy_that_cannot_be_had_and_not_an_error_of_dt() {
    let mut scene = build::scene::<f32>(&generate::rope(3));
    let before = build::bits(&scene);
    let method = Verlet::new(1.0).with(hooke::Drag(1e30));
    assert_eq!(scene.step(&mut Adaptive::new(method, 0.01, 1e-6)), Err(StepError::Accuracy));
    assert_eq!(build::bits(&scene), before);
}
