//! PCG around the cycle, in f32 on the finest level like the cycle itself: the iterations of [`crate::solver::pcg`] for A c = r,
//! where x + c is what x is to become.
//!
//! f32 loses what c is made of after some iterations, so c is handed out when Σ|rᵢ|²/μᵢ has fallen by [`FALL`], and r comes anew,
//! computed outside in the precision of the scene. The direction p stays, so few iterations are lost. r comes divided by the
//! largest component that it had at first, since f32 would lose a small one, 1/μ by the largest, and A times 1/σ.
//!
//! Measured against iterations in f64 around the same cycle (cloth:32, :64, :128, R = 1e-3 and 1e-6): as many iterations (to
//! 1e-10 and beyond up to a fifth more), each shorter by a fifth on the smallest and by three tenths on the largest. [`FALL`] from 1e-3 to 1e-9 makes no difference that is not chance;
//! this one asks for no new residual before R = 1e-3 is reached.
//!
//! Source: van der Vorst & Ye 2000, *Residual replacement strategies for Krylov subspace iterative methods*.

use super::block::Tied;
use super::cycle::Hierarchy;
use super::level::Level;
use super::planes::{Planes, cut, plane, read, write};
use super::product::{subtract, subtract_held, subtract_loose};
use super::tile::{Tile, Tile3, WIDTH, add, add3, dot, scale};
use super::words::take;
use crate::real::{Real, larger};
use crate::wide::Dispatch;

/// Planes: c, r, p, 1/μ.
const PLANES: usize = 10;
/// Of Σ|rᵢ|²/μᵢ, until c is handed out.
const FALL: f32 = 1e-7;

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

/// Iterates as [`crate::solver::pcg::Iterates::iterate`] says; `scale` is 1/σ.
#[inline(always)]
pub(super) fn iterate<T: Real>(
    (hierarchy, inner): (&mut Hierarchy<'_>, &mut Inner<'_>),
    outer: &mut impl Outer<T>,
    scale: T,
    (target, max_iterations): (T, u32),
    iterations: &mut u32,
    dispatch: impl Dispatch,
) -> bool {
    let (most, heaviest) = (outer.most(), outer.heaviest());
    let (down, up, lighter) = (T::ONE / most, most * scale, T::ONE / heaviest);
    if !(most > T::ZERO && down.is_finite() && up.is_finite() && lighter.is_finite()) {
        return true;
    }
    // ½ Σ|rᵢ|²/μᵢ of what is 1 here; where that is below or beyond the numbers, no target is known and FALL alone ends a group.
    let unit = T::HALF * (most * heaviest) * most;
    let known = unit > T::ZERO && unit.is_finite();
    let target = if known { (target / unit).to_f64() as f32 } else { 0.0 };
    // Behind the last row a tile has zeros.
    inner.weight.fill(0.0);
    outer.weights(lighter, inner.weight);
    inner.r.clear();
    inner.p.clear();
    let (mut rz, mut before) = (0.0, f32::INFINITY);
    loop {
        outer.residual(down, &mut inner.r);
        let Some(Some(finest)) = hierarchy.levels.first_mut() else { return true };
        inner.c.clear();
        finest.r.clear();
        let mut beta = inner.update(0.0, finest, dispatch);
        // What was handed out has not helped by much: the limit of this precision is near.
        if !(beta < 0.5 * before) {
            return false;
        }
        before = beta;
        let goal = larger(target, FALL * beta);
        let (first, mut broken) = (*iterations, false);
        while beta > goal && *iterations < max_iterations {
            hierarchy.cycle(dispatch);
            let Some(Some(finest)) = hierarchy.levels.first_mut() else { return true };
            let next = inner.dot(finest, dispatch);
            broken = !(next > 0.0);
            if broken {
                break;
            }
            let curvature = inner.product(if rz > 0.0 { next / rz } else { 0.0 }, finest, dispatch);
            broken = !(curvature > 0.0);
            if broken {
                break;
            }
            rz = next;
            beta = inner.update(next / curvature, finest, dispatch);
            *iterations += 1;
        }
        if *iterations == first {
            return broken;
        }
        outer.put(up, &inner.c);
        outer.add();
        if !(beta > target) || *iterations >= max_iterations {
            return false;
        }
        outer.renew();
        if broken {
            inner.p.clear();
            rz = 0.0;
        }
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
