//! The scene's vectors, and those in lanes, as the hierarchy sees them.

use super::inner::{Outer, Rows};
use super::planes::Planes;
use super::tile::WIDTH;
use crate::force::Force;
use crate::parts::Vectors;
use crate::real::{Real, larger};
use crate::solver::around;
use crate::system::System;
use crate::vec3::{self, Vec3};
use crate::wide::eight::all;
use crate::wide::neighbours::Way;
use crate::wide::solve::Widened;
use crate::wide::{Dispatch, sweep};

#[inline(always)]
fn down_to<T: Real>(x: T) -> f32 {
    x.to_f64() as f32
}

#[inline(always)]
fn up_from<T: Real>(x: f32) -> T {
    T::from_f64(f64::from(x))
}

/// A plane from its first row on.
#[inline(always)]
fn rows_of(plane: &[f32]) -> &[f32] {
    plane.get(WIDTH..).unwrap_or_default()
}

#[inline(always)]
fn rows_mut(plane: &mut [f32]) -> &mut [f32] {
    plane.get_mut(WIDTH..).unwrap_or_default()
}

/// r and y, row by row.
pub(super) struct InLists<'v, T> {
    pub(super) r: &'v [Vec3<T>],
    pub(super) y: &'v mut [Vec3<T>],
}

impl<T: Real> Rows<T> for InLists<'_, T> {
    #[inline(always)]
    fn most(&mut self) -> T {
        around::largest(self.r)
    }
    #[inline(always)]
    fn residual(&mut self, down: T, Planes([x, y, z]): &mut Planes<'_>) {
        let to = rows_mut(x).iter_mut().zip(rows_mut(y)).zip(rows_mut(z));
        for (((x, y), z), [a, b, c]) in to.zip(self.r) {
            (*x, *y, *z) = (down_to(down * *a), down_to(down * *b), down_to(down * *c));
        }
    }
    #[inline(always)]
    fn put(&mut self, up: T, Planes([x, y, z]): &Planes<'_>) {
        let from = rows_of(x).iter().zip(rows_of(y)).zip(rows_of(z));
        for (to, ((x, y), z)) in self.y.iter_mut().zip(from) {
            *to = vec3::scale(up, [up_from(*x), up_from(*y), up_from(*z)]);
        }
    }
}

/// The scene's own vectors.
pub(super) struct InVectors<'s, 'v, 'a, T, F> {
    pub(super) system: &'s System<'s, T, F>,
    pub(super) v: &'v mut Vectors<'a, T>,
}

impl<'v, T: Real, F> InVectors<'_, 'v, '_, T, F> {
    #[inline(always)]
    fn lists(&mut self) -> InLists<'_, T> {
        InLists { r: self.v.r, y: self.v.y }
    }
}

impl<T: Real, F> Rows<T> for InVectors<'_, '_, '_, T, F> {
    #[inline(always)]
    fn most(&mut self) -> T {
        self.lists().most()
    }
    #[inline(always)]
    fn residual(&mut self, down: T, to: &mut Planes<'_>) {
        self.lists().residual(down, to);
    }
    #[inline(always)]
    fn put(&mut self, up: T, c: &Planes<'_>) {
        self.lists().put(up, c);
    }
}

impl<T: Real, F: Force<T>> Outer<T> for InVectors<'_, '_, '_, T, F> {
    #[inline(always)]
    fn heaviest(&mut self) -> T {
        self.v.mu.iter().fold(T::ZERO, |most, weight| larger(most, *weight))
    }
    #[inline(always)]
    fn weights(&mut self, down: T, to: &mut [f32]) {
        for (to, weight) in rows_mut(to).iter_mut().zip(self.v.mu.iter()) {
            *to = down_to(down * *weight);
        }
    }
    #[inline(always)]
    fn add(&mut self) {
        for (x, y) in self.v.x.iter_mut().zip(self.v.y.iter()) {
            *x = vec3::add(*x, *y);
        }
    }
    #[inline(always)]
    fn renew(&mut self) {
        self.v.p.fill([T::ZERO; 3]);
        self.system.add_product(self.v.y, self.v.p);
        for (r, p) in self.v.r.iter_mut().zip(self.v.p.iter()) {
            *r = vec3::sub(*r, *p);
        }
    }
}

