//! What every method of time integration must keep: scalings, islands, memory, errors without a trace.

use hooke::{
    Drag, Force, Gravity, MassSpring, Memory, Motion, PointForce, Real, Scene, SceneIn, SpringDamping,
    StepError,
};
use hooke_tests::build::{self, Forces};
use hooke_tests::data::SceneData;
use hooke_tests::generate;
use hooke_tests::methods::{self, Method, options};
use hooke_tests::scaled::{Factors, ONE, scaled};
use hooke_tests::side_by_side::side_by_side;
use hooke_tests::vec_memory::VecScene;

/// A gentle network in whole numbers of a 1024th, so that scaling does not round.
fn gentle() -> SceneData {
    let mut data = generate::gentle_network(7, 12).rounded_to_f32();
    // Within the limits of explicit methods.
    data.springs.iter_mut().for_each(|s| s.k *= 0.25);
    data
}

const H: f64 = 1.0 / 64.0;

fn moved<T: Real>(method: Method, data: &SceneData, by: Factors, absolute: f64) -> Vec<[f64; 6]> {
    let data = scaled(data, by);
    let tolerance = if T::UNIT_ROUNDOFF.to_f64() < 1e-10 { 1e-6 } else { 1e-4 };
    let options = methods::Options { absolute: absolute * by.energy, ..options(H * by.time, tolerance) };
    let scene = method.run::<T>(&data, options, 20);
    let both = build::positions(&scene).into_iter().zip(build::velocities(&scene));
    let undo = |(x, v): ([f64; 3], [f64; 3])| {
        let (x, v) = (x.map(|x| x / by.length), v.map(|v| v / by.velocity));
        [x[0], x[1], x[2], v[0], v[1], v[2]]
    };
    both.map(undo).collect()
}

fn unchanged_by(factors: impl Fn(i32) -> Factors) {
    let data = gentle();
    for method in methods::ALL {
        for absolute in [0.0, 1e-9] {
            let plain = moved::<f64>(method, &data, ONE, absolute);
            let single = moved::<f32>(method, &data, ONE, absolute);
            assert!(plain.iter().flatten().all(|x| x.is_finite()));
            for p in [-3, 1, 4] {
                assert_eq!(
                    moved::<f64>(method, &data, factors(p), absolute),
                    plain,
                    "{method:?}, f64, p = {p}"
                );
                assert_eq!(
                    moved::<f32>(method, &data, factors(p), absolute),
                    single,
                    "{method:?}, f32, p = {p}"
                );
            }
        }
    }
}

#[test]
fn mass_stiffness_damping_and_joules_times_4_to_the_p_change_no_bit_under_any_method() {
    unchanged_by(|p| {
        let f = 4f64.powi(p);
        Factors { mass: f, stiffness: f, damping: f, energy: f, ..ONE }
    });
}

#[test]
fn lengths_velocities_and_gravity_times_2_to_the_p_scale_bit_for_bit_under_any_method() {
    unchanged_by(|p| {
        let f = 2f64.powi(p);
        Factors { length: f, velocity: f, gravity: f, energy: f * f, ..ONE }
    });
}

#[test]
fn time_times_2_to_the_p_scales_bit_for_bit_under_any_method() {
    unchanged_by(|p| {
        let f = 2f64.powi(p);
        let square = f * f;
        Factors {
            time: f,
            velocity: 1.0 / f,
            gravity: 1.0 / square,
            stiffness: 1.0 / square,
            damping: 1.0 / f,
            drag: 1.0 / f,
            energy: 1.0 / square,
            ..ONE
        }
    });
}

#[test]
fn flipping_the_sign_of_an_axis_flips_the_motion_bit_for_bit_under_any_method() {
    let data = gentle();
    for method in methods::ALL {
        for axis in 0..3 {
            let flip = |mut x: [f64; 3]| {
                x[axis] = -x[axis];
                x
            };
            let mut flipped = moved::<f64>(method, &data.moved(flip, flip), ONE, 0.0);
            for s in &mut flipped {
                (s[axis], s[axis + 3]) = (-s[axis], -s[axis + 3]);
            }
            assert_eq!(flipped, moved::<f64>(method, &data, ONE, 0.0), "{method:?}");
        }
    }
}

