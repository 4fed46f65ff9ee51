//! Rows and their springs in slots ([`crate::wide::slots`]): other ends are found by index.

use core::ops::Range;

use crate::hessian::Hessian;
use crate::real::Real;
use crate::vec3::Vec3;
use crate::wide::eight::{Eight, WIDTH, all, load};
use crate::wide::neighbours::Neighbours;
use crate::wide::slots::{NUMBERS, Slots};

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
