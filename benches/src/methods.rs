//! Hooke's own solvers, a line each. To add one, give it a name, say how the integrator is told to use it, and how many
//! bytes a scene needs with it.

use std::time::Duration;

use cpu_time::ThreadTime;
use hooke::{BandedLdl, Force, Integrator, Multigrid, SceneIn, SparseLdl, StepError, WideJacobi};
use hooke_harness::host::Host;
use hooke_harness::run::solver::minimum_degree;

use crate::scenario::{Euler, HostScene};

/// One timed step.
pub(crate) struct Stepped {
    pub(crate) time: Duration,
    pub(crate) iterations: u32,
    /// The bounds that the kernel reports, J.
    pub(crate) upper: f64,
    pub(crate) lower: f64,
    /// Some island used up its iterations or stalled above the floor.
    pub(crate) unfinished: bool,
}

/// Something that steps a scene and times itself. What it learns of pins and springs it may keep from step to step.
pub(crate) trait Step {
    fn step(&mut self, scene: &mut HostScene) -> Result<Stepped, StepError>;
}

/// One of Hooke's solvers.
pub(crate) struct Method<F> {
    pub(crate) name: &'static str,
    /// From the scene's integrator and a relative tolerance R.
    pub(crate) make: for<'e> fn(&'e Euler<F>, f64) -> Box<dyn Step + 'e>,
    /// Bytes of a scene with this solver: its state, islands, matrix and vectors.
    pub(crate) workspace: fn(&HostScene) -> usize,
}

/// All of them.
pub(crate) fn methods<F: Force<f64> + Clone>() -> Vec<Method<F>> {
    vec![
        Method {
            name: "hooke block-Jacobi PCG",
            make: |euler, r| Box::new(Timed(euler.clone().tolerance(r).max_iterations(MOST_ITERATIONS))),
            workspace: scene_bytes,
        },
        Method {
            name: "hooke wide PCG",
            make: |euler, r| {
                growing(move |numbers, words| {
                    let solver = WideJacobi::new(vec![0.0; numbers], vec![0; words], Host::new());
                    Box::new(Timed(euler.clone().tolerance(r).max_iterations(MOST_ITERATIONS).solver(solver)))
                })
            },
            workspace: scene_bytes,
        },
        Method {
            name: "hooke multigrid PCG",
            make: |euler, r| {
                growing(move |numbers, words| {
                    let solver = Multigrid::new(vec![0.0; numbers], vec![0; words], Host::new());
                    Box::new(Timed(euler.clone().tolerance(r).max_iterations(MOST_ITERATIONS).solver(solver)))
                })
            },
            workspace: multigrid_bytes,
        },
        Method {
            name: "hooke banded LDL",
            make: |euler, r| {
                growing(move |numbers, _| {
                    let solver = BandedLdl::new(vec![0.0; numbers]);
                    Box::new(Timed(euler.clone().tolerance(r).solver(solver)))
                })
            },
            workspace: scene_bytes,
        },
        Method {
            name: "hooke sparse LDL",
            make: |euler, r| Box::new(Ordered { euler, r, solver: None }),
            workspace: scene_bytes,
        },
    ]
}

/// So many that none of the scenes here is cut short by it.
const MOST_ITERATIONS: u32 = 100_000;

/// Bytes of a scene's own lists, which hold all that PCG needs.
fn scene_bytes(scene: &HostScene) -> usize {
    let (reals, words) = SceneIn::<f64>::needs(scene.positions().len(), scene.state().springs());
    reals * size_of::<f64>() + words * size_of::<u32>()
}

/// The same with multigrid's own.
fn multigrid_bytes(scene: &HostScene) -> usize {
    let (numbers, words) = Multigrid::needs(scene.positions().len(), scene.state().springs());
    scene_bytes(scene) + numbers * size_of::<f32>() + words * size_of::<u32>()
}

/// Any integrator of the kernel.
struct Timed<I>(I);

impl<I: Integrator<f64>> Step for Timed<I> {
    fn step(&mut self, scene: &mut HostScene) -> Result<Stepped, StepError> {
        let began = ThreadTime::now();
        let report = scene.step(&mut self.0)?;
        let time = began.elapsed();
        let unfinished = report.capped + report.stalled > 0;
        let (iterations, upper, lower) = (report.iterations, report.upper, report.lower);
        Ok(Stepped { time, iterations, upper, lower, unfinished })
    }
}

/// A solver with a workspace of so many numbers and words.
type Make<'e> = Box<dyn Fn(usize, usize) -> Box<dyn Step + 'e> + 'e>;

/// A direct solver that is made anew, untimed, whenever a step says how much workspace it lacks.
struct Growing<'e> {
    make: Make<'e>,
    solver: Box<dyn Step + 'e>,
}

fn growing<'e>(make: impl Fn(usize, usize) -> Box<dyn Step + 'e> + 'e) -> Box<dyn Step + 'e> {
    let solver = make(0, 0);
    Box::new(Growing { make: Box::new(make), solver })
}

impl Step for Growing<'_> {
    fn step(&mut self, scene: &mut HostScene) -> Result<Stepped, StepError> {
        loop {
            match self.solver.step(scene) {
                Err(StepError::Workspace { numbers, words }) => self.solver = (self.make)(numbers, words),
                other => return other,
            }
        }
    }
}

/// The sparse solver in an approximate minimum degree order, which it asks the first scene for, untimed.
struct Ordered<'e, F> {
    euler: &'e Euler<F>,
    r: f64,
    solver: Option<Box<dyn Step + 'e>>,
}

impl<F: Force<f64> + Clone> Step for Ordered<'_, F> {
    fn step(&mut self, scene: &mut HostScene) -> Result<Stepped, StepError> {
        let (euler, r) = (self.euler, self.r);
        let solver = self.solver.get_or_insert_with(|| {
            let state = scene.state();
            let pinned: Vec<bool> = (0..scene.positions().len()).map(|i| scene.is_pinned(i)).collect();
            let (order, _) = minimum_degree(
                &pinned,
                (0..state.springs()).filter_map(|j| state.ends(j).map(|(a, b)| [a, b])),
            );
            growing(move |numbers, words| {
                let solver = SparseLdl::new(order.clone(), vec![0.0; numbers], vec![0; words]);
                Box::new(Timed(euler.clone().tolerance(r).solver(solver)))
            })
        });
        solver.step(scene)
    }
}
