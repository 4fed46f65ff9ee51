//! One who is timed: a peer or one of Hooke's methods, made ready for a scene.
//!
//! Both start from the same restored state. A peer is charged the kernel's own assembly of the step (forces, Hessians,
//! certificate, right side: the same code that Hooke's step runs), the adding of the blocks into its array of values,
//! its numeric factorisation and its solve; Hooke its whole step. What depends on the pattern only is free for both: each
//! has solved state 0 once before it is timed.
//! Times are those of the thread, not of the clock on the wall: what others do on the machine is not counted.

use cpu_time::ThreadTime;
use hooke::{Force, LinearlyImplicitEuler};
use hooke_harness::run::solver::{AnySolver, Method};

use crate::pattern::Pattern;
use crate::peers::{Entry, Peer};
use crate::scenario::{MOST_ITERATIONS, Scenario};
use crate::{memory, methods};

/// One timed answer.
pub(crate) struct Answer {
    pub(crate) seconds: f64,
    pub(crate) iterations: u32,
    /// Δq̇, row by row
    pub(crate) x: Vec<f64>,
    /// Upper and lower bound as the kernel reports them, J.
    pub(crate) reported: Option<[f64; 2]>,
    pub(crate) unfinished: bool,
}

/// What is made ready once.
enum Kind<'a, F> {
    Peer { peer: Box<dyn Peer>, pattern: &'a Pattern, values: Vec<f64>, b: Vec<f64> },
    Hooke(Box<LinearlyImplicitEuler<f64, F, AnySolver<f64>>>),
}

/// One who is timed.
pub(crate) struct Contender<'a, F> {
    pub(crate) name: &'static str,
    pub(crate) is_peer: bool,
    /// None for a direct peer.
    pub(crate) tolerance: Option<f64>,
    pub(crate) bytes: usize,
    /// The answer at state 0 by which it was made ready.
    pub(crate) first: Option<Answer>,
    kind: Kind<'a, F>,
}

impl<'a, F: Force<f64> + Clone> Contender<'a, F> {
    /// A peer that has solved state 0 once, so that its memory is known; or why it is skipped.
    pub(crate) fn peer(
        entry: &Entry,
        pattern: &'a Pattern,
        tolerance: f64,
        scenario: &mut Scenario<F>,
    ) -> Result<Self, String> {
        let (kind, held) = memory::held_by(|| -> Result<_, String> {
            let peer = (entry.make)(pattern, tolerance)?;
            let (values, b) = (vec![0.0; pattern.entries()], vec![0.0; scenario.unknowns()]);
            Ok(Kind::Peer { peer, pattern, values, b })
        });
        let tolerance = entry.iterates.then_some(tolerance);
        let mut contender =
            Self { name: entry.name, is_peer: true, tolerance, bytes: 0, first: None, kind: kind? };
        scenario.put(0);
        let (first, more) = memory::peak_of(|| contender.run(scenario, 0));
        contender.first = Some(first?);
        let Kind::Peer { peer, .. } = &contender.kind else { return Ok(contender) };
        contender.bytes = peer.bytes_elsewhere().unwrap_or(held + more) + pattern.map_bytes();
        Ok(contender)
    }

    /// One of Hooke's methods that has solved state 0 once, so that it knows the pattern; or why it is skipped.
    pub(crate) fn hooke(method: Method, tolerance: f64, scenario: &mut Scenario<F>) -> Result<Self, String> {
        let solver = methods::solver(method, scenario)?;
        let bytes = methods::bytes(&scenario.scene, &solver);
        let euler = scenario.euler.clone().tolerance(tolerance).max_iterations(MOST_ITERATIONS);
        let kind = Kind::Hooke(Box::new(euler.solver(solver)));
        let (name, tolerance) = (methods::name(method), Some(tolerance));
        let mut contender = Self { name, is_peer: false, tolerance, bytes, first: None, kind };
        scenario.put(0);
        contender.first = Some(contender.run(scenario, 0)?);
        Ok(contender)
    }

    /// Solves state k, into which the scene has just been put.
    pub(crate) fn run(&mut self, scenario: &mut Scenario<F>, k: usize) -> Result<Answer, String> {
        match &mut self.kind {
            Kind::Peer { peer, pattern, values, b } => {
                let mut x = vec![0.0; b.len()];
                let began = ThreadTime::now();
                pattern.fill(scenario, values, b);
                let assembly = began.elapsed();
                let solved = peer.solve(values, b, &mut x)?;
                let seconds = (assembly + solved.time).as_secs_f64();
                Ok(Answer { seconds, iterations: solved.iterations, x, reported: None, unfinished: false })
            }
            Kind::Hooke(euler) => {
                let began = ThreadTime::now();
                let report = scenario.scene.step(euler.as_mut()).map_err(|error| error.to_string())?;
                let seconds = began.elapsed().as_secs_f64();
                Ok(Answer {
                    seconds,
                    iterations: report.iterations,
                    x: scenario.change(k),
                    reported: Some([report.upper, report.lower]),
                    unfinished: report.capped + report.stalled > 0,
                })
            }
        }
    }
}
