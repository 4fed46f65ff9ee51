//! One step of each implicit method against its textbook formula with dense matrices of all unknowns (q, q̇).

use hooke_tests::data::SceneData;
use hooke_tests::dense::Dense;
use hooke_tests::methods::{Method, options};
use hooke_tests::{allowed, build, generate};
use nalgebra::{DMatrix, DVector, Vector3};

use super::coefficients::{Published, ros2, ros34pw2};

/// Nothing is clamped, springs do not damp, and there are no points: what `Dense` has of forces.
fn gentle(seed: u64) -> SceneData {
    let mut data = generate::gentle_network(seed, 8);
    data.springs.iter_mut().for_each(|s| s.c = 0.0);
    data.points.clear();
    data
}

/// The scene with other free positions and velocities.
fn at(data: &SceneData, y: &DVector<f64>) -> SceneData {
    let mut to = data.clone();
    let n = y.len() / 2;
    for (row, i) in (0..data.len()).filter(|i| !data.pinned[*i]).enumerate() {
        for d in 0..3 {
            (to.position[i][d], to.velocity[i][d]) = (y[3 * row + d], y[n + 3 * row + d]);
        }
    }
    to
}

/// y = (q, q̇) of the free particles
fn state(data: &SceneData) -> DVector<f64> {
    let (dense, p) = (Dense::new(data), Dense::new(data).pins());
    let (q, v) = (&p * dense.position(), &p * dense.velocity());
    DVector::from_iterator(q.len() + v.len(), q.iter().chain(v.iter()).copied())
}

/// F(y) = (q̇, M⁻¹f − dq̇)
fn rate(data: &SceneData) -> DVector<f64> {
    let (dense, p) = (Dense::new(data), Dense::new(data).pins());
    let v = &p * dense.velocity();
    let f = &p * dense.spring_force();
    let m = (&p * dense.mass_matrix() * p.transpose()).diagonal();
    let a = DVector::from_fn(f.len(), |r, _| f[r] / m[r] + data.gravity[r % 3] - data.drag * v[r]);
    DVector::from_iterator(2 * v.len(), v.iter().chain(a.iter()).copied())
}

/// ∂F/∂y
fn jacobian(data: &SceneData) -> DMatrix<f64> {
    let (dense, p) = (Dense::new(data), Dense::new(data).pins());
    let k = &p * dense.stiffness_matrix() * p.transpose();
    let m = (&p * dense.mass_matrix() * p.transpose()).diagonal();
    let n = m.len();
    DMatrix::from_fn(2 * n, 2 * n, |r, c| match (r < n, c < n) {
        (true, false) => f64::from(u8::from(c == r + n)),
        (false, true) => k[(r - n, c)] / m[r - n],
        (false, false) if r == c => -data.drag,
        _ => 0.0,
    })
}

/// kᵢ = F(y + hΣαᵢⱼkⱼ) + hJΣγᵢⱼkⱼ, y⁺ = y + hΣbᵢkᵢ
fn rosenbrock(data: &SceneData, method: &Published, h: f64) -> DVector<f64> {
    let (y, j) = (state(data), jacobian(data));
    let n = y.len();
    let w = (DMatrix::identity(n, n) - method.gamma * h * &j).lu();
    let mut k: Vec<DVector<f64>> = Vec::new();
    for (alpha, gamma) in method.alpha.iter().zip(&method.gammas) {
        let sum = |of: &[f64]| {
            let terms = of.iter().zip(&k).map(|(share, k)| *share * k);
            terms.fold(DVector::zeros(n), |sum, term| sum + term)
        };
        let right = rate(&at(data, &(&y + h * sum(alpha)))) + h * &j * sum(gamma);
        k.push(w.solve(&right).expect("W is regular"));
    }
    let terms = method.b.iter().zip(&k).map(|(b, k)| h * *b * k);
    terms.fold(y, |y, term| y + term)
}

