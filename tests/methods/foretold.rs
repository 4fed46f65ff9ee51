//! What an attempt that is not taken says of the step that would be.

use hooke::{Adaptive, Embedded, Probed, Rosenbrock2, Rosenbrock3, Verlet};
use hooke_tests::vec_memory::VecScene;
use hooke_tests::{build, generate};

const JOULES: f64 = 1e-4;

/// Attempts until one was about as long as the step that it asks for.
fn settled<I: Embedded<f64>>(scene: &mut VecScene<f64>, method: &mut Adaptive<I, f64>) -> Probed<f64> {
    for _ in 0..20 {
        let probed = method.probe(scene, &[]).unwrap();
        assert_eq!(probed.dt, method.dt());
        if probed.settled {
            return probed;
        }
    }
    panic!("no length is right");
}

/// A cloth that has fallen into its pins, 0.1 s of it.
fn fallen() -> VecScene<f64> {
    let data = generate::cloth(5);
    let mut forces = build::Forces::<f64>::new(&data);
    let mut scene = build::scene::<f64>(&data);
    let mut method = Verlet::new(0.001).with(forces.all());
    (0..100).for_each(|_| assert!(scene.step(&mut method).is_ok()));
    scene
}

#[test]
fn where_the_limit_holds_a_step_its_error_is_foretold_to_the_bit_and_is_below_what_was_asked_for() {
    let data = generate::cloth(5);
    let mut forces = build::Forces::<f64>::new(&data);
    let mut scene = fallen();
    let mut method = Adaptive::new(Verlet::new(1.0).with(forces.all()), 1e-5, 1e6 * JOULES);
    let before = build::bits(&scene);
    let limit = settled(&mut scene, &mut method).dt;
    let probed = settled(&mut scene, &mut method);
    assert_eq!(build::bits(&scene), before);
    assert_eq!(probed.dt, limit, "there is no longer one");
    let report = scene.step(&mut method).unwrap();
    assert_eq!((method.made().dt, method.made().error.energy), (probed.dt, probed.energy));
    assert_eq!(report, probed.report);
    assert!(probed.energy > 0.0 && probed.energy < JOULES, "{:e} J", probed.energy);
}

#[test]
fn where_the_error_holds_a_step_it_is_foretold_by_the_order_and_is_about_what_was_asked_for() {
    fn check<I: Embedded<f64>>(method: I) {
        let mut scene = fallen();
        let mut method = Adaptive::new(method, 1e-5, JOULES);
        let probed = settled(&mut scene, &mut method);
        scene.step(&mut method).unwrap();
        let made = method.made();
        println!("{:e} s: {:e} J foretold, {:e} J", probed.dt, probed.energy, made.error.energy);
        assert_eq!((made.dt, made.rejections), (probed.dt, 0));
        // 0.9 of the length at which it would be J, to the fourth or the sixth power.
        assert!(probed.energy > 0.5 * JOULES && probed.energy < 0.7 * JOULES);
        assert!(made.error.energy < 2.0 * probed.energy && probed.energy < 2.0 * made.error.energy);
    }
    let data = generate::cloth(5);
    let mut forces = build::Forces::<f64>::new(&data);
    let memory = vec![[f64::NAN; 3]; Rosenbrock3::<f64, ()>::needs(data.len())];
    check(Rosenbrock2::new(1.0, memory.clone()).with(forces.all()));
    check(Rosenbrock3::new(1.0, memory).with(forces.all()));
}
