//! `--integrator auto`: which method moves a scene on, and with what step, decided from counted work, never by a clock.
//!
//! With `--accuracy` the methods that know their error compete: where the scene is, each finds how long a step of the wanted
//! accuracy is, by attempts that are not taken, and what such a step costs; the one that costs least per simulated second
//! goes on. One whose steps are held by its limit is more exact than was asked for, at no price, so all are compared at what an
//! equal error would cost ([`FINER`]). Another must be a fifth cheaper to take over.
//!
//! They compete again after 2 steps, and after twice as many whenever nothing changed, up to 512 (after 8 when one has just taken
//! over): where a scene is let go from rest an estimate sees nothing of what is to come. One that is three times as dear sits out
//! the next comparison, then three, then seven. If the one that was chosen cannot make a step, the next cheapest tries. All of this
//! is a function of the scene and the options, bit for bit.
//!
//! With a fixed step there are two: [`Integrator::Verlet`] in as many substeps as its limit asks for, more exact, and
//! [`Integrator::Euler`], whose work [`super::auto`] foretells. The cheaper one is taken.
//!
//! Work is counted in passes over particles and springs, iterations, and factors, and weighed in nanoseconds of one machine:
//! [`super::auto::WEIGHTS`] for the solvers, and two numbers here. [`PASS`] is from runs of Verlet on
//! that machine, 15.5 µs a step for two forces and a limit on a cloth of 16×16, 65 on one of 32×32; [`STAGE`] is an estimate that
//! nobody has measured. Only ratios matter.

use hooke::{MassSpring, Motion, Probed, Real, Report, StepError, Verlet};

use super::auto::{self, Case};
use super::integrator::{AnyIntegrator, Integrator};
use super::solver::Method;
use crate::cli::Precision;
use crate::heap::Heap;
use crate::scene::Model;

/// ns per particle and spring: forces of all springs.
pub const PASS: f64 = 4.4;
/// The right side of a later stage.
pub const STAGE: f64 = 10.0;

/// What competes, in this order between equals.
pub const COMPETITORS: [Integrator; 3] = [Integrator::Verlet, Integrator::Ros2, Integrator::Ros3];

/// Attempts that find how long a step may be.
const ATTEMPTS: u32 = 4;
/// So many times dearer than the best is out of the question for now.
const FAR: f64 = 3.0;

/// An error below this part of the joules asked for is worth no more: that of steps half as long, 2⁻⁴ of the energy, at order 1 or 2.
/// So exactness that was not asked for makes a method count as up to twice as cheap. With a hundredth instead, `verlet` keeps nets
/// that `ros2` moves three times cheaper to the same error; with no such rule `ros2` takes over from rest, and what it has spoilt
/// by then stays (cloth:16 at 1e-4 J: 4e-3 m instead of 4e-5 in the same time).
pub const FINER: f64 = 1.0 / 16.0;

/// What the steps of a scene cost.
#[derive(Debug, Clone)]
pub struct Prices {
    /// Particles and springs.
    size: f64,
    /// Does anything damp? Then [`Verlet`] has two more passes a substep.
    damped: bool,
    method: Method,
    case: Case,
}

impl Prices {
    /// Those of a scene in the order that the kernel gets it.
    pub fn new(model: &Model, dt: f64, tolerance: Option<f64>, precision: Precision, method: Method) -> Self {
        let case = Case::new(model, dt, tolerance, precision);
        let size = case.islands.iter().map(Case::size).sum();
        let damped = model.drag > 0.0 || model.springs.iter().any(|spring| spring.damping > 0.0);
        Self { size, damped, method, case }
    }

