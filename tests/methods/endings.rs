//! How steps end that iterate on a nonlinear equation: what their report says is that equation's own residual.

use hooke::solver::Problem;
use hooke::{BlockJacobi, EnergyMomentum, Force, Newton, Solve, Solver, StepError, Stop};
use hooke_tests::allowed;
use hooke_tests::methods::{Method, options};
use hooke_tests::vec_memory::VecScene;

const H: f64 = 0.125;
const M: f64 = 2.0;
const K: f64 = 60.0;

/// A particle on a spring of a metre to a pin, stretched, and thrown across it; alone, or the second of two islands of which the
/// first rests.
fn thrown(beside: bool) -> VecScene<f64> {
    let mut scene = VecScene::<f64>::empty();
    let pin = scene.particle([0.0; 3], 1.0).unwrap();
    scene.pin(pin).unwrap();
    if beside {
        let rests = scene.particle([0.0, 0.0, 1.0], 1.0).unwrap();
        scene.spring(pin, rests, 10.0).unwrap();
    }
    let thrown = scene.particle([1.0, 0.0, 0.0], M).unwrap();
    scene.spring(pin, thrown, K).unwrap();
    scene.set_position(thrown, [1.5, 0.25, -0.5]).unwrap();
    scene.set_velocity(thrown, [0.5, 2.0, -1.0]).unwrap();
    scene
}

/// The last particle.
fn last(scene: &VecScene<f64>) -> [[f64; 3]; 2] {
    [*scene.positions().last().unwrap(), *scene.velocities().last().unwrap()]
}

fn length(x: [f64; 3]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// What a step's end leaves of its equation M(q̇⁺ − q̇) = h f, an impulse.
fn left(method: Method, [q, v]: [[f64; 3]; 2], [end, rate]: [[f64; 3]; 2]) -> f64 {
    let f: [f64; 3] = match method {
        Method::Newton => end.map(|x| -K * (1.0 - 1.0 / length(end)) * x),
        _ => {
            let middle: [f64; 3] = std::array::from_fn(|d| 0.5 * (q[d] + end[d]));
            let pull = K * (0.5 * (length(q) + length(end)) - 1.0) * 2.0 / (length(q) + length(end));
            middle.map(|x| -pull * x)
        }
    };
    let r: [f64; 3] = std::array::from_fn(|d| H * f[d] - M * (rate[d] - v[d]));
    length(r)
}

#[test]
fn the_upper_bound_is_that_of_the_residual_where_it_ended_and_the_lower_one_0() {
    for method in [Method::Newton, Method::EnergyMomentum] {
        for beside in [false, true] {
            for tolerance in [0.5, 1e-1, 1e-3] {
                let mut scene = thrown(beside);
                let before = last(&scene);
                let report = method.step(&mut scene, options(H, tolerance), (), &[]).unwrap();
                let r = left(method, before, last(&scene));
                let upper = 0.5 * r * r / M;
                println!("{method:?}, R = {tolerance}: {} iterations, {upper:e} J", report.iterations);
                // r is a difference of impulses below 8 N·s, each some 16u off; upper is M⁻¹r·δr off.
                let allowed = 256.0 * allowed::U64 * (r + 256.0 * allowed::U64);
                assert!(
                    (report.upper - upper).abs() <= allowed,
                    "{method:?}, {tolerance}: {report:?}, {upper:e}"
                );
                assert_eq!(report.lower, 0.0);
                assert_eq!(
                    (report.untouched, report.at_floor, report.capped, report.stalled),
                    (u32::from(beside), 0, 0, 0),
                    "{method:?}: converged, and the other at rest"
                );
                assert!(report.iterations >= 1 && report.upper > 0.0);
            }
        }
    }
}

#[test]
fn as_many_linear_solves_are_made_as_the_tolerance_asks_for() {
    // One row takes one iteration of PCG a solve.
    for method in [Method::Newton, Method::EnergyMomentum] {
        let solves = [0.5, 1e-1, 1e-3, 1e-6, 1e-10].map(|tolerance| {
            method.step(&mut thrown(false), options(H, tolerance), (), &[]).unwrap().iterations
        });
        let expected = if method == Method::Newton { [1, 1, 2, 3, 3] } else { [1, 1, 1, 2, 3] };
        assert_eq!(solves, expected, "{method:?}: few, and each squares what is left");
        let mut scene = thrown(false);
        let absolute = hooke_tests::methods::Options { absolute: 1e3, ..options(H, 1e-10) };
        let report = method.step(&mut scene, absolute, (), &[]).unwrap();
        assert_eq!((report.iterations, report.untouched), (0, 1), "{method:?}: a kilojoule is met at once");
    }
}

/// Notes what it is asked to stop at.
struct Asked<'n>(&'n mut Vec<[f64; 3]>);

