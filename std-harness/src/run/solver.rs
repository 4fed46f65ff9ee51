//! The kernel's solvers by name, and the memory that a direct one needs.

use std::fmt;

use hooke::solver::{Answer, Island};
use hooke::{
    BandedLdl, BlockIlu, BlockJacobi, Force, Law, MassSpring, Memory, Multigrid, Numbers, Real, Single,
    SingleJacobi, Solve, Solver, SparseLdl, Ssor, StepError, Stop, Wide, WideJacobi,
};

use crate::host::Host;
use crate::scene::Model;
use crate::scene::dissection::nested_dissection;

/// How linear systems are solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Block-Jacobi PCG.
    Jacobi,
    /// Block-SSOR PCG.
    Ssor,
    /// Block-D-ILU PCG.
    Ilu,
    /// Block-Jacobi PCG in lanes.
    Wide,
    /// The same with its iterations in f32.
    Wide32,
    /// PCG around one aggregation-multigrid cycle in f32.
    Multigrid,
    /// Block-banded LDLᵀ in the order of the particles.
    Banded,
    /// Block-sparse LDLᵀ.
    Ldl,
    /// PCG around a block-sparse LDLᵀ in f32.
    Ldl32,
}

/// What `--solver` calls them.
pub const METHODS: [(&str, Method); 9] = [
    ("jacobi", Method::Jacobi),
    ("ssor", Method::Ssor),
    ("ilu", Method::Ilu),
    ("wide", Method::Wide),
    ("wide32", Method::Wide32),
    ("multigrid", Method::Multigrid),
    ("banded", Method::Banded),
    ("ldl", Method::Ldl),
    ("ldl32", Method::Ldl32),
];

impl Method {
    /// What `--solver` calls it.
    pub fn name(self) -> &'static str {
        METHODS.iter().find(|(_, method)| *method == self).map_or("", |(name, _)| name)
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Jacobi => "block-Jacobi PCG",
            Self::Ssor => "block-SSOR PCG",
            Self::Ilu => "block-D-ILU PCG",
            Self::Wide => "block-Jacobi PCG in lanes",
            Self::Wide32 => "block-Jacobi PCG in lanes, iterations in f32",
            Self::Multigrid => "multigrid PCG",
            Self::Banded => "banded LDLᵀ",
            Self::Ldl => "sparse LDLᵀ",
            Self::Ldl32 => "sparse LDLᵀ in f32",
        })
    }
}

/// Block Jacobi in lanes and in f32.
type Wide32<T> = Wide<Vec<T>, Vec<u32>, Host, SingleJacobi<Vec<f32>>>;

/// Multigrid in lanes.
type Lanes<T> = Wide<Vec<T>, Vec<u32>, Host, Multigrid<Vec<f32>, Vec<u32>, Host>>;

/// Sparse LDLᵀ with these numbers.
type Sparse<N> = SparseLdl<Vec<u32>, N, Vec<u32>, Host>;

/// The banded solver in lanes.
type Chains<T> = Wide<Vec<T>, Vec<u32>, Host, BandedLdl<Vec<T>>>;

/// Any of the solvers, decided when the program runs.
#[derive(Debug, Clone)]
pub enum AnySolver<T> {
    /// [`Method::Jacobi`]
    Jacobi(BlockJacobi),
    /// [`Method::Ssor`], and how many bytes it has
    Ssor(Ssor<Vec<T>>, usize),
    /// [`Method::Ilu`], and how many bytes it has
    Ilu(BlockIlu<Vec<T>>, usize),
    /// [`Method::Wide`], and how many bytes it has
    Wide(Box<WideJacobi<Vec<T>, Vec<u32>, Host>>, usize),
    /// [`Method::Wide32`], and how many bytes it has
    Wide32(Box<Wide32<T>>, usize),
    /// [`Method::Multigrid`], in lanes where a scene has any, and how many bytes it has
    Multigrid(Box<Lanes<T>>, usize),
    /// [`Method::Banded`], chains in lanes, and how many bytes it has
    Banded(Box<Chains<T>>, usize),
    /// [`Method::Ldl`], and how many bytes it has
    Ldl(Box<Sparse<Vec<T>>>, usize),
    /// [`Method::Ldl32`], and how many bytes it has
    Ldl32(Box<Sparse<Single<Vec<f32>>>>, usize),
}

