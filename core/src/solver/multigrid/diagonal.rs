//! The inverses of a level's diagonal blocks, D_i = m_i I + held_i + Σ H over the edges that meet row i: a tile at a time.

use super::block::{Full, Kind, Tied};
use super::galerkin::loose_block;
use super::level::{Level, tiles};
use super::planes::cut;
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
        let count = self.pattern.size.rows.div_ceil(WIDTH);
        let Self { pattern, held_count, blocks, mass, held, inverse, loose, .. } = self;
        let rows = inverse.iter_mut().zip(cut(mass, WIDTH, WIDTH * count));
        for ((sum, mass), edges) in rows.zip(tiles::<K>(&pattern.strips, blocks, [0, count])) {
            let zero = [0.0; WIDTH];
            let mut diagonal = [*mass, *mass, *mass, zero, zero, zero];
            for (_, blocks) in edges {
                diagonal = add6(diagonal, K::matrices(*blocks));
            }
            *sum = diagonal;
        }
        for row in pattern.held_rows.iter().take(*held_count) {
            add_to(inverse, *row, held.get(*row as usize).copied().unwrap_or_default());
        }
        let [a, b] = &pattern.loose;
        for (k, (a, b)) in a.iter().zip(b.iter()).enumerate() {
            let block = loose_block(loose, k);
            add_to(inverse, *a, block);
            add_to(inverse, *b, block);
        }
        for block in inverse.iter_mut() {
            for half in [0, HALF] {
                let inverse = invert(block.each_ref().map(|entries| part(entries, half)));
                for (entries, inverse) in block.iter_mut().zip(inverse) {
                    for (entry, inverse) in entries.iter_mut().skip(half).zip(inverse) {
                        *entry = inverse;
                    }
                }
            }
        }
    }
}

/// Adds to one row.
#[inline(always)]
fn add_to(diagonal: &mut [Tile6], row: u32, block: [f32; 6]) {
    let row = row as usize;
    if let Some(tile) = diagonal.get_mut(row / WIDTH) {
        for (entries, value) in tile.iter_mut().zip(block) {
            if let Some(entry) = entries.get_mut(row % WIDTH) {
                *entry += value;
            }
        }
    }
}

#[inline(always)]
fn add6(a: Tile6, b: Tile6) -> Tile6 {
    let ([a, b, c, d, e, f], [p, q, r, s, t, u]) = (a, b);
    [add(a, p), add(b, q), add(c, r), add(d, s), add(e, t), add(f, u)]
}

/// So many at a time: a whole tile may take 8.9 KB of stack, by clippy's count.
const HALF: usize = WIDTH / 2;

#[inline(always)]
fn part(entries: &Tile, from: usize) -> Half {
    entries.get(from..).and_then(|entries| entries.first_chunk()).copied().unwrap_or([0.0; HALF])
}

type Half = [f32; HALF];

/// 1/a; where a is not positive the lane is bad.
#[inline(always)]
fn reciprocal(a: Half, bad: &mut Half) -> Half {
    let mut out = a;
    for ((out, a), bad) in out.iter_mut().zip(a).zip(bad) {
        *out = 1.0 / a;
        *bad = if a > 0.0 && *out > 0.0 { *bad } else { 1.0 };
    }
    out
}

/// As [`crate::Sym3::inverse`] does one; a block that is not positive becomes its largest entry's.
#[inline(always)]
fn invert([xx, yy, zz, xy, xz, yz]: [Half; 6]) -> [Half; 6] {
    let mut bad = [0.0; HALF];
    let i1 = reciprocal(xx, &mut bad);
    let (l21, l31) = (mul(xy, i1), mul(xz, i1));
    let i2 = reciprocal(sub(yy, mul(l21, xy)), &mut bad);
    let s32 = sub(yz, mul(l31, xy));
    let l32 = mul(s32, i2);
    let i3 = reciprocal(sub(sub(zz, mul(l31, xz)), mul(l32, s32)), &mut bad);
    let m31 = sub(mul(l21, l32), l31);
    let (t21, t31, t32) = (mul(i2, l21), mul(i3, m31), mul(i3, l32));
    let zero = [0.0; HALF];
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
fn choose(bad: Half, instead: Half, mut tile: Half) -> Half {
    for (entry, (bad, instead)) in tile.iter_mut().zip(bad.into_iter().zip(instead)) {
        *entry = if bad > 0.0 { instead } else { *entry };
    }
    tile
}
