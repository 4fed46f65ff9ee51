//! Block D-ILU: PCG with the incomplete factorization M = (P + L) P⁻¹ (P + Lᵀ), by Eisenstat's trick
//! ([`super::eisenstat`]).
//!
//! L is A's own part below the diagonal, without fill; the 3×3 pivots are chosen such that M has A's diagonal blocks:
//!
//! Pᵢ = Dᵢ − Eᵢ,  Eᵢ = Σ_{j<i} Hᵢⱼ Pⱼ⁻¹ Hᵢⱼ,  Hᵢⱼ = −Aᵢⱼ the sum of all springs between i and j.
//!
//! Where A has no fill (chains, trees whose particles are numbered from the leaves) M = A.
//!
//! **No breakdown where A is certified.** With |H| = |α|(I − uuᵀ) + (α + |w|²)uuᵀ ⪰ ±H of each spring, and Gᵢⱼ = Σ|H| of
//! those between i and j, Pᵢ ⪰ μᵢ I + Σ_{j>i} Gᵢⱼ for every row, by induction: it gives Pⱼ ⪰ Gᵢⱼ, so Hᵢⱼ Pⱼ⁻¹ Hᵢⱼ ⪯ Hᵢⱼ
//! Gᵢⱼ⁻¹ Hᵢⱼ ⪯ Gᵢⱼ since −G ⪯ H ⪯ G; what is left of Dᵢ is at least m̃ᵢI + Σ_{j>i} Hᵢⱼ + Σ_{j<i} (Hᵢⱼ − Gᵢⱼ) + (pins, points) ⪰ (m̃ᵢ
//! − Σ_e c_e max(0, −αₑ)) I + Σ_{j>i} Gᵢⱼ, and the bracket is μᵢ.
//!
//! **Breakdown in rounded arithmetic** (condition above 1/u). A Pᵢ with a scalar pivot that is not positive is replaced by
//! Dᵢ; and where Dᵢ has one too, the island is left to [`BlockJacobi`]. [`Solve::fallback`] says so in both cases. M stays
//! symmetric and positive, since it is (P + L)P⁻¹(P + L)ᵀ with positive P.
//!
//! Not where [`crate::Ssor`] serves: with as many iterations it takes 1.1 to 1.2 times the time (on cloth:64 180 iterations
//! and 25.3 ms, SSOR 165 and 20.6; on the bunny of the design 13 and 0.54, SSOR 13 and 0.48; block Jacobi 37.6 and 0.75). On
//! a chain it is exact, but takes twice the time of [`crate::BandedLdl`] (chain:1000: 0.17 and 0.084 ms). It is for what is
//! nearly a chain or a tree. (R = 1e-6; `cargo run --release -p hooke-benches --bin compare`, and with the mesh.)
//!
//! Cost: of the pivots 100 flops per spring and 40 per particle. Memory: 12 numbers per particle.
//!
//! Source: Meijerink & van der Vorst 1977; Pommerell 1992 (D-ILU); the bound on P is this crate's own.

use crate::error::StepError;
use crate::force::Force;
use crate::real::Real;
use crate::report::Solve;
use crate::solver::eisenstat::{Eisenstat, Excess, Sums};
use crate::solver::triangle::Springs;
use crate::solver::{BlockJacobi, Jacobi, Preconditioner, Problem, Solver, Stop, pcg};
use crate::sym3::Sym3;
use crate::system::System;
use crate::vec3::{self, Vec3};

/// Block-D-ILU PCG in a workspace of the caller's: an array, a borrowed slice, a vector.
///
/// ```
/// use hooke::{BlockIlu, LinearlyImplicitEuler, Scene};
/// const ROOM: usize = BlockIlu::needs(40);
/// let mut rope = Box::new(Scene::<f32, 40, 39>::new());
/// for i in 0..40 {
///     rope.particle([0.1 * i as f32, 0.0, 0.0], 0.010)?;
/// }
/// for i in 1..40 {
///     rope.spring(i - 1, i, 1_000.0)?;
/// }
/// rope.pin(0)?;
/// let mut euler =
///     LinearlyImplicitEuler::new(1.0 / 60.0).gravity([0.0, -9.81, 0.0]).solver(BlockIlu::new([0.0; ROOM]));
/// let report = rope.step(&mut euler)?;
/// assert_eq!(report.iterations, 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct BlockIlu<B> {
    workspace: B,
}

impl BlockIlu<()> {
    /// How many numbers an island of so many free particles needs, whatever its springs: 12 per particle. Islands share
    /// the workspace: the largest need counts.
    pub const fn needs(particles: usize) -> usize {
        particles.saturating_mul(12)
    }
}

impl<B> BlockIlu<B> {
    /// A solver in this workspace; [`BlockIlu::needs`] says how large it is to be. If it is too small, a step fails with
    /// [`StepError::Workspace`], which says so too.
    pub const fn new(workspace: B) -> Self {
        Self { workspace }
    }

