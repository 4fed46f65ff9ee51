//! PCG around the cycle, in f32 on the finest level like the cycle itself, refined from outside ([`crate::solver::refinement`]).
//!
//! Measured against iterations in f64 around the same cycle (cloth:32, :64, :128, R = 1e-3 and 1e-6): as many iterations (to
//! 1e-10 and beyond up to a fifth more), each shorter by a fifth on the smallest and by three tenths on the largest.

use super::block::Tied;
use super::cycle::Hierarchy;
use super::level::Level;
use super::planes::{Planes, cut, plane, read, write};
use super::product::{subtract, subtract_held, subtract_loose};
use super::tile::{Tile, Tile3, WIDTH, add, add3, dot, scale};
use super::words::take;
use crate::real::Real;
use crate::solver::refinement::{Group, Refines};
use crate::wide::Dispatch;

/// Planes: c, r, p, 1/μ.
const PLANES: usize = 10;

/// Numbers for so many rows.
pub(super) const fn numbers(rows: usize) -> usize {
    let plain = WIDTH * (rows.div_ceil(WIDTH) + 2);
    PLANES * (plain + plain / 4)
}

/// Vectors of the scene as the hierarchy sees them, row by row.
pub(super) trait Rows<T> {
    /// The largest component of r.
    fn most(&mut self) -> T;
    /// r · down
    fn residual(&mut self, down: T, to: &mut Planes<'_>);
    /// y = up · c
    fn put(&mut self, up: T, c: &Planes<'_>);
}

/// The same with an x that is to be changed.
pub(super) trait Outer<T>: Rows<T> {
    /// The largest 1/μ.
    fn heaviest(&mut self) -> T;
    /// down/μ
    fn weights(&mut self, down: T, to: &mut [f32]);
    /// x += y
    fn add(&mut self);
    /// r −= A y
    fn renew(&mut self);
}

/// The vectors of the iterations.
pub(super) struct Inner<'a> {
    c: Planes<'a>,
    r: Planes<'a>,
    p: Planes<'a>,
    weight: &'a mut [f32],
}

impl<'a> Inner<'a> {
    pub(super) fn none() -> Self {
        let no = || Planes([&mut [], &mut [], &mut []]);
        Self { c: no(), r: no(), p: no(), weight: &mut [] }
    }

    pub(super) fn carve(pool: &mut &'a mut [f32], rows: usize) -> Option<Self> {
        let n = plane(rows);
        let mut next = || take(pool, n);
        let weight = next()?;
        let mut three = || Some(Planes([next()?, next()?, next()?]));
        Some(Self { c: three()?, r: three()?, p: three()?, weight })
    }
}

/// A hierarchy with the vectors of the iterations and those of the scene, `scale` being 1/σ.
pub(super) struct Refined<'r, 'a, O, T, D> {
    pub(super) hierarchy: &'r mut Hierarchy<'a>,
    pub(super) inner: &'r mut Inner<'a>,
    pub(super) outer: &'r mut O,
    pub(super) scale: T,
    pub(super) dispatch: D,
}

impl<T: Real, O: Outer<T>, D: Dispatch> Refines<T> for Refined<'_, '_, O, T, D> {
    #[inline(always)]
    fn scale(&self) -> T {
        self.scale
    }
    #[inline(always)]
    fn most(&mut self) -> T {
        self.outer.most()
    }
    #[inline(always)]
    fn heaviest(&mut self) -> T {
        self.outer.heaviest()
    }
    #[inline(always)]
    fn begin(&mut self, lighter: T) {
        // Behind the last row a tile has zeros.
        self.inner.weight.fill(0.0);
        self.outer.weights(lighter, self.inner.weight);
        self.inner.r.clear();
        self.inner.p.clear();
    }
    #[inline(always)]
    fn residual(&mut self, down: T) -> f32 {
        self.outer.residual(down, &mut self.inner.r);
        let Some(Some(finest)) = self.hierarchy.levels.first_mut() else { return f32::NAN };
        self.inner.c.clear();
        finest.r.clear();
        self.inner.update(0.0, finest, self.dispatch)
    }
    #[inline(always)]
    fn iterate(&mut self, group: Group, rz: &mut f32, iterations: &mut u32) -> (f32, bool) {
        let Self { hierarchy, inner, dispatch, .. } = self;
        let mut beta = group.beta;
        while beta > group.goal && *iterations < group.max_iterations {
            hierarchy.cycle(*dispatch);
            let Some(Some(finest)) = hierarchy.levels.first_mut() else { return (beta, true) };
            let next = inner.dot(finest, *dispatch);
            if !(next > 0.0) {
                return (beta, true);
            }
            let curvature = inner.product(if *rz > 0.0 { next / *rz } else { 0.0 }, finest, *dispatch);
            if !(curvature > 0.0) {
                return (beta, true);
            }
            *rz = next;
            beta = inner.update(next / curvature, finest, *dispatch);
            *iterations += 1;
        }
        (beta, false)
    }
    #[inline(always)]
    fn hand_out(&mut self, up: T) {
        self.outer.put(up, &self.inner.c);
        self.outer.add();
    }
    #[inline(always)]
    fn renew(&mut self) {
        self.outer.renew();
    }
    #[inline(always)]
    fn forget(&mut self) {
        self.inner.p.clear();
    }
}

/// A sum over rows, lane by lane.
struct Sum(Tile);

impl Sum {
    #[inline(always)]
    const fn new() -> Self {
        Self([0.0; WIDTH])
    }

