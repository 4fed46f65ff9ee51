//! Rosenbrock methods: implicit methods of several stages with one matrix, one linear system a stage, and no iteration.
//!
//! With h′ = γh, y = (q, q̇), F = (q̇, M⁻¹f) and J = (0 I; M⁻¹K̃ −M⁻¹D), stage i finds its increment u from
//!
//! (I − h′J)uᵢ = h′F(tᵢ, y + Σ aᵢⱼuⱼ) + Σ γcᵢⱼuⱼ + (γᵢ/γ) h′² ∂F/∂t,  y⁺ = y + Σ mᵢuᵢ,
//!
//! which in the velocities' part u̇ of u is a system with the matrix that every method here has:
//!
//! (M + h′D − h′²K̃)u̇ᵢ = h′f(Yᵢ) + MΣ γcᵢⱼu̇ⱼ + h′²K̃wᵢ,  uᵢ = (h′(wᵢ + u̇ᵢ), u̇ᵢ),  w = ∑ (of q̇ and the u̇ⱼ before).
//!
//! So only u̇ is stored, and the first stage is the lecture's step of h′. All methods here are W-methods: they keep their
//! order with any symmetric K̃, so also where springs are clamped, and with the springs' damping in D alone. Pins: b and ḃ
//! at the stage's own time, by the cubic that has the motion's b and ḃ at both ends of its time; ∂f/∂t = K_fp ḃ.
//!
//! The difference to a second answer of lower order, δ = Σ eᵢuᵢ, costs no solve: the estimate of the local error.
//!
//! Source: Hairer & Wanner, *Solving Ordinary Differential Equations II*, §IV.7 (W-methods, the form without products by J).

use core::marker::PhantomData;

use super::embedded::{Embedded, LocalError, energy};
use super::stage::{self, Stages};
use super::stepper::{Stepper, commit_at};
use super::{Integrator, merge};
use crate::assembly::{Assembled, Same, assemble, prepare};
use crate::error::StepError;
use crate::force::Force;
use crate::hessian::Scaling;
use crate::memory::Memory;
use crate::parts::{IslandParts, Parts};
use crate::pins::{Course, Motion};
use crate::real::{Real, larger};
use crate::report::{IslandReport, Report};
use crate::solver::{Problem, Solver};
use crate::system::System;
use crate::vec3::{self, Vec3};

/// own·q̇ + Σ stagesⱼ·u̇ⱼ
#[derive(Debug)]
pub struct Combination {
    /// What q̇ is multiplied by.
    pub own: f64,
    /// What the u̇ of each stage is multiplied by.
    pub stages: &'static [f64],
}

/// One stage.
#[derive(Debug)]
pub struct Stage {
    /// Where in the step it stands, from 0 to 1.
    pub time: f64,
    /// γᵢ/γ: its share of ∂F/∂t.
    pub turn: f64,
    /// Yᵢ = (q + h′·this, …
    pub position: Combination,
    /// … q̇ + Σ of this).
    pub velocity: &'static [f64],
    /// γcᵢⱼ
    pub mass: &'static [f64],
    /// w
    pub rate: Combination,
}

/// A Rosenbrock method.
pub trait Tableau {
    /// γ
    const GAMMA: f64;
    /// Its stages, the first at y itself.
    const STAGES: &'static [Stage];
    /// q⁺ = q + h′·this
    const POSITION: Combination;
    /// q̇⁺ = q̇ + Σ of this
    const VELOCITY: &'static [f64];
    /// δ: the same two of the error.
    const ERROR: (Combination, &'static [f64]);
    /// The order of the answer that δ is the difference to.
    const LOWER_ORDER: u32;
}

/// The rule of a Rosenbrock method with its memory: see [`crate::Rosenbrock2`], [`crate::Rosenbrock3`].
#[derive(Debug, Clone, Copy)]
pub struct Staged<K, W> {
    tableau: PhantomData<K>,
    memory: W,
}

impl<K: Tableau, W> Staged<K, W> {
    /// How many vectors a scene of so many particles needs.
    pub(crate) const fn needs(particles: usize) -> usize {
        // Positions, velocities, and u̇ of all stages but the last, which the scene has room for.
        particles.saturating_mul(K::STAGES.len() + 1)
    }

