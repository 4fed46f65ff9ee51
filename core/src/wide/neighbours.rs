//! How lanes walk from eight rows to their springs and the other ends, in either layout: the formulas are written once, over
//! this trait.

use crate::hessian::Hessian;
use crate::real::Real;
use crate::vec3::Vec3;
use crate::wide::eight::{Eight, Planes, all, load};
use crate::wide::layout::Layout;
use crate::wide::runs::Runs;
use crate::wide::slots::Slots;

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
            None => Self::Runs(Runs::new(layout, words)),
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
