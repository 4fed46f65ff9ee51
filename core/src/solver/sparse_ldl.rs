//! Block-sparse LDLᵀ: a direct solver for nets and bodies of any shape, in an elimination order that the caller gives.
//!
//! A = L S Lᵀ with 3×3 pivots S and no pivoting. What depends on the springs' pattern only ([`super::elimination`]) is kept
//! from step to step, island after island, and found anew when a fingerprint of the pattern has changed; should two patterns
//! share one, the certificate notices and PCG answers. The numbers ([`super::supernodes`]) are new in every step.
//!
//! Cost: 27 c² flops per row with c entries below its pivot; all depends on the order. Exact up to rounding, which the
//! certificate measures; see [`super::direct`] for refinement and what happens when a pivot fails. In [`crate::Single`] the factor
//! is in `f32` ([`super::precision`]): A is divided by its largest number and r by its own, so that `f32` holds them.

use crate::error::StepError;
use crate::force::Force;
use crate::lanes::Lanes;
use crate::memory::Memory;
use crate::parts::{Matrix, Parts, Vectors};
use crate::real::{Real, to};
use crate::report::Solve;
use crate::scene::MassSpring;
use crate::solver::around;
use crate::solver::direct::{self, Factors, Kept, On};
use crate::solver::elimination::{FIXED, Sizes, analyse, fingerprint, lists};
use crate::solver::precision::Numbers;
use crate::solver::supernodes::Supernodes;
use crate::solver::{Problem, Solver, Stop};
use crate::system::System;
use crate::vec3::{self, Vec3};
use crate::wide::{Dispatch, Portable};

/// Block-sparse LDLᵀ. Numbers, words and the order are the caller's: arrays, borrowed slices, vectors.
///
/// The order lists particles, first to be eliminated first, best one that keeps the factor sparse (approximate minimum
/// degree, nested dissection). Every order is right: particles that it does not name come last, and what it names twice or
/// in vain is skipped.
///
/// How much memory is needed depends on the order. With too little, [`SparseLdl::prepare`] or a step fails with
/// [`StepError::Workspace`], which says how much, and never less than there is: of words, first so many as it takes to find
/// out, then all.
///
/// ```
/// use hooke::{LinearlyImplicitEuler, Scene, SparseLdl, StepError};
/// let mut net = Box::new(Scene::<f64, 9, 12>::new());
/// for i in 0..9 {
///     net.particle([0.1 * (i % 3) as f64, 0.0, 0.1 * (i / 3) as f64], 0.010)?;
/// }
/// for i in 0..9 {
///     if i % 3 != 2 {
///         net.spring(i, i + 1, 1_000.0)?;
///     }
///     if i < 6 {
///         net.spring(i, i + 3, 1_000.0)?;
///     }
/// }
/// net.pin(0)?;
/// let order = [8, 2, 6, 1, 3, 5, 7, 4];
/// let (mut numbers, mut words) = (vec![], vec![]);
/// let solver = loop {
///     let mut solver = SparseLdl::new(order, numbers, words);
///     match solver.prepare(&mut net) {
///         Err(StepError::Workspace { numbers: n, words: w }) => (numbers, words) = (vec![0.0; n], vec![0; w]),
///         other => break other.map(|()| solver)?,
///     }
/// };
/// let mut euler = LinearlyImplicitEuler::new(0.01).gravity([0.0, -9.81, 0.0]).solver(solver);
/// let report = net.step(&mut euler)?;
/// assert_eq!(report.iterations, 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct SparseLdl<O, N, W, D = Portable> {
    order: O,
    numbers: N,
    words: W,
    /// How many words the records of the present patterns fill
    known: usize,
    /// Where the next island's record is or is to be
    cursor: usize,
    /// Where the last one's is
    last: usize,
    dispatch: D,
    kept: Kept,
}

impl<O, N, W> SparseLdl<O, N, W> {
    /// A solver that eliminates in this order, in this workspace.
    pub const fn new(order: O, numbers: N, words: W) -> Self {
        Self {
            order,
            numbers,
            words,
            known: 0,
            cursor: 0,
            last: 0,
            dispatch: Portable,
            kept: Kept::nothing(),
        }
    }
}

