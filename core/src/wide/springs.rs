//! The springs of an island in lanes, one by one in the scene's order: for who takes numbers from them.

use crate::force::Force;
use crate::hessian::Hessian;
use crate::real::{Real, larger};
use crate::vec3;
use crate::wide::dispatch::Dispatch;
use crate::wide::eight::{Eight, WIDTH, all, load};
use crate::wide::layout::Layout;
use crate::wide::neighbours::{Neighbours, Way, either};
use crate::wide::slots::NUMBERS;
use crate::wide::solve::Widened;
use crate::wide::sweep::larger_lanes;
use crate::wide::work::Front;

impl<'s, T: Real, F: Force<T>, D: Dispatch> Widened<'s, '_, T, F, D> {
    /// The springs in their order: (row, other end, H).
    #[inline(always)]
    pub(crate) fn each_spring(&self, mut visit: impl FnMut(usize, usize, Hessian<T>)) {
        let matrix = self.system.matrix;
        let rows = matrix.own.iter().enumerate();
        match &self.way {
            Way::Runs(runs) => {
                let mut springs = matrix.other.iter().zip(runs.words);
                for (row, own) in rows {
                    for (other, word) in springs.by_ref().take(*own as usize) {
                        visit(row, *other as usize, self.hessian(runs.layout.at(*word), runs.layout.plane()));
                    }
                }
            }
            Way::Slots(slots) => {
                let mut others = matrix.other.iter();
                for ((row, own), place) in rows.zip(slots.places) {
                    let (lane, range) = (*place as usize % WIDTH, slots.range(*place as usize / WIDTH, 0));
                    for (slot, other) in range.zip(others.by_ref().take(*own as usize)) {
                        visit(row, *other as usize, self.hessian(slot * NUMBERS + lane, WIDTH));
                    }
                }
            }
        }
    }

    /// α and w, the first at a place and each of the others so much further.
    #[inline(always)]
    fn hessian(&self, at: usize, further: usize) -> Hessian<T> {
        Hessian::unpack(
            [0, 1, 2, 3].map(|k| self.front.hessians.get(at + k * further).copied().unwrap_or(T::ZERO)),
        )
    }

    /// The largest mass or stiffness: [`crate::System`]'s.
    pub(crate) fn largest(&self) -> T {
        self.dispatch.run(
            #[inline(always)]
            || either!(self.way, neighbours => largest(neighbours, self.layout, &self.front)),
        )
    }
}

#[inline(always)]
fn largest<T: Real, N: Neighbours>(neighbours: N, layout: &Layout, front: &Front<'_, T>) -> T {
    let mut most = all(T::ZERO);
    for at in layout.tiles() {
        most = larger_lanes(most, load(front.inertia, at));
        for (h, _) in neighbours.own(front.hessians, at) {
            most = larger_lanes(most, h.alpha + vec3::dot(h.w, h.w));
        }
    }
    let Eight(most) = most;
    most.iter().fold(T::ZERO, |most, x| larger(most, *x))
}