    /// z = M⁻¹ r for a system's A; answers rᵀz. `blocks` is room for a block per row. For tests and for other iterations.
    ///
    /// # Errors
    /// [`StepError::Workspace`] if the workspace is too small.
    pub fn apply<T: Real, F: Force<T>>(
        &mut self,
        system: &System<'_, T, F>,
        blocks: &mut [[T; 6]],
        r: &[Vec3<T>],
        z: &mut [Vec3<T>],
    ) -> Result<T, StepError>
    where
        B: AsMut<[T]>,
    {
        Ok(match prepare(system, blocks, self.workspace.as_mut())? {
            Some(mut by) => by.apply(system, r, z),
            None => Jacobi::new(system, blocks).apply(r, z),
        })
    }
}

/// E, a block per row, and whether a pivot was replaced.
struct Stored<'a, T> {
    blocks: &'a [[T; 6]],
    replaced: bool,
}

impl<T: Real> Excess<T> for Stored<'_, T> {
    #[inline(always)]
    fn times(&self, row: usize, p: Vec3<T>, _: Vec3<T>) -> Vec3<T> {
        self.blocks.get(row).map_or([T::ZERO; 3], |block| Sym3(*block).mul(p))
    }
}

/// The iteration with P⁻¹ in `blocks`; `None` if a block of D is not positive.
#[inline(never)]
fn prepare<'a, T: Real, F: Force<T>>(
    system: &System<'_, T, F>,
    blocks: &'a mut [[T; 6]],
    workspace: &'a mut [T],
) -> Result<Option<Eisenstat<'a, T, Stored<'a, T>>>, StepError> {
    let numbers = BlockIlu::needs(system.particles());
    let lacks = StepError::Workspace { numbers, words: 0 };
    let workspace = workspace.get_mut(..numbers).ok_or(lacks)?;
    let (sums, excess) = workspace.split_at_mut_checked(numbers / 2).ok_or(lacks)?;
    let excess = excess.as_chunks_mut().0;
    let Some(replaced) = factor(system, blocks, excess, sums.as_chunks_mut().0) else { return Ok(None) };
    let sums: &mut [Sums<T>] = sums.as_chunks_mut().0.as_chunks_mut().0;
    Ok(Some(Eisenstat { inverse: blocks, excess: Stored { blocks: excess, replaced }, sums }))
}

/// P⁻¹ into `blocks` and E; answers whether a pivot was replaced. `pairs` is room for Hᵢⱼ of the row at hand.
#[inline(never)]
fn factor<T: Real, F: Force<T>>(
    system: &System<'_, T, F>,
    blocks: &mut [[T; 6]],
    excess: &mut [[T; 6]],
    pairs: &mut [[T; 6]],
) -> Option<bool> {
    system.diagonal(blocks);
    excess.fill([T::ZERO; 6]);
    pairs.fill([T::ZERO; 6]);
    let mut springs = Springs::of(system.matrix);
    let mut replaced = false;
    for (row, (own, block)) in system.matrix.own.iter().zip(blocks).enumerate() {
        let own = springs.first(*own);
        let e = excess.get_mut(row)?;
        let pivot = Sym3(combined(block, e, |d, e| d - e)).inverse();
        if pivot.is_none() {
            (*e, replaced) = ([T::ZERO; 6], true);
        }
        let inverse = pivot.or_else(|| Sym3(*block).inverse())?;
        *block = inverse.0;
        own.blocks(pairs.len(), |other, h| {
            if let Some(pair) = pairs.get_mut(other) {
                *pair = combined(pair, &h.0, |sum, h| sum + h);
            }
        });
        own.blocks(excess.len(), |other, _| {
            if let (Some(pair), Some(e)) = (pairs.get_mut(other), excess.get_mut(other)) {
                *e = combined(e, &congruent(Sym3(*pair), inverse), |sum, e| sum + e);
                // The next spring between the same rows, if there is one, finds it done.
                *pair = [T::ZERO; 6];
            }
        });
    }
    Some(replaced)
}

/// Two blocks entry by entry.
#[inline(always)]
fn combined<T: Real>(a: &[T; 6], b: &[T; 6], f: impl Fn(T, T) -> T) -> [T; 6] {
    let mut out = *a;
    for (out, b) in out.iter_mut().zip(b) {
        *out = f(*out, *b);
    }
    out
}

/// H P⁻¹ H
#[inline(always)]
fn congruent<T: Real>(h: Sym3<T>, inverse: Sym3<T>) -> [T; 6] {
    let columns = h.dense();
    let [x, y, z] = columns;
    let [px, py, pz] = columns.map(|column| inverse.mul(column));
    [
        vec3::dot(x, px),
        vec3::dot(y, py),
        vec3::dot(z, pz),
        vec3::dot(x, py),
        vec3::dot(x, pz),
        vec3::dot(y, pz),
    ]
}

impl<T: Real, B: AsMut<[T]>> Solver<T> for BlockIlu<B> {
    fn solve<F: Force<T>>(
        &mut self,
        problem: Problem<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        let Problem { system, vectors, block, free } = problem;
        if let Some(mut by) = prepare(&system, block, self.workspace.as_mut())? {
            let solve = pcg::solve_by(&system, &mut by, vectors, stop, free);
            return Ok(Solve { fallback: by.excess.replaced, ..solve });
        }
        let solve = BlockJacobi.solve(Problem { system, vectors, block, free }, stop)?;
        Ok(Solve { fallback: true, ..solve })
    }
}
