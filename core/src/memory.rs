//! Where a scene keeps its numbers. The algorithms see slices; three kinds of owner hand them out:
//!
//! - [`Fixed`]: arrays of a capacity known at compile time, built in place by a `const fn` (so a `static` lands in
//!   .bss and never crosses the stack);
//! - [`Slices`]: two borrowed buffers of any size, one of numbers and one of words;
//! - growable lists, on a host (the harness brings them by implementing [`Memory`] on `Vec`).

use core::marker::PhantomData;
use core::ops::{Deref, DerefMut, Range};

use crate::law::{Hookean, Law};
use crate::real::Real;

/// A list that knows when it is full.
pub trait List<X: Copy>: Deref<Target = [X]> + DerefMut {
    /// Appends `x`; `false`, and no change, if there is no room.
    fn push(&mut self, x: X) -> bool;
    /// Empties the list.
    fn clear(&mut self);
    /// How many items there is room for.
    fn room(&self) -> usize;
}

/// An owner of a scene's lists: one family for what belongs to particles, one for what belongs to springs. All lists of
/// a family must have the same room: a scene fills them side by side.
pub trait Memory {
    /// The precision.
    type Real: Real;
    /// Which springs go slack.
    type Law: Law;
    /// A list with one item per particle.
    type Particles<X: Copy + 'static>: List<X>;
    /// A list with one item per spring.
    type Springs<X: Copy + 'static>: List<X>;
}

/// Arrays for up to `N` particles and `S` springs.
pub struct Fixed<T, const N: usize, const S: usize, L = Hookean>(PhantomData<(T, L)>);

impl<T: Real, const N: usize, const S: usize, L: Law> Memory for Fixed<T, N, S, L> {
    type Real = T;
    type Law = L;
    type Particles<X: Copy + 'static> = heapless::Vec<X, N>;
    type Springs<X: Copy + 'static> = heapless::Vec<X, S>;
}

impl<X: Copy, const N: usize> List<X> for heapless::Vec<X, N> {
    #[inline]
    fn push(&mut self, x: X) -> bool {
        heapless::Vec::push(self, x).is_ok()
    }
    #[inline]
    fn clear(&mut self) {
        heapless::Vec::clear(self);
    }
    #[inline]
    fn room(&self) -> usize {
        N
    }
}

/// Borrowed buffers of any size: see [`crate::MassSpring::in_buffers`].
pub struct Slices<'a, T, L = Hookean>(PhantomData<(&'a T, L)>);

impl<'a, T: Real, L: Law> Memory for Slices<'a, T, L> {
    type Real = T;
    type Law = L;
    type Particles<X: Copy + 'static> = SliceList<'a, X>;
    type Springs<X: Copy + 'static> = SliceList<'a, X>;
}

/// A list in a borrowed slice.
#[derive(Debug)]
pub struct SliceList<'a, X> {
    buffer: &'a mut [X],
    len: usize,
}

impl<'a, X> SliceList<'a, X> {
    /// An empty list with room for the whole slice.
    pub fn new(buffer: &'a mut [X]) -> Self {
        Self { buffer, len: 0 }
    }

    /// A list whose first `len` items are already in the slice; `None` if it has not so many.
    pub(crate) fn filled(buffer: &'a mut [X], len: usize) -> Option<Self> {
        if len <= buffer.len() { Some(Self { buffer, len }) } else { None }
    }
}

impl<X> Deref for SliceList<'_, X> {
    type Target = [X];
    #[inline]
    fn deref(&self) -> &[X] {
        self.buffer.get(..self.len).unwrap_or_default()
    }
}

impl<X> DerefMut for SliceList<'_, X> {
    #[inline]
    fn deref_mut(&mut self) -> &mut [X] {
        self.buffer.get_mut(..self.len).unwrap_or_default()
    }
}

impl<X: Copy> List<X> for SliceList<'_, X> {
    #[inline]
    fn push(&mut self, x: X) -> bool {
        let Some(place) = self.buffer.get_mut(self.len) else { return false };
        *place = x;
        self.len += 1;
        true
    }
    #[inline]
    fn clear(&mut self) {
        self.len = 0;
    }
    #[inline]
    fn room(&self) -> usize {
        self.buffer.len()
    }
}

/// Part of a slice, empty if it has none.
#[inline(always)]
pub(crate) fn part<X>(slice: &[X], range: Range<usize>) -> &[X] {
    slice.get(range).unwrap_or_default()
}

/// As [`part`], mutable.
#[inline(always)]
pub(crate) fn part_mut<X>(slice: &mut [X], range: Range<usize>) -> &mut [X] {
    slice.get_mut(range).unwrap_or_default()
}

/// Appends what `from` holds to an emptied `to`; `false` if it does not fit.
pub(crate) fn copy<X: Copy>(to: &mut impl List<X>, from: &[X]) -> bool {
    to.clear();
    from.iter().all(|x| to.push(*x))
}
