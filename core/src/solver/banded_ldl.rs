//! Block-banded LDLᵀ: a direct solver for chains, ropes and thin nets.
//!
//! Rows in the island's own order; w, the half bandwidth, is the farthest row that a spring reaches (found anew from the
//! matrix each time, so a broken spring or a released pin needs no word). w = 1 goes the way of [`super::chain`]; else
//! column after column, with 3×3 pivots Sₖ and no pivoting (A is positive definite):
//!
//! Wᵢₖ = Aᵢₖ = Lᵢₖ Sₖ,  Aᵢⱼ ← Aᵢⱼ − Wᵢₖ Lⱼₖᵀ for k < j ≤ i ≤ k + w.
//!
//! A block column is three columns of 3w numbers each, so that an update is a sum of three multiples of contiguous columns.
//! Cost: 27 w² flops per row to factor, 36 w to solve. Memory: 9w numbers per row; pivots lie in the scene's own.
//! [`crate::Wide`] around it solves a chain's islands in lanes ([`crate::wide::pieces`]), the others in this way.
//! Exact up to rounding, which the certificate measures; see [`super::direct`] for refinement and what happens when a
//! pivot fails.
//!
//! Source: Golub & Van Loan, *Matrix Computations*, §4.3 (banded LDLᵀ).

use crate::error::StepError;
use crate::force::Force;
use crate::memory::{Memory, part};
use crate::parts::Matrix;
use crate::real::Real;
use crate::report::Solve;
use crate::scene::MassSpring;
use crate::solver::chain;
use crate::solver::direct::{self, Factors, Kept};
use crate::solver::panel::{Block, below, divided, first, subtract, three, three_mut};
use crate::solver::pivot::inverse;
use crate::solver::{Problem, Solver, Stop};
use crate::sym3::Sym3;
use crate::system::System;
use crate::vec3::{self, Vec3};
use crate::wide::{Dispatch, Preconditions, Wide, Widened, direct as in_lanes, piece_rows};

/// Block-banded LDLᵀ in a workspace of the caller's: an array, a borrowed slice, a vector.
///
/// ```
/// use hooke::{BandedLdl, LinearlyImplicitEuler, Scene};
/// const ROOM: usize = BandedLdl::needs(40, 1); // A rope: each particle is tied to the next.
/// let mut rope = Box::new(Scene::<f32, 40, 39>::new());
/// for i in 0..40 {
///     rope.particle([0.1 * i as f32, 0.0, 0.0], 0.010)?;
/// }
/// for i in 1..40 {
///     rope.spring(i - 1, i, 1_000.0)?;
/// }
/// rope.pin(0)?;
/// let mut euler = LinearlyImplicitEuler::new(1.0 / 60.0)
///     .gravity([0.0, -9.81, 0.0])
///     .solver(BandedLdl::new([0.0; ROOM]));
/// let report = rope.step(&mut euler)?;
/// assert_eq!(report.iterations, 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct BandedLdl<B> {
    workspace: B,
    kept: Kept,
}

impl BandedLdl<()> {
    /// How many numbers an island of so many free particles needs, none tied to one more than `half_bandwidth` rows
    /// away. Islands share the workspace: the largest need counts.
    pub const fn needs(particles: usize, half_bandwidth: usize) -> usize {
        particles.saturating_mul(half_bandwidth).saturating_mul(9)
    }

    /// How many numbers a scene needs as its pins and springs are now.
    pub fn needs_of<M: Memory>(scene: &mut MassSpring<M>) -> usize {
        let parts = scene.parts();
        let mut most = 0;
        for words in parts.islands.islands() {
            let island = crate::islands::Island::unpack(*words);
            let own = part(&parts.islands.own, island.slots());
            let other = part(&parts.islands.other, island.springs());
            let needs = Self::needs(island.particles, half_bandwidth(own, other));
            most = if needs > most { needs } else { most };
        }
        most
    }

