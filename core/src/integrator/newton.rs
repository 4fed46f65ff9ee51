//! `newton`: backward Euler, its nonlinear equations solved by Newton's method with a line search.
//!
//! M(q̇⁺ − q̇) = h f(q⁺, q̇⁺),  q⁺ = q + hq̇⁺: where the incremental potential
//!
//! E(v) = ½‖v − q̇‖²_M + ½h vᵀDv + V(q + hv)
//!
//! is least. Each iteration solves (M + hD − h²K̃)Δ = −∂E/∂v at v, K̃ clamped where the certificate fails, so that Δ leads
//! downhill, and goes as far along it as E falls enough (Armijo's rule): E never rises. The springs' damping has no potential; its directions
//! are lagged, u at the beginning of the step, and then ½h c(u·Δv)² is one. Pins are at b⁺, with p = (b⁺ − b)/h.
//!
//! Order 1; stable at any h on any scene, whatever springs are compressed; damps as [`crate::LinearlyImplicitEuler`] does. Keeps
//! linear momentum to the tolerance on islands that nothing holds. Use it where a large step is to hold, and to find what a scene
//! rests in; at R = 1e-7 and 1/60 s 2 of 30 violent random networks asked for more iterations than there are, at 1 s 16. It ends where ½bᵀdiag(μ)⁻¹b, b = −∂E/∂v, is at most R² of what it was at v = 0, or at most the absolute
//! tolerance, or where rounding ends it; after 200 iterations with [`StepError::NotConverged`]. Cost: a few assemblies and
//! solves, and passes over the springs (one root each) for E. Memory: 2 vectors per particle.
//!
//! Source: Gast, Schroeder, Stomakhin, Jiang & Teran 2015, *Optimization integrator for large time steps*; Nocedal & Wright,
//! *Numerical Optimization*, §3.1.

use super::stepper::{Stepper, commit};
use super::trial::{Trial, loose, rounding, unsolved};
use super::{Integrator, merge, stage};
use crate::assembly::{Assembled, Nothing, assemble, prepare_island};
use crate::error::StepError;
use crate::force::{Force, Rows};
use crate::hessian::Scaling;
use crate::law::Law;
use crate::memory::Memory;
use crate::network::State;
use crate::parts::{IslandParts, Parts};
use crate::pins::Motion;
use crate::real::{Real, larger};
use crate::report::{Ending, IslandReport, Report, Solve};
use crate::solver::{BlockJacobi, Problem, Solver, Stop};
use crate::spring::Stretched;
use crate::system::System;
use crate::vec3::{self, Vec3};

/// The rule of [`Newton`], with its memory.
#[derive(Debug, Clone, Copy)]
pub struct Minimized<W> {
    memory: W,
}

/// Backward Euler solved for; `W` is its memory ([`Newton::needs`]), `F` are the forces besides the springs'.
pub type Newton<T, W, F = (), S = BlockJacobi> = Stepper<Minimized<W>, T, F, S>;

impl<T: Real, W: AsMut<[Vec3<T>]>> Stepper<Minimized<W>, T> {
    /// A step of `dt` seconds with the default stopping rule and no forces but the springs'. The values are checked at
    /// each step; if the memory is too small the step fails with [`StepError::Workspace`], which says how many vectors it is
    /// to have.
    pub const fn new(dt: T, memory: W) -> Self {
        Self::of(Minimized { memory }, dt)
    }
}

impl<T: Real> Stepper<Minimized<()>, T> {
    /// How many vectors a scene of so many particles needs.
    pub const fn needs(particles: usize) -> usize {
        Trial::<T>::needs(particles)
    }
}

/// No more iterations than these, nor halvings of one.
const ITERATIONS: u32 = 200;
const HALVINGS: u32 = 40;

/// How far an island's iteration has come.
struct Way<T> {
    iterations: u32,
    goal: T,
    /// ½bᵀdiag(μ)⁻¹b before the last iteration
    before: T,
    /// The last iteration changed E by no more than its rounding.
    flat: bool,
    clamped: u32,
    certified: bool,
    solve: Solve<T>,
}

