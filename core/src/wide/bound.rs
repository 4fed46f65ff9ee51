//! The residual with its rounding bound and both bounds on the error's energy, in lanes, by the formulas and in the order of
//! [`crate::bound`]; its sums run over places instead of rows.

use crate::bound::{cover, square, unit};
use crate::hessian::Hessian;
use crate::lanes::Lanes;
use crate::real::Real;
use crate::vec3::{self, Vec3};
use crate::wide::eight::{Eight, Planes, all, load, where_positive};
use crate::wide::gather::{Gather, Matrix, gather};
use crate::wide::layout::Layout;
use crate::wide::neighbours::{Neighbours, alike, either};

/// |a| by component.
#[inline(always)]
fn magnitude<T: Real>(a: Vec3<Eight<T>>) -> Vec3<Eight<T>> {
    let [x, y, z] = a;
    [x.abs(), y.abs(), z.abs()]
}

/// 7·(|α||d| + |w|(|w|·|d|)): what the rounding of a spring's term cannot exceed, in units of u.
#[inline(always)]
fn term_error<T: Real>(h: &Hessian<Eight<T>>, d: Vec3<Eight<T>>) -> Vec3<Eight<T>> {
    let (w, d) = (magnitude(h.w), magnitude(d));
    let along = vec3::dot(w, d) + all(T::MIN_POSITIVE);
    vec3::scale(all(T::from_count(7)), vec3::add_scaled(vec3::scale(h.alpha.abs(), d), along, w))
}

/// Where a running sum and the bound on its rounding, in units of u, go.
struct Running<'y, 'a, 'b, T> {
    y: &'y mut Planes<'a, T>,
    g: &'y mut Planes<'b, T>,
}

#[inline(always)]
fn add<T: Real>(
    [y, g]: [Vec3<Eight<T>>; 2],
    term: Vec3<Eight<T>>,
    rounding: Vec3<Eight<T>>,
) -> [Vec3<Eight<T>>; 2] {
    let y = vec3::add(y, term);
    [y, vec3::add(vec3::add(g, magnitude(y)), rounding)]
}

impl<T: Real> Gather<T> for Running<'_, '_, '_, T> {
    type Rows = [Vec3<Eight<T>>; 2];

    #[inline(always)]
    fn new() -> Self::Rows {
        [[all(T::ZERO); 3]; 2]
    }
    #[inline(always)]
    fn above(rows: Self::Rows, h: Hessian<Eight<T>>, apart: Vec3<Eight<T>>) -> Self::Rows {
        add(rows, h.mul(apart), term_error(&h, apart))
    }
    #[inline(always)]
    fn inertia(rows: Self::Rows, m: Eight<T>, here: Vec3<Eight<T>>) -> Self::Rows {
        let term = vec3::scale(m, here);
        add(rows, term, magnitude(term))
    }
    #[inline(always)]
    fn own(rows: Self::Rows, h: Hessian<Eight<T>>, apart: Vec3<Eight<T>>) -> Self::Rows {
        add(rows, h.mul(apart), term_error(&h, apart))
    }
    #[inline(always)]
    fn put_down(&mut self, at: usize, [y, g]: Self::Rows) {
        self.y.store(at, y);
        self.g.store(at, g);
    }
    #[inline(always)]
    fn take_up(&self, at: usize) -> Self::Rows {
        [self.y.load(at), self.g.load(at)]
    }
    #[inline(always)]
    fn finish(&mut self, at: usize, m: Eight<T>, [y, g]: Self::Rows) {
        self.y.store(at, where_positive(m, y));
        self.g.store(at, where_positive(m, g));
    }
}

/// y = A x over the runs, and in g the running bound, before b and δ.
#[inline(always)]
pub(crate) fn product<T: Real>(
    matrix: Matrix<'_, T>,
    x: &Planes<'_, T>,
    y: &mut Planes<'_, T>,
    g: &mut Planes<'_, T>,
) {
    gather(matrix, x, &mut Running { y, g });
}

/// r = b − y and δ = u(1 + 2⁻⁴)(g + |r|) + what underflow can lose; answers Σ |rᵢ|²/μᵢ.
#[inline(always)]
pub(crate) fn finish<T: Real>(
    layout: &Layout,
    b: &Planes<'_, T>,
    weight: &[T],
    r: &mut Planes<'_, T>,
    error: &mut Planes<'_, T>,
) -> T {
    let unit = all(unit::<T>());
    let mut sum = Lanes::new();
    for at in layout.tiles() {
        let left = vec3::sub(b.load(at), r.load(at));
        let g = vec3::add(error.load(at), magnitude(left));
        let least = [all(T::MIN_POSITIVE); 3];
        error.store(at, vec3::add_scaled(least, unit, g));
        r.store(at, left);
        sum.add_lane(square(left, load(weight, at)).0);
    }
    sum.sum()
}

/// ½ Σ |rᵢ|²/μᵢ, not rounded up.
#[inline(always)]
pub(crate) fn weighted<T: Real>(layout: &Layout, r: &Planes<'_, T>, weight: &[T]) -> T {
    let mut sum = Lanes::new();
    for at in layout.tiles() {
        sum.add_lane(square(r.load(at), load(weight, at)).0);
    }
    T::HALF * sum.sum()
}

/// ½ Σ (|rᵢ| + δᵢ)²/μᵢ, rounded up.
#[inline(always)]
pub(crate) fn upper<T: Real>(layout: &Layout, r: &Planes<'_, T>, error: &Planes<'_, T>, weight: &[T]) -> T {
    let mut sum = Lanes::new();
    for at in layout.tiles() {
        let most = vec3::add(magnitude(r.load(at)), error.load(at));
        sum.add_lane(square(most, load(weight, at)).0);
    }
    let (factor, term) = cover(3 * layout.places);
    T::HALF * sum.sum() * factor + term
}