impl Solver<f64> for Asked<'_> {
    fn solve<F: Force<f64>>(
        &mut self,
        problem: Problem<'_, '_, f64, F>,
        stop: &Stop<f64>,
    ) -> Result<Solve<f64>, StepError> {
        self.0.push([stop.relative, stop.absolute, f64::from(stop.max_iterations)]);
        BlockJacobi.solve(problem, stop)
    }
}

#[test]
fn linear_systems_of_an_iteration_are_solved_to_a_thousandth_or_as_loosely_as_the_step_whatever_it_asks_for()
{
    for (relative, expected) in [(1e-12, 1e-3), (1e-3, 1e-3), (0.125, 0.125)] {
        let (mut newton, mut energy_momentum) = (Vec::new(), Vec::new());
        let memory = || vec![[0.0; 3]; 64];
        macro_rules! step {
            ($method:expr, $asked:expr) => {
                thrown(false)
                    .step(
                        &mut $method
                            .tolerance(relative)
                            .absolute(1e-30)
                            .max_iterations(77)
                            .solver(Asked($asked)),
                    )
                    .unwrap()
            };
        }
        step!(Newton::new(H, memory()), &mut newton);
        step!(EnergyMomentum::new(H, memory()), &mut energy_momentum);
        for asked in [newton, energy_momentum] {
            assert!(
                !asked.is_empty() && asked.iter().all(|asked| *asked == [expected, 0.0, 77.0]),
                "{asked:?}"
            );
        }
    }
}

#[test]
fn a_step_of_energy_momentum_that_is_far_too_long_gives_up_without_trace_and_names_the_particle() {
    for h in [8.0, 64.0, 1e3] {
        let mut scene = thrown(true);
        let before = hooke_tests::build::bits(&scene);
        let made = Method::EnergyMomentum.step(&mut scene, options(h, 1e-10), (), &[]);
        println!("{h} s: {made:?}");
        assert_eq!(made, Err(StepError::NotConverged(2)));
        assert_eq!(hooke_tests::build::bits(&scene), before);
    }
}

#[test]
fn how_a_step_ends_is_told_of_its_own_equation_and_not_of_the_last_linear_system() {
    // Two iterations are not enough for any of the linear systems, and loose ones leave a lower bound that is not 0.
    let mut data = hooke_tests::generate::rope(12);
    data.velocity[11] = [0.0, 0.0, 1.0];
    for method in [Method::Newton, Method::EnergyMomentum] {
        let mut scene = hooke_tests::build::scene::<f64>(&data);
        let mut forces = hooke_tests::build::Forces::<f64>::new(&data);
        let few = hooke_tests::methods::Options { max_iterations: 2, ..options(1.0 / 240.0, 1e-3) };
        let report = method.step(&mut scene, few, forces.all(), &[]).unwrap();
        assert_eq!(
            (report.lower, report.capped, report.untouched, report.at_floor),
            (0.0, 0, 0, 0),
            "{method:?}"
        );
        assert!(report.iterations > 2 && report.upper > 0.0, "{method:?}: {report:?}");
    }
}

#[test]
fn a_pin_that_moves_drags_a_damped_spring_along() {
    // M(q̇⁺ − q̇) = h(f(q⁺) − c u(u·(q̇⁺ − p))), u of the beginning, p = (b⁺ − b)/h; by what is left of it.
    const C: f64 = 3.0;
    let mut scene = thrown(false);
    let [q, v] = last(&scene);
    let end = [0.25, -0.125, 0.0625];
    let motion = hooke::Motion { particle: 0, position: end, velocity: [9.0, 9.0, 9.0] };
    Method::Newton.step(&mut scene, options(H, 1e-14), hooke::SpringDamping(C), &[motion]).unwrap();
    let [x, rate] = last(&scene);
    let way: [f64; 3] = std::array::from_fn(|d| x[d] - end[d]);
    let u = q.map(|x| x / length(q));
    let along: f64 = (0..3).map(|d| u[d] * (rate[d] - end[d] / H)).sum();
    let pull = K * (1.0 - 1.0 / length(way));
    let left: [f64; 3] =
        std::array::from_fn(|d| M * (rate[d] - v[d]) + H * (pull * way[d] + C * along * u[d]));
    assert!(length(left) <= 256.0 * allowed::U64, "{left:?}");
    assert!(length(std::array::from_fn(|d| x[d] - q[d] - H * rate[d])) <= 16.0 * allowed::U64);
}
