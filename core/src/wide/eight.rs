//! Eight rows side by side. Written so that a compiler finds the vector registers; each lane is its own row, so how wide
//! they are does not touch the bits.

use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::real::Real;
use crate::vec3::Vec3;

/// How many there are.
pub(crate) const WIDTH: usize = 8;

/// A number of each row.
#[derive(Clone, Copy)]
pub(crate) struct Eight<T>(pub(crate) [T; WIDTH]);

/// The same number for each.
#[inline(always)]
pub(crate) fn all<T: Real>(x: T) -> Eight<T> {
    Eight([x; WIDTH])
}

impl<T: Real> Eight<T> {
    /// f of each lane.
    #[inline(always)]
    pub(crate) fn map(mut self, f: impl Fn(T) -> T) -> Self {
        for a in &mut self.0 {
            *a = f(*a);
        }
        self
    }

    /// f of each pair of lanes.
    #[inline(always)]
    pub(crate) fn zip(mut self, other: Self, f: impl Fn(T, T) -> T) -> Self {
        for (a, b) in self.0.iter_mut().zip(&other.0) {
            *a = f(*a, *b);
        }
        self
    }

    /// √
    #[inline(always)]
    pub(crate) fn sqrt(self) -> Self {
        self.map(
            #[inline(always)]
            |a| a.sqrt(),
        )
    }

    /// |a|
    #[inline(always)]
    pub(crate) fn abs(self) -> Self {
        self.map(
            #[inline(always)]
            |a| a.abs(),
        )
    }

    /// Where self > 0 what is given, else 0.
    #[inline(always)]
    pub(crate) fn positive_then(self, then: Self) -> Self {
        self.zip(
            then,
            #[inline(always)]
            |a, b| if a > T::ZERO { b } else { T::ZERO },
        )
    }

    /// Is any lane as told?
    #[inline(always)]
    pub(crate) fn any(self, is: impl Fn(T) -> bool) -> bool {
        let mut any = false;
        for a in &self.0 {
            any |= is(*a);
        }
        any
    }
}

impl<T: Real> Add for Eight<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(
            other,
            #[inline(always)]
            |a, b| a + b,
        )
    }
}

impl<T: Real> Sub for Eight<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(
            other,
            #[inline(always)]
            |a, b| a - b,
        )
    }
}

impl<T: Real> Mul for Eight<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(
            other,
            #[inline(always)]
            |a, b| a * b,
        )
    }
}

impl<T: Real> Div for Eight<T> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.zip(
            other,
            #[inline(always)]
            |a, b| a / b,
        )
    }
}

impl<T: Real> Neg for Eight<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(
            #[inline(always)]
            |a| -a,
        )
    }
}

/// Where m > 0 the vector, else 0.
#[inline(always)]
pub(crate) fn where_positive<T: Real>(m: Eight<T>, [x, y, z]: Vec3<Eight<T>>) -> Vec3<Eight<T>> {
    [m.positive_then(x), m.positive_then(y), m.positive_then(z)]
}

/// Where `mark` > 0 one, else the other.
#[inline(always)]
pub(crate) fn choose<T: Real>(mark: Eight<T>, one: Eight<T>, other: Eight<T>) -> Eight<T> {
    let mut out = other;
    for ((out, one), mark) in out.0.iter_mut().zip(&one.0).zip(&mark.0) {
        *out = if *mark > T::ZERO { *one } else { *out };
    }
    out
}

/// Eight numbers of a plane from the i-th on; zeros past its end.
#[inline(always)]
pub(crate) fn load<T: Real>(plane: &[T], i: usize) -> Eight<T> {
    Eight(*plane.get(i..).and_then(|rest| rest.first_chunk()).unwrap_or(T::ZEROS))
}

#[inline(always)]
pub(crate) fn store<T: Real>(plane: &mut [T], i: usize, lanes: Eight<T>) {
    if let Some(place) = plane.get_mut(i..).and_then(|rest| rest.first_chunk_mut()) {
        *place = lanes.0;
    }
}

/// A vector per row, by component.
pub(crate) struct Planes<'a, T>(pub(crate) [&'a mut [T]; 3]);

impl<T: Real> Planes<'_, T> {
    /// Eight rows.
    #[inline(always)]
    pub(crate) fn load(&self, i: usize) -> Vec3<Eight<T>> {
        let [x, y, z] = &self.0;
        [load(x, i), load(y, i), load(z, i)]
    }

    #[inline(always)]
    pub(crate) fn store(&mut self, i: usize, [a, b, c]: Vec3<Eight<T>>) {
        let [x, y, z] = &mut self.0;
        store(x, i, a);
        store(y, i, b);
        store(z, i, c);
    }

    /// One row.
    #[inline(always)]
    pub(crate) fn row(&self, i: usize) -> Vec3<T> {
        let [x, y, z] = &self.0;
        let of = |plane: &[T]| plane.get(i).copied().unwrap_or(T::ZERO);
        [of(x), of(y), of(z)]
    }

    #[inline(always)]
    pub(crate) fn put(&mut self, i: usize, row: Vec3<T>) {
        for (plane, value) in self.0.iter_mut().zip(row) {
            if let Some(place) = plane.get_mut(i) {
                *place = value;
            }
        }
    }

    /// Zeros before and behind the places: what lies there is read as a neighbour.
    pub(crate) fn clear_margins(&mut self, before: usize, behind: usize) {
        for plane in &mut self.0 {
            let end = plane.len().saturating_sub(behind);
            for part in [0..before, end..plane.len()] {
                if let Some(part) = plane.get_mut(part) {
                    part.fill(T::ZERO);
                }
            }
        }
    }
}

/// Each lane has what the lane before it had.
#[inline(always)]
pub(crate) fn later<T: Real>(Eight([a, b, c, d, e, f, g, _]): Eight<T>) -> Eight<T> {
    Eight([T::ZERO, a, b, c, d, e, f, g])
}

/// Each lane has what the lane after it had.
#[inline(always)]
pub(crate) fn earlier<T: Real>(Eight([_, b, c, d, e, f, g, h]): Eight<T>) -> Eight<T> {
    Eight([b, c, d, e, f, g, h, T::ZERO])
}

/// A lane's number; 0 where there is none.
#[inline(always)]
pub(crate) fn lane<T: Real>(of: Eight<T>, l: usize) -> T {
    of.0.get(l).copied().unwrap_or(T::ZERO)
}
