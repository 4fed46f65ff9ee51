//! y = A x and xᵀA x over offset runs, by gathering: row i is
//!
//! ((0 − Σ_d H(i−d, i) (x_{i−d} − x_i)) + m̃ᵢ xᵢ) + Σ_d H(i, i+d) (x_i − x_{i+d}),
//!
//! first the farthest row above, last the farthest below; then springs to pins and point springs. A spring is computed at
//! both of its ends from the same numbers, so what it adds to one row it takes from the other bit for bit. No index, no
//! scatter; each row's sum is its own, so the width of the registers does not touch the bits.
//!
//! Cost: 40 flops per spring and 9 for the form, 12 per row; 4 numbers per spring read twice (the second time from the cache).
//! Computing each spring once and subtracting it below was a sixth slower: the rows below overlap what was just written.

use crate::force::Force;
use crate::hessian::Hessian;
use crate::lanes::Lanes;
use crate::real::Real;
use crate::system::System;
use crate::vec3::{self, Vec3};
use crate::wide::layout::{Layout, place};
use crate::wide::tile::{TILE, Tile, add_terms, row, tile};
use crate::wide::work::{Planes, tiles};

/// α and w of a tile of a run's springs.
#[inline(always)]
pub(crate) fn springs<T: Real>(runs: &[T], plane: usize, run: usize, at: usize) -> [&Tile<T>; 4] {
    let first = 4 * run * plane + at;
    [0, 1, 2, 3].map(
        #[inline(always)]
        |k| tile(runs, first + k * plane),
    )
}

/// H of row i.
#[inline(always)]
pub(crate) fn hessian<T: Real>([alpha, x, y, z]: [&Tile<T>; 4], i: usize) -> Hessian<T> {
    #[expect(clippy::indexing_slicing)] // As in `row`.
    Hessian { alpha: alpha[i], w: [x[i], y[i], z[i]] }
}

/// A vector per row of a tile, by component.
type Sums<T> = [Tile<T>; 3];

/// y = A x over the runs; answers the partial sums of xᵀA x.
#[inline(always)]
pub(crate) fn over_runs<T: Real>(
    layout: &Layout,
    runs: &[T],
    inertia: &[T],
    x: &Planes<'_, T>,
    y: &mut Planes<'_, T>,
) -> Lanes<T> {
    let plane = layout.plane();
    let mut form = Lanes::new();
    for at in tiles(layout) {
        let here = x.tiles(at);
        let mut sum = [[T::ZERO; TILE]; 3];
        let mut energy = [T::ZERO; TILE];
        for (run, d) in layout.distances().iter().enumerate().rev() {
            let above = at - *d as usize;
            take_from_above(springs(runs, plane, run, above), x.tiles(above), here, &mut sum);
        }
        add_inertia(tile(inertia, at), here, &mut sum, &mut energy);
        for (run, d) in layout.distances().iter().enumerate() {
            let below = x.tiles(at + *d as usize);
            add_own(springs(runs, plane, run, at), here, below, &mut sum, &mut energy);
        }
        y.put_tiles(at, sum);
        add_terms(&mut form, &energy);
    }
    form
}

#[inline(always)]
#[expect(clippy::indexing_slicing)] // As in `row`.
fn add_to<T: Real>(sum: &mut Sums<T>, i: usize, term: Vec3<T>) {
    let [x, y, z] = sum;
    (x[i], y[i], z[i]) = (x[i] + term[0], y[i] + term[1], z[i] + term[2]);
}

/// Σ −H (x_{i−d} − x_i)
#[inline(always)]
fn take_from_above<T: Real>(h: [&Tile<T>; 4], above: [&Tile<T>; 3], here: [&Tile<T>; 3], sum: &mut Sums<T>) {
    for i in 0..TILE {
        let product = hessian(h, i).mul_and_form(vec3::sub(row(above, i), row(here, i))).0;
        add_to(sum, i, vec3::scale(-T::ONE, product));
    }
}

/// m̃ x, and m̃|x|²
#[inline(always)]
#[allow(clippy::indexing_slicing, clippy::needless_range_loop)] // As in `row`.
fn add_inertia<T: Real>(m: &Tile<T>, here: [&Tile<T>; 3], sum: &mut Sums<T>, energy: &mut Tile<T>) {
    for i in 0..TILE {
        let x = row(here, i);
        add_to(sum, i, vec3::scale(m[i], x));
        energy[i] = m[i] * vec3::dot(x, x);
    }
}

/// Σ H (x_i − x_{i+d}), and its form
#[inline(always)]
#[allow(clippy::indexing_slicing, clippy::needless_range_loop)] // As in `row`.
fn add_own<T: Real>(
    h: [&Tile<T>; 4],
    here: [&Tile<T>; 3],
    below: [&Tile<T>; 3],
    sum: &mut Sums<T>,
    energy: &mut Tile<T>,
) {
    for i in 0..TILE {
        let (product, form) = hessian(h, i).mul_and_form(vec3::sub(row(here, i), row(below, i)));
        add_to(sum, i, product);
        energy[i] += form;
    }
}

/// Adds what belongs to one row only: springs to pins, and point springs.
pub(crate) fn over_anchors<T: Real, F: Force<T>>(
    system: &System<'_, T, F>,
    layout: &Layout,
    anchors: &[u32],
    x: &Planes<'_, T>,
    y: &mut Planes<'_, T>,
    form: &mut Lanes<T>,
) {
    let mut add = |row: usize, h: Hessian<T>| {
        let Some(place) = place(system.matrix, row) else { return };
        let at = layout.pad + place;
        let (product, energy) = h.mul_and_form(x.row(at));
        y.put(at, vec3::add(y.row(at), product));
        form.add(place, energy);
    };
    each_anchor(system, anchors, &mut add);
    system.each_point(add);
}

/// The springs to pins: `anchors` holds (row, place in the lists) of each.
#[inline(always)]
pub(crate) fn each_anchor<T: Real, F: Force<T>>(
    system: &System<'_, T, F>,
    anchors: &[u32],
    visit: &mut impl FnMut(usize, Hessian<T>),
) {
    for [row, edge] in anchors.as_chunks().0 {
        if let Some(h) = system.matrix.hessian.get(*edge as usize) {
            visit(*row as usize, Hessian::unpack(*h));
        }
    }
}
