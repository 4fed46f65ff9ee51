//! Aggregation multigrid as a preconditioner: PCG around one cycle, both in f32, with residuals in the scene's precision.
//!
//! Rows are put together in groups of up to eight ([`matching`]), again and again ([`analysis`], once per pattern, kept behind a
//! [`record`] that a [`fingerprint`] finds again); every level is a net of springs again ([`level`], [`galerkin`]), whose edges
//! lie where they can be read in order ([`strips`], [`block`], [`planes`]). A [`cycle`] smooths on every level, in one [`sweep`]
//! each way ([`product`], [`transfer`]), with the inverses of the [`diagonal`] blocks, and solves the last one directly ([`dense`]). The number of
//! iterations then hardly grows with the size of the net. They run on the finest level too ([`inner`]), for the scene's vectors or
//! those in lanes ([`outer`]); x, the residual that ends a solve and its bounds are in the scene's precision, so a bad hierarchy costs
//! time, never truth; and where it brings x no nearer at all, block Jacobi does ([`spare`];
//! in lanes [`crate::wide::jacobi::OrDiagonal`]).
//!
//! Cost per iteration: seven products of the finest level in f32, 46 flops and 32 bytes per spring each (an edge is computed at both of
//! its ends), and half as much again on the coarser ones. Memory ([`sizes`]): see [`Multigrid::needs`].

mod analysis;
mod block;
mod cycle;
mod dense;
mod diagonal;
mod entries;
mod fingerprint;
mod galerkin;
mod inner;
mod level;
mod matching;
mod outer;
mod planes;
mod preconditioner;
mod product;
mod record;
mod sizes;
mod spare;
mod springs;
mod strips;
mod sweep;
mod tile;
mod transfer;
mod words;

use crate::error::StepError;
use crate::force::Force;
use crate::real::Real;
use crate::report::Solve;
use crate::solver::{Problem, Solver, Stop, pcg};
use crate::system::System;
use crate::vec3::Vec3;
use crate::wide::jacobi::OrDiagonal;
use crate::wide::{Dispatch, Portable, Preconditions, Widened};
use preconditioner::Preconditioner;
use sizes::DENSE;
use spare::WithSpare;
use springs::Springs;

/// PCG with an aggregation-multigrid preconditioner, in a workspace of the caller's: arrays, borrowed slices, vectors.
///
/// ```
/// use hooke::{LinearlyImplicitEuler, Multigrid, Portable, Scene};
/// const NEEDS: (usize, usize) = Multigrid::needs(40, 39);
/// let mut rope = Box::new(Scene::<f32, 40, 39>::new());
/// for i in 0..40 {
///     rope.particle([0.1 * i as f32, 0.0, 0.0], 0.010)?;
/// }
/// for i in 1..40 {
///     rope.spring(i - 1, i, 1_000.0)?;
/// }
/// rope.pin(0)?;
/// let solver = Multigrid::new(vec![0.0; NEEDS.0], vec![0; NEEDS.1], Portable);
/// let mut euler = LinearlyImplicitEuler::new(1.0 / 60.0).gravity([0.0, -9.81, 0.0]).solver(solver);
/// assert!(rope.step(&mut euler)?.iterations < 20);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Multigrid<N, W, D = Portable> {
    numbers: N,
    words: W,
    dispatch: D,
    /// Where the next island's hierarchy is kept
    place: usize,
    /// Where the last one's is, if it is kept
    last: usize,
    /// Where the last one's ends
    end: usize,
    /// May what later islands kept have been written over?
    spoilt: bool,
}

impl Multigrid<(), ()> {
    /// How many numbers (f32) and words a scene of so many particles and springs needs.
    pub const fn needs(particles: usize, springs: usize) -> (usize, usize) {
        let words = sizes::words_kept_by_all(particles, springs) + sizes::words_worked_in(particles, springs);
        (sizes::numbers(particles, springs), words)
    }
}

impl<N, W, D: Dispatch> Multigrid<N, W, D> {
    /// A solver in this workspace; [`Multigrid::needs`] says how large it is to be. If it is too small, a step fails with
    /// [`StepError::Workspace`], which says so too.
    pub const fn new(numbers: N, words: W, dispatch: D) -> Self {
        Self { numbers, words, dispatch, place: 0, last: 0, end: 0, spoilt: false }
    }
}

