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
