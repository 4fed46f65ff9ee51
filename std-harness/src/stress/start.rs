//! How a trial begins: the plan that `hooke run` would make of the scene, with a step that the method can take.

use std::fmt::Display;

use hooke::{Real, StepError};

use super::judge::Judge;
use super::method::Method;
use super::mirror::{Mirror, Snapshot};
use crate::cli::{Precision, RunArgs};
use crate::error::InputError;
use crate::run::plan::Plan;
use crate::run::simulation::Simulation;
use crate::scene::Model;

/// How a trial begins.
pub(super) enum Start<T: Real> {
    /// With this, and the limit of an explicit method if it is below the case's step, s.
    Ready(Box<Simulation<T>>, Option<f64>),
    /// There is no step that the method could take.
    Never(&'static str),
}

/// How a scene is tried.
pub(super) struct Options<'a> {
    pub(super) method: Method,
    pub(super) precision: Precision,
    pub(super) solver: &'a str,
    pub(super) most: u32,
}

impl Options<'_> {
    fn plan(&self, model: &Model, dt: f64) -> Result<Plan, InputError> {
        let args = RunArgs {
            dt: Some(dt),
            steps: (!self.method.chosen).then_some(u64::from(u16::MAX)),
            seconds: self.method.chosen.then_some(1.0),
            accuracy: self.method.chosen.then_some(self.accuracy(model)),
            integrator: self.method.integrator.name().into(),
            solver: self.solver.into(),
            max_iterations: Some(self.most),
            precision: self.precision,
            quiet: true,
            ..RunArgs::default()
        };
        Plan::of(&args, || Ok(model.clone().into()))
    }

    /// A millionth of the energy that the scene plays with: T + V and what a particle's fall over the longest spring gives. Of a
    /// joule where that is rounding, or beyond the precision.
    fn accuracy(&self, model: &Model) -> f64 {
        let energy = Mirror::new(model).map_or(0.0, |mut mirror| {
            let state = Snapshot { position: model.position.clone(), velocity: model.velocity.clone() };
            let (springs, kinetic) = mirror.energies(&state, |i| state.velocity[i]);
            let longest = model.springs.iter().map(|spring| spring.rest_length).fold(0.0, f64::max);
            let gravity = model.gravity.iter().map(|g| g * g).sum::<f64>().sqrt();
            springs + kinetic + model.mass.iter().sum::<f64>() * gravity * longest
        });
        let full: f64 =
            model.springs.iter().map(|spring| spring.stiffness * spring.rest_length.powi(2)).sum();
        // What a millionth is a number of in this precision.
        let (least, most) = match self.precision {
            Precision::F64 => (1e-280, 1e300),
            Precision::F32 => (1e-28, 1e30),
        };
        1e-6 * if energy > least && energy > 1e-12 * full && energy < most { energy } else { 1.0 }
    }

    /// With the case's step, or an explicit method's with 0.9 of its limit, if that is less; and the limit then.
    pub(super) fn start<T: Real + Display>(&self, model: &Model) -> Result<Start<T>, InputError> {
        let simulation = |dt| Simulation::<T>::new(&self.plan(model, dt)?).map(Box::new);
        if !self.method.integrator.is_explicit() || self.method.chosen {
            return simulation(model.dt).map(|simulation| Start::Ready(simulation, None));
        }
        // The least step whose square is a number.
        let mut least = match simulation(if self.precision == Precision::F64 { 1e-150 } else { 1e-18 }) {
            Err(error) if error.message.contains("beyond the limit") => {
                return Ok(Start::Never("no step is below its limit"));
            }
            other => other?,
        };
        let limit = least.limit().unwrap_or(f64::INFINITY);
        if model.dt < limit {
            return simulation(model.dt).map(|simulation| Start::Ready(simulation, None));
        }
        simulation(0.9 * limit).map(|simulation| Start::Ready(simulation, Some(limit)))
    }

    /// The case's own step is refused by the command before the run, and by the kernel at the step, without a trace.
    pub(super) fn is_refused_beyond_the_limit<T: Real + Display>(
        &self,
        model: &Model,
        simulation: &mut Simulation<T>,
        judge: &mut Judge<'_>,
    ) {
        let refused = self.plan(model, model.dt).and_then(|plan| Simulation::<T>::new(&plan).map(|_| ()));
        if !refused.is_err_and(|error| error.message.contains("beyond the limit")) {
            judge.broken.push(format!("dt {:e} is beyond the limit, but not refused", model.dt));
        }
        let before = Snapshot::of(&simulation.scene);
        let dt = simulation.made();
        let result = simulation.relax(model.dt);
        if !matches!(result, Err(StepError::StepLimit(_))) {
            judge.broken.push(format!("a step beyond the limit ends with {result:?}"));
        }
        if let Some(i) = before.differs(&Snapshot::of(&simulation.scene)) {
            judge.broken.push(format!("a step beyond the limit was refused, but particle {i} has changed"));
        }
        simulation.set_dt(dt);
    }
}
