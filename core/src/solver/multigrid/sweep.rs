//! What a cycle does on a level, in one sweep over its rows: the stages follow one another some rows apart, so that blocks and
//! vectors are still in the nearest cache when the next stage needs them.
//!
//! Edges go from a row to higher ones only. So once the edges of a block of rows are done, these rows' r is complete and their
//! d needed no more. The order of the sums (it makes the bits): loose edges, then block by block masses, runs by offset, and
//! held rows. With loose edges every stage needs a sweep of its own.
//!
//! Measured and not kept: each row gathering both of its edges of a run, so that nothing is scattered and an edge's force is
//! computed twice: a cycle on cloth:64 took 161 µs instead of 134. Tiles of 32 rows whose sums wait on the stack: 219 µs.

use super::block::{Full, Kind, Tied};
use super::level::{Level, each_run};
use super::planes::{Planes, Planes6, cut, read, write};
use super::runs::{Run, length};
use super::tile::{WIDTH, add3, scale, sub3, symmetric};
use crate::sym3::Sym3;
use crate::vec3;
use crate::wide::Dispatch;

/// What is done to a row. d is the last change of x, which r does not know of yet.
#[derive(Debug, Clone, Copy)]
pub(super) enum Stage {
    /// x = d = c D⁻¹r
    Start(f32),
    /// d = ω P x of the next level, x += d
    Prolong(f32),
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
                    self.subtract_loose();
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
        let farthest =
            self.pattern.runs.iter().fold(0, |most, run| if run[1] > most { run[1] } else { most });
        // A stage needs what the one before has left in all rows that edges lead to.
        let lag = (farthest as usize).next_multiple_of(WIDTH) + WIDTH;
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
                if matches!(stage, Stage::Smooth(..) | Stage::Restrict) {
                    subtract::<K>(pattern.runs, blocks, d, mass, r, next, [i, n]);
                    subtract_held(held_rows, held_blocks, held, i + n, d, r);
                }
                match *stage {
                    Stage::Start(c) => start(c, inverse, r, x, next, [i, n]),
                    Stage::Prolong(over) => prolong(over, pattern.aggregate, coarse_x, x, next, [i, n]),
                    Stage::Smooth(a, c) => smooth([a, c], inverse, r, d, x, next, [i, n]),
                    Stage::Restrict => scatter(pattern.aggregate, r, coarse_r, [i, n]),
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

    fn subtract_loose(&mut self) {
        let [a, b] = &self.pattern.loose;
        let ends = a.as_chunks::<WIDTH>().0.iter().zip(b.as_chunks::<WIDTH>().0);
        let [d, _] = &self.d;
        for (tile, (a, b)) in self.loose.iter().zip(ends) {
            let mut force = [[0.0; 3]; WIDTH];
            for (force, (a, b)) in force.iter_mut().zip(a.iter().zip(b)) {
                *force = vec3::sub(d.at(*a as usize), d.at(*b as usize));
            }
            let [xx, yy, zz, xy, xz, yz] = tile;
            let blocks = xx.iter().zip(yy).zip(zz).zip(xy.iter().zip(xz).zip(yz));
            for (force, (((xx, yy), zz), ((xy, xz), yz))) in force.iter_mut().zip(blocks) {
                *force = Sym3([*xx, *yy, *zz, *xy, *xz, *yz]).mul(*force);
            }
            for (force, (a, b)) in force.iter().zip(a.iter().zip(b)) {
                self.r.add(*a as usize, vec3::scale(-1.0, *force));
                self.r.add(*b as usize, *force);
            }
        }
    }
}

/// x = d = c D⁻¹r
#[inline(always)]
fn start(
    c: f32,
    inverse: &Planes6<'_>,
    r: &Planes<'_>,
    x: &mut Planes<'_>,
    d: &mut Planes<'_>,
    [i, n]: [usize; 2],
) {
    let at = i + WIDTH;
    let solved = inverse.tiles(at, n).zip(r.tiles(at, n));
    for ((inverse, r), (x, d)) in solved.zip(x.tiles_mut(at, n).zip(d.tiles_mut(at, n))) {
        let change = scale([c; WIDTH], symmetric(inverse, r));
        write(x, change);
        write(d, change);
    }
}

/// d = ω P x_c, x += d
#[inline(always)]
fn prolong(
    over: f32,
    aggregate: &[u32],
    coarse: &Planes<'_>,
    x: &mut Planes<'_>,
    d: &mut Planes<'_>,
    [i, n]: [usize; 2],
) {
    let [x_c, y_c, z_c] = &coarse.0;
    let places = x_c.len();
    let (Some(y_c), Some(z_c)) = (y_c.get(..places), z_c.get(..places)) else { return };
    let [dx, dy, dz] = d.0.each_mut().map(|plane| plane.get_mut(i + WIDTH..).unwrap_or_default());
    let rows = aggregate.get(i..).unwrap_or_default().iter().take(n);
    for (((aggregate, a), b), c) in rows.zip(dx).zip(dy).zip(dz) {
        let place = *aggregate as usize + WIDTH;
        if let (Some(x), Some(y), Some(z)) = (x_c.get(place), y_c.get(place), z_c.get(place)) {
            (*a, *b, *c) = (*x, *y, *z);
        }
    }
    let at = i + WIDTH;
    for (x, d) in x.tiles_mut(at, n).zip(d.tiles_mut(at, n)) {
        let change = scale([over; WIDTH], read(&d));
        let moved = add3(read(&x), change);
        write(x, moved);
        write(d, change);
    }
}

/// d = a d + c D⁻¹r, x += d
#[inline(always)]
fn smooth(
    [a, c]: [f32; 2],
    inverse: &Planes6<'_>,
    r: &Planes<'_>,
    d: &Planes<'_>,
    x: &mut Planes<'_>,
    next: &mut Planes<'_>,
    [i, n]: [usize; 2],
) {
    let at = i + WIDTH;
    let known = inverse.tiles(at, n).zip(r.tiles(at, n)).zip(d.tiles(at, n));
    for (((inverse, r), d), (x, next)) in known.zip(x.tiles_mut(at, n).zip(next.tiles_mut(at, n))) {
        let z = symmetric(inverse, r);
        let change = add3(scale([a; WIDTH], d), scale([c; WIDTH], z));
        let moved = add3(read(&x), change);
        write(x, moved);
        write(next, change);
    }
}

/// r −= A d in n rows from i on, but for held rows and loose edges; of r of higher rows what edges from here do to it.
/// These rows of `forces` are scratch.
#[inline(always)]
fn subtract<K: Kind>(
    runs: &[Run],
    blocks: &[f32],
    d: &Planes<'_>,
    mass: &[f32],
    r: &mut Planes<'_>,
    forces: &mut Planes<'_>,
    [i, n]: [usize; 2],
) {
    let at = i + WIDTH;
    for ((mass, d), r) in cut(mass, at, n).iter().zip(d.tiles(at, n)).zip(r.tiles_mut(at, n)) {
        let left = sub3(read(&r), scale(*mass, d));
        write(r, left);
    }
    each_run::<K>(
        runs,
        blocks,
        #[inline(always)]
        |[first, offset, tiles], numbers| {
            let (first, offset, rows) = (first as usize, offset as usize, WIDTH * tiles as usize);
            let begin = if i > first { i } else { first };
            let end = if i + n < first + rows { i + n } else { first + rows };
            let n = end.saturating_sub(begin);
            let at = begin + WIDTH;
            // What edges do to their lower ends, and then to their upper ones: their rows overlap, and a load that overlaps a
            // store just before it would wait for it.
            let blocks = K::tiles(numbers, length(tiles as usize), at.wrapping_sub(first), n);
            let ends = d.tiles(at, n).zip(d.tiles(at + offset, n));
            let rows = r.tiles_mut(at, n).zip(forces.tiles_mut(at, n));
            for ((blocks, (lower, upper)), (r, force)) in blocks.zip(ends).zip(rows) {
                let pull = K::times(blocks, sub3(lower, upper));
                let left = sub3(read(&r), pull);
                write(r, left);
                write(force, pull);
            }
            for (r, force) in r.tiles_mut(at + offset, n).zip(forces.tiles(at, n)) {
                let sum = add3(read(&r), force);
                write(r, sum);
            }
        },
    );
}

/// The held rows below `end` that have not been met; they are sorted.
#[inline(always)]
fn subtract_held(
    rows: &[u32],
    blocks: &[[f32; 6]],
    next: &mut usize,
    end: usize,
    d: &Planes<'_>,
    r: &mut Planes<'_>,
) {
    while let Some(row) = rows.get(*next).filter(|row| (**row as usize) < end) {
        let i = *row as usize;
        let held = Sym3(blocks.get(i).copied().unwrap_or_default()).mul(d.at(i));
        r.add(i, vec3::scale(-1.0, held));
        *next += 1;
    }
}

/// Adds Pᵀr of n rows from i on.
#[inline(always)]
fn scatter(aggregate: &[u32], r: &Planes<'_>, coarse: &mut Planes<'_>, [i, n]: [usize; 2]) {
    let [x, y, z] = &mut coarse.0;
    // Of one length, so that one comparison does for all three.
    let places = x.len();
    let (Some(y), Some(z)) = (y.get_mut(..places), z.get_mut(..places)) else { return };
    let [from_x, from_y, from_z] = r.0.each_ref().map(|plane| plane.get(i + WIDTH..).unwrap_or_default());
    let rows = aggregate.get(i..).unwrap_or_default().iter().take(n);
    for (((aggregate, a), b), c) in rows.zip(from_x).zip(from_y).zip(from_z) {
        let place = *aggregate as usize + WIDTH;
        if let (Some(x), Some(y), Some(z)) = (x.get_mut(place), y.get_mut(place), z.get_mut(place)) {
            (*x, *y, *z) = (*x + a, *y + b, *z + c);
        }
    }
}
