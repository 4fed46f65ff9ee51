//! `--solver auto`: which solver a scene gets, decided from what it is, never by a clock: the same scene and options choose
//! the same solver on every machine.
//!
//! Every solver's work in a step is foretold, and the least wins. Work is counted (springs, iterations, multiplications of
//! a factorisation) and weighed with [`WEIGHTS`], nanoseconds of one machine. Their ratios are what matters; to take them
//! anew, on another machine or after a solver has changed:
//!
//! `cargo run --release -p hooke-benches --bin compare -- --choose`
//!
//! It times every solver on a grid of scenes, steps and tolerances, prints who wins beside what is chosen here, and the
//! weights that fit its times best, ready to be pasted.
//!
//! **Iterations.** Block Jacobi's error shrinks over a distance or a stiffness ratio, whichever is less: it needs about
//! c·min(√(1+σ), depth) iterations per halving of the residual, σ the island's stiffness and depth its distance from a pin
//! ([`super::structure`]). Multigrid's grow with the square root of that.
//!
//! An absolute tolerance or few `--max-iterations` end a solve earlier than is foretold here.

use std::fmt::Write;

use hooke::Stop;

use super::solver::{Fill, METHODS, Method, in_runs, minimum_degree};
use super::structure::{Island, islands};
use crate::cli::Precision;
use crate::scene::Model;

/// A solver that iterates.
#[derive(Debug, Clone, Copy)]
pub struct Iterative {
    /// Iterations per halving and unit of difficulty (multigrid: of its root).
    pub iterations: f64,
    /// ns per row and spring, once a step, the assembly included.
    pub setup: f64,
    /// ns per row and spring, per iteration.
    pub iteration: f64,
}

/// What a unit of work takes.
#[derive(Debug, Clone, Copy)]
pub struct Weights {
    /// Block Jacobi.
    pub jacobi: Iterative,
    /// Lanes over offset runs: the same iterations, but for rounding.
    pub wide: Iterative,
    /// Lanes over slots, where the springs lie in no runs.
    pub slots: Iterative,
    /// The two with their iterations in f32: over runs, ...
    pub wide32: Iterative,
    /// ... and over slots.
    pub slots32: Iterative,
    /// Multigrid on a scene with lanes, whose levels are read in order.
    pub multigrid: Iterative,
    /// Multigrid on any other that is flat, ...
    pub loose: Iterative,
    /// ... and where particles have more springs than in a cloth: fewer of them lie in order.
    pub solid: Iterative,
    /// ns per row of a chain that is eliminated from both ends.
    pub chain: f64,
    /// A wider band: ns per row, and per block product of the factorisation (w² of them a row).
    pub band: [f64; 2],
    /// Sparse LDLᵀ: ns per row and spring, per block of the factor, and per block product.
    pub ldl: [f64; 3],
    /// The same in f32.
    pub ldl32: [f64; 3],
}

/// Taken by the command above on one core of an AMD EPYC with AVX-512, from the 17 scenes of its grid, 2 steps and 3 tolerances. With
/// these auto has the fastest solver in 79 of 102 cases and 1.04 times the fastest's time on average, at worst 2.27 times (net:32 at
/// 1/60 s to 1e-10, where factors win; else 1.69).
pub const WEIGHTS: Weights = Weights {
    jacobi: Iterative { iterations: 0.314, setup: 30.66, iteration: 3.52 },
    wide: Iterative { iterations: 0.319, setup: 20.52, iteration: 1.69 },
    slots: Iterative { iterations: 0.298, setup: 19.59, iteration: 1.71 },
    wide32: Iterative { iterations: 0.319, setup: 23.06, iteration: 0.97 },
    slots32: Iterative { iterations: 0.300, setup: 23.92, iteration: 1.47 },
    multigrid: Iterative { iterations: 0.145, setup: 28.21, iteration: 4.38 },
    loose: Iterative { iterations: 0.143, setup: 26.28, iteration: 6.10 },
    solid: Iterative { iterations: 0.179, setup: 43.19, iteration: 19.66 },
    chain: 42.3,
    band: [223.04, 1.31],
    ldl: [69.89, 20.07, 0.39],
    ldl32: [84.36, 16.57, 0.15],
};

/// More memory than this is not asked for a factor, bytes.
const MOST_BYTES: f64 = 1e9;
/// In a scene of more particles no elimination order is looked for: it takes longer than many steps.
const MOST_PARTICLES: usize = 100_000;

/// A scene as it bears on the choice.
#[derive(Debug, Clone)]
pub struct Case {
    /// Its islands.
    pub islands: Vec<Island>,
    /// How often a solve must halve its residual.
    pub halvings: f64,
    /// Do its springs lie in offset runs?
    pub lanes: bool,
    /// Is it in f32 itself, so that nothing is gained by iterations in f32?
    pub single: bool,
    /// The sparse factor, if an order was looked for.
    pub fill: Option<Fill>,
}

