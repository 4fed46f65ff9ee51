//! Every method against closed forms: the lecture's spring, free fall, a pair that rotates.

use hooke_tests::data::SceneData;
use hooke_tests::methods::{self, Method, Method::*, options};
use hooke_tests::vec_memory::VecScene;
use hooke_tests::{allowed, build};
use nalgebra::{Complex, DMatrix};

/// A wall at x = 0, k = 1 N/m, l₀ = 1 m, 1 kg at x = 1.5 m: along its axis the spring is linear, ω = 1.
fn spring() -> SceneData {
    let mut data = SceneData::default();
    let wall = data.particle([0.0; 3], 1.0);
    let ball = data.particle([1.5, 0.0, 0.0], 1.0);
    data.pinned[wall] = true;
    data.spring_with(wall, ball, 1.0, 1.0);
    data
}

/// (x − l₀, v) of the ball
fn swing(scene: &VecScene<f64>) -> [f64; 2] {
    [scene.positions()[1][0] - 1.0, scene.velocities()[1][0]]
}

/// `of` the spring's state is multiplied by `ratio` at every step.
fn changes_by(method: Method, h: f64, ratio: f64, of: impl Fn([f64; 2]) -> f64) {
    let mut scene = build::scene::<f64>(&spring());
    for step in 0..100 {
        let before = of(swing(&scene));
        method.step(&mut scene, options(h, 0.0), (), &[]).unwrap();
        let off = of(swing(&scene)) / (ratio * before) - 1.0;
        let allowed = allowed::SPRING_ENERGY * allowed::U64 / (2.0 * before).sqrt();
        assert!(off.abs() <= allowed, "{method:?}, step {step}: {off:e}, allowed {allowed:e}");
    }
}

fn energy([x, v]: [f64; 2]) -> f64 {
    0.5 * (x * x + v * v)
}

const STEPS: [f64; 2] = [1.0 / 8.0, 1.0 / 60.0];

#[test]
fn energy_of_the_spring_is_constant_under_midpoint_and_energy_momentum() {
    for h in STEPS {
        changes_by(Midpoint, h, 1.0, energy);
        changes_by(EnergyMomentum, h, 1.0, energy);
    }
}

#[test]
fn energy_of_the_spring_falls_by_one_over_one_plus_h2_omega2_under_newton_as_under_euler() {
    for h in STEPS {
        changes_by(Euler, h, 1.0 / (1.0 + h * h), energy);
        changes_by(Newton, h, 1.0 / (1.0 + h * h), energy);
    }
}

#[test]
fn verlet_and_symplectic_euler_keep_an_energy_of_their_own_of_the_spring() {
    for h in STEPS {
        changes_by(Verlet, h, 1.0, |[x, v]| 0.5 * (v * v + (1.0 - 0.25 * h * h) * x * x));
        changes_by(SymplecticEuler, h, 1.0, |[x, v]| 0.5 * (v * v + x * x - h * x * v));
    }
}

/// 1 + z bᵀ(I − zβ)⁻¹1, β the sum of the method's two matrices
fn stability(beta: &[&[f64]], b: &[f64], z: Complex<f64>) -> Complex<f64> {
    let n = b.len();
    let at = |r: usize, c: usize| beta[r].get(c).map_or(0.0, |x| *x);
    let matrix = DMatrix::from_fn(n, n, |r, c| Complex::from(if r == c { 1.0 } else { 0.0 }) - z * at(r, c));
    let ones = DMatrix::from_element(n, 1, Complex::from(1.0));
    let solved = matrix.lu().solve(&ones).expect("it is triangular");
    Complex::from(1.0) + z * (0..n).map(|i| solved[(i, 0)] * b[i]).sum::<Complex<f64>>()
}

#[test]
fn energy_of_the_spring_changes_by_the_square_of_the_stability_function_under_rosenbrock_methods() {
    let two = 1.0 - 0.5f64.sqrt();
    for h in STEPS {
        let z = Complex::new(0.0, h);
        let ratio = stability(&[&[two], &[1.0 - 2.0 * two, two]], &[0.5, 0.5], z).norm_sqr();
        changes_by(Ros2, h, ratio, energy);
        let beta: Vec<Vec<f64>> = super::coefficients::ros34pw2().beta();
        let rows: Vec<&[f64]> = beta.iter().map(Vec::as_slice).collect();
        let ratio = stability(&rows, &super::coefficients::ros34pw2().b, z).norm_sqr();
        changes_by(Ros3, h, ratio, energy);
    }
}

