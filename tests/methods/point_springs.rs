//! A point spring is a spring to a pin, under every method but one: stretched or compressed, certified or clamped, several on a particle.

use hooke::{PointSpring, Spring, SpringDamping};
use hooke_tests::methods::{self, Method, Options, options};
use hooke_tests::vec_memory::VecScene;
use hooke_tests::{allowed, build};

/// Two particles with a spring, thrown.
fn pair() -> VecScene<f64> {
    let mut scene = VecScene::<f64>::empty();
    for (x, v) in [([0.0; 3], [0.5, -0.25, 0.0]), ([1.25, 0.25, 0.0], [-0.5, 1.0, 0.75])] {
        let i = scene.particle(x, 0.75).unwrap();
        scene.set_velocity(i, v).unwrap();
    }
    scene.spring_with(0, 1, Spring { stiffness: 30.0, rest_length: 1.0 }).unwrap();
    scene
}

/// Particle, target, rest length.
const POINTS: [(usize, [f64; 3], f64); 3] =
    [(0, [-1.0, 0.5, 0.25], 0.5), (1, [1.5, 1.0, -0.5], 0.75), (1, [2.0, -0.5, 0.0], 1.5)];

#[test]
fn a_step_with_point_springs_is_that_with_springs_to_pins() {
    // Energy-momentum takes a force that is no spring's at the middle of the step, and a spring's mean so that its energy is kept.
    for method in methods::ALL.into_iter().filter(|method| *method != Method::EnergyMomentum) {
        for (h, k) in [(1.0 / 64.0, 50.0), (1.0 / 16.0, 20.0), (0.25, 300.0)] {
            let mut points = POINTS.map(|(i, target, l0)| PointSpring::new(i, target, k).rest_length(l0));
            let (mut with_points, mut with_pins) = (pair(), pair());
            for (i, target, l0) in POINTS {
                let pin = with_pins.particle(target, 1.0).unwrap();
                with_pins.pin(pin).unwrap();
                with_pins.spring_with(pin, i, Spring { stiffness: k, rest_length: l0 }).unwrap();
            }
            // Damped are only the scene's own.
            let damping = SpringDamping(&[0.5, 0.0, 0.0, 0.0][..]);
            let options = Options { substeps: 32, ..options(h, 1e-14) };
            let one = method.step(&mut with_points, options, (damping, points.as_mut_slice()), &[]);
            let other = method.step(&mut with_pins, options, damping, &[]);
            let (one, other) = match (one, other) {
                (Ok(one), Ok(other)) => (one, other),
                // Beyond a limit, or of a long step no end: both.
                (one, other) => {
                    assert!(one.is_err() && one == other && h > 0.1, "{method:?}, {h} s: {one:?}, {other:?}");
                    continue;
                }
            };
            assert_eq!((one.clamped, one.certified), (other.clamped, other.certified), "{method:?}, {h} s");
            let off = build::farthest(&build::positions(&with_points), &build::positions(&with_pins)[..2])
                .max(build::farthest(&build::velocities(&with_points), &build::velocities(&with_pins)[..2]));
            println!("{method:?}, {h} s: {off:.1e}, {} clamped", one.clamped);
            assert!(off <= allowed::DENSE_STEP, "{method:?}, {h} s: {off:e}");
        }
    }
}
