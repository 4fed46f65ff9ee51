//! Every solve is certified: ½‖e‖²_A, computed in 62 digits for the matrix of the stored floats, lies in [lower, upper];
//! A ⪰ diag(μ); the bounds are no farther apart than is known beforehand; and what is certified without projection is
//! positive definite. Systems and judge are those of `src/certified`; `bin/certify.rs` runs 10⁵ systems.

use std::sync::OnceLock;

use hooke::{BandedLdl, Ending, LinearlyImplicitEuler, PointForce, Portable, Spring, Wide};
use hooke_tests::allowed;
use hooke_tests::certified::case::Case;
use hooke_tests::certified::judge;
use hooke_tests::certified::seen::{Record, Seen, quantile};
use hooke_tests::certified::solvers::METHODS;
use hooke_tests::certified::table;
use hooke_tests::data::SceneData;
use hooke_tests::random::Random;
use hooke_tests::vec_memory::VecScene;
use hooke_tests::{build, multigrid};

/// Systems in release, and with debug assertions on.
const SYSTEMS: usize = if cfg!(debug_assertions) { 1_500 } else { 6_000 };

/// Judged once for all tests.
fn seen() -> &'static Seen {
    static SEEN: OnceLock<Seen> = OnceLock::new();
    SEEN.get_or_init(|| {
        let mut random = Random::new(Random::seed(64));
        let mut seen = Seen::default();
        let mut number = 0;
        while seen.count() < SYSTEMS {
            judge::judge(&Case::new(&mut random), &mut random, number, &mut seen);
            number += 1;
        }
        println!("{}", table::markdown(&seen));
        seen
    })
}

#[test]
fn the_true_error_lies_between_the_bounds_and_mu_is_below_the_matrix() {
    let seen = seen();
    assert!(seen.wrong.is_empty(), "{}", seen.wrong.join("\n"));
    assert!(seen.mu_checked > SYSTEMS / 5);
}

#[test]
fn sixty_two_digits_are_enough() {
    let seen = seen();
    assert!(seen.compared > 100);
    assert!(seen.difference <= allowed::DIGITS, "{:e}", seen.difference);
}

#[test]
fn clear_of_rounding_the_bounds_are_no_farther_apart_than_the_matrix_says_beforehand() {
    let seen = seen();
    let clear = seen.solves.iter().filter(|r| r.clear).count();
    let loose: Vec<&Record> = seen.solves.iter().filter(|r| r.loose).collect();
    assert!(clear > SYSTEMS, "{clear}");
    assert!(loose.is_empty(), "{} of {clear}: {:?}", loose.len(), loose[0]);
}

/// T = max νᵢ/μᵢ bounds upper/lower by 2T where block Jacobi or ν makes the lower bound (`src/certified/rounding.rs`), so the
/// median of the one is below 1.25 times that of the other, 1.25 being what rounding may take. T is finite and known beforehand.
#[test]
fn at_every_condition_number_the_median_of_upper_over_lower_is_below_that_of_two_t() {
    let seen = seen();
    let mut judged = 0;
    for single in [false, true] {
        for decade in 0..=table::LAST {
            let fits = |r: &&Record| {
                r.single == single && table::row(r.decade) == decade && r.clear && r.is_bounded()
            };
            let of: Vec<&Record> = seen.solves.iter().filter(fits).collect();
            if of.len() < 20 {
                continue;
            }
            judged += 1;
            let mut ratios: Vec<f64> = of.iter().map(|r| r.ratio()).collect();
            let mut known: Vec<f64> = of.iter().map(|r| r.known).collect();
            let (median, known) = (quantile(&mut ratios, 0.5), quantile(&mut known, 0.5));
            assert!(median <= 1.25 * known, "κ = 1e{decade}: {median:e}, 2T {known:e}");
        }
    }
    assert!(judged >= 10, "{judged} decades");
}

