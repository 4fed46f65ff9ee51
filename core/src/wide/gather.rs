//! How every product with A is made in lanes: rows gather their springs' terms, first from the farthest row above, then m̃,
//! last from the farthest below:
//!
//! ((0 + Σ_d H(i−d, i) (x_i − x_{i−d})) + m̃ᵢ xᵢ) + Σ_d H(i, i+d) (x_i − x_{i+d}).
//!
//! That is the sum of [`crate::System`] where each row's springs come in the order of their other ends. A spring is computed
//! at both of its ends from the same numbers, so what it adds to one row it takes from the other bit for bit. No index, no
//! scatter; each row's sum is its own, so the width of the registers does not touch the bits.

use crate::hessian::Hessian;
use crate::real::Real;
use crate::vec3::{self, Vec3};
use crate::wide::eight::{Eight, Planes, load};
use crate::wide::layout::Layout;
use crate::wide::neighbours::{Neighbours, Way, alike};

/// What rows make of their terms, and where it goes.
pub(crate) trait Gather<T: Real> {
    /// What eight rows have so far.
    type Rows;
    /// Nothing yet.
    fn new() -> Self::Rows;
    /// A spring from above: it was counted there.
    fn above(rows: Self::Rows, h: Hessian<Eight<T>>, apart: Vec3<Eight<T>>) -> Self::Rows;
    /// m̃ x
    fn inertia(rows: Self::Rows, m: Eight<T>, here: Vec3<Eight<T>>) -> Self::Rows;
    /// A spring of the row's own.
    fn own(rows: Self::Rows, h: Hessian<Eight<T>>, apart: Vec3<Eight<T>>) -> Self::Rows;
    /// Puts down what rows have from above ...
    fn put_down(&mut self, at: usize, rows: Self::Rows);
    /// ... and takes it up again.
    fn take_up(&self, at: usize) -> Self::Rows;
    /// All that rows have, and their masses.
    fn finish(&mut self, at: usize, m: Eight<T>, rows: Self::Rows);
}

/// A's planes.
#[derive(Clone, Copy)]
pub(crate) struct Matrix<'p, T> {
    pub(crate) layout: &'p Layout,
    pub(crate) way: Way<'p>,
    pub(crate) hessians: &'p [T],
    pub(crate) inertia: &'p [T],
}

/// Gathers all rows' terms with x.
#[inline(always)]
pub(crate) fn gather<T: Real, G: Gather<T>>(matrix: Matrix<'_, T>, x: &Planes<'_, T>, to: &mut G) {
    match (matrix.way, matrix.layout.distances()) {
        // A cloth's runs without a loop over them and without asking where a plane ends: a third faster.
        (Way::Runs(_), [d]) => _ = one(matrix, *d as usize, x, to),
        (Way::Runs(_), [a, b, c, d]) => _ = four(matrix, [*a, *b, *c, *d], x, to),
        (Way::Runs(runs), _) => any(runs, matrix, x, to),
        (Way::Slots(slots), _) => any(slots, matrix, x, to),
    }
}

#[inline(always)]
fn any<T: Real, N: Neighbours, G: Gather<T>>(
    neighbours: N,
    Matrix { layout, hessians, inertia, .. }: Matrix<'_, T>,
    x: &Planes<'_, T>,
    to: &mut G,
) {
    let planes = alike(x);
    for at in layout.tiles() {
        let here = x.load(at);
        let m = load(inertia, at);
        let mut rows = G::new();
        for (h, ends) in neighbours.above(hessians, at) {
            rows = G::above(rows, h, vec3::sub(here, neighbours.vector(planes, ends)));
        }
        rows = G::inertia(rows, m, here);
        for (h, ends) in neighbours.own(hessians, at) {
            rows = G::own(rows, h, vec3::sub(here, neighbours.vector(planes, ends)));
        }
        to.finish(at, m, rows);
    }
}

/// A plane from somewhere on, in tiles.
type Tiles<'p, T> = &'p [[T; 8]];

#[inline(always)]
fn tiles<T>(plane: &[T], from: usize, count: usize) -> Option<Tiles<'_, T>> {
    plane.get(from..)?.as_chunks().0.get(..count)
}

/// The t-th. Every list is as long as the loops over it, so nothing is asked where code is optimised for speed.
#[inline(always)]
fn tile<T: Real>(tiles: Tiles<'_, T>, t: usize) -> Eight<T> {
    Eight(*tiles.get(t).unwrap_or(T::ZEROS))
}

#[inline(always)]
fn vectors<'p, T>(
    Planes([x, y, z]): &'p Planes<'_, T>,
    from: usize,
    count: usize,
) -> Option<[Tiles<'p, T>; 3]> {
    Some([tiles(x, from, count)?, tiles(y, from, count)?, tiles(z, from, count)?])
}

