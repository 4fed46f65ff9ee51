//! S, E_j, B, P as dense matrices from their definitions equal the code that never forms them.

use hooke::selection;
use hooke_tests::dense::Dense;
use hooke_tests::random::Random;
use hooke_tests::{allowed, build, generate};
use nalgebra::{DVector, Vector3};

#[test]
fn the_selection_of_a_spring_times_q_is_its_two_particles_bit_for_bit() {
    let data = generate::gentle_network(1, 9);
    let dense = Dense::new(&data);
    let q = dense.position();
    for s in &data.springs {
        let selected = dense.spring_selection(s.a, s.b) * &q;
        let both: Vec<f64> = [data.position[s.a], data.position[s.b]].concat();
        assert_eq!(selected.as_slice(), both);
        let difference = dense.difference() * selected;
        assert_eq!(difference.as_slice(), selection::difference(s.a, s.b, &data.position));
    }
}

#[test]
fn the_transposed_selection_scatters_bit_for_bit() {
    let data = generate::gentle_network(2, 9);
    let dense = Dense::new(&data);
    let mut random = Random::new(2);
    for s in &data.springs {
        let f = random.vector(5.0);
        let mut y = vec![[0.0; 3]; data.len()];
        selection::scatter(s.a, s.b, f, &mut y);
        let scattered =
            dense.spring_selection(s.a, s.b).transpose() * dense.difference().transpose() * Vector3::from(f);
        let y: Vec<f64> = y.into_iter().flatten().collect();
        assert_eq!(scattered.as_slice(), y);
    }
}

#[test]
fn pins_drop_exactly_the_rows_of_p() {
    for seed in 0..20 {
        let data = generate::gentle_network(seed, 9);
        let p = Dense::new(&data).pins();
        let mut scene = build::scene::<f64>(&data);
        let mut forces = build::Forces::new(&data);
        let mut unknown = Vec::new();
        let see = |system: &hooke::System<'_, f64, _>, _: &[[f64; 3]], _: &[f64]| {
            unknown.extend((0..system.particles()).map(|row| system.particle(row).unwrap()));
        };
        forces.euler(0.01).inspect(scene.parts(), &[], see).unwrap();
        unknown.sort_unstable();
        let kept: Vec<usize> =
            (0..p.nrows() / 3).map(|r| p.row(3 * r).iter().position(|x| *x == 1.0).unwrap() / 3).collect();
        assert_eq!(unknown, kept);
        assert_eq!(scene.free_particles(), kept.len());
    }
}

/// Σ over the springs at each particle of k(l + l₀), the size that rounding is relative to.
fn sizes(data: &hooke_tests::data::SceneData) -> Vec<f64> {
    let mut size = vec![0.0; data.len()];
    for s in &data.springs {
        let l = hooke_tests::data::distance(data.position[s.a], data.position[s.b]);
        for end in [s.a, s.b] {
            size[end] += s.k * (l + s.l0) * (1.0 + s.l0 / l);
        }
    }
    size
}

#[test]
fn scattered_forces_and_stiffness_equal_the_dense_matrices() {
    for seed in 0..20 {
        let data = generate::gentle_network(seed, 9);
        let dense = Dense::new(&data);
        let scene = build::scene::<f64>(&data);
        let n = data.len();
        let size = sizes(&data);
        let compare = |y: &[[f64; 3]], expected: &DVector<f64>, scale: f64, what: &str| {
            for (i, y) in y.iter().enumerate() {
                for d in 0..3 {
                    let (y, expected) = (y[d], expected[3 * i + d]);
                    let allowed = allowed::DENSE_ROW * allowed::U64 * size[i] * scale;
                    assert!(
                        (y - expected).abs() <= allowed,
                        "{what}, seed {seed}, particle {i}: {y} for {expected}"
                    );
                }
            }
        };
        let mut f = vec![[0.0; 3]; n];
        scene.springs().add_force(&mut f);
        compare(&f, &dense.spring_force(), 1.0, "force");
        let mut random = Random::new(seed);
        let x: Vec<[f64; 3]> = (0..n).map(|_| random.vector(1.0)).collect();
        let mut y = vec![[0.0; 3]; n];
        scene.springs().stiffness_product(&x, &mut y);
        let flat = DVector::from_vec(x.concat());
        // k per metre of length instead of k: the shortest spring of these networks is above a tenth of a metre.
        compare(&y, &(dense.stiffness_matrix() * flat), 10.0, "stiffness");
        let v = dense.potential_energy();
        assert!(
            (scene.springs().potential_energy() - v).abs()
                <= allowed::ENERGY * allowed::U64 * size.iter().sum::<f64>()
        );
    }
}

#[test]
fn the_cross_product_is_its_definition() {
    // Of primes, so that no term stands for another.
    assert_eq!(
        hooke::vec3::cross([2.0, 3.0, 5.0], [7.0, 11.0, 13.0]),
        [39.0 - 55.0, 35.0 - 26.0, 22.0 - 21.0]
    );
}
