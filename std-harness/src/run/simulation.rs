//! A model given to the kernel: the scene, the integrator with its forces, and the pins' motion.

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
    /// The kernel's scene.
    pub scene: MassSpring<Heap<T>>,
    euler: LinearlyImplicitEuler<T, Forces<T>, AnySolver<T>, MaybeSleeping<T>>,
    /// Of the solver's own scratch and of what sleeping remembers
    scratch_bytes: usize,
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
        let model = &plan.model;
        let real = T::from_f64;
        in_range::<T>(plan)?;
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
        let mut scene = model.build::<T>()?;
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
            .map_err(|e| InputError::new(e.to_string()))?;
        let origin = model.position.clone();
        Ok(Self {
            scene,
            euler,
            scratch_bytes,
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
        self.scene.step_moving(&mut self.euler, &self.motion)
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

    /// Writes the final CSV in this precision's own shortest decimals.
    pub fn write_final(&self, file: &Path) -> io::Result<()> {
        table::write_final(file, self.scene.positions(), self.scene.velocities())
    }
}
