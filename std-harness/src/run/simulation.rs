//! A model given to the kernel: the scene, the integrator with its forces, and the pins' motion.

use std::borrow::Cow;
use std::fmt::Display;
use std::io;
use std::path::Path;

use hooke::force::Coefficients;
use hooke::{
    Drag, Force, Gravity, LinearlyImplicitEuler, Made, MassSpring, Motion, Real, Report, SceneIn, Sleeping,
    SpringDamping, StepError,
};

use super::choice::{Auto, COMPETITORS, Prices};
use super::counted::{Counted, Work};
use super::integrator::{AnyIntegrator, Integrator, Options};
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

/// The forces besides the springs'; those that a scene has not are zero.
pub type Forces<T> = ((((), Gravity<T>), Drag<T>), SpringDamping<Dampings<T>>);

/// A running simulation in precision `T`.
pub struct Simulation<T: Real> {
    /// The kernel's scene, in the kernel's numbering.
    pub scene: MassSpring<Heap<T>>,
    integrator: AnyIntegrator<T>,
    work: Work,
    /// Of the solver's and the integrator's own scratch and of what sleeping remembers
    scratch_bytes: usize,
    numbering: Option<Numbering>,
    moving: Vec<Moving>,
    /// Where the moving pins were at t = 0.
    origin: Vec<[f64; 3]>,
    motion: Vec<Motion<T>>,
    dt: f64,
    /// Where a run with chosen steps is, and where it ends
    chosen: Option<Chosen<T>>,
}

/// A run whose steps are chosen: the kernel is at `time`, perhaps beyond the moment that is shown.
struct Chosen<T> {
    time: f64,
    end: f64,
    /// The state at the beginning of the last step, and when
    before: (f64, Lists<T>),
    /// The state at its end, while the scene shows a moment within it
    after: Option<Lists<T>>,
    /// Pins are at a corner of their path, and told their new speed before the next step
    turns: bool,
    /// What became of the steps
    count: Steps,
}

/// Positions and velocities.
type Lists<T> = [Vec<[T; 3]>; 2];

