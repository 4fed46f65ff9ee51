//! Observed orders: the differences of runs at h, h/2 and h/4 fall by 2 to the order; and what the estimates of error are worth.

use hooke::{
    Course, Embedded, Force, Hessian, Motion, Real, Rosenbrock2, Rosenbrock3, Scaling, StepError, force::Rows,
};
use hooke_tests::data::{PointData, SceneData, distance};
use hooke_tests::methods::{Method, Method::*, options};
use hooke_tests::vec_memory::VecScene;
use hooke_tests::{build, generate};
use nalgebra::Vector3;

/// A cloth in motion, soft and smooth: with damping and drag if wanted.
pub(super) fn cloth(damped: bool) -> SceneData {
    let mut cloth = generate::cloth(6);
    for (i, x) in cloth.position.iter_mut().enumerate() {
        // No spring rests and no coordinate is idle.
        let t = i as f64;
        let by = if cloth.pinned[i] { 0.0 } else { 0.02 };
        *x = [x[0] + by * (1.3 * t).sin(), x[1] + by * (0.7 * t).cos(), x[2] + by * (2.1 * t).sin()];
    }
    for (i, v) in cloth.velocity.iter_mut().enumerate() {
        if !cloth.pinned[i] {
            *v = [0.3 * (i as f64).cos(), 0.5, 0.2 * (i as f64).sin()];
        }
    }
    cloth.springs.iter_mut().for_each(|s| s.k *= 0.1);
    if damped {
        cloth.drag = 2.0;
        cloth.springs.iter_mut().for_each(|s| s.c = 0.05);
    }
    cloth
}

/// The pin's way: b(t) with an acceleration that changes.
pub(super) fn way(start: [f64; 3], t: f64) -> [[f64; 3]; 2] {
    let (a, w) = (0.05, 25.0);
    let [sin, cos] = [(w * t).sin(), (w * t).cos()];
    [[start[0] + a * sin, start[1] + a * (1.0 - cos), start[2]], [a * w * cos, a * w * sin, 0.0]]
}

/// q and 0.1 s·q̇ at the end.
fn run<T: Real>(method: Method, data: &SceneData, seconds: f64, steps: usize, moving: bool) -> Vec<[f64; 3]> {
    let real = |x: [f64; 3]| x.map(T::from_f64);
    // As exact as the precision has it.
    let tolerance = if T::UNIT_ROUNDOFF.to_f64() < 1e-10 { 1e-12 } else { 1e-6 };
    let h = seconds / steps as f64;
    let mut scene = build::scene::<T>(data);
    let mut forces = build::Forces::<T>::new(data);
    if moving {
        scene.set_pin_velocity(0, real(way(data.position[0], 0.0)[1])).unwrap();
    }
    for step in 1..=steps {
        let [position, velocity] = way(data.position[0], step as f64 * h);
        let motion = [Motion { particle: 0, position: real(position), velocity: real(velocity) }];
        let motion = if moving { motion.as_slice() } else { &[] };
        let made = method.step(&mut scene, options(h, tolerance), forces.all(), motion);
        assert!(made.is_ok(), "{method:?}, step {step} of {steps}: {made:?}");
    }
    state(&scene)
}

pub(super) fn state<T: Real>(scene: &VecScene<T>) -> Vec<[f64; 3]> {
    let mut end = build::positions(scene);
    end.extend(build::velocities(scene).into_iter().map(|v| v.map(|v| 0.1 * v)));
    end
}

/// Of runs with h, h/2 and h/4.
pub(super) fn order_of([a, b, c]: &[Vec<[f64; 3]>; 3]) -> f64 {
    let off = |a: &[[f64; 3]], b: &[[f64; 3]]| {
        a.iter().zip(b).map(|(a, b)| distance(*a, *b).powi(2)).sum::<f64>().sqrt()
    };
    (off(a, b) / off(b, c)).log2()
}

fn observed<T: Real>(method: Method, data: &SceneData, seconds: f64, steps: usize, moving: bool) -> f64 {
    order_of(&[1, 2, 4].map(|n| run::<T>(method, data, seconds, n * steps, moving)))
}

