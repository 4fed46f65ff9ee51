//! r −= A d, and what follows it row by row: d = a d + c D⁻¹r, x += d.
//!
//! Edges go from a row to higher ones only. So once the edges of the first rows are done, these rows' r is complete and
//! their d needed no more: rows are walked in blocks, and a block is smoothed while it is still in the cache.
//!
//! The order of the sums (it makes the bits): held blocks, loose edges, then block by block masses and runs, by offset.

use super::level::{Level, TILE, blocks};
use super::tile::{Planes, Tile, Tile3, WIDTH, add3, mul, sub3, symmetric};
use crate::sym3::Sym3;
use crate::wide::Dispatch;

/// Rows of a block ...
const BLOCK: usize = 128;
/// ... unless there are more runs than this; each is looked at once per block.
const FEW: usize = 24;

/// Tiles of a run whose ends overlap that are done at a time.
const WAITING: usize = 8;

/// A step of smoothing: d = a d + c D⁻¹r.
pub(super) type Step = (f32, f32);

impl Level<'_> {
    /// r −= A d, then, if any, the step.
    #[inline(never)]
    pub(super) fn relax(&mut self, dispatch: impl Dispatch, step: Option<Step>) {
        dispatch.run(
            #[inline(always)]
            || self.relax_in_lanes(step),
        );
    }

    #[inline(always)]
    fn relax_in_lanes(&mut self, step: Option<Step>) {
        self.subtract_held();
        self.subtract_loose();
        let rows = self.pattern.size.rows;
        let block = if self.pattern.runs().len() > FEW { rows.next_multiple_of(WIDTH) } else { BLOCK };
        let mut first = 0;
        while first < rows {
            let end = first + block;
            self.subtract_mass(first, end);
            self.subtract_runs(first, end);
            if let Some(step) = step {
                self.smooth(first, end, step);
            }
            first = end;
        }
    }

    /// x = d = c D⁻¹r
    #[inline(never)]
    pub(super) fn start(&mut self, dispatch: impl Dispatch, c: f32) {
        dispatch.run(
            #[inline(always)]
            || self.start_in_lanes(c),
        );
    }

    #[inline(always)]
    fn start_in_lanes(&mut self, c: f32) {
        let tiles = self.pattern.size.rows.div_ceil(WIDTH);
        let inverse = tiles6(&self.inverse, 0, tiles);
        let (r, x, d) = (self.r.tiles(0, tiles), self.x.tiles_mut(0, tiles), self.d.tiles_mut(0, tiles));
        let c = [c; WIDTH];
        for (((inverse, r), x), d) in
            columns6(inverse).zip(columns(r)).zip(columns_mut(x)).zip(columns_mut(d))
        {
            let [zx, zy, zz] = symmetric(inverse, r);
            let z = [mul(c, zx), mul(c, zy), mul(c, zz)];
            put(x, z);
            put(d, z);
        }
    }

    /// d = a d + c D⁻¹r, x += d in these rows.
    #[inline(always)]
    fn smooth(&mut self, first: usize, end: usize, (a, c): Step) {
        let end = if end < self.mass.len() { end } else { self.mass.len() };
        let tiles = (end - first) / WIDTH;
        let inverse = tiles6(&self.inverse, first, tiles);
        let (r, x, d) =
            (self.r.tiles(first, tiles), self.x.tiles_mut(first, tiles), self.d.tiles_mut(first, tiles));
        let (a, c) = ([a; WIDTH], [c; WIDTH]);
        for (((inverse, r), x), d) in
            columns6(inverse).zip(columns(r)).zip(columns_mut(x)).zip(columns_mut(d))
        {
            let [zx, zy, zz] = symmetric(inverse, r);
            let [dx, dy, dz] = take3(&d);
            let next = add3([mul(a, dx), mul(a, dy), mul(a, dz)], [mul(c, zx), mul(c, zy), mul(c, zz)]);
            let moved = add3(take3(&x), next);
            put(x, moved);
            put(d, next);
        }
    }

    #[inline(always)]
    fn subtract_mass(&mut self, first: usize, end: usize) {
        let end = if end < self.mass.len() { end } else { self.mass.len() };
        let tiles = (end - first) / WIDTH;
        let mass = tiles_at(self.mass, first, tiles);
        for ((mass, d), r) in mass
            .iter()
            .zip(columns(self.d.tiles(first, tiles)))
            .zip(columns_mut(self.r.tiles_mut(first, tiles)))
        {
            let [x, y, z] = d;
            let left = sub3(take3(&r), [mul(*mass, x), mul(*mass, y), mul(*mass, z)]);
            put(r, left);
        }
    }

    /// The tiles of runs that begin in these rows.
    #[inline(always)]
    fn subtract_runs(&mut self, first: usize, end: usize) {
        let mut rest = self.blocks.as_chunks::<TILE>().0;
        for [from, offset, count] in self.pattern.runs() {
            let (from, offset, count) = (*from as usize, *offset as usize, *count as usize);
            let (run, others) = rest.split_at_checked(count).unwrap_or_default();
            rest = others;
            let tile_at = |row: usize| {
                let tile = row.saturating_sub(from).div_ceil(WIDTH);
                if tile < count { tile } else { count }
            };
            let (begin, stop) = (tile_at(first), tile_at(end));
            let tiles = run.get(begin..stop).unwrap_or_default();
            let a = from + WIDTH * begin;
            if tiles.is_empty() {
            } else if offset < WIDTH {
                near(tiles, a, offset, &self.d, &mut self.r);
            } else {
                let most = offset / WIDTH;
                for (k, tiles) in tiles.chunks(most).enumerate() {
                    far(tiles, a + WIDTH * most * k, offset, &self.d, &mut self.r);
                }
            }
        }
    }

    fn subtract_loose(&mut self) {
        let (r, d) = (&mut self.r, &self.d);
        let split = TILE * self.pattern.size.extent.run_tiles;
        let loose = self.blocks.get(split..).unwrap_or_default();
        self.pattern.each_loose_tile(loose, |tile, a, b| {
            let mut apart = [[0.0; WIDTH]; 3];
            for (k, (a, b)) in a.iter().zip(b).enumerate() {
                let (at_a, at_b) = (d.at(*a as usize), d.at(*b as usize));
                for (apart, (a, b)) in apart.iter_mut().zip(at_a.into_iter().zip(at_b)) {
                    if let Some(apart) = apart.get_mut(k) {
                        *apart = a - b;
                    }
                }
            }
            let [x, y, z] = symmetric(blocks(tile), apart);
            for ((a, b), ((x, y), z)) in a.iter().zip(b).zip(x.into_iter().zip(y).zip(z)) {
                r.add(*a as usize, [-x, -y, -z]);
                r.add(*b as usize, [x, y, z]);
            }
        });
    }

    fn subtract_held(&mut self) {
        for row in self.pattern.held_rows.iter().take(self.held_count) {
            let row = *row as usize;
            let held = self.held.get(row).copied().unwrap_or_default();
            let [x, y, z] = Sym3(held).mul(self.d.at(row));
            self.r.add(row, [-x, -y, -z]);
        }
    }
}