    /// Of a step whose report is this, ns.
    pub fn of<T: Real>(&self, integrator: Integrator, report: &Report<T>) -> f64 {
        let stages = match integrator {
            Integrator::Ros2 => 2.0,
            Integrator::Ros3 => 4.0,
            // Eight substeps, and a pass for the limit.
            _ => return self.size * PASS * (10.0 + if self.damped { 16.0 } else { 0.0 }),
        };
        let w = &auto::WEIGHTS;
        let iterations = f64::from(report.iterations);
        let direct = |[size, block, product]: [f64; 3]| {
            let fill =
                self.case.fill.map_or((f64::INFINITY, f64::INFINITY), |fill| (fill.blocks, fill.products));
            // A solve reads the factor twice.
            size * self.size + block * fill.0 + product * fill.1 + 2.0 * iterations * fill.0
        };
        let rows: f64 = self.case.islands.iter().map(|island| island.rows as f64).sum();
        let solves = match self.method {
            Method::Banded => {
                let wide =
                    self.case.islands.iter().map(|island| island.half_bandwidth as f64).fold(1.0, f64::max);
                rows * if wide <= 1.0 {
                    4.0 * w.chain
                } else {
                    w.band[0] + w.band[1] * wide * wide + wide * iterations
                }
            }
            Method::Ldl => direct(w.ldl),
            Method::Ldl32 => direct(w.ldl32),
            Method::Multigrid => {
                let w = self.case.multigrid(w);
                self.size * (stages * w.setup + w.iteration * iterations)
            }
            // Later stages do not run in lanes.
            Method::Jacobi | Method::Wide | Method::Wide32 | Method::Ssor | Method::Ilu => {
                self.size * (w.jacobi.setup + w.jacobi.iteration * iterations)
            }
        };
        solves + self.size * STAGE * (stages - 1.0)
    }
}

/// The methods that compete for a run with chosen steps.
pub struct Auto<T: Real> {
    members: Vec<Member<T>>,
    prices: Prices,
    /// J a step
    accuracy: f64,
    /// Which one goes on
    chosen: usize,
    /// Steps until they compete again, and how many that were
    left: u32,
    every: u32,
}

struct Member<T: Real> {
    name: Integrator,
    method: AnyIntegrator<T>,
    /// ns per simulated second, where they last competed; infinite if it could not
    price: f64,
    /// The same, were its error what was asked for: what they are compared by
    even: f64,
    steps: u64,
    /// Comparisons that it still sits out, and how many it sat out last
    sits_out: u32,
    pause: u32,
}

impl<T: Real> Auto<T> {
    /// What competes, what it costs, and how exact a step is to be, J.
    pub fn new(members: Vec<(Integrator, AnyIntegrator<T>)>, prices: Prices, accuracy: f64) -> Self {
        let members = members
            .into_iter()
            .map(|(name, method)| Member {
                name,
                method,
                price: f64::INFINITY,
                even: f64::INFINITY,
                steps: 0,
                sits_out: 0,
                pause: 0,
            })
            .collect();
        Self { members, prices, accuracy, chosen: 0, left: 0, every: 1 }
    }

    fn member(&self) -> &Member<T> {
        &self.members[self.chosen]
    }

    /// The method that goes on.
    pub fn method(&self) -> &AnyIntegrator<T> {
        &self.member().method
    }

    /// What all of them end at.
    pub fn end_after(&mut self, seconds: T) {
        self.members.iter_mut().for_each(|member| member.method.end_after(seconds));
    }

    /// The longest step that one of them is to begin with, s.
    pub fn next(&self) -> Option<T> {
        let steps = self.members.iter().filter_map(|member| member.method.next());
        steps.reduce(|longest, dt| if dt > longest { dt } else { longest })
    }

    /// One step by the one that is chosen.
    pub fn step(
        &mut self,
        scene: &mut MassSpring<Heap<T>>,
        motion: &[Motion<T>],
    ) -> Result<Report<T>, StepError> {
        if self.left == 0 {
            let before = self.chosen;
            self.compete(scene, motion);
            self.every = if self.chosen == before { (2 * self.every).min(512) } else { 8 };
            self.left = self.every;
        }
        self.left -= 1;
        let mut tried = vec![self.chosen];
        loop {
            let member = &mut self.members[self.chosen];
            match member.method.step(scene, motion) {
                Ok(report) => {
                    member.steps += 1;
                    return Ok(report);
                }
                Err(error @ (StepError::Accuracy | StepError::NotFinite(_))) => {
                    let mut others: Vec<usize> =
                        (0..self.members.len()).filter(|k| !tried.contains(k)).collect();
                    others.sort_by(|a, b| self.members[*a].even.total_cmp(&self.members[*b].even));
                    let Some(next) = others.first() else { return Err(error) };
                    tried.push(*next);
                    (self.chosen, self.left) = (*next, 0);
                }
                Err(error) => return Err(error),
            }
        }
    }

