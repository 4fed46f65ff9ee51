//! l → 0: where the ends of a spring coincide there is no direction, and the rules say so.

use hooke::{Hessian, LinearlyImplicitEuler, PointSpring, Real, Scaling, Spring, Stretched};
use hooke_tests::data::SceneData;
use hooke_tests::vec_memory::VecScene;
use hooke_tests::{allowed, build, lanes};

fn pair<T: Real>(apart: T, rest_length: f64) -> VecScene<T> {
    let mut scene = VecScene::<T>::empty();
    let a = scene.particle([T::ONE, T::ZERO, T::ZERO], T::ONE).unwrap();
    let b = scene.particle([T::ONE, apart, T::ZERO], T::ONE).unwrap();
    scene
        .spring_with(a, b, Spring { stiffness: T::from_f64(50.0), rest_length: T::from_f64(rest_length) })
        .unwrap();
    scene
}

fn rules<T: Real>(underflows: T) {
    for apart in [T::ZERO, underflows] {
        for (rest_length, replaced) in [(0.0, 0), (0.5, 1)] {
            let mut scene = pair(apart, rest_length);
            let mut f = [[T::ZERO; 3]; 2];
            scene.springs().add_force(&mut f);
            assert_eq!(f, [[T::ZERO; 3]; 2], "no direction is preferred");
            let hessian = scene.springs().hessian_of(0).unwrap();
            assert_eq!(hessian, Hessian { alpha: T::from_f64(50.0), w: [T::ZERO; 3] }, "H = kI");
            let before = build::bits(&scene);
            let report = scene.step(&mut LinearlyImplicitEuler::new(T::from_f64(0.01))).unwrap();
            assert_eq!(report.clamped, replaced, "counted as projected exactly where l₀ > 0");
            assert_eq!(build::bits(&scene), before, "nothing pulls");
        }
    }
}

#[test]
fn where_l_is_zero_or_underflows_f_is_zero_and_h_is_k_times_identity() {
    rules::<f64>(1e-170);
    rules::<f32>(1e-20);
}

#[test]
fn a_length_of_zero_is_counted_only_where_the_rest_length_is_not_zero() {
    let spring = Spring { stiffness: 2.0, rest_length: 0.0 };
    assert_eq!(spring.potential_energy(Stretched::<f64>::new([0.0; 3]).length), 0.0);
    let spring = Spring { stiffness: 2.0, rest_length: 3.0 };
    assert_eq!(spring.potential_energy(Stretched::<f64>::new([0.0; 3]).length), 9.0);
}

#[test]
fn coincident_particles_with_different_velocities_separate() {
    let mut scene = pair(0.0, 0.0);
    scene.set_velocity(0, [1.0, 0.0, 0.0]).unwrap();
    scene.set_velocity(1, [-1.0, 0.0, 0.0]).unwrap();
    scene.step(&mut LinearlyImplicitEuler::new(0.01).tolerance(1e-14)).unwrap();
    // l₀ = 0: A = 1 + 2·h²k along the difference, so v⁺ = v/(1 + 0.01).
    let v = scene.velocities()[0][0];
    assert!((v - 1.0 / 1.01).abs() <= 8.0 * hooke_tests::allowed::U64, "{v}");
    assert_eq!(scene.velocities()[1][0], -v);
}

#[test]
fn a_point_spring_at_its_target_does_not_pull_and_is_counted_where_its_rest_length_is_not_zero() {
    for (rest_length, replaced) in [(0.0, 0), (0.5, 1)] {
        let mut scene = VecScene::<f64>::empty();
        let i = scene.particle([1.0, 2.0, 3.0], 1.0).unwrap();
        let point = PointSpring::new(i, [1.0, 2.0, 3.0], 10.0).rest_length(rest_length);
        let before = build::bits(&scene);
        let report = scene.step(&mut LinearlyImplicitEuler::new(0.01).with(point)).unwrap();
        assert_eq!(report.clamped, replaced);
        assert_eq!(build::bits(&scene), before);
    }
}

#[test]
fn clamping_first_and_then_w_keeps_the_axial_stiffness_k_down_to_the_shortest_length() {
    // With the old w the axial stiffness would be k·l₀/l, which diverges.
    let spring = Spring { stiffness: 64.0, rest_length: 1.0 };
    for length in [0.5, 2f64.powi(-20), 2f64.powi(-100), 2f64.powi(-500)] {
        let stretched = Stretched::new([0.0, length, 0.0]);
        let h = Hessian::clamped(spring, stretched, 0.0, Scaling::unit());
        assert_eq!(h, Hessian { alpha: 0.0, w: [0.0, 8.0, 0.0] });
        assert_eq!(h.mul([0.0, 1.0, 0.0]), [0.0, 64.0, 0.0]);
        assert_eq!(h.mul([1.0, 0.0, 1.0]), [0.0; 3]);
    }
}

#[test]
fn a_replaced_hessian_counts_as_projected_and_its_step_as_not_certified() {
    let mut scene = hooke::Scene::<f64, 2, 1>::new();
    scene.particle([0.0; 3], 1.0).unwrap();
    scene.particle([0.0; 3], 1.0).unwrap();
    scene.spring_with(0, 1, hooke::Spring { stiffness: 5.0, rest_length: 1.0 }).unwrap();
    let report = scene.step(&mut hooke::LinearlyImplicitEuler::new(0.1)).unwrap();
    assert_eq!((report.clamped, report.is_certified()), (1, false));
}

/// The right side once held the true Hessian, k l₀/l and all, before the clamped one took its place, and lost the force: at
/// l = 1e-14 m the fifth digit of it, at 1e-20 m all of it.
#[test]
fn a_clamped_spring_pushes_its_ends_apart_however_short_it_is() {
    fn check<T: Real>(lengths: &[f64], wide: bool) {
        let real = T::from_f64;
        for l in lengths {
            let mut data = SceneData::default();
            let pin = data.particle([0.0; 3], 1.0);
            data.pinned[pin] = true;
            let i = data.particle([0.6 * l, 0.8 * l, 0.0], 1.0);
            data.velocity[i] = [0.3, 0.0, 0.0];
            data.spring_with(pin, i, 100.0, 1.0);
            let mut scene = build::scene::<T>(&data);
            let h = 1.0 / 64.0;
            let mut euler = LinearlyImplicitEuler::new(real(h)).tolerance(real(1e-14));
            let report = if wide {
                let mut solver = lanes::wide::<T>(&data);
                let report = scene.step(&mut euler.solver(&mut solver)).unwrap();
                assert!(solver.in_lanes());
                report
            } else {
                scene.step(&mut euler).unwrap()
            };
            assert_eq!(report.clamped, 1);
            let v = scene.velocities()[i].map(T::to_f64);
            let exact = 0.18 + (h * 100.0 * (1.0 - l) - h * h * 100.0 * 0.18) / (1.0 + h * h * 100.0);
            let off = 0.6 * v[0] + 0.8 * v[1] - exact;
            assert!(
                off.abs() < allowed::SHORT_SPRING_SPEED * T::UNIT_ROUNDOFF.to_f64(),
                "l = {l:e}: off by {off:e}"
            );
        }
    }
    for wide in [false, true] {
        check::<f64>(&[1e-3, 1e-8, 1e-14, 1e-20, 1e-40, 1e-150], wide);
        check::<f32>(&[1e-3, 1e-8, 1e-15], wide);
    }
}
