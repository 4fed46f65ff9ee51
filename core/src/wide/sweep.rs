//! The vector work of a PCG iteration in lanes: x += a p, r −= a y, z = D⁻¹r, and p = z + ρ p.

use crate::bound::square;
use crate::lanes::Lanes;
use crate::real::{Real, larger};
use crate::sym3::Sym3;
use crate::vec3::{self, Vec3};
use crate::wide::eight::{Eight, Planes, all};
use crate::wide::layout::Layout;
use crate::wide::work::Iterates;

/// The tiles of a plane.
#[inline(always)]
fn tiles<'p, T>(layout: &Layout, plane: &'p [T]) -> core::slice::Iter<'p, [T; 8]> {
    let there = plane.get(layout.pad..layout.pad + layout.places);
    there.unwrap_or_default().as_chunks().0.iter()
}

#[inline(always)]
fn tiles_mut<'p, T>(layout: &Layout, plane: &'p mut [T]) -> core::slice::IterMut<'p, [T; 8]> {
    let there = plane.get_mut(layout.pad..layout.pad + layout.places);
    there.unwrap_or_default().as_chunks_mut().0.iter_mut()
}

/// Vectors of eight rows at a time.
#[inline(always)]
pub(crate) fn vectors<'p, T: Real>(
    layout: &Layout,
    Planes([x, y, z]): &'p Planes<'_, T>,
) -> impl Iterator<Item = Vec3<Eight<T>>> + use<'p, T> {
    tiles(layout, x).zip(tiles(layout, y)).zip(tiles(layout, z)).map(
        #[inline(always)]
        |((x, y), z)| [Eight(*x), Eight(*y), Eight(*z)],
    )
}

/// Where vectors of eight rows at a time are.
#[inline(always)]
pub(crate) fn vectors_mut<'p, T: Real>(
    layout: &Layout,
    Planes([x, y, z]): &'p mut Planes<'_, T>,
) -> impl Iterator<Item = Vec3Mut<'p, T>> + use<'p, T> {
    tiles_mut(layout, x).zip(tiles_mut(layout, y)).zip(tiles_mut(layout, z)).map(
        #[inline(always)]
        |((x, y), z)| [x, y, z],
    )
}

/// Eight vectors in their planes.
pub(crate) type Vec3Mut<'p, T> = [&'p mut [T; 8]; 3];

#[inline(always)]
fn get<T: Real>([x, y, z]: &Vec3Mut<'_, T>) -> Vec3<Eight<T>> {
    [Eight(**x), Eight(**y), Eight(**z)]
}

#[inline(always)]
fn put<T: Real>([x, y, z]: Vec3Mut<'_, T>, [a, b, c]: Vec3<Eight<T>>) {
    *x = a.0;
    *y = b.0;
    *z = c.0;
}

/// A number of eight rows at a time.
#[inline(always)]
fn scalars<'p, T: Real>(layout: &Layout, plane: &'p [T]) -> impl Iterator<Item = Eight<T>> + use<'p, T> {
    tiles(layout, plane).map(
        #[inline(always)]
        |x| Eight(*x),
    )
}

/// D⁻¹ of eight rows at a time.
#[inline(always)]
fn blocks<'p, T: Real>(
    layout: &Layout,
    [a, b, c, d, e, f]: &'p [&mut [T]; 6],
) -> impl Iterator<Item = Sym3<Eight<T>>> + use<'p, T> {
    let first = tiles(layout, a).zip(tiles(layout, b)).zip(tiles(layout, c));
    let last = tiles(layout, d).zip(tiles(layout, e)).zip(tiles(layout, f));
    first.zip(last).map(
        #[inline(always)]
        |(((a, b), c), ((d, e), f))| Sym3([Eight(*a), Eight(*b), Eight(*c), Eight(*d), Eight(*e), Eight(*f)]),
    )
}

/// x += a p, r −= a y, and then y = z = D⁻¹r. Answers Σ|rᵢ|²/μᵢ and rᵀz.
#[inline(always)]
pub(crate) fn sweep<T: Real>(layout: &Layout, work: &mut Iterates<'_, T>, weight: &[T], a: T) -> (T, T) {
    let (mut beta, mut rz) = (all(T::ZERO), all(T::ZERO));
    let (plus, minus) = (all(a), all(-a));
    let Iterates { x, r, p, y, inverse } = work;
    let moved = vectors_mut(layout, x).zip(vectors(layout, p));
    let left = vectors_mut(layout, r).zip(vectors_mut(layout, y));
    let rows = scalars(layout, weight).zip(blocks(layout, inverse));
    for (((x, p), (r, y)), (weight, inverse)) in moved.zip(left).zip(rows) {
        let next = vec3::add_scaled(get(&x), plus, p);
        put(x, next);
        let residual = vec3::add_scaled(get(&r), minus, get(&y));
        put(r, residual);
        let z = inverse.mul(residual);
        put(y, z);
        beta = beta + square(residual, weight);
        rz = rz + vec3::dot(residual, z);
    }
    (Lanes::of(beta.0).sum(), Lanes::of(rz.0).sum())
}

/// The largest component.
#[inline(always)]
pub(crate) fn most<T: Real>(layout: &Layout, r: &Planes<'_, T>) -> T {
    let most = vectors(layout, r).fold(
        all(T::ZERO),
        #[inline(always)]
        |most, r| largest(most, r),
    );
    most.0.iter().fold(T::ZERO, |most, x| larger(most, *x))
}

#[inline(always)]
fn largest<T: Real>(most: Eight<T>, [a, b, c]: Vec3<Eight<T>>) -> Eight<T> {
    larger_lanes(larger_lanes(larger_lanes(most, a.abs()), b.abs()), c.abs())
}

#[inline(always)]
pub(crate) fn larger_lanes<T: Real>(most: Eight<T>, a: Eight<T>) -> Eight<T> {
    most.zip(
        a,
        #[inline(always)]
        |most, a| if most < a { a } else { most },
    )
}

/// y = z = D⁻¹r
#[inline(always)]
pub(crate) fn precondition<T: Real>(layout: &Layout, work: &mut Iterates<'_, T>) {
    let Iterates { r, y, inverse, .. } = work;
    let rows = vectors(layout, r).zip(vectors_mut(layout, y)).zip(blocks(layout, inverse));
    for ((r, y), inverse) in rows {
        put(y, inverse.mul(r));
    }
}

/// p = z + ρ p, z being in y.
#[inline(always)]
pub(crate) fn direction<T: Real>(layout: &Layout, work: &mut Iterates<'_, T>, ratio: T) {
    let Iterates { p, y, .. } = work;
    for (p, z) in vectors_mut(layout, p).zip(vectors(layout, y)) {
        let next = vec3::add_scaled(z, all(ratio), get(&p));
        put(p, next);
    }
}
