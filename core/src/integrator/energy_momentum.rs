//! `energy-momentum`: a midpoint rule whose spring forces are discrete gradients, so that energy is kept.
//!
//! M(q̇¹ − q̇⁰) = h f̄,  q¹ = q⁰ + ½h(q̇⁰ + q̇¹),  f̄_A = −k(1 − 2l₀/(l⁰ + l¹))(Δx⁰ + Δx¹)/2 = −f̄_B.
//!
//! Then f̄ᵀ(q¹ − q⁰) = V(q⁰) − V(q¹) exactly, since k(l − l₀)²/2 differs by k((l⁰ + l¹)/2 − l₀)(l¹ − l⁰); f̄ is along the mean of
//! Δx, so angular momentum is kept too. Other forces, drag and the springs' damping are taken in the middle of the step.
//!
//! Its true Jacobian is unsymmetric, so iterations use the one that every method here has, A = M + ½hD − ¼h²K̃ with K̃ at the
//! middle: they converge linearly, fast where springs change little in a step. They end where ½bᵀdiag(μ)⁻¹b, b what is missing
//! in the equation, is at most R² of what it was at first (give R = 1e-14 for conservation to rounding), or at most the
//! absolute tolerance, or where rounding ends it; after 50 with [`StepError::NotConverged`].
//!
//! Order 2. Keeps energy, linear and angular momentum to that tolerance where pins rest and nothing damps; conserving is not
//! being right: at hω ≳ 1 what is fast has a wrong phase, and where springs turn or are pressed much in a step the iteration
//! above does not converge, and says so. Use it for long runs whose balance matters. A cable
//! is taken as a spring whose V is 0 when slack, by the same difference. [`crate::PointSpring`] is taken in the middle: it
//! swings, but keeps no energy. Cost: an assembly, a solve and a pass over the springs (two roots each) per iteration. Memory: 2 vectors per particle.
//!
//! Source: Simo & Tarnow 1992, *The discrete energy–momentum method*; Gonzalez 1996, *Time integration and discrete Hamiltonian
//! systems*.

use super::stepper::{Stepper, commit};
use super::trial::{Trial, loose, rounding, unsolved};
use super::{Integrator, merge, stage};
use crate::assembly::{Assembled, Nothing, assemble, prepare_island};
use crate::error::StepError;
use crate::force::Force;
use crate::hessian::Scaling;
use crate::law::Law;
use crate::memory::Memory;
use crate::network::State;
use crate::parts::{IslandParts, Parts};
use crate::pins::Motion;
use crate::real::{Real, larger};
use crate::report::{Ending, IslandReport, Report, Solve};
use crate::solver::{BlockJacobi, Problem, Solver};
use crate::spring::Stretched;
use crate::system::System;
use crate::vec3::{self, Vec3};

/// The rule of [`EnergyMomentum`], with its memory.
#[derive(Debug, Clone, Copy)]
pub struct Conserving<W> {
    memory: W,
}

/// Keeps energy and momenta; `W` is its memory ([`EnergyMomentum::needs`]), `F` are the forces besides the springs'.
pub type EnergyMomentum<T, W, F = (), S = BlockJacobi> = Stepper<Conserving<W>, T, F, S>;

impl<T: Real, W: AsMut<[Vec3<T>]>> Stepper<Conserving<W>, T> {
    /// A step of `dt` seconds with the default stopping rule and no forces but the springs'. The values are checked at
    /// each step; if the memory is too small the step fails with [`StepError::Workspace`], which says how many vectors it is
    /// to have.
    pub const fn new(dt: T, memory: W) -> Self {
        Self::of(Conserving { memory }, dt)
    }
}

impl<T: Real> Stepper<Conserving<()>, T> {
    /// How many vectors a scene of so many particles needs.
    pub const fn needs(particles: usize) -> usize {
        Trial::<T>::needs(particles)
    }
}

/// No more iterations than these.
const ITERATIONS: u32 = 50;