#[test]
fn an_island_has_the_bits_that_it_has_alone_under_every_method() {
    let (a, mut b) = (gentle(), generate::gentle_network(107, 6));
    (b.gravity, b.drag) = (a.gravity, a.drag);
    let (both, places) = side_by_side(&a, &b);
    for method in methods::ALL {
        let alone = build::bits(&method.run::<f64>(&a, options(H, 1e-6), 20));
        let together = build::bits(&method.run::<f64>(&both, options(H, 1e-6), 20));
        let picked: Vec<_> = places.iter().map(|i| together[*i]).collect();
        assert_eq!(picked, alone, "{method:?}");
    }
}

fn trace<M: Memory>(scene: &mut MassSpring<M>, method: Method, data: &SceneData) -> Vec<Vec<[u64; 6]>> {
    build::fill(scene, data).unwrap();
    let mut forces = Forces::<M::Real>::new(data);
    let pin = data.pinned.iter().position(|p| *p).unwrap();
    (1..=20)
        .map(|step| {
            let t = f64::from(step) * H;
            let mut at = data.position[pin];
            at[0] += 0.1 * t * t;
            let motion = Motion {
                particle: pin,
                position: build::real3(at),
                velocity: build::real3([0.2 * t, 0.0, 0.0]),
            };
            method.step(scene, options(H, 1e-4), forces.all(), &[motion]).unwrap();
            build::bits(scene)
        })
        .collect()
}

fn alike<T: Real>() {
    let data = gentle();
    let (n, s) = (data.len(), data.springs.len());
    let (reals, words) = SceneIn::<T>::needs(n, s);
    for method in methods::ALL {
        let grown = trace(&mut VecScene::<T>::empty(), method, &data);
        assert_eq!(trace(&mut VecScene::<T>::empty(), method, &data), grown, "{method:?} again");
        assert_eq!(trace(&mut Scene::<T, 40, 70>::new(), method, &data), grown, "{method:?}, fixed");
        let (mut reals, mut words) = (vec![T::from_f64(f64::NAN); reals], vec![7; words]);
        let mut slices = SceneIn::<T>::in_buffers(&mut reals, &mut words, n, s).unwrap();
        assert_eq!(trace(&mut slices, method, &data), grown, "{method:?}, slices");
    }
}

#[test]
fn fixed_slices_and_growable_memory_give_the_same_bits_under_every_method() {
    alike::<f64>();
    alike::<f32>();
}

#[test]
fn a_pin_that_has_moved_and_rests_is_a_pin_that_rests_under_every_method() {
    let data = gentle();
    let pin = data.pinned.iter().position(|p| *p).unwrap();
    for method in methods::ALL {
        let mut scene = build::scene::<f64>(&data);
        let mut forces = Forces::<f64>::new(&data);
        let motion = Motion { particle: pin, position: data.position[pin], velocity: [3.0, -2.0, 1.0] };
        method.step(&mut scene, options(H, 1e-6), forces.all(), &[motion]).unwrap();
        let mut now = data.clone();
        build::read_back(&scene, &mut now);
        // A pin has no velocity unless a motion gave it one.
        now.velocity[pin] = [0.0; 3];
        let mut fresh = build::scene::<f64>(&now);
        method.step(&mut scene, options(H, 1e-6), forces.all(), &[]).unwrap();
        method.step(&mut fresh, options(H, 1e-6), forces.all(), &[]).unwrap();
        assert_eq!(build::bits(&scene), build::bits(&fresh), "{method:?}");
    }
}