impl Case {
    /// Looks at a scene, in the order that the kernel gets; without a tolerance it is the precision's usual one.
    pub fn new(model: &Model, dt: f64, tolerance: Option<f64>, precision: Precision) -> Self {
        let (usual, most) = match precision {
            Precision::F64 => (Stop::<f64>::new().relative, 44.0),
            Precision::F32 => (f64::from(Stop::<f32>::new().relative), 20.0),
        };
        let springs = model.springs.iter().map(|spring| spring.ends);
        let small = model.pinned.len() <= MOST_PARTICLES;
        Self {
            islands: islands(model, dt),
            halvings: halvings(tolerance.unwrap_or(usual), most),
            lanes: in_runs(model),
            single: precision == Precision::F32,
            fill: small.then(|| minimum_degree(&model.pinned, springs).1),
        }
    }

    /// min(√(1+σ), depth) of an island.
    pub fn difficulty(island: &Island) -> f64 {
        let (root, depth) = ((1.0 + island.stiffness).sqrt(), island.depth as f64);
        if root < depth { root } else { depth }
    }

    /// Rows and springs.
    pub fn size(island: &Island) -> f64 {
        (island.rows + island.springs) as f64
    }

    /// More springs a particle than a cloth with both diagonals has?
    pub fn solid(&self) -> bool {
        let rows: usize = self.islands.iter().map(|island| island.rows).sum();
        let springs: usize = self.islands.iter().map(|island| island.springs).sum();
        4 * springs > 17 * rows
    }

    /// Those of multigrid's weights that are this scene's.
    pub fn multigrid<'w>(&self, weights: &'w Weights) -> &'w Iterative {
        match (self.lanes, self.solid()) {
            (true, _) => &weights.multigrid,
            (false, false) => &weights.loose,
            (false, true) => &weights.solid,
        }
    }

    /// The work of a step's solves, ms of the machine that the weights are from; or why it cannot be.
    pub fn work(&self, method: Method) -> Result<f64, &'static str> {
        let w = &WEIGHTS;
        let over = |work: &dyn Fn(&Island) -> f64| 1e-6 * self.islands.iter().map(work).sum::<f64>();
        let iterate = |w: &Iterative, difficulty: fn(&Island) -> f64| {
            over(&|island| {
                let iterations = w.iterations * difficulty(island) * self.halvings;
                Self::size(island) * (w.setup + w.iteration * iterations)
            })
        };
        match method {
            Method::Jacobi => Ok(iterate(&w.jacobi, Self::difficulty)),
            Method::Wide => Ok(iterate(if self.lanes { &w.wide } else { &w.slots }, Self::difficulty)),
            Method::Wide32 if self.single => Err("the scene is in f32 itself"),
            Method::Wide32 => Ok(iterate(if self.lanes { &w.wide32 } else { &w.slots32 }, Self::difficulty)),
            Method::Multigrid => Ok(iterate(self.multigrid(w), |island| Self::difficulty(island).sqrt())),
            Method::Ssor | Method::Ilu => Err("it has no weights"),
            Method::Banded => {
                let bytes = |island: &Island| 72.0 * island.rows as f64 * island.half_bandwidth as f64;
                if self.islands.iter().any(|island| bytes(island) > MOST_BYTES) {
                    return Err("the band does not fit the memory");
                }
                Ok(over(&|island| {
                    let (rows, wide) = (island.rows as f64, island.half_bandwidth as f64);
                    rows * if wide <= 1.0 { w.chain } else { w.band[0] + w.band[1] * wide * wide }
                }))
            }
            Method::Ldl | Method::Ldl32 => {
                let Some(fill) = self.fill else { return Err("too many particles for an elimination order") };
                if 72.0 * fill.blocks > MOST_BYTES {
                    return Err("the factor does not fit the memory");
                }
                let [size, block, product] = if method == Method::Ldl { w.ldl } else { w.ldl32 };
                let factor = 1e-6 * (block * fill.blocks + product * fill.products);
                Ok(over(&|island| size * Self::size(island)) + factor)
            }
        }
    }
}

/// −log₂ R, rounded: from the number's exponent, so that no library's logarithm decides. No solve gets farther than `most`,
/// where its rounding ends it.
fn halvings(tolerance: f64, most: f64) -> f64 {
    let exponent = 1023.0 - (tolerance.to_bits() >> 52) as f64;
    if !(exponent < most) {
        most
    } else if exponent > 0.0 {
        exponent
    } else {
        0.0
    }
}

/// What was chosen, and why.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// The solver.
    pub method: Method,
    /// Why, in a line.
    pub reason: String,
}

