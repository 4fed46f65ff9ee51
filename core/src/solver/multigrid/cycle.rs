//! The cycle: B ≈ A⁻¹, a fixed symmetric positive operator, in f32.
//!
//! On a level: Chebyshev-weighted block Jacobi (three steps on the finest, two elsewhere), r ← Pᵀ(r − A x) one level down, two
//! cycles there (a W), x ← x + P x_c, the same smoothing. The coarsest level is solved by its factors or, if it has none,
//! smoothed once more.
//!
//! λ(D⁻¹A) ≤ 2 on every level, since an edge's [H −H; −H H] ⪯ 2 diag(H, H), and 2 is attained: hence the interval [1/5, 2].
//! Smoothing contracts in the A-norm and is symmetric; I − P A_c⁻¹PᵀA too, since A_c = Pᵀ(M + K/ω)P ⪰ PᵀAP/ω with 1 ≤ ω < 2, and
//! two cycles on a level leave an error (I − B A)² ⪰ 0: so B is positive on every level. ω > 1 since piecewise constant functions
//! are too stiff. It divides the springs alone: x ← x + ω P x_c with A_c = PᵀAP, as it was, moves what masses rule too far, and
//! takes a tenth more iterations on cloths at 1/1000 s, about as many at 1/60 s.
//!
//! Measured and not kept (iterations at R = 1e-6, cloth:64 and cloth:128, worst state, with two steps everywhere 25 and 93):
//! a K-cycle, or six cycles where two are made now, 25 and 99: it is not the cycle that limits. Aggregates of four 21 and 85,
//! at 1.5 times the work. A V 32 and 116. Block Gauss-Seidel instead of two steps 29 and 107. A prolongator smoothed with
//! scalar weights (the levels stay nets of springs) 20 and 73, with blocks 14 and 74, at three times the edges on the next
//! level. What does limit are wrinkles of one or two cells, which no function that is constant on eight particles follows. Two
//! levels, the second solved exactly, three steps, R = 1e-6, states of t = 0.3 and 0.4 s, cloth:256 at 1/1000 s and at 1/60 s:
//! aggregates of 4×2 35 and 64, of 8×1 40 and 83, of 1×8 26 and 78, of 2×2 32 and 53; of 2×2 with six rigid motions each 11 and
//! 12, but of 4×4 so 34 and 46: only a level of half the unknowns of the finest would help, which costs twice the finest, and
//! with the levels that it needs itself twice as many iterations again (cloth:128 at 1/60 s: 11 become 23 of three times the work).
//!
//! Levels are walked by a loop: which cycle it is on each level is one bit of a word.
//!
//! Sources: Notay 2010; Adams, Brezina, Hu & Tuminaro 2003 (polynomial smoothing).

use super::dense::Dense;
use super::level::Level;
use super::sizes::{LEVELS, UNKNOWNS};
use super::sweep::Stage;
use crate::wide::Dispatch;

/// Lower ends of the intervals.
const FINE_FROM: f32 = 0.2;
const COARSE_FROM: f32 = 0.2;

/// The factors (a, c) of Chebyshev's steps d = a d + c D⁻¹r on [from, 2].
const fn chebyshev<const STEPS: usize>(from: f32) -> [Stage; STEPS] {
    let (centre, half) = ((2.0 + from) / 2.0, (2.0 - from) / 2.0);
    let ratio = half / centre;
    let mut steps = [Stage::Smooth(0.0, 1.0 / centre); STEPS];
    let (mut before, mut rest) = (ratio, steps.as_mut_slice());
    while let [_, next @ ..] = rest {
        if let [step, ..] = next {
            let now = 1.0 / (2.0 / ratio - before);
            *step = Stage::Smooth(now * before, 2.0 * now / half);
            before = now;
        }
        rest = next;
    }
    steps
}

const FINE: [Stage; 3] = chebyshev(FINE_FROM);
const COARSE: [Stage; 2] = chebyshev(COARSE_FROM);

/// The same step from x = d = 0.
const fn start(step: Stage) -> Stage {
    match step {
        Stage::Smooth(_, c) => Stage::Start(c),
        other => other,
    }
}

/// The finest level.
const FINE_DOWN: [Stage; 4] = [start(FINE[0]), FINE[1], FINE[2], Stage::Restrict];
const FINE_UP: [Stage; 4] = [Stage::Prolong, FINE[0], FINE[1], FINE[2]];
/// The finest level where any z will do.
const ROUGH_DOWN: [Stage; 2] = [start(COARSE[0]), Stage::Restrict];
const ROUGH_UP: [Stage; 2] = [Stage::Prolong, COARSE[0]];
/// The others.
const DOWN: [Stage; 3] = [start(COARSE[0]), COARSE[1], Stage::Restrict];
/// From an x whose last change is not yet in r.
const DOWN_AGAIN: [Stage; 3] = [COARSE[0], COARSE[1], Stage::Restrict];
const UP: [Stage; 3] = [Stage::Prolong, COARSE[0], COARSE[1]];
/// Where there is no next level.
const ONLY: [Stage; 2] = [start(COARSE[0]), COARSE[1]];

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
        dense.solve(&mut y, dispatch);
        for (i, y) in y.as_chunks::<3>().0.iter().enumerate().take(self.pattern.size.rows) {
            self.x.put(i, *y);
        }
    }
}

impl<'a> Hierarchy<'a> {
    /// x = B r on the finest level.
    #[inline(always)]
    pub(super) fn cycle(&mut self, dispatch: impl Dispatch) {
        self.cycle_by([&FINE_DOWN, &FINE_UP], dispatch);
    }

    /// The same with one step each way on the finest level, two products of six, and no symmetry: a z for the lower bound. (With
    /// none up, one product of six, √(upper/lower) was 1.2 times as large; with three each way it is 0.85 of this.)
    pub(super) fn rough_cycle(&mut self, dispatch: impl Dispatch) {
        self.cycle_by([&ROUGH_DOWN, &ROUGH_UP], dispatch);
    }

    #[inline(never)]
    fn cycle_by(&mut self, [fine_down, fine_up]: [&[Stage]; 2], dispatch: impl Dispatch) {
        let last = self.count.saturating_sub(1);
        // Bit l: level l is on its second cycle.
        let (mut l, mut second) = (0_usize, 0_u32);
        loop {
            // Down.
            while l < last {
                let Some((fine, coarse)) = self.pair(l) else { return };
                let stages = if l == 0 {
                    fine_down
                } else if second & (1 << l) == 0 {
                    &DOWN[..]
                } else {
                    &DOWN_AGAIN[..]
                };
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
                let stages = if l == 0 { fine_up } else { &UP[..] };
                fine.sweep(Some(coarse), stages, dispatch);
            }
        }
    }

    /// Level l and the next.
    fn pair(&mut self, l: usize) -> Option<(&mut Level<'a>, &mut Level<'a>)> {
        let (first, rest) = self.levels.split_at_mut_checked(l + 1)?;
        Some((first.last_mut()?.as_mut()?, rest.first_mut()?.as_mut()?))
    }
}