impl<T: Real> AnySolver<T> {
    /// The solver with the memory that this scene needs.
    pub fn new<M: Memory<Real = T>>(method: Method, scene: &mut MassSpring<M>, model: &Model) -> Self {
        match method {
            Method::Jacobi => Self::Jacobi(BlockJacobi),
            Method::Ssor => {
                let numbers = Ssor::needs(model.pinned.len());
                Self::Ssor(Ssor::new(vec![T::ZERO; numbers]), numbers * size_of::<T>())
            }
            Method::Ilu => {
                let numbers = BlockIlu::needs(model.pinned.len());
                Self::Ilu(BlockIlu::new(vec![T::ZERO; numbers]), numbers * size_of::<T>())
            }
            Method::Wide => {
                let (numbers, words) = WideJacobi::needs_of(scene, true);
                let bytes = numbers * size_of::<T>() + words * size_of::<u32>();
                let solver = WideJacobi::new(vec![T::ZERO; numbers], vec![0; words], Host::new());
                Self::Wide(Box::new(solver), bytes)
            }
            Method::Wide32 => {
                let (numbers, words) = WideJacobi::needs_of(scene, true);
                let singles = SingleJacobi::needs_of(scene);
                let bytes = numbers * size_of::<T>() + singles * size_of::<f32>() + words * size_of::<u32>();
                let lanes = WideJacobi::new(vec![T::ZERO; numbers], vec![0; words], Host::new());
                Self::Wide32(Box::new(lanes.around(SingleJacobi::new(vec![0.0; singles]))), bytes)
            }
            Method::Multigrid => {
                let (numbers, words) = Multigrid::needs(model.pinned.len(), model.springs.len());
                let (lanes, places) = WideJacobi::needs_of(scene, true);
                let bytes =
                    numbers * size_of::<f32>() + lanes * size_of::<T>() + (words + places) * size_of::<u32>();
                let multigrid = Multigrid::new(vec![0.0; numbers], vec![0; words], Host::new());
                let lanes = Wide::new(vec![T::ZERO; lanes], vec![0; places], Host::new());
                Self::Multigrid(Box::new(lanes.around(multigrid)), bytes)
            }
            Method::Banded => {
                let (numbers, (lanes, places)) = BandedLdl::needs_in_lanes_of(scene, true);
                let bytes = (numbers + lanes) * size_of::<T>() + places * size_of::<u32>();
                let lanes = Wide::new(vec![T::ZERO; lanes], vec![0; places], Host::new());
                Self::Banded(Box::new(lanes.around(BandedLdl::new(vec![T::ZERO; numbers]))), bytes)
            }
            Method::Ldl => {
                let (solver, numbers, words) = sparse(scene, model, |n| vec![T::ZERO; n]);
                Self::Ldl(Box::new(solver), numbers * size_of::<T>() + words * size_of::<u32>())
            }
            Method::Ldl32 => {
                let (solver, numbers, words) = sparse(scene, model, |n| Single(vec![0.0; n]));
                Self::Ldl32(Box::new(solver), numbers * size_of::<f32>() + words * size_of::<u32>())
            }
        }
    }

    /// Bytes of its own scratch.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Jacobi(_) => 0,
            Self::Ssor(_, bytes)
            | Self::Ilu(_, bytes)
            | Self::Wide(_, bytes)
            | Self::Wide32(_, bytes)
            | Self::Multigrid(_, bytes)
            | Self::Banded(_, bytes)
            | Self::Ldl(_, bytes)
            | Self::Ldl32(_, bytes) => *bytes,
        }
    }
}

