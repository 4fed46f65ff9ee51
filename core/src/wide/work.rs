//! An island's numbers in planes: one list per component, so that rows lie side by side. The front holds what a step keeps
//! from assembly to answer; behind it first lies what assembly works in, then, in the same place, what the solve works in.

use crate::real::Real;
use crate::wide::eight::{Eight, Planes, WIDTH, load};
use crate::wide::layout::Layout;
use crate::wide::slots::{Counts, NUMBERS};

/// A, b and μ.
pub(crate) struct Front<'a, T> {
    pub(crate) b: Planes<'a, T>,
    /// m̃; 0 where there is no row
    pub(crate) inertia: &'a mut [T],
    /// The charges, then μ, then 1/μ; 0 where there is no row
    pub(crate) mu: &'a mut [T],
    /// α and w of each run's springs, planes one after the other; in slots [`NUMBERS`] of each
    pub(crate) hessians: &'a mut [T],
}

/// What assembly works in.
pub(crate) struct Workshop<'a, T> {
    pub(crate) position: Planes<'a, T>,
    pub(crate) velocity: Planes<'a, T>,
    /// k and l₀ of each run's or own slot's springs, and c if there is damping
    pub(crate) springs: &'a mut [T],
    /// Per run what each spring of a stretch adds to b at its lower end, three planes; [`NUMBERS`] of each own slot
    pub(crate) pulls: &'a mut [T],
}

/// What the solve works in.
pub(crate) struct Iterates<'a, T> {
    pub(crate) x: Planes<'a, T>,
    pub(crate) r: Planes<'a, T>,
    /// The direction; at a check, δ
    pub(crate) p: Planes<'a, T>,
    /// A p; after that, z
    pub(crate) y: Planes<'a, T>,
    /// D⁻¹
    pub(crate) inverse: [&'a mut [T]; 6],
}

/// How many numbers the springs' Hessians, constants and pulls are.
fn of_springs(layout: &Layout, damped: bool) -> [usize; 3] {
    let constants = if damped { 3 } else { 2 };
    match &layout.slots {
        Some(Counts { own, above, .. }) => [NUMBERS * (own + above), WIDTH * constants * own, NUMBERS * own],
        None => {
            let of_run = [4 * layout.plane(), constants * layout.plane(), 3 * layout.pulls()];
            of_run.map(|numbers| layout.runs * numbers)
        }
    }
}

/// How many numbers the springs' Hessians are.
pub(crate) fn hessians_of(layout: &Layout) -> usize {
    let [hessians, ..] = of_springs(layout, false);
    hessians
}

/// Numbers of a layout.
pub(crate) fn needs(layout: &Layout, damped: bool) -> usize {
    let [hessians, constants, pulls] = of_springs(layout, damped);
    let n = layout.plane();
    5 * n + hessians + core::cmp::max(6 * n + constants + pulls, 18 * n)
}

/// Takes planes off a buffer.
struct Cutter<'a, T> {
    rest: &'a mut [T],
    plane: usize,
}

impl<'a, T: Real> Cutter<'a, T> {
    fn plane(&mut self) -> Option<&'a mut [T]> {
        self.numbers(self.plane)
    }

    fn numbers(&mut self, n: usize) -> Option<&'a mut [T]> {
        let (front, rest) = core::mem::take(&mut self.rest).split_at_mut_checked(n)?;
        self.rest = rest;
        Some(front)
    }

    fn vectors(&mut self) -> Option<Planes<'a, T>> {
        Some(Planes([self.plane()?, self.plane()?, self.plane()?]))
    }
}

/// Cuts a buffer: the front, and what lies behind it; `None` if it is too small.
pub(crate) fn cut<'a, T: Real>(buffer: &'a mut [T], layout: &Layout) -> Option<(Front<'a, T>, &'a mut [T])> {
    let mut cutter = Cutter { rest: buffer, plane: layout.plane() };
    let front = Front {
        b: cutter.vectors()?,
        inertia: cutter.plane()?,
        mu: cutter.plane()?,
        hessians: cutter.numbers(hessians_of(layout))?,
    };
    Some((front, cutter.rest))
}

impl<'a, T: Real> Workshop<'a, T> {
    pub(crate) fn cut(behind: &'a mut [T], layout: &Layout, damped: bool) -> Option<Self> {
        let mut cutter = Cutter { rest: behind, plane: layout.plane() };
        let (position, velocity) = (cutter.vectors()?, cutter.vectors()?);
        let [_, constants, pulls] = of_springs(layout, damped);
        let (springs, pulls) = (cutter.numbers(constants)?, cutter.numbers(pulls)?);
        Some(Self { position, velocity, springs, pulls })
    }
}

impl<'a, T: Real> Iterates<'a, T> {
    pub(crate) fn cut(behind: &'a mut [T], layout: &Layout) -> Option<Self> {
        let mut cutter = Cutter { rest: behind, plane: layout.plane() };
        let (mut x, r, mut p, mut y) =
            (cutter.vectors()?, cutter.vectors()?, cutter.vectors()?, cutter.vectors()?);
        for planes in [&mut x, &mut p, &mut y] {
            planes.clear_margins(layout.pad, layout.behind);
        }
        let mut plane = || cutter.plane();
        let inverse = [plane()?, plane()?, plane()?, plane()?, plane()?, plane()?];
        Some(Self { x, r, p, y, inverse })
    }
}

/// α and w as a Hessian of eight springs of a run.
#[inline(always)]
pub(crate) fn hessians<T: Real>(
    planes: &[T],
    plane: usize,
    run: usize,
    at: usize,
) -> crate::hessian::Hessian<Eight<T>> {
    let number = |k: usize| load(planes, (4 * run + k) * plane + at);
    crate::hessian::Hessian { alpha: number(0), w: [number(1), number(2), number(3)] }
}
