#![doc = include_str!("../README.md")]
#![no_std]
#![forbid(unsafe_code)]
#![warn(clippy::indexing_slicing, clippy::missing_errors_doc)]

// From the ground up, one idea per file, named after the thing in the lecture.
mod lanes;
mod real;
mod sym3;
pub mod vec3;

mod energy;
mod hessian;
mod law;
mod momentum;
mod network;
mod pins;
mod reaction;
pub mod selection;
mod spring;
mod stiffness;

mod assembly;
mod bound;
mod certificate;
mod islands;
mod parts;
mod system;

mod edit;
mod error;
pub mod force;
mod integrator;
mod memory;
mod report;
mod scene;
mod sleeping;
mod snapshot;
pub mod solver;
mod wide;

pub use energy::Energies;
pub use error::{EditError, StepError};
pub use force::{Drag, Force, Gravity, PointForce, PointSpring, SpringDamping};
pub use hessian::{Hessian, Scaling};
pub use integrator::{Adaptive, Made, Probed};
pub use integrator::{AtTheMiddle, Midpoint};
pub use integrator::{Combination, Ros2, Ros34Pw2, Rosenbrock2, Rosenbrock3, Stage, Staged, Tableau};
pub use integrator::{Conserving, EnergyMomentum};
pub use integrator::{Embedded, Integrator, LocalError, Stepper};
pub use integrator::{KickDrift, KickDriftKick, Stiffest, SymplecticEuler, Verlet};
pub use integrator::{LinearizedOnce, LinearlyImplicitEuler};
pub use integrator::{Minimized, Newton};
pub use law::{Cables, Hookean, Law, Mixed};
pub use memory::{Fixed, List, Memory, SliceList, Slices};
pub use network::State;
pub use parts::Parts;
pub use pins::{Course, Motion};
pub use real::{Number, Real};
pub use report::{Ending, IslandReport, Report, Solve};
pub use scene::{Growable, MassSpring, Scene, SceneIn};
pub use sleeping::{Awake, Rest, Sleep, Sleeping};
pub use snapshot::Snapshot;
pub use solver::{BandedLdl, BlockJacobi, Jacobi, Multigrid, Preconditioner, Solver, SparseLdl, Stop};
pub use solver::{BlockIlu, Numbers, Single, Ssor};
pub use spring::{Spring, Stretched};
pub use sym3::Sym3;
pub use system::{Operator, System};
pub use vec3::Vec3;
pub use wide::{Dispatch, Portable, SingleJacobi, Wide, WideJacobi};
