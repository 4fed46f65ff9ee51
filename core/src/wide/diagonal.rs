//! D⁻¹ in lanes: the 3×3 blocks of A's diagonal and their inverses, by the formulas of [`crate::Sym3`].

use crate::hessian::Hessian;
use crate::real::{Real, larger};
use crate::sym3::Sym3;
use crate::wide::eight::{Eight, all, choose, load, store, where_positive};
use crate::wide::layout::Layout;
use crate::wide::neighbours::Neighbours;

/// D = M̃ + Σ H into the planes of the inverse.
#[inline(always)]
pub(crate) fn blocks<T: Real, N: Neighbours>(
    neighbours: N,
    layout: &Layout,
    hessians: &[T],
    inertia: &[T],
    inverse: &mut [&mut [T]; 6],
) {
    for at in layout.tiles() {
        let (m, zero) = (load(inertia, at), all(T::ZERO));
        let mut block = Sym3([m, m, m, zero, zero, zero]);
        for (hessian, _) in neighbours.above(hessians, at).chain(neighbours.own(hessians, at)) {
            block = add(block, hessian);
        }
        put(inverse, at, block);
    }
}

/// block + H
#[inline(always)]
fn add<T: Real>(block: Sym3<Eight<T>>, Hessian { alpha, w }: Hessian<Eight<T>>) -> Sym3<Eight<T>> {
    block.plus_scalar(alpha).plus_outer(w)
}

/// D ← D⁻¹. Where a pivot is not positive the largest diagonal entry stands for the block; where there is no row, 0.
#[inline(always)]
pub(crate) fn invert<T: Real>(layout: &Layout, inertia: &[T], planes: &mut [&mut [T]; 6]) {
    for at in layout.tiles() {
        let [a, b, c, d, e, f] = &*planes;
        let block = Sym3([load(a, at), load(b, at), load(c, at), load(d, at), load(e, at), load(f, at)]);
        let m = load(inertia, at);
        let Sym3([a, b, c, d, e, f]) = inverse(block);
        let ([a, b, c], [d, e, f]) = (where_positive(m, [a, b, c]), where_positive(m, [d, e, f]));
        put(planes, at, Sym3([a, b, c, d, e, f]));
    }
}

/// The inverse without a branch: every row takes the same steps.
#[inline(always)]
fn inverse<T: Real>(block: Sym3<Eight<T>>) -> Sym3<Eight<T>> {
    let (Sym3([a, b, c, d, e, f]), pivots) = block.inverse_and_pivots(all(T::ONE));
    let [xx, yy, zz, ..] = block.0;
    let largest = xx.zip(yy, larger_lane).zip(zz, larger_lane);
    let scalar = all(T::ONE) / largest;
    let scalar = scalar.map(
        #[inline(always)]
        |scalar| if scalar > T::ZERO { scalar } else { T::ZERO },
    );
    let [one, two, three] = pivots;
    let sound = one.positive_then(two.positive_then(three.positive_then(all(T::ONE))));
    let zero = all(T::ZERO);
    Sym3([
        choose(sound, a, scalar),
        choose(sound, b, scalar),
        choose(sound, c, scalar),
        choose(sound, d, zero),
        choose(sound, e, zero),
        choose(sound, f, zero),
    ])
}

/// As [`larger`], and inlined wherever it is used.
#[inline(always)]
fn larger_lane<T: Real>(a: T, b: T) -> T {
    larger(a, b)
}

#[inline(always)]
fn put<T: Real>(planes: &mut [&mut [T]; 6], at: usize, Sym3(block): Sym3<Eight<T>>) {
    for (plane, block) in planes.iter_mut().zip(block) {
        store(plane, at, block);
    }
}