#[test]
fn what_is_certified_without_projection_is_positive_definite() {
    let seen = seen();
    let [mut certified, mut positive] = [0; 2];
    for bin in &seen.projection {
        assert_eq!(bin.wrong, 0, "{bin:?}");
        (certified, positive) = (certified + bin.certified, positive + bin.positive);
    }
    // It accepts what is not compressed, and not everything else.
    assert_eq!(seen.projection[0].certified, seen.projection[0].systems);
    assert!(certified > positive / 2 && certified < positive, "{certified} of {positive}");
}

/// The cases are to meet what they are there for.
#[test]
fn every_solver_ending_precision_and_decade_is_met() {
    let seen = seen();
    for method in METHODS {
        for single in [false, true] {
            let of = || seen.solves.iter().filter(|r| r.method == method && r.single == single);
            assert!(of().count() > SYSTEMS / 3, "{method:?}");
            assert!(of().filter(|r| r.lower > 0.0).count() > SYSTEMS / 100, "{method:?}: lower bounds");
        }
    }
    for ending in [Ending::Untouched, Ending::Converged, Ending::Floor, Ending::Capped] {
        let met = seen.solves.iter().filter(|r| r.ending == ending).count();
        assert!(met > SYSTEMS / 10, "{ending:?}: {met}");
    }
    for decade in 0..=table::LAST {
        let systems: usize =
            seen.systems.iter().filter(|((_, _, d), _)| table::row(*d) == decade).map(|(_, n)| n).sum();
        assert!(systems > SYSTEMS / 1_000, "κ = 1e{decade}: {systems}");
    }
    assert!(seen.solves.iter().filter(|r| r.in_lanes).count() > SYSTEMS / 10);
    assert!(seen.solves.iter().filter(|r| r.fallback).count() > SYSTEMS / 20);
}

/// Where nothing is iterated, z once had what assembly left at places without a row: the lower bound was 14 % above the truth.
#[test]
fn multigrid_in_lanes_bounds_a_solve_that_it_does_not_begin() {
    let mut data = SceneData::default();
    for [x, y] in [[0.0, 0.0], [1.0, 1.0], [2.0, 1.0], [3.0, 0.0], [4.0, 1.0]] {
        data.particle([x, y, 0.0], 1.0);
    }
    data.pinned[2] = true;
    for (a, b) in [(0, 1), (0, 2), (1, 2), (1, 3), (2, 4), (3, 4)] {
        data.spring_with(a, b, 1e4, 0.0);
    }
    let mut scene = build::scene::<f64>(&data);
    let needs = Wide::needs_of(&mut scene, false);
    let lanes = Wide::new(vec![1.0; needs.0], vec![0; needs.1], Portable);
    let solver = lanes.around(multigrid::multigrid(&data));
    let mut euler = LinearlyImplicitEuler::new(0.01).tolerance(1.0).solver(solver);
    let report = scene.step(&mut euler).unwrap();
    assert_eq!(report.iterations, 0);
    // All springs are linear: ½ bᵀA⁻¹b with b = hf, in fractions.
    let truth = 59_493.670_886_075_95;
    assert!(report.lower <= truth && truth <= report.upper, "{report:?}");
}

/// In the range of subnormal numbers a product rounds up as well as down.
#[test]
fn a_direct_solvers_lower_bound_holds_where_energies_are_subnormal() {
    for push in 100..1_100_u32 {
        let force = 1e-24 * push as f32;
        let mut scene = VecScene::<f32>::empty();
        let (pin, i) =
            (scene.particle([0.0; 3], 1.0).unwrap(), scene.particle([1.0, 0.0, 0.0], 1.0).unwrap());
        scene.pin(pin).unwrap();
        scene.spring_with(pin, i, Spring { stiffness: 0.0, rest_length: 1.0 }).unwrap();
        let mut euler = LinearlyImplicitEuler::new(1.0)
            .with(PointForce { particle: i, force: [force, 0.0, 0.0] })
            .tolerance(1.0)
            .solver(BandedLdl::new(vec![0.0_f32; 64]));
        let report = scene.step(&mut euler).unwrap();
        // x = 0, so e = f h/m and ½|e|²m is the energy.
        let truth = 0.5 * f64::from(force).powi(2);
        assert!(f64::from(report.lower) <= truth, "{force:e} N: {:e} J above {truth:e} J", report.lower);
    }
}