/// Each step of free fall, its position as x₀ + v₀t − ½gt² − (θ − ½)ght and its velocity as v₀ − gt, all numbers dyadic.
fn falls(method: Method, theta: f64, allowed: impl Fn(f64, f64) -> f64) {
    let (h, g, x0, v0) = (1.0 / 64.0, 9.8125, 2.0, [0.5, 3.0, -0.25]);
    let mut data = SceneData { gravity: [0.0, -g, 0.0], ..SceneData::default() };
    let i = data.particle([0.0, x0, 0.0], 0.25);
    data.velocity[i] = v0;
    let mut scene = build::scene::<f64>(&data);
    let mut forces = build::Forces::<f64>::new(&data);
    for n in 1..=200 {
        method.step(&mut scene, options(h, 1e-6), forces.all(), &[]).unwrap();
        let t = f64::from(n) * h;
        let fallen = x0 + v0[1] * t - 0.5 * g * t * t - (theta - 0.5) * g * h * t;
        let (x, v) = (scene.positions()[i], scene.velocities()[i]);
        let off = [x[0] - v0[0] * t, x[1] - fallen, x[2] - v0[2] * t];
        let (far, fast) = (off.iter().fold(0.0, |m: f64, x| m.max(x.abs())), (v[1] - (v0[1] - g * t)).abs());
        assert!(far <= allowed(f64::from(n), 2.0 + 40.0 * t), "{method:?}, step {n}: {far:e} m");
        assert!(fast <= allowed(f64::from(n), 40.0), "{method:?}, step {n}: {fast:e} m/s");
    }
}

#[test]
fn free_fall_is_the_closed_form_of_each_theta_bit_for_bit() {
    for (method, theta) in [
        (Euler, 1.0),
        (Newton, 1.0),
        (SymplecticEuler, 1.0),
        (Midpoint, 0.5),
        (EnergyMomentum, 0.5),
        (Verlet, 0.5),
    ] {
        falls(method, theta, |_, _| 0.0);
    }
}

#[test]
fn free_fall_is_exact_under_rosenbrock_methods_to_the_rounding_of_their_coefficients() {
    for method in [Ros2, Ros3] {
        falls(method, 0.5, |n, size| allowed::FREE_FALL * allowed::U64 * n * size);
    }
}

/// Two particles of 1 kg at the radius r, k = 100 N/m, l₀ = 0.8 m, turning by φ in a step: |v| and φ from ω̃. Answers how far
/// positions, and velocities over the speed, are off after the steps.
fn rotates(method: Method, h: f64, steps: u32, turn: impl Fn(f64) -> f64, speed: impl Fn(f64) -> f64) -> f64 {
    let (r, k, l0) = (0.5f64, 100.0, 0.8);
    let phi = turn((k * (2.0 * r - l0) / r).sqrt());
    let speed = speed(phi) * r;
    let mut data = SceneData::default();
    for side in [1.0, -1.0] {
        let i = data.particle([side * r, 0.0, 0.0], 1.0);
        data.velocity[i] = [0.0, side * speed, 0.0];
    }
    data.spring_with(0, 1, k, l0);
    let mut scene = build::scene::<f64>(&data);
    let mut worst = 0.0f64;
    for n in 1..=steps {
        method.step(&mut scene, options(h, 1e-15), (), &[]).unwrap();
        let (sin, cos) = (f64::from(n) * phi).sin_cos();
        for (i, side) in [1.0, -1.0].into_iter().enumerate() {
            let (x, v) = (scene.positions()[i], scene.velocities()[i]);
            let off = [x[0] - side * r * cos, x[1] - side * r * sin, x[2]];
            let fast = [v[0] + side * speed * sin, v[1] - side * speed * cos, v[2]].map(|v| v / speed);
            worst = off.iter().chain(&fast).fold(worst, |m, x| m.max(x.abs()));
        }
        assert!(worst <= allowed::ROTATING * f64::from(n) * allowed::U64, "{method:?}, step {n}: {worst:e}");
    }
    println!("{method:?}, φ = {phi:.3}: {:.1} u a step", worst / allowed::U64 / f64::from(steps));
    worst
}

#[test]
fn a_rotating_pair_turns_under_energy_momentum_with_omega_two_over_h_tan_of_half_the_turn() {
    for h in [0.01, 0.1, 0.2] {
        rotates(EnergyMomentum, h, 200, |w| 2.0 * (0.5 * h * w).atan(), |phi| 2.0 / h * (0.5 * phi).tan());
    }
}

#[test]
fn a_rotating_pair_turns_under_verlet_with_omega_two_over_h_sin_of_half_the_turn() {
    for h in [0.01, 0.1] {
        rotates(Verlet, h, 200, |w| 2.0 * (0.5 * h * w).asin(), |phi| phi.sin() / h);
    }
}

#[test]
fn nothing_moves_bit_for_bit_without_force_and_velocity_at_rest_length() {
    for method in methods::ALL {
        let mut data = SceneData::default();
        // Lengths are exact: 3-4-5 and its multiples.
        for x in [[0.0; 3], [3.0, 4.0, 0.0], [3.0, 4.0, 2.0], [0.0, 0.0, 2.0]] {
            data.particle(x, 0.3);
        }
        for (a, b) in [(0, 1), (1, 2), (2, 3)] {
            data.spring(a, b, 70.0);
        }
        for pinned in [false, true] {
            data.pinned[0] = pinned;
            let mut scene = build::scene::<f64>(&data);
            let before = build::bits(&scene);
            for _ in 0..10 {
                let damped = hooke::SpringDamping(0.5);
                let report = method.step(&mut scene, options(0.01, 1e-6), damped, &[]).unwrap();
                assert_eq!(report.iterations, 0);
                assert_eq!(build::bits(&scene), before, "{method:?}");
            }
        }
    }
}
