//! Symplectic Euler: a kick, then a drift with the new velocity.
//!
//! q̇⁺ = q̇ + hM⁻¹f(q, q̇),  q⁺ = q + hq̇⁺.
//!
//! Order 1. Explicit: no linear system, and a limit, h < (√(d² + 4λ) − d)/λ, that is h²λ + 2hd < 4, with λ and d of
//! [`super::limit::Stiffest`], which need no state; a step beyond it is refused ([`StepError::StepLimit`]). Symplectic
//! without damping: its positions are those of [`crate::Verlet`] with a velocity that is half a step late, so it is no worse
//! to look at; [`crate::Verlet`] costs no more with substeps. Keeps linear and angular momentum to rounding on islands that
//! nothing holds. Use it where one force a step is all there is time for. Cost: one pass over the springs (one root each),
//! and one for the limit; no memory of its own.
//!
//! Source: Hairer, Lubich & Wanner, *Geometric Numerical Integration*, §I.1.2.

use super::Integrator;
use super::explicit::Explicit;
use super::limit::stiffest;
use super::stepper::Stepper;
use crate::error::StepError;
use crate::force::Force;
use crate::memory::Memory;
use crate::parts::Parts;
use crate::pins::{Course, Motion};
use crate::real::Real;
use crate::report::{IslandReport, Report};
use crate::scene::MassSpring;

/// The rule of [`SymplecticEuler`].
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct KickDrift;

/// q̇⁺ = q̇ + hM⁻¹f(q, q̇), q⁺ = q + hq̇⁺, with the forces `F` besides the springs'.
pub type SymplecticEuler<T, F = ()> = Stepper<KickDrift, T, F>;

impl<T: Real> Stepper<KickDrift, T> {
    /// A step of `dt` seconds, which is to be below the limit, and no forces but the springs'. The values are checked at each
    /// step.
    pub const fn new(dt: T) -> Self {
        Self::of(KickDrift, dt)
    }
}

impl<T: Real, F: Force<T>, S, Z> Stepper<KickDrift, T, F, S, Z> {
    /// The largest step that is stable for a scene as it is, s: (√(d² + 4λ) − d)/λ; infinite where nothing moves.
    pub fn limit<M: Memory<Real = T>>(&mut self, scene: &mut MassSpring<M>) -> T {
        let of = stiffest(&mut scene.parts(), &mut self.forces, self.dt);
        let root = (of.damping * of.damping + T::TWO * T::TWO * of.square).sqrt();
        // 4/(√(d² + 4λ) + d) is the same without the cancellation.
        T::TWO * T::TWO / (root + of.damping)
    }
}

impl<T: Real, F: Force<T>, S, Z> Integrator<T> for Stepper<KickDrift, T, F, S, Z> {
    fn advance<M: Memory<Real = T>>(
        &mut self,
        mut parts: Parts<'_, M>,
        motion: &[Motion<T>],
        _: &mut impl FnMut(&IslandReport<T>),
    ) -> Result<Report<T>, StepError> {
        let h = self.dt;
        self.check(parts.network)?;
        self.pins(&mut parts, motion, Self::over_the_step(h))?;
        let most = stiffest(&mut parts, &mut self.forces, h);
        if !(h * (h * most.square + T::TWO * most.damping) < T::TWO * T::TWO) {
            return Err(StepError::StepLimit(most.particle));
        }
        let mut scene = Explicit::new(parts);
        let course = Course { motion, over: h };
        scene.pins(course, T::ZERO, h);
        scene.forces(&self.forces, most.damping > T::ZERO);
        scene.kick(h);
        scene.drift(h);
        let report = scene.report();
        scene.commit(course, h)?;
        Ok(report)
    }
}