impl<O, N, W, D> SparseLdl<O, N, W, D> {
    /// The same with its arithmetic run by a host's wider instructions; the same bits.
    pub fn dispatched_by<E: Dispatch>(self, dispatch: E) -> SparseLdl<O, N, W, E> {
        let Self { order, numbers, words, known, cursor, last, kept, .. } = self;
        SparseLdl { order, numbers, words, known, cursor, last, dispatch, kept }
    }
}

fn larger(a: usize, b: usize) -> usize {
    if a < b { b } else { a }
}

/// A record's header: whose it is, and its sizes.
fn header(first: usize, fingerprint: u32, sizes: &Sizes) -> [u32; FIXED] {
    let Sizes { rows, edges, supers, listed, panels, longest, widest } = *sizes;
    let [first, rows, edges, supers, listed, panels, longest, widest] =
        [first, rows, edges, supers, listed, panels, longest, widest].map(|n| n as u32);
    [first, fingerprint, rows, edges, supers, listed, panels, longest, widest]
}

/// The sizes in a header.
fn sizes(header: [u32; FIXED]) -> Sizes {
    let [_, _, rows, edges, supers, listed, panels, longest, widest] = header.map(|word| word as usize);
    Sizes { rows, edges, supers, listed, panels, longest, widest }
}

impl<O: AsRef<[u32]>, N, W: AsMut<[u32]>, D> SparseLdl<O, N, W, D> {
    /// Analyses a scene before its first step, and tells whether the workspace is large enough for all its islands. A step
    /// does so too; this does it where there is time, and changes nothing of the scene.
    ///
    /// # Errors
    /// [`StepError::Workspace`].
    pub fn prepare<M: Memory>(&mut self, scene: &mut MassSpring<M>) -> Result<(), StepError>
    where
        N: Numbers<M::Real>,
    {
        let Parts { network, islands, work } = scene.parts();
        let (mut scratch, mut numbers) = (0, self.numbers.numbers().len());
        let mut words = self.words.as_mut().len();
        for k in 0..islands.count {
            let sizes = self.analysed(&islands.island(k, work, &network.state()).matrix)?;
            self.cursor += sizes.words();
            numbers = larger(numbers, sizes.numbers());
            scratch = larger(scratch, sizes.scratch());
            words = larger(words, self.known + scratch);
        }
        if (numbers, words) == (self.numbers.numbers().len(), self.words.as_mut().len()) {
            return Ok(());
        }
        Err(StepError::Workspace { numbers, words })
    }

