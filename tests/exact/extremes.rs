//! The certificate at the ends of the number range, and over many islands.

use hooke::{LinearlyImplicitEuler, PointForce, Spring};
use hooke_tests::vec_memory::VecScene;

#[test]
fn the_upper_bound_is_above_the_error_also_where_squares_of_the_residual_underflow() {
    // b = h f = 1e-25: |b|² is no f32, but the solution b/m is, and leaving it out is an error of ½ b²/m > 0.
    let mut scene = VecScene::<f32>::empty();
    let i = scene.particle([0.0; 3], 1e-15).unwrap();
    let force = PointForce { particle: i, force: [1e-25, 0.0, 0.0] };
    let report = scene.step(&mut LinearlyImplicitEuler::new(1.0).with(force)).unwrap();
    let exact = 1e-25 / 1e-15;
    let error = f64::from(scene.velocities()[i][0]) - exact;
    let energy = 0.5 * 1e-15 * error * error;
    let upper = f64::from(report.upper);
    assert!(energy <= upper, "error {energy:e} J, reported at most {upper:e} J");
}

#[test]
fn a_solve_that_overflows_is_not_called_converged() {
    // |b|² is beyond f32, so neither tolerance nor bound can be judged: nothing may claim that 0 iterations met R.
    let mut scene = VecScene::<f32>::empty();
    let i = scene.particle([0.0; 3], 1.0).unwrap();
    let pin = scene.particle([1.0, 0.0, 0.0], 1.0).unwrap();
    scene.pin(pin).unwrap();
    scene.spring(i, pin, 1.0).unwrap();
    let force = PointForce { particle: i, force: [1e20, 0.0, 0.0] };
    let result = scene.step(&mut LinearlyImplicitEuler::new(1.0).with(force));
    if let Ok(report) = result {
        assert_eq!(report.untouched, 0, "the velocity is {:?} and not 1e20 m/s", scene.velocities()[i]);
    }
}

#[test]
fn a_step_never_answers_a_bound_that_is_no_number() {
    // The length overflows in f32: the force is no number, so the step cannot meet its contract.
    let mut scene = VecScene::<f32>::empty();
    let a = scene.particle([0.0; 3], 1.0).unwrap();
    let b = scene.particle([3e19, 0.0, 0.0], 1.0).unwrap();
    scene.pin(a).unwrap();
    scene.spring_with(a, b, Spring { stiffness: 1.0, rest_length: 1.0 }).unwrap();
    if let Ok(report) = scene.step(&mut LinearlyImplicitEuler::new(1e-3)) {
        assert!(!report.upper.is_nan() && !report.lower.is_nan(), "{report:?}");
    }
}

#[test]
fn the_bounds_of_a_step_are_bounds_also_when_summed_over_many_islands() {
    // One particle per island, held by a spring without stiffness, A = m exactly, no iteration: ½‖e‖² = ½|b|²/m each,
    // b = h·m·g.
    let mut scene = VecScene::<f32>::empty();
    let islands = 20_000;
    let pin = scene.particle([1.0, 0.0, 0.0], 1.0).unwrap();
    scene.pin(pin).unwrap();
    for _ in 0..islands {
        let i = scene.particle([0.0; 3], 0.7).unwrap();
        scene.spring(pin, i, 0.0).unwrap();
    }
    let mut euler = LinearlyImplicitEuler::new(1.0f32 / 60.0).gravity([0.0, -9.81, 0.0]).max_iterations(0);
    let mut exact = 0.0;
    let add = |_: &hooke::System<'_, f32, _>, b: &[[f32; 3]], _: &[f32]| {
        exact += 0.5 * f64::from(b[0][1]).powi(2) / f64::from(0.7f32);
    };
    euler.inspect(scene.parts(), &[], add).unwrap();
    let report = scene.step(&mut euler).unwrap();
    assert_eq!(report.islands, islands);
    let (lower, upper) = (f64::from(report.lower), f64::from(report.upper));
    assert!(lower <= exact && exact <= upper, "{exact:e} not in [{lower:e}, {upper:e}]");
}

#[test]
fn islands_whose_bounds_have_no_finite_sum_are_an_error_that_names_the_one_too_many() {
    // ½|b|²/m = 1.6e38 J for each: f32 ends at 3.4e38.
    for many in 1..4_u8 {
        let mut scene = VecScene::<f32>::empty();
        let pin = scene.particle([0.0; 3], 1.0).unwrap();
        scene.pin(pin).unwrap();
        let mut forces = Vec::new();
        for _ in 0..many {
            let i = scene.particle([1.0, 0.0, 0.0], 1.0).unwrap();
            scene.spring(pin, i, 1.0).unwrap();
            forces.push(PointForce { particle: i, force: [1.8e19, 0.0, 0.0] });
        }
        let before = scene.velocities().to_vec();
        let mut euler = LinearlyImplicitEuler::new(1.0).with(forces.as_mut_slice()).max_iterations(0);
        let made = scene.step(&mut euler);
        if many < 3 {
            let upper = f64::from(made.unwrap().upper) / f64::from(many);
            assert!(upper > 1.6e38 && upper < 1.65e38, "{upper}");
        } else {
            assert_eq!(made.unwrap_err(), hooke::StepError::NotFinite(3));
        }
        assert_eq!(scene.velocities(), before);
    }
}
