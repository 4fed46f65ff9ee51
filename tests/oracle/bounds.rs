//! Every solve is certified: ½‖e‖²_A, computed in 62 digits for the matrix of the stored floats, lies in [lower, upper]; and
//! A ⪰ diag(μ).

use hooke::{BlockJacobi, Ending, Real, Solver};
use hooke_tests::build::{self, Forces};
use hooke_tests::data::{MotionData, SceneData};
use hooke_tests::direct;
use hooke_tests::generate::{self, Ingredients};
use hooke_tests::lanes::wide;
use hooke_tests::multigrid::multigrid;
use hooke_tests::precise::{Factor, big, small};
use hooke_tests::random::Random;
use hooke_tests::triangular::{ilu, ssor};

use crate::stored::Stored;

/// Systems per precision: 10,000 in all in release, 1,000 with debug assertions on.
const SYSTEMS: usize = if cfg!(debug_assertions) { 500 } else { 5_000 };

/// One random network, what to solve it with, and how the pins move.
struct Case {
    data: SceneData,
    h: f64,
    relative: f64,
    max_iterations: u32,
    motion: Vec<MotionData>,
}

fn case(random: &mut Random) -> Case {
    // Mostly small; one in a hundred has up to 72 unknowns, which CG does not finish in a few iterations.
    let n = if random.chance(0.01) { 24 } else { 2 + random.below(5) };
    let mut chance = |p| random.chance(p);
    let with = Ingredients {
        pins: chance(0.5),
        compressed: chance(0.5),
        damped: chance(0.4),
        points: chance(0.3),
        gravity: chance(0.7),
        // From rest, so that v⁺ = Δ holds the solution itself and not a rounded sum.
        moving: false,
    };
    let data = generate::network(random, n, with);
    let h = random.decade(1e-4, 0.1);
    let relative = if random.chance(0.1) { 0.0 } else { random.decade(1e-12, 1e-1) };
    let max_iterations = [1, 3, 10, 10_000, 10_000][random.below(5)];
    let mut motion = Vec::new();
    for particle in 0..n {
        if data.pinned[particle] && random.chance(0.3) {
            let mut position = data.position[particle];
            position.iter_mut().zip(random.vector(0.1)).for_each(|(x, d)| *x += d);
            motion.push(MotionData { particle, position, velocity: [0.0; 3] });
        }
    }
    Case { data, h, relative, max_iterations, motion }
}

/// What was seen.
#[derive(Default)]
struct Seen {
    systems: usize,
    violations: usize,
    clamped: usize,
    capped: usize,
    floor: usize,
    uncertain: usize,
    tightness: Vec<f64>,
    above: Vec<f64>,
    wrong_mu: usize,
}

impl Seen {
    fn one<T: Real>(&mut self, case: &Case, check_mu: bool, solver: impl Solver<T>) {
        let data = &case.data;
        let mut scene = build::scene::<T>(data);
        let mut forces = Forces::<T>::new(data);
        let h = T::from_f64(case.h);
        let euler = forces.euler(h).tolerance(T::from_f64(case.relative)).max_iterations(case.max_iterations);
        let mut euler = euler.solver(solver);
        let motion = build::motions::<T>(&case.motion);
        let mut islands = Vec::new();
        euler
            .inspect(scene.parts(), &motion, |system, b, mu| {
                islands.push(Stored::new(data, h, system, b, mu))
            })
            .unwrap();
        let mut reports = Vec::new();
        scene.step_watched(&mut euler, &motion, |island| reports.push(*island)).unwrap();
        assert_eq!(islands.len(), reports.len());
        let velocity = build::velocities(&scene);
        for (stored, report) in islands.iter().zip(&reports) {
            let x: Vec<f64> = stored.particles.iter().flat_map(|i| velocity[*i]).collect();
            assert_eq!(stored.clamped, report.clamped as usize);
            let factor = Factor::new(&stored.matrix).expect("A is positive definite");
            let energy = big(0.5) * factor.inverse_form(&stored.residual(&x));
            let (lower, upper) = (report.solve.lower.to_f64(), report.solve.upper.to_f64());
            self.systems += 1;
            if !(big(lower) <= energy && energy <= big(upper)) {
                println!("{:e} J not in [{lower:e}, {upper:e}]: {report:?}", small(&energy));
                self.violations += 1;
            }
            self.clamped += usize::from(report.clamped > 0);
            self.capped += usize::from(report.solve.ending == Ending::Capped);
            self.floor += usize::from(report.solve.ending == Ending::Floor);
            self.uncertain += usize::from(lower == 0.0 && upper > 0.0);
            if lower > 0.0 {
                self.tightness.push(upper / lower);
                self.above.push(upper / small(&energy));
            }
            if check_mu {
                self.wrong_mu += usize::from(stored.mu.iter().any(|mu| *mu <= 0.0));
                self.wrong_mu += usize::from(Factor::new(&stored.beyond_mu()).is_none());
            }
        }
    }
}

fn quantile(values: &mut [f64], part: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values[(part * values.len() as f64) as usize]
}

