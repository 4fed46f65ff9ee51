//! The numbers of a chain in eight pieces side by side, place by place: see [`crate::wide::pieces`].

use crate::hessian::Hessian;
use crate::real::Real;
use crate::sym3::Sym3;
use crate::vec3::Vec3;
use crate::wide::eight::{Eight, Planes, WIDTH, all, load, store};

/// Numbers per place: S⁻¹, α and w of C, F by columns, y.
pub(crate) const KEPT: usize = 6 + 4 + 9 + 3;
/// Where S⁻¹ lies, before that m̃.
pub(crate) const BLOCK: usize = 0;
/// Where C lies.
pub(crate) const COUPLING: usize = 6;
/// Where F lies; before that R, and what else is on the diagonal.
pub(crate) const SPIKE: usize = 10;
/// Where a right side becomes an answer.
pub(crate) const VECTOR: usize = 19;

/// The k-th rows of the pieces.
pub(crate) type Rows<T> = [[T; WIDTH]; KEPT];

/// A 3×3 block by columns.
pub(crate) type Block<V> = [Vec3<V>; 3];

#[inline(always)]
pub(crate) fn take<T: Real, const N: usize>(rows: &Rows<T>, from: usize) -> [Eight<T>; N] {
    let mut out = [all(T::ZERO); N];
    for (k, out) in out.iter_mut().enumerate() {
        *out = Eight(*rows.get(from + k).unwrap_or(T::ZEROS));
    }
    out
}

#[inline(always)]
pub(crate) fn put<T: Real, const N: usize>(rows: &mut Rows<T>, from: usize, values: [Eight<T>; N]) {
    for (k, value) in values.iter().enumerate() {
        if let Some(place) = rows.get_mut(from + k) {
            *place = value.0;
        }
    }
}

#[inline(always)]
pub(crate) fn columns<V: Copy>([a, b, c, d, e, f, g, h, i]: [V; 9]) -> Block<V> {
    [[a, b, c], [d, e, f], [g, h, i]]
}

#[inline(always)]
pub(crate) fn flat<V: Copy>([[a, b, c], [d, e, f], [g, h, i]]: Block<V>) -> [V; 9] {
    [a, b, c, d, e, f, g, h, i]
}

/// Cuts a workspace into rows for so many places; `None` if it is too small.
pub(crate) fn cut<T: Real>(workspace: &mut [T], places: usize) -> Option<&mut [Rows<T>]> {
    workspace.as_chunks_mut().0.as_chunks_mut().0.get_mut(..places / WIDTH)
}

/// Planes into the rows from `from` on: piece by piece side by side.
#[inline(always)]
pub(crate) fn spread<T: Real, const N: usize>(
    planes: [&[T]; N],
    pad: usize,
    rows: &mut [Rows<T>],
    from: usize,
) {
    let length = rows.len();
    for first in blocks(length) {
        let Some(rows) = rows.get_mut(first..).and_then(|rows| rows.first_chunk_mut::<WIDTH>()) else {
            return;
        };
        for (c, plane) in planes.iter().enumerate() {
            let at = pad + first;
            for (l, piece) in (0..WIDTH).map(|l| (l, load(plane, at + l * length).0)) {
                for (rows, value) in rows.iter_mut().zip(&piece) {
                    if let Some(place) = rows.get_mut(from + c).and_then(|place| place.get_mut(l)) {
                        *place = *value;
                    }
                }
            }
        }
    }
}

/// Where blocks of eight rows begin; the last overlaps the one before it.
#[inline(always)]
fn blocks(length: usize) -> impl Iterator<Item = usize> {
    let last = length.saturating_sub(WIDTH);
    (0..length.div_ceil(WIDTH)).map(move |k| if k * WIDTH < last { k * WIDTH } else { last })
}

/// The spring to the next row.
#[inline(always)]
pub(crate) fn spring<T: Real>(rows: &Rows<T>) -> Hessian<Eight<T>> {
    let [alpha, x, y, z] = take(rows, COUPLING);
    Hessian { alpha, w: [x, y, z] }
}

/// Nothing else on the diagonals.
pub(crate) fn clear<T: Real>(rows: &mut [Rows<T>]) {
    for rows in rows {
        put(rows, SPIKE, [all(T::ZERO); 6]);
    }
}

/// The diagonal of the row at this place += H.
pub(crate) fn add_to_diagonal<T: Real>(rows: &mut [Rows<T>], place: usize, h: &Hessian<T>) {
    let length = rows.len().max(1);
    let (lane, added) = (place / length, Sym3::scalar(h.alpha).plus_outer(h.w).0);
    let Some(rows) = rows.get_mut(place % length) else { return };
    for (lanes, added) in rows.iter_mut().skip(SPIKE).zip(added) {
        if let Some(entry) = lanes.get_mut(lane) {
            *entry += added;
        }
    }
}

/// y of the rows into planes.
#[inline(always)]
pub(crate) fn put_back<T: Real>(rows: &[Rows<T>], to: &mut Planes<'_, T>, pad: usize) {
    let length = rows.len();
    for first in blocks(length) {
        let Some(rows) = rows.get(first..).and_then(|rows| rows.first_chunk::<WIDTH>()) else { return };
        for (c, plane) in to.0.iter_mut().enumerate() {
            for l in 0..WIDTH {
                let mut piece = [T::ZERO; WIDTH];
                for (place, rows) in piece.iter_mut().zip(rows) {
                    *place = rows.get(VECTOR + c).and_then(|lanes| lanes.get(l)).copied().unwrap_or(T::ZERO);
                }
                store(plane, pad + first + l * length, Eight(piece));
            }
        }
    }
}
