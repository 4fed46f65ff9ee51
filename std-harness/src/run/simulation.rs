//! A model given to the kernel: the scene, the integrator with its forces, and the pins' motion.

use std::borrow::Cow;
use std::fmt::Display;
use std::io;
use std::path::Path;

use hooke::force::Coefficients;
use hooke::{
    Drag, Force, Gravity, LinearlyImplicitEuler, MassSpring, Motion, Real, Report, SceneIn, Sleeping,
    SpringDamping, StepError,
};

use super::plan::Plan;
use super::solver::AnySolver;
use crate::error::InputError;
use crate::heap::Heap;
use crate::output::{Energy, table};
use crate::scene::Moving;
use crate::scene::renumber::Numbering;

/// One damping coefficient per spring.
#[derive(Debug, Clone)]
pub struct Dampings<T>(Vec<T>);

impl<T: Real> Coefficients<T> for Dampings<T> {
    fn coefficient(&self, spring: usize) -> T {
        self.0.as_slice().coefficient(spring)
    }
    fn invalid(&self, springs: usize) -> Option<usize> {
        self.0.as_slice().invalid(springs)
    }
}

type Forces<T> = ((((), Gravity<T>), Drag<T>), SpringDamping<Dampings<T>>);
type MaybeSleeping<T> = Option<Sleeping<T, Vec<T>, Vec<u32>>>;

/// A running simulation in precision `T`.
pub struct Simulation<T: Real> {
    /// The kernel's scene, in the kernel's numbering.
    pub scene: MassSpring<Heap<T>>,
    euler: LinearlyImplicitEuler<T, Forces<T>, AnySolver<T>, MaybeSleeping<T>>,
    /// Of the solver's own scratch and of what sleeping remembers
    scratch_bytes: usize,
    numbering: Option<Numbering>,
    moving: Vec<Moving>,
    /// Where the moving pins were at t = 0.
    origin: Vec<[f64; 3]>,
    motion: Vec<Motion<T>>,
    dt: f64,
}

/// What f64 can hold and `T` cannot, by the name of the option that says it.
fn in_range<T: Real>(plan: &Plan) -> Result<(), InputError> {
    let refuse = |name: &str, x: f64| {
        let bits = size_of::<T>() * 8;
        Err(InputError::new(format!("{name} {x:?}: outside the range of f{bits}")))
    };
    // A step multiplies with h², which must not vanish or overflow either.
    let h = T::from_f64(plan.dt);
    if !(h * h > T::ZERO && (h * h).is_finite()) {
        return refuse("--dt", plan.dt);
    }
    let [x, y, z] = plan.model.gravity;
    let tolerance = plan.tolerance.unwrap_or(0.0);
    for (name, value) in [
        ("--gravity", x),
        ("--gravity", y),
        ("--gravity", z),
        ("--tolerance", tolerance),
        ("--absolute", plan.absolute),
        ("--sleep", plan.sleep.unwrap_or(0.0)),
        ("drag", plan.model.drag),
    ] {
        if !T::from_f64(value).is_finite() {
            return refuse(name, value);
        }
    }
    for (j, spring) in plan.model.springs.iter().enumerate() {
        if !T::from_f64(spring.damping).is_finite() {
            return refuse(&format!("spring {j}: damping"), spring.damping);
        }
    }
    Ok(())
}

impl<T: Real + Display> Simulation<T> {
    /// Builds the scene and the integrator; what the kernel refuses is bad input.
    pub fn new(plan: &Plan) -> Result<Self, InputError> {
        let real = T::from_f64;
        in_range::<T>(plan)?;
        let model = &*plan.ordered();
        let dampings = Dampings(model.springs.iter().map(|spring| real(spring.damping)).collect());
        let mut euler = LinearlyImplicitEuler::new(real(plan.dt))
            .with(Gravity(model.gravity.map(real)))
            .with(Drag(real(model.drag)))
            .with(SpringDamping(dampings))
            .absolute(real(plan.absolute));
        if let Some(tolerance) = plan.tolerance {
            euler = euler.tolerance(real(tolerance));
        }
        if let Some(max_iterations) = plan.max_iterations {
            euler = euler.max_iterations(max_iterations);
        }
        // What the kernel refuses is named as the user names it.
        let mut scene = plan.model.build::<T>()?;
        if plan.numbering.is_some() {
            scene = model.build::<T>()?;
        }
        let solver = AnySolver::new(plan.method, &mut scene, model);
        let (numbers, words) = match plan.sleep {
            Some(_) => Sleeping::needs(model.mass.len(), model.springs.len()),
            None => (0, 0),
        };
        let scratch_bytes = solver.bytes() + numbers * size_of::<T>() + words * size_of::<u32>();
        let sleeping =
            plan.sleep.map(|joules| Sleeping::new(real(joules), vec![T::ZERO; numbers], vec![0; words]));
        let euler = euler.solver(solver).sleeping(sleeping);
        // What would fail at the first step fails now, before anything is written.
        euler
            .forces
            .check(model.mass.len(), model.springs.len())
            .map_err(|e| InputError::new(in_users_ids(e, plan.numbering.as_ref()).to_string()))?;
        let origin = model.position.clone();
        Ok(Self {
            scene,
            euler,
            scratch_bytes,
            numbering: plan.numbering.clone(),
            moving: model.moving.clone(),
            origin,
            motion: Vec::new(),
            dt: plan.dt,
        })
    }