/// What became of steps that were chosen.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Steps {
    /// How many were taken.
    pub taken: u64,
    /// How many were rejected.
    pub rejected: u64,
    /// Shortest and longest of those taken, s.
    pub shortest: f64,
    /// The longest, s.
    pub longest: f64,
    /// The largest estimate of an error, J.
    pub energy: f64,
    /// The sum of all estimates of position errors, m: where they all add up, the run is as far off.
    pub distance: f64,
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
    if let Some(joules) = plan.accuracy
        && !(T::from_f64(joules) > T::ZERO)
    {
        return refuse("--accuracy", joules);
    }
    let [x, y, z] = plan.model.gravity;
    let tolerance = plan.tolerance.unwrap_or(0.0);
    for (name, value) in [
        ("--gravity", x),
        ("--gravity", y),
        ("--gravity", z),
        ("--tolerance", tolerance),
        ("--absolute", plan.absolute),
        ("--accuracy", plan.accuracy.unwrap_or(1.0)),
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
        let gravity = ((), Gravity(model.gravity.map(real)));
        let forces = ((gravity, Drag(real(model.drag))), SpringDamping(dampings));
        // What the kernel refuses is named as the user names it.
        let mut scene = plan.model.build::<T>()?;
        if plan.numbering.is_some() {
            scene = model.build::<T>()?;
        }
        // What would fail at the first step fails now, before anything is written.
        forces
            .check(model.mass.len(), model.springs.len())
            .map_err(|e| InputError::new(in_users_ids(e, plan.numbering.as_ref()).to_string()))?;
        let solver = AnySolver::new(plan.method, &mut scene, model);
        let (numbers, words) = match plan.sleep {
            Some(_) => Sleeping::needs(model.mass.len(), model.springs.len()),
            None => (0, 0),
        };
        let vectors = AnyIntegrator::<T>::vectors(plan.integrator, model.mass.len());
        let solvers = if plan.integrator == Integrator::Auto { COMPETITORS.len() } else { 1 };
        let scratch_bytes =
            solvers * solver.bytes() + (numbers + 3 * vectors) * size_of::<T>() + words * size_of::<u32>();
        let sleeping =
            plan.sleep.map(|joules| Sleeping::new(real(joules), vec![T::ZERO; numbers], vec![0; words]));
        let work = Work::default();
        let solver = Counted::new(solver, work.clone());
        let options = Options {
            dt: real(plan.first),
            tolerance: plan.tolerance.map(real),
            absolute: real(plan.absolute),
            max_iterations: plan.max_iterations,
            accuracy: plan.accuracy.map(real),
            particles: model.mass.len(),
            substeps: plan.substeps,
        };
        let mut integrator = if plan.integrator == Integrator::Auto {
            let member = |name| {
                (name, AnyIntegrator::new(name, &options, forces.clone(), solver.clone(), sleeping.clone()))
            };
            let (tolerance, precision) = (plan.tolerance, plan.precision);
            let prices = Prices::new(model, plan.first, tolerance, precision, plan.method);
            AnyIntegrator::Auto(Box::new(Auto::new(
                COMPETITORS.map(member).into(),
                prices,
                plan.accuracy.unwrap_or(f64::INFINITY),
            )))
        } else {
            AnyIntegrator::new(plan.integrator, &options, forces, solver, sleeping)
        };
        beyond_the_limit(plan, &mut integrator, &mut scene)?;
        let origin = model.position.clone();
        let chosen = plan.accuracy.map(|_| Chosen {
            time: 0.0,
            end: plan.seconds,
            before: (0.0, lists(&scene)),
            after: None,
            turns: false,
            count: Steps::default(),
        });
        let mut simulation = Self {
            scene,
            integrator,
            work,
            scratch_bytes,
            numbering: plan.numbering.clone(),
            moving: model.moving.clone(),
            origin,
            motion: Vec::new(),
            dt: plan.dt,
            chosen,
        };
        if simulation.chosen.is_some() || simulation.integrator.interpolates() {
            // A speed beyond the numbers is refused with the first motion.
            let _ = simulation.depart(0.0);
        }
        Ok(simulation)
    }

    /// Step number `step`, counted from 1: from (step − 1)·dt to step·dt; where steps are chosen, as many as it takes. Answers
    /// their reports.
    pub fn step(&mut self, step: u64) -> Result<Vec<Report<T>>, StepError> {
        let made = match self.chosen {
            Some(_) => self.show(step as f64 * self.dt),
            None => self.fixed(step).map(|report| vec![report]),
        };
        made.map_err(|error| in_users_ids(error, self.numbering.as_ref()))
    }

    /// A step of dt.
    fn fixed(&mut self, step: u64) -> Result<Report<T>, StepError> {
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
        self.integrator.step(&mut self.scene, &self.motion)
    }

    /// One step of the method, of dt or as long as it chooses; answers its report, and how many longer ones it rejected.
    pub fn once(&mut self, step: u64) -> Result<(Report<T>, u32), StepError> {
        let report = match self.chosen {
            Some(_) => self.integrator.step(&mut self.scene, &[]),
            None => self.fixed(step),
        };
        let report = report.map_err(|error| in_users_ids(error, self.numbering.as_ref()))?;
        Ok((report, self.integrator.made().map_or(0, |(made, _)| made.rejections)))
    }

    /// How long the last step was, s.
    pub fn made(&self) -> f64 {
        self.integrator.made().map_or(self.dt, |(made, _)| made.dt.to_f64())
    }

    /// Another step for all that follow, s; not where steps are chosen.
    pub fn set_dt(&mut self, dt: f64) {
        self.dt = dt;
        self.integrator.set_dt(T::from_f64(dt));
    }

    /// What the solver was asked to do so far, also in steps that failed.
    pub fn work(&self) -> &Work {
        &self.work
    }

    /// Goes on until the moment is reached, and shows it: within a step by the cubic that has the positions and velocities of
    /// both its ends.
    fn show(&mut self, moment: f64) -> Result<Vec<Report<T>>, StepError> {
        let Some(mut chosen) = self.chosen.take() else { return Ok(Vec::new()) };
        let moment = if moment < chosen.end { moment } else { chosen.end };
        let made = self.go_on(&mut chosen, moment);
        if made.is_ok() && chosen.time > moment {
            let after = lists(&self.scene);
            let shown = within(&chosen.before, &(chosen.time, &after), moment);
            put(&mut self.scene, &shown);
            chosen.after = Some(after);
        }
        self.chosen = Some(chosen);
        made
    }

    fn go_on(&mut self, chosen: &mut Chosen<T>, moment: f64) -> Result<Vec<Report<T>>, StepError> {
        if let Some(after) = chosen.after.take() {
            put(&mut self.scene, &after);
        }
        let mut reports = Vec::new();
        while chosen.time < moment {
            if std::mem::take(&mut chosen.turns) {
                self.depart(chosen.time)?;
            }
            let (span, stop) = self.ahead(chosen.time, chosen.end);
            // At the end no moment lies within a step.
            if moment < chosen.end {
                chosen.before = (chosen.time, lists(&self.scene));
            }
            self.integrator.end_after(T::from_f64(span));
            reports.push(self.integrator.step(&mut self.scene, &self.motion)?);
            let Some((made, _)) = self.integrator.made() else { break };
            let dt = made.dt.to_f64();
            // A span need not be a number of f32.
            let whole = made.dt >= T::from_f64(span) || dt >= span * (1.0 - 1e-12);
            // The last step ends at the end, whatever its rounding.
            (chosen.time, chosen.turns) = match stop {
                Some(stop) if whole => (stop, true),
                _ => (chosen.time + dt, false),
            };
            chosen.count.add(dt, &made);
        }
        Ok(reports)
    }

    /// How far the next step may go, s, and when that is, if it is at the end or at a corner of a path; pins' motion is set to
    /// that time. Where they move a step goes no farther than it is to be long, for a motion is a cubic, and that is as close to
    /// a path as it is short.
    fn ahead(&mut self, time: f64, end: f64) -> (f64, Option<f64>) {
        self.motion.clear();
        let corners = self.moving.iter().map(|moving| moving.path.corner_after(time));
        let stop = corners.fold(end, |first, corner| if corner < first { corner } else { first });
        let left = stop - time;
        let wanted = self.integrator.next().map_or(left, T::to_f64);
        // Rather two halves than a long step and a short rest, whose rounding is an error of u|q|/h.
        let rests = self.moving.is_empty();
        let (span, reached) = match left {
            left if left <= wanted || (rests && T::UNIT_ROUNDOFF.to_f64() < 1e-10) => (left, Some(stop)),
            left if left < 2.0 * wanted => (0.5 * left, None),
            left if rests => (left, Some(stop)),
            _ => (wanted, None),
        };
        let then = reached.unwrap_or(time + span);
        for moving in &self.moving {
            let (displacement, rate) = (moving.path.at(then).0, moving.path.arrives(then));
            for &particle in &moving.particles {
                let from = self.origin[particle];
                let position = std::array::from_fn(|c| T::from_f64(from[c] + displacement[c]));
                self.motion.push(Motion { particle, position, velocity: rate.map(T::from_f64) });
            }
        }
        (span, reached)
    }

    /// Moving pins, where they are, become as fast as their path goes on.
    fn depart(&mut self, time: f64) -> Result<(), StepError> {
        for moving in &self.moving {
            let rate = moving.path.at(time).1.map(T::from_f64);
            for &particle in &moving.particles {
                let told = self.scene.set_pin_velocity(particle, rate);
                told.map_err(|_| StepError::Motion(particle))?;
            }
        }
        Ok(())
    }

    /// Every free particle stands still.
    pub fn stop(&mut self) {
        for i in 0..self.scene.positions().len() {
            if !self.scene.state().is_pinned(i) {
                self.scene.set_velocity(i, [T::ZERO; 3]).expect("a free particle of this scene");
            }
        }
    }

    /// A step of so many seconds.
    pub fn relax(&mut self, dt: f64) -> Result<Report<T>, StepError> {
        self.integrator.set_dt(T::from_f64(dt));
        let report = self.integrator.step(&mut self.scene, &[]);
        report.map_err(|error| in_users_ids(error, self.numbering.as_ref()))
    }

    /// The largest force on a free particle, N, and on which, if all stood still.
    pub fn left(&mut self) -> (usize, f64) {
        let ((((), gravity), drag), damping) = self.integrator.forces().clone();
        // With h = 1 and q̇ = 0 the right side of the lecture's step is f.
        let mut euler = LinearlyImplicitEuler::new(T::ONE).with(gravity).with(drag).with(damping);
        let mut most = (0, 0.0);
        let moving = lists(&self.scene);
        self.stop();
        let parts = self.scene.parts();
        let _ = euler.inspect(parts, &[], |system, f, _| {
            for (row, f) in f.iter().enumerate() {
                let size = f.iter().map(|x| x.to_f64().powi(2)).sum::<f64>().sqrt();
                if size > most.1 {
                    most = (system.particle(row).unwrap_or(0), size);
                }
            }
        });
        put(&mut self.scene, &moving);
        (self.users_particle(most.0), most.1)
    }

    /// What became of steps that were chosen, if they were.
    pub fn chosen(&self) -> Option<Steps> {
        self.chosen.as_ref().map(|chosen| chosen.count)
    }

    /// When the last step ended that was made, if steps are chosen.
    pub fn reached(&self) -> Option<f64> {
        self.chosen.as_ref().map(|chosen| chosen.time)
    }

    /// What was picked and why, if that was left to the program while it runs.
    pub fn told(&self) -> Option<String> {
        self.integrator.told()
    }

    /// After [`StepError::Accuracy`]: the least error of a step, J.
    pub fn attained(&self) -> Option<f64> {
        self.integrator.made().map(|(_, attained)| attained.to_f64())
    }

    /// The largest step that an explicit method is stable with, s; `None` for the others.
    pub fn limit(&mut self) -> Option<f64> {
        self.integrator.limit(&mut self.scene).map(T::to_f64)
    }

    /// Energies at a time, J.
    pub fn energy(&self, time: f64) -> Energy {
        let springs = self.scene.springs();
        let (kinetic, potential) = (springs.kinetic_energy().to_f64(), springs.potential_energy().to_f64());
        let gravity = self.integrator.forces().potential_energy(self.scene.state()).to_f64();
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

impl Steps {
    fn add<T: Real>(&mut self, dt: f64, made: &Made<T>) {
        self.shortest = if self.taken == 0 || dt < self.shortest { dt } else { self.shortest };
        self.longest = if dt > self.longest { dt } else { self.longest };
        self.taken += 1;
        self.rejected += u64::from(made.rejections);
        let (energy, distance) = (made.error.energy.to_f64(), made.error.distance.to_f64());
        self.energy = if energy > self.energy { energy } else { self.energy };
        self.distance += distance;
    }
}

/// A step beyond the limit of an explicit method is bad input: it is known before the first step.
fn beyond_the_limit<T: Real>(
    plan: &Plan,
    integrator: &mut AnyIntegrator<T>,
    scene: &mut MassSpring<Heap<T>>,
) -> Result<(), InputError> {
    let Some(limit) = integrator.limit(scene).map(T::to_f64) else { return Ok(()) };
    let most = limit * if plan.substeps > 1 { 0.9 * f64::from(plan.substeps) } else { 1.0 };
    if plan.accuracy.is_some() || plan.dt < most {
        return Ok(());
    }
    let allow = match plan.integrator {
        Integrator::Verlet => ", or allow --substeps",
        _ => "",
    };
    Err(InputError::new(format!(
        "--dt {:?}: beyond the limit of {}, which is {limit:.4e} s for this scene; take less{allow}",
        plan.dt,
        plan.integrator.name(),
    )))
}

fn lists<T: Real>(scene: &MassSpring<Heap<T>>) -> Lists<T> {
    [scene.positions().to_vec(), scene.velocities().to_vec()]
}

/// Puts particles where the lists say, as fast as they say.
fn put<T: Real>(scene: &mut MassSpring<Heap<T>>, lists: &Lists<T>) {
    let [positions, velocities] = lists;
    for (i, (q, v)) in positions.iter().zip(velocities).enumerate() {
        scene.set_position(i, *q).expect("a state of this scene");
        let pinned = scene.state().is_pinned(i);
        let set = if pinned { scene.set_pin_velocity(i, *v) } else { scene.set_velocity(i, *v) };
        set.expect("a state of this scene");
    }
}

/// Between two states by Hermite's cubic, whose error is of order 4.
fn within<T: Real>(before: &(f64, Lists<T>), after: &(f64, &Lists<T>), moment: f64) -> Lists<T> {
    let h = after.0 - before.0;
    let s = (moment - before.0) / h;
    let (left, [q0, v0], [q1, v1]) = (1.0 - s, &before.1, after.1);
    let at = |i: usize, c: usize| {
        let [q0, q1, v0, v1] = [q0, q1, v0, v1].map(|list| list[i][c].to_f64());
        let way = q1 - q0;
        let q = q0 + s * s * (3.0 - 2.0 * s) * way + h * s * left * (left * v0 - s * v1);
        let v = 6.0 * s * left * way / h + left * (left - 2.0 * s) * v0 + s * (3.0 * s - 2.0) * v1;
        [q, v].map(T::from_f64)
    };
    let list = |k: usize| (0..q0.len()).map(|i| std::array::from_fn(|c| at(i, c)[k])).collect();
    [list(0), list(1)]
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
