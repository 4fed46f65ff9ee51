//! What a step of several solves reports of an island: iterations added, the largest bounds, the worst ending, whichever came first.

use std::cell::Cell;

use hooke::solver::Problem;
use hooke::{BlockJacobi, Ending, Force, LinearlyImplicitEuler, Rosenbrock2, Solve, Solver, StepError, Stop};
use hooke_tests::vec_memory::VecScene;
use hooke_tests::{build, generate};

/// Block Jacobi that says of its solves what it is told.
struct Told<'a> {
    told: &'a [Solve<f64>],
    solves: &'a Cell<usize>,
}

impl Solver<f64> for Told<'_> {
    fn solve<F: Force<f64>>(
        &mut self,
        problem: Problem<'_, '_, f64, F>,
        stop: &Stop<f64>,
    ) -> Result<Solve<f64>, StepError> {
        BlockJacobi.solve(problem, stop)?;
        self.solves.set(self.solves.get() + 1);
        Ok(self.told[self.solves.get() - 1])
    }
}

const ONE: Solve<f64> =
    Solve { iterations: 3, upper: 2.0, lower: 0.5, ending: Ending::Converged, fallback: false };

/// What a step of ros2 tells of its one island, whose two solves end so.
fn merged(told: [Solve<f64>; 2]) -> Result<Solve<f64>, StepError> {
    let data = generate::rope(5);
    let mut scene: VecScene<f64> = build::scene(&data);
    let solves = Cell::new(0);
    let memory = vec![[0.0; 3]; Rosenbrock2::<f64, ()>::needs(5)];
    let mut method =
        Rosenbrock2::new(0.01, memory).gravity(data.gravity).solver(Told { told: &told, solves: &solves });
    let mut seen = Vec::new();
    scene.step_watched(&mut method, &[], |island| seen.push(island.solve))?;
    assert_eq!((solves.get(), seen.len()), (2, 1));
    Ok(seen[0])
}

#[test]
fn iterations_are_added_and_the_largest_bounds_told_whichever_solve_has_them() {
    for (upper, lower) in [(2.0, 0.5), (1.0, 0.25), (3.0, 0.75), (3.0, 0.25), (1.0, 0.75)] {
        let other = Solve { iterations: 4, upper, lower, ..ONE };
        let both = Solve { iterations: 7, upper: f64::max(2.0, upper), lower: f64::max(0.5, lower), ..ONE };
        assert_eq!(merged([ONE, other]), Ok(both));
        assert_eq!(merged([other, ONE]), Ok(both));
    }
}

#[test]
fn the_worst_ending_is_told_and_a_fallback_is_not_forgotten() {
    use Ending::{Capped, Converged, Floor, Stalled, Untouched};
    let all = [Untouched, Converged, Floor, Capped, Stalled];
    for (i, a) in all.into_iter().enumerate() {
        for (j, b) in all.into_iter().enumerate() {
            let found = merged([Solve { ending: a, ..ONE }, Solve { ending: b, ..ONE }]).unwrap();
            assert_eq!(found.ending, all[i.max(j)]);
        }
    }
    for (a, b) in [(false, true), (true, false), (true, true), (false, false)] {
        let found = merged([Solve { fallback: a, ..ONE }, Solve { fallback: b, ..ONE }]).unwrap();
        assert_eq!(found.fallback, a || b);
    }
}

#[test]
fn a_bound_that_is_no_number_refuses_the_step_whichever_solve_has_it() {
    for upper in [f64::NAN, f64::INFINITY] {
        let bad = Solve { upper, ..ONE };
        for told in [[ONE, bad], [bad, ONE], [bad, bad]] {
            assert!(matches!(merged(told), Err(StepError::NotFinite(_))), "{told:?}");
        }
    }
}

#[test]
fn every_island_whose_solve_stalled_is_counted() {
    let stalled = Solve { ending: Ending::Stalled, ..ONE };
    for islands in 1..4 {
        let mut scene = VecScene::<f64>::empty();
        for i in 0..islands {
            scene.particle([i as f64, 0.0, 0.0], 1.0).unwrap();
        }
        let solves = Cell::new(0);
        let told = [stalled; 3];
        let mut method = LinearlyImplicitEuler::new(0.01)
            .gravity([0.0, -1.0, 0.0])
            .solver(Told { told: &told, solves: &solves });
        let report = scene.step(&mut method).unwrap();
        assert_eq!((report.stalled, report.at_floor, report.capped, report.fallbacks), (islands, 0, 0, 0));
    }
}
