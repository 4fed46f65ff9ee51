//! Block-Jacobi PCG in lanes: for hosts with vector registers.
//!
//! The same mathematics as [`crate::BlockJacobi`], eight rows side by side, with the numbers in planes ([`work`]) and the
//! springs in one of two layouts:
//!
//! - *Offset runs* ([`layout`]), where springs join particles at few distances in the numbering (cloths, nets, ropes,
//!   lattices): no index, no scatter.
//! - *Slots* ([`slots`]), where they do not (tetrahedral meshes): rows sorted by their numbers of springs, other ends found
//!   by index.
//!
//! Assembly, certificate, product, residual and bounds are written once over both ([`neighbours`]). Each row's sum is that of
//! [`crate::System`] in its order (in runs, where springs come in the order of their other ends). Sums over rows run over
//! places, so bits differ from those of [`crate::BlockJacobi`] in the last places; they are the same on every target, for
//! every [`Dispatch`]. An island that fills neither layout (a star) is left to [`crate::BlockJacobi`]. The layout is found
//! once, compared with the island at every step, and found anew when springs or pins have changed.
//!
//! Cost: `compare` in `benches/` measures it. Memory, on top of the scene's: in runs 23 numbers per particle and 4 per particle
//! and distance (11 and 6 where there are more than six distances). In slots 11 numbers per particle and 14 per spring (23 and 8
//! where a particle has fewer than two springs), 3 words per spring and 1 per particle, and a tenth more of what belongs to
//! springs, for places that no spring takes. With damping along springs each of them has up to one number more.

pub(crate) mod assembly;
pub(crate) mod bound;
pub(crate) mod diagonal;
pub(crate) mod direct;
pub(crate) mod dispatch;
pub(crate) mod eight;
pub(crate) mod gather;
pub(crate) mod in_single;
pub(crate) mod in_slots;
pub(crate) mod island;
pub(crate) mod jacobi;
pub(crate) mod last_rows;
pub(crate) mod layout;
pub(crate) mod load;
pub(crate) mod neighbours;
pub(crate) mod piece_rows;
pub(crate) mod pieces;
pub(crate) mod product;
pub(crate) mod runs;
pub(crate) mod single;
pub(crate) mod slots;
pub(crate) mod solve;
pub(crate) mod springs;
pub(crate) mod sweep;
pub(crate) mod work;

pub use dispatch::{Dispatch, Portable};

use crate::error::StepError;
use crate::force::Force;
use crate::law::Law;
use crate::memory::Memory;
use crate::parts::IslandParts;
use crate::real::Real;
use crate::report::Solve;
use crate::scene::MassSpring;
use crate::solver::{Answer, BlockJacobi, Island, Problem, Solver, Stop};
use crate::system::System;
use island::Givens;
use layout::Layout;
use neighbours::Way;
pub use single::SingleJacobi;
pub use solve::Widened;
use work::{Iterates, Workshop};

/// PCG in lanes in a workspace of the caller's, preconditioned by `P`. An island without lanes is left to `P`'s own way.
#[derive(Debug, Clone, Copy)]
pub struct Wide<N, W, D = Portable, P = BlockJacobi> {
    numbers: N,
    words: W,
    dispatch: D,
    preconditioner: P,
    layout: Layout,
    /// Is the layout that of the words?
    found: bool,
    /// With room for damping?
    damped: bool,
}

/// Block-Jacobi PCG in lanes.
pub type WideJacobi<N, W, D = Portable> = Wide<N, W, D, BlockJacobi>;

impl<N, W, D: Dispatch> Wide<N, W, D> {
    /// A solver in this workspace; [`Wide::needs_of`] says how large it is to be. If it is too small, a step fails with
    /// [`StepError::Workspace`], which says so too.
    pub const fn new(numbers: N, words: W, dispatch: D) -> Self {
        let layout = Layout::none();
        Self { numbers, words, dispatch, preconditioner: BlockJacobi, layout, found: false, damped: false }
    }