/// Σ xᵀz, Σ |x|ᵀ|z| and Σ eᵀ|z|.
#[inline(always)]
pub(crate) fn products<T: Real>(
    layout: &Layout,
    x: &Planes<'_, T>,
    error: &Planes<'_, T>,
    z: &Planes<'_, T>,
) -> [T; 3] {
    let (mut sum, mut size, mut loss) = (Lanes::new(), Lanes::new(), Lanes::new());
    for at in layout.tiles() {
        let (x, z) = (x.load(at), z.load(at));
        sum.add_lane(vec3::dot(x, z).0);
        let z = magnitude(z);
        size.add_lane(vec3::dot(magnitude(x), z).0);
        loss.add_lane(vec3::dot(error.load(at), z).0);
    }
    [sum.sum(), size.sum(), loss.sum()]
}

/// zᵀAz = Σ m̃|z|² + Σ (α|d|² + (w·d)²), each spring at the row that owns it, and what its rounding is measured by:
/// Σ m̃|z|² + Σ (|α||d|² + (|w|·|d|)²).
#[inline(always)]
pub(crate) fn form<T: Real>(matrix: Matrix<'_, T>, z: &Planes<'_, T>) -> [Lanes<T>; 2] {
    either!(matrix.way, neighbours => form_in(neighbours, matrix, z))
}

#[inline(always)]
fn form_in<T: Real, N: Neighbours>(
    neighbours: N,
    Matrix { layout, hessians, inertia, .. }: Matrix<'_, T>,
    z: &Planes<'_, T>,
) -> [Lanes<T>; 2] {
    let (planes, least) = (alike(z), all(T::MIN_POSITIVE));
    let (mut form, mut size) = (all(T::ZERO), all(T::ZERO));
    for at in layout.tiles() {
        let here = z.load(at);
        let m = load(inertia, at);
        let squared = vec3::dot(here, here);
        form = form + m * squared;
        size = size + m * (squared + least);
        for (h, ends) in neighbours.own(hessians, at) {
            let d = vec3::sub(here, neighbours.vector(planes, ends));
            let (squared, along) = (vec3::dot(d, d), vec3::dot(h.w, d));
            let most = vec3::dot(magnitude(h.w), magnitude(d)) + least;
            form = form + (h.alpha * squared + along * along);
            size = size + (h.alpha.abs() * (squared + least) + most * most);
        }
    }
    [Lanes::of(form.0), Lanes::of(size.0)]
}

/// The same of a point spring.
pub(crate) fn form_of_point<T: Real>(h: &Hessian<T>, z: Vec3<T>) -> [T; 2] {
    let (squared, along) = (vec3::dot(z, z), vec3::dot(h.w, z));
    let most = vec3::dot(vec3::map(h.w, T::abs), vec3::map(z, T::abs)) + T::MIN_POSITIVE;
    [h.alpha * squared + along * along, h.alpha.abs() * (squared + T::MIN_POSITIVE) + most * most]
}

/// What rounding x itself leaves after so many updates, β of δ + k u |A||x|; see [`crate::bound::attainable`]. Into `size`.
#[inline(always)]
pub(crate) fn attainable<T: Real>(matrix: Matrix<'_, T>, x: &Planes<'_, T>, size: &mut Planes<'_, T>) {
    either!(matrix.way, neighbours => sizes(neighbours, matrix, x, size));
}

#[inline(always)]
fn sizes<T: Real, N: Neighbours>(
    neighbours: N,
    Matrix { layout, hessians, inertia, .. }: Matrix<'_, T>,
    x: &Planes<'_, T>,
    size: &mut Planes<'_, T>,
) {
    let planes = alike(x);
    for at in layout.tiles() {
        let here = magnitude(x.load(at));
        let m = load(inertia, at);
        let mut sum = vec3::scale(m, here);
        for (h, ends) in neighbours.above(hessians, at).chain(neighbours.own(hessians, at)) {
            let most = h.alpha.abs() + vec3::dot(h.w, h.w);
            sum = vec3::add_scaled(sum, most, vec3::add(here, magnitude(neighbours.vector(planes, ends))));
        }
        size.store(at, where_positive(m, sum));
    }
}

/// νᵢ = m̃ᵢ + Σ c (max(0, α) + |w|²), c = 2 if the other end is a row too, else 1: A ⪯ diag(ν). Of eight rows.
#[inline(always)]
pub(crate) fn row_sum<T: Real, N: Neighbours>(
    neighbours: N,
    Matrix { hessians, inertia, .. }: Matrix<'_, T>,
    at: usize,
) -> Eight<T> {
    let mut sum = load(inertia, at);
    for (h, ends) in neighbours.above(hessians, at).chain(neighbours.own(hessians, at)) {
        let most = h.alpha.positive_then(h.alpha) + vec3::dot(h.w, h.w);
        sum = sum + (most + neighbours.number(inertia, ends).positive_then(most));
    }
    sum
}

/// (|r| − δ)₊
#[inline(always)]
pub(crate) fn beyond<T: Real>(r: Vec3<Eight<T>>, error: Vec3<Eight<T>>) -> Vec3<Eight<T>> {
    let [x, y, z] = vec3::sub(magnitude(r), error);
    [x.positive_then(x), y.positive_then(y), z.positive_then(z)]
}