    /// The cheapest so far goes first; who is seen to be far dearer is not looked at more closely, and sits out for a while.
    fn compete(&mut self, scene: &mut MassSpring<Heap<T>>, motion: &[Motion<T>]) {
        let mut order: Vec<usize> = (0..self.members.len()).collect();
        order.sort_by(|a, b| self.members[*a].even.total_cmp(&self.members[*b].even));
        let mut best = f64::INFINITY;
        for k in order {
            let member = &mut self.members[k];
            if member.sits_out > 0 {
                member.sits_out -= 1;
                continue;
            }
            (member.price, member.even) = (f64::INFINITY, f64::INFINITY);
            for _ in 0..ATTEMPTS {
                match member.method.probe(scene, motion) {
                    Some(Ok(Probed { dt, report, energy, settled })) => {
                        member.price = self.prices.of(member.name, &report) / dt.to_f64();
                        let part = (energy.to_f64() / self.accuracy).clamp(FINER, 1.0);
                        member.even = member.price * part.sqrt().sqrt();
                        if settled || member.even > FAR * best {
                            break;
                        }
                    }
                    Some(Err(StepError::NotFinite(_))) => {}
                    _ => break,
                }
            }
            best = if member.even < best { member.even } else { best };
            member.pause = if member.even > FAR * best { (2 * member.pause + 1).min(7) } else { 0 };
            member.sits_out = member.pause;
        }
        let prices = self.members.iter().map(|member| member.even).enumerate();
        let Some((best, price)) = prices.min_by(|a, b| a.1.total_cmp(&b.1)) else { return };
        if price < 0.8 * self.member().even {
            self.chosen = best;
        }
    }

    /// What was picked, and why: steps by method, and the prices when they last competed.
    pub fn told(&self) -> String {
        let steps: Vec<String> = self
            .members
            .iter()
            .filter(|member| member.steps > 0)
            .map(|member| format!("{} {} steps", member.name.name(), member.steps))
            .collect();
        let prices: Vec<String> = self
            .members
            .iter()
            .map(|member| format!("{} {:.3}", member.name.name(), 1e-9 * member.price))
            .collect();
        format!(
            "{}; least work foretold (s per simulated second, on the machine it was weighed on), at the last \
             comparison: {}",
            steps.join(", "),
            prices.join(", ")
        )
    }
}

/// For a fixed step: the method, its substeps, and why.
pub fn fixed(
    model: &Model,
    dt: f64,
    tolerance: Option<f64>,
    precision: Precision,
) -> (Integrator, u32, String) {
    let choice = auto::choose(model, dt, tolerance, precision);
    let case = Case::new(model, dt, tolerance, precision);
    let size: f64 = case.islands.iter().map(Case::size).sum();
    let euler = case.work(choice.method).unwrap_or(f64::INFINITY);
    let damped = model.drag > 0.0 || model.springs.iter().any(|spring| spring.damping > 0.0);
    let Some(limit) = limit(model) else {
        return (Integrator::Euler, 1, "the scene has no limit for an explicit method".into());
    };
    let substeps = if dt < limit { 1.0 } else { (dt / (0.9 * limit)).floor() + 1.0 };
    let passes = substeps * if damped { 3.0 } else { 1.0 } + 2.0;
    let verlet = 1e-6 * size * PASS * passes;
    let reason = format!(
        "foretold work a step, µs on the machine it was weighed on: verlet {:.0} in {substeps} substeps below its limit of \
         {limit:.2e} s, euler {:.0}",
        1e3 * verlet,
        1e3 * euler
    );
    if verlet <= euler && substeps < 1e6 {
        (Integrator::Verlet, substeps as u32, reason)
    } else {
        (Integrator::Euler, 1, reason)
    }
}

/// The largest stable step of [`Verlet`], s.
fn limit(model: &Model) -> Option<f64> {
    let mut scene = model.build::<f64>().ok()?;
    let damping = model.springs.iter().map(|spring| spring.damping).fold(0.0, f64::max);
    let verlet = Verlet::new(1.0).with(hooke::Drag(model.drag)).with(hooke::SpringDamping(damping));
    Some({ verlet }.limit(&mut scene))
}