    /// The same with another preconditioner, [`crate::Multigrid`], with iterations in f32, [`crate::SingleJacobi`], or around a direct
    /// solver, [`crate::BandedLdl`].
    pub fn around<P>(self, preconditioner: P) -> Wide<N, W, D, P> {
        let Self { numbers, words, dispatch, layout, .. } = self;
        Wide { numbers, words, dispatch, preconditioner, layout, found: false, damped: false }
    }
}

impl<N, W, D, P> Wide<N, W, D, P> {
    /// Was the last island solved in lanes? If not, neither layout would hold much but zeros.
    pub fn in_lanes(&self) -> bool {
        self.found
    }
}

impl Wide<(), ()> {
    /// How many numbers and words a scene needs as its pins and springs are now, with damping along springs or without.
    /// Islands share the workspace.
    pub fn needs_of<M: Memory>(scene: &mut MassSpring<M>, damped: bool) -> (usize, usize) {
        Self::needs_where(scene, damped, |_| true)
    }

    /// The same of the islands whose layout is as told.
    pub(crate) fn needs_where<M: Memory>(
        scene: &mut MassSpring<M>,
        damped: bool,
        mut takes: impl FnMut(&Layout) -> bool,
    ) -> (usize, usize) {
        let (mut numbers, mut words) = (0, 0);
        layouts_of(scene, |layout| {
            if takes(layout) {
                numbers = core::cmp::max(numbers, work::needs(layout, damped));
                words = core::cmp::max(words, layout.words());
            }
        });
        (numbers, words)
    }
}

/// Visits the layouts of a scene's islands.
pub(crate) fn layouts_of<M: Memory>(scene: &mut MassSpring<M>, mut visit: impl FnMut(&Layout)) {
    let parts = scene.parts();
    let state = parts.network.state();
    for k in 0..parts.islands.count {
        let mut island = parts.islands.island(k, parts.work, &state);
        if let Some(layout) = Layout::of(&mut island) {
            visit(&layout);
        }
    }
}

impl Wide<(), ()> {
    /// Do the springs of some island join particles at few distances in the numbering, so that it is laid out in offset
    /// runs? Runs are twice as fast as slots: such a numbering is worth keeping.
    pub fn runs_of<M: Memory>(scene: &mut MassSpring<M>) -> bool {
        let parts = scene.parts();
        let state = parts.network.state();
        (0..parts.islands.count)
            .any(|k| Layout::shape(&parts.islands.island(k, parts.work, &state)).is_some())
    }
}