    #[inline(always)]
    fn add(&mut self, a: Tile3, b: Tile3) {
        self.0 = add(self.0, dot(a, b));
    }

    #[inline(always)]
    fn of(self) -> f32 {
        let mut sums = self.0;
        let mut n = WIDTH / 2;
        while n > 0 {
            let (low, high) = sums.split_at_mut(n);
            for (low, high) in low.iter_mut().zip(high) {
                *low += *high;
            }
            n /= 2;
        }
        let [sum, ..] = sums;
        sum
    }
}

/// How many rows, to the end of the last tile.
#[inline(always)]
fn all(level: &Level<'_>) -> usize {
    level.pattern.size.rows.next_multiple_of(WIDTH)
}

impl Inner<'_> {
    /// c += a p, r += a q; q is −A p, in the level's r, and r's copy comes there instead. Answers Σ|rᵢ|²/μᵢ.
    #[inline(never)]
    fn update(&mut self, a: f32, level: &mut Level<'_>, dispatch: impl Dispatch) -> f32 {
        let n = all(level);
        dispatch.run(
            #[inline(always)]
            || {
                let (mut beta, a) = (Sum::new(), [a; WIDTH]);
                let moved = self.c.tiles_mut(WIDTH, n).zip(self.p.tiles(WIDTH, n));
                let left = self.r.tiles_mut(WIDTH, n).zip(level.r.tiles_mut(WIDTH, n));
                for (((c, p), (r, q)), weight) in moved.zip(left).zip(cut(self.weight, WIDTH, n)) {
                    let next = add3(read(&c), scale(a, p));
                    write(c, next);
                    let next = add3(read(&r), scale(a, read(&q)));
                    write(r, next);
                    write(q, next);
                    beta.add(scale(*weight, next), next);
                }
                beta.of()
            },
        )
    }

    /// rᵀz, z being the level's x.
    #[inline(never)]
    fn dot(&self, level: &Level<'_>, dispatch: impl Dispatch) -> f32 {
        let n = all(level);
        dispatch.run(
            #[inline(always)]
            || {
                let mut sum = Sum::new();
                for (r, z) in self.r.tiles(WIDTH, n).zip(level.x.tiles(WIDTH, n)) {
                    sum.add(r, z);
                }
                sum.of()
            },
        )
    }

    /// p = z + ρ p, and q = −A p into the level's r; answers pᵀA p.
    #[inline(never)]
    fn product(&mut self, ratio: f32, level: &mut Level<'_>, dispatch: impl Dispatch) -> f32 {
        let n = all(level);
        dispatch.run(
            #[inline(always)]
            || {
                for (p, z) in self.p.tiles_mut(WIDTH, n).zip(level.x.tiles(WIDTH, n)) {
                    let next = add3(z, scale([ratio; WIDTH], read(&p)));
                    write(p, next);
                }
                let Level { pattern, held_count, blocks, loose, mass, held, r, .. } = level;
                r.clear();
                subtract_loose(&pattern.loose, loose, &self.p, r);
                subtract::<Tied>(&pattern.strips, blocks, &self.p, mass, r, [0, n]);
                let held_rows = pattern.held_rows.get(..*held_count).unwrap_or_default();
                subtract_held(held_rows, held, &mut 0, n, &self.p, r);
                let mut sum = Sum::new();
                for (p, q) in self.p.tiles(WIDTH, n).zip(r.tiles(WIDTH, n)) {
                    sum.add(p, q);
                }
                -sum.of()
            },
        )
    }
}