fn true_error_lies_between_the_bounds<T: Real, S: Solver<T>>(
    name: &str,
    seed: u64,
    solver: impl Fn(&SceneData) -> S,
) -> Seen {
    let mut random = Random::new(Random::seed(seed));
    let mut seen = Seen::default();
    while seen.systems < SYSTEMS {
        let case = case(&mut random);
        let check_mu = seen.systems % 5 == 0;
        seen.one::<T>(&case, check_mu, solver(&case.data));
    }
    println!(
        "{name}: {} systems, {} violations; {} clamped, {} cut short, {} at the floor, {} without lower bound; \
         median upper/lower {:.2} (nine in ten below {:.1}), upper/true {:.2}",
        seen.systems,
        seen.violations,
        seen.clamped,
        seen.capped,
        seen.floor,
        seen.uncertain,
        quantile(&mut seen.tightness, 0.5),
        quantile(&mut seen.tightness, 0.9),
        quantile(&mut seen.above, 0.5),
    );
    assert_eq!(seen.violations, 0);
    assert_eq!(seen.wrong_mu, 0, "A ⪰ diag(μ) > 0");
    seen
}

/// The cases are to meet what they are there for.
fn met(seen: &Seen) {
    assert!(seen.clamped > SYSTEMS / 50 && seen.capped > SYSTEMS / 50 && seen.floor > SYSTEMS / 50);
    assert!(seen.tightness.len() > SYSTEMS / 3);
}

#[test]
fn the_true_error_lies_between_the_bounds_in_f64() {
    met(&true_error_lies_between_the_bounds::<f64, _>("f64", 64, |_| BlockJacobi));
}

#[test]
fn the_true_error_lies_between_the_bounds_in_f32() {
    met(&true_error_lies_between_the_bounds::<f32, _>("f32", 32, |_| BlockJacobi));
}

#[test]
fn the_true_error_of_ssor_and_d_ilu_lies_between_the_bounds_in_f64() {
    met(&true_error_lies_between_the_bounds::<f64, _>("SSOR f64", 643, ssor));
    met(&true_error_lies_between_the_bounds::<f64, _>("D-ILU f64", 644, ilu));
}

#[test]
fn the_true_error_of_ssor_and_d_ilu_lies_between_the_bounds_in_f32() {
    met(&true_error_lies_between_the_bounds::<f32, _>("SSOR f32", 323, ssor));
    // On nets so small D-ILU is nearly exact: in f32 mostly rounding is left.
    met_by_direct(&true_error_lies_between_the_bounds::<f32, _>("D-ILU f32", 324, ilu));
}

#[test]
fn the_true_error_in_lanes_lies_between_the_bounds() {
    met(&true_error_lies_between_the_bounds::<f64, _>("lanes f64", 645, wide));
    met(&true_error_lies_between_the_bounds::<f32, _>("lanes f32", 325, wide));
}

/// On nets so small all is the coarsest level, which f32 factors solve: in f64 some iterations are left to do, in f32 only
/// rounding is left, in which an error can hardly be recognised.
#[test]
fn the_true_error_of_multigrid_lies_between_the_bounds_in_f64() {
    let seen = true_error_lies_between_the_bounds::<f64, _>("multigrid f64", 642, multigrid);
    assert!(seen.clamped > SYSTEMS / 50 && seen.capped > SYSTEMS / 50 && seen.floor > SYSTEMS / 50);
    assert!(seen.tightness.len() > SYSTEMS / 3, "{} lower bounds", seen.tightness.len());
}

#[test]
fn the_true_error_of_multigrid_lies_between_the_bounds_in_f32() {
    let seen = true_error_lies_between_the_bounds::<f32, _>("multigrid f32", 322, multigrid);
    assert!(seen.clamped > SYSTEMS / 50 && seen.floor > SYSTEMS / 50);
}

/// Direct solves leave rounding only; some of it is to be recognised as an error that is there.
fn met_by_direct(seen: &Seen) {
    assert!(seen.clamped > SYSTEMS / 50 && seen.floor > SYSTEMS / 50);
    assert!(seen.tightness.len() > SYSTEMS / 20, "{} lower bounds", seen.tightness.len());
}

#[test]
fn the_true_error_of_direct_solves_lies_between_the_bounds_in_f64() {
    met_by_direct(&true_error_lies_between_the_bounds::<f64, _>("banded f64", 640, direct::banded));
    met_by_direct(&true_error_lies_between_the_bounds::<f64, _>("sparse f64", 641, direct::sparse));
}

#[test]
fn the_true_error_of_direct_solves_lies_between_the_bounds_in_f32() {
    met_by_direct(&true_error_lies_between_the_bounds::<f32, _>("banded f32", 320, direct::banded));
    met_by_direct(&true_error_lies_between_the_bounds::<f32, _>("sparse f32", 321, direct::sparse));
}

#[test]
fn the_true_error_with_a_factor_in_less_precision_lies_between_the_bounds() {
    let seen = true_error_lies_between_the_bounds::<f64, _>("sparse f32 in f64", 643, direct::single);
    assert!(seen.clamped > SYSTEMS / 50 && seen.floor > SYSTEMS / 50);
    assert!(seen.tightness.len() > SYSTEMS / 3, "{} lower bounds", seen.tightness.len());
}