impl<N, W, D: Dispatch, P> Wide<N, W, D, P> {
    /// Finds the layout of an island; answers whether it has one.
    #[inline(never)]
    fn find<T: Real>(&mut self, island: &mut IslandParts<'_, T>, damped: bool) -> Result<bool, StepError>
    where
        N: AsMut<[T]>,
        W: AsMut<[u32]>,
        P: Preconditions<T>,
    {
        self.found = false;
        let Some(layout) = Layout::of(island) else { return Ok(false) };
        if !P::takes(layout.distances(), layout.places) {
            return Ok(false);
        }
        let needs = (work::needs(&layout, damped), layout.words());
        let (numbers, words) = (self.numbers.as_mut(), self.words.as_mut());
        let (Some(numbers), Some(words)) = (numbers.get_mut(..needs.0), words.get_mut(..needs.1)) else {
            return Err(StepError::Workspace { numbers: needs.0, words: needs.1 });
        };
        numbers.fill(T::ZERO);
        let Some(layout) = layout.find(island, words) else { return Ok(false) };
        (self.layout, self.found, self.damped) = (layout, true, damped);
        Ok(true)
    }

    /// An island's step; `None` if the layout is not that of the island any more.
    fn attempt<T: Real, F: Force<T>, L: Law>(
        &mut self,
        to: &mut Island<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Option<Answer<T>>, StepError>
    where
        N: AsMut<[T]>,
        W: AsMut<[u32]>,
        P: Preconditions<T>,
    {
        let (layout, dispatch) = (self.layout, self.dispatch);
        let short = StepError::Workspace { numbers: work::needs(&layout, F::DAMPS), words: layout.words() };
        let words = &*self.words.as_mut().get_mut(..layout.words()).ok_or(short)?;
        let way = Way::of(&layout, words).ok_or(short)?;
        let (mut front, behind) = work::cut(self.numbers.as_mut(), &layout).ok_or(short)?;
        let Island { island, forces, h, scaling } = to;
        let assembled = {
            let mut workshop = Workshop::cut(&mut *behind, &layout, F::DAMPS).ok_or(short)?;
            let (h, scaling, layout) = (*h, *scaling, &layout);
            let mut givens =
                Givens { island, forces: &mut **forces, h, scaling, layout, words, way, dispatch };
            givens.assemble::<L>(&mut front, &mut workshop)?
        };
        let Some(assembled) = assembled else { return Ok(None) };
        let work = Iterates::cut(behind, &layout).ok_or(short)?;
        let system = System { matrix: &island.matrix, forces: &**forces, points: assembled.points };
        let lanes = Widened { layout: &layout, way, front, work, system, dispatch, free: assembled.free };
        let solve = self.preconditioner.solve_in_lanes(lanes, &mut *island.vectors.x, stop)?;
        Ok(Some(Answer { clamped: assembled.clamped, certified: assembled.certified, solve }))
    }
}

/// Preconditioners that PCG in lanes can be built around, and [`crate::BandedLdl`].
pub trait Preconditions<T: Real>: Solver<T> {
    /// Does it work on an island whose springs join particles at these distances, with so many places? If not, it answers
    /// in its own way.
    #[doc(hidden)]
    fn takes(_distances: &[u32], _places: usize) -> bool {
        true
    }

    /// Solves an island that is laid out in lanes; the answer goes to `x`.
    ///
    /// # Errors
    /// [`StepError::Workspace`] if the preconditioner's scratch is too small.
    fn solve_in_lanes<F: Force<T>, D: Dispatch>(
        &mut self,
        lanes: Widened<'_, '_, T, F, D>,
        x: &mut [[T; 3]],
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError>;
}

impl<T: Real> Preconditions<T> for BlockJacobi {
    fn solve_in_lanes<F: Force<T>, D: Dispatch>(
        &mut self,
        mut lanes: Widened<'_, '_, T, F, D>,
        x: &mut [[T; 3]],
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        lanes.invert_diagonal();
        Ok(lanes.solve(jacobi::Diagonal, x, stop))
    }
}

impl<T: Real, N: AsMut<[T]>, W: AsMut<[u32]>, D: Dispatch, P: Preconditions<T>> Solver<T>
    for Wide<N, W, D, P>
{
    fn begin(&mut self) {
        self.preconditioner.begin();
    }

    fn repeat(&mut self) {
        self.preconditioner.repeat();
    }

    fn again<F: Force<T>>(
        &mut self,
        problem: Problem<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        self.preconditioner.again(problem, stop)
    }

    fn answer<F: Force<T>, L: Law>(
        &mut self,
        mut to: Island<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Answer<T>, StepError> {
        if self.found
            && self.damped == F::DAMPS
            && let Some(answer) = self.attempt::<T, F, L>(&mut to, stop)?
        {
            return Ok(answer);
        }
        if self.find(to.island, F::DAMPS)?
            && let Some(answer) = self.attempt::<T, F, L>(&mut to, stop)?
        {
            return Ok(answer);
        }
        self.found = false;
        self.preconditioner.answer::<F, L>(to, stop)
    }

    fn solve<F: Force<T>>(
        &mut self,
        problem: Problem<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        self.preconditioner.solve(problem, stop)
    }
}
