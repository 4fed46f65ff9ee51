//! The bounds of a solve in closed form: where the stored floats, x and the residual are exact, both are those of the theorem
//! (`core/CERTIFICATE.md`) term by term, margins for rounding and underflow with them.
//!
//! In `f32`, so that `f64` tells what the theorem says of it. A plane net at rest under a pull normal to it: no spring is
//! stretched, and none feels what moves all alike, so A x = m̃ x, and with powers of two nothing rounds but the bounds themselves.

use hooke::{BlockIlu, BlockJacobi, Ending, IslandReport, Solver, Ssor};
use hooke_tests::allowed::{THEOREM, U32 as U};
use hooke_tests::build;
use hooke_tests::data::{SceneData, SpringData};
use hooke_tests::multigrid::multigrid;
use hooke_tests::random::Random;
use hooke_tests::{direct, lanes};

/// λ, the smallest normal number
const LEAST: f64 = f32::MIN_POSITIVE as f64;
/// h, s
const H: f64 = 1.0 / 32.0;
/// m, kg, and h²k, kg
const MASS: f64 = 0.25;
const STIFF: f64 = 1.0;
/// A net of n × n particles a metre apart in the plane y = 0, numbered along rows or anyhow, with the first pinned or not.
fn net(n: usize, anyhow: bool, held: bool, pull: f64) -> SceneData {
    let mut data = SceneData { gravity: [0.0, pull, 0.0], ..SceneData::default() };
    let places = if anyhow { Random::new(5).permutation(n * n) } else { (0..n * n).collect() };
    let mut at = vec![0; n * n];
    for (i, place) in places.iter().enumerate() {
        at[*place] = i;
        data.particle([(place % n) as f64, 0.0, (place / n) as f64], MASS);
    }
    for place in 0..n * n {
        let (right, down) = (place % n + 1 < n, place / n + 1 < n);
        for other in [right.then_some(place + 1), down.then_some(place + n)].into_iter().flatten() {
            let (a, b) = (at[place], at[other]);
            data.springs.push(SpringData { a, b, k: STIFF / (H * H), l0: 1.0, c: 0.0 });
        }
    }
    data.pinned[0] = held;
    data
}

/// The springs of a particle whose other end is free, or pinned.
fn tied(data: &SceneData, i: usize, pinned: bool) -> f64 {
    let other = |s: &SpringData| if s.a == i { Some(s.b) } else { (s.b == i).then_some(s.a) };
    data.springs.iter().filter_map(other).filter(|j| data.pinned[*j] == pinned).count() as f64
}

/// δ of a row where all move alike by b/m̃: |m̃x| twice, and once more for each spring that is added after it. In lanes that is
/// each; else those to particles behind it and to pins, since before it the sum is 0.
fn delta(data: &SceneData, i: usize, b: f64, in_lanes: bool) -> f64 {
    let behind = |i: usize, j: usize| in_lanes || j > i || data.pinned[j];
    let after = |s: &&SpringData| (s.a == i && behind(i, s.b)) || (s.b == i && behind(i, s.a));
    U * (17.0 / 16.0) * (2 + data.springs.iter().filter(after).count()) as f64 * b + LEAST
}

/// One step's solve, to `relative`.
fn solve(data: &SceneData, relative: f32, solver: impl Solver<f32>) -> IslandReport<f32> {
    let mut scene = build::scene::<f32>(data);
    let mut forces = build::Forces::<f32>::new(data);
    let mut euler = forces.euler(H as f32).tolerance(relative).solver(solver);
    let mut seen = None;
    scene.step_watched(&mut euler, &[], |island| seen = Some(*island)).unwrap();
    seen.expect("one island")
}

/// `cover` of a sum of n terms: a factor and a term.
fn cover(n: usize) -> (f64, f64) {
    let n = (n + 16) as f64;
    (1.0 + 2.0 * n * U, n * LEAST)
}

/// The bound with margins for so many rows. Lanes count places, of which some have no row: up to eight times as many.
fn near(name: &str, found: f32, rows: usize, expected: impl Fn(usize) -> f64) -> usize {
    let most = if name.starts_with("lanes") { 8 * rows } else { rows };
    let off = |rows: usize| (f64::from(found) / expected(rows) - 1.0).abs() / U;
    let counted = (rows..=most).min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap_or(rows);
    println!("{name}: {found:e}, {:.1} u from the theorem, {counted} of {rows} rows", off(counted));
    assert!(
        off(counted) <= THEOREM,
        "{name}: {found:e}, and the theorem says {:e}: {} u",
        expected(rows),
        off(rows)
    );
    counted
}

