//! One step of each implicit method against its textbook formula with dense matrices of all unknowns (q, q̇).

use hooke::{Course, Embedded, Rosenbrock2, Rosenbrock3};
use hooke_tests::data::{SceneData, distance};
use hooke_tests::dense::Dense;
use hooke_tests::methods::{Method, options};
use hooke_tests::{allowed, build, generate};
use nalgebra::{DMatrix, DVector, Vector3};

use super::coefficients::{Published, ros2, ros34pw2};

/// Nothing is clamped, and there are no points: what `Dense` has of forces. Every second one is damped along its springs.
fn gentle(seed: u64) -> SceneData {
    let mut data = generate::gentle_network(seed, 8);
    if seed.is_multiple_of(2) {
        data.springs.iter_mut().for_each(|s| s.c = 0.0);
    }
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

/// D of the springs' damping, Σ c uuᵀ between both ends.
fn damping(data: &SceneData) -> DMatrix<f64> {
    let mut d = DMatrix::zeros(3 * data.len(), 3 * data.len());
    for s in &data.springs {
        let (a, b) = (data.position[s.a], data.position[s.b]);
        let u: [f64; 3] = std::array::from_fn(|k| (a[k] - b[k]) / distance(a, b));
        for (row, column, sign) in [(s.a, s.a, 1.0), (s.b, s.b, 1.0), (s.a, s.b, -1.0), (s.b, s.a, -1.0)] {
            for (i, j) in (0..9).map(|k| (k / 3, k % 3)) {
                d[(3 * row + i, 3 * column + j)] += sign * s.c * u[i] * u[j];
            }
        }
    }
    d
}

/// F(y) = (q̇, M⁻¹(f − Dq̇) − dq̇)
fn rate(data: &SceneData) -> DVector<f64> {
    rate_with(data, &damping(data))
}

fn rate_with(data: &SceneData, damping: &DMatrix<f64>) -> DVector<f64> {
    let (dense, p) = (Dense::new(data), Dense::new(data).pins());
    let v = &p * dense.velocity();
    let f = &p * (dense.spring_force() - damping * dense.velocity());
    let m = (&p * dense.mass_matrix() * p.transpose()).diagonal();
    let a = DVector::from_fn(f.len(), |r, _| f[r] / m[r] + data.gravity[r % 3] - data.drag * v[r]);
    DVector::from_iterator(2 * v.len(), v.iter().chain(a.iter()).copied())
}

/// ∂F/∂y, but for how D changes with q: that is not symmetric, and no part of A
fn jacobian(data: &SceneData) -> DMatrix<f64> {
    jacobian_with(data, &damping(data))
}

fn jacobian_with(data: &SceneData, damping: &DMatrix<f64>) -> DMatrix<f64> {
    let (dense, p) = (Dense::new(data), Dense::new(data).pins());
    let k = &p * dense.stiffness_matrix() * p.transpose();
    let d = &p * damping * p.transpose();
    let m = (&p * dense.mass_matrix() * p.transpose()).diagonal();
    let n = m.len();
    DMatrix::from_fn(2 * n, 2 * n, |r, c| match (r < n, c < n) {
        (true, false) => f64::from(u8::from(c == r + n)),
        (false, true) => k[(r - n, c)] / m[r - n],
        (false, false) => -d[(r - n, c - n)] / m[r - n] - if r == c { data.drag } else { 0.0 },
        _ => 0.0,
    })
}

/// −M⁻¹(∂D/∂q·q̇)q̇: how the damping changes along the motion, by a difference of fourth order.
fn turning(data: &SceneData) -> DVector<f64> {
    const SECONDS: f64 = 1e-4;
    let (y, n) = (state(data), state(data).len());
    let mut along = DVector::zeros(n);
    along.rows_mut(0, n / 2).copy_from(&y.rows(n / 2, n / 2));
    let none = DMatrix::zeros(3 * data.len(), 3 * data.len());
    let damped = |steps: f64| {
        let there = at(data, &(&y + steps * SECONDS * &along));
        rate(&there) - rate_with(&there, &none)
    };
    (8.0 * (damped(1.0) - damped(-1.0)) - (damped(2.0) - damped(-2.0))) / (12.0 * SECONDS)
}

/// kᵢ = F(y + hΣαᵢⱼkⱼ) + hJΣγᵢⱼkⱼ, y⁺ = y + hΣbᵢkᵢ, and what it is estimated to be wrong by, hΣ(bᵢ − b̂ᵢ)kᵢ
fn rosenbrock(data: &SceneData, method: &Published, h: f64) -> [DVector<f64>; 2] {
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
    let sum = |of: &[f64], from: DVector<f64>| {
        of.iter().zip(&k).map(|(b, k)| h * *b * k).fold(from, |sum, term| sum + term)
    };
    let error = sum(&method.b, DVector::zeros(n)) - sum(&method.lower, DVector::zeros(n));
    [sum(&method.b, y), error]
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
    agrees(Method::Ros2, |data, h| rosenbrock(data, &ros2(), h)[0].clone());
}

#[test]
fn a_step_of_ros3_is_that_of_the_published_method_with_dense_matrices() {
    agrees(Method::Ros3, |data, h| rosenbrock(data, &ros34pw2(), h)[0].clone());
}

/// ½‖δq̇‖²_M + ½δqᵀ(M/h² − K)δq, and the farthest |δq|: what an attempt says of its error, δ being the difference to the embedded
/// method, or for positions that to the trapezoidal rule.
fn estimates<I: Embedded<f64>>(
    (published, trapezoidal): (&Published, bool),
    mut method: impl FnMut(usize) -> I,
) {
    for mut data in (0..10).step_by(2).map(gentle) {
        // Drag counts as mass in the estimate, and damping as stiffness: without them.
        (data.drag, data.gravity) = (0.0, [0.0; 3]);
        for h in [1e-3, 1.0 / 60.0, 0.05] {
            let [end, mut error] = rosenbrock(&data, published, h);
            let (dense, p) = (Dense::new(&data), Dense::new(&data).pins());
            let (k, m) = (dense.stiffness_matrix(), dense.mass_matrix());
            let weight = &p * (&m / (h * h) - k) * p.transpose();
            let n = error.len() / 2;
            if trapezoidal {
                let (start, half) = (state(&data), 0.5 * h);
                let way = end.rows(0, n) - start.rows(0, n);
                error.rows_mut(0, n).copy_from(&(way - half * (start.rows(n, n) + end.rows(n, n))));
            }
            let (q, v) = (error.rows(0, n).into_owned(), error.rows(n, n).into_owned());
            let energy = 0.5 * (&p * m * p.transpose() * &v).dot(&v) + 0.5 * (weight * &q).dot(&q);
            let farthest = (0..n / 3).map(|i| q.rows(3 * i, 3).norm()).fold(0.0, f64::max);
            let mut scene = build::scene::<f64>(&data);
            let attempt = method(data.len()).attempt(&mut scene.parts(), h, Course::rest(), 0.0, &mut |_| {});
            let found = attempt.unwrap().1;
            let off = [found.energy / energy - 1.0, found.distance / farthest - 1.0].map(f64::abs);
            println!("{energy:e} J, {farthest:e} m, {:e} off", off[0].max(off[1]));
            assert!(
                off[0].max(off[1]) <= allowed::DENSE_ESTIMATE,
                "{found:?}, not {energy:e} J, {farthest:e} m"
            );
        }
    }
}

#[test]
fn the_error_of_ros2_and_ros3_is_estimated_by_the_published_embedded_method_in_the_scenes_own_energy() {
    let memory = |needs: usize| vec![[f64::NAN; 3]; needs];
    estimates((&ros2(), true), |n| {
        Rosenbrock2::new(1.0, memory(Rosenbrock2::<f64, ()>::needs(n))).tolerance(1e-14)
    });
    estimates((&ros34pw2(), false), |n| {
        Rosenbrock3::new(1.0, memory(Rosenbrock3::<f64, ()>::needs(n))).tolerance(1e-14)
    });
}

#[test]
fn a_step_of_midpoint_is_one_newton_step_of_the_implicit_midpoint_rule_with_dense_matrices() {
    agrees(Method::Midpoint, |data, h| {
        let (y, n) = (state(data), state(data).len());
        let matrix = DMatrix::identity(n, n) - 0.5 * h * jacobian(data);
        let right = rate(data) + 0.5 * h * turning(data);
        y + h * matrix.lu().solve(&right).expect("regular")
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
    // y⁺ = y + hF(y⁺), by Newton's method on all unknowns; D is that of the step's beginning, so that there is a potential.
    agrees(Method::Newton, |data, h| {
        let start = state(data);
        let (mut y, n) = (start.clone(), start.len());
        for _ in 0..30 {
            let (here, d) = (at(data, &y), damping(data));
            let matrix = DMatrix::identity(n, n) - h * jacobian_with(&here, &d);
            y -= matrix.lu().solve(&(&y - &start - h * rate_with(&here, &d))).expect("regular");
        }
        y
    });
}

#[test]
fn a_step_of_energy_momentum_solves_its_equation() {
    // M(q̇¹ − q̇⁰) = h(f̄ + Mg − dM(q̇⁰ + q̇¹)/2), q¹ = q⁰ + ½h(q̇⁰ + q̇¹), f̄_A = −k(1 − 2l₀/(l⁰ + l¹))(Δx⁰ + Δx¹)/2.
    let mut largest = 0.0f64;
    for seed in (0..10).step_by(2) {
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