impl<T: Real, F: Force<T>, S: Solver<T>, W: AsMut<[Vec3<T>]>, Z> Integrator<T>
    for Stepper<Conserving<W>, T, F, S, Z>
{
    fn advance<M: Memory<Real = T>>(
        &mut self,
        mut parts: Parts<'_, M>,
        motion: &[Motion<T>],
        watch: &mut impl FnMut(&IslandReport<T>),
    ) -> Result<Report<T>, StepError> {
        let (h, half) = (self.dt, T::HALF * self.dt);
        self.check(parts.network)?;
        self.pins(&mut parts, motion, Self::over_the_step(h))?;
        let Parts { network, islands, work } = parts;
        let state = network.state();
        let particles = state.mass.len();
        let short = StepError::Workspace { numbers: Trial::<T>::needs(particles), words: 0 };
        let mut trial = Trial::cut(self.rule.memory.as_mut(), particles).ok_or(short)?;
        trial.begin(&state, motion, h, T::HALF);
        self.solver.begin();
        let mut report = Report::new(state.springs() - islands.edges);
        let scaling = Scaling { stiffness: half * half, damping: half };
        for k in 0..islands.count {
            // The middle: velocity q̇⁰ + ½Δ, position q⁰ + ½h of it. At first Δ = 0.
            let stuck = {
                let rows = islands.island(k, work, &state).matrix.rows;
                trial.place(&rows, |_, [q, v]| [vec3::add_scaled(q, half, v), v]);
                StepError::NotConverged(rows.particles().next().unwrap_or(0))
            };
            let none = T::ZERO;
            let mut solve =
                Solve { iterations: 0, upper: none, lower: none, ending: Ending::Untouched, fallback: false };
            let (mut goal, mut before, mut worse) = (T::ZERO, T::ZERO, 0);
            let mut found;
            for iteration in 0.. {
                let here = trial.state(&state);
                let mut island = islands.island(k, work, &here);
                prepare_island(&mut island, &self.forces, h, scaling);
                found =
                    assemble::<T, F, M::Law, _>(&mut island, &mut self.forces, T::ZERO, scaling, &Nothing)?;
                missing::<T, F, M::Law>(&mut island, &state, &self.forces, h);
                let beta = unsolved(&island);
                if iteration == 0 {
                    let relative = self.stop.relative * self.stop.relative * beta;
                    goal = larger(if relative.is_finite() { relative } else { T::ZERO }, self.stop.absolute);
                }
                // What no longer falls has reached its rounding, or diverges.
                let stalls = iteration > 0 && !(beta < before);
                worse = if stalls { worse + 1 } else { 0 };
                let tiny = stalls && beta <= rounding(&mut island, &state, h);
                let ending = if beta <= goal {
                    Some(if iteration == 0 { Ending::Untouched } else { Ending::Converged })
                } else if tiny {
                    Some(Ending::Floor)
                } else {
                    None
                };
                if let Some(ending) = ending {
                    let solve = Solve { upper: beta, lower: T::ZERO, ending, ..solve };
                    for (x, i) in island.vectors.x.iter_mut().zip(island.matrix.rows.particles()) {
                        *x = here.velocity.get(i).copied().unwrap_or([T::ZERO; 3]);
                    }
                    report.island(&island, found.clamped, found.certified, solve, watch)?;
                    break;
                }
                if iteration >= ITERATIONS || worse > 3 || !beta.is_finite() {
                    return Err(stuck);
                }
                before = beta;
                if iteration > 0 {
                    self.solver.repeat();
                }
                let Assembled { points, free, .. } = found;
                let IslandParts { matrix, vectors, block, .. } = &mut island;
                let system = System { matrix, forces: &self.forces, points };
                let problem = Problem { system, vectors, block, free };
                solve = merge(Some(solve), self.solver.solve(problem, &loose(&self.stop))?);
                // The middle moves by half of what the end does.
                for (y, i) in vectors.y.iter_mut().zip(matrix.rows.particles()) {
                    *y = here.velocity.get(i).copied().unwrap_or([T::ZERO; 3]);
                }
                let island = islands.island(k, work, &state);
                trial.place(&island.matrix.rows, |row, [q, _]| {
                    let at = |list: &[Vec3<T>]| list.get(row).copied().unwrap_or([T::ZERO; 3]);
                    let v = vec3::add_scaled(at(island.vectors.y), T::HALF, at(island.vectors.x));
                    [vec3::add_scaled(q, half, v), v]
                });
            }
        }
        commit(network, islands, &work.x, motion, |_, [q, v], middle| {
            [vec3::add_scaled(q, h, middle), vec3::sub(vec3::scale(T::TWO, middle), v)]
        })?;
        Ok(report)
    }
}

