//! Rows and their springs in offset runs ([`crate::wide::layout`]): other ends lie a distance on, the Hessians of rows above as
//! far back.

use crate::hessian::Hessian;
use crate::real::Real;
use crate::vec3::Vec3;
use crate::wide::eight::{Eight, load};
use crate::wide::layout::{Layout, eights};
use crate::wide::neighbours::Neighbours;
use crate::wide::work::hessians;

/// Offset runs.
#[derive(Clone, Copy)]
pub(crate) struct Runs<'l> {
    pub(crate) layout: &'l Layout,
    /// Where each spring lies, in the scene's order; none where nobody asks for springs one by one
    pub(crate) words: &'l [u32],
    /// Of which place the first pulls are. There are those of a stretch, and before them those of the rows that reach it.
    from: usize,
}

impl<'l> Runs<'l> {
    /// With the first stretch's pulls in view.
    pub(crate) fn new(layout: &'l Layout, words: &'l [u32]) -> Self {
        Self { layout, words, from: 0 }
    }

    #[inline(always)]
    fn of_pulls<T: Real>(self, pulls: &[T], spring: [usize; 2]) -> Vec3<Eight<T>> {
        [0, 1, 2].map(
            #[inline(always)]
            |k| load(pulls, self.pull(spring, k)),
        )
    }
}

impl Neighbours for Runs<'_> {
    /// Run and place.
    type Spring = [usize; 2];
    type Ends = usize;

    #[inline(always)]
    fn above<T: Real>(self, planes: &[T], at: usize) -> impl Iterator<Item = (Hessian<Eight<T>>, usize)> {
        let n = self.layout.plane();
        self.layout.distances().iter().enumerate().rev().map(
            #[inline(always)]
            move |(run, d)| (hessians(planes, n, run, at - *d as usize), at - *d as usize),
        )
    }
    #[inline(always)]
    fn own<T: Real>(self, planes: &[T], at: usize) -> impl Iterator<Item = (Hessian<Eight<T>>, usize)> {
        let n = self.layout.plane();
        self.layout.distances().iter().enumerate().map(
            #[inline(always)]
            move |(run, d)| (hessians(planes, n, run, at), at + *d as usize),
        )
    }
    #[inline(always)]
    fn stretch(self, first: usize) -> (Self, usize) {
        let Layout { pad, places, .. } = *self.layout;
        let stop = core::cmp::min(first + self.layout.stretch(), pad + places);
        (Self { from: first - pad, ..self }, stop)
    }
    #[inline(always)]
    fn each_spring(self, rows: [usize; 2], mut visit: impl FnMut([usize; 2], usize, usize)) {
        for (run, d) in self.layout.distances().iter().enumerate() {
            for at in eights(rows) {
                visit([run, at], at, at + *d as usize);
            }
        }
    }
    #[inline(always)]
    fn place<const N: usize>(self, [run, at]: [usize; 2], k: usize) -> usize {
        (N * run + k) * self.layout.plane() + at
    }
    #[inline(always)]
    fn pulls_above<T: Real>(self, pulls: &[T], at: usize) -> impl Iterator<Item = Vec3<Eight<T>>> {
        self.layout.distances().iter().enumerate().rev().map(
            #[inline(always)]
            move |(run, d)| self.of_pulls(pulls, [run, at - *d as usize]),
        )
    }
    #[inline(always)]
    fn pulls_own<T: Real>(self, pulls: &[T], at: usize) -> impl Iterator<Item = Vec3<Eight<T>>> {
        (0..self.layout.runs).map(
            #[inline(always)]
            move |run| self.of_pulls(pulls, [run, at]),
        )
    }
    #[inline(always)]
    fn pull(self, [run, at]: [usize; 2], k: usize) -> usize {
        (3 * run + k) * self.layout.pulls() + at - self.from
    }
    #[inline(always)]
    fn keep<T: Real>(self, pulls: &mut [T]) {
        for plane in 0..3 * self.layout.runs {
            let plane = pulls.get_mut(plane * self.layout.pulls()..);
            let (kept, rest) =
                plane.unwrap_or_default().split_at_mut_checked(self.layout.pad).unwrap_or_default();
            let last = rest.get(self.layout.stretch() - self.layout.pad..).unwrap_or_default();
            for (to, from) in kept.iter_mut().zip(last) {
                *to = *from;
            }
        }
    }
    #[inline(always)]
    fn number<T: Real>(self, plane: &[T], at: usize) -> Eight<T> {
        load(plane, at)
    }
    #[inline(always)]
    fn vector<T: Real>(self, [x, y, z]: [&[T]; 3], at: usize) -> Vec3<Eight<T>> {
        [load(x, at), load(y, at), load(z, at)]
    }
    #[inline(always)]
    fn share<T: Real>(self, _: &mut [T]) {}
}
