//! Drag and damping along springs.

use hooke::{Drag, LinearlyImplicitEuler, Real, Spring, SpringDamping};
use hooke_tests::allowed;
use hooke_tests::random::Random;
use hooke_tests::vec_memory::VecScene;

#[test]
fn drag_divides_velocity_by_one_plus_h_d_per_step_bit_for_bit() {
    // h·d = 1, mass dyadic: every step halves the velocity, and nothing rounds.
    let mut scene = VecScene::<f64>::empty();
    let i = scene.particle([0.0; 3], 0.5).unwrap();
    scene.set_velocity(i, [1.0, -3.0, 0.75]).unwrap();
    let mut euler = LinearlyImplicitEuler::new(0.125).with(Drag(8.0));
    for n in 1..=40 {
        scene.step(&mut euler).unwrap();
        assert_eq!(scene.velocities()[i], [1.0, -3.0, 0.75].map(|v: f64| v / 2f64.powi(n)), "step {n}");
    }
}

fn decays<T: Real>(unit: f64) {
    let mut random = Random::new(1);
    for _ in 0..200 {
        let (h, d, m) = (random.decade(1e-4, 1.0), random.decade(1e-3, 1e3), random.decade(1e-3, 1e3));
        let (h, d, m) = (T::from_f64(h), T::from_f64(d), T::from_f64(m));
        let mut scene = VecScene::<T>::empty();
        let i = scene.particle([T::ZERO; 3], m).unwrap();
        let v = T::from_f64(random.between(0.1, 1.0));
        scene.set_velocity(i, [v, T::ZERO, T::ZERO]).unwrap();
        scene.step(&mut LinearlyImplicitEuler::new(h).with(Drag(d)).tolerance(T::ZERO)).unwrap();
        let (found, v) = (scene.velocities()[i][0].to_f64(), v.to_f64());
        let expected = v / (1.0 + h.to_f64() * d.to_f64());
        // v + Δ cancels where hd is large: the error is relative to v.
        assert!((found - expected).abs() <= allowed::DRAG * unit * v, "{found} for {expected}");
    }
}

#[test]
fn drag_divides_velocity_by_one_plus_h_d_per_step() {
    decays::<f64>(allowed::U64);
    decays::<f32>(allowed::U32);
}

/// A square with one diagonal, away from the origin.
fn square() -> VecScene<f64> {
    let mut scene = VecScene::<f64>::empty();
    for x in [[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [1.0, 1.0, 0.0]] {
        scene.particle(x, 0.5).unwrap();
    }
    for (a, b) in [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)] {
        scene.spring(a, b, 10.0).unwrap();
    }
    scene
}

/// The right side of the step: h·f − H·Δq̇, zero where neither force nor damping acts.
fn impulses(scene: &mut VecScene<f64>, damping: f64) -> Vec<[f64; 3]> {
    let mut right = Vec::new();
    let mut euler = LinearlyImplicitEuler::new(0.01).with(SpringDamping(damping));
    let see = |_: &hooke::System<'_, f64, _>, b: &[[f64; 3]], _: &[f64]| right.extend_from_slice(b);
    euler.inspect(scene.parts(), &[], see).unwrap();
    right
}

#[test]
fn damping_along_springs_does_not_resist_translation_bit_for_bit() {
    let mut scene = square();
    for i in 0..4 {
        scene.set_velocity(i, [0.3, -0.7, 1.1]).unwrap();
    }
    assert_eq!(impulses(&mut scene, 1e3), vec![[0.0; 3]; 4]);
}

#[test]
fn damping_along_springs_does_not_resist_rotation_bit_for_bit() {
    // ω = (0, 0, 2): u·(ω×Δx) = 0, with these numbers without rounding. At l = l₀ there is α = 0 and no other term.
    let mut scene = square();
    for i in 0..4 {
        let x = scene.positions()[i];
        scene.set_velocity(i, [-2.0 * x[1], 2.0 * x[0], 0.0]).unwrap();
    }
    assert_eq!(impulses(&mut scene, 1e3), vec![[0.0; 3]; 4]);
}

#[test]
fn damping_resists_the_change_of_length_by_c_times_its_rate() {
    let mut scene = VecScene::<f64>::empty();
    scene.particle([0.0; 3], 1.0).unwrap();
    scene.particle([1.0, 0.0, 0.0], 1.0).unwrap();
    scene.spring_with(0, 1, Spring { stiffness: 0.0, rest_length: 1.0 }).unwrap();
    scene.set_velocity(1, [0.5, 3.0, 0.0]).unwrap();
    // h c l̇ along the spring, nothing across: h = 0.01, c = 4·1e2 so that √(hc) = 2 is exact to rounding.
    let right = impulses(&mut scene, 400.0);
    assert!((right[1][0] + 0.01 * 400.0 * 0.5).abs() <= 8.0 * allowed::U64 * 2.0, "{right:?}");
    assert_eq!(right[1][1..], [0.0; 2]);
    assert_eq!(right[0], right[1].map(|b| -b));
}

#[test]
fn coefficients_per_spring_act_on_their_spring_and_are_zero_past_the_end() {
    let (mut all, mut listed) = (square(), square());
    for scene in [&mut all, &mut listed] {
        scene.set_velocity(2, [1.0, 2.0, 3.0]).unwrap();
    }
    let mut one = LinearlyImplicitEuler::new(0.01).with(SpringDamping(2.5));
    let mut each = LinearlyImplicitEuler::new(0.01).with(SpringDamping([2.5; 5].as_slice()));
    let mut none = LinearlyImplicitEuler::new(0.01).with(SpringDamping([].as_slice()));
    assert_eq!(all.step(&mut one), listed.step(&mut each));
    assert_eq!(hooke_tests::build::bits(&all), hooke_tests::build::bits(&listed));
    let (mut a, mut b) = (square(), square());
    for scene in [&mut a, &mut b] {
        scene.set_velocity(2, [1.0, 2.0, 3.0]).unwrap();
    }
    assert_eq!(a.step(&mut none), b.step(&mut LinearlyImplicitEuler::new(0.01)));
    assert_eq!(hooke_tests::build::bits(&a), hooke_tests::build::bits(&b));
}