impl<T: Real> Way<T> {
    fn new() -> Self {
        let none = T::ZERO;
        let solve =
            Solve { iterations: 0, upper: none, lower: none, ending: Ending::Untouched, fallback: false };
        Self { iterations: 0, goal: none, before: none, flat: false, clamped: 0, certified: true, solve }
    }

    /// Is this the end?
    fn ends(&mut self, beta: T, found: Assembled, stop: &Stop<T>) -> Option<Ending> {
        (self.clamped, self.certified) = (found.clamped, found.certified);
        if self.iterations == 0 {
            let relative = if beta.is_finite() { stop.relative * stop.relative * beta } else { T::ZERO };
            self.goal = larger(relative, stop.absolute);
        }
        let stuck = self.flat && !(beta < T::HALF * self.before);
        self.before = beta;
        if beta <= self.goal {
            Some(if self.iterations == 0 { Ending::Untouched } else { Ending::Converged })
        } else if stuck {
            Some(Ending::Floor)
        } else {
            None
        }
    }
}

impl<T: Real, F: Force<T>, S: Solver<T>, W: AsMut<[Vec3<T>]>, Z> Integrator<T>
    for Stepper<Minimized<W>, T, F, S, Z>
{
    fn advance<M: Memory<Real = T>>(
        &mut self,
        mut parts: Parts<'_, M>,
        motion: &[Motion<T>],
        watch: &mut impl FnMut(&IslandReport<T>),
    ) -> Result<Report<T>, StepError> {
        let h = self.dt;
        self.check(parts.network)?;
        self.pins(&mut parts, motion, Self::over_the_step(h))?;
        let Parts { network, islands, work } = parts;
        let state = network.state();
        let particles = state.mass.len();
        let short = StepError::Workspace { numbers: Trial::<T>::needs(particles), words: 0 };
        let mut trial = Trial::cut(self.rule.memory.as_mut(), particles).ok_or(short)?;
        trial.begin(&state, motion, h, T::ONE);
        self.solver.begin();
        let mut report = Report::new(state.springs() - islands.edges);
        let scaling = Scaling { stiffness: h * h, damping: h };
        for k in 0..islands.count {
            // v = 0: there the first iteration is the lecture's step.
            let stuck = {
                let rows = islands.island(k, work, &state).matrix.rows;
                trial.place(&rows, |_, [q, _]| [q, [T::ZERO; 3]]);
                StepError::NotConverged(rows.particles().next().unwrap_or(0))
            };
            let mut way = Way::new();
            loop {
                let here = trial.state(&state);
                let mut island = islands.island(k, work, &here);
                prepare_island(&mut island, &self.forces, h, scaling);
                let found = assemble::<T, F, M::Law, _>(&mut island, &mut self.forces, h, scaling, &Nothing)?;
                pull_back::<T, F, M::Law>(&mut island, &state, &self.forces, h);
                let beta = unsolved(&island);
                let ending = way.ends(beta, found, &self.stop);
                let mut floor = || way.flat && beta <= rounding(&mut island, &state, h);
                if let Some(ending) = ending.or_else(|| floor().then_some(Ending::Floor)) {
                    let solve = Solve { upper: beta, lower: T::ZERO, ending, ..way.solve };
                    for (x, i) in island.vectors.x.iter_mut().zip(island.matrix.rows.particles()) {
                        *x = here.velocity.get(i).copied().unwrap_or([T::ZERO; 3]);
                    }
                    report.island(&island, way.clamped, way.certified, solve, watch)?;
                    break;
                }
                if way.iterations >= ITERATIONS || !beta.is_finite() {
                    return Err(stuck);
                }
                if way.iterations > 0 {
                    self.solver.repeat();
                }
                way.iterations += 1;
                let (energy, rounding) = potential::<T, F, M::Law>(&island, &state, &self.forces, h);
                let Assembled { points, free, .. } = found;
                let IslandParts { matrix, vectors, block, .. } = &mut island;
                let system = System { matrix, forces: &self.forces, points };
                let problem = Problem { system, vectors, block, free };
                way.solve = merge(Some(way.solve), self.solver.solve(problem, &loose(&self.stop))?);
                // bᵀΔ: x is A's own answer to b in the space it lies in, so this is ΔᵀAΔ.
                let slope = System { matrix, forces: &self.forces, points }.form(vectors.x);
                if !(slope > T::ZERO) && way.solve.ending == Ending::Capped {
                    return Err(stuck); // A solver that may not iterate finds nothing.
                }
                // v stays in y while the search moves.
                for (y, i) in vectors.y.iter_mut().zip(matrix.rows.particles()) {
                    *y = here.velocity.get(i).copied().unwrap_or([T::ZERO; 3]);
                }
                way.flat = !(T::HALF * slope > rounding);
                let mut part = T::ONE;
                for halvings in 0.. {
                    let island = islands.island(k, work, &state);
                    trial.place(&rows_of(&island, &state), |row, [q, _]| {
                        let at = |list: &[Vec3<T>]| list.get(row).copied().unwrap_or([T::ZERO; 3]);
                        let v = vec3::add_scaled(at(island.vectors.y), part, at(island.vectors.x));
                        [vec3::add_scaled(q, h, v), v]
                    });
                    let here = trial.state(&state);
                    let island = islands.island(k, work, &here);
                    let (reached, blur) = potential::<T, F, M::Law>(&island, &state, &self.forces, h);
                    // Armijo: at least a ten-thousandth of what the slope promises.
                    if reached <= energy - T::from_f64(1e-4) * part * slope + larger(rounding, blur) {
                        break;
                    }
                    if way.flat {
                        // No better point can be recognised: back to where this one began, which is the end.
                        let island = islands.island(k, work, &state);
                        trial.place(&rows_of(&island, &state), |row, [q, _]| {
                            let v = island.vectors.y.get(row).copied().unwrap_or([T::ZERO; 3]);
                            [vec3::add_scaled(q, h, v), v]
                        });
                        break;
                    }
                    if halvings >= HALVINGS {
                        return Err(stuck);
                    }
                    part = part * T::HALF;
                }
            }
        }
        commit(network, islands, &work.x, motion, |_, [q, _], v| [vec3::add_scaled(q, h, v), v])?;
        Ok(report)
    }
}

