//! What a cycle does on a level, in one sweep over its rows: the stages follow one another some rows apart, so that blocks and
//! vectors are still in the nearest cache when the next stage needs them.
//!
//! With loose edges every stage needs a sweep of its own.

use super::block::{Full, Kind, Tied};
use super::level::Level;
use super::planes::{Planes, read, write};
use super::product::{subtract, subtract_held, subtract_loose};
use super::tile::{Tile6, WIDTH, add3, scale, symmetric};
use super::transfer::{gather, scatter};
use crate::wide::Dispatch;

/// What is done to a row. d is the last change of x, which r does not know of yet.
#[derive(Debug, Clone, Copy)]
pub(super) enum Stage {
    /// x = d = c D⁻¹r
    Start(f32),
    /// d = P x of the next level, x += d
    Prolong,
    /// r −= A d; d = a d + c D⁻¹r, x += d
    Smooth(f32, f32),
    /// r −= A d; r of the next level += Pᵀr
    Restrict,
}

/// At most so many stages in a sweep.
const STAGES: usize = 8;
/// Rows at a time.
const BLOCK: usize = 128;

impl Level<'_> {
    /// All stages, in their order. The next level is read or written by those that name it.
    #[inline(never)]
    pub(super) fn sweep(&mut self, next: Option<&mut Level<'_>>, stages: &[Stage], dispatch: impl Dispatch) {
        let mut none = [Planes([&mut [], &mut [], &mut []]), Planes([&mut [], &mut [], &mut []])];
        let [x, r] = &mut none;
        let (x, r) = match next {
            Some(next) => (&mut next.x, &mut next.r),
            None => (x, r),
        };
        if stages.iter().any(|stage| matches!(stage, Stage::Restrict)) {
            r.clear();
        }
        if self.loose.is_empty() {
            self.together(x, r, stages, dispatch);
        } else {
            for stage in stages {
                if matches!(stage, Stage::Smooth(..) | Stage::Restrict) {
                    let [d, _] = &self.d;
                    subtract_loose(&self.pattern.loose, self.loose, d, &mut self.r);
                }
                self.together(x, r, core::slice::from_ref(stage), dispatch);
            }
        }
    }

    #[inline(always)]
    fn together(&mut self, x: &Planes<'_>, r: &mut Planes<'_>, stages: &[Stage], dispatch: impl Dispatch) {
        if self.tied {
            dispatch.run(
                #[inline(always)]
                || self.walk::<Tied>(x, r, stages),
            );
        } else {
            dispatch.run(
                #[inline(always)]
                || self.walk::<Full>(x, r, stages),
            );
        }
    }

    #[inline(always)]
    fn walk<K: Kind>(&mut self, coarse_x: &Planes<'_>, coarse_r: &mut Planes<'_>, stages: &[Stage]) {
        let rows = self.pattern.size.rows.next_multiple_of(WIDTH);
        // A stage needs what the one before has left in all rows that edges lead to.
        let lag = self.pattern.size.extent.farthest.next_multiple_of(WIDTH) + WIDTH;
        let mut held = [0; STAGES];
        let Self { pattern, held_count, blocks, mass, held: held_blocks, inverse, x, r, d, .. } = self;
        let held_rows = pattern.held_rows.get(..*held_count).unwrap_or_default();
        let [even, odd] = d;
        let mut end = BLOCK;
        let last = rows + lag * stages.len().saturating_sub(1);
        while end < last + BLOCK {
            for ((number, stage), held) in stages.iter().enumerate().zip(&mut held) {
                // Rows from i to here.
                let to = end.saturating_sub(lag * number);
                let i = to.saturating_sub(BLOCK);
                let to = if to < rows { to } else { rows };
                let n = to.saturating_sub(i);
                if n == 0 {
                    continue;
                }
                let (d, next) = if number % 2 == 0 { (&*even, &mut *odd) } else { (&*odd, &mut *even) };
                // Two questions after one another: a table of jumps would leave the stack without a bound.
                if matches!(stage, Stage::Smooth(..) | Stage::Restrict) {
                    subtract::<K>(&pattern.strips, blocks, d, mass, r, [i, n]);
                    subtract_held(held_rows, held_blocks, held, i + n, d, r);
                    if let Stage::Smooth(a, c) = *stage {
                        smooth([a, c], inverse, r, d, x, next, [i, n]);
                    } else {
                        scatter(pattern.aggregate, r, coarse_r, [i, n]);
                    }
                } else if let Stage::Start(c) = *stage {
                    start(c, inverse, r, x, next, [i, n]);
                } else if matches!(stage, Stage::Prolong) {
                    prolong(pattern.aggregate, coarse_x, x, next, [i, n]);
                }
            }
            end += BLOCK;
        }
        // Each stage that changes d leaves it in the other place.
        let changes = stages.iter().filter(|stage| !matches!(stage, Stage::Restrict)).count();
        if changes % 2 == 1 {
            self.d.swap(0, 1);
        }
    }
}

/// Those of n rows from i on.
#[inline(always)]
fn blocks(inverse: &[Tile6], [i, n]: [usize; 2]) -> core::slice::Iter<'_, Tile6> {
    inverse.get(i / WIDTH..(i + n) / WIDTH).unwrap_or_default().iter()
}

/// x = d = c D⁻¹r
#[inline(always)]
fn start(
    c: f32,
    inverse: &[Tile6],
    r: &Planes<'_>,
    x: &mut Planes<'_>,
    d: &mut Planes<'_>,
    [i, n]: [usize; 2],
) {
    let at = i + WIDTH;
    let solved = blocks(inverse, [i, n]).zip(r.tiles(at, n));
    for ((inverse, r), (x, d)) in solved.zip(x.tiles_mut(at, n).zip(d.tiles_mut(at, n))) {
        let change = scale([c; WIDTH], symmetric(*inverse, r));
        write(x, change);
        write(d, change);
    }
}

/// d = P x_c, x += d
#[inline(always)]
fn prolong(
    aggregate: &[u32],
    coarse: &Planes<'_>,
    x: &mut Planes<'_>,
    d: &mut Planes<'_>,
    [i, n]: [usize; 2],
) {
    gather(aggregate, coarse, d, [i, n]);
    let at = i + WIDTH;
    for (x, d) in x.tiles_mut(at, n).zip(d.tiles(at, n)) {
        let moved = add3(read(&x), d);
        write(x, moved);
    }
}

/// d = a d + c D⁻¹r, x += d
#[inline(always)]
fn smooth(
    [a, c]: [f32; 2],
    inverse: &[Tile6],
    r: &Planes<'_>,
    d: &Planes<'_>,
    x: &mut Planes<'_>,
    next: &mut Planes<'_>,
    [i, n]: [usize; 2],
) {
    let at = i + WIDTH;
    let known = blocks(inverse, [i, n]).zip(r.tiles(at, n)).zip(d.tiles(at, n));
    for (((inverse, r), d), (x, next)) in known.zip(x.tiles_mut(at, n).zip(next.tiles_mut(at, n))) {
        let z = symmetric(*inverse, r);
        let change = add3(scale([a; WIDTH], d), scale([c; WIDTH], z));
        let moved = add3(read(&x), change);
        write(x, moved);
        write(next, change);
    }
}