/// The step fails with this error, leaves no bit changed, and what follows is what would have.
fn refused<F: Force<f64>>(
    method: Method,
    of: methods::Options,
    forces: F,
    motion: &[Motion<f64>],
    expected: impl Fn(StepError) -> bool,
) {
    let data = gentle();
    let (mut tried, mut untouched) = (build::scene::<f64>(&data), build::scene::<f64>(&data));
    let made = method.step(&mut tried, of, forces, motion);
    let error = made.expect_err(&format!("{method:?} with {of:?}, {motion:?}"));
    assert!(expected(error), "{method:?}: {error:?}");
    assert!(!error.to_string().is_empty());
    assert_eq!(build::bits(&tried), build::bits(&untouched), "{method:?}: {error:?}");
    let mut forces = Forces::<f64>::new(&data);
    let after = method.step(&mut tried, options(H, 1e-6), forces.all(), &[]);
    assert_eq!(after, method.step(&mut untouched, options(H, 1e-6), forces.all(), &[]));
    assert_eq!(build::bits(&tried), build::bits(&untouched), "{method:?}: {error:?}");
}

#[test]
fn every_error_of_a_step_leaves_no_trace_under_every_method() {
    let data = gentle();
    let n = data.len();
    // A pin that holds something.
    let held = data.springs.iter().find(|s| data.pinned[s.a] != data.pinned[s.b]).unwrap();
    let pin = if data.pinned[held.a] { held.a } else { held.b };
    let free = data.pinned.iter().position(|p| !*p).unwrap();
    let at = |particle, position: [f64; 3]| Motion { particle, position, velocity: [0.0; 3] };
    let good = options(H, 1e-6);
    for method in methods::ALL {
        let needs = method.needs(n);
        if needs > 0 {
            let short = methods::Options { short_of: 1, ..good };
            refused(method, short, (), &[], |e| e == StepError::Workspace { numbers: needs, words: 0 });
        }
        for dt in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-200, 1e200] {
            refused(method, options(dt, 1e-6), (), &[], |e| e == StepError::TimeStep);
        }
        for tolerance in [-1.0, f64::NAN, f64::INFINITY] {
            refused(method, options(H, tolerance), (), &[], |e| e == StepError::Tolerance);
            let absolute = methods::Options { absolute: tolerance, ..good };
            refused(method, absolute, (), &[], |e| e == StepError::Tolerance);
        }
        refused(method, good, Gravity([0.0, f64::NAN, 0.0]), &[], |e| e == StepError::Field);
        refused(method, good, Drag(-1.0), &[], |e| e == StepError::Field);
        refused(method, good, SpringDamping(f64::NAN), &[], |e| e == StepError::Damping(0));
        let push = |f| PointForce { particle: free, force: [f, 0.0, 0.0] };
        refused(method, good, push(f64::NAN), &[], |e| e == StepError::Force(free));
        // Finite, and too large to move by; explicit and implicit methods find the particle, Newton's the island.
        refused(method, good, (push(f64::MAX), push(f64::MAX)), &[], |e| {
            matches!(e, StepError::NotFinite(_) | StepError::NotConverged(_))
        });
        refused(method, good, (), &[at(free, [0.0; 3])], |e| e == StepError::NotPinned(free));
        refused(method, good, (), &[at(99, [0.0; 3])], |e| e == StepError::NotPinned(99));
        refused(method, good, (), &[at(pin, [f64::NAN; 3])], |e| e == StepError::Motion(pin));
        refused(method, good, (), &[at(pin, [f64::MAX; 3])], |e| {
            matches!(e, StepError::Motion(_) | StepError::NotFinite(_) | StepError::NotConverged(_))
        });
    }
}

#[test]
fn an_empty_scene_and_one_of_pins_alone_step_under_every_method() {
    for method in methods::ALL {
        let report = method.step(&mut VecScene::<f32>::empty(), options(0.1, 1e-4), (), &[]).unwrap();
        assert_eq!((report.islands, report.iterations, report.springs_skipped), (0, 0, 0), "{method:?}");
        let mut pins = VecScene::<f32>::empty();
        let (a, b) = (pins.particle([0.0; 3], 1.0).unwrap(), pins.particle([1.0, 0.0, 0.0], 1.0).unwrap());
        pins.spring(a, b, 10.0).unwrap();
        pins.pin(a).unwrap();
        pins.pin(b).unwrap();
        let report = method.step(&mut pins, options(0.1, 1e-4), (), &[]).unwrap();
        assert_eq!((report.islands, report.iterations, report.springs_skipped), (0, 0, 1), "{method:?}");
    }
}
