//! Linearly-implicit Euler, the lecture's method: one Newton step of backward Euler, one linear system per step.
//!
//! P(M + hD − h²K̃)Pᵀ q̇̂⁺ = P(Mq̇ + h f),  q⁺ = q + h q̇⁺,
//!
//! f at q, K̃ the stiffness matrix clamped only where the certificate fails. Moving pins: A_ff v⁺ = (Mq̇ + hf)_f − A_fp p
//! with p = (b⁺ − b)/h, and q⁺_p = b⁺. Springs' damping and drag are implicit.
//!
//! Order 1. Stable at any h on what is convex; damps heavily: T + V of one spring with l₀ = 0 falls by exactly
//! 1/(1 + h²ω²) per step, and a cloth of 32×32 at dt 1/60 is 6 % of its size off after a quarter of a second. Keeps
//! linear momentum to rounding on islands that nothing holds. Use it where robustness and a known cost matter more than
//! accuracy. Cost: one assembly (two roots per spring) and one PCG solve.
//!
//! Source: the mass-spring lecture (linearly-implicit time integration); Baraff & Witkin 1998, §3.

use super::Integrator;
use crate::assembly::{Assembled, assemble, prepare};
use crate::error::StepError;
use crate::force::{Force, Gravity};
use crate::hessian::Scaling;
use crate::islands::Islands;
use crate::law::Law;
use crate::memory::Memory;
use crate::network::Network;
use crate::parts::{IslandParts, Parts};
use crate::pins::Motion;
use crate::real::Real;
use crate::report::{IslandReport, Report};
use crate::sleeping::{Awake, Found, Sleep};
use crate::solver::{Answer, BlockJacobi, Island, Problem, Solver, Stop};
use crate::system::System;
use crate::vec3::{self, Vec3};

/// (M + hD − h²K̃)q̇⁺ = Mq̇ + hf, q⁺ = q + hq̇⁺, with the forces `F` besides the springs'.
#[derive(Debug, Clone, Copy)]
pub struct LinearlyImplicitEuler<T, F = (), S = BlockJacobi, Z = Awake> {
    dt: T,
    stop: Stop<T>,
    solver: S,
    sleep: Z,
    /// The forces besides the springs' own; change their values between steps here. The last one added is `.1`, the
    /// one before it `.0.1`, and so on.
    pub forces: F,
}

impl<T: Real> LinearlyImplicitEuler<T> {
    /// A step of `dt` seconds with the default stopping rule and no forces but the springs'. The values are checked at
    /// each step.
    pub const fn new(dt: T) -> Self {
        Self { dt, stop: Stop::new(), solver: BlockJacobi, sleep: Awake, forces: () }
    }
}

impl<T: Real, F, S, Z> LinearlyImplicitEuler<T, F, S, Z> {
    /// Adds a force.
    pub fn with<G>(self, force: G) -> LinearlyImplicitEuler<T, (F, G), S, Z> {
        let Self { dt, stop, solver, sleep, forces } = self;
        LinearlyImplicitEuler { dt, stop, solver, sleep, forces: (forces, force) }
    }

    /// Solves by another method; [`BlockJacobi`] unless said.
    pub fn solver<R: Solver<T>>(self, solver: R) -> LinearlyImplicitEuler<T, F, R, Z> {
        let Self { dt, stop, sleep, forces, .. } = self;
        LinearlyImplicitEuler { dt, stop, solver, sleep, forces }
    }

    /// Brings islands to rest, and with [`crate::Sleeping`] skips those that stay there; [`Awake`] unless said.
    pub fn sleeping<R: Sleep<T>>(self, sleep: R) -> LinearlyImplicitEuler<T, F, S, R> {
        let Self { dt, stop, solver, forces, .. } = self;
        LinearlyImplicitEuler { dt, stop, solver, sleep, forces }
    }

    /// Adds gravity, m/s².
    pub fn gravity(self, g: Vec3<T>) -> LinearlyImplicitEuler<T, (F, Gravity<T>), S, Z> {
        self.with(Gravity(g))
    }

