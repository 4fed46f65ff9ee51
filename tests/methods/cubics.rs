//! Pins under way, by themselves: where both ends of a motion are those of a cubic, a pin is on that cubic after any part of it.

use hooke::{Course, Embedded, Motion, Real, Rosenbrock2, Rosenbrock3, Verlet};
use hooke_tests::vec_memory::VecScene;

/// a + bt + ct² + dt³ in each direction. Small whole numbers: at a 4th of a time nothing below rounds.
const WAY: [[f64; 4]; 3] = [[1.0, -3.0, 2.0, 5.0], [-2.0, 7.0, -11.0, 3.0], [0.0, 1.0, 13.0, -6.0]];

/// Where it is at t, and how fast.
fn way<T: Real>(t: f64) -> [[T; 3]; 2] {
    let place = WAY.map(|[a, b, c, d]| T::from_f64(a + t * (b + t * (c + t * d))));
    [place, WAY.map(|[_, b, c, d]| T::from_f64(b + t * (2.0 * c + t * 3.0 * d)))]
}

/// A scene of one particle, which is a pin where the way begins.
fn scene<T: Real>() -> VecScene<T> {
    let [position, velocity] = way(0.0);
    let mut scene = VecScene::<T>::empty();
    let i = scene.particle(position, T::ONE).unwrap();
    scene.pin(i).unwrap();
    scene.set_pin_velocity(i, velocity).unwrap();
    scene
}

/// A step of `dt`, of a motion that takes `over`.
fn part<T: Real>(method: &mut impl Embedded<T>, scene: &mut VecScene<T>, at: f64, dt: f64, over: f64) {
    let [position, velocity] = way(at + over);
    let motion = [Motion { particle: 0, position, velocity }];
    let course = Course { motion: &motion, over: T::from_f64(over) };
    method.attempt(&mut scene.parts(), T::from_f64(dt), course, T::ONE, &mut |_| {}).unwrap();
    method.accept(scene.parts(), course).unwrap();
}

fn on_the_cubic<T: Real, I: Embedded<T>>(method: impl Fn() -> I) {
    for over in [0.5, 1.0, 2.0] {
        for quarter in [0.25, 0.5, 0.75, 1.0] {
            let (mut scene, dt) = (scene::<T>(), quarter * over);
            part(&mut method(), &mut scene, 0.0, dt, over);
            let [position, velocity] = way::<T>(dt);
            assert_eq!(
                (scene.positions()[0], scene.velocities()[0]),
                (position, velocity),
                "{dt} s of {over} s"
            );
            // What is left of the motion is the cubic of its own ends; of its half a part is dyadic again.
            if dt < over {
                let left = over - dt;
                part(&mut method(), &mut scene, dt, left / 2.0, left);
                let [position, velocity] = way::<T>(dt + left / 2.0);
                assert_eq!(
                    (scene.positions()[0], scene.velocities()[0]),
                    (position, velocity),
                    "the rest of {over} s"
                );
            }
        }
    }
}

#[test]
fn a_pin_told_both_ends_of_a_cubic_is_on_it_after_any_part_bit_for_bit() {
    on_the_cubic::<f64, _>(|| Verlet::new(1.0));
    on_the_cubic::<f64, _>(|| Rosenbrock2::new(1.0, vec![[0.0; 3]; Rosenbrock2::<f64, ()>::needs(1)]));
    on_the_cubic::<f64, _>(|| Rosenbrock3::new(1.0, vec![[0.0; 3]; Rosenbrock3::<f64, ()>::needs(1)]));
    on_the_cubic::<f32, _>(|| Verlet::new(1.0));
}

#[test]
fn a_pin_that_is_told_a_whole_step_ends_at_its_end_whatever_the_way() {
    // 0.1 and its parts have no exact quotient: the end is taken, not computed.
    let mut scene = scene::<f64>();
    let motion = [Motion { particle: 0, position: [0.1, 0.7, -0.3], velocity: [1e-3, 3.7, 1e5] }];
    let course = Course { motion: &motion, over: 0.1 };
    let mut verlet = Verlet::new(1.0);
    verlet.attempt(&mut scene.parts(), 0.1, course, 1.0, &mut |_| {}).unwrap();
    verlet.accept(scene.parts(), course).unwrap();
    assert_eq!((scene.positions()[0], scene.velocities()[0]), (motion[0].position, motion[0].velocity));
}

#[test]
fn only_a_pin_of_the_scene_takes_a_velocity_of_a_pin_and_only_a_finite_one() {
    use hooke::EditError;
    let mut scene = scene::<f64>();
    scene.particle([0.0; 3], 1.0).unwrap();
    assert_eq!(scene.set_pin_velocity(1, [1.0; 3]), Err(EditError::NotPinned(1)));
    assert_eq!(scene.set_pin_velocity(2, [1.0; 3]), Err(EditError::NoParticle(2)));
    assert_eq!(scene.set_pin_velocity(0, [1.0, f64::NAN, 1.0]), Err(EditError::NotFinite(0)));
    assert_eq!(scene.velocities(), [way::<f64>(0.0)[1], [0.0; 3]]);
    scene.set_pin_velocity(0, [4.0, 5.0, 6.0]).unwrap();
    assert_eq!(scene.velocities(), [[4.0, 5.0, 6.0], [0.0; 3]]);
}