impl<N: AsMut<[f32]>, W: AsMut<[u32]>, D: Dispatch> Multigrid<N, W, D> {
    /// The hierarchy of these springs, known from an earlier step or found, with their numbers, into `to`.
    #[inline(never)]
    fn prepare<'a, T: Real, F: Force<T>>(
        &'a mut self,
        springs_of: &impl Springs<T, F>,
        to: &mut Preconditioner<'a, T, D>,
    ) -> Result<(), StepError> {
        let matrix = springs_of.system().matrix;
        let (rows, springs) = (matrix.own.len(), matrix.other.len());
        if matrix.rows.first == 0 {
            (self.place, self.spoilt) = (0, false);
        }
        let (kept, worked_in) = (sizes::words_kept(rows, springs), sizes::words_worked_in(rows, springs));
        let numbers = sizes::numbers(rows, springs);
        let words = self.place + kept + worked_in;
        let short = StepError::Workspace { numbers, words };
        let pool = self.numbers.as_mut().get_mut(..numbers).ok_or(short)?;
        // What is kept lies in front, what is soon forgotten at the back, where it can spoil what later islands keep only
        // if there is less room than the whole scene needs.
        let room = self.words.as_mut();
        let back = room.len().checked_sub(worked_in).filter(|_| words <= room.len()).ok_or(short)?;
        let (front, scratch) = room.split_at_mut_checked(back).ok_or(short)?;
        let keeps = rows > DENSE;
        let place = if keeps { self.place } else { back - kept };
        let forgotten_from = if keeps { back } else { place };
        let kept = front.get_mut(place..place + kept).ok_or(short)?;
        self.last = self.place;
        if keeps {
            self.place += kept.len();
        }
        let fingerprint = fingerprint::fingerprint(matrix.own, matrix.other);
        let known = record::recall(kept, fingerprint, rows, springs).filter(|_| keeps && !self.spoilt);
        let shape = match known {
            Some(shape) => shape,
            None => {
                self.spoilt |= forgotten_from < self.end;
                let (weight, pool) = pool.split_at_mut_checked(springs).ok_or(short)?;
                springs::weigh(springs_of, weight);
                analysis::analyse(matrix, fingerprint, kept, scratch, weight, pool).ok_or(short)?
            }
        };
        self.end = core::cmp::max(self.end, self.place);
        to.build(springs_of, &shape, kept, pool).ok_or(short)
    }

    /// z = B r, one cycle for a system's A, B ≈ A⁻¹; answers rᵀz. For tests and for other iterations.
    ///
    /// # Errors
    /// [`StepError::Workspace`] if the workspace is too small.
    pub fn apply<T: Real, F: Force<T>>(
        &mut self,
        system: &System<'_, T, F>,
        r: &[Vec3<T>],
        z: &mut [Vec3<T>],
    ) -> Result<T, StepError> {
        let mut prepared = Preconditioner::empty(self.dispatch);
        self.prepare(system, &mut prepared)?;
        Ok(prepared.apply(r, z))
    }

    /// Visits all levels of a system's hierarchy, the finest first: its blocks as [`System::blocks`] does, divided by a
    /// number that is answered, and each row's row on the next level. For tests.
    ///
    /// # Errors
    /// [`StepError::Workspace`] if the workspace is too small.
    pub fn inspect<T: Real, F: Force<T>>(
        &mut self,
        system: &System<'_, T, F>,
        mut visit: impl FnMut(usize, LevelPart),
    ) -> Result<T, StepError> {
        let mut prepared = Preconditioner::empty(self.dispatch);
        self.prepare(system, &mut prepared)?;
        prepared.inspect(&mut visit);
        Ok(T::ONE / prepared.scale())
    }
}

/// A part of a level: see [`Multigrid::inspect`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LevelPart {
    /// (row, column, block)
    Block(usize, usize, [[f32; 3]; 3]),
    /// (row, row on the next level)
    Aggregate(usize, usize),
}

impl<T: Real, N: AsMut<[f32]>, W: AsMut<[u32]>, D: Dispatch> Solver<T> for Multigrid<N, W, D> {
    fn begin(&mut self) {
        (self.place, self.last, self.spoilt) = (0, 0, false);
    }

    fn repeat(&mut self) {
        self.place = self.last;
    }

    fn solve<F: Force<T>>(
        &mut self,
        problem: Problem<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        let Problem { system, vectors, block, free } = problem;
        let mut preconditioner = Preconditioner::empty(self.dispatch);
        self.prepare(&system, &mut preconditioner)?;
        let mut by = WithSpare { hierarchy: &mut preconditioner, block, jacobi: None };
        Ok(pcg::solve_by(&system, &mut by, vectors, stop, free))
    }
}

impl<T: Real, N: AsMut<[f32]>, W: AsMut<[u32]>, D: Dispatch> Preconditions<T> for Multigrid<N, W, D> {
    fn solve_in_lanes<F: Force<T>, E: Dispatch>(
        &mut self,
        lanes: Widened<'_, '_, T, F, E>,
        x: &mut [Vec3<T>],
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        let mut preconditioner = Preconditioner::empty(self.dispatch);
        self.prepare(&lanes, &mut preconditioner)?;
        Ok(lanes.solve(OrDiagonal::new(&mut preconditioner), x, stop))
    }
}
