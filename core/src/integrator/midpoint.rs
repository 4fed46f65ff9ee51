//! The linearly-implicit midpoint rule: one Newton step of the implicit midpoint rule, one linear system per step.
//!
//! (M + θhD − θ²h²K̃)Δ = h(f − Dq̇) + θh²Kq̇,  q⁺ = q + h(q̇ + θΔ),  q̇⁺ = q̇ + Δ,  θ = ½.
//!
//! K̃ is clamped where the certificate fails, the K of the right side never: so the order is 2 whatever is clamped. D is the
//! drag and the springs' damping, f the rest; that a damped spring turns during the step is on the right side too, as the
//! unsymmetric (∂f_d/∂q)q̇. Pins: K_ff q̇ + K_fp p with p = (b⁺ − b)/h.
//!
//! Order 2. Neutral on linear problems: T + V of a spring with l₀ = 0 stays as it is. On others it gains energy at hω ≳ 0.3
//! and leaves the scene at hω ≳ 1, so it is no method to fall back on, and none for a stiff scene at a large step. Keeps
//! linear momentum to rounding on islands that nothing holds. Use it on smooth motion, well below the period of what
//! matters. Cost: one assembly and one solve, as [`crate::LinearlyImplicitEuler`]; no memory of its own.
//!
//! Source: Hairer, Lubich & Wanner, *Geometric Numerical Integration*, §VI.1 (the midpoint rule), of which this is one
//! Newton step.

use super::Integrator;
use super::stepper::{Stepper, commit};
use crate::assembly::{Assembled, Side, assemble, prepare};
use crate::error::StepError;
use crate::force::Force;
use crate::hessian::{Hessian, Scaling};
use crate::memory::Memory;
use crate::parts::{IslandParts, Parts};
use crate::pins::Motion;
use crate::real::Real;
use crate::report::{IslandReport, Report};
use crate::solver::{BlockJacobi, Problem, Solver};
use crate::spring::Stretched;
use crate::system::System;
use crate::vec3::{self, Vec3};

/// The rule of [`Midpoint`].
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct AtTheMiddle;

/// (M + ½hD − ¼h²K̃)Δ = h(f − Dq̇) + ½h²Kq̇, q⁺ = q + h(q̇ + ½Δ), with the forces `F` besides the springs'.
pub type Midpoint<T, F = (), S = BlockJacobi> = Stepper<AtTheMiddle, T, F, S>;

impl<T: Real> Stepper<AtTheMiddle, T> {
    /// A step of `dt` seconds with the default stopping rule and no forces but the springs'. The values are checked at
    /// each step.
    pub const fn new(dt: T) -> Self {
        Self::of(AtTheMiddle, dt)
    }
}

/// H/θ with the true H: θh²Kq̇ and hDq̇ in one.
struct True<T> {
    /// θh²
    turn: T,
}

impl<T: Real> Side<T> for True<T> {
    const CLAMPED: bool = false;
    const TURNS: bool = true;
    #[inline(always)]
    fn of(&self, hessian: &Hessian<T>, speed: Vec3<T>) -> Vec3<T> {
        vec3::scale(T::TWO, hessian.mul(speed))
    }
    /// u turns by du = τ/l, τ the part of Δq̇ across the spring: −θh²(c/l)(|τ|²u + (u·Δq̇)τ).
    #[inline(always)]
    fn turning(&self, damping: T, stretched: Stretched<T>, speed: Vec3<T>) -> Vec3<T> {
        let u = stretched.direction;
        let along = vec3::dot(u, speed);
        let across = vec3::add_scaled(speed, -along, u);
        let by = vec3::add(vec3::scale(vec3::dot(across, across), u), vec3::scale(along, across));
        vec3::scale(-(self.turn * damping * stretched.inverse), by)
    }
}

impl<T: Real, F: Force<T>, S: Solver<T>, Z> Integrator<T> for Stepper<AtTheMiddle, T, F, S, Z> {
    fn advance<M: Memory<Real = T>>(
        &mut self,
        mut parts: Parts<'_, M>,
        motion: &[Motion<T>],
        watch: &mut impl FnMut(&IslandReport<T>),
    ) -> Result<Report<T>, StepError> {
        let h = self.dt;
        self.check(parts.network)?;
        self.pins(&mut parts, motion, Self::over_the_step(h))?;
        let half = T::HALF * h;
        let scaling = Scaling { stiffness: half * half, damping: half };
        let Parts { network, islands, work } = parts;
        let state = network.state();
        prepare(&islands.all_rows(&state), work, &self.forces, h, scaling);
        self.solver.begin();
        let mut report = Report::new(state.springs() - islands.edges);
        let side = True { turn: half * h };
        for k in 0..islands.count {
            let mut island = islands.island(k, work, &state);
            let found = assemble::<T, F, M::Law, _>(&mut island, &mut self.forces, h, scaling, &side)?;
            let Assembled { clamped, certified, points, free } = found;
            let IslandParts { matrix, vectors, block, .. } = &mut island;
            let system = System { matrix, forces: &self.forces, points };
            let solve = self.solver.solve(Problem { system, vectors, block, free }, &self.stop)?;
            report.island(&island, clamped, certified, solve, watch)?;
        }
        commit(network, islands, &work.x, motion, |_, [q, v], change| {
            let middle = vec3::add_scaled(v, T::HALF, change);
            [vec3::add_scaled(q, h, middle), vec3::add(v, change)]
        })?;
        Ok(report)
    }
}
