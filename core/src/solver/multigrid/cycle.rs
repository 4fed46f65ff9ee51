//! The cycle: B ≈ A⁻¹, a fixed symmetric positive operator, in f32.
//!
//! On a level: Chebyshev-weighted block Jacobi, r ← Pᵀ(r − A x) one level down, two cycles there (a W), x ← x + ω P x_c, the
//! same smoothing. The coarsest level is solved by its factors or, if it has none, smoothed once more.
//!
//! λ(D⁻¹A) ≤ 2 on every level, since an edge's [H −H; −H H] ⪯ 2 diag(H, H), and 2 is attained: hence the interval [1/3, 2].
//! Smoothing contracts in the A-norm and is symmetric; I − ω P A_c⁻¹PᵀA too for 0 < ω < 2, and two cycles on a level leave
//! an error (I − B A)² ⪰ 0: so B is positive on every level. ω > 1 since piecewise constant functions are too stiff.
//!
//! Levels are walked by a loop: which cycle it is on each level is one bit of a word.
//!
//! Sources: Notay 2010; Adams, Brezina, Hu & Tuminaro 2003 (polynomial smoothing).

use super::dense::Dense;
use super::level::Level;
use super::sizes::{LEVELS, UNKNOWNS};
use super::sweep::Stage;
use crate::wide::Dispatch;

/// Centre and half width of [1/3, 2].
const CENTRE: f32 = 7.0 / 6.0;
const HALF: f32 = 5.0 / 6.0;
/// Chebyshev's factors of two steps: x₁ = c₀ D⁻¹r, d₂ = a d₁ + c D⁻¹r.
const RATIO: f32 = HALF / CENTRE;
const NEXT: f32 = 1.0 / (2.0 / RATIO - RATIO);
const FIRST: f32 = 1.0 / CENTRE;
const KEEP: f32 = NEXT * RATIO;
const STEP: f32 = 2.0 * NEXT / HALF;
/// ω
const OVER: f32 = 1.5;

/// From x = 0.
const DOWN: [Stage; 3] = [Stage::Start(FIRST), Stage::Smooth(KEEP, STEP), Stage::Restrict];
/// From an x whose last change is not yet in r.
const DOWN_AGAIN: [Stage; 3] = [Stage::Smooth(0.0, FIRST), Stage::Smooth(KEEP, STEP), Stage::Restrict];
const UP: [Stage; 3] = [Stage::Prolong(OVER), Stage::Smooth(0.0, FIRST), Stage::Smooth(KEEP, STEP)];
/// Where there is no next level.
const ONLY: [Stage; 2] = [Stage::Start(FIRST), Stage::Smooth(KEEP, STEP)];

/// The levels of an island and the factors of the coarsest.
pub(super) struct Hierarchy<'a> {
    pub(super) levels: [Option<Level<'a>>; LEVELS],
    pub(super) count: usize,
    pub(super) dense: Dense<'a>,
}

impl Level<'_> {
    /// x = A⁻¹ r, or some steps towards it.
    fn solve(&mut self, dense: &Dense<'_>, dispatch: impl Dispatch) {
        if !dense.sound {
            self.sweep(None, &ONLY, dispatch);
            return;
        }
        let mut y = [0.0; UNKNOWNS];
        for (i, y) in y.as_chunks_mut::<3>().0.iter_mut().enumerate().take(self.pattern.size.rows) {
            *y = self.r.at(i);
        }
        dispatch.run(
            #[inline(always)]
            || dense.solve(&mut y),
        );
        for (i, y) in y.as_chunks::<3>().0.iter().enumerate().take(self.pattern.size.rows) {
            self.x.put(i, *y);
        }
    }
}

impl<'a> Hierarchy<'a> {
    /// x = B r on the finest level.
    pub(super) fn cycle(&mut self, dispatch: impl Dispatch) {
        let last = self.count.saturating_sub(1);
        // Bit l: level l is on its second cycle.
        let (mut l, mut second) = (0_usize, 0_u32);
        loop {
            // Down.
            while l < last {
                let Some((fine, coarse)) = self.pair(l) else { return };
                let stages = if second & (1 << l) == 0 { &DOWN } else { &DOWN_AGAIN };
                fine.sweep(Some(coarse), stages, dispatch);
                l += 1;
                second &= !(1 << l);
            }
            let dense = &self.dense;
            if let Some(Some(coarsest)) = self.levels.get_mut(last) {
                coarsest.solve(dense, dispatch);
            }
            // Up, until a level has its second cycle before it.
            loop {
                if l == 0 {
                    return;
                }
                if l < last && second & (1 << l) == 0 {
                    second |= 1 << l;
                    break;
                }
                l -= 1;
                let Some((fine, coarse)) = self.pair(l) else { return };
                fine.sweep(Some(coarse), &UP, dispatch);
            }
        }
    }

    /// Level l and the next.
    fn pair(&mut self, l: usize) -> Option<(&mut Level<'a>, &mut Level<'a>)> {
        let (first, rest) = self.levels.split_at_mut_checked(l + 1)?;
        Some((first.last_mut()?.as_mut()?, rest.first_mut()?.as_mut()?))
    }
}
