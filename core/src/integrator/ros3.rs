//! `ros3`: ROS34PW2, a Rosenbrock W-method of four stages and order 3 with an estimate of order 2.
//!
//! Order 3, also with clamped springs, damping, and pins that move. L-stable and stiffly accurate where K̃ = K. Keeps linear
//! momentum to rounding on islands that nothing holds. Use it with error control ([`crate::Adaptive`]) where small errors are
//! wanted of a stiff scene. On rotating stiff springs at hω ≫ 1 its answer is far off: there only behind its estimate. Cost:
//! one assembly, three passes over the springs, four solves with one matrix, which a direct solver factors once. Memory: 5
//! vectors per particle.
//!
//! The numbers below are the method's own (γ, α, γᵢⱼ, b, b̂) brought to the form of [`super::rosenbrock`]: a = αΓ⁻¹,
//! γc = I − γΓ⁻¹, m = bΓ⁻¹, and from these what multiplies q̇ and u̇ in w and in q. A test makes them anew from the method's
//! own.
//!
//! Source: Rang & Angermann 2005, *New Rosenbrock W-methods of order 3 for partial differential algebraic equations of
//! index 1*, BIT 45, table 4.

use super::rosenbrock::{Combination, Stage, Staged, Tableau};
use super::stepper::Stepper;
use crate::real::Real;
use crate::solver::BlockJacobi;
use crate::vec3::Vec3;

/// The coefficients of `ros3`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Ros34Pw2;

impl Tableau for Ros34Pw2 {
    const GAMMA: f64 = 0.435_866_521_508_459;
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
            time: 0.871_733_043_016_918,
            turn: -1.0,
            position: Combination { own: 2.0, stages: &[2.0] },
            velocity: &[2.0],
            mass: &[-2.0],
            rate: Combination { own: -1.0, stages: &[0.0] },
        },
        Stage {
            time: 0.731_579_957_788_852_4,
            turn: -0.948_302_647_341_233_8,
            position: Combination {
                own: 1.678_449_529_128_734_4,
                stages: &[1.419_217_317_455_764_7, -0.259_232_211_672_969_7],
            },
            velocity: &[1.419_217_317_455_764_7, -0.259_232_211_672_969_7],
            mass: &[-1.823_996_994_774_513_7, 0.124_305_652_566_720_07],
            rate: Combination {
                own: -0.948_302_647_341_233_8,
                stages: &[-0.404_779_677_318_749_1, -0.134_926_559_106_249_64],
            },
        },
        Stage {
            time: 1.0,
            turn: 0.0,
            position: Combination {
                own: 2.294_280_360_279_042,
                stages: &[3.256_082_418_406_667, -0.594_751_371_992_993_8, 2.294_280_360_279_042],
            },
            velocity: &[4.184_760_482_319_161, -0.285_192_017_355_495_9, 2.294_280_360_279_042],
            mass: &[-2.775_676_116_302_468, -2.961_983_662_554_789, 1.250_979_895_056_060_4],
            rate: Combination {
                own: 0.0,
                stages: &[0.902_713_127_763_657_9, -3.415_966_092_661_296, 3.545_260_255_335_102],
            },
        },
    ];
    const POSITION: Combination = Combination {
        own: 2.294_280_360_279_041_2,
        stages: &[4.158_795_546_170_324, -4.010_717_464_654_29, 5.839_540_615_614_144, 1.0],
    };
    const VELOCITY: &'static [f64] =
        &[4.184_760_482_319_16, -0.285_192_017_355_495_9, 2.294_280_360_279_041_4, 1.0];
    const ERROR: (Combination, &'static [f64]) = (
        Combination {
            own: 0.0,
            stages: &[0.011_581_860_447_032_9, -3.350_397_825_200_902, 3.545_260_255_335_102, 0.5],
        },
        &[0.277_749_947_647_968_1, -1.403_239_895_175_999, 1.772_630_127_667_550_7, 0.5],
    );
    const LOWER_ORDER: u32 = 2;
}

/// Order 3 in four solves, with an estimate of the error; `W` is its memory ([`Rosenbrock3::needs`]), `F` are the forces
/// besides the springs'.
pub type Rosenbrock3<T, W, F = (), S = BlockJacobi> = Stepper<Staged<Ros34Pw2, W>, T, F, S>;

impl<T: Real, W: AsMut<[Vec3<T>]>> Stepper<Staged<Ros34Pw2, W>, T> {
    /// A step of `dt` seconds with the default stopping rule and no forces but the springs'. The values are checked at
    /// each step; if the memory is too small the step fails with [`crate::StepError::Workspace`], which says how many
    /// vectors it is to have.
    pub const fn new(dt: T, memory: W) -> Self {
        Self::of(Staged::new(memory), dt)
    }
}

impl<T> Stepper<Staged<Ros34Pw2, ()>, T> {
    /// How many vectors a scene of so many particles needs.
    pub const fn needs(particles: usize) -> usize {
        Staged::<Ros34Pw2, ()>::needs(particles)
    }
}
