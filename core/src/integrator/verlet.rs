//! Velocity Verlet: half a kick, a drift, half a kick.
//!
//! q̇½ = q̇ + ½hM⁻¹f(q),  q⁺ = q + hq̇½,  q̇⁺ = q̇½ + ½hM⁻¹f(q⁺).
//!
//! With drag or damped springs the drift is cut in two, and between its halves q̇ fades for the time h by the explicit
//! midpoint rule on q̇' = −M⁻¹Dq̇ (Strang's splitting: the order stays 2).
//!
//! Order 2. Explicit: no linear system, and a limit, h²λ < 4 and hd < 2, with λ and d of [`Stiffest`], which need no state.
//! A step beyond it is refused ([`StepError::StepLimit`]) or cut into substeps, if [`Verlet::substeps_at_most`] allows as many;
//! substeps share the force where they meet, so that n of them cost n + 1 forces. Symplectic without damping: the energy's
//! error stays bounded, of size h². Keeps linear momentum to rounding, and angular momentum too, on islands that nothing
//! holds. Use it where the wanted error asks for steps below the limit anyway: undamped, not stiff scenes, small errors. Not
//! on stiff or strongly damped ones. Cost: a pass over the springs (one root each) per force; no memory of its own.
//!
//! Source: Hairer, Lubich & Wanner 2003, *Geometric numerical integration illustrated by the Störmer–Verlet method*.

use super::Integrator;
use super::explicit::{Explicit, Stiffest, stiffest};
use super::stepper::Stepper;
use crate::error::StepError;
use crate::force::Force;
use crate::memory::Memory;
use crate::parts::Parts;
use crate::pins::Motion;
use crate::real::Real;
use crate::report::{IslandReport, Report};
use crate::scene::MassSpring;

/// The rule of [`Verlet`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct KickDriftKick {
    at_most: u32,
}

/// q̇½ = q̇ + ½hM⁻¹f(q), q⁺ = q + hq̇½, q̇⁺ = q̇½ + ½hM⁻¹f(q⁺), with the forces `F` besides the springs'.
pub type Verlet<T, F = ()> = Stepper<KickDriftKick, T, F>;

impl<T: Real> Stepper<KickDriftKick, T> {
    /// A step of `dt` seconds, which is to be below the limit, and no forces but the springs'. The values are checked at each
    /// step.
    pub const fn new(dt: T) -> Self {
        Self::of(KickDriftKick { at_most: 1 }, dt)
    }
}

impl<T: Real, F: Force<T>, S, Z> Stepper<KickDriftKick, T, F, S, Z> {
    /// Lets a step beyond the limit be made of up to so many equal substeps, as few as are at most nine tenths of it.
    pub fn substeps_at_most(mut self, n: u32) -> Self {
        self.rule.at_most = n;
        self
    }

    /// The largest step that is stable for a scene as it is, s: min(2/√λ, 2/d); infinite where nothing moves.
    pub fn limit<M: Memory<Real = T>>(&mut self, scene: &mut MassSpring<M>) -> T {
        limit(&stiffest(&mut scene.parts(), &mut self.forces, self.dt))
    }
}

/// min(2/√λ, 2/d)
fn limit<T: Real>(of: &Stiffest<T>) -> T {
    let (swing, fade) = (T::TWO / of.square.sqrt(), T::TWO / of.damping);
    if fade < swing { fade } else { swing }
}

impl<T: Real, F: Force<T>, S, Z> Integrator<T> for Stepper<KickDriftKick, T, F, S, Z> {
    fn advance<M: Memory<Real = T>>(
        &mut self,
        mut parts: Parts<'_, M>,
        motion: &[Motion<T>],
        _: &mut impl FnMut(&IslandReport<T>),
    ) -> Result<Report<T>, StepError> {
        self.check(parts.network)?;
        self.pins(&mut parts, motion, Self::over_the_step(self.dt))?;
        let stiffest = stiffest(&mut parts, &mut self.forces, self.dt);
        let limit = limit(&stiffest);
        let substeps = if self.dt < limit {
            1
        } else {
            // Saturates where that is more than there are numbers.
            (self.dt / (T::from_f64(0.9) * limit)).to_f64() as u32
        };
        let substeps = if self.dt < limit { substeps } else { substeps.saturating_add(1) };
        if substeps > self.rule.at_most.max(1) || !(limit > T::ZERO) {
            return Err(StepError::StepLimit(stiffest.particle));
        }
        let n = T::from_count(substeps as usize);
        let (h, half) = (self.dt / n, T::HALF * (self.dt / n));
        let damped = F::DRAGS || F::DAMPS;
        let mut scene = Explicit::new(parts);
        scene.pins(motion, T::ZERO, self.dt);
        scene.forces(&self.forces, false);
        for k in 0..substeps {
            scene.kick(half);
            if damped {
                scene.drift(half);
                scene.pins(motion, (T::from_count(k as usize) + T::HALF) / n, self.dt);
                scene.fade(&self.forces, h);
                scene.drift(half);
            } else {
                scene.drift(h);
            }
            scene.pins(motion, T::from_count(k as usize + 1) / n, self.dt);
            scene.forces(&self.forces, false);
            scene.kick(half);
        }
        let report = scene.report();
        scene.commit(motion)?;
        Ok(report)
    }
}