    /// Stops at β ≤ R²β₀; R = 1e-6 (f64) or 1e-4 (f32) unless said.
    pub fn tolerance(mut self, relative: T) -> Self {
        self.stop.relative = relative;
        self
    }

    /// Stops at β ≤ J joules; 0 unless said.
    pub fn absolute(mut self, joules: T) -> Self {
        self.stop.absolute = joules;
        self
    }

    /// At most so many iterations per island and step; 10,000 unless said.
    pub fn max_iterations(mut self, n: u32) -> Self {
        self.stop.max_iterations = n;
        self
    }

    /// The time step, s.
    pub fn dt(&self) -> T {
        self.dt
    }
}

impl<T: Real, F: Force<T>, S, Z> LinearlyImplicitEuler<T, F, S, Z> {
    /// Refuses what no step can be made with, writes the pins' velocities over this step behind the unknowns, and asks
    /// the forces.
    fn begin<M: Memory<Real = T>>(
        &self,
        parts: &mut Parts<'_, M>,
        motion: &[Motion<T>],
    ) -> Result<Scaling<T>, StepError> {
        let h = self.dt;
        if !(h > T::ZERO && (h * h).is_finite() && h * h > T::ZERO) {
            return Err(StepError::TimeStep);
        }
        let valid = |x: T| x.is_finite() && x >= T::ZERO;
        if !valid(self.stop.relative) || !valid(self.stop.absolute) {
            return Err(StepError::Tolerance);
        }
        let Parts { network, islands, work } = parts;
        self.forces.check(network.mass.len(), network.ends.len())?;
        for v in work.x.iter_mut().skip(islands.free) {
            *v = [T::ZERO; 3];
        }
        for m in motion {
            let slot = network.slot.get(m.particle).filter(|slot| **slot & crate::selection::MARK != 0);
            let slot = slot.ok_or(StepError::NotPinned(m.particle))? & !crate::selection::MARK;
            let (Some(v), Some(b)) = (work.x.get_mut(slot as usize), network.position.get(m.particle)) else {
                return Err(StepError::NotPinned(m.particle));
            };
            *v = vec3::map(vec3::sub(m.position, *b), |d| d / h);
            if !vec3::is_finite(m.position) || !vec3::is_finite(m.velocity) || !vec3::is_finite(*v) {
                return Err(StepError::Motion(m.particle));
            }
        }
        let scaling = Scaling { stiffness: h * h, damping: h };
        prepare(&islands.all_rows(&network.state()), *work, &self.forces, h, scaling);
        Ok(scaling)
    }

