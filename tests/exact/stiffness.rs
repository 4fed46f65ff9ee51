//! Identities of f, K and one spring's Hessian.

use std::collections::BTreeMap;

use hooke::{Real, Spring};
use hooke_tests::data::distance;
use hooke_tests::random::Random;
use hooke_tests::{allowed, build, generate};
use nalgebra::{Matrix6, Vector3};

fn springs(count: usize, seed: u64) -> impl Iterator<Item = (Spring<f64>, [f64; 3], [f64; 3])> {
    let mut random = Random::new(seed);
    (0..count).map(move |_| {
        let spring = Spring { stiffness: random.decade(1e-3, 1e6), rest_length: random.between(0.0, 2.0) };
        (spring, random.vector(1.0), random.vector(1.0))
    })
}

fn opposite<T: Real>() {
    for (spring, a, b) in springs(1000, 1) {
        let spring =
            Spring { stiffness: T::from_f64(spring.stiffness), rest_length: T::from_f64(spring.rest_length) };
        let [at_a, at_b] = spring.gradient(a.map(T::from_f64), b.map(T::from_f64));
        for (a, b) in at_a.into_iter().zip(at_b) {
            assert_eq!(a.to_f64().to_bits(), (-b).to_f64().to_bits());
        }
    }
}

#[test]
fn the_forces_at_the_two_ends_of_a_spring_are_opposite_bit_for_bit() {
    opposite::<f64>();
    opposite::<f32>();
    // And so in a scene: the forces of a pair add up to zero.
    for (spring, a, b) in springs(100, 2) {
        let mut scene = hooke_tests::vec_memory::VecScene::<f64>::empty();
        let (i, j) = (scene.particle(a, 1.0).unwrap(), scene.particle(b, 1.0).unwrap());
        scene.spring_with(i, j, spring).unwrap();
        let mut f = [[0.0; 3]; 2];
        scene.springs().add_force(&mut f);
        assert_eq!(f[0], f[1].map(|f| -f));
    }
}

#[test]
fn a_springs_hessian_has_eigenvalues_2k_2alpha_2alpha_0_0_0() {
    for (spring, a, b) in springs(300, 3) {
        let blocks = spring.dense_hessian(a, b);
        let dense = Matrix6::from_fn(|r, c| blocks[r / 3][c / 3][r % 3][c % 3]);
        assert_eq!(dense, dense.transpose());
        let mut found: Vec<f64> = dense.symmetric_eigen().eigenvalues.iter().copied().collect();
        found.sort_by(f64::total_cmp);
        let (k, l) = (spring.stiffness, distance(a, b));
        let alpha = k * (1.0 - spring.rest_length / l);
        let mut expected = [2.0 * k, 2.0 * alpha, 2.0 * alpha, 0.0, 0.0, 0.0];
        expected.sort_by(f64::total_cmp);
        let size = k * (1.0 + spring.rest_length / l);
        for (found, expected) in found.iter().zip(expected) {
            assert!(
                (found - expected).abs() <= allowed::EIGENVALUE_6 * allowed::U64 * size,
                "{found} {expected}"
            );
        }
    }
}

#[test]
fn the_compressed_hessian_equals_the_textbook_formula() {
    for (spring, a, b) in springs(300, 4) {
        let h = spring.hessian(a, b);
        let stretch = hooke_tests::textbook::Stretch::new(
            Vector3::from(a) - Vector3::from(b),
            spring.stiffness,
            spring.rest_length,
        );
        let (dense, textbook) = (h.dense(), stretch.hessian());
        let size = spring.stiffness * (1.0 + spring.rest_length / stretch.l);
        for r in 0..3 {
            for c in 0..3 {
                let off = (dense[r][c] - textbook[(r, c)]).abs();
                assert!(off <= allowed::COMPRESSED_HESSIAN * allowed::U64 * size, "{off:e} of {size:e}");
            }
        }
        assert_eq!(h.alpha < 0.0, stretch.l < spring.rest_length, "α < 0 exactly where compressed");
    }
}

#[test]
fn k_is_symmetric_bit_for_bit() {
    for seed in 0..10 {
        let data = generate::gentle_network(seed, 10);
        let mut k: BTreeMap<(usize, usize, usize, usize), f64> = BTreeMap::new();
        build::scene::<f64>(&data).springs().stiffness_blocks(|row, column, block| {
            for r in 0..3 {
                for c in 0..3 {
                    *k.entry((row, r, column, c)).or_default() += block[r][c];
                }
            }
        });
        for ((row, r, column, c), value) in &k {
            assert_eq!(value, &k[&(*column, *c, *row, *r)]);
        }
    }
}

#[test]
fn k_times_a_translation_is_zero_bit_for_bit() {
    let mut random = Random::new(5);
    for seed in 0..10 {
        let data = generate::gentle_network(seed, 10);
        let scene = build::scene::<f64>(&data);
        let mut y = vec![[f64::NAN; 3]; data.len()];
        scene.springs().stiffness_product(&vec![random.vector(3.0); data.len()], &mut y);
        assert_eq!(y, vec![[0.0; 3]; data.len()]);
    }
}

#[test]
fn k_times_a_rotation_is_the_rotated_force() {
    let mut random = Random::new(6);
    for seed in 0..20 {
        let data = generate::gentle_network(seed, 10);
        let scene = build::scene::<f64>(&data);
        let omega = Vector3::from(random.vector(2.0));
        let turned: Vec<[f64; 3]> =
            data.position.iter().map(|x| omega.cross(&Vector3::from(*x)).into()).collect();
        let (mut y, mut f) = (vec![[0.0; 3]; data.len()], vec![[0.0; 3]; data.len()]);
        scene.springs().stiffness_product(&turned, &mut y);
        scene.springs().add_force(&mut f);
        let mut size = vec![0.0; data.len()];
        for s in &data.springs {
            let l = distance(data.position[s.a], data.position[s.b]);
            for end in [s.a, s.b] {
                size[end] += s.k * (1.0 + s.l0 / l) * omega.norm() * 3f64.sqrt();
            }
        }
        for ((y, f), size) in y.iter().zip(&f).zip(&size) {
            let expected = omega.cross(&Vector3::from(*f));
            let off = (Vector3::from(*y) - expected).norm();
            assert!(off <= allowed::ROTATED_FORCE * allowed::U64 * size, "{off:e} of {size:e}");
        }
    }
}
