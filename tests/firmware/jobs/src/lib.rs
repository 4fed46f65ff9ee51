//! Small simulations, one per feature of the kernel. Each builds its scene in a `static`, steps it, and gives a digest
//! of all positions and velocities after every step; the digests must be the same on every target.
#![no_std]
#![forbid(unsafe_code)]

mod digest;
mod job;
mod outcome;
mod scenes;
mod trace;

pub mod break_spring;
pub mod cables;
pub mod clamping;
pub mod cloth;
pub mod cut_short;
pub mod drag;
pub mod edits;
pub mod islands;
pub mod measures;
pub mod methods;
pub mod moving_pin;
pub mod pin_release;
pub mod point_force;
pub mod point_spring;
pub mod rope;
pub mod sleeping;
pub mod slices;
pub mod snapshot;
pub mod solvers;
pub mod spring_damping;

pub use digest::Digest;
pub use job::Job;
pub use outcome::{Failure, Outcome};
pub use scenes::{cloth as hang_cloth, gravity, hang};
pub use trace::Trace;

/// Every job, in the order of the golden file.
pub static ALL: &[Job] = &[
    rope::F32,
    rope::F64,
    cloth::F32,
    cloth::F64,
    drag::F32,
    drag::F64,
    spring_damping::F32,
    spring_damping::F64,
    point_spring::F32,
    point_spring::F64,
    point_force::F32,
    point_force::F64,
    cables::F32,
    cables::F64,
    moving_pin::F32,
    moving_pin::F64,
    pin_release::F32,
    pin_release::F64,
    edits::F32,
    edits::F64,
    break_spring::F32,
    break_spring::F64,
    clamping::F32,
    clamping::F64,
    islands::F32,
    islands::F64,
    snapshot::F32,
    snapshot::F64,
    slices::F32,
    slices::F64,
    cut_short::F32,
    cut_short::F64,
    measures::F32,
    measures::F64,
    solvers::BANDED_F32,
    solvers::BANDED_F64,
    solvers::SPARSE_F32,
    solvers::SPARSE_F64,
    solvers::SINGLE_F32,
    solvers::SINGLE_F64,
    solvers::CHAIN_F32,
    solvers::CHAIN_F64,
    solvers::SLOTS_F32,
    solvers::SLOTS_F64,
    solvers::SSOR_F32,
    solvers::SSOR_F64,
    solvers::ILU_F32,
    solvers::ILU_F64,
    solvers::WIDE_F32,
    solvers::WIDE_F64,
    solvers::WIDE_SINGLE_F32,
    solvers::WIDE_SINGLE_F64,
    solvers::MULTIGRID_F32,
    solvers::MULTIGRID_F64,
    sleeping::F32,
    sleeping::F64,
    methods::MIDPOINT_F32,
    methods::MIDPOINT_F64,
    methods::ROS2_F32,
    methods::ROS2_F64,
    methods::ROS3_F32,
    methods::ROS3_F64,
    methods::NEWTON_F32,
    methods::NEWTON_F64,
    methods::ENERGY_MOMENTUM_F32,
    methods::ENERGY_MOMENTUM_F64,
    methods::VERLET_F32,
    methods::VERLET_F64,
    methods::SYMPLECTIC_F32,
    methods::SYMPLECTIC_F64,
    methods::ADAPTIVE_F32,
    methods::ADAPTIVE_F64,
];