pub(super) const ORDERS: [(Method, f64); 8] = [
    (Euler, 1.0),
    (Midpoint, 2.0),
    (Ros2, 2.0),
    (Ros3, 3.0),
    (Newton, 1.0),
    (EnergyMomentum, 2.0),
    (Verlet, 2.0),
    (SymplecticEuler, 1.0),
];

#[test]
fn every_method_has_its_order_also_with_damping_and_with_pins_that_accelerate() {
    println!("{:>16} {:>7} {:>7} {:>7}", "method", "plain", "damped", "moving");
    let mut off = Vec::new();
    for (method, order) in ORDERS {
        let found = [(false, false), (true, false), (true, true)].map(|(damped, moving)| {
            observed::<f64>(method, &cloth(damped), 0.064, if order < 1.5 { 1024 } else { 64 }, moving)
        });
        println!("{:>16} {:7.2} {:7.2} {:7.2}", format!("{method:?}"), found[0], found[1], found[2]);
        for found in found {
            if (found - order).abs() > 0.1 {
                off.push((method, found));
            }
        }
    }
    assert!(off.is_empty(), "{off:?}");
}

/// The cloth with points that pull at three particles.
fn held(mut cloth: SceneData) -> SceneData {
    cloth.points = [8, 14, 21]
        .map(|i| {
            let [x, y, z] = cloth.position[i];
            PointData { particle: i, target: [x + 0.1, y + 0.2, z - 0.1], k: 20.0, l0: 0.1 }
        })
        .into();
    cloth
}

#[test]
fn point_springs_leave_every_method_its_order() {
    for (method, order) in ORDERS {
        let steps = if order < 1.5 { 1024 } else { 64 };
        let found = observed::<f64>(method, &held(cloth(true)), 0.064, steps, false);
        println!("{method:?} with point springs: {found:.2}");
        assert!((found - order).abs() <= 0.1, "{method:?}: {found}");
    }
}

/// The same orders as f64 sees with the same steps, which are so long that rounding, u·(1 m) over some hundred of them, is a
/// thousandth of what they differ by; on springs so soft that these steps show an order.
#[test]
fn in_f32_every_method_has_its_order_down_to_where_rounding_begins() {
    let mut data = cloth(true);
    data.springs.iter_mut().for_each(|s| s.k *= 0.02);
    let mut off = Vec::new();
    for (method, order) in ORDERS {
        let steps = [64, 16, 8][order as usize - 1];
        let [single, double] = [
            observed::<f32>(method, &data, 0.064, steps, false),
            observed::<f64>(method, &data, 0.064, steps, false),
        ];
        println!("{method:?}: {single:.3} in f32, {double:.3} in f64 with the same steps");
        if (single - order).abs() > 0.1 || (single - double).abs() > 0.1 {
            off.push((method, single, double));
        }
    }
    assert!(off.is_empty(), "{off:?}");
}

/// A pull of 3 N/m to the origin that says it had 20 N/m.
struct Wrong {
    scale: f64,
}

impl Force<f64> for Wrong {
    const ANCHORS: bool = true;
    fn check(&self, _: usize, _: usize) -> Result<(), StepError> {
        Ok(())
    }
    fn add(&self, rows: &Rows<'_, f64>, f: &mut [[f64; 3]]) {
        for (f, i) in f.iter_mut().zip(rows.particles()) {
            for d in 0..3 {
                f[d] -= 3.0 * rows.state().position[i][d];
            }
        }
    }
    fn linearize(&mut self, _: &Rows<'_, f64>, scaling: Scaling<f64>) -> u32 {
        self.scale = scaling.stiffness;
        0
    }
    fn hessians(&self, rows: &Rows<'_, f64>, visit: &mut impl FnMut(usize, Hessian<f64>)) {
        for row in 0..rows.particles().count() {
            visit(row, Hessian { alpha: 20.0 * self.scale, w: [0.0; 3] });
        }
    }
}

