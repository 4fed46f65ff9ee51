//! The oracles agree with each other: three programs, three data structures, two arithmetics.

use hooke_tests::precise::{self, Factor, big, small};
use hooke_tests::{allowed, build, dense::Dense, generate, sparse};

#[test]
fn the_sparse_oracle_is_the_dense_oracle_to_rounding() {
    for seed in 0..10 {
        let data = generate::gentle_network(seed, 14);
        let h = 1.0 / 60.0;
        let mut dense = data.clone();
        let mut clamped = 0;
        for _ in 0..10 {
            let (next, count) = Dense::new(&dense).step(h, &[]);
            (dense, clamped) = (next, clamped + count);
        }
        let sparse = sparse::simulate(&data, h, 10);
        assert_eq!(sparse.clamped, clamped);
        let off = build::farthest(&sparse.position, &dense.position);
        assert!(off <= allowed::TWO_ORACLES, "{off:e} m");
    }
}

#[test]
fn the_dense_potential_and_gradient_are_the_multi_precision_ones_to_rounding() {
    for seed in 0..10 {
        let data = generate::gentle_network(seed, 8);
        let dense = Dense::new(&data);
        let q = precise::bigs(&data.position);
        let size: f64 = data.springs.iter().map(|s| s.k * s.l0.max(1.0).powi(2) * 4.0).sum();
        let v = small(&precise::potential(&data, &q));
        // The dense form squares l by five matrix products.
        assert!((dense.potential_energy() - v).abs() <= 2.0 * allowed::ENERGY * allowed::U64 * size);
        let f = dense.spring_force();
        for (i, g) in precise::gradient(&data, &q).iter().flatten().enumerate() {
            assert!((f[i] + small(g)).abs() <= allowed::DENSE_ROW * allowed::U64 * size);
        }
        let by_difference = precise::derivative(|q| precise::potential(&data, q), &q);
        for (g, d) in precise::gradient(&data, &q).iter().flatten().zip(by_difference.iter().flatten()) {
            assert!((small(g) - d).abs() <= 4.0 * allowed::U64 * size, "{} {d}", small(g));
        }
    }
}

#[test]
fn the_multi_precision_factor_solves_the_hilbert_matrix_which_f64_cannot() {
    let n = 12;
    let hilbert: Vec<Vec<_>> =
        (0..n).map(|i| (0..n).map(|j| big(1.0) / big((i + j + 1) as f64)).collect()).collect();
    let right: Vec<_> = hilbert.iter().map(|row| row.iter().fold(big(0.0), |sum, a| sum + a)).collect();
    let factor = Factor::new(&hilbert).unwrap();
    let solution = factor.solve(&right);
    for x in &solution {
        // The condition number is 1.7e16; 62 digits leave 45.
        assert!((small(&(x - big(1.0)))).abs() <= 1e-40);
    }
    let form = right.iter().zip(&solution).fold(big(0.0), |sum, (b, x)| sum + b * x);
    assert!(small(&(factor.inverse_form(&right) - form)).abs() <= 1e-40);
    let mut indefinite = hilbert;
    indefinite[n - 1][n - 1] -= big(1e-3);
    assert!(Factor::new(&indefinite).is_none());
}
