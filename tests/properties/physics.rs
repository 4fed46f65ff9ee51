//! V, its gradient and Hessian, symmetry, momentum, equivariance.

use hooke::{LinearlyImplicitEuler, Real, Spring};
use hooke_tests::data::{SceneData, distance};
use hooke_tests::generate::{self, Ingredients};
use hooke_tests::precise::{self, Big, big, small};
use hooke_tests::random::Random;
use hooke_tests::{allowed, build};
use proptest::prelude::*;

use crate::config;

/// A point of a box of some decades of size.
fn point() -> impl Strategy<Value = [f64; 3]> {
    (prop::array::uniform3(-1.0..1.0f64), -3..3i32).prop_map(|(x, p)| x.map(|x| x * 10f64.powi(p)))
}

fn spring() -> impl Strategy<Value = Spring<f64>> {
    (-6.0..6.0f64, prop_oneof![Just(0.0), 1e-3..10.0f64])
        .prop_map(|(p, rest_length)| Spring { stiffness: 10f64.powf(p), rest_length })
}

/// One spring as a scene, so that the multi-precision oracle reads it.
fn alone(spring: Spring<f64>, a: [f64; 3], b: [f64; 3]) -> SceneData {
    let mut data = SceneData::default();
    data.particle(a, 1.0);
    data.particle(b, 1.0);
    data.spring_with(0, 1, spring.stiffness, spring.rest_length);
    data
}

/// ∂(∂V/∂x_A)/∂x by a central difference in 208 bits.
fn precise_hessian(data: &SceneData) -> [[f64; 3]; 3] {
    let step = precise::two_to_minus(40);
    let at = precise::bigs(&data.position);
    let mut hessian = [[0.0; 3]; 3];
    for c in 0..3 {
        let gradient = |sign: f64| -> [Big; 3] {
            let mut q = at.clone();
            q[0][c] = &at[0][c] + big(sign) * &step;
            precise::gradient(data, &q)[0].clone()
        };
        let (after, before) = (gradient(1.0), gradient(-1.0));
        for r in 0..3 {
            hessian[r][c] = small(&((&after[r] - &before[r]) / (&step + &step)));
        }
    }
    hessian
}

proptest! {
    #![proptest_config(config(1, 256))]

    #[test]
    fn the_gradient_of_a_spring_is_the_difference_of_v(spring in spring(), a in point(), b in point()) {
        let l = distance(a, b);
        prop_assume!(l > 1e-6);
        let data = alone(spring, a, b);
        let expected = precise::derivative(|q| precise::potential(&data, q), &precise::bigs(&data.position));
        // The central difference of step 2⁻⁴⁰ is off by step²·V‴/6 ≤ 2⁻⁸⁰·k·l₀/l², nothing at these lengths.
        let allowed = allowed::SPRING_FORCE * allowed::U64 * spring.stiffness * (l + spring.rest_length)
            + 2f64.powi(-78) * spring.stiffness * spring.rest_length / (l * l);
        for (end, expected) in spring.gradient(a, b).iter().zip(&expected) {
            for (g, expected) in end.iter().zip(expected) {
                prop_assert!((g - expected).abs() <= allowed, "{g} for {expected}");
            }
        }
    }

    #[test]
    fn the_hessian_of_a_spring_is_the_difference_of_its_gradient(spring in spring(), a in point(), b in point()) {
        let l = distance(a, b);
        prop_assume!(l > 1e-4);
        let expected = precise_hessian(&alone(spring, a, b));
        let size = spring.stiffness * (1.0 + spring.rest_length / l);
        let allowed = allowed::COMPRESSED_HESSIAN * allowed::U64 * size
            + 2f64.powi(-76) * spring.stiffness * spring.rest_length / (l * l * l);
        let blocks = spring.dense_hessian(a, b);
        for r in 0..3 {
            for c in 0..3 {
                prop_assert!((blocks[0][0][r][c] - expected[r][c]).abs() <= allowed);
                prop_assert_eq!(blocks[0][0][r][c], blocks[0][0][c][r]);
                prop_assert_eq!(blocks[0][0][r][c], -blocks[0][1][r][c]);
                prop_assert_eq!(blocks[1][1][r][c], blocks[0][0][r][c]);
            }
        }
    }

    #[test]
    fn v_is_never_negative_and_zero_only_at_the_rest_length(spring in spring(), a in point(), b in point()) {
        let mut scene = build::scene::<f64>(&alone(spring, a, b));
        let v = scene.springs().potential_energy();
        let length = scene.springs().length_of(0).unwrap();
        prop_assert!(v >= 0.0);
        prop_assert_eq!(v == 0.0, length == spring.rest_length);
        scene.set_rest_length(0, length).unwrap();
        prop_assert_eq!(scene.springs().potential_energy(), 0.0);
    }
}