impl<T: Real> Solver<T> for AnySolver<T> {
    fn answer<F: Force<T>, L: Law>(
        &mut self,
        to: Island<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Answer<T>, StepError> {
        match self {
            Self::Jacobi(solver) => solver.answer::<F, L>(to, stop),
            Self::Wide(solver, _) => solver.as_mut().answer::<F, L>(to, stop),
            Self::Wide32(solver, _) => solver.as_mut().answer::<F, L>(to, stop),
            Self::Multigrid(solver, _) => solver.as_mut().answer::<F, L>(to, stop),
            Self::Ssor(solver, _) => solver.answer::<F, L>(to, stop),
            Self::Ilu(solver, _) => solver.answer::<F, L>(to, stop),
            Self::Banded(solver, _) => solver.as_mut().answer::<F, L>(to, stop),
            Self::Ldl(solver, _) => solver.as_mut().answer::<F, L>(to, stop),
            Self::Ldl32(solver, _) => solver.as_mut().answer::<F, L>(to, stop),
        }
    }

    fn begin(&mut self) {
        match self {
            Self::Jacobi(solver) => Solver::<T>::begin(solver),
            Self::Wide(solver, _) => Solver::<T>::begin(solver.as_mut()),
            Self::Wide32(solver, _) => Solver::<T>::begin(solver.as_mut()),
            Self::Multigrid(solver, _) => Solver::<T>::begin(solver.as_mut()),
            Self::Banded(solver, _) => Solver::<T>::begin(solver.as_mut()),
            Self::Ssor(solver, _) => Solver::<T>::begin(solver),
            Self::Ilu(solver, _) => Solver::<T>::begin(solver),
            Self::Ldl(solver, _) => Solver::<T>::begin(solver.as_mut()),
            Self::Ldl32(solver, _) => Solver::<T>::begin(solver.as_mut()),
        }
    }

    fn repeat(&mut self) {
        match self {
            Self::Jacobi(solver) => Solver::<T>::repeat(solver),
            Self::Wide(solver, _) => Solver::<T>::repeat(solver.as_mut()),
            Self::Wide32(solver, _) => Solver::<T>::repeat(solver.as_mut()),
            Self::Multigrid(solver, _) => Solver::<T>::repeat(solver.as_mut()),
            Self::Banded(solver, _) => Solver::<T>::repeat(solver.as_mut()),
            Self::Ssor(solver, _) => Solver::<T>::repeat(solver),
            Self::Ilu(solver, _) => Solver::<T>::repeat(solver),
            Self::Ldl(solver, _) => Solver::<T>::repeat(solver.as_mut()),
            Self::Ldl32(solver, _) => Solver::<T>::repeat(solver.as_mut()),
        }
    }

    fn again<F: Force<T>>(
        &mut self,
        problem: hooke::solver::Problem<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        match self {
            Self::Jacobi(solver) => solver.again(problem, stop),
            Self::Ssor(solver, _) => solver.again(problem, stop),
            Self::Ilu(solver, _) => solver.again(problem, stop),
            Self::Wide(solver, _) => solver.as_mut().again(problem, stop),
            Self::Wide32(solver, _) => solver.as_mut().again(problem, stop),
            Self::Multigrid(solver, _) => solver.as_mut().again(problem, stop),
            Self::Banded(solver, _) => solver.as_mut().again(problem, stop),
            Self::Ldl(solver, _) => solver.as_mut().again(problem, stop),
            Self::Ldl32(solver, _) => solver.as_mut().again(problem, stop),
        }
    }

    fn solve<F: Force<T>>(
        &mut self,
        problem: hooke::solver::Problem<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        match self {
            Self::Jacobi(solver) => solver.solve(problem, stop),
            Self::Ssor(solver, _) => solver.solve(problem, stop),
            Self::Ilu(solver, _) => solver.solve(problem, stop),
            Self::Wide(solver, _) => solver.as_mut().solve(problem, stop),
            Self::Wide32(solver, _) => solver.as_mut().solve(problem, stop),
            Self::Multigrid(solver, _) => solver.as_mut().solve(problem, stop),
            Self::Banded(solver, _) => solver.as_mut().solve(problem, stop),
            Self::Ldl(solver, _) => solver.as_mut().solve(problem, stop),
            Self::Ldl32(solver, _) => solver.as_mut().solve(problem, stop),
        }
    }
}

/// A sparse solver with the memory that it needs, in the order of two whose factor is smaller; and how many numbers and
/// words it has.
fn sparse<M: Memory, N: Numbers<M::Real>>(
    scene: &mut MassSpring<M>,
    model: &Model,
    room: impl Fn(usize) -> N,
) -> (Sparse<N>, usize, usize) {
    let springs = model.springs.iter().map(|spring| spring.ends);
    let orders = [minimum_degree(&model.pinned, springs).0, nested_dissection(model)];
    let mut prepared = orders.map(|order| {
        let (mut numbers, mut words) = (0, 0);
        loop {
            let solver = SparseLdl::new(order.clone(), room(numbers), vec![0; words]);
            let mut solver = solver.dispatched_by(Host::new());
            match solver.prepare(scene) {
                Err(StepError::Workspace { numbers: n, words: w }) => (numbers, words) = (n, w),
                // No other error is there to be had.
                _ => return (solver, numbers, words + order.len()),
            }
        }
    });
    if prepared[1].1 < prepared[0].1 {
        prepared.swap(0, 1);
    }
    let [smaller, _] = prepared;
    smaller
}

/// Do the springs of some island join particles at few distances in the numbering, so that lanes are offset runs?
pub fn in_runs(model: &Model) -> bool {
    // A model that the kernel refuses has none.
    model.build::<f64>().is_ok_and(|mut scene| WideJacobi::runs_of(&mut scene))
}

/// How much a sparse factor is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fill {
    /// Blocks below the diagonal.
    pub blocks: f64,
    /// Products of two blocks that it takes to get there.
    pub products: f64,
}

/// An order of the particles that keeps the factor of their free part sparse, and how sparse that is.
pub fn minimum_degree(pinned: &[bool], springs: impl Iterator<Item = [usize; 2]>) -> (Vec<u32>, Fill) {
    let particles = pinned.len();
    let mut neighbours = vec![Vec::new(); particles];
    for [a, b] in springs {
        if !pinned[a] && !pinned[b] {
            neighbours[a].push(b);
            neighbours[b].push(a);
        }
    }
    let (mut from, mut rows) = (vec![0], Vec::new());
    for (i, list) in neighbours.iter_mut().enumerate() {
        // The diagonal bears on no order, but the crate subtracts it from the number of entries.
        list.push(i);
        list.sort_unstable();
        list.dedup();
        rows.extend_from_slice(list);
        from.push(rows.len());
    }
    match amd::order(particles, &from, &rows, &amd::Control::default()) {
        Ok((order, _, info)) => (
            order.into_iter().map(|i| i as u32).collect(),
            Fill { blocks: info.lnz as f64, products: info.n_mult_subs_ldl as f64 },
        ),
        // Every order is right: the particles' own. It may fill all there is.
        Err(_) => {
            let n = particles as f64;
            (Vec::new(), Fill { blocks: n * n / 2.0, products: n * n * n / 6.0 })
        }
    }
}
