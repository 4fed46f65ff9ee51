//! Dense pieces of a block factor: a *block column* is three columns of equal length, one after the other, three numbers
//! per block row. What is stored is W = L S, not yet divided by its pivot S, so that nothing is scaled in place.

use crate::real::Real;
use crate::sym3::Sym3;
use crate::vec3::Vec3;

/// A 3×3 block by rows.
pub(crate) type Block<T> = [Vec3<T>; 3];

/// The three columns of a block column.
#[inline(always)]
pub(crate) fn three<T>(column: &[T]) -> Option<[&[T]; 3]> {
    let third = column.len() / 3;
    let (a, rest) = column.split_at_checked(third)?;
    let (b, c) = rest.split_at_checked(third)?;
    Some([a, b, c])
}

/// As [`three`], mutable.
#[inline(always)]
pub(crate) fn three_mut<T>(column: &mut [T]) -> Option<[&mut [T]; 3]> {
    let third = column.len() / 3;
    let (a, rest) = column.split_at_mut_checked(third)?;
    let (b, c) = rest.split_at_mut_checked(third)?;
    Some([a, b, c])
}

/// Three columns without their first `rows` block rows.
#[inline(always)]
pub(crate) fn below<T>(columns: [&[T]; 3], rows: usize) -> [&[T]; 3] {
    columns.map(|column| column.get(3 * rows..).unwrap_or_default())
}

/// As [`below`], mutable.
#[inline(always)]
pub(crate) fn below_mut<T>(columns: [&mut [T]; 3], rows: usize) -> [&mut [T]; 3] {
    columns.map(|column| column.get_mut(3 * rows..).unwrap_or_default())
}

/// The first block of three columns; zeros if they are shorter.
#[inline(always)]
pub(crate) fn first<T: Real>([a, b, c]: [&[T]; 3]) -> Block<T> {
    match (a, b, c) {
        ([ax, ay, az, ..], [bx, by, bz, ..], [cx, cy, cz, ..]) => {
            [[*ax, *bx, *cx], [*ay, *by, *cy], [*az, *bz, *cz]]
        }
        _ => [[T::ZERO; 3]; 3],
    }
}

/// W S⁻¹ of one block.
#[inline(always)]
pub(crate) fn divided<T: Real>(w: Block<T>, inverse: &Sym3<T>) -> Block<T> {
    [inverse.mul(w[0]), inverse.mul(w[1]), inverse.mul(w[2])]
}

/// Y −= W Lᵀ, L one block and Y, W three columns each.
#[inline(always)]
pub(crate) fn subtract<T: Real>(y: [&mut [T]; 3], w: [&[T]; 3], l: &Block<T>) {
    let ([y0, y1, y2], [w0, w1, w2]) = (y, w);
    rank_three(y0, y1, y2, w0, w1, w2, l);
}

/// Columns as parameters of their own: only so does the compiler know that they do not overlap.
#[inline(never)]
fn rank_three<T: Real>(
    y0: &mut [T],
    y1: &mut [T],
    y2: &mut [T],
    w0: &[T],
    w1: &[T],
    w2: &[T],
    [l0, l1, l2]: &Block<T>,
) {
    let columns = y0.iter_mut().zip(y1).zip(y2).zip(w0.iter().zip(w1).zip(w2));
    for (((y0, y1), y2), ((w0, w1), w2)) in columns {
        *y0 -= (*w0 * l0[0] + *w1 * l0[1]) + *w2 * l0[2];
        *y1 -= (*w0 * l1[0] + *w1 * l1[1]) + *w2 * l1[2];
        *y2 -= (*w0 * l2[0] + *w1 * l2[1]) + *w2 * l2[2];
    }
}
