//! An island's numbers in planes: one list per component, so that rows lie side by side. The front holds what a step keeps
//! from assembly to answer; behind it first lies what assembly works in, then, in the same place, what the solve works in.

use crate::real::Real;
use crate::wide::eight::{Eight, Planes, load};
use crate::wide::layout::Layout;

/// A, b and μ.
pub(crate) struct Front<'a, T> {
    pub(crate) b: Planes<'a, T>,
    /// m̃; 0 where there is no row
    pub(crate) inertia: &'a mut [T],
    /// The charges, then μ, then 1/μ; 0 where there is no row
    pub(crate) mu: &'a mut [T],
    /// α and w of each run's springs, planes one after the other
    pub(crate) hessians: &'a mut [T],
    /// k and l₀ of each run's springs, and c if there is damping
    pub(crate) springs: &'a mut [T],
}

/// What assembly works in.
pub(crate) struct Workshop<'a, T> {
    pub(crate) position: Planes<'a, T>,
    pub(crate) velocity: Planes<'a, T>,
    /// Per run what each spring adds to b at its lower end, three planes
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

/// Planes of a run's constants.
const fn constants(damped: bool) -> usize {
    if damped { 3 } else { 2 }
}

/// Numbers of a layout.
pub(crate) fn needs(layout: &Layout, damped: bool) -> usize {
    let (workshop, iterates) = (6 + 3 * layout.runs, 18);
    let behind = if workshop > iterates { workshop } else { iterates };
    (5 + (4 + constants(damped)) * layout.runs + behind) * layout.plane()
}

/// Takes planes off a buffer.
struct Cutter<'a, T> {
    rest: &'a mut [T],
    plane: usize,
}

impl<'a, T: Real> Cutter<'a, T> {
    fn planes(&mut self, n: usize) -> Option<&'a mut [T]> {
        let (front, rest) = core::mem::take(&mut self.rest).split_at_mut_checked(n * self.plane)?;
        self.rest = rest;
        Some(front)
    }

    fn vectors(&mut self) -> Option<Planes<'a, T>> {
        Some(Planes([self.planes(1)?, self.planes(1)?, self.planes(1)?]))
    }
}

/// Cuts a buffer: the front, and what lies behind it; `None` if it is too small.
pub(crate) fn cut<'a, T: Real>(
    buffer: &'a mut [T],
    layout: &Layout,
    damped: bool,
) -> Option<(Front<'a, T>, &'a mut [T])> {
    let mut cutter = Cutter { rest: buffer, plane: layout.plane() };
    let front = Front {
        b: cutter.vectors()?,
        inertia: cutter.planes(1)?,
        mu: cutter.planes(1)?,
        hessians: cutter.planes(4 * layout.runs)?,
        springs: cutter.planes(constants(damped) * layout.runs)?,
    };
    Some((front, cutter.rest))
}

impl<'a, T: Real> Workshop<'a, T> {
    pub(crate) fn cut(behind: &'a mut [T], layout: &Layout) -> Option<Self> {
        let mut cutter = Cutter { rest: behind, plane: layout.plane() };
        let (position, velocity) = (cutter.vectors()?, cutter.vectors()?);
        Some(Self { position, velocity, pulls: cutter.planes(3 * layout.runs)? })
    }
}

impl<'a, T: Real> Iterates<'a, T> {
    pub(crate) fn cut(behind: &'a mut [T], layout: &Layout) -> Option<Self> {
        let mut cutter = Cutter { rest: behind, plane: layout.plane() };
        let (mut x, r, mut p, mut y) =
            (cutter.vectors()?, cutter.vectors()?, cutter.vectors()?, cutter.vectors()?);
        for planes in [&mut x, &mut p, &mut y] {
            planes.clear_margins(layout.pad);
        }
        let mut plane = || cutter.planes(1);
        let inverse = [plane()?, plane()?, plane()?, plane()?, plane()?, plane()?];
        Some(Self { x, r, p, y, inverse })
    }
}

/// Eight of a run's springs: N planes, one after the other.
#[inline(always)]
pub(crate) fn of_run<T: Real, const N: usize>(
    planes: &[T],
    plane: usize,
    run: usize,
    at: usize,
) -> [Eight<T>; N] {
    let mut out = [crate::wide::eight::all(T::ZERO); N];
    for (k, out) in out.iter_mut().enumerate() {
        *out = load(planes, (N * run + k) * plane + at);
    }
    out
}

/// Writes them.
#[inline(always)]
pub(crate) fn put_of_run<T: Real, const N: usize>(
    planes: &mut [T],
    plane: usize,
    run: usize,
    at: usize,
    values: [Eight<T>; N],
) {
    for (k, value) in values.into_iter().enumerate() {
        crate::wide::eight::store(planes, (N * run + k) * plane + at, value);
    }
}

/// α and w as a Hessian of eight springs.
#[inline(always)]
pub(crate) fn hessians<T: Real>(
    planes: &[T],
    plane: usize,
    run: usize,
    at: usize,
) -> crate::hessian::Hessian<Eight<T>> {
    let [alpha, x, y, z] = of_run(planes, plane, run, at);
    crate::hessian::Hessian { alpha, w: [x, y, z] }
}