fn agrees(method: Method, expected: impl Fn(&SceneData, f64) -> DVector<f64>) {
    let mut largest = 0.0f64;
    for seed in 0..10 {
        let data = gentle(seed);
        for h in [1e-3, 1.0 / 60.0, 0.05] {
            let mut scene = build::scene::<f64>(&data);
            let mut forces = build::Forces::<f64>::new(&data);
            let report = method.step(&mut scene, options(h, 1e-14), forces.all(), &[]).unwrap();
            assert_eq!(report.clamped, 0, "the formula knows nothing of clamping");
            let mut after = data.clone();
            build::read_back(&scene, &mut after);
            largest = largest.max((state(&after) - expected(&data, h)).amax());
        }
    }
    println!("{method:?}: {largest:.1e} off");
    assert!(largest <= allowed::DENSE_STEP, "{method:?}: {largest:e}");
}

#[test]
fn a_step_of_ros2_is_that_of_the_published_method_with_dense_matrices() {
    agrees(Method::Ros2, |data, h| rosenbrock(data, &ros2(), h));
}

#[test]
fn a_step_of_ros3_is_that_of_the_published_method_with_dense_matrices() {
    agrees(Method::Ros3, |data, h| rosenbrock(data, &ros34pw2(), h));
}

#[test]
fn a_step_of_midpoint_is_one_newton_step_of_the_implicit_midpoint_rule_with_dense_matrices() {
    agrees(Method::Midpoint, |data, h| {
        let (y, n) = (state(data), state(data).len());
        let matrix = DMatrix::identity(n, n) - 0.5 * h * jacobian(data);
        y + h * matrix.lu().solve(&rate(data)).expect("regular")
    });
}

#[test]
fn a_step_of_euler_is_one_newton_step_of_backward_euler_with_dense_matrices() {
    agrees(Method::Euler, |data, h| {
        let (y, n) = (state(data), state(data).len());
        let matrix = DMatrix::identity(n, n) - h * jacobian(data);
        y + h * matrix.lu().solve(&rate(data)).expect("regular")
    });
}

#[test]
fn a_step_of_newton_solves_backward_euler() {
    // y⁺ = y + hF(y⁺), by Newton's method on all unknowns.
    agrees(Method::Newton, |data, h| {
        let start = state(data);
        let (mut y, n) = (start.clone(), start.len());
        for _ in 0..30 {
            let here = at(data, &y);
            let matrix = DMatrix::identity(n, n) - h * jacobian(&here);
            y -= matrix.lu().solve(&(&y - &start - h * rate(&here))).expect("regular");
        }
        y
    });
}

#[test]
fn a_step_of_energy_momentum_solves_its_equation() {
    // M(q̇¹ − q̇⁰) = h(f̄ + Mg − dM(q̇⁰ + q̇¹)/2), q¹ = q⁰ + ½h(q̇⁰ + q̇¹), f̄_A = −k(1 − 2l₀/(l⁰ + l¹))(Δx⁰ + Δx¹)/2.
    let mut largest = 0.0f64;
    for seed in 0..10 {
        let data = gentle(seed);
        for h in [1e-3, 1.0 / 60.0] {
            let mut scene = build::scene::<f64>(&data);
            let mut forces = build::Forces::<f64>::new(&data);
            Method::EnergyMomentum.step(&mut scene, options(h, 1e-14), forces.all(), &[]).unwrap();
            let mut after = data.clone();
            build::read_back(&scene, &mut after);
            let of = |list: &[[f64; 3]], i: usize| Vector3::from(list[i]);
            let mut impulse = vec![Vector3::zeros(); data.len()];
            for s in &data.springs {
                let start = of(&data.position, s.a) - of(&data.position, s.b);
                let end = of(&after.position, s.a) - of(&after.position, s.b);
                let f = -s.k * (1.0 - 2.0 * s.l0 / (start.norm() + end.norm())) * (start + end) / 2.0;
                impulse[s.a] += h * f;
                impulse[s.b] -= h * f;
            }
            for i in (0..data.len()).filter(|i| !data.pinned[*i]) {
                let (m, v0, v1) = (data.mass[i], of(&data.velocity, i), of(&after.velocity, i));
                let outer = m * (Vector3::from(data.gravity) - data.drag * (v0 + v1) / 2.0);
                let missing = (v1 - v0) - (impulse[i] + h * outer) / m;
                let way = of(&after.position, i) - of(&data.position, i) - 0.5 * h * (v0 + v1);
                largest = largest.max(missing.amax()).max(way.amax());
            }
        }
    }
    println!("energy-momentum: {largest:.1e} m/s missing");
    assert!(largest <= allowed::DENSE_STEP, "{largest:e}");
}