/// A run's springs from a place on, and the rows at their other ends.
#[derive(Clone, Copy)]
struct Reach<'p, T> {
    springs: [Tiles<'p, T>; 4],
    others: [Tiles<'p, T>; 3],
}

impl<'p, T: Real> Reach<'p, T> {
    #[inline(always)]
    fn new(
        matrix: Matrix<'p, T>,
        x: &'p Planes<'_, T>,
        run: usize,
        [spring, other]: [usize; 2],
        count: usize,
    ) -> Option<Self> {
        let n = matrix.layout.plane();
        let plane = |k: usize| tiles(matrix.hessians, (4 * run + k) * n + spring, count);
        let springs = [plane(0)?, plane(1)?, plane(2)?, plane(3)?];
        Some(Self { springs, others: vectors(x, other, count)? })
    }

    #[inline(always)]
    fn at(self, t: usize, here: Vec3<Eight<T>>) -> (Hessian<Eight<T>>, Vec3<Eight<T>>) {
        let ([alpha, a, b, c], [x, y, z]) = (self.springs, self.others);
        let h = Hessian { alpha: tile(alpha, t), w: [tile(a, t), tile(b, t), tile(c, t)] };
        (h, vec3::sub(here, [tile(x, t), tile(y, t), tile(z, t)]))
    }
}

/// A chain's run.
#[inline(always)]
fn one<T: Real, G: Gather<T>>(matrix: Matrix<'_, T>, d: usize, x: &Planes<'_, T>, to: &mut G) -> Option<()> {
    let (pad, count) = (matrix.layout.pad, matrix.layout.places / 8);
    let above = Reach::new(matrix, x, 0, [pad - d, pad - d], count)?;
    let own = Reach::new(matrix, x, 0, [pad, pad + d], count)?;
    let [x, y, z] = vectors(x, pad, count)?;
    let masses = tiles(matrix.inertia, pad, count)?;
    for t in 0..count {
        let here = [tile(x, t), tile(y, t), tile(z, t)];
        let m = tile(masses, t);
        let (h, apart) = above.at(t, here);
        let rows = G::inertia(G::above(G::new(), h, apart), m, here);
        let (h, apart) = own.at(t, here);
        to.finish(pad + 8 * t, m, G::own(rows, h, apart));
    }
    Some(())
}

/// Rows of a block. Half of the terms at a time: all at once are more than there are registers.
const BLOCK: usize = 32;

#[inline(always)]
fn four<T: Real, G: Gather<T>>(
    matrix: Matrix<'_, T>,
    distances: [u32; 4],
    x: &Planes<'_, T>,
    to: &mut G,
) -> Option<()> {
    let (pad, count) = (matrix.layout.pad, matrix.layout.places / 8);
    let [d0, d1, d2, d3] = distances.map(|d| d as usize);
    let above = |run, d| Reach::new(matrix, x, run, [pad - d, pad - d], count);
    let own = |run, d| Reach::new(matrix, x, run, [pad, pad + d], count);
    let (a0, a1, a2, a3) = (above(0, d0)?, above(1, d1)?, above(2, d2)?, above(3, d3)?);
    let (o0, o1, o2, o3) = (own(0, d0)?, own(1, d1)?, own(2, d2)?, own(3, d3)?);
    let [x, y, z] = vectors(x, pad, count)?;
    let masses = tiles(matrix.inertia, pad, count)?;
    let mut first = 0;
    while first < count {
        let stop = core::cmp::min(first + BLOCK, count);
        for t in first..stop {
            let here = [tile(x, t), tile(y, t), tile(z, t)];
            let (h, apart) = a3.at(t, here);
            let rows = G::above(G::new(), h, apart);
            let (h, apart) = a2.at(t, here);
            let rows = G::above(rows, h, apart);
            let (h, apart) = a1.at(t, here);
            let rows = G::above(rows, h, apart);
            let (h, apart) = a0.at(t, here);
            to.put_down(pad + 8 * t, G::above(rows, h, apart));
        }
        for t in first..stop {
            let here = [tile(x, t), tile(y, t), tile(z, t)];
            let m = tile(masses, t);
            let rows = G::inertia(to.take_up(pad + 8 * t), m, here);
            let (h, apart) = o0.at(t, here);
            let rows = G::own(rows, h, apart);
            let (h, apart) = o1.at(t, here);
            let rows = G::own(rows, h, apart);
            let (h, apart) = o2.at(t, here);
            let rows = G::own(rows, h, apart);
            let (h, apart) = o3.at(t, here);
            to.finish(pad + 8 * t, m, G::own(rows, h, apart));
        }
        first = stop;
    }
    Some(())
}