    /// The same for [`crate::Wide`] around it, and behind that what [`crate::Wide`] needs itself, numbers and words: nothing
    /// if no island is solved in lanes. That are those whose springs join particle i to i + 1, 64 or more places of them.
    pub fn needs_in_lanes_of<M: Memory>(scene: &mut MassSpring<M>, damped: bool) -> (usize, (usize, usize)) {
        let mut most = Self::needs_of(scene);
        let lanes = Wide::needs_where(scene, damped, |layout| {
            let takes = is_chain(layout.distances(), layout.places);
            let needs = piece_rows::KEPT.saturating_mul(layout.places);
            most = if takes && needs > most { needs } else { most };
            takes
        });
        (most, lanes)
    }
}

/// Is an island of this shape solved in lanes? Less than eight rows to a piece are not worth it.
fn is_chain(distances: &[u32], places: usize) -> bool {
    distances == [1] && places >= 64
}

impl<B> BandedLdl<B> {
    /// A solver in this workspace; [`BandedLdl::needs`] says how large it is to be. If it is too small, a step fails with
    /// [`StepError::Workspace`], which says so too.
    pub const fn new(workspace: B) -> Self {
        Self { workspace, kept: Kept::nothing() }
    }
}

/// The farthest that a spring reaches.
fn half_bandwidth(own: &[u32], other: &[u32]) -> usize {
    let (rows, mut others, mut most) = (own.len(), other.iter(), 0);
    for (row, own) in own.iter().enumerate() {
        for other in others.by_ref().take(*own as usize) {
            let (other, reach) = (*other as usize, (*other as usize).saturating_sub(row));
            most = if other < rows && reach > most { reach } else { most };
        }
    }
    most
}

impl<T: Real, B: AsMut<[T]>> Solver<T> for BandedLdl<B> {
    fn solve<F: Force<T>>(
        &mut self,
        problem: Problem<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        let Matrix { own, other, .. } = problem.system.matrix;
        let width = half_bandwidth(own, other);
        let numbers = BandedLdl::needs(own.len(), width);
        let Self { workspace, kept } = self;
        let Some(workspace) = workspace.as_mut().get_mut(..numbers) else {
            return Err(StepError::Workspace { numbers, words: 0 });
        };
        Ok(if width <= 1 {
            direct::solve(problem, stop, &mut Chain { towards: workspace.as_chunks_mut().0 }, kept)
        } else {
            direct::solve(problem, stop, &mut Band { width, columns: workspace }, kept)
        })
    }
    fn again<F: Force<T>>(
        &mut self,
        problem: Problem<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        self.kept.again();
        self.solve(problem, stop)
    }
}

impl<T: Real, B: AsMut<[T]>> Preconditions<T> for BandedLdl<B> {
    fn takes(distances: &[u32], places: usize) -> bool {
        is_chain(distances, places)
    }

    fn solve_in_lanes<F: Force<T>, D: Dispatch>(
        &mut self,
        lanes: Widened<'_, '_, T, F, D>,
        x: &mut [Vec3<T>],
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        let places = lanes.layout.places;
        let numbers = piece_rows::KEPT.saturating_mul(places);
        let rows = piece_rows::cut(self.workspace.as_mut(), places);
        let rows = rows.ok_or(StepError::Workspace { numbers, words: 0 })?;
        Ok(in_lanes::solve(lanes, rows, x, stop))
    }
}

/// w ≤ 1
struct Chain<'a, T> {
    towards: &'a mut [chain::Towards<T>],
}

impl<T: Real> Factors<T> for Chain<'_, T> {
    fn factor<F: Force<T>>(&mut self, system: &System<'_, T, F>, pivots: &mut [[T; 6]]) -> bool {
        chain::factor(system, pivots, self.towards)
    }
    fn solve(&mut self, pivots: &[[T; 6]], x: &mut [Vec3<T>]) {
        chain::solve(pivots, self.towards, x);
    }
}

/// w > 1
struct Band<'a, T> {
    width: usize,
    /// The block columns below the diagonal, 9w numbers each
    columns: &'a mut [T],
}

