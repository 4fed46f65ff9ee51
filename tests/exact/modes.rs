//! Longitudinal modes of a chain, and the box lattice: closed forms for the eigenvalues of K.

use core::f64::consts::PI;

use hooke::LinearlyImplicitEuler;
use hooke_tests::allowed;
use hooke_tests::build;
use hooke_tests::data::SceneData;
use hooke_tests::generate;
use nalgebra::DMatrix;

/// `masses` free masses on x = 1, 2, …, a wall at 0, and one at the other end if `both`.
fn row(masses: usize, both: bool, k: f64, m: f64) -> SceneData {
    let mut data = SceneData::default();
    for i in 0..=masses + usize::from(both) {
        data.particle([i as f64, 0.0, 0.0], m);
    }
    for i in 1..data.len() {
        data.spring(i - 1, i, k);
    }
    data.pinned[0] = true;
    if both {
        data.pinned[masses + 1] = true;
    }
    data
}

fn omega(masses: usize, both: bool, mode: usize, k: f64, m: f64) -> f64 {
    let n = masses as f64;
    let angle = if both {
        mode as f64 * PI / (2.0 * (n + 1.0))
    } else {
        (2.0 * mode as f64 - 1.0) * PI / (2.0 * (2.0 * n + 1.0))
    };
    2.0 * (k / m).sqrt() * angle.sin()
}

/// −K of the free particles' x components.
fn longitudinal(data: &SceneData) -> DMatrix<f64> {
    let n = data.len();
    let mut k = DMatrix::zeros(n, n);
    build::scene::<f64>(data).springs().stiffness_blocks(|r, c, block| k[(r, c)] -= block[0][0]);
    let free: Vec<usize> = (0..n).filter(|i| !data.pinned[*i]).collect();
    DMatrix::from_fn(free.len(), free.len(), |r, c| k[(free[r], free[c])])
}

fn eigenvalues(k: DMatrix<f64>) -> Vec<f64> {
    let mut values: Vec<f64> = k.symmetric_eigen().eigenvalues.iter().copied().collect();
    values.sort_by(f64::total_cmp);
    values
}

fn frequencies(both: bool) {
    let (masses, k, m) = (20, 50.0, 0.3);
    let values = eigenvalues(longitudinal(&row(masses, both, k, m)));
    for (mode, value) in (1..).zip(values) {
        let expected = m * omega(masses, both, mode, k, m).powi(2);
        let allowed = allowed::EIGENVALUE * masses as f64 * allowed::U64 * 4.0 * k;
        assert!((value - expected).abs() <= allowed, "mode {mode}: {value} for {expected}");
    }
}

#[test]
fn masses_between_two_walls_have_omega_j_2_sqrt_k_over_m_sin() {
    frequencies(true);
}

#[test]
fn masses_with_one_end_free_have_omega_j_2_sqrt_k_over_m_sin_of_odd_multiples() {
    frequencies(false);
}

/// Each mode decays on its own under euler: amplitude energy by 1/(1+h²ω²) per step.
fn decay(both: bool) {
    let (masses, k, m, h) = (7, 50.0, 0.25, 1.0 / 32.0);
    for mode in 1..=masses {
        let mut data = row(masses, both, k, m);
        let angle = if both {
            mode as f64 * PI / (masses as f64 + 1.0)
        } else {
            (2.0 * mode as f64 - 1.0) * PI / (2.0 * masses as f64 + 1.0)
        };
        let size = 1.0 / 8.0;
        for i in 1..=masses {
            data.position[i][0] += size * (angle * i as f64).sin();
        }
        let mut scene = build::scene::<f64>(&data);
        let mut euler = LinearlyImplicitEuler::new(h).tolerance(0.0);
        let factor = 1.0 + (h * omega(masses, both, mode, k, m)).powi(2);
        let mut before = scene.springs().kinetic_energy() + scene.springs().potential_energy();
        for step in 0..10 {
            scene.step(&mut euler).unwrap();
            let after = scene.springs().kinetic_energy() + scene.springs().potential_energy();
            let ratio = after * factor / before;
            let amplitude = (2.0 * before / k).sqrt();
            let allowed = allowed::MODE_ENERGY * allowed::U64 * masses as f64 / amplitude;
            assert!((ratio - 1.0).abs() <= allowed, "mode {mode}, step {step}: {ratio} ± {allowed:e}");
            before = after;
        }
    }
}

#[test]
fn each_mode_between_walls_decays_by_its_own_factor_per_step() {
    decay(true);
}

#[test]
fn each_mode_with_one_end_free_decays_by_its_own_factor_per_step() {
    decay(false);
}

#[test]
fn rest_length_zero_makes_k_minus_kl_times_identity_bit_for_bit() {
    // Unit spacing, so that l = 1 and no operation rounds; L is the graph's Laplacian.
    let k = 3.0;
    let data = generate::box_lattice([2, 2, 2], k, 1.0);
    let n = data.len();
    let mut laplacian = DMatrix::<f64>::zeros(3 * n, 3 * n);
    for s in &data.springs {
        for d in 0..3 {
            let (a, b) = (3 * s.a + d, 3 * s.b + d);
            laplacian[(a, a)] += 1.0;
            laplacian[(b, b)] += 1.0;
            laplacian[(a, b)] -= 1.0;
            laplacian[(b, a)] -= 1.0;
        }
    }
    let mut stiffness = DMatrix::zeros(3 * n, 3 * n);
    build::scene::<f64>(&data).springs().stiffness_blocks(|r, c, block| {
        for i in 0..3 {
            for j in 0..3 {
                stiffness[(3 * r + i, 3 * c + j)] += block[i][j];
            }
        }
    });
    assert_eq!(stiffness, laplacian * -k);
}

#[test]
fn a_box_lattice_of_rest_length_zero_has_eigenvalues_sum_of_4k_sin2() {
    let (k, size) = (3.0, [2, 3, 4]);
    let data = generate::box_lattice(size, k, 1.0);
    let mut expected = Vec::new();
    let one = |mode: usize, n: usize| 4.0 * k * (mode as f64 * PI / (2.0 * (n as f64 + 1.0))).sin().powi(2);
    for a in 1..=size[0] {
        for b in 1..=size[1] {
            for c in 1..=size[2] {
                expected.push(one(a, size[0]) + one(b, size[1]) + one(c, size[2]));
            }
        }
    }
    expected.sort_by(f64::total_cmp);
    let values = eigenvalues(longitudinal(&data));
    assert_eq!(values.len(), expected.len());
    let allowed = allowed::EIGENVALUE * values.len() as f64 * allowed::U64 * 12.0 * k;
    for (value, expected) in values.iter().zip(&expected) {
        assert!((value - expected).abs() <= allowed, "{value} for {expected}");
    }
}
