//! Y −= W Lᵀ of dense panels, in tiles that stay in registers: what nearly all of a sparse factorisation's time goes into.
//!
//! Y has C columns (one or two block columns), W three for each of the source's block columns, all as long as each other;
//! l[m] are block column m's rows of L that belong to Y's columns. A tile of 16 rows of Y is loaded once, takes
//! all source columns in their order, and is stored once:
//!
//! y −= (w₀ l₀ + w₁ l₁) + w₂ l₂.
//!
//! Cost: 6 flops per row, column of Y and block column of W; one number of W read for each 2C of them.

use crate::real::Real;
use crate::solver::panel::Block;
use crate::vec3::{self, Vec3};
use crate::wide::eight::{Eight, WIDTH, all, load, store};

/// Rows of a panel's columns: numbers, the distance between columns, and the row to begin with.
#[derive(Clone, Copy)]
pub(crate) struct Panel<'a, T> {
    pub(crate) numbers: &'a [T],
    pub(crate) stride: usize,
    pub(crate) from: usize,
}

/// Three columns, eight rows of each.
type Three<T> = [Eight<T>; 3];

/// Y −= W Lᵀ for B block columns, one or two. Their columns lie `stride` apart, `rows` numbers each; with `NEW`, Y is 0
/// before.
#[inline(always)]
pub(crate) fn subtract<T: Real, const B: usize, const NEW: bool>(
    y: &mut [T],
    stride: usize,
    rows: usize,
    w: Panel<'_, T>,
    l: &[[Block<T>; B]],
) {
    let Some(last) = rows.checked_sub(WIDTH) else {
        for row in 0..rows {
            one_row::<T, B, NEW>(y, stride, row, w, l);
        }
        return;
    };
    // The last eight rows overlap what comes before them: all have the same numbers to begin with and so in the end.
    let end = tile::<T, B, NEW>(y, stride, last, w, l);
    let mut at = 0;
    while at < last {
        let sums = tile::<T, B, NEW>(y, stride, at, w, l);
        put(y, stride, at, sums);
        at += WIDTH;
    }
    put(y, stride, last, end);
}

#[inline(always)]
fn tile<T: Real, const B: usize, const NEW: bool>(
    y: &[T],
    stride: usize,
    at: usize,
    w: Panel<'_, T>,
    l: &[[Block<T>; B]],
) -> [Three<T>; B] {
    let mut sums = [[all(T::ZERO); 3]; B];
    if !NEW {
        for (b, sum) in sums.iter_mut().enumerate() {
            *sum = three(y, 3 * b * stride + at, stride);
        }
    }
    let mut column = w.from + at;
    for blocks in l {
        let three = three(w.numbers, column, w.stride);
        for (sum, block) in sums.iter_mut().zip(blocks) {
            *sum = less(*sum, three, block);
        }
        column += 3 * w.stride;
    }
    sums
}

/// One row where there are fewer than eight.
#[inline(always)]
fn one_row<T: Real, const B: usize, const NEW: bool>(
    y: &mut [T],
    stride: usize,
    row: usize,
    w: Panel<'_, T>,
    l: &[[Block<T>; B]],
) {
    for b in 0..B {
        let mut sums = [T::ZERO; 3];
        let number = |numbers: &[T], at: usize| numbers.get(at).copied().unwrap_or(T::ZERO);
        let three = |numbers: &[T], at: usize, stride: usize| {
            [number(numbers, at), number(numbers, at + stride), number(numbers, at + 2 * stride)]
        };
        let from = 3 * b * stride + row;
        if !NEW {
            sums = three(y, from, stride);
        }
        let mut column = w.from + row;
        for blocks in l {
            if let Some([k, l, m]) = blocks.get(b) {
                let w = three(w.numbers, column, w.stride);
                sums = vec3::sub(sums, [vec3::dot(w, *k), vec3::dot(w, *l), vec3::dot(w, *m)]);
            }
            column += 3 * w.stride;
        }
        for (c, sum) in sums.into_iter().enumerate() {
            if let Some(y) = y.get_mut(from + c * stride) {
                *y = sum;
            }
        }
    }
}

#[inline(always)]
fn three<T: Real>(numbers: &[T], at: usize, stride: usize) -> Three<T> {
    [load(numbers, at), load(numbers, at + stride), load(numbers, at + 2 * stride)]
}

#[inline(always)]
fn put<T: Real, const B: usize>(y: &mut [T], stride: usize, at: usize, sums: [Three<T>; B]) {
    for (b, [x, y_, z]) in sums.into_iter().enumerate() {
        let at = 3 * b * stride + at;
        store(y, at, x);
        store(y, at + stride, y_);
        store(y, at + 2 * stride, z);
    }
}

/// y − ((w₀ l₀ + w₁ l₁) + w₂ l₂), for three columns.
#[inline(always)]
fn less<T: Real>([x, y, z]: Three<T>, w: Three<T>, [k, l, m]: &Block<T>) -> Three<T> {
    [less_one(x, w, k), less_one(y, w, l), less_one(z, w, m)]
}

#[inline(always)]
fn less_one<T: Real>(y: Eight<T>, [a, b, c]: Three<T>, [k, l, m]: &Vec3<T>) -> Eight<T> {
    y - ((a * all(*k) + b * all(*l)) + c * all(*m))
}
