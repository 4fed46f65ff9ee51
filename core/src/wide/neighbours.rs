//! How lanes walk from eight rows to their springs and the other ends, in either layout: the formulas are written once, over
//! this trait.

use core::ops::Range;

use crate::hessian::Hessian;
use crate::real::Real;
use crate::vec3::Vec3;
use crate::wide::eight::{Eight, Planes, WIDTH, all, load};
use crate::wide::layout::{Layout, eights};
use crate::wide::slots::{NUMBERS, Slots};
use crate::wide::work::hessians;

/// Rows and their springs.
pub(crate) trait Neighbours: Copy {
    /// Eight springs at the rows that own them.
    type Spring: Copy;
    /// Where eight other ends lie.
    type Ends: Copy;

    /// Hessians and other ends of the springs that rows above own, in the order of [`crate::System`].
    fn above<T: Real>(self, planes: &[T], at: usize)
    -> impl Iterator<Item = (Hessian<Eight<T>>, Self::Ends)>;
    /// Those of the rows' own.
    fn own<T: Real>(self, planes: &[T], at: usize) -> impl Iterator<Item = (Hessian<Eight<T>>, Self::Ends)>;
    /// Rows from a first one on whose springs are computed before they gather their pulls: with the pulls in view, and where
    /// they end.
    fn stretch(self, first: usize) -> (Self, usize);
    /// Visits the springs that rows from a first until before a last one own, with their rows and other ends. No iterator: the
    /// standard library's closures are not compiled for the registers of a [`crate::Dispatch`].
    fn each_spring(self, rows: [usize; 2], visit: impl FnMut(Self::Spring, usize, Self::Ends));
    /// Where the k-th of N numbers of eight springs lies.
    fn place<const N: usize>(self, spring: Self::Spring, k: usize) -> usize;
    /// Pulls of the springs that rows above own.
    fn pulls_above<T: Real>(self, pulls: &[T], at: usize) -> impl Iterator<Item = Vec3<Eight<T>>>;
    /// Those of the rows' own.
    fn pulls_own<T: Real>(self, pulls: &[T], at: usize) -> impl Iterator<Item = Vec3<Eight<T>>>;
    /// The k-th component of pulls.
    fn pull(self, spring: Self::Spring, k: usize) -> usize;
    /// Keeps of the pulls of a stretch what rows behind it will gather.
    fn keep<T: Real>(self, pulls: &mut [T]);
    /// A number of each other end.
    fn number<T: Real>(self, plane: &[T], ends: Self::Ends) -> Eight<T>;
    /// A vector of each; the planes are equally long.
    fn vector<T: Real>(self, planes: [&[T]; 3], ends: Self::Ends) -> Vec3<Eight<T>>;
    /// Brings the Hessians to the springs' other ends.
    fn share<T: Real>(self, planes: &mut [T]);
}

/// Equally long, so that one comparison says where an end is in all three.
#[inline(always)]
pub(crate) fn alike<'x, T>(Planes([x, y, z]): &'x Planes<'_, T>) -> [&'x [T]; 3] {
    let n = core::cmp::min(x.len(), core::cmp::min(y.len(), z.len()));
    [&**x, &**y, &**z].map(|plane| plane.get(..n).unwrap_or_default())
}

/// N numbers of eight springs.
#[inline(always)]
pub(crate) fn of_springs<T: Real, N: Neighbours, const COUNT: usize>(
    neighbours: N,
    planes: &[T],
    spring: N::Spring,
) -> [Eight<T>; COUNT] {
    let mut out = [all(T::ZERO); COUNT];
    for (k, out) in out.iter_mut().enumerate() {
        *out = load(planes, neighbours.place::<COUNT>(spring, k));
    }
    out
}

