//! Block-Jacobi PCG in lanes: for hosts with vector registers, on scenes whose springs join particles at few distances in
//! the numbering (cloths, nets, ropes, lattices).
//!
//! The same mathematics as [`crate::BlockJacobi`], with the island laid out in offset runs ([`layout`]) and planes
//! ([`work`]): no index, no scatter, eight rows side by side. Sums run in an order of its own, so its bits differ from
//! those of [`crate::BlockJacobi`] in the last places; they are the same on every target, for every [`Dispatch`]. The
//! start, the checks and the bounds are those of every solver. An island that has too many distances is left to
//! [`crate::BlockJacobi`].
//!
//! Cost: an iteration takes about half the time that it takes in the scene's own vectors (`compare` in `benches/` measures
//! it). Memory: 20 numbers per particle and 4 per particle and distance, on top of the scene's.

pub(crate) mod diagonal;
pub(crate) mod dispatch;
pub(crate) mod layout;
pub(crate) mod product;
pub(crate) mod sweep;
pub(crate) mod tile;
pub(crate) mod work;

pub use dispatch::{Dispatch, Portable};

use crate::error::StepError;
use crate::force::Force;
use crate::memory::Memory;
use crate::parts::{Matrix, Vectors};
use crate::real::Real;
use crate::report::Solve;
use crate::scene::MassSpring;
use crate::solver::{BlockJacobi, Problem, Solver, Stop, pcg};
use crate::system::System;
use crate::vec3::Vec3;
use layout::{ANCHOR, Layout, each_spring, place};
use work::Work;

/// Block-Jacobi PCG over offset runs, in a workspace of the caller's.
#[derive(Debug, Clone, Copy)]
pub struct WideJacobi<N, W, D = Portable> {
    numbers: N,
    words: W,
    dispatch: D,
    layout: Layout,
    /// Is the layout that of the words?
    found: bool,
}

impl<N, W, D: Dispatch> WideJacobi<N, W, D> {
    /// A solver in this workspace; [`WideJacobi::needs_of`] says how large it is to be. If it is too small, a step fails with
    /// [`StepError::Workspace`], which says so too.
    pub const fn new(numbers: N, words: W, dispatch: D) -> Self {
        Self { numbers, words, dispatch, layout: Layout::none(), found: false }
    }

    /// Was the last island solved in lanes? If not, its springs join particles at too many distances, and
    /// [`crate::BlockJacobi`] solved it.
    pub fn in_lanes(&self) -> bool {
        self.found
    }
}

impl WideJacobi<(), ()> {
    /// How many numbers and words a scene needs as its pins and springs are now. Islands share the workspace.
    /// `scratch` is a word per spring.
    pub fn needs_of<M: Memory>(scene: &mut MassSpring<M>, scratch: &mut [u32]) -> (usize, usize) {
        let parts = scene.parts();
        let state = parts.network.state();
        let (mut numbers, mut words) = (0, 0);
        for k in 0..parts.islands.count {
            let island = parts.islands.island(k, parts.work, &state);
            if !Layout::is_conceivable(&island.matrix) {
                continue;
            }
            words = core::cmp::max(words, island.matrix.other.len());
            let Some(layout) = Layout::find(&island.matrix, scratch) else { continue };
            let edges = island.matrix.other.len();
            numbers = core::cmp::max(numbers, work::needs(&layout));
            words = core::cmp::max(words, edges + 2 * island.anchors);
        }
        (numbers, words)
    }
}

impl<T: Real, N: AsMut<[T]>, W: AsMut<[u32]>, D: Dispatch> Solver<T> for WideJacobi<N, W, D> {
    fn solve<F: Force<T>>(
        &mut self,
        problem: Problem<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        let (numbers, words) = (self.numbers.as_mut(), self.words.as_mut());
        let Problem { system, vectors, free, .. } = problem;
        let matrix = system.matrix;
        let edges = matrix.other.len();
        let known = self.found && self.layout.fits(matrix);
        if !known {
            let room = words.len();
            self.found = false;
            // Most scenes without a layout are known as such before the springs are looked at one by one.
            let layout = if Layout::is_conceivable(matrix) {
                let run = words.get_mut(..edges).ok_or(StepError::Workspace { numbers: 0, words: edges })?;
                Layout::find(matrix, run)
            } else {
                None
            };
            let Some(layout) = layout else {
                return BlockJacobi.solve(Problem { system, vectors, ..problem }, stop);
            };
            let needs = (work::needs(&layout), edges + 2 * anchors_of(matrix));
            if needs.0 > numbers.len() || needs.1 > room {
                return Err(StepError::Workspace { numbers: needs.0, words: needs.1 });
            }
            numbers.fill(T::ZERO);
            list_anchors(matrix, words);
            (self.layout, self.found) = (layout, true);
        }
        let (run, anchors) = words.split_at_mut_checked(edges).unwrap_or_default();
        let anchors = anchors.get(..2 * anchors_of(matrix)).unwrap_or_default();
        let Some(work) = Work::cut(numbers, &self.layout) else {
            return Err(StepError::Workspace { numbers: work::needs(&self.layout), words: 0 });
        };
        let mut lanes =
            Lanes { layout: self.layout, run, anchors, work, dispatch: self.dispatch, filled: false };
        Ok(pcg::solve_by(&system, &mut lanes, vectors, stop, free))
    }
}

