//! Velocity Verlet: half a kick, a drift, half a kick.
//!
//! q̇½ = q̇ + ½hM⁻¹f(q),  q⁺ = q + hq̇½,  q̇⁺ = q̇½ + ½hM⁻¹f(q⁺).
//!
//! Where something damps the drift is cut in two, and between its halves q̇ fades for the time h by the explicit
//! midpoint rule on q̇' = −M⁻¹Dq̇ (Strang's splitting: the order stays 2).
//!
//! Order 2. Explicit: no linear system, and a limit, h²λ < 4 and hd < 2, with λ and d of [`Stiffest`], which need no state.
//! A step beyond it is refused ([`StepError::StepLimit`]) or cut into substeps, if [`Verlet::substeps_at_most`] allows as many;
//! substeps share the force where they meet, so that n of them cost n + 1 forces. Symplectic without damping: the energy's
//! error stays bounded, of size h². Keeps linear momentum to rounding, and angular momentum too, on islands that nothing
//! holds. Use it where the wanted error asks for steps below the limit anyway: undamped, not stiff scenes, small errors. Not
//! on stiff or strongly damped ones. Cost: a pass over the springs (one root each) per force; no memory of its own.
//!
//! Nothing is kept from one step to the next: in between a caller may change positions, springs, masses, pins, the values of forces
//! or the method, and nothing would tell. So a step by itself is two forces and a look at the limit, 352,000 instructions on a
//! cloth of 16×16, where a substep is one force, 132,000: if steps are short only for the limit, ask for long ones in substeps.
//!
//! Source: Hairer, Lubich & Wanner 2003, *Geometric numerical integration illustrated by the Störmer–Verlet method*.

use super::Integrator;
use super::embedded::{Embedded, LocalError};
use super::explicit::Explicit;
use super::limit::{Stiffest, stiffest};
use super::stepper::Stepper;
use crate::error::StepError;
use crate::force::Force;
use crate::memory::Memory;
use crate::parts::Parts;
use crate::pins::{Course, Motion};
use crate::real::{Real, larger};
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

/// What substeps are estimated to be wrong by.
#[derive(Clone, Copy)]
struct Wrong<T> {
    energy: T,
    square: T,
}

/// n substeps, which together are `dt`; with the part of λ that is in their estimate.
fn walk<M: Memory<Real = T>, T: Real, F: Force<T>>(
    scene: &mut Explicit<'_, M>,
    forces: &F,
    course: Course<'_, T>,
    (dt, substeps): (T, u32),
    damped: bool,
    square: Option<T>,
) -> Wrong<T> {
    let n = T::from_count(substeps as usize);
    let (h, half) = (dt / n, T::HALF * (dt / n));
    let mut wrong = Wrong { energy: T::ZERO, square: T::ZERO };
    scene.pins(course, T::ZERO, dt);
    scene.forces(forces, false);
    for k in 0..substeps {
        if square.is_some() {
            scene.keep_forces();
        }
        scene.kick(half);
        if (F::DRAGS || F::DAMPS) && damped {
            scene.drift(half);
            scene.pins(course, (T::from_count(k as usize) + T::HALF) / n, dt);
            wrong.energy += scene.fade(forces, h);
            scene.drift(half);
        } else {
            scene.drift(h);
        }
        scene.pins(course, T::from_count(k as usize + 1) / n, dt);
        scene.forces(forces, false);
        scene.kick(half);
        if let Some(square) = square {
            let (energy, most) = scene.change(h);
            wrong.energy += (T::TWO + h * h * square) * energy;
            wrong.square = larger(wrong.square, most);
        }
    }
    // Errors of substeps add up at worst: (Σ√Eₖ)² ≤ n ΣEₖ.
    Wrong { energy: n * wrong.energy, square: n * n * h * h * wrong.square }
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
        let mut substeps = 1;
        if !(self.dt < limit) {
            // Saturates where that is more than there are numbers.
            substeps = ((self.dt / (T::from_f64(0.9) * limit)).to_f64() as u32).saturating_add(1);
        }
        if substeps > self.rule.at_most.max(1) || !(limit > T::ZERO) {
            return Err(StepError::StepLimit(stiffest.particle));
        }
        let mut scene = Explicit::new(parts);
        let course = Course { motion, over: self.dt };
        walk(&mut scene, &self.forces, course, (self.dt, substeps), stiffest.damping > T::ZERO, None);
        let report = scene.report();
        scene.commit(course, self.dt)?;
        Ok(report)
    }
}

/// Under error control a step is made of so many substeps.
const SUBSTEPS: u32 = 8;

/// The position's error of a substep is h³ȧ/6 and more, which h²(a⁺ − a)/6 is, and the velocity's is no more than that over h
/// below the limit: h³ä/12 and |ä| ≤ ω|ȧ|, hω < 2. Fading is judged by its difference to first order.
impl<T: Real, F: Force<T>, S, Z> Embedded<T> for Stepper<KickDriftKick, T, F, S, Z> {
    const LOWER_ORDER: u32 = 1;

    fn longest<M: Memory<Real = T>>(&mut self, parts: &mut Parts<'_, M>) -> T {
        let limit = limit(&stiffest(parts, &mut self.forces, self.dt));
        T::from_f64(0.9) * T::from_count(SUBSTEPS as usize) * limit
    }

    fn attempt<M: Memory<Real = T>>(
        &mut self,
        parts: &mut Parts<'_, M>,
        dt: T,
        course: Course<'_, T>,
        _: T,
        _: &mut impl FnMut(&IslandReport<T>),
    ) -> Result<(Report<T>, LocalError<T>), StepError> {
        self.dt = dt;
        self.check(parts.network)?;
        self.pins(parts, course.motion, Self::over_the_step(course.over))?;
        let stiffest = stiffest(parts, &mut self.forces, dt);
        let mut scene = Explicit::new(parts.reborrow());
        let damped = stiffest.damping > T::ZERO;
        let wrong = walk(&mut scene, &self.forces, course, (dt, SUBSTEPS), damped, Some(stiffest.square));
        if !wrong.energy.is_finite() {
            return Err(StepError::NotFinite(stiffest.particle));
        }
        Ok((scene.report(), LocalError { energy: wrong.energy, distance: wrong.square.sqrt() }))
    }

    fn accept<M: Memory<Real = T>>(
        &mut self,
        parts: Parts<'_, M>,
        course: Course<'_, T>,
    ) -> Result<(), StepError> {
        Explicit::resume(parts).commit(course, self.dt)
    }
}
