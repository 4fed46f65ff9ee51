//! One iteration of each iterative method against the memory bound, told apart from what a step costs besides: the time
//! of a step that is cut off after MANY iterations less that of one after FEW, at state 0, divided by the difference.

use cpu_time::ThreadTime;
use hooke::Force;
use hooke_harness::run::solver::{AnySolver, Method};

use crate::bandwidth::{self, Level};
use crate::median::median;
use crate::methods;
use crate::scenario::Scenario;

const FEW: u32 = 2;
const MANY: u32 = 14;
/// Pairs of steps.
const REPEATS: usize = 15;

/// α and w: a layout in lanes has no indices.
const PER_SPRING: usize = 4 * 8;
/// Inertia, 1/μ and D⁻¹ read; x, r, p and y read and written.
const PER_PARTICLE: usize = 8 + 8 + 6 * 8 + 4 * 2 * 24;

/// A method's iteration on a scene.
#[derive(Debug, Clone)]
pub(crate) struct Iteration {
    pub(crate) scene: String,
    pub(crate) dt: f64,
    pub(crate) method: &'static str,
    pub(crate) springs: usize,
    /// ns; `None` if the scene was solved to rounding too soon
    pub(crate) time: Option<f64>,
    /// ns that the memory allows an iteration of block-Jacobi PCG
    pub(crate) allowed: f64,
    pub(crate) level: Level,
}

/// ns of a step that is cut off after `most` iterations; `None` if it ended before.
fn cut_off<F: Force<f64> + Clone>(
    scenario: &mut Scenario<F>,
    solver: &mut AnySolver<f64>,
    most: u32,
) -> Option<f64> {
    scenario.put(0);
    let mut euler = scenario.euler.clone().tolerance(0.0).max_iterations(most).solver(solver);
    let began = ThreadTime::now();
    let report = scenario.scene.step(&mut euler).ok()?;
    let time = began.elapsed().as_nanos() as f64;
    (report.capped == report.islands && report.iterations == most * report.islands).then_some(time)
}

/// ns per iteration.
fn time<F: Force<f64> + Clone>(scenario: &mut Scenario<F>, solver: &mut AnySolver<f64>) -> Option<f64> {
    // What it learns of the pattern is no iteration's cost.
    cut_off(scenario, solver, FEW)?;
    let mut times = Vec::new();
    for _ in 0..REPEATS {
        let few = cut_off(scenario, solver, FEW)?;
        times.push((cut_off(scenario, solver, MANY)? - few) / f64::from(MANY - FEW));
    }
    Some(median(times))
}

/// Times an iteration of those of `methods` that iterate.
pub(crate) fn iterations<F: Force<f64> + Clone>(
    scenario: &mut Scenario<F>,
    methods: &[Method],
    levels: &[Level; 4],
) -> Vec<Iteration> {
    let springs = scenario.scene.state().springs();
    let bytes = PER_SPRING * springs + PER_PARTICLE * scenario.particle.len();
    let level = bandwidth::home(levels, bytes);
    let iterating = methods.iter().filter(|method| methods::iterates(**method));
    let of = |method: &Method| {
        // What is skipped, and why, the comparison says.
        let mut solver = methods::solver(*method, scenario).ok()?;
        Some(Iteration {
            scene: scenario.name.clone(),
            dt: scenario.euler.dt(),
            method: methods::name(*method),
            springs,
            time: time(scenario, &mut solver),
            allowed: bytes as f64 / level.read,
            level,
        })
    };
    iterating.filter_map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    #[test]
    fn an_iteration_takes_time_unless_there_are_not_enough_of_them() {
        let level = Level { name: "L1", size: usize::MAX, read: 100.0 };
        let all = methods::all();
        let mut scenario = testing::moving("cloth:16");
        let cloth = iterations(&mut scenario, &all, &[level; 4]);
        assert_eq!(cloth.len(), all.len() - 3, "those with exact factors, or nearly exact, hardly iterate");
        assert!(cloth.iter().all(|iteration| iteration.time.is_some_and(|ns| ns > 0.0)), "{cloth:?}");
        // One free particle: exact after one iteration.
        let pair = iterations(&mut testing::moving("chain:2"), &all, &[level; 4]);
        assert!(pair.iter().all(|iteration| iteration.time.is_none()), "{pair:?}");
    }
}