/// How many springs end at a pin.
fn anchors_of<T>(matrix: &Matrix<'_, T>) -> usize {
    let rows = matrix.own.len();
    matrix.other.iter().filter(|other| **other as usize >= rows).count()
}

/// Lists (row, place in the lists) of the springs that end at a pin behind the runs of all springs.
fn list_anchors<T>(matrix: &Matrix<'_, T>, words: &mut [u32]) {
    let Some((run, list)) = words.split_at_mut_checked(matrix.other.len()) else { return };
    let mut list = list.as_chunks_mut().0.iter_mut();
    _ = each_spring(matrix, |row, _, edge| {
        if run.get(edge) == Some(&ANCHOR) {
            *list.next()? = [row as u32, edge as u32];
        }
        Some(())
    });
}

/// One island's solve in lanes.
struct Lanes<'a, T, D> {
    layout: Layout,
    /// Which run each spring belongs to
    run: &'a [u32],
    anchors: &'a [u32],
    work: Work<'a, T>,
    dispatch: D,
    filled: bool,
}

impl<T: Real, D: Dispatch> Lanes<'_, T, D> {
    /// The system's numbers into planes, and D⁻¹.
    fn fill<F: Force<T>>(&mut self, system: &System<'_, T, F>, weight: &[T]) {
        let Self { layout, run, anchors, work, dispatch, .. } = self;
        let (matrix, plane, pad) = (system.matrix, layout.plane(), layout.pad);
        for (row, (m, weight)) in matrix.inertia.iter().zip(weight).enumerate() {
            let at = pad + place(matrix, row).unwrap_or(0);
            if let (Some(to_m), Some(to_weight)) = (work.inertia.get_mut(at), work.weight.get_mut(at)) {
                (*to_m, *to_weight) = (*m, *weight);
            }
        }
        _ = each_spring(matrix, |row, _, edge| {
            let run = *run.get(edge)?;
            if run != ANCHOR {
                let first = 4 * run as usize * plane + pad + place(matrix, row)?;
                for (k, value) in matrix.hessian.get(edge)?.iter().enumerate() {
                    *work.runs.get_mut(first + k * plane)? = *value;
                }
            }
            Some(())
        });
        dispatch.run(
            #[inline(always)]
            || diagonal::blocks(layout, work),
        );
        diagonal::anchors(system, layout, anchors, work);
        dispatch.run(
            #[inline(always)]
            || diagonal::invert(layout, work),
        );
        self.filled = true;
    }

    /// r and x of the scene into planes; p and y 0.
    fn load<F>(&mut self, system: &System<'_, T, F>, x: &[Vec3<T>], r: &[Vec3<T>]) {
        let Work { x: x_planes, r: r_planes, p, y, .. } = &mut self.work;
        for (row, (x, r)) in x.iter().zip(r).enumerate() {
            let at = self.layout.pad + place(system.matrix, row).unwrap_or(0);
            x_planes.put(at, *x);
            r_planes.put(at, *r);
        }
        p.clear();
        y.clear();
    }
}

impl<T: Real, D: Dispatch> pcg::Iteration<T> for Lanes<'_, T, D> {
    fn iterate<F: Force<T>>(
        &mut self,
        system: &System<'_, T, F>,
        v: &mut Vectors<'_, T>,
        target: T,
        max_iterations: u32,
        iterations: &mut u32,
    ) -> bool {
        if !self.filled {
            self.fill(system, v.mu);
        }
        self.load(system, v.x, v.r);
        let Self { layout, anchors, work, dispatch, .. } = self;
        let stuck = dispatch.run(
            #[inline(always)]
            || {
                let (mut step, mut rz) = (T::ZERO, T::ZERO);
                loop {
                    let (beta, next) = sweep::sweep(layout, work, step);
                    if !(T::HALF * beta > target) || *iterations >= max_iterations {
                        return false;
                    }
                    sweep::direction(layout, work, if rz > T::ZERO { next / rz } else { T::ZERO });
                    let Work { p, y, runs, inertia, .. } = &mut *work;
                    let mut form = product::over_runs(layout, runs, inertia, p, y);
                    product::over_anchors(system, layout, anchors, p, y, &mut form);
                    let curvature = form.sum();
                    if !(curvature > T::ZERO) {
                        return true;
                    }
                    step = next / curvature;
                    rz = next;
                    *iterations += 1;
                }
            },
        );
        for (row, x) in v.x.iter_mut().enumerate() {
            *x = work.x.row(layout.pad + place(system.matrix, row).unwrap_or(0));
        }
        stuck
    }

    fn precondition<F: Force<T>>(&mut self, system: &System<'_, T, F>, v: &mut Vectors<'_, T>) {
        if !self.filled {
            self.fill(system, v.mu);
        }
        self.load(system, v.x, v.r);
        let Self { layout, work, dispatch, .. } = self;
        dispatch.run(
            #[inline(always)]
            || sweep::sweep(layout, work, T::ZERO),
        );
        for (row, z) in v.y.iter_mut().enumerate() {
            *z = work.y.row(layout.pad + place(system.matrix, row).unwrap_or(0));
        }
    }
}
