//! Every way to solve a step's system, by name.

use hooke::{BandedLdl, BlockJacobi, IslandReport, Portable, Real, Solver, StepError, Wide, WideJacobi};

use super::case::{Case, Cut};
use crate::build::{self, Forces};
use crate::direct;
use crate::lanes::{self, wide};
use crate::multigrid::multigrid;
use crate::triangular::{ilu, ssor};

/// A solver of the kernel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Method {
    /// PCG with the diagonal blocks
    Jacobi,
    /// The same in lanes
    Lanes,
    /// The same with its iterations in `f32`
    LanesSingle,
    /// PCG with multigrid, in lanes
    LanesMultigrid,
    /// Chains by eight pieces side by side
    LanesBanded,
    /// PCG with block SSOR
    Ssor,
    /// PCG with block D-ILU
    Ilu,
    /// PCG with one cycle of multigrid
    Multigrid,
    /// Banded LDLᵀ, refined
    Banded,
    /// Sparse LDLᵀ, refined
    Sparse,
    /// Sparse LDLᵀ in `f32`, PCG around it
    Single,
}

/// All of them.
pub const METHODS: [Method; 11] = [
    Method::Jacobi,
    Method::Lanes,
    Method::LanesSingle,
    Method::LanesMultigrid,
    Method::LanesBanded,
    Method::Ssor,
    Method::Ilu,
    Method::Multigrid,
    Method::Banded,
    Method::Sparse,
    Method::Single,
];

/// A solve's answer.
#[derive(Debug, Clone)]
pub struct Solved<T> {
    /// Δq̇ of every particle
    pub velocity: Vec<[f64; 3]>,
    /// What was reported of each island
    pub reports: Vec<IslandReport<T>>,
    /// Was the last island solved in lanes?
    pub in_lanes: bool,
}

impl Method {
    /// As in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Jacobi => "block Jacobi",
            Self::Lanes => "block Jacobi in lanes",
            Self::LanesSingle => "single in lanes",
            Self::LanesMultigrid => "multigrid in lanes",
            Self::LanesBanded => "banded LDLᵀ in lanes",
            Self::Ssor => "SSOR",
            Self::Ilu => "D-ILU",
            Self::Multigrid => "multigrid",
            Self::Banded => "banded LDLᵀ",
            Self::Sparse => "sparse LDLᵀ",
            Self::Single => "sparse LDLᵀ in f32, refined",
        }
    }

    /// Is its lower bound the one with ν, as long as its factors hold?
    pub fn is_direct(self) -> bool {
        matches!(self, Self::Banded | Self::LanesBanded | Self::Sparse | Self::Single)
    }

    /// One step of linearly-implicit Euler from rest.
    pub fn solve<T: Real>(self, case: &Case, cut: Cut) -> Result<Solved<T>, StepError> {
        let data = &case.data;
        match self {
            Self::Jacobi => step::<T, _>(case, cut, BlockJacobi),
            Self::Lanes => {
                let mut lanes = wide::<T>(data);
                let solved = step::<T, _>(case, cut, &mut lanes)?;
                Ok(Solved { in_lanes: lanes.in_lanes(), ..solved })
            }
            Self::LanesSingle => {
                let mut lanes = lanes::single::<T>(data);
                let solved = step::<T, _>(case, cut, &mut lanes)?;
                Ok(Solved { in_lanes: lanes.in_lanes(), ..solved })
            }
            Self::LanesMultigrid => {
                let mut lanes = wide::<T>(data).around(multigrid(data));
                let solved = step::<T, _>(case, cut, &mut lanes)?;
                Ok(Solved { in_lanes: lanes.in_lanes(), ..solved })
            }
            Self::LanesBanded => {
                let mut scene = build::scene::<T>(data);
                let (own, _) = BandedLdl::needs_in_lanes_of(&mut scene, true);
                let (numbers, words) = WideJacobi::needs_of(&mut scene, true);
                let lanes = Wide::new(vec![T::ONE; numbers], vec![7; words], Portable);
                let mut lanes = lanes.around(BandedLdl::new(vec![T::ONE; own]));
                let solved = step::<T, _>(case, cut, &mut lanes)?;
                Ok(Solved { in_lanes: lanes.in_lanes(), ..solved })
            }
            Self::Ssor => step::<T, _>(case, cut, ssor::<T>(data)),
            Self::Ilu => step::<T, _>(case, cut, ilu::<T>(data)),
            Self::Multigrid => step::<T, _>(case, cut, multigrid(data)),
            Self::Banded => step::<T, _>(case, cut, direct::banded::<T>(data)),
            Self::Sparse => step::<T, _>(case, cut, direct::sparse::<T>(data)),
            Self::Single => step::<T, _>(case, cut, direct::single(data)),
        }
    }
}

fn step<T: Real, S: Solver<T>>(case: &Case, cut: Cut, solver: S) -> Result<Solved<T>, StepError> {
    let mut scene = build::scene::<T>(&case.data);
    let mut forces = Forces::<T>::new(&case.data);
    let euler = forces.euler(T::from_f64(case.h)).tolerance(T::from_f64(cut.relative));
    let mut euler = euler.max_iterations(cut.iterations).solver(solver);
    let mut reports = Vec::new();
    let motion = build::motions::<T>(&case.motion);
    scene.step_watched(&mut euler, &motion, |island| reports.push(*island))?;
    Ok(Solved { velocity: build::velocities(&scene), reports, in_lanes: false })
}