/// A matrix that is wrong by as much as one likes, at any h.
#[test]
fn rosenbrock_methods_have_their_order_with_any_symmetric_matrix_and_midpoint_only_with_the_true_one() {
    let data = cloth(true);
    for (method, order) in [(Euler, 1.0), (Ros2, 2.0), (Ros3, 3.0), (Midpoint, 1.0), (EnergyMomentum, 2.0)] {
        let steps = if order < 1.5 { 1024 } else { 64 };
        let [a, b, c] = [1, 2, 4].map(|n| {
            let mut scene = build::scene::<f64>(&data);
            for _ in 0..n * steps {
                let h = 0.064 / f64::from(n * steps);
                method.step(&mut scene, options(h, 1e-12), Wrong { scale: 0.0 }, &[]).unwrap();
            }
            build::positions(&scene)
        });
        let found = (build::farthest(&a, &b) / build::farthest(&b, &c)).log2();
        println!("{method:?} with a wrong matrix: {found:.2}");
        assert!((found - order).abs() <= 0.1, "{method:?}: {found}");
    }
}

/// One attempt: the estimate's distance and energy, and the farthest that the step itself is off, by many small steps of `ros3`.
fn estimate<I: Embedded<f64>>(data: &SceneData, mut method: I, h: f64) -> [f64; 3] {
    let mut scene = build::scene::<f64>(data);
    let (_, error) = method.attempt(&mut scene.parts(), h, Course::rest(), 0.0, &mut |_| {}).unwrap();
    method.accept(scene.parts(), Course::rest()).unwrap();
    let exact = run::<f64>(Ros3, data, h, 64, false);
    let off = build::farthest(&build::positions(&scene), &exact[..data.len()]);
    [error.distance, error.energy, off]
}

#[test]
fn the_estimate_is_of_the_size_of_the_true_local_error_and_its_energy_goes_with_h4_under_ros2_and_h6_under_ros3_or_more()
 {
    let memory = |data: &SceneData| vec![[0.0; 3]; Rosenbrock3::<f64, ()>::needs(data.len())];
    let mut stiff = cloth(false);
    stiff.springs.iter_mut().for_each(|s| s.k *= 1e4);
    for (name, data, smooth) in
        [("cloth", cloth(false), true), ("damped", cloth(true), true), ("stiff", stiff, false)]
    {
        let mut forces = build::Forces::<f64>::new(&data);
        for method in ["ros2", "ros3"] {
            let mut seen = Vec::new();
            for h in [2e-3, 1e-3, 5e-4] {
                let found = if method == "ros2" {
                    estimate(&data, Rosenbrock2::new(h, memory(&data)).with(forces.all()), h)
                } else {
                    estimate(&data, Rosenbrock3::new(h, memory(&data)).with(forces.all()), h)
                };
                let ratio = found[0] / found[2];
                println!(
                    "{name}, {method}, h {h:.0e}: estimate {:.1e} m over truth {:.1e} m = {ratio:.1}",
                    found[0], found[2]
                );
                // What is judged is the energy, which δq̇ of order 1 rules.
                let least = if !smooth {
                    0.1
                } else if method == "ros2" {
                    0.5
                } else {
                    1.0
                };
                assert!(ratio > least, "{name}, {method}, {h} s: {ratio}");
                seen.push(found[1]);
            }
            let power = (seen[1] / seen[2]).log2();
            println!("{name}, {method}: its energy goes with h^{power:.2}");
            if smooth {
                // Damped springs leave a part of J out: then a W-method's error of order 2 shows in δq̇.
                let expected = match (method, name) {
                    // Near rest ȧ is small, and then it goes with more.
                    ("ros2", _) => 3.75..6.25,
                    (_, "damped") => 3.75..6.25,
                    _ => 5.75..6.25,
                };
                assert!(expected.contains(&power), "{power}");
            }
        }
    }
}

/// The pin's way has an acceleration, or the test above would see less.
#[test]
fn the_way_of_the_pin_accelerates() {
    let rate = |t| Vector3::from(way([0.0; 3], t)[1]);
    assert!((rate(0.05) - rate(0.0)).norm() > 0.5);
}