/// μ of an uncompressed row is m̃, rounded down.
const MU: f64 = MASS * (1.0 - 4.0 * U);

/// Every solver by name, with whether its preconditioner makes z = r/m̃ exactly, and whether its lower bound is the one by ν.
fn each(data: &SceneData, mut check: impl FnMut(&str, bool, bool, &dyn Fn(f32) -> IslandReport<f32>)) {
    check("block Jacobi", true, false, &|r| solve(data, r, BlockJacobi));
    let mut wide = lanes::wide::<f32>(data);
    solve(data, 1.0, &mut wide);
    // A net in any order may fill no lanes; then this is block Jacobi once more.
    let name = if wide.in_lanes() { "lanes" } else { "no lanes" };
    check(name, true, false, &|r| solve(data, r, lanes::wide::<f32>(data)));
    let name = if wide.in_lanes() { "lanes in f32" } else { "no lanes, in f32" };
    check(name, true, false, &|r| solve(data, r, lanes::single::<f32>(data)));
    check("SSOR", false, false, &|r| solve(data, r, Ssor::new(vec![1.0f32; Ssor::needs(data.len())])));
    check("D-ILU", false, false, &|r| {
        solve(data, r, BlockIlu::new(vec![1.0f32; BlockIlu::needs(data.len())]))
    });
    check("multigrid", false, false, &|r| solve(data, r, multigrid(data)));
    check("banded", false, true, &|r| solve(data, r, direct::banded::<f32>(data)));
    check("sparse", false, true, &|r| solve(data, r, direct::sparse::<f32>(data)));
}

/// Where x = 0 and r = b exactly: δ = 0.
#[test]
fn where_nothing_is_solved_the_bounds_are_those_of_b_itself_with_the_margins_of_the_theorem() {
    // Once where all is far from the smallest numbers, once where what underflow can lose is a tenth of it.
    for pull in [-8.0, -8.0 * 2f64.powi(-58)] {
        for (n, anyhow) in [(2, false), (5, false), (5, true), (9, false), (9, true)] {
            let data = net(n, anyhow, true, pull);
            let (rows, springs) = (n * n - 1, data.springs.len());
            let b = (MASS * H * pull).abs();
            each(&data, |name, exact, by_nu, solve| {
                let name =
                    format!("{name}, {n} by {n}{}, b = {b:e}", if anyhow { ", any order" } else { "" });
                let solve = solve(1.0).solve;
                assert_eq!((solve.ending, solve.iterations), (Ending::Untouched, 0), "{name}");
                let upper = |counted: usize| {
                    let (factor, term) = cover(3 * counted);
                    0.5 * rows as f64 * b * b / MU * factor + term
                };
                let counted = near(&format!("{name}: upper"), solve.upper, rows, upper);
                let (factor, term) = cover(3 * counted);
                if by_nu {
                    let nu = |i: usize| MASS + STIFF * (2.0 * tied(&data, i, false) + tied(&data, i, true));
                    let sum: f64 = (1..data.len()).map(|i| b * b / nu(i)).sum();
                    let own = (springs + 3 * rows + 32) as f64;
                    let lower = 0.5 * sum * (1.0 - 2.0 * own * U) - own * LEAST;
                    if lower > 100.0 * own * LEAST {
                        near(&format!("{name}: lower"), solve.lower, rows, |_| lower);
                    } else {
                        assert!(f64::from(solve.lower) <= lower.max(0.0) * 1.001 + LEAST, "{name}");
                    }
                } else if exact {
                    // z = b/m̃, r − Az = 0: what is left are margins.
                    let z = b / MASS;
                    let size = rows as f64 * b * z;
                    let unit = factor - 1.0;
                    let gain = size - (unit * size + term);
                    let form = if name.starts_with("lanes") {
                        // Springs are at right angles to z and not stretched: they add terms, but nothing to the sum.
                        let (factor, term) = cover(counted + springs);
                        (size + (factor - 1.0) * size * factor + term) * factor
                    } else {
                        let spread: f64 = (1..data.len()).map(|i| delta(&data, i, b, false) * z).sum();
                        (size + spread * factor + unit * size + term) * factor
                    };
                    near(&format!("{name}: lower"), solve.lower, rows, |_| 0.5 * gain * gain / form / factor);
                } else {
                    assert!(solve.lower > 0.0 && solve.lower < solve.upper, "{name}");
                }
            });
        }
    }
}

