//! `ros2`: a Rosenbrock method of two stages and order 2, with an estimate of its error.
//!
//! W k₁ = F(y), W k₂ = F(y + hk₁) − 2k₁, y⁺ = y + h(3/2 k₁ + ½k₂), W = I − γhJ, γ = 1 − 1/√2. The estimate is
//! δq̇ = ½h(k₁ + k₂), the difference to the velocities of y + hk₁, and δq = q⁺ − q − ½h(q̇ + q̇⁺), the difference to the
//! trapezoidal rule: that to the positions of y + hk₁ is of size h², whose energy M/h² would make of size h² instead of h⁴.
//!
//! Order 2, as a W-method also with clamped springs, damping, and pins that move. L-stable where K̃ = K: it damps what is
//! faster than the step, and little of what is slower. Keeps linear momentum to rounding on islands that nothing holds.
//! Use it with error control ([`crate::Adaptive`]), or where a step of [`crate::LinearlyImplicitEuler`] is stable but its
//! answer too damped. On rotating stiff springs at hω ≫ 1 its answer is far off: there only behind its estimate. Cost: one
//! assembly, one pass over the springs, two solves with one matrix, which a direct solver factors once. Memory: 3 vectors per
//! particle.
//!
//! Source: Verwer, Spee, Blom & Hundsdorfer 1999, *A second-order Rosenbrock method applied to photochemical dispersion
//! problems*, §2.

use super::rosenbrock::{Combination, Stage, Staged, Tableau};
use super::stepper::Stepper;
use crate::real::Real;
use crate::solver::BlockJacobi;
use crate::vec3::Vec3;

/// The coefficients of `ros2`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Ros2;

/// √2
const ROOT: f64 = core::f64::consts::SQRT_2;

impl Tableau for Ros2 {
    const GAMMA: f64 = 1.0 - 1.0 / ROOT;
    // 1/γ = 2 + √2
    const STAGES: &'static [Stage] = &[
        Stage {
            time: 0.0,
            turn: 1.0,
            position: Combination { own: 0.0, stages: &[] },
            velocity: &[],
            mass: &[],
            rate: Combination { own: 1.0, stages: &[] },
        },
        Stage {
            time: 1.0,
            turn: -1.0,
            position: Combination { own: 2.0 + ROOT, stages: &[2.0 + ROOT] },
            velocity: &[2.0 + ROOT],
            mass: &[-2.0],
            rate: Combination { own: -1.0, stages: &[ROOT] },
        },
    ];
    const POSITION: Combination =
        Combination { own: 2.0 + ROOT, stages: &[4.0 + 2.5 * ROOT, 1.0 + 0.5 * ROOT] };
    const VELOCITY: &'static [f64] = &[3.0 + 1.5 * ROOT, 1.0 + 0.5 * ROOT];
    const ERROR: (Combination, &'static [f64]) = (
        Combination { own: 0.0, stages: &[-0.5 - 0.5 * ROOT, -0.5 - 0.5 * ROOT] },
        &[1.0 + 0.5 * ROOT, 1.0 + 0.5 * ROOT],
    );
    const LOWER_ORDER: u32 = 1;
}

/// Order 2 in two solves, with an estimate of the error; `W` is its memory ([`Rosenbrock2::needs`]), `F` are the forces
/// besides the springs'.
pub type Rosenbrock2<T, W, F = (), S = BlockJacobi> = Stepper<Staged<Ros2, W>, T, F, S>;

impl<T: Real, W: AsMut<[Vec3<T>]>> Stepper<Staged<Ros2, W>, T> {
    /// A step of `dt` seconds with the default stopping rule and no forces but the springs'. The values are checked at
    /// each step; if the memory is too small the step fails with [`crate::StepError::Workspace`], which says how many
    /// vectors it is to have.
    pub const fn new(dt: T, memory: W) -> Self {
        Self::of(Staged::new(memory), dt)
    }
}

impl<T> Stepper<Staged<Ros2, ()>, T> {
    /// How many vectors a scene of so many particles needs.
    pub const fn needs(particles: usize) -> usize {
        Staged::<Ros2, ()>::needs(particles)
    }
}