/// b, which is h(f − Dq̇) without springs at the middle, becomes h(f + f̄ − Dq̇ − Cq̇) − M(q̇¹ − q̇⁰).
#[inline(never)]
fn missing<T: Real, F: Force<T>, L: Law>(
    island: &mut IslandParts<'_, T>,
    before: &State<'_, T>,
    forces: &F,
    h: T,
) {
    let IslandParts { matrix, vectors, particle, spring, .. } = island;
    let here = matrix.rows.state;
    for (b, i) in vectors.b.iter_mut().zip(matrix.rows.particles()) {
        if let (Some(m), Some(was), Some(is)) =
            (here.mass.get(i), before.velocity.get(i), here.velocity.get(i))
        {
            *b = vec3::add_scaled(*b, -(T::TWO * *m), vec3::sub(*is, *was));
        }
    }
    let place = |slot: usize| particle.get(slot).map_or(usize::MAX, |i| *i as usize);
    let mut edges = matrix.other.iter().zip(spring.iter());
    for (row, own) in matrix.own.iter().enumerate() {
        for (other, j) in edges.by_ref().take(*own as usize) {
            let (other, j) = (*other as usize, *j as usize);
            let force = mean::<T, F, L>(before, here, forces, j, [place(row), place(other)]);
            let force = vec3::scale(h, force);
            if let Some(b) = vectors.b.get_mut(row) {
                *b = vec3::add(*b, force);
            }
            if let Some(b) = vectors.b.get_mut(other) {
                *b = vec3::sub(*b, force);
            }
        }
    }
}

/// f̄ of a spring on its first end, its damping included.
#[inline(always)]
fn mean<T: Real, F: Force<T>, L: Law>(
    before: &State<'_, T>,
    here: &State<'_, T>,
    forces: &F,
    j: usize,
    [near, far]: [usize; 2],
) -> Vec3<T> {
    let at = |list: &[Vec3<T>], i: usize| list.get(i).copied().unwrap_or([T::ZERO; 3]);
    let spring = before.spring(j);
    let start = vec3::sub(at(before.position, near), at(before.position, far));
    let middle = vec3::sub(at(here.position, near), at(here.position, far));
    // Δx¹ = 2·middle − Δx⁰
    let end = vec3::sub(vec3::scale(T::TWO, middle), start);
    let (l0, l1) = (Stretched::new(start).length, Stretched::new(end).length);
    let (k, rest) = (spring.stiffness, spring.rest_length);
    let sum = l0 + l1;
    let taut = [l0, l1].map(|l| !stage::is_slack::<T, L>(before, j, l));
    // The tension whose work along the change of length is the difference of V; of two taut ends k(mean − l₀).
    let tension = match taut {
        [true, true] => k * (T::HALF * sum - rest),
        [false, false] => T::ZERO,
        [true, false] => T::HALF * k * (l0 - rest) * (l0 - rest) / (l0 - l1),
        [false, true] => T::HALF * k * (l1 - rest) * (l1 - rest) / (l1 - l0),
    };
    if !(sum > T::ZERO) {
        return [T::ZERO; 3];
    }
    let mut force = vec3::scale(-(T::TWO * tension / sum), middle);
    if F::DAMPS {
        force = vec3::add(force, stage::damped::<T, F, L>(here, forces, j, [near, far]));
    }
    force
}
