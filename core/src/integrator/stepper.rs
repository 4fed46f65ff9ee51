//! What every method of time integration is made of: its rule, its step, the rule by which its solves stop, its solver, and
//! the forces besides the springs'. What is common to their steps is here; what is a method's own stands in its file.

use crate::error::StepError;
use crate::force::{Force, Gravity};
use crate::islands::Islands;
use crate::memory::Memory;
use crate::network::Network;
use crate::parts::Parts;
use crate::pins::Motion;
use crate::real::Real;
use crate::selection::MARK;
use crate::sleeping::Awake;
use crate::solver::{BlockJacobi, Solver, Stop};
use crate::vec3::{self, Vec3};

/// A method `R` of time integration with its step, its solver `S` and the forces `F`. It is named by its aliases:
/// [`crate::LinearlyImplicitEuler`], [`crate::Midpoint`], [`crate::Rosenbrock2`], [`crate::Rosenbrock3`] …
#[derive(Debug, Clone, Copy)]
pub struct Stepper<R, T, F = (), S = BlockJacobi, Z = Awake> {
    pub(crate) rule: R,
    pub(crate) dt: T,
    pub(crate) stop: Stop<T>,
    pub(crate) solver: S,
    pub(crate) sleep: Z,
    /// The forces besides the springs' own; change their values between steps here. The last one added is `.1`, the
    /// one before it `.0.1`, and so on.
    pub forces: F,
}

impl<R, T: Real> Stepper<R, T> {
    /// A step of `dt` seconds with the default stopping rule and no forces but the springs'. The values are checked at
    /// each step.
    pub(crate) const fn of(rule: R, dt: T) -> Self {
        Self { rule, dt, stop: Stop::new(), solver: BlockJacobi, sleep: Awake, forces: () }
    }
}

impl<R, T: Real, F, S, Z> Stepper<R, T, F, S, Z> {
    /// Adds a force.
    pub fn with<G>(self, force: G) -> Stepper<R, T, (F, G), S, Z> {
        let Self { rule, dt, stop, solver, sleep, forces } = self;
        Stepper { rule, dt, stop, solver, sleep, forces: (forces, force) }
    }

    /// Solves by another method; [`BlockJacobi`] unless said.
    pub fn solver<N: Solver<T>>(self, solver: N) -> Stepper<R, T, F, N, Z> {
        let Self { rule, dt, stop, sleep, forces, .. } = self;
        Stepper { rule, dt, stop, solver, sleep, forces }
    }

    /// Adds gravity, m/s².
    pub fn gravity(self, g: Vec3<T>) -> Stepper<R, T, (F, Gravity<T>), S, Z> {
        self.with(Gravity(g))
    }

    /// Stops a solve at β ≤ R²β₀; R = 1e-6 (f64) or 1e-4 (f32) unless said.
    pub fn tolerance(mut self, relative: T) -> Self {
        self.stop.relative = relative;
        self
    }

    /// Stops a solve at β ≤ J joules; 0 unless said.
    pub fn absolute(mut self, joules: T) -> Self {
        self.stop.absolute = joules;
        self
    }

    /// At most so many iterations per island and solve; 10,000 unless said.
    pub fn max_iterations(mut self, n: u32) -> Self {
        self.stop.max_iterations = n;
        self
    }

    /// The time step, s.
    pub fn dt(&self) -> T {
        self.dt
    }

    /// Another time step, s, from the next step on.
    pub fn set_dt(&mut self, dt: T) {
        self.dt = dt;
    }
}

impl<R, T: Real, F: Force<T>, S, Z> Stepper<R, T, F, S, Z> {
    /// Refuses what no step can be made with: dt, a tolerance, a force.
    pub(crate) fn check<M: Memory<Real = T>>(&self, network: &Network<M>) -> Result<(), StepError> {
        let h = self.dt;
        if !(h > T::ZERO && (h * h).is_finite() && h * h > T::ZERO) {
            return Err(StepError::TimeStep);
        }
        let valid = |x: T| x.is_finite() && x >= T::ZERO;
        if !valid(self.stop.relative) || !valid(self.stop.absolute) {
            return Err(StepError::Tolerance);
        }
        self.forces.check(network.mass.len(), network.ends.len())
    }

