//! The inverses of a level's diagonal blocks, D_i = m_i I + held_i + Σ H over the edges that meet row i: a tile at a time.

use super::block::{Full, Kind, Tied};
use super::galerkin::loose_block;
use super::level::{Level, each_run, meet};
use super::planes::{Planes6, cut};
use super::runs::length;
use super::tile::{Tile, Tile6, WIDTH, add, mul, sub};
use crate::real::larger;
use crate::wide::Dispatch;

impl Level<'_> {
    /// Finds them.
    #[inline(never)]
    pub(super) fn invert_diagonal(&mut self, dispatch: impl Dispatch) {
        dispatch.run(
            #[inline(always)]
            || {
                if self.tied {
                    self.invert_of::<Tied>();
                } else {
                    self.invert_of::<Full>();
                }
            },
        );
    }

    #[inline(always)]
    fn invert_of<K: Kind>(&mut self) {
        let rows = self.pattern.size.rows.next_multiple_of(WIDTH);
        let Self { pattern, held_count, blocks, mass, held, inverse, loose, .. } = self;
        inverse.clear();
        let masses = cut(mass, WIDTH, rows).iter();
        for (sum, mass) in inverse.tiles_mut(WIDTH, rows).zip(masses) {
            let [xx, yy, zz, ..] = sum;
            (*xx, *yy, *zz) = (*mass, *mass, *mass);
        }
        each_run::<K>(
            pattern.runs,
            blocks,
            #[inline(always)]
            |run, numbers| {
                for [row, place, n] in meet(run, 0, rows) {
                    let length = length(run[2] as usize);
                    let tiles = K::tiles(numbers, length, place, n);
                    for (sum, blocks) in inverse.tiles_mut(row + WIDTH, n).zip(tiles) {
                        let added = add6(read(&sum), K::matrices(blocks));
                        write(sum, added);
                    }
                }
            },
        );
        for row in pattern.held_rows.iter().take(*held_count) {
            inverse.add(*row as usize, held.get(*row as usize).copied().unwrap_or_default());
        }
        let [a, b] = &pattern.loose;
        for (k, (a, b)) in a.iter().zip(b.iter()).enumerate() {
            let block = loose_block(loose, k);
            inverse.add(*a as usize, block);
            inverse.add(*b as usize, block);
        }
        invert_all(inverse, rows);
    }
}

#[inline(always)]
fn invert_all(blocks: &mut Planes6<'_>, rows: usize) {
    for block in blocks.tiles_mut(WIDTH, rows) {
        let inverse = invert(read(&block));
        write(block, inverse);
    }
}

#[inline(always)]
fn read([a, b, c, d, e, f]: &[&mut Tile; 6]) -> Tile6 {
    [**a, **b, **c, **d, **e, **f]
}

#[inline(always)]
fn write(to: [&mut Tile; 6], from: Tile6) {
    let [a, b, c, d, e, f] = to;
    [*a, *b, *c, *d, *e, *f] = from;
}

#[inline(always)]
fn add6(a: Tile6, b: Tile6) -> Tile6 {
    let ([a, b, c, d, e, f], [p, q, r, s, t, u]) = (a, b);
    [add(a, p), add(b, q), add(c, r), add(d, s), add(e, t), add(f, u)]
}

/// 1/a; where a is not positive the lane is bad.
#[inline(always)]
fn reciprocal(a: Tile, bad: &mut Tile) -> Tile {
    let mut out = a;
    for ((out, a), bad) in out.iter_mut().zip(a).zip(bad) {
        *out = 1.0 / a;
        *bad = if a > 0.0 && *out > 0.0 { *bad } else { 1.0 };
    }
    out
}

/// As [`crate::Sym3::inverse`] does one; a block that is not positive becomes its largest entry's.
#[inline(always)]
fn invert([xx, yy, zz, xy, xz, yz]: Tile6) -> Tile6 {
    let mut bad = [0.0; WIDTH];
    let i1 = reciprocal(xx, &mut bad);
    let (l21, l31) = (mul(xy, i1), mul(xz, i1));
    let i2 = reciprocal(sub(yy, mul(l21, xy)), &mut bad);
    let s32 = sub(yz, mul(l31, xy));
    let l32 = mul(s32, i2);
    let i3 = reciprocal(sub(sub(zz, mul(l31, xz)), mul(l32, s32)), &mut bad);
    let m31 = sub(mul(l21, l32), l31);
    let (t21, t31, t32) = (mul(i2, l21), mul(i3, m31), mul(i3, l32));
    let zero = [0.0; WIDTH];
    let mut instead = xx;
    for (instead, (y, z)) in instead.iter_mut().zip(yy.into_iter().zip(zz)) {
        let largest = larger(larger(*instead, y), z);
        *instead = if largest > 0.0 { 1.0 / largest } else { 0.0 };
    }
    [
        choose(bad, instead, add(add(i1, mul(t21, l21)), mul(t31, m31))),
        choose(bad, instead, add(i2, mul(t32, l32))),
        choose(bad, instead, i3),
        choose(bad, zero, sub(zero, add(t21, mul(t31, l32)))),
        choose(bad, zero, t31),
        choose(bad, zero, sub(zero, t32)),
    ]
}

#[inline(always)]
fn choose(bad: Tile, instead: Tile, mut tile: Tile) -> Tile {
    for (entry, (bad, instead)) in tile.iter_mut().zip(bad.into_iter().zip(instead)) {
        *entry = if bad > 0.0 { instead } else { *entry };
    }
    tile
}
