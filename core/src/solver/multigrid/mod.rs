//! Aggregation multigrid as a preconditioner: PCG in the scene's precision around one cycle in f32.
//!
//! Rows are put together in groups of up to eight ([`matching`]), again and again ([`analysis`], once per pattern); every
//! level is a net of springs again ([`level`], [`galerkin`]), whose edges lie where they can be read in order ([`runs`]). A
//! [`cycle`] smooths on every level and solves the last one directly ([`dense`]). The number of iterations then hardly grows
//! with the size of the net; PCG certifies the answer as ever, so a bad hierarchy costs time, never truth.
//!
//! Cost per cycle: about ten products of the finest level in f32. Memory: see [`Multigrid::needs`].

mod analysis;
mod cycle;
mod dense;
mod galerkin;
mod level;
mod matching;
mod relax;
mod runs;
mod tile;
mod words;

use core::cell::RefCell;

use crate::error::StepError;
use crate::force::Force;
use crate::lanes::Lanes;
use crate::real::{Real, larger};
use crate::report::Solve;
use crate::solver::{Preconditioner, Problem, Solver, Stop, pcg};
use crate::system::System;
use crate::vec3::{self, Vec3};
use analysis::{DENSE, Shape, UNKNOWNS};
use cycle::Hierarchy;
use dense::Dense;
use level::Level;
use words::take;

/// PCG with an aggregation-multigrid preconditioner, in a workspace of the caller's: arrays, borrowed slices, vectors.
///
/// ```
/// use hooke::{LinearlyImplicitEuler, Multigrid, Scene};
/// const NEEDS: (usize, usize) = Multigrid::needs(40, 39);
/// let mut rope = Box::new(Scene::<f32, 40, 39>::new());
/// for i in 0..40 {
///     rope.particle([0.1 * i as f32, 0.0, 0.0], 0.010)?;
/// }
/// for i in 1..40 {
///     rope.spring(i - 1, i, 1_000.0)?;
/// }
/// rope.pin(0)?;
/// let solver = Multigrid::new(vec![0.0; NEEDS.0], vec![0; NEEDS.1]);
/// let mut euler = LinearlyImplicitEuler::new(1.0 / 60.0).gravity([0.0, -9.81, 0.0]).solver(solver);
/// assert!(rope.step(&mut euler)?.iterations < 20);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Multigrid<N, W> {
    numbers: N,
    words: W,
    /// Where the next island's hierarchy is kept
    place: usize,
}

impl Multigrid<(), ()> {
    /// How many numbers (f32) and words a scene of so many particles and springs needs.
    pub const fn needs(particles: usize, springs: usize) -> (usize, usize) {
        // An island that is solved directly keeps nothing; of others there are n/25 at most. So much more than linear:
        let most = particles / (DENSE + 1);
        let kept = analysis::words_kept(particles, springs) + most * analysis::words_kept(0, 0);
        (analysis::numbers(particles, springs), kept + analysis::words_worked_in(particles, springs))
    }
}

impl<N, W> Multigrid<N, W> {
    /// A solver in this workspace; [`Multigrid::needs`] says how large it is to be. If it is too small, a step fails with
    /// [`StepError::Workspace`], which says so too.
    pub const fn new(numbers: N, words: W) -> Self {
        Self { numbers, words, place: 0 }
    }
}