/// Both ends' rows are apart: two slices of each plane of r.
#[inline(always)]
fn far(tiles: &[[f32; TILE]], a: usize, offset: usize, d: &Planes<'_>, r: &mut Planes<'_>) {
    let n = tiles.len();
    let d = columns(d.tiles(a, n)).zip(columns(d.tiles(a + offset, n)));
    let [x, y, z] = &mut r.0;
    let ((xa, xb), (ya, yb), (za, zb)) =
        (both(x, a, offset, n), both(y, a, offset, n), both(z, a, offset, n));
    let r = columns_mut([xa, ya, za]).zip(columns_mut([xb, yb, zb]));
    for (tile, ((da, db), (ra, rb))) in tiles.iter().zip(d.zip(r)) {
        let force = symmetric(blocks(tile), sub3(da, db));
        let (at_a, at_b) = (sub3(take3(&ra), force), add3(take3(&rb), force));
        put(ra, at_a);
        put(rb, at_b);
    }
}

#[inline(always)]
fn both(plane: &mut [f32], a: usize, offset: usize, n: usize) -> (&mut [Tile], &mut [Tile]) {
    let (low, high) = plane.split_at_mut_checked(a + offset).unwrap_or_default();
    (tiles_at_mut(low, a, n), tiles_at_mut(high, 0, n))
}