/// An island's rows with the scene's own state.
fn rows_of<'s, T: Real>(island: &IslandParts<'s, T>, state: &'s State<'s, T>) -> Rows<'s, T> {
    Rows { state, ..island.matrix.rows }
}

/// b += M(q̇ − v), and −h c(u₀·Δv)u₀ of damped springs, u₀ their directions at the beginning of the step.
#[inline(never)]
fn pull_back<T: Real, F: Force<T>, L: Law>(
    island: &mut IslandParts<'_, T>,
    before: &State<'_, T>,
    forces: &F,
    h: T,
) {
    let IslandParts { matrix, vectors, .. } = island;
    let here = matrix.rows.state;
    for (b, i) in vectors.b.iter_mut().zip(matrix.rows.particles()) {
        if let (Some(m), Some(was), Some(is)) =
            (here.mass.get(i), before.velocity.get(i), here.velocity.get(i))
        {
            *b = vec3::add_scaled(*b, *m, vec3::sub(*was, *is));
        }
    }
    if F::DAMPS {
        each_spring(island, |b, row, other, j, ends| {
            let (c, u, along) = lagged::<T, F, L>(before, here, forces, j, ends);
            let force = vec3::scale(h * c * along, u);
            if let Some(b) = b.get_mut(row) {
                *b = vec3::sub(*b, force);
            }
            if let Some(b) = b.get_mut(other) {
                *b = vec3::add(*b, force);
            }
        });
    }
}