fn network(seed: u64, with: Ingredients) -> SceneData {
    generate::network(&mut Random::new(seed), 10, with)
}

/// Σ over springs of k(1 + l₀/l): what a product with K is relative to.
fn stiffness_size(data: &SceneData) -> f64 {
    let one = |s: &hooke_tests::data::SpringData| {
        s.k * (1.0 + s.l0 / distance(data.position[s.a], data.position[s.b]))
    };
    data.springs.iter().map(one).sum()
}

fn momentum<T: Real>(scene: &hooke_tests::vec_memory::VecScene<T>) -> ([f64; 3], f64) {
    let (mut sum, mut size) = ([0.0; 3], 0.0);
    for (m, v) in scene.state().mass.iter().zip(build::velocities(scene)) {
        for d in 0..3 {
            sum[d] += m.to_f64() * v[d];
            size += (m.to_f64() * v[d]).abs();
        }
    }
    (sum, size)
}

proptest! {
    #![proptest_config(config(2, 64))]

    #[test]
    fn k_is_symmetric_as_an_operator(seed: u64) {
        let data = network(seed, Ingredients { compressed: true, ..Ingredients::default() });
        let scene = build::scene::<f64>(&data);
        let mut random = Random::new(seed ^ 1);
        let n = data.len();
        let (x, y): (Vec<_>, Vec<_>) = (0..n).map(|_| (random.vector(1.0), random.vector(1.0))).unzip();
        let (mut kx, mut ky) = (vec![[0.0; 3]; n], vec![[0.0; 3]; n]);
        scene.springs().stiffness_product(&x, &mut kx);
        scene.springs().stiffness_product(&y, &mut ky);
        let dot = |a: &[[f64; 3]], b: &[[f64; 3]]| -> f64 {
            a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| a * b).sum()
        };
        let off = (dot(&y, &kx) - dot(&x, &ky)).abs();
        // Both products lose 16u per spring and component, the dots 30u; |x|, |y| ≤ √3, differences twice that.
        prop_assert!(off <= allowed::SYMMETRIC_FORM * allowed::U64 * stiffness_size(&data));
    }

    #[test]
    fn the_sum_of_all_spring_forces_is_rounding(seed: u64) {
        let data = network(seed, Ingredients { compressed: true, ..Ingredients::default() });
        let mut f = vec![[0.0; 3]; data.len()];
        build::scene::<f64>(&data).springs().add_force(&mut f);
        let tensions: f64 =
            data.springs.iter().map(|s| s.k * (distance(data.position[s.a], data.position[s.b]) - s.l0).abs()).sum();
        for d in 0..3 {
            let sum: f64 = f.iter().map(|f| f[d]).sum();
            // f_A = −f_B bit for bit, so only the sums round: at most 30 terms in each.
            prop_assert!(sum.abs() <= 60.0 * allowed::U64 * tensions);
        }
    }

    #[test]
    fn momentum_of_a_free_network_is_kept_whatever_cuts_the_solve(seed: u64, cut in 1..20u32, h in 1e-3..0.05f64) {
        let data = network(seed, Ingredients { compressed: true, moving: true, ..Ingredients::default() });
        let mut scene = build::scene::<f64>(&data);
        let mut euler = LinearlyImplicitEuler::new(h).max_iterations(cut);
        for _ in 0..5 {
            let (before, size) = momentum(&scene);
            let impulses = build::impulses(&scene, h, 0.0);
            scene.step(&mut euler).unwrap();
            let (after, size_after) = momentum(&scene);
            let allowed = allowed::MOMENTUM * allowed::U64 * (size + size_after + impulses);
            for d in 0..3 {
                prop_assert!((after[d] - before[d]).abs() <= allowed);
            }
        }
    }

    #[test]
    fn energy_of_an_unforced_stretched_network_never_grows(seed: u64, h in 1e-3..0.1f64) {
        // l₀ = 0 everywhere: V is quadratic and convex, where euler loses energy at every step, at any h.
        let mut data = network(seed, Ingredients { pins: true, moving: true, ..Ingredients::default() });
        data.springs.iter_mut().for_each(|s| s.l0 = 0.0);
        let mut scene = build::scene::<f64>(&data);
        let mut euler = LinearlyImplicitEuler::new(h).tolerance(1e-12);
        let mut before = scene.springs().kinetic_energy() + scene.springs().potential_energy();
        for _ in 0..10 {
            scene.step(&mut euler).unwrap();
            let energy = scene.springs().kinetic_energy() + scene.springs().potential_energy();
            prop_assert!(energy >= 0.0 && energy <= before * (1.0 + allowed::ENERGY_GROWTH));
            before = energy;
        }
    }

    #[test]
    fn translation_rotation_and_permutation_of_the_axes_commute_with_a_step(seed: u64, angles in prop::array::uniform3(-3.0..3.0f64)) {
        let data = generate::gentle_network(seed, 10);
        prop_assume!(shortest(&data) > 0.2);
        let step = |data: &SceneData| {
            let mut scene = build::scene::<f64>(data);
            let mut forces = build::Forces::<f64>::new(data);
            scene.step(&mut forces.euler(1.0 / 60.0).tolerance(1e-14)).unwrap();
            (build::positions(&scene), build::velocities(&scene))
        };
        let rotation = nalgebra::Rotation3::from_euler_angles(angles[0], angles[1], angles[2]);
        let turn = |x: [f64; 3]| -> [f64; 3] { (rotation * nalgebra::Vector3::from(x)).into() };
        let exchange = |x: [f64; 3]| [x[2], x[0], x[1]];
        let shift = |x: [f64; 3]| [x[0] + angles[0], x[1] + angles[1], x[2] + angles[2]];
        let same = |x: [f64; 3]| x;
        type Map<'a> = &'a dyn Fn([f64; 3]) -> [f64; 3];
        let maps: [(Map<'_>, Map<'_>); 3] = [(&turn, &turn), (&exchange, &exchange), (&shift, &same)];
        let (position, velocity) = step(&data);
        for (of_x, of_v) in maps {
            let (moved, moving) = step(&data.moved(of_x, of_v));
            let position: Vec<[f64; 3]> = position.iter().copied().map(of_x).collect();
            let velocity: Vec<[f64; 3]> = velocity.iter().copied().map(of_v).collect();
            prop_assert!(build::farthest(&position, &moved) <= allowed::EQUIVARIANT_STEP);
            prop_assert!(build::farthest(&velocity, &moving) <= 60.0 * allowed::EQUIVARIANT_STEP);
        }
    }
}

fn shortest(data: &SceneData) -> f64 {
    let length = |s: &hooke_tests::data::SpringData| distance(data.position[s.a], data.position[s.b]);
    data.springs.iter().map(length).fold(f64::INFINITY, f64::min)
}