    /// The sizes of an island's factor, analysed if its record is not the next one.
    fn analysed<T: Real>(&mut self, matrix: &Matrix<'_, T>) -> Result<Sizes, StepError>
    where
        N: Numbers<T>,
    {
        let numbers = self.numbers.numbers().len();
        if matrix.rows.first == 0 {
            self.cursor = 0;
        }
        let (first, print) = (matrix.rows.first, fingerprint(matrix));
        let words = self.words.as_mut();
        let kept = words.get(self.cursor..self.known).and_then(|record| record.first_chunk::<FIXED>());
        if let Some(kept) = kept {
            let sizes = sizes(*kept);
            let same = (sizes.rows, sizes.edges) == (matrix.own.len(), matrix.other.len());
            if same && *kept == header(first, print, &sizes) {
                return Ok(sizes);
            }
        }
        let lacks = |words: usize| StepError::Workspace { numbers, words: self.cursor + FIXED + words };
        let Some((head, rest)) =
            words.get_mut(self.cursor..).and_then(|record| record.split_first_chunk_mut::<FIXED>())
        else {
            return Err(lacks(9 * matrix.own.len() + 4 * matrix.other.len() + 2));
        };
        // What follows belongs to the old pattern.
        self.known = self.cursor;
        let sizes = analyse(matrix, self.order.as_ref(), rest).map_err(lacks)?;
        *head = header(first, print, &sizes);
        self.known = self.cursor + sizes.words();
        Ok(sizes)
    }
}

impl<T, O, N, W, D> Solver<T> for SparseLdl<O, N, W, D>
where
    T: Real,
    D: Dispatch,
    O: AsRef<[u32]>,
    N: Numbers<T>,
    W: AsMut<[u32]>,
{
    fn begin(&mut self) {
        (self.cursor, self.last) = (0, 0);
    }

    fn repeat(&mut self) {
        self.cursor = self.last;
    }

    fn again<F: Force<T>>(
        &mut self,
        problem: Problem<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        self.repeat();
        self.kept.again();
        self.solve(problem, stop)
    }

    fn solve<F: Force<T>>(
        &mut self,
        problem: Problem<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        let sizes = self.analysed(problem.system.matrix)?;
        let (begin, end) = (self.cursor + FIXED, self.cursor + sizes.words());
        let known = self.known;
        let lacks = StepError::Workspace {
            numbers: larger(sizes.numbers(), self.numbers.numbers().len()),
            words: larger(known + sizes.scratch(), self.words.as_mut().len()),
        };
        let Some((records, scratch)) = self.words.as_mut().split_at_mut_checked(known) else {
            return Err(lacks);
        };
        let lists = records.get(begin..end).and_then(|record| lists(&sizes, record));
        let supernodes =
            lists.and_then(|lists| Supernodes::new(&sizes, lists, self.numbers.numbers(), scratch));
        let Some(supernodes) = supernodes else { return Err(lacks) };
        (self.last, self.cursor) = (begin - FIXED, end);
        let less = <N as Numbers<T>>::LESS;
        let mut factors = Dispatched { supernodes, dispatch: self.dispatch, scale: T::ONE, less };
        if less {
            factors.scale = T::ONE / problem.system.largest();
        }
        Ok(direct::solve(problem, stop, &mut factors, &mut self.kept))
    }
}

/// Where the factor's numbers are, what runs the arithmetic, and what A is multiplied by.
struct Dispatched<'a, T, U, D> {
    supernodes: Supernodes<'a, U>,
    dispatch: D,
    scale: T,
    /// In less than the scene's precision
    less: bool,
}

impl<T: Real, U: Real, D: Dispatch> Dispatched<'_, T, U, D> {
    /// x ← A⁻¹ x, x being divided by `most` on the way.
    #[inline(never)]
    fn substitute(&mut self, most: T, x: &mut [Vec3<T>]) {
        let Self { supernodes, dispatch, scale, .. } = self;
        let (down, up) = (T::ONE / most, most * *scale);
        for (z, row) in supernodes.vector.iter_mut().zip(supernodes.lists.row) {
            let x = x.get(*row as usize).copied().unwrap_or([T::ZERO; 3]);
            *z = x.map(|x| to(down * x));
        }
        dispatch.run(
            #[inline(always)]
            || supernodes.substitute(),
        );
        for (z, row) in supernodes.vector.iter().zip(supernodes.lists.row) {
            if let Some(x) = x.get_mut(*row as usize) {
                *x = z.map(|z| up * to::<U, T>(z));
            }
        }
    }
}

impl<T: Real, U: Real, D: Dispatch> Factors<T> for Dispatched<'_, T, U, D> {
    #[inline(never)]
    fn factor<F: Force<T>>(&mut self, system: &System<'_, T, F>, blocks: &mut [[T; 6]]) -> bool {
        self.supernodes.assemble(system, blocks, self.scale);
        let Self { supernodes, dispatch, .. } = self;
        dispatch.run(
            #[inline(always)]
            || supernodes.factor(),
        )
    }

    fn solve(&mut self, _: &[[T; 6]], x: &mut [Vec3<T>]) {
        self.substitute(T::ONE, x);
    }

    #[inline(always)]
    fn advance<F: Force<T>>(
        &mut self,
        on: On<'_, '_, T, F>,
        v: &mut Vectors<'_, T>,
        target: T,
        max_iterations: u32,
        iterations: &mut u32,
    ) {
        if !self.less {
            return direct::refine(self, on.pivots, v, iterations);
        }
        around::iterate(on.system, v, target, max_iterations, iterations, |r, most, z| {
            if !(most > T::ZERO && most.is_finite()) {
                return T::ZERO;
            }
            direct::copy(r, z);
            self.substitute(most, z);
            let mut product = Lanes::new();
            for (i, (r, z)) in r.iter().zip(z.iter()).enumerate() {
                product.add(i, vec3::dot(*r, *z));
            }
            product.sum()
        });
    }
}
