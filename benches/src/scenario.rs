//! A scene with its forces, and the states it is timed at.
//!
//! States lie on the scene's own trajectory at t = 0.25–0.5 s, solved to R = 1e-10: at rest, and in the first steps,
//! every solver looks better than it is.

use hooke::{Force, LinearlyImplicitEuler, MassSpring, StepError, System, Vec3};
use hooke_harness::error::InputError;
use hooke_harness::heap::Heap;
use hooke_harness::run::solver::{AnySolver, Method};
use hooke_harness::scene::Model;

/// A scene on the heap.
pub(crate) type HostScene = MassSpring<Heap<f64>>;
/// The lecture's method with the forces `F`.
pub(crate) type Euler<F> = LinearlyImplicitEuler<f64, F>;

/// Where on the trajectory states are taken unless told otherwise, s.
pub(crate) const WINDOW: [f64; 2] = [0.25, 0.5];
/// So many that none of the scenes here is cut short by it.
pub(crate) const MOST_ITERATIONS: u32 = 100_000;
/// The relative tolerance of the trajectory.
const TIGHT: f64 = 1e-10;

/// Positions and velocities of all particles.
struct State {
    position: Vec<Vec3<f64>>,
    velocity: Vec<Vec3<f64>>,
}

/// A scene, its integrator and its states.
pub(crate) struct Scenario<F> {
    pub(crate) name: String,
    pub(crate) model: Model,
    pub(crate) scene: HostScene,
    pub(crate) euler: Euler<F>,
    /// The particle of each unknown block row; the islands' rows follow one another.
    pub(crate) particle: Vec<usize>,
    states: Vec<State>,
}

impl<F: Force<f64> + Clone> Scenario<F> {
    /// The scene at t = 0, without states.
    pub(crate) fn new(model: &Model, euler: Euler<F>) -> Result<Self, InputError> {
        let scene = model.build::<f64>()?;
        let (name, model) = (model.name.clone(), model.clone());
        let mut scenario = Self { name, model, scene, euler, particle: Vec::new(), states: Vec::new() };
        let mut particle = Vec::new();
        let visited = scenario.systems(|system, _, _, _| {
            particle.extend((0..system.particles()).filter_map(|row| system.particle(row)));
        });
        visited.map_err(|error| InputError::new(format!("{}: {error}", scenario.name)))?;
        scenario.particle = particle;
        Ok(scenario)
    }

    /// The steps at which states are taken: `count` of them, evenly between these times.
    pub(crate) fn steps(dt: f64, count: usize, [from, to]: [f64; 2]) -> Result<Vec<usize>, InputError> {
        let [first, last] = [(from / dt - 1e-9).ceil(), (to / dt + 1e-9).floor()];
        let there = (last - first + 1.0).max(0.0);
        if there < count as f64 || count == 0 {
            return Err(InputError::new(format!(
                "--states {count}: with dt {dt} s there are {there} steps at t = {from} to {to} s; ask for 1 to {there}"
            )));
        }
        let gap = if count > 1 { (last - first) / (count - 1) as f64 } else { 0.0 };
        Ok((0..count).map(|k| (first + k as f64 * gap).floor() as usize).collect())
    }

    /// Goes along the trajectory to the last of `steps` and keeps the states at them. (Multigrid is the method that no scene
    /// makes very slow; the tolerance is what the states depend on.)
    pub(crate) fn record(
        &mut self,
        steps: &[usize],
        tolerance: Option<f64>,
        mut progress: impl FnMut(usize),
    ) -> Result<(), StepError> {
        let solver = AnySolver::new(Method::Multigrid, &mut self.scene, &self.model);
        let euler = self.euler.clone().tolerance(tolerance.unwrap_or(TIGHT));
        let mut euler = euler.max_iterations(MOST_ITERATIONS).solver(solver);
        for step in 1..=steps.last().copied().unwrap_or(0) {
            self.scene.step(&mut euler)?;
            progress(step);
            if steps.contains(&step) {
                let (position, velocity) =
                    (self.scene.positions().to_vec(), self.scene.velocities().to_vec());
                self.states.push(State { position, velocity });
            }
        }
        Ok(())
    }

    /// How many states there are.
    pub(crate) fn states(&self) -> usize {
        self.states.len()
    }

    /// Number of scalar unknowns.
    pub(crate) fn unknowns(&self) -> usize {
        3 * self.particle.len()
    }

    /// Puts the scene into state k. Pins and springs stay as they are, so nothing that a solver knows of them is lost.
    pub(crate) fn put(&mut self, k: usize) {
        let Self { scene, states, .. } = self;
        for (i, (position, velocity)) in states[k].position.iter().zip(&states[k].velocity).enumerate() {
            scene.set_position(i, *position).expect("a state of this scene");
            if !scene.is_pinned(i) {
                scene.set_velocity(i, *velocity).expect("a state of this scene");
            }
        }
        scene.parts();
    }

    /// Δq̇ of the unknowns, row by row: how the present velocities differ from those of state k. (Rounded to u|q̇|, which
    /// is where the judged bound of a very fine solve ends.)
    pub(crate) fn change(&self, k: usize) -> Vec<f64> {
        let (after, before) = (self.scene.velocities(), &self.states[k].velocity);
        self.particle.iter().flat_map(|&i| [0, 1, 2].map(|c| after[i][c] - before[i][c])).collect()
    }

    /// Assembles a step at the present state and shows each island's A, b, μ and the number of its first row.
    pub(crate) fn systems(
        &mut self,
        mut visit: impl FnMut(&System<'_, f64, F>, &[Vec3<f64>], &[f64], usize),
    ) -> Result<(), StepError> {
        let mut first = 0;
        self.euler.inspect(self.scene.parts(), &[], |system, b, mu| {
            visit(system, b, mu, first);
            first += system.particles();
        })
    }
}