/// The rows overlap: what the upper ends get waits until the lower ends have theirs. (A load that overlaps the stores just
/// before it would wait for them.)
#[inline(always)]
fn near(tiles: &[[f32; TILE]], mut a: usize, offset: usize, d: &Planes<'_>, r: &mut Planes<'_>) {
    for tiles in tiles.chunks(WAITING) {
        let n = tiles.len();
        let mut waiting = [[[0.0; WIDTH]; 3]; WAITING];
        let d = columns(d.tiles(a, n)).zip(columns(d.tiles(a + offset, n)));
        let lower = columns_mut(r.tiles_mut(a, n));
        for ((tile, (da, db)), (r, waiting)) in tiles.iter().zip(d).zip(lower.zip(&mut waiting)) {
            let force = symmetric(blocks(tile), sub3(da, db));
            let left = sub3(take3(&r), force);
            put(r, left);
            *waiting = force;
        }
        for (r, waiting) in columns_mut(r.tiles_mut(a + offset, n)).zip(&waiting) {
            let sum = add3(take3(&r), *waiting);
            put(r, sum);
        }
        a += WIDTH * n;
    }
}

/// `n` tiles of a plane from row i on.
#[inline(always)]
fn tiles_at(plane: &[f32], i: usize, n: usize) -> &[Tile] {
    plane.get(i..i + WIDTH * n).unwrap_or_default().as_chunks().0
}

#[inline(always)]
fn tiles_at_mut(plane: &mut [f32], i: usize, n: usize) -> &mut [Tile] {
    plane.get_mut(i..i + WIDTH * n).unwrap_or_default().as_chunks_mut().0
}

#[inline(always)]
fn tiles6<'p>([a, b, c, d, e, f]: &'p [&mut [f32]; 6], i: usize, n: usize) -> [&'p [Tile]; 6] {
    [
        tiles_at(a, i, n),
        tiles_at(b, i, n),
        tiles_at(c, i, n),
        tiles_at(d, i, n),
        tiles_at(e, i, n),
        tiles_at(f, i, n),
    ]
}

impl Planes<'_> {
    #[inline(always)]
    fn tiles(&self, i: usize, n: usize) -> [&[Tile]; 3] {
        let [x, y, z] = &self.0;
        [tiles_at(x, i, n), tiles_at(y, i, n), tiles_at(z, i, n)]
    }

    #[inline(always)]
    fn tiles_mut(&mut self, i: usize, n: usize) -> [&mut [Tile]; 3] {
        let [x, y, z] = &mut self.0;
        [tiles_at_mut(x, i, n), tiles_at_mut(y, i, n), tiles_at_mut(z, i, n)]
    }
}

/// Vectors out of planes, a tile at a time.
#[inline(always)]
fn columns([x, y, z]: [&[Tile]; 3]) -> impl Iterator<Item = Tile3> {
    x.iter().zip(y).zip(z).map(|((x, y), z)| [*x, *y, *z])
}

#[inline(always)]
fn columns6([a, b, c, d, e, f]: [&[Tile]; 6]) -> impl Iterator<Item = [Tile; 6]> {
    let upper = a.iter().zip(b).zip(c);
    upper.zip(d.iter().zip(e).zip(f)).map(|(((a, b), c), ((d, e), f))| [*a, *b, *c, *d, *e, *f])
}

#[inline(always)]
fn columns_mut([x, y, z]: [&mut [Tile]; 3]) -> impl Iterator<Item = [&mut Tile; 3]> {
    x.iter_mut().zip(y).zip(z).map(|((x, y), z)| [x, y, z])
}

#[inline(always)]
fn take3([x, y, z]: &[&mut Tile; 3]) -> Tile3 {
    [**x, **y, **z]
}

#[inline(always)]
fn put([x, y, z]: [&mut Tile; 3], [tx, ty, tz]: Tile3) {
    *x = tx;
    *y = ty;
    *z = tz;
}