    pub(crate) const fn new(memory: W) -> Self {
        Self { tableau: PhantomData, memory }
    }
}

/// A combination's value at a slot; the last stage's u̇ is `last`.
#[inline]
fn combined<T: Real>(of: &Combination, v: Vec3<T>, before: &Stages<'_, T>, slot: usize) -> Vec3<T> {
    before.sum(of.stages, vec3::scale(T::from_f64(of.own), v), slot)
}

impl<K: Tableau, W: AsMut<[Vec3<T>]>, T: Real, F: Force<T>, S: Solver<T>, Z>
    Stepper<Staged<K, W>, T, F, S, Z>
{
    /// h′
    fn inner(&self) -> T {
        T::from_f64(K::GAMMA) * self.dt
    }

    /// All stages; the scene stays as it is. With `judge` also what their error is.
    fn stages<M: Memory<Real = T>>(
        &mut self,
        parts: &mut Parts<'_, M>,
        course: Course<'_, T>,
        watch: &mut impl FnMut(&IslandReport<T>),
        judge: bool,
    ) -> Result<(Report<T>, LocalError<T>), StepError> {
        let h = self.inner();
        self.check(parts.network)?;
        self.pins(parts, course.motion, |_, rate, _| rate)?;
        let scaling = Scaling { stiffness: h * h, damping: h };
        let Parts { network, islands, work } = parts;
        let state = network.state();
        let numbers = Staged::<K, W>::needs(state.mass.len());
        let short = StepError::Workspace { numbers, words: 0 };
        let mut stages =
            Stages::cut(self.rule.memory.as_mut(), state.mass.len(), K::STAGES.len()).ok_or(short)?;
        stages.begin(&state);
        prepare(&islands.all_rows(&state), *work, &self.forces, h, scaling);
        self.solver.begin();
        let mut report = Report::new(state.springs() - islands.edges);
        let mut error = LocalError { energy: T::ZERO, distance: T::ZERO };
        for k in 0..islands.count {
            let mut island = islands.island(k, work, &state);
            let Assembled { clamped, certified, points, free } =
                assemble::<T, F, M::Law, _>(&mut island, &mut self.forces, h, scaling, &Same)?;
            let mut solve = None;
            for (i, stage) in K::STAGES.iter().enumerate() {
                if i > 0 {
                    stages.keep(i - 1, &island);
                    stages.place(stage, &island, h);
                    stages.place_pins(Some(stage), course, &state, self.dt);
                    stage::right_side::<T, F, M::Law>(&mut island, &stages, stage, &self.forces, h, points);
                }
                let IslandParts { matrix, vectors, block, .. } = &mut island;
                let system = System { matrix, forces: &self.forces, points };
                let problem = Problem { system, vectors, block, free };
                let next = if i == 0 {
                    self.solver.solve(problem, &self.stop)?
                } else {
                    self.solver.again(problem, &self.stop)?
                };
                solve = Some(merge(solve, next));
            }
            let Some(solve) = solve else { continue };
            if judge {
                let of = Self::judge(&mut island, &stages, &self.forces, points, h);
                error.energy += of.energy;
                error.distance = larger(error.distance, of.distance);
            }
            report.island(&island, clamped, certified, solve, watch)?;
        }
        Ok((report, error))
    }

    /// δ of an island, as energy and as distance.
    fn judge(
        island: &mut IslandParts<'_, T>,
        stages: &Stages<'_, T>,
        forces: &F,
        points: bool,
        h: T,
    ) -> LocalError<T> {
        let (position, velocity) = &K::ERROR;
        let first = island.matrix.rows.first;
        let mut farthest = T::ZERO;
        let IslandParts { matrix, vectors, .. } = island;
        for (row, i) in matrix.rows.particles().enumerate() {
            let v = matrix.rows.state.velocity.get(i).copied().unwrap_or([T::ZERO; 3]);
            let last = vectors.x.get(row).copied().unwrap_or([T::ZERO; 3]);
            let with_last = |sum: Vec3<T>, of: &[f64]| {
                let share = of.get(K::STAGES.len() - 1).copied().unwrap_or(0.0);
                vec3::add_scaled(sum, T::from_f64(share), last)
            };
            let q = with_last(combined(position, v, stages, first + row), position.stages);
            let dv = with_last(stages.sum(velocity, [T::ZERO; 3], first + row), velocity);
            farthest = larger(farthest, vec3::dot(q, q));
            if let (Some(y), Some(r)) = (vectors.y.get_mut(row), vectors.r.get_mut(row)) {
                (*y, *r) = (q, dv);
            }
        }
        // δq = h′y and A has h′²K̃, so ½δqᵀ(M/h² − K̃)δq = ½yᵀ(γ²M − h′²K̃)y.
        let gamma = T::from_f64(K::GAMMA);
        let system = System { matrix, forces, points };
        LocalError {
            energy: energy(&system, vectors.y, vectors.r, gamma * gamma),
            distance: h * farthest.sqrt(),
        }
    }

    /// y⁺
    fn commit<M: Memory<Real = T>>(
        &mut self,
        parts: Parts<'_, M>,
        course: Course<'_, T>,
    ) -> Result<(), StepError> {
        let h = self.inner();
        let Parts { network, islands, work } = parts;
        let particles = network.mass.len();
        let numbers = Staged::<K, W>::needs(particles);
        let stages = Stages::cut(self.rule.memory.as_mut(), particles, K::STAGES.len());
        let mut stages = stages.ok_or(StepError::Workspace { numbers, words: 0 })?;
        if let Some(i) = stages.place_pins(None, course, &network.state(), self.dt) {
            return Err(StepError::Motion(i));
        }
        let share = |of: &[f64]| T::from_f64(of.get(K::STAGES.len() - 1).copied().unwrap_or(0.0));
        let (of_position, of_velocity) = (share(K::POSITION.stages), share(K::VELOCITY));
        let next = |slot: usize, [q, v]: [Vec3<T>; 2], last: Vec3<T>| {
            let rate = vec3::add_scaled(combined(&K::POSITION, v, &stages, slot), of_position, last);
            let v = vec3::add_scaled(stages.sum(K::VELOCITY, v, slot), of_velocity, last);
            [vec3::add_scaled(q, h, rate), v]
        };
        commit_at(network, islands, &work.x, course.motion, next, |m| stages.placed(m.particle))
    }
}

impl<K: Tableau, W: AsMut<[Vec3<T>]>, T: Real, F: Force<T>, S: Solver<T>, Z> Integrator<T>
    for Stepper<Staged<K, W>, T, F, S, Z>
{
    fn advance<M: Memory<Real = T>>(
        &mut self,
        mut parts: Parts<'_, M>,
        motion: &[Motion<T>],
        watch: &mut impl FnMut(&IslandReport<T>),
    ) -> Result<Report<T>, StepError> {
        let course = Course { motion, over: self.dt };
        let (report, _) = self.stages(&mut parts, course, watch, false)?;
        self.commit(parts, course)?;
        Ok(report)
    }
}

impl<K: Tableau, W: AsMut<[Vec3<T>]>, T: Real, F: Force<T>, S: Solver<T>, Z> Embedded<T>
    for Stepper<Staged<K, W>, T, F, S, Z>
{
    const LOWER_ORDER: u32 = K::LOWER_ORDER;

    fn attempt<M: Memory<Real = T>>(
        &mut self,
        parts: &mut Parts<'_, M>,
        dt: T,
        course: Course<'_, T>,
        absolute: T,
        watch: &mut impl FnMut(&IslandReport<T>),
    ) -> Result<(Report<T>, LocalError<T>), StepError> {
        self.dt = dt;
        // Only J rules: a relative tolerance would let a solve end sooner.
        (self.stop.relative, self.stop.absolute) = (T::ZERO, absolute);
        self.stages(parts, course, watch, true)
    }

    fn accept<M: Memory<Real = T>>(
        &mut self,
        parts: Parts<'_, M>,
        course: Course<'_, T>,
    ) -> Result<(), StepError> {
        self.commit(parts, course)
    }
}
