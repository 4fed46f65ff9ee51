//! D⁻¹ in tiles: the 3×3 blocks of A's diagonal and their inverses, by the formulas of [`crate::Sym3`].

use crate::force::Force;
use crate::hessian::Hessian;
use crate::real::{Real, larger};
use crate::sym3::Sym3;
use crate::system::System;
use crate::wide::layout::{Layout, place};
use crate::wide::product::{each_anchor, hessian, springs};
use crate::wide::tile::{TILE, Tile, tile, tile_mut};
use crate::wide::work::{Work, tiles};

/// D = M̃ + Σ H into the planes of the inverse.
#[inline(always)]
pub(crate) fn blocks<T: Real>(layout: &Layout, work: &mut Work<'_, T>) {
    for at in tiles(layout) {
        let (m, zero) = (*tile(work.inertia, at), [T::ZERO; TILE]);
        let mut blocks = [m, m, m, zero, zero, zero];
        for (run, d) in layout.distances().iter().enumerate() {
            for at in [at - *d as usize, at] {
                let h = springs(work.runs, layout.plane(), run, at);
                for i in 0..TILE {
                    let h = hessian(h, i);
                    let block = get(&blocks, i).plus_scalar(h.alpha).plus_outer(h.w);
                    put(&mut blocks, i, block);
                }
            }
        }
        put_tiles(work, at, blocks);
    }
}

/// Springs to pins, and point springs.
pub(crate) fn anchors<T: Real, F: Force<T>>(
    system: &System<'_, T, F>,
    layout: &Layout,
    list: &[u32],
    work: &mut Work<'_, T>,
) {
    let mut add = |row: usize, h: Hessian<T>| {
        let Some(place) = place(system.matrix, row) else { return };
        let added = Sym3::scalar(h.alpha).plus_outer(h.w).0;
        for (plane, added) in work.inverse.iter_mut().zip(added) {
            if let Some(entry) = plane.get_mut(layout.pad + place) {
                *entry += added;
            }
        }
    };
    each_anchor(system, list, &mut add);
    system.each_point(add);
}

/// D ← D⁻¹. Where a pivot is not positive the largest diagonal entry stands for the block; where there is no row, 0.
#[inline(always)]
pub(crate) fn invert<T: Real>(layout: &Layout, work: &mut Work<'_, T>) {
    for at in tiles(layout) {
        let mut blocks = [[T::ZERO; TILE]; 6];
        for (block, plane) in blocks.iter_mut().zip(&work.inverse) {
            *block = *tile(plane, at);
        }
        for i in 0..TILE {
            let inverse = inverse(get(&blocks, i));
            put(&mut blocks, i, inverse);
        }
        put_tiles(work, at, blocks);
    }
}

/// The inverse without a branch: every row takes the same steps.
#[inline(always)]
fn inverse<T: Real>(block: Sym3<T>) -> Sym3<T> {
    let (inverse, pivots) = block.inverse_and_pivots();
    let [xx, yy, zz, ..] = block.0;
    let largest = larger(larger(xx, yy), zz);
    let scalar = if largest > T::ZERO { T::ONE / largest } else { T::ZERO };
    let sound = pivots[0] > T::ZERO && pivots[1] > T::ZERO && pivots[2] > T::ZERO;
    let [a, b, c, d, e, f] = inverse.0;
    let choose = |inverse: T, instead: T| if sound { inverse } else { instead };
    let zero = T::ZERO;
    Sym3([
        choose(a, scalar),
        choose(b, scalar),
        choose(c, scalar),
        choose(d, zero),
        choose(e, zero),
        choose(f, zero),
    ])
}

#[inline(always)]
fn put_tiles<T: Real>(work: &mut Work<'_, T>, at: usize, blocks: [Tile<T>; 6]) {
    for (plane, block) in work.inverse.iter_mut().zip(blocks) {
        if let Some(place) = tile_mut(plane, at) {
            *place = block;
        }
    }
}

#[inline(always)]
#[expect(clippy::indexing_slicing)] // As in `row`.
fn get<T: Real>([a, b, c, d, e, f]: &[Tile<T>; 6], i: usize) -> Sym3<T> {
    Sym3([a[i], b[i], c[i], d[i], e[i], f[i]])
}

#[inline(always)]
#[expect(clippy::indexing_slicing)] // As in `row`.
fn put<T: Real>([a, b, c, d, e, f]: &mut [Tile<T>; 6], i: usize, block: Sym3<T>) {
    [a[i], b[i], c[i], d[i], e[i], f[i]] = block.0;
}
