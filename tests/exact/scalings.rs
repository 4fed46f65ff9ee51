//! Bit-exact scalings by powers of two, over many steps; and the symmetries of space that cost rounding.

use hooke::{Real, Stop};
use hooke_tests::build::{self, Forces};
use hooke_tests::data::SceneData;
use hooke_tests::random::Random;
use hooke_tests::scaled::{Factors, ONE, scaled};
use hooke_tests::{allowed, generate};

/// Positions, velocities, iterations and clamped springs after so many steps, undone by the factors.
fn run<T: Real>(data: &SceneData, by: Factors, absolute: f64) -> (Vec<[f64; 6]>, u32, u32) {
    let real = T::from_f64;
    let data = scaled(&data.rounded_to_f32(), by);
    let mut scene = build::scene::<T>(&data);
    let mut forces = Forces::<T>::new(&data);
    let mut euler = forces
        .euler(real(2f64.powi(-6) * by.time))
        .tolerance(Stop::<T>::new().relative)
        .absolute(real(absolute * by.energy));
    let (mut iterations, mut clamped) = (0, 0);
    for _ in 0..40 {
        let report = scene.step(&mut euler).unwrap();
        iterations += report.iterations;
        clamped += report.clamped;
    }
    let (x, v) = (build::positions(&scene), build::velocities(&scene));
    let both = x.iter().zip(&v).map(|(x, v)| {
        let (x, v) = (x.map(|x| x / by.length), v.map(|v| v / by.velocity));
        [x[0], x[1], x[2], v[0], v[1], v[2]]
    });
    (both.collect(), iterations, clamped)
}

/// A gentle scene and a violent one with clamping; everything in it (pins, points, drag, damping, gravity).
fn scenes() -> Vec<SceneData> {
    let mut random = Random::new(11);
    let with = generate::Ingredients {
        pins: true,
        compressed: true,
        damped: true,
        points: true,
        gravity: true,
        moving: true,
    };
    let mut violent = generate::network(&mut random, 10, with);
    for s in &mut violent.springs {
        s.k = s.k.clamp(2e3, 1e4);
    }
    for m in &mut violent.mass {
        *m = m.clamp(0.05, 1.0);
    }
    vec![generate::gentle_network(7, 12), violent]
}

fn unchanged_by(factors: impl Fn(i32) -> Factors) {
    let mut met_clamping = false;
    for data in scenes() {
        for absolute in [0.0, 1e-7] {
            let (plain, again) = (run::<f64>(&data, ONE, absolute), run::<f32>(&data, ONE, absolute));
            met_clamping |= plain.2 > 0 && again.2 > 0;
            assert!(plain.1 > 0 && plain.0.iter().flatten().all(|x| x.is_finite()));
            for p in [-4, -1, 1, 3, 6] {
                assert_eq!(run::<f64>(&data, factors(p), absolute), plain, "f64, p = {p}");
                assert_eq!(run::<f32>(&data, factors(p), absolute), again, "f32, p = {p}");
            }
        }
    }
    assert!(met_clamping, "one of the scenes is to need clamping");
}

#[test]
fn mass_stiffness_damping_and_joules_times_4_to_the_p_change_no_bit_of_the_motion() {
    unchanged_by(|p| {
        let f = 4f64.powi(p);
        Factors { mass: f, stiffness: f, damping: f, energy: f, ..ONE }
    });
}

#[test]
fn lengths_velocities_and_gravity_times_2_to_the_p_scale_the_motion_bit_for_bit() {
    unchanged_by(|p| {
        let f = 2f64.powi(p);
        Factors { length: f, velocity: f, gravity: f, energy: f * f, ..ONE }
    });
}

#[test]
fn time_times_2_to_the_p_scales_the_motion_bit_for_bit() {
    unchanged_by(|p| {
        let f = 2f64.powi(p);
        Factors {
            time: f,
            velocity: 1.0 / f,
            gravity: 1.0 / (f * f),
            stiffness: 1.0 / (f * f),
            damping: 1.0 / f,
            drag: 1.0 / f,
            energy: 1.0 / (f * f),
            ..ONE
        }
    });
}

fn plain<T: Real>(data: &SceneData) -> Vec<[f64; 6]> {
    run::<T>(data, ONE, 0.0).0
}

#[test]
fn flipping_the_sign_of_an_axis_flips_the_motion_bit_for_bit() {
    for data in scenes() {
        for axis in 0..3 {
            let flip = |mut x: [f64; 3]| {
                x[axis] = -x[axis];
                x
            };
            let unflip = |mut s: [f64; 6]| {
                s[axis] = -s[axis];
                s[axis + 3] = -s[axis + 3];
                s
            };
            let flipped = data.moved(flip, flip);
            let back = |run: Vec<[f64; 6]>| run.into_iter().map(unflip).collect::<Vec<_>>();
            assert_eq!(back(plain::<f64>(&flipped)), plain::<f64>(&data));
            assert_eq!(back(plain::<f32>(&flipped)), plain::<f32>(&data));
        }
    }
}

#[test]
fn exchanging_the_ends_of_a_spring_changes_no_bit() {
    for data in scenes() {
        let mut other = data.clone();
        for s in &mut other.springs {
            (s.a, s.b) = (s.b, s.a);
        }
        assert_eq!(plain::<f64>(&other), plain::<f64>(&data));
        assert_eq!(plain::<f32>(&other), plain::<f32>(&data));
    }
}

/// Ten tight steps of a gentle scene, as vectors.
fn tight(data: &SceneData) -> (Vec<[f64; 3]>, Vec<[f64; 3]>) {
    let mut scene = build::scene::<f64>(data);
    let mut forces = Forces::<f64>::new(data);
    let mut euler = forces.euler(1.0 / 64.0).tolerance(1e-14);
    for _ in 0..10 {
        scene.step(&mut euler).unwrap();
    }
    (build::positions(&scene), build::velocities(&scene))
}

fn equivariant(x: impl Fn([f64; 3]) -> [f64; 3] + Copy, v: impl Fn([f64; 3]) -> [f64; 3] + Copy) {
    let data = generate::gentle_network(21, 12);
    let (position, velocity) = tight(&data);
    let (moved, moving) = tight(&data.moved(x, v));
    let position: Vec<[f64; 3]> = position.into_iter().map(x).collect();
    let velocity: Vec<[f64; 3]> = velocity.into_iter().map(v).collect();
    let off = build::farthest(&position, &moved);
    println!("{off:.1e} m off");
    assert!(off <= allowed::EQUIVARIANT_TRAJECTORY, "{off:e} m");
    let off = build::farthest(&velocity, &moving);
    assert!(off <= 64.0 * allowed::EQUIVARIANT_TRAJECTORY, "{off:e} m/s");
}

#[test]
fn permuting_the_axes_permutes_the_motion_to_rounding() {
    let turn = |x: [f64; 3]| [x[1], x[2], x[0]];
    equivariant(turn, turn);
}

#[test]
fn translating_the_scene_translates_the_motion_to_rounding() {
    equivariant(|x| [x[0] + 1.3, x[1] - 0.7, x[2] + 2.9], |v| v);
}

#[test]
fn rotating_the_scene_rotates_the_motion_to_rounding() {
    let rotation = nalgebra::Rotation3::from_euler_angles(0.4, 1.2, -2.5);
    let turn = |x: [f64; 3]| (rotation * nalgebra::Vector3::from(x)).into();
    equivariant(turn, turn);
}