/// Which of them.
#[derive(Clone, Copy)]
pub(crate) enum Way<'w> {
    Runs(Runs<'w>),
    Slots(Slots<'w>),
}

impl<'w> Way<'w> {
    /// A layout's, with its words; `None` if they are too few.
    #[inline(always)]
    pub(crate) fn of(layout: &'w Layout, words: &'w [u32]) -> Option<Self> {
        Some(match &layout.slots {
            Some(counts) => Self::Slots(Slots::cut(counts, words)?),
            None => Self::Runs(Runs::new(layout)),
        })
    }

    /// Where a row, which is that particle's, lies in a plane.
    #[inline(always)]
    pub(crate) fn place(&self, row: usize, particle: u32) -> usize {
        match self {
            Self::Runs(runs) => runs.layout.place(particle),
            Self::Slots(slots) => slots.places.get(row).map_or(0, |place| *place as usize),
        }
    }

    /// The particle at a place.
    #[cold]
    pub(crate) fn particle(&self, place: usize, particles: &[u32]) -> Option<usize> {
        match self {
            Self::Runs(runs) => Some(runs.layout.base + place - runs.layout.pad),
            Self::Slots(slots) => {
                let row = slots.places.iter().position(|at| *at as usize == place)?;
                particles.get(row).map(|particle| *particle as usize)
            }
        }
    }
}

/// The same for either.
macro_rules! either {
    ($way:expr, $n:ident => $do:expr) => {
        match $way {
            $crate::wide::neighbours::Way::Runs($n) => $do,
            $crate::wide::neighbours::Way::Slots($n) => $do,
        }
    };
}
pub(crate) use either;

/// Offset runs.
#[derive(Clone, Copy)]
pub(crate) struct Runs<'l> {
    layout: &'l Layout,
    /// Of which place the first pulls are. There are those of a stretch, and before them those of the rows that reach it.
    from: usize,
}

