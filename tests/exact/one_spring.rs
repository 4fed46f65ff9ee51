//! The previous lecture's spring, and free fall.

use hooke::{LinearlyImplicitEuler, Real, Spring};
use hooke_tests::allowed;
use hooke_tests::build;
use hooke_tests::data::SceneData;
use hooke_tests::vec_memory::VecScene;

/// A wall at x = 0, k = 1 N/m, l₀ = 1 m, 1 kg at x = 1.5 m.
fn spring() -> SceneData {
    let mut data = SceneData::default();
    let wall = data.particle([0.0; 3], 1.0);
    let ball = data.particle([1.5, 0.0, 0.0], 1.0);
    data.pinned[wall] = true;
    data.spring_with(wall, ball, 1.0, 1.0);
    data
}

#[test]
fn omega_squared_is_k_over_m() {
    let scene = build::scene::<f64>(&spring());
    let mut f = [[0.0; 3]; 2];
    scene.springs().stiffness_product(&[[0.0; 3], [1.0, 0.0, 0.0]], &mut f);
    let omega_squared = -f[1][0] / scene.state().mass[1];
    assert!((omega_squared - 1.0).abs() <= allowed::SPRING_STIFFNESS * allowed::U64, "{omega_squared}");
}

#[test]
fn with_rest_length_zero_and_h_omega_one_energy_halves_at_every_step_bit_for_bit() {
    let mut scene = VecScene::<f64>::empty();
    let wall = scene.particle([0.0; 3], 1.0).unwrap();
    let ball = scene.particle([0.5, 0.0, 0.0], 1.0).unwrap();
    scene.pin(wall).unwrap();
    scene.spring_with(wall, ball, Spring { stiffness: 1.0, rest_length: 0.0 }).unwrap();
    let mut euler = LinearlyImplicitEuler::new(1.0);
    let mut energy = scene.springs().kinetic_energy() + scene.springs().potential_energy();
    for step in 0..20 {
        scene.step(&mut euler).unwrap();
        let next = scene.springs().kinetic_energy() + scene.springs().potential_energy();
        assert_eq!(next, energy / 2.0, "step {step}");
        energy = next;
    }
}

fn energy_falls<T: Real>(unit: f64, h: f64) {
    let mut scene = build::scene::<T>(&spring());
    let mut euler = LinearlyImplicitEuler::new(T::from_f64(h)).tolerance(T::ZERO);
    let energy = |scene: &VecScene<T>| {
        let data = build::positions(scene);
        let v = build::velocities(scene)[1][0];
        0.5 * v * v + 0.5 * (data[1][0] - 1.0).powi(2)
    };
    let h = T::from_f64(h).to_f64();
    for step in 0..100 {
        let before = energy(&scene);
        scene.step(&mut euler).unwrap();
        let ratio = energy(&scene) * (1.0 + h * h) / before;
        let amplitude = (2.0 * before).sqrt();
        let allowed = allowed::SPRING_ENERGY * unit / amplitude;
        assert!((ratio - 1.0).abs() <= allowed, "step {step}: {ratio}, allowed {allowed:e}");
    }
}

#[test]
fn energy_of_the_spring_scene_falls_by_one_over_one_plus_h2_omega2_at_every_step() {
    energy_falls::<f64>(allowed::U64, 1.0 / 8.0);
    energy_falls::<f64>(allowed::U64, 1.0 / 60.0);
    energy_falls::<f32>(allowed::U32, 1.0 / 8.0);
}

#[test]
fn free_fall_is_the_closed_form_with_theta_one_bit_for_bit() {
    // x_n = x₀ + v₀t − ½gt² − ½ght with dyadic numbers: no operation rounds.
    let (h, g, x0, v0) = (1.0 / 64.0, 9.8125, 2.0, [0.5, 3.0, -0.25]);
    let mut scene = VecScene::<f64>::empty();
    let i = scene.particle([0.0, x0, 0.0], 0.25).unwrap();
    scene.set_velocity(i, v0).unwrap();
    let mut euler = LinearlyImplicitEuler::new(h).gravity([0.0, -g, 0.0]);
    for n in 1..=200 {
        scene.step(&mut euler).unwrap();
        let t = f64::from(n) * h;
        assert_eq!(
            scene.positions()[i],
            [v0[0] * t, x0 + v0[1] * t - 0.5 * g * t * t - 0.5 * g * h * t, v0[2] * t]
        );
        assert_eq!(scene.velocities()[i], [v0[0], v0[1] - g * t, v0[2]]);
    }
}

#[test]
fn strain_and_stretch_factor_are_l_minus_l0_and_1_minus_l0_over_l_where_there_is_a_length() {
    let mut scene = hooke::Scene::<f64, 4, 3>::new();
    for x in [[0.0; 3], [3.0, 4.0, 0.0], [3.0, 4.0, 1.0], [3.0, 4.0, 1.0]] {
        scene.particle(x, 1.0).unwrap();
    }
    for (a, b, rest_length) in [(0, 1, 2.5), (1, 2, 4.0), (2, 3, 1.0)] {
        scene.spring_with(a, b, hooke::Spring { stiffness: 1.0, rest_length }).unwrap();
    }
    let found = |scene: &hooke::Scene<f64, 4, 3>, j: usize| {
        (scene.springs().length_of(j), scene.springs().strain_of(j), scene.springs().stretch_factor_of(j))
    };
    assert_eq!(found(&scene, 0), (Some(5.0), Some(2.5), Some(0.5)), "stretched");
    assert_eq!(found(&scene, 1), (Some(1.0), Some(-3.0), Some(-3.0)), "compressed");
    assert_eq!(found(&scene, 2), (Some(0.0), Some(-1.0), None), "of length 0");
    assert_eq!(found(&scene, 3), (None, None, None), "out of range");
    scene.break_spring(0).unwrap();
    assert_eq!(found(&scene, 0), (None, None, None), "broken");
}