    /// Step number `step`, counted from 1: from (step − 1)·dt to step·dt.
    pub fn step(&mut self, step: u64) -> Result<Report<T>, StepError> {
        let time = step as f64 * self.dt;
        self.motion.clear();
        for moving in &self.moving {
            let (displacement, rate) = moving.path.at(time);
            for &particle in &moving.particles {
                let from = self.origin[particle];
                let position = std::array::from_fn(|c| T::from_f64(from[c] + displacement[c]));
                self.motion.push(Motion { particle, position, velocity: rate.map(T::from_f64) });
            }
        }
        let stepped = self.scene.step_moving(&mut self.euler, &self.motion);
        stepped.map_err(|error| in_users_ids(error, self.numbering.as_ref()))
    }

    /// Energies at a time, J.
    pub fn energy(&self, time: f64) -> Energy {
        let springs = self.scene.springs();
        let (kinetic, potential) = (springs.kinetic_energy().to_f64(), springs.potential_energy().to_f64());
        let gravity = self.euler.forces.potential_energy(self.scene.state()).to_f64();
        Energy { time, kinetic, springs: potential, gravity, total: kinetic + potential + gravity }
    }

    /// Linear momentum, kg m/s.
    pub fn momentum(&self) -> [f64; 3] {
        self.scene.state().linear_momentum().map(T::to_f64)
    }

    /// The fastest particle and its speed, m/s.
    pub fn fastest(&self) -> (usize, f64) {
        let speed = |v: &[T; 3]| v.iter().map(|x| x.to_f64().powi(2)).sum::<f64>().sqrt();
        let speeds = self.scene.velocities().iter().map(speed).enumerate();
        speeds.fold((0, 0.0), |best, now| if now.1 > best.1 { now } else { best })
    }

    /// Bytes of the scene's lists (state, islands and the solver's vectors), of the solver's own scratch, and of what
    /// sleeping remembers.
    pub fn workspace_bytes(&self) -> usize {
        let (reals, words) = SceneIn::<T>::needs(self.scene.positions().len(), self.scene.state().springs());
        reals * size_of::<T>() + words * size_of::<u32>() + self.scratch_bytes
    }

    /// Positions in the order of the user's ids.
    pub fn positions(&self) -> Cow<'_, [[T; 3]]> {
        self.restored(self.scene.positions())
    }

    /// Velocities in the order of the user's ids.
    pub fn velocities(&self) -> Cow<'_, [[T; 3]]> {
        self.restored(self.scene.velocities())
    }

    fn restored<'a, X: Copy>(&self, list: &'a [X]) -> Cow<'a, [X]> {
        match &self.numbering {
            Some(numbering) => Cow::Owned(numbering.restored(list)),
            None => Cow::Borrowed(list),
        }
    }

    /// Where the user's spring `j` is in the kernel's order.
    pub fn place_of_spring(&self, j: usize) -> usize {
        self.numbering.as_ref().map_or(j, |numbering| numbering.place_of_spring(j))
    }

    /// What the user calls the kernel's particle `i`.
    pub fn users_particle(&self, i: usize) -> usize {
        self.numbering.as_ref().map_or(i, |numbering| numbering.users_particle(i))
    }

    /// Writes the final CSV in this precision's own shortest decimals.
    pub fn write_final(&self, file: &Path) -> io::Result<()> {
        table::write_final(file, &self.positions(), &self.velocities())
    }
}

/// The error with the particle or spring as the user numbers it. (No `_` arm: a new error must be looked at here.)
fn in_users_ids(error: StepError, numbering: Option<&Numbering>) -> StepError {
    use StepError::*;
    let Some(numbering) = numbering else { return error };
    let particle = |i| numbering.users_particle(i);
    match error {
        Force(i) => Force(particle(i)),
        NoParticle(i) => NoParticle(particle(i)),
        NotPinned(i) => NotPinned(particle(i)),
        Motion(i) => Motion(particle(i)),
        NotCertified(i) => NotCertified(particle(i)),
        NotFinite(i) => NotFinite(particle(i)),
        StepLimit(i) => StepLimit(particle(i)),
        NotConverged(i) => NotConverged(particle(i)),
        Damping(j) => Damping(numbering.users_spring(j)),
        TimeStep | Tolerance | Field | Accuracy | Workspace { .. } => error,
    }
}