impl<'l> Runs<'l> {
    /// With the first stretch's pulls in view.
    pub(crate) fn new(layout: &'l Layout) -> Self {
        Self { layout, from: 0 }
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

/// Some slots' Hessians.
#[inline(always)]
fn chunks<T>(planes: &[T], slots: Range<usize>) -> &[[T; NUMBERS]] {
    planes.as_chunks().0.get(slots).unwrap_or_default()
}

#[inline(always)]
fn ends(list: &[[u32; WIDTH]], slots: Range<usize>) -> &[[u32; WIDTH]] {
    list.get(slots).unwrap_or_default()
}

/// Four numbers of each of a slot's springs.
#[inline(always)]
fn four<T: Real>(slot: &[T; NUMBERS]) -> [Eight<T>; 4] {
    [load(slot, 0), load(slot, WIDTH), load(slot, 2 * WIDTH), load(slot, 3 * WIDTH)]
}

#[inline(always)]
fn hessian<T: Real>(slot: &[T; NUMBERS]) -> Hessian<Eight<T>> {
    let [alpha, x, y, z] = four(slot);
    Hessian { alpha, w: [x, y, z] }
}

/// Numbers from eight places of N lists that are equally long. Eight scalar loads each: measured, they were faster than rows
/// of four with a transposition, and than the hardware's own gather.
#[inline(always)]
fn pick<T: Real, const N: usize>(lists: [&[T]; N], places: &[u32; WIDTH]) -> Option<[Eight<T>; N]> {
    let mut out = [all(T::ZERO); N];
    for (lane, place) in places.iter().enumerate() {
        for (out, list) in out.iter_mut().zip(lists) {
            *out.0.get_mut(lane)? = *list.get(*place as usize)?;
        }
    }
    Some(out)
}

/// Four lists out of slots' numbers, k-th numbers in the k-th, equally long.
#[inline(always)]
fn by_number<T>(numbers: &[T]) -> [&[T]; 4] {
    let n = (numbers.len() + WIDTH).saturating_sub(NUMBERS);
    [0, 1, 2, 3].map(|k| numbers.get(k * WIDTH..k * WIDTH + n).unwrap_or_default())
}

impl<'w> Neighbours for Slots<'w> {
    type Spring = usize;
    type Ends = &'w [u32; WIDTH];

    #[inline(always)]
    fn above<T: Real>(
        self,
        planes: &[T],
        at: usize,
    ) -> impl Iterator<Item = (Hessian<Eight<T>>, Self::Ends)> {
        let slots = self.range(at / WIDTH, 1);
        let first = self.own.len();
        let springs = chunks(planes, first + slots.start..first + slots.end);
        springs.iter().zip(ends(self.above, slots)).map(
            #[inline(always)]
            |(slot, ends)| (hessian(slot), ends),
        )
    }
    #[inline(always)]
    fn own<T: Real>(self, planes: &[T], at: usize) -> impl Iterator<Item = (Hessian<Eight<T>>, Self::Ends)> {
        let slots = self.range(at / WIDTH, 0);
        chunks(planes, slots.clone()).iter().zip(ends(self.own, slots)).map(
            #[inline(always)]
            |(slot, ends)| (hessian(slot), ends),
        )
    }
    #[inline(always)]
    fn stretch(self, first: usize) -> (Self, usize) {
        // Of rows that are not in the scene's order any row may be above any.
        (self, first + WIDTH * self.starts.len().saturating_sub(1))
    }
    #[inline(always)]
    fn each_spring(self, [first, stop]: [usize; 2], mut visit: impl FnMut(usize, usize, Self::Ends)) {
        for tile in first / WIDTH..stop / WIDTH {
            let slots = self.range(tile, 0);
            for (slot, ends) in slots.clone().zip(ends(self.own, slots)) {
                visit(slot, WIDTH * tile, ends);
            }
        }
    }
    #[inline(always)]
    fn place<const N: usize>(self, slot: usize, k: usize) -> usize {
        (N * slot + k) * WIDTH
    }
    #[inline(always)]
    fn pulls_above<T: Real>(self, pulls: &[T], at: usize) -> impl Iterator<Item = Vec3<Eight<T>>> {
        let [x, y, z, _] = by_number(pulls);
        ends(self.source, self.range(at / WIDTH, 1)).iter().map(
            #[inline(always)]
            move |source| pick([x, y, z], source).unwrap_or([all(T::ZERO); 3]),
        )
    }
    #[inline(always)]
    fn pulls_own<T: Real>(self, pulls: &[T], at: usize) -> impl Iterator<Item = Vec3<Eight<T>>> {
        chunks(pulls, self.range(at / WIDTH, 0)).iter().map(
            #[inline(always)]
            |slot| {
                let [x, y, z, _] = four(slot);
                [x, y, z]
            },
        )
    }
    #[inline(always)]
    fn pull(self, slot: usize, k: usize) -> usize {
        self.place::<4>(slot, k)
    }
    #[inline(always)]
    fn keep<T: Real>(self, _: &mut [T]) {}
    #[inline(always)]
    fn number<T: Real>(self, plane: &[T], ends: Self::Ends) -> Eight<T> {
        let [number] = pick([plane], ends).unwrap_or([all(T::ZERO)]);
        number
    }
    #[inline(always)]
    fn vector<T: Real>(self, planes: [&[T]; 3], ends: Self::Ends) -> Vec3<Eight<T>> {
        pick(planes, ends).unwrap_or([all(T::ZERO); 3])
    }
    #[inline(always)]
    fn share<T: Real>(self, planes: &mut [T]) {
        let Some((own, above)) = planes.split_at_mut_checked(NUMBERS * self.own.len()) else { return };
        let lists = by_number(own);
        for (slot, source) in above.as_chunks_mut::<NUMBERS>().0.iter_mut().zip(self.source) {
            let numbers = pick(lists, source).unwrap_or([all(T::ZERO); 4]);
            for (to, from) in slot.as_chunks_mut().0.iter_mut().zip(numbers) {
                *to = from.0;
            }
        }
    }
}
