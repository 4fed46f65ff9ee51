//! Steps of a chosen length while pins move: orders, and J asked against error got.

use hooke::{Adaptive, Course, Embedded, Motion, Real, Rosenbrock2, Rosenbrock3, Verlet};
use hooke_tests::build::{self, Forces};
use hooke_tests::data::SceneData;
use hooke_tests::methods::{Method, options};
use hooke_tests::vec_memory::VecScene;

use super::orders::{cloth, way};

/// Two motions of this long, each a cubic, s.
pub(super) const SPAN: f64 = 0.032;

pub(super) fn memory(data: &SceneData) -> Vec<[f64; 3]> {
    vec![[f64::NAN; 3]; Rosenbrock3::<f64, ()>::needs(data.len())]
}

/// The end of the motion of pin 0 that is under way.
pub(super) fn end(data: &SceneData, span: usize) -> Motion<f64> {
    let [position, velocity] = way(data.position[0], (span + 1) as f64 * SPAN);
    Motion { particle: 0, position, velocity }
}

/// Where the cubic of both ends is after the part s of a span, and how fast: Bernstein's form of Hermite's cubic.
fn cubic(begin: [[f64; 3]; 2], end: &Motion<f64>, s: f64) -> [[f64; 3]; 2] {
    let [b, rate] = begin;
    let at = |d: usize| {
        let third = SPAN / 3.0;
        let p = [b[d], b[d] + third * rate[d], end.position[d] - third * end.velocity[d], end.position[d]];
        let r = 1.0 - s;
        let q = r * r * r * p[0] + 3.0 * r * r * s * p[1] + 3.0 * r * s * s * p[2] + s * s * s * p[3];
        let v = r * r * (p[1] - p[0]) + 2.0 * r * s * (p[2] - p[1]) + s * s * (p[3] - p[2]);
        [q, v / third]
    };
    let all: [[f64; 2]; 3] = std::array::from_fn(at);
    [0, 1].map(|k| all.map(|both| both[k]))
}

/// The scene with pin 0 as fast as its way begins.
pub(super) fn scene<T: Real>(data: &SceneData) -> VecScene<T> {
    let mut scene = build::scene::<T>(data);
    scene.set_pin_velocity(0, way(data.position[0], 0.0)[1].map(T::from_f64)).unwrap();
    scene
}

/// q and 0.1 s·q̇.
fn state(scene: &VecScene<f64>) -> Vec<[f64; 3]> {
    let mut end = build::positions(scene);
    end.extend(build::velocities(scene).into_iter().map(|v| v.map(|v| 0.1 * v)));
    end
}

/// Both spans in so many steps of `ros3` each, every one told where the cubic is.
fn exact(data: &SceneData, steps: usize) -> Vec<[f64; 3]> {
    let mut scene = scene::<f64>(data);
    let mut forces = Forces::<f64>::new(data);
    for span in 0..2 {
        let begin = [scene.positions()[0], scene.velocities()[0]];
        for step in 1..=steps {
            let [position, velocity] = cubic(begin, &end(data, span), step as f64 / steps as f64);
            let motion = [Motion { particle: 0, position, velocity }];
            let h = SPAN / steps as f64;
            Method::Ros3.step(&mut scene, options(h, 1e-13), forces.all(), &motion).unwrap();
        }
    }
    state(&scene)
}

/// Both spans in so many equal steps each, all told where the span ends.
fn parts<I: Embedded<f64>>(data: &SceneData, mut method: I, steps: usize) -> Vec<[f64; 3]> {
    let mut scene = scene::<f64>(data);
    for span in 0..2 {
        for step in 0..steps {
            let h = SPAN / steps as f64;
            let course = Course { motion: &[end(data, span)], over: (steps - step) as f64 * h };
            method.attempt(&mut scene.parts(), h, course, 1e-25, &mut |_| {}).unwrap();
            method.accept(scene.parts(), course).unwrap();
        }
    }
    state(&scene)
}

#[test]
fn steps_that_are_parts_of_a_motion_leave_every_method_its_order() {
    let data = cloth(true);
    let mut forces = Forces::<f64>::new(&data);
    let truth = exact(&data, 512);
    let mut off = |name: &str, steps: usize| {
        let all = forces.all();
        let end = match name {
            "ros2" => parts(&data, Rosenbrock2::new(1.0, memory(&data)).with(all), steps),
            "ros3" => parts(&data, Rosenbrock3::new(1.0, memory(&data)).with(all), steps),
            _ => parts(&data, Verlet::new(1.0).with(all), steps),
        };
        build::farthest(&end, &truth)
    };
    for (name, order, steps) in [("ros2", 2.0, 64), ("ros3", 3.0, 32), ("verlet", 2.0, 16)] {
        let [long, short] = [steps, 2 * steps].map(|steps| off(name, steps));
        let found = (long / short).log2();
        println!("{name}: {long:.1e} m off, {short:.1e} m with half the step: order {found:.2}");
        assert!((found - order).abs() <= 0.1, "{name}: {found}");
    }
}

