//! The lecture's three demands on V, and the derivatives of the Lagrangian.

use hooke::{Real, Spring};
use hooke_tests::data::SceneData;
use hooke_tests::random::Random;
use hooke_tests::{allowed, build, generate, precise};

fn network(seed: u64) -> SceneData {
    let mut data = generate::gentle_network(seed, 8);
    for (i, v) in data.velocity.iter_mut().enumerate() {
        *v = if data.pinned[i] { [0.0; 3] } else { *v };
    }
    data
}

fn minimum_at_rest_length<T: Real>() {
    let spring = Spring { stiffness: T::from_f64(7.0), rest_length: T::from_f64(0.3) };
    assert_eq!(spring.potential_energy(spring.rest_length), T::ZERO);
    let (mut below, mut above) = (spring.rest_length, spring.rest_length);
    for _ in 0..1000 {
        // Each step of relative size 2u at least: the very neighbours of l₀ are among the lengths tried.
        below = below - below * T::UNIT_ROUNDOFF * T::TWO;
        above = above + above * T::UNIT_ROUNDOFF * T::TWO;
        assert!(spring.potential_energy(below) > T::ZERO && spring.potential_energy(above) > T::ZERO);
        assert!(spring.tension(below) < T::ZERO && spring.tension(above) > T::ZERO);
    }
    for factor in [0.0, 0.5, 0.99, 1.01, 2.0, 10.0] {
        assert!(spring.potential_energy(spring.rest_length * T::from_f64(factor)) > T::ZERO);
    }
}

#[test]
fn first_demand_v_is_least_at_the_rest_length() {
    minimum_at_rest_length::<f64>();
    minimum_at_rest_length::<f32>();
}

#[test]
fn second_demand_v_is_unchanged_by_rigid_motion() {
    let data = network(1);
    // Dyadic positions, so that a translation by a dyadic vector is exact: V has the same bits.
    let grid = |x: f64| (x * 1024.0).round() / 1024.0;
    let placed = data.moved(|x| x.map(grid), |v| v);
    let v = build::scene::<f64>(&placed).springs().potential_energy();
    assert!(v > 0.0);
    let shifted = placed.moved(|x| [x[0] + 8.0, x[1] - 3.5, x[2] + 0.125], |v| v);
    assert_eq!(build::scene::<f64>(&shifted).springs().potential_energy().to_bits(), v.to_bits());
    // Half turns and reflections only change signs.
    let turned = placed.moved(|x| [-x[0], x[1], -x[2]], |v| v);
    assert_eq!(build::scene::<f64>(&turned).springs().potential_energy().to_bits(), v.to_bits());
    // Any rotation, to rounding.
    let rotation = nalgebra::Rotation3::from_euler_angles(0.3, -1.1, 2.0);
    let rotated = data.moved(|x| (rotation * nalgebra::Vector3::from(x)).into(), |v| v);
    let (before, after) = (
        build::scene::<f64>(&data).springs().potential_energy(),
        build::scene::<f64>(&rotated).springs().potential_energy(),
    );
    let k: f64 = data.springs.iter().map(|s| s.k).sum();
    assert!((after - before).abs() <= allowed::ROTATED_ENERGY * allowed::U64 * k, "{before} {after}");
}

#[test]
fn third_demand_v_is_of_positions_only() {
    let mut data = network(2);
    let v = build::scene::<f64>(&data).springs().potential_energy();
    let mut random = Random::new(3);
    for v in &mut data.velocity {
        *v = random.vector(100.0);
    }
    assert_eq!(build::scene::<f64>(&data).springs().potential_energy().to_bits(), v.to_bits());
}

#[test]
fn derivative_of_the_lagrangian_by_velocity_is_mass_times_velocity() {
    let data = network(4);
    let scene = build::scene::<f64>(&data);
    let mut seen = data.clone();
    build::read_back(&scene, &mut seen);
    let q = precise::bigs(&seen.position);
    let by_velocity =
        precise::derivative(|v| precise::lagrangian(&seen, &q, v), &precise::bigs(&seen.velocity));
    let state = scene.state();
    for ((d, m), v) in by_velocity.iter().zip(state.mass).zip(state.velocity) {
        for (d, v) in d.iter().zip(v) {
            // L is quadratic in q̇: the central difference is exact but for its 2⁻²⁰⁸; one rounding here, one there.
            assert!((d - m * v).abs() <= 2.0 * allowed::U64 * (m * v).abs(), "{d} for {}", m * v);
        }
    }
}

#[test]
fn derivative_of_the_lagrangian_by_position_is_the_force() {
    for seed in 5..10 {
        let data = network(seed);
        let scene = build::scene::<f64>(&data);
        let velocity = precise::bigs(&data.velocity);
        let by_position =
            precise::derivative(|q| precise::lagrangian(&data, q, &velocity), &precise::bigs(&data.position));
        let mut f = vec![[0.0; 3]; data.len()];
        scene.springs().add_force(&mut f);
        let mut allowed = vec![0.0; data.len()];
        for s in &data.springs {
            let l = hooke_tests::data::distance(data.position[s.a], data.position[s.b]);
            for end in [s.a, s.b] {
                allowed[end] += allowed::SPRING_FORCE * allowed::U64 * s.k * (l + s.l0);
            }
        }
        for (i, (f, d)) in f.iter().zip(&by_position).enumerate() {
            for (f, d) in f.iter().zip(d) {
                assert!((f - d).abs() <= allowed[i], "seed {seed}, particle {i}: {f} for {d}");
            }
        }
    }
}

#[test]
fn kinetic_potential_and_lagrangian_are_the_multi_precision_ones_to_rounding() {
    for seed in 10..15 {
        let data = network(seed);
        let scene = build::scene::<f64>(&data);
        let (q, v) = (precise::bigs(&data.position), precise::bigs(&data.velocity));
        let springs = scene.springs();
        let (t, p) =
            (precise::small(&precise::kinetic(&data, &v)), precise::small(&precise::potential(&data, &q)));
        let size: f64 = data.springs.iter().map(|s| s.k * s.l0.max(1.0).powi(2) * 4.0).sum();
        let allowed = allowed::ENERGY * allowed::U64 * (t + size);
        assert!((springs.kinetic_energy() - t).abs() <= allowed);
        assert!((springs.potential_energy() - p).abs() <= allowed);
        assert!(
            (springs.lagrangian() - precise::small(&precise::lagrangian(&data, &q, &v))).abs()
                <= 2.0 * allowed
        );
        assert_eq!(springs.lagrangian(), springs.kinetic_energy() - springs.potential_energy());
    }
}