impl<T: Real> Band<'_, T> {
    /// Numbers of a block column; not 0, so that a slice can be cut into such.
    fn length(&self) -> usize {
        (9 * self.width).max(1)
    }

    /// A below its diagonal, by columns.
    fn assemble<F: Force<T>>(&mut self, system: &System<'_, T, F>) {
        let (length, rows) = (self.length(), system.particles());
        for number in self.columns.iter_mut() {
            *number = T::ZERO;
        }
        system.each_spring(|row, other, h| {
            let column = self.columns.chunks_exact_mut(length).nth(row).and_then(three_mut);
            let (Some(column), true) = (column, other < rows) else { return };
            let from = 3 * (other.saturating_sub(row).saturating_sub(1));
            for (column, block) in column.into_iter().zip(h.dense()) {
                for (a, h) in column.iter_mut().skip(from).zip(block) {
                    *a -= h;
                }
            }
        });
    }
}

impl<T: Real> Factors<T> for Band<'_, T> {
    #[inline(never)]
    fn factor<F: Force<T>>(&mut self, system: &System<'_, T, F>, pivots: &mut [[T; 6]]) -> bool {
        system.diagonal(pivots);
        self.assemble(system);
        let length = self.length();
        let (mut pivots, mut columns): (&mut [[T; 6]], &mut [T]) = (pivots, self.columns);
        loop {
            let Some((pivot, later)) = pivots.split_first_mut() else { return true };
            let Some((column, rest)) = columns.split_at_mut_checked(length) else { return true };
            let Some(inverted) = inverse(Sym3(*pivot)) else { return false };
            *pivot = inverted.0;
            let Some(w) = three(column) else { return false };
            let targets = later.iter_mut().zip(rest.chunks_exact_mut(length));
            for (t, (pivot, target)) in targets.enumerate().take(self.width) {
                let block = first(below(w, t));
                let l = divided(block, &inverted);
                take_from(pivot, &block, &l);
                if let Some(target) = three_mut(target) {
                    subtract(target, below(w, t + 1), &l);
                }
            }
            (pivots, columns) = (later, rest);
        }
    }

    #[inline(never)]
    fn solve(&mut self, pivots: &[[T; 6]], x: &mut [Vec3<T>]) {
        let length = self.length();
        let mut rest = &mut *x;
        for (column, pivot) in self.columns.chunks_exact(length).zip(pivots) {
            let (Some((first, below)), Some([a, b, c])) = (rest.split_first_mut(), three(column)) else {
                break;
            };
            let v = Sym3(*pivot).mul(*first);
            for (((y, a), b), c) in below.as_flattened_mut().iter_mut().zip(a).zip(b).zip(c) {
                *y -= (*a * v[0] + *b * v[1]) + *c * v[2];
            }
            rest = below;
        }
        let mut end = x.len();
        for (column, pivot) in self.columns.chunks_exact(length).zip(pivots).rev() {
            end = end.saturating_sub(1);
            let (Some((_, from)), Some(w)) = (x.split_at_mut_checked(end), three(column)) else { break };
            let Some((first, below)) = from.split_first_mut() else { break };
            let sums = w.map(|column| inner(column, below));
            *first = Sym3(*pivot).mul(vec3::sub(*first, sums));
        }
    }
}

/// S −= W Lᵀ, a symmetric product of two blocks.
#[inline(always)]
fn take_from<T: Real>(pivot: &mut [T; 6], w: &Block<T>, l: &Block<T>) {
    let [xx, yy, zz, xy, xz, yz] = *pivot;
    *pivot = [
        xx - vec3::dot(w[0], l[0]),
        yy - vec3::dot(w[1], l[1]),
        zz - vec3::dot(w[2], l[2]),
        xy - vec3::dot(w[1], l[0]),
        xz - vec3::dot(w[2], l[0]),
        yz - vec3::dot(w[2], l[1]),
    ];
}

/// wᵀx, with one sum for each component of a row.
#[inline(always)]
fn inner<T: Real>(w: &[T], x: &[Vec3<T>]) -> T {
    let mut sum = [T::ZERO; 3];
    for (w, x) in w.as_chunks::<3>().0.iter().zip(x) {
        sum = [sum[0] + w[0] * x[0], sum[1] + w[1] * x[1], sum[2] + w[2] * x[2]];
    }
    (sum[0] + sum[1]) + sum[2]
}
