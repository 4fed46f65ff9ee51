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
use super::stepper::{Stepper, commit};
use crate::assembly::{Assembled, Same, assemble, prepare};
use crate::error::StepError;
use crate::force::Force;
use crate::hessian::Scaling;
use crate::law::Law;
use crate::memory::Memory;
use crate::parts::{IslandParts, Parts};
use crate::pins::Motion;
use crate::real::Real;
use crate::report::{IslandReport, Report};
use crate::sleeping::{Awake, Found, Sleep};
use crate::solver::{Answer, BlockJacobi, Island, Problem, Solver};
use crate::system::System;
use crate::vec3::{self, Vec3};

/// The rule of [`LinearlyImplicitEuler`].
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct LinearizedOnce;

/// (M + hD − h²K̃)q̇⁺ = Mq̇ + hf, q⁺ = q + hq̇⁺, with the forces `F` besides the springs'.
pub type LinearlyImplicitEuler<T, F = (), S = BlockJacobi, Z = Awake> = Stepper<LinearizedOnce, T, F, S, Z>;

impl<T: Real> Stepper<LinearizedOnce, T> {
    /// A step of `dt` seconds with the default stopping rule and no forces but the springs'. The values are checked at
    /// each step.
    pub const fn new(dt: T) -> Self {
        Self::of(LinearizedOnce, dt)
    }
}

impl<T: Real, F, S, Z> LinearlyImplicitEuler<T, F, S, Z> {
    /// Brings islands to rest, and with [`crate::Sleeping`] skips those that stay there; [`Awake`] unless said.
    pub fn sleeping<N: Sleep<T>>(self, sleep: N) -> LinearlyImplicitEuler<T, F, S, N> {
        let Self { rule, dt, stop, solver, forces, .. } = self;
        Stepper { rule, dt, stop, solver, sleep, forces }
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
        self.check(parts.network)?;
        self.pins(parts, motion, Self::over_the_step(h))?;
        let Parts { network, islands, work } = parts;
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
                assemble::<T, F, M::Law, _>(&mut island, &mut self.forces, self.dt, scaling, &Same)?;
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
                if !report.has_room_for(asleep.solve.upper) {
                    return Err(StepError::NotFinite(asleep.first_particle));
                }
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
            report.island(&island, clamped, certified, solve, watch)?;
        }
        let h = self.dt;
        commit(network, islands, &work.x, motion, |_, [q, v], change| {
            let v = vec3::add(v, change);
            [vec3::add_scaled(q, h, v), v]
        })?;
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
            assemble::<T, F, L, _>(island, &mut self.forces, self.dt, scaling, &Same)?;
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