/// Steps of chosen length over both spans: how many, how many were rejected, and the state at the end.
fn chosen<I: Embedded<f64>>(data: &SceneData, method: I, accuracy: f64) -> (usize, u32, Vec<[f64; 3]>) {
    let mut scene = scene::<f64>(data);
    let mut method = Adaptive::new(method, SPAN, accuracy);
    let (mut steps, mut rejections) = (0, 0);
    for span in 0..2 {
        let (begin, mut time) = ([scene.positions()[0], scene.velocities()[0]], 0.0);
        while time < SPAN {
            let left = SPAN - time;
            method.end_after(left);
            scene.step_moving(&mut method, &[end(data, span)]).unwrap();
            let made = method.made();
            assert!(made.error.energy <= accuracy);
            time = if made.dt == left { SPAN } else { time + made.dt };
            (steps, rejections) = (steps + 1, rejections + made.rejections);
            // On the cubic, but for the rounding of some steps.
            let [b, rate] = cubic(begin, &end(data, span), time / SPAN);
            let (q, v) = (scene.positions()[0], scene.velocities()[0]);
            for d in 0..3 {
                assert!((q[d] - b[d]).abs() <= 1e-12, "{time} s: {q:?}, not {b:?}");
                assert!((v[d] - rate[d]).abs() * left <= 1e-12, "{time} s: {v:?}, not {rate:?}");
            }
        }
        // At the end there is nothing to round.
        assert_eq!((scene.positions()[0], scene.velocities()[0]), {
            let end = end(data, span);
            (end.position, end.velocity)
        });
    }
    (steps, rejections, state(&scene))
}

#[test]
fn with_a_hundredth_of_j_the_end_is_a_tenth_as_far_off_while_a_pin_accelerates_and_pins_stay_on_their_cubics()
{
    let data = cloth(true);
    let mut forces = Forces::<f64>::new(&data);
    let truth = exact(&data, 512);
    for name in ["ros2", "ros3", "verlet"] {
        let errors = [1e-7, 1e-9, 1e-11].map(|accuracy| {
            let all = forces.all();
            let (steps, rejections, end) = match name {
                "ros2" => chosen(&data, Rosenbrock2::new(1.0, memory(&data)).with(all), accuracy),
                "ros3" => chosen(&data, Rosenbrock3::new(1.0, memory(&data)).with(all), accuracy),
                _ => chosen(&data, Verlet::new(1.0).with(all), accuracy),
            };
            let off = build::farthest(&end, &truth);
            println!("{name}, {accuracy:.0e} J: {steps} steps, {rejections} rejected, {off:.1e} m off");
            off
        });
        let gained = (errors[0] / errors[2]).log10() / 2.0;
        println!("{name}: a hundredth of J, 10^{gained:.2} closer");
        // J goes with h⁴, under ros3 with h⁴ to h⁶ (see the estimates in `orders`), the error with h² or h³.
        let expected = if name == "ros3" { 0.9..1.6 } else { 0.9..1.1 };
        assert!(expected.contains(&gained), "{name}: {gained}");
    }
}

/// The way turns at once: ḃ jumps from one to the other, and with it the force of damped springs.
#[test]
fn where_a_pin_turns_a_corner_the_end_is_as_close_as_j_says_if_a_motion_ends_there_and_the_next_is_told_its_speed()
 {
    let mut data = cloth(true);
    data.springs.iter_mut().for_each(|s| s.c *= 4.0);
    let speeds = [[2.0, 0.0, 0.0], [-1.0, 3.0, 0.0]];
    let ends = {
        let [x, y, z] = data.position[0];
        [[x + 2.0 * SPAN, y, z], [x + SPAN, y + 3.0 * SPAN, z]]
    };
    let run = |accuracy: Option<f64>| {
        let mut scene = build::scene::<f64>(&data);
        let mut forces = Forces::<f64>::new(&data);
        let steps = 2048;
        let method = Rosenbrock3::new(1.0, memory(&data)).with(forces.all()).tolerance(1e-13);
        let mut method = Adaptive::new(method, SPAN, accuracy.unwrap_or(1.0));
        let (mut taken, mut most) = (0, 0);
        for (velocity, position) in speeds.into_iter().zip(ends) {
            scene.set_pin_velocity(0, velocity).unwrap();
            let motion = [Motion { particle: 0, position, velocity }];
            let mut time = 0.0;
            for step in 1.. {
                if accuracy.is_none() {
                    if step > steps {
                        break;
                    }
                    let left = (steps - step) as f64 / steps as f64 * SPAN;
                    let position = std::array::from_fn(|d| position[d] - left * velocity[d]);
                    let motion = [Motion { position, ..motion[0] }];
                    method.method.set_dt(SPAN / steps as f64);
                    scene.step_moving(&mut method.method, &motion).unwrap();
                } else {
                    let left = SPAN - time;
                    method.end_after(left);
                    scene.step_moving(&mut method, &motion).unwrap();
                    taken += 1;
                    most = most.max(method.made().rejections);
                    if method.made().dt == left {
                        break;
                    }
                    time += method.made().dt;
                }
            }
        }
        (taken, most, state(&scene))
    };
    let (_, _, truth) = run(None);
    let errors = [1e-9, 1e-11].map(|accuracy| {
        let (steps, most, end) = run(Some(accuracy));
        let off = build::farthest(&end, &truth);
        println!("{accuracy:.0e} J: {steps} steps, at most {most} rejections of one, {off:.1e} m off");
        assert!(most <= 6, "{most} rejections of one step");
        off
    });
    let gained = (errors[0] / errors[1]).log10();
    println!("a hundredth of J, 10^{gained:.2} closer");
    assert!((0.9..1.6).contains(&gained), "{gained}");
}