impl<T: Real, N: AsMut<[f32]>, W: AsMut<[u32]>> Solver<T> for Multigrid<N, W> {
    fn solve<F: Force<T>>(
        &mut self,
        problem: Problem<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        let matrix = problem.system.matrix;
        let (rows, springs) = (matrix.own.len(), matrix.other.len());
        if matrix.rows.first == 0 {
            self.place = 0;
        }
        let (kept, worked_in) =
            (analysis::words_kept(rows, springs), analysis::words_worked_in(rows, springs));
        let numbers = analysis::numbers(rows, springs);
        let words = self.place + kept + worked_in;
        let short = StepError::Workspace { numbers, words };
        let pool = self.numbers.as_mut().get_mut(..numbers).ok_or(short)?;
        let room = self.words.as_mut().get_mut(self.place..words).ok_or(short)?;
        let (kept, scratch) = room.split_at_mut_checked(kept).ok_or(short)?;
        if rows > DENSE {
            self.place += kept.len();
        }
        let fingerprint = analysis::fingerprint(matrix.own, matrix.other);
        let shape = match analysis::recall(kept, fingerprint, rows, springs) {
            Some(shape) => shape,
            None => analysis::analyse(matrix, fingerprint, kept, scratch, pool).ok_or(short)?,
        };
        let cycle = Cycle::new(&problem.system, &shape, kept, pool).ok_or(short)?;
        let Problem { system, vectors, free, .. } = problem;
        Ok(pcg::solve(&system, &cycle, vectors, stop, free))
    }
}

/// The hierarchy with this step's numbers.
struct Cycle<'a, T> {
    /// 1/σ
    scale: T,
    hierarchy: RefCell<Hierarchy<'a>>,
}

impl<'a, T: Real> Cycle<'a, T> {
    #[inline(never)]
    fn new<F: Force<T>>(
        system: &System<'_, T, F>,
        shape: &Shape,
        mut kept: &'a mut [u32],
        mut pool: &'a mut [f32],
    ) -> Option<Self> {
        let slot_of = analysis::skip_record(&mut kept, system.matrix.other.len())?;
        let scale = T::ONE / galerkin::largest(system);
        let coarsest = shape.size.get(shape.levels.checked_sub(1)?)?.rows;
        let mut dense = Dense::new(take(&mut pool, UNKNOWNS * UNKNOWNS)?, coarsest);
        let mut levels = [const { None }; analysis::LEVELS];
        let mut finer: Option<&mut Level<'_>> = None;
        for (level, size) in levels.iter_mut().zip(&shape.size).take(shape.levels) {
            let level = level.insert(Level::carve(&mut kept, &mut pool, *size)?);
            match finer {
                None => level.fill(system, slot_of, scale),
                Some(fine) => level.coarsen(fine),
            }
            finer = Some(level);
        }
        if let Some(coarsest) = finer.filter(|level| level.pattern.size.rows <= DENSE) {
            coarsest.write_dense(&mut dense);
            dense.factor();
        }
        Some(Self { scale, hierarchy: RefCell::new(Hierarchy { levels, count: shape.levels, dense }) })
    }
}

impl<T: Real> Preconditioner<T> for Cycle<'_, T> {
    /// z = B r; the cycle sees r divided by its largest component, since f32 would lose a small one.
    #[inline(never)]
    fn apply(&self, r: &[Vec3<T>], z: &mut [Vec3<T>]) -> T {
        let mut most = T::ZERO;
        for r in r {
            most = larger(larger(larger(most, r[0].abs()), r[1].abs()), r[2].abs());
        }
        let down = T::ONE / most;
        let up = most * self.scale;
        let mut product = Lanes::new();
        // Nobody else holds it.
        let Ok(mut hierarchy) = self.hierarchy.try_borrow_mut() else { return T::ZERO };
        let hierarchy = &mut *hierarchy;
        let ready = most > T::ZERO && down.is_finite();
        match hierarchy.levels.first_mut() {
            Some(Some(finest)) if ready => {
                let [x, y, z] = &mut finest.r.0;
                for (((x, y), z), r) in x.iter_mut().zip(y.iter_mut()).zip(z.iter_mut()).zip(r) {
                    [*x, *y, *z] = vec3::scale(down, *r).map(|r| r.to_f64() as f32);
                }
            }
            _ => {
                z.fill([T::ZERO; 3]);
                return T::ZERO;
            }
        }
        hierarchy.cycle();
        if let Some(Some(finest)) = hierarchy.levels.first() {
            for (i, (z, r)) in z.iter_mut().zip(r).enumerate() {
                *z = finest.x.at(i).map(|x| up * T::from_f64(f64::from(x)));
                product.add(i, vec3::dot(*r, *z));
            }
        }
        product.sum()
    }
}