    /// Assembles each island's system at the present state and shows it with its right side b and its μ, without
    /// solving or moving anything: A Δq̇ = b. For export, tests and comparison with other solvers.
    ///
    /// # Errors
    /// As for a step: dt, a tolerance, a force or a motion is not valid.
    pub fn inspect<M: Memory<Real = T>>(
        &mut self,
        mut parts: Parts<'_, M>,
        motion: &[Motion<T>],
        mut visit: impl FnMut(&System<'_, T, F>, &[Vec3<T>], &[T]),
    ) -> Result<(), StepError> {
        let scaling = self.begin(&mut parts, motion)?;
        let Parts { network, islands, work } = parts;
        let state = network.state();
        for k in 0..islands.count {
            let mut island = islands.island(k, work, &state);
            let Assembled { points, .. } =
                assemble::<T, F, M::Law>(&mut island, &mut self.forces, self.dt, scaling)?;
            let IslandParts { matrix, vectors, .. } = &island;
            let system = System { matrix, forces: &self.forces, points };
            visit(&system, vectors.b, vectors.mu);
        }
        Ok(())
    }
}

impl<T: Real, F: Force<T>, S: Solver<T>, Z: Sleep<T>> Integrator<T> for LinearlyImplicitEuler<T, F, S, Z> {
    fn advance<M: Memory<Real = T>>(
        &mut self,
        mut parts: Parts<'_, M>,
        motion: &[Motion<T>],
        watch: &mut impl FnMut(&IslandReport<T>),
    ) -> Result<Report<T>, StepError> {
        let scaling = self.begin(&mut parts, motion)?;
        self.sleep.begin(&parts, self.dt, self.stop.absolute)?;
        self.solver.begin();
        let Parts { network, islands, work } = parts;
        let state = network.state();
        let mut report = Report::new(state.springs() - islands.edges);
        for k in 0..islands.count {
            let mut island = islands.island(k, work, &state);
            if let Some(asleep) = self.sleep.asleep(&mut island, &self.forces) {
                report.add(&asleep);
                watch(&asleep);
                continue;
            }
            let Answer { clamped, certified, solve } = if self.sleep.is_slow(&island) {
                self.slow_step::<M::Law>(&mut island, scaling)?
            } else {
                let to = Island { island: &mut island, forces: &mut self.forces, h: self.dt, scaling };
                self.solver.answer::<F, M::Law>(to, &self.stop)?
            };
            let rows = island.matrix.rows.particle;
            let first_particle = rows.first().map_or(0, |i| *i as usize);
            if !solve.upper.is_finite() {
                return Err(StepError::NotFinite(first_particle));
            }
            let particles = rows.len();
            let island = IslandReport { first_particle, particles, clamped, certified, asleep: false, solve };
            report.add(&island);
            watch(&island);
        }
        commit(network, islands, &work.x, self.dt, motion)?;
        Ok(report)
    }
}

impl<T: Real, F: Force<T>, S: Solver<T>, Z: Sleep<T>> LinearlyImplicitEuler<T, F, S, Z> {
    /// The step of an island that may come to rest: what it is decided by is the scene's own assembly.
    #[inline(never)]
    fn slow_step<L: Law>(
        &mut self,
        island: &mut IslandParts<'_, T>,
        scaling: Scaling<T>,
    ) -> Result<Answer<T>, StepError> {
        let Assembled { clamped, certified, points, free } =
            assemble::<T, F, L>(island, &mut self.forces, self.dt, scaling)?;
        let IslandParts { matrix, vectors, block, .. } = island;
        let system = System { matrix, forces: &self.forces, points };
        let found = Found { clamped, certified };
        let solve = match self.sleep.rest(&system, vectors, self.stop.absolute, found) {
            Some(solve) => solve,
            None => self.solver.solve(Problem { system, vectors, block, free }, &self.stop)?,
        };
        Ok(Answer { clamped, certified, solve })
    }
}

/// q̇⁺ = q̇ + Δ, q⁺ = q + h q̇⁺ on free particles; b⁺, ḃ⁺ on pins. Nothing is written unless all of it is finite.
#[inline(never)]
fn commit<M: Memory<Real = T>, T: Real>(
    network: &mut Network<M>,
    islands: &Islands<M>,
    x: &[Vec3<T>],
    h: T,
    motion: &[Motion<T>],
) -> Result<(), StepError> {
    let Network { position, velocity, .. } = network;
    let (particle, free) = (&islands.particle, islands.free);
    for (i, change) in particle.iter().zip(x.iter()).take(free) {
        let i = *i as usize;
        let (Some(q), Some(v)) = (position.get(i), velocity.get(i)) else { continue };
        let v = vec3::add(*v, *change);
        if !vec3::is_finite(v) || !vec3::is_finite(vec3::add_scaled(*q, h, v)) {
            return Err(StepError::NotFinite(i));
        }
    }
    for (slot, (i, change)) in particle.iter().zip(x.iter()).enumerate() {
        let (Some(q), Some(v)) = (position.get_mut(*i as usize), velocity.get_mut(*i as usize)) else {
            continue;
        };
        if slot < free {
            *v = vec3::add(*v, *change);
            *q = vec3::add_scaled(*q, h, *v);
        } else {
            *v = [T::ZERO; 3];
        }
    }
    for m in motion {
        if let (Some(q), Some(v)) = (position.get_mut(m.particle), velocity.get_mut(m.particle)) {
            *q = m.position;
            *v = m.velocity;
        }
    }
    Ok(())
}