    /// Writes a velocity for each pin behind the unknowns: that of its motion as `of` finds it from b, ḃ (the scene's) and
    /// b⁺, ḃ⁺ (the motion's), 0 for a pin that rests.
    pub(crate) fn pins<M: Memory<Real = T>>(
        &self,
        parts: &mut Parts<'_, M>,
        motion: &[Motion<T>],
        of: impl Fn(Vec3<T>, Vec3<T>, &Motion<T>) -> Vec3<T>,
    ) -> Result<(), StepError> {
        let Parts { network, islands, work } = parts;
        for v in work.x.iter_mut().skip(islands.free) {
            *v = [T::ZERO; 3];
        }
        for m in motion {
            let slot = network.slot.get(m.particle).filter(|slot| **slot & MARK != 0);
            let slot = slot.ok_or(StepError::NotPinned(m.particle))? & !MARK;
            let (Some(v), Some(b), Some(rate)) = (
                work.x.get_mut(slot as usize),
                network.position.get(m.particle),
                network.velocity.get(m.particle),
            ) else {
                return Err(StepError::NotPinned(m.particle));
            };
            *v = of(*b, *rate, m);
            if !vec3::is_finite(m.position) || !vec3::is_finite(m.velocity) || !vec3::is_finite(*v) {
                return Err(StepError::Motion(m.particle));
            }
        }
        Ok(())
    }

    /// p = (b⁺ − b)/h
    #[inline]
    pub(crate) fn over_the_step(h: T) -> impl Fn(Vec3<T>, Vec3<T>, &Motion<T>) -> Vec3<T> {
        move |b, _, m| vec3::map(vec3::sub(m.position, b), |d| d / h)
    }
}

/// (q⁺, q̇⁺) of every free particle as `next` makes them from its slot, q, q̇ and x, and b⁺, ḃ⁺ on pins. Nothing is written
/// unless all of it is finite.
#[inline(always)]
pub(crate) fn commit<M: Memory<Real = T>, T: Real>(
    network: &mut Network<M>,
    islands: &Islands<M>,
    x: &[Vec3<T>],
    motion: &[Motion<T>],
    next: impl Fn(usize, [Vec3<T>; 2], Vec3<T>) -> [Vec3<T>; 2],
) -> Result<(), StepError> {
    commit_at(network, islands, x, motion, next, |m| [m.position, m.velocity])
}

/// The same where pins are not at the ends of their motions but as `end` says, finite.
#[inline(never)]
pub(crate) fn commit_at<M: Memory<Real = T>, T: Real>(
    network: &mut Network<M>,
    islands: &Islands<M>,
    x: &[Vec3<T>],
    motion: &[Motion<T>],
    next: impl Fn(usize, [Vec3<T>; 2], Vec3<T>) -> [Vec3<T>; 2],
    end: impl Fn(&Motion<T>) -> [Vec3<T>; 2],
) -> Result<(), StepError> {
    let Network { position, velocity, .. } = network;
    let (particle, free) = (&islands.particle, islands.free);
    for (slot, (i, change)) in particle.iter().zip(x.iter()).take(free).enumerate() {
        let i = *i as usize;
        let (Some(q), Some(v)) = (position.get(i), velocity.get(i)) else { continue };
        let [q, v] = next(slot, [*q, *v], *change);
        if !vec3::is_finite(v) || !vec3::is_finite(q) {
            return Err(StepError::NotFinite(i));
        }
    }
    for (slot, (i, change)) in particle.iter().zip(x.iter()).enumerate() {
        let (Some(q), Some(v)) = (position.get_mut(*i as usize), velocity.get_mut(*i as usize)) else {
            continue;
        };
        if slot < free {
            [*q, *v] = next(slot, [*q, *v], *change);
        } else {
            *v = [T::ZERO; 3];
        }
    }
    for m in motion {
        if let (Some(q), Some(v)) = (position.get_mut(m.particle), velocity.get_mut(m.particle)) {
            [*q, *v] = end(m);
        }
    }
    Ok(())
}