/// Where x = b/m̃ exactly, r = 0, and what is left of the upper bound is δ.
#[test]
fn where_the_answer_is_exact_the_upper_bound_is_that_of_the_rounding_alone_and_the_lower_one_is_0() {
    for (n, anyhow) in [(2, false), (5, false), (5, true), (9, false), (9, true)] {
        for held in [true, false] {
            let data = net(n, anyhow, held, -8.0);
            let rows = n * n - usize::from(held);
            let b = (MASS * H * 8.0).abs();
            each(&data, |name, exact, _, solve| {
                // A net that nothing holds is moved as a whole before anything else is asked.
                if !exact && held {
                    return;
                }
                let name =
                    format!("{name}, {n} by {n}{}, held: {held}", if anyhow { ", any order" } else { "" });
                let solve = solve(1e-6).solve;
                assert!(matches!(solve.ending, Ending::Converged | Ending::Untouched), "{name}: {solve:?}");
                let upper = |counted: usize, all: bool| {
                    let of = |i: usize| delta(&data, i, b, all).powi(2) / MU;
                    let (factor, term) = cover(3 * counted);
                    0.5 * (data.len() - rows..data.len()).map(of).sum::<f64>() * factor + term
                };
                if name.starts_with("lanes") {
                    // Which springs come first there is the layout's affair.
                    let (least, most) = (upper(rows, false) * (1.0 - THEOREM * U), upper(8 * rows, true));
                    assert!((least..=most).contains(&f64::from(solve.upper)), "{name}: {solve:?}");
                } else {
                    near(&name, solve.upper, rows, |counted| upper(counted, false));
                }
                assert_eq!(solve.lower, 0.0, "{name}");
            });
        }
    }
}

/// Two springs of a particle, each pressed to a quarter: α = −3h²k, |w|² = 4h²k.
#[test]
fn mu_is_what_pressed_springs_leave_of_the_mass_rounded_down_by_8_units_of_it() {
    // m̃ is 3·2^-9 more than the charge, so that what is rounded up of the charge is 2^11 times as much of μ.
    let left = 1.0 / 512.0;
    let mut data = SceneData { gravity: [0.0, 0.0, -8.0], ..SceneData::default() };
    for (x, mass) in [(0.0, 1.0), (1.0, 6.0 * STIFF * (1.0 + left)), (2.0, 1.0)] {
        data.particle([x, 0.0, 0.0], mass);
    }
    for (a, b) in [(0, 1), (1, 2)] {
        data.springs.push(SpringData { a, b, k: STIFF / (H * H), l0: 4.0, c: 0.0 });
    }
    (data.pinned[0], data.pinned[2]) = (true, true);
    let island = solve(&data, 1.0, BlockJacobi);
    assert!(island.certified && island.clamped == 0 && island.solve.ending == Ending::Untouched);
    let charge = (3.0 * STIFF * (1.0 + 4.0 * U) + 3.0 * STIFF) * (1.0 + 4.0 * U);
    let mu = (data.mass[1] - charge) * (1.0 - 4.0 * U);
    let b = data.mass[1] * H * 8.0;
    let (factor, term) = cover(3);
    let expected = 0.5 * b * b / mu * factor + term;
    let off = (f64::from(island.solve.upper) / expected - 1.0).abs() / U;
    // Each of two charges is rounded thrice by half a unit at most: of μ 512 times that.
    println!("{} {expected} {off}", island.solve.upper);
    assert!(off <= 2.0 * 512.0, "{off}");
    // Half of what is charged more, 4u twice over, would show.
    assert!((0.5 * b * b / (data.mass[1] - 6.0 * STIFF) * factor / expected - 1.0).abs() / U > 2.0 * 1024.0);
}

/// One pressed spring, α = −3h²k, charged as 3h²k(1 + 4u): a mass of just that leaves μ = 0, and one unit more leaves something.
#[test]
fn a_node_whose_mu_is_exactly_0_is_not_certified_and_its_spring_is_clamped() {
    let charge = 3.0 * STIFF as f32 * (1.0 + 2.0 * f32::EPSILON);
    for (mass, certified, clamped) in
        [(charge, false, 1), (charge.next_up(), true, 0), (charge.next_down(), false, 1)]
    {
        let mut data = SceneData { gravity: [0.0, 0.0, -8.0], ..SceneData::default() };
        data.particle([0.0; 3], 1.0);
        data.particle([1.0, 0.0, 0.0], f64::from(mass));
        data.springs.push(SpringData { a: 0, b: 1, k: STIFF / (H * H), l0: 4.0, c: 0.0 });
        data.pinned[0] = true;
        let island = solve(&data, 1e-4, BlockJacobi);
        assert_eq!((island.certified, island.clamped), (certified, clamped), "{mass}");
    }
}
