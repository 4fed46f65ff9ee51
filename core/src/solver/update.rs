//! Y −= W Lᵀ of dense panels, in tiles that stay in registers: what nearly all of a sparse factorisation's time goes into.
//!
//! Y has B block columns (one or two), W any number, all as long as each other; l[m] are the B blocks of L that belong to
//! W's block column m. A tile of Y, sixteen numbers of each column in `f32` and eight in `f64`, is loaded once, takes all of
//! W's columns in their order, and is stored once:
//!
//! y −= (w₀ l₀ + w₁ l₁) + w₂ l₂.
//!
//! Each row is its own sum, so how wide tiles are does not touch the bits.
//!
//! Cost: 18B flops per row and block column of W, and three numbers of W read.

use crate::real::Real;
use crate::solver::panel::Block;
use crate::vec3::{self, Vec3};

/// Some rows of a panel's columns: its numbers, the distance between columns, and the row to begin with.
#[derive(Clone, Copy)]
pub(crate) struct Panel<'a, T> {
    pub(crate) numbers: &'a [T],
    pub(crate) stride: usize,
    pub(crate) from: usize,
}

/// Y −= W Lᵀ for B block columns. Their columns lie `stride` apart, `rows` numbers each; with `NEW`, Y is 0 before.
#[inline(always)]
pub(crate) fn subtract<T: Real, const B: usize, const NEW: bool>(
    y: &mut [T],
    stride: usize,
    rows: usize,
    w: Panel<'_, T>,
    l: &[[Block<T>; B]],
) {
    if size_of::<T>() == 4 && rows >= 16 {
        tiles::<T, 16, B, NEW>(y, stride, rows, w, l);
    } else if rows >= 8 {
        tiles::<T, 8, B, NEW>(y, stride, rows, w, l);
    } else {
        for row in 0..rows {
            let sums = tile::<T, 1, B, NEW>(y, stride, row, w, l);
            put(y, stride, row, sums);
        }
    }
}

#[inline(always)]
fn tiles<T: Real, const N: usize, const B: usize, const NEW: bool>(
    y: &mut [T],
    stride: usize,
    rows: usize,
    w: Panel<'_, T>,
    l: &[[Block<T>; B]],
) {
    // The last tile overlaps the one before it: its rows come from the same numbers, so both have the same.
    let last = rows.saturating_sub(N);
    let end = tile::<T, N, B, NEW>(y, stride, last, w, l);
    let mut at = 0;
    while at < last {
        let sums = tile::<T, N, B, NEW>(y, stride, at, w, l);
        put(y, stride, at, sums);
        at += N;
    }
    put(y, stride, last, end);
}

/// N rows of a block column.
type Three<T, const N: usize> = [[T; N]; 3];

#[inline(always)]
fn tile<T: Real, const N: usize, const B: usize, const NEW: bool>(
    y: &[T],
    stride: usize,
    at: usize,
    w: Panel<'_, T>,
    l: &[[Block<T>; B]],
) -> [Three<T, N>; B] {
    let mut sums = [[[T::ZERO; N]; 3]; B];
    if !NEW {
        for (b, sum) in sums.iter_mut().enumerate() {
            *sum = three(y, 3 * b * stride + at, stride);
        }
    }
    let mut column = w.from + at;
    for blocks in l {
        let three = three(w.numbers, column, w.stride);
        for (sum, block) in sums.iter_mut().zip(blocks) {
            *sum = less(*sum, &three, block);
        }
        column += 3 * w.stride;
    }
    sums
}

#[inline(always)]
fn three<T: Real, const N: usize>(numbers: &[T], at: usize, stride: usize) -> Three<T, N> {
    [load(numbers, at), load(numbers, at + stride), load(numbers, at + 2 * stride)]
}

#[inline(always)]
fn load<T: Real, const N: usize>(numbers: &[T], at: usize) -> [T; N] {
    match numbers.get(at..).and_then(|rest| rest.first_chunk()) {
        Some(rows) => *rows,
        None => [T::ZERO; N],
    }
}

#[inline(always)]
fn put<T: Real, const N: usize, const B: usize>(
    y: &mut [T],
    stride: usize,
    at: usize,
    sums: [Three<T, N>; B],
) {
    for (b, columns) in sums.iter().enumerate() {
        for (c, rows) in columns.iter().enumerate() {
            let at = (3 * b + c) * stride + at;
            if let Some(place) = y.get_mut(at..).and_then(|rest| rest.first_chunk_mut()) {
                *place = *rows;
            }
        }
    }
}

#[inline(always)]
fn less<T: Real, const N: usize>(
    [x, y, z]: Three<T, N>,
    w: &Three<T, N>,
    [k, l, m]: &Block<T>,
) -> Three<T, N> {
    [less_one(x, w, k), less_one(y, w, l), less_one(z, w, m)]
}

/// y − ((w₀ l₀ + w₁ l₁) + w₂ l₂)
#[inline(always)]
fn less_one<T: Real, const N: usize>(mut y: [T; N], [a, b, c]: &Three<T, N>, l: &Vec3<T>) -> [T; N] {
    for (((y, a), b), c) in y.iter_mut().zip(a).zip(b).zip(c) {
        *y -= vec3::dot([*a, *b, *c], *l);
    }
    y
}