/// Chooses the solver of least work; between equals the one that stands first in [`METHODS`].
pub fn choose(model: &Model, dt: f64, tolerance: Option<f64>, precision: Precision) -> Choice {
    let case = Case::new(model, dt, tolerance, precision);
    let (mut able, mut unable) = (Vec::new(), String::new());
    // SSOR and D-ILU have no weights: taken by name only.
    let weighed = |(_, method): &(&str, Method)| !matches!(method, Method::Ssor | Method::Ilu);
    for (name, method) in METHODS.into_iter().filter(weighed) {
        match case.work(method) {
            Ok(work) => able.push((work, name, method)),
            // Writing to a String cannot fail.
            Err(why) => _ = write!(unable, "; {name} cannot: {why}"),
        }
    }
    able.sort_by(|a, b| a.0.total_cmp(&b.0));
    let work: Vec<String> = able.iter().map(|(work, name, _)| format!("{name} {:.0}", 1e3 * work)).collect();
    Choice {
        // Block Jacobi always can.
        method: able.first().map_or(Method::Jacobi, |best| best.2),
        reason: format!(
            "least work foretold (µs a step, on the machine it was weighed on): {}{unable}",
            work.join(", ")
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::catalog;

    fn chosen(scene: &str, dt: f64, tolerance: f64) -> Choice {
        let model = catalog::named(scene).unwrap().unwrap();
        choose(&model, dt, Some(tolerance), Precision::F64)
    }

    #[test]
    fn the_reference_scenes_get_what_the_grid_says() {
        let table = [
            ("cloth:16", 0.001, ["wide32", "wide32", "wide32"]),
            ("cloth:16", 1.0 / 60.0, ["multigrid", "multigrid", "multigrid"]),
            ("cloth:32", 0.001, ["wide32", "wide32", "wide32"]),
            ("cloth:32", 1.0 / 60.0, ["multigrid", "multigrid", "multigrid"]),
            ("cloth:64", 0.001, ["multigrid", "multigrid", "multigrid"]),
            ("cloth:64", 1.0 / 60.0, ["multigrid", "multigrid", "ldl32"]),
            ("cloth:128", 0.001, ["multigrid", "multigrid", "multigrid"]),
            ("cloth:128", 1.0 / 60.0, ["multigrid", "multigrid", "ldl32"]),
            ("net:32", 0.001, ["multigrid", "multigrid", "multigrid"]),
            ("net:32", 1.0 / 60.0, ["multigrid", "multigrid", "multigrid"]),
            ("syrup:32", 0.001, ["wide32", "multigrid", "multigrid"]),
            ("syrup:32", 1.0 / 60.0, ["multigrid", "multigrid", "multigrid"]),
            ("curtain", 0.001, ["wide32", "wide32", "wide32"]),
            ("curtain", 1.0 / 60.0, ["multigrid", "multigrid", "multigrid"]),
            ("chain:40", 0.001, ["banded", "banded", "banded"]),
            ("chain:40", 1.0 / 60.0, ["banded", "banded", "banded"]),
            ("chain:1000", 0.001, ["banded", "banded", "banded"]),
            ("chain:1000", 1.0 / 60.0, ["banded", "banded", "banded"]),
            ("lattice:8x8x8", 0.001, ["wide32", "wide32", "wide32"]),
            ("lattice:8x8x8", 1.0 / 60.0, ["wide32", "multigrid", "multigrid"]),
            ("spring", 0.001, ["banded", "banded", "banded"]),
            ("spring", 1.0 / 60.0, ["banded", "banded", "banded"]),
            ("pair", 0.001, ["wide", "banded", "banded"]),
            ("pair", 1.0 / 60.0, ["wide", "banded", "banded"]),
        ];
        let wrong: Vec<String> = table
            .iter()
            .flat_map(|(scene, dt, names)| {
                let found = [1e-3, 1e-6, 1e-10].map(|r| chosen(scene, *dt, r).method.name());
                (found != *names).then(|| format!("(\"{scene}\", {dt}, {found:?}),"))
            })
            .collect();
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    }

    #[test]
    fn the_same_question_has_the_same_answer() {
        for scene in ["cloth:20", "curtain", "chain:50", "lattice:4x4x4"] {
            assert_eq!(chosen(scene, 0.01, 1e-7), chosen(scene, 0.01, 1e-7));
        }
    }

    #[test]
    fn a_net_without_runs_gets_lanes_over_slots_and_no_factor_without_an_order() {
        let mut model = Model::at_rest("", (0..61).map(|i| [i as f64, 0.0, 0.0]).collect(), 1.0);
        for i in 0..61 {
            for j in [i * i % 61, (i * i * i + 1) % 61].into_iter().filter(|j| *j != i) {
                model.join(i, j, 1.0);
            }
        }
        let choice = choose(&model, 0.01, None, Precision::F64);
        assert!(!choice.reason.contains("cannot"), "{}", choice.reason);
        assert_eq!(choice.method, Method::Wide);
        let case = Case { fill: None, ..Case::new(&model, 0.01, None, Precision::F64) };
        assert!(case.work(Method::Ldl).is_err() && case.work(Method::Jacobi).is_ok());
    }

    #[test]
    fn halvings_are_counted_by_the_exponent_and_end_where_rounding_does() {
        assert_eq!([1.0, 0.5, 0.25, 1e-3, 1e-6].map(|r| halvings(r, 44.0)), [0.0, 1.0, 2.0, 10.0, 20.0]);
        assert_eq!([0.0, 1e-300, f64::MIN_POSITIVE, 7.0].map(|r| halvings(r, 44.0)), [44.0, 44.0, 44.0, 0.0]);
    }
}