impl<T: Real, F: Force<T>, D: Dispatch> Rows<T> for Widened<'_, '_, T, F, D> {
    #[inline(always)]
    fn most(&mut self) -> T {
        let Self { layout, work, dispatch, .. } = self;
        dispatch.run(
            #[inline(always)]
            || sweep::most(layout, &work.r),
        )
    }
    #[inline(always)]
    fn residual(&mut self, down: T, to: &mut Planes<'_>) {
        each_stretch(self.way, self.system.matrix.rows.particle, |row, place, n| {
            for (to, from) in to.0.iter_mut().zip(&self.work.r.0) {
                for (to, from) in part_mut(to, row + WIDTH, n).iter_mut().zip(part(from, place, n)) {
                    *to = down_to(down * *from);
                }
            }
        });
    }
    /// A product with y must find zeros where there is no row.
    #[inline(always)]
    fn put(&mut self, up: T, c: &Planes<'_>) {
        let Self { layout, work, .. } = self;
        for at in layout.tiles() {
            work.y.store(at, [all(T::ZERO); 3]);
        }
        each_stretch(self.way, self.system.matrix.rows.particle, |row, place, n| {
            for (to, from) in work.y.0.iter_mut().zip(&c.0) {
                for (to, from) in part_mut(to, place, n).iter_mut().zip(part(from, row + WIDTH, n)) {
                    *to = up * up_from(*from);
                }
            }
        });
    }
}

impl<T: Real, F: Force<T>, D: Dispatch> Outer<T> for Widened<'_, '_, T, F, D> {
    #[inline(always)]
    fn heaviest(&mut self) -> T {
        Self::heaviest(self)
    }
    #[inline(always)]
    fn weights(&mut self, down: T, to: &mut [f32]) {
        each_stretch(self.way, self.system.matrix.rows.particle, |row, place, n| {
            for (to, from) in part_mut(to, row + WIDTH, n).iter_mut().zip(part(self.front.mu, place, n)) {
                *to = down_to(down * *from);
            }
        });
    }
    #[inline(always)]
    fn add(&mut self) {
        let Self { layout, work, .. } = self;
        for at in layout.tiles() {
            let moved = vec3::add(work.x.load(at), work.y.load(at));
            work.x.store(at, moved);
        }
    }
    #[inline(always)]
    fn renew(&mut self) {
        Self::renew(self);
    }
}

/// Rows whose places follow one another: visits the first row, its place, and how many there are.
#[inline(always)]
fn each_stretch(way: Way<'_>, rows: &[u32], mut visit: impl FnMut(usize, usize, usize)) {
    let list = match &way {
        Way::Runs(_) => rows,
        Way::Slots(slots) => slots.places,
    };
    let (mut row, mut rest) = (0, list);
    while let Some(first) = rest.first() {
        let together = rest.iter().zip(rest.iter().skip(1)).take_while(|(a, b)| b.wrapping_sub(**a) == 1);
        let n = together.count() + 1;
        visit(row, way.place(row, *first), n);
        row += n;
        rest = rest.get(n..).unwrap_or_default();
    }
}

#[inline(always)]
fn part<X>(plane: &[X], from: usize, n: usize) -> &[X] {
    plane.get(from..from.saturating_add(n)).unwrap_or_default()
}

#[inline(always)]
fn part_mut<X>(plane: &mut [X], from: usize, n: usize) -> &mut [X] {
    plane.get_mut(from..from.saturating_add(n)).unwrap_or_default()
}