/// c, u₀ and u₀·Δv of a spring; zeros where it does not damp.
#[inline(always)]
fn lagged<T: Real, F: Force<T>, L: Law>(
    before: &State<'_, T>,
    here: &State<'_, T>,
    forces: &F,
    j: usize,
    [near, far]: [usize; 2],
) -> (T, Vec3<T>, T) {
    let at = |list: &[Vec3<T>], i: usize| list.get(i).copied().unwrap_or([T::ZERO; 3]);
    let c = forces.damping(j);
    let stretched = Stretched::new(vec3::sub(at(before.position, near), at(before.position, far)));
    if !(c > T::ZERO) || stage::is_slack::<T, L>(before, j, stretched.length) {
        return (T::ZERO, [T::ZERO; 3], T::ZERO);
    }
    let speed = vec3::sub(at(here.velocity, near), at(here.velocity, far));
    (c, stretched.direction, vec3::dot(stretched.direction, speed))
}

/// Visits an island's springs: (b, row, other end, spring, the two particles).
#[inline(always)]
fn each_spring<T: Real>(
    island: &mut IslandParts<'_, T>,
    mut visit: impl FnMut(&mut [Vec3<T>], usize, usize, usize, [usize; 2]),
) {
    let IslandParts { matrix, vectors, particle, spring, .. } = island;
    let place = |slot: usize| particle.get(slot).map_or(usize::MAX, |i| *i as usize);
    let mut edges = matrix.other.iter().zip(spring.iter());
    for (row, own) in matrix.own.iter().enumerate() {
        for (other, j) in edges.by_ref().take(*own as usize) {
            let other = *other as usize;
            visit(vectors.b, row, other, *j as usize, [place(row), place(other)]);
        }
    }
}

/// E of an island, and what rounding can make of it.
#[inline(never)]
fn potential<T: Real, F: Force<T>, L: Law>(
    island: &IslandParts<'_, T>,
    before: &State<'_, T>,
    forces: &F,
    h: T,
) -> (T, T) {
    let Rows { state: here, .. } = island.matrix.rows;
    let place = |slot: usize| island.particle.get(slot).map_or(usize::MAX, |i| *i as usize);
    let given = forces.potential(&island.matrix.rows);
    // All other terms are not negative. What rounded positions make of V is k(l − l₀)u|x|.
    let (mut sum, mut blur) = (T::ZERO, T::ZERO);
    for i in island.matrix.rows.particles() {
        if let (Some(m), Some(was), Some(is)) =
            (here.mass.get(i), before.velocity.get(i), here.velocity.get(i))
        {
            let change = vec3::sub(*is, *was);
            sum += T::HALF * *m * vec3::dot(change, change);
            if F::DRAGS {
                sum += T::HALF * h * forces.drag(i, *m) * vec3::dot(*is, *is);
            }
        }
    }
    let mut edges = island.matrix.other.iter().zip(island.spring.iter());
    for (row, own) in island.matrix.own.iter().enumerate() {
        for (other, j) in edges.by_ref().take(*own as usize) {
            let (j, ends) = (*j as usize, [place(row), place(*other as usize)]);
            let at = |i: usize| here.position.get(i).copied().unwrap_or([T::ZERO; 3]);
            let length = Stretched::new(vec3::sub(at(ends[0]), at(ends[1]))).length;
            if !stage::is_slack::<T, L>(here, j, length) {
                let spring = here.spring(j);
                sum += spring.potential_energy(length);
                let reach = vec3::dot(at(ends[0]), at(ends[0])) + vec3::dot(at(ends[1]), at(ends[1]));
                let reach = reach.sqrt() + spring.rest_length;
                blur += spring.tension(length).abs() * reach
                    + T::UNIT_ROUNDOFF * spring.stiffness * reach * reach;
            }
            if F::DAMPS {
                let (c, _, along) = lagged::<T, F, L>(before, here, forces, j, ends);
                sum += T::HALF * h * c * along * along;
            }
        }
    }
    let terms = T::from_count(island.spring.len() + island.matrix.own.len() + 16);
    (sum + given, T::TWO * T::UNIT_ROUNDOFF * (terms * (sum + given.abs()) + blur))
}
