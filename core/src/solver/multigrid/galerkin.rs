//! The numbers of every level, new in each step: A_{l+1} = PᵀA_l P with P piecewise constant. In spring form that is all
//! sums: of an aggregate's masses and held blocks, of the blocks of edges between two aggregates; edges inside one vanish.
//!
//! All is divided by σ, the largest mass or stiffness of the island, so that f32 holds it.

use super::level::{Level, TILE, blocks};
use super::tile::{Tile, WIDTH, add, load, mul, store, sub};
use super::words::get;
use crate::force::Force;
use crate::hessian::Hessian;
use crate::real::{Real, larger};
use crate::sym3::Sym3;
use crate::system::System;
use crate::vec3;

/// σ
pub(super) fn largest<T: Real, F: Force<T>>(system: &System<'_, T, F>) -> T {
    let mut most = T::ZERO;
    for m in system.matrix.inertia.iter() {
        most = larger(most, *m);
    }
    for h in system.matrix.hessian.iter() {
        let Hessian { alpha, w } = Hessian::unpack(*h);
        most = larger(most, alpha + vec3::dot(w, w));
    }
    most
}

/// H/σ
fn block<T: Real>(h: Hessian<T>, scale: T) -> [f32; 6] {
    let w = vec3::scale(scale, h.w);
    let product = |a: T, b: T| (a * b).to_f64() as f32;
    let diagonal = |a: T, b: T| (scale * h.alpha + a * b).to_f64() as f32;
    [
        diagonal(w[0], h.w[0]),
        diagonal(w[1], h.w[1]),
        diagonal(w[2], h.w[2]),
        product(w[0], h.w[1]),
        product(w[0], h.w[2]),
        product(w[1], h.w[2]),
    ]
}

/// Adds a block to a slot.
#[inline(always)]
fn add_to_slot(blocks: &mut [f32], slot: usize, block: [f32; 6]) {
    let tile = blocks.get_mut(slot / WIDTH * TILE..).and_then(|rest| rest.first_chunk_mut::<TILE>());
    if let Some(tile) = tile {
        for (entries, value) in tile.as_chunks_mut::<WIDTH>().0.iter_mut().zip(block) {
            if let Some(entry) = entries.get_mut(slot % WIDTH) {
                *entry += value;
            }
        }
    }
}

fn add_to_row(held: &mut [[f32; 6]], row: usize, block: [f32; 6]) {
    if let Some(held) = held.get_mut(row) {
        for (held, value) in held.iter_mut().zip(block) {
            *held += value;
        }
    }
}

impl Level<'_> {
    fn clear(&mut self) {
        self.blocks.fill(0.0);
        self.mass.fill(0.0);
        self.held.fill([0.0; 6]);
        self.r.clear();
        self.d.clear();
        self.x.clear();
    }

    /// The finest level, 1/σ = `scale`.
    #[inline(never)]
    pub(super) fn fill<T: Real, F: Force<T>>(
        &mut self,
        system: &System<'_, T, F>,
        slot_of: &[u32],
        scale: T,
    ) {
        self.clear();
        for (mass, m) in self.mass.iter_mut().zip(system.matrix.inertia.iter()) {
            *mass = (*m * scale).to_f64() as f32;
        }
        let rows = self.pattern.size.rows;
        let mut slots = slot_of.iter();
        system.each_spring(|row, other, h| {
            let (slot, h) = (slots.next(), block(h, scale));
            match slot.filter(|_| other < rows) {
                Some(slot) => add_to_slot(self.blocks, *slot as usize, h),
                None => add_to_row(self.held, row, h),
            }
        });
        system.each_point(|row, h| add_to_row(self.held, row, block(h, scale)));
        self.finish();
    }

    /// Pᵀ`fine`P
    #[inline(never)]
    pub(super) fn coarsen(&mut self, fine: &Level<'_>) {
        self.clear();
        let pattern = &fine.pattern;
        for ((aggregate, mass), held) in pattern.aggregate.iter().zip(fine.mass.iter()).zip(fine.held.iter())
        {
            let row = *aggregate as usize;
            if let Some(sum) = self.mass.get_mut(row) {
                *sum += *mass;
            }
            add_to_row(self.held, row, *held);
        }
        let tiles = fine.blocks.as_chunks::<TILE>().0.iter().zip(pattern.coarse.as_chunks::<WIDTH>().0);
        for (tile, coarse) in tiles {
            let [xx, yy, zz, xy, xz, yz] = blocks(tile);
            let lanes = xx.into_iter().zip(yy).zip(zz).zip(xy.into_iter().zip(xz).zip(yz));
            for (slot, (((xx, yy), zz), ((xy, xz), yz))) in coarse.iter().zip(lanes) {
                add_to_slot(self.blocks, *slot as usize, [xx, yy, zz, xy, xz, yz]);
            }
        }
        self.finish();
    }

    /// Notes which rows are held, and inverts the diagonal blocks.
    fn finish(&mut self) {
        self.held_count = 0;
        for (row, held) in self.held.iter().enumerate().filter(|(_, held)| **held != [0.0; 6]) {
            super::words::set(self.pattern.held_rows, self.held_count, row as u32);
            self.held_count += usize::from(!held.is_empty());
        }
        self.diagonal();
        invert(&mut self.inverse, self.pattern.size.rows);
    }

    /// The diagonal blocks, into the planes of their inverses.
    fn diagonal(&mut self) {
        let [xx, yy, zz, xy, xz, yz] = &mut self.inverse;
        for plane in [&mut *xx, yy, zz] {
            for (entry, mass) in plane.iter_mut().zip(self.mass.iter()) {
                *entry = *mass;
            }
        }
        for plane in [&mut *xy, xz, yz] {
            plane.fill(0.0);
        }
        let planes = &mut self.inverse;
        let add_at = |planes: &mut [&mut [f32]; 6], row: usize, block: [f32; 6]| {
            for (plane, value) in planes.iter_mut().zip(block) {
                if let Some(entry) = plane.get_mut(row) {
                    *entry += value;
                }
            }
        };
        for row in self.pattern.held_rows.iter().take(self.held_count) {
            let row = *row as usize;
            add_at(planes, row, self.held.get(row).copied().unwrap_or_default());
        }
        let split = TILE * self.pattern.size.extent.run_tiles;
        let (tiled, loose) = self.blocks.split_at_checked(split).unwrap_or_default();
        let mut tiles = tiled.as_chunks::<TILE>().0.iter();
        for [first, offset, count] in self.pattern.runs() {
            let mut a = *first as usize;
            let mut b = a + *offset as usize;
            for tile in tiles.by_ref().take(*count as usize) {
                for (plane, entry) in planes.iter_mut().zip(blocks(tile)) {
                    store(plane, a, add(load(plane, a), entry));
                    store(plane, b, add(load(plane, b), entry));
                }
                (a, b) = (a + WIDTH, b + WIDTH);
            }
        }
        self.pattern.each_loose_tile(loose, |tile, a, b| {
            let [xx, yy, zz, xy, xz, yz] = blocks(tile);
            let lanes = xx.into_iter().zip(yy).zip(zz).zip(xy.into_iter().zip(xz).zip(yz));
            for ((a, b), (((xx, yy), zz), ((xy, xz), yz))) in a.iter().zip(b).zip(lanes) {
                add_at(planes, *a as usize, [xx, yy, zz, xy, xz, yz]);
                add_at(planes, *b as usize, [xx, yy, zz, xy, xz, yz]);
            }
        });
    }

    /// The level's blocks as (row, column, block), to be added up.
    pub(super) fn each_block(&self, mut visit: impl FnMut(usize, usize, [f32; 6])) {
        let rows = self.pattern.size.rows;
        for (i, (mass, held)) in self.mass.iter().zip(self.held.iter()).enumerate().take(rows) {
            visit(i, i, Sym3::scalar(*mass).0);
            visit(i, i, *held);
        }
        for (t, tile) in self.blocks.as_chunks::<TILE>().0.iter().enumerate() {
            let [xx, yy, zz, xy, xz, yz] = blocks(tile);
            let lanes = xx.into_iter().zip(yy).zip(zz).zip(xy.into_iter().zip(xz).zip(yz));
            for (k, (((xx, yy), zz), ((xy, xz), yz))) in lanes.enumerate() {
                let slot = WIDTH * t + k;
                if self.pattern.is_edge(slot) {
                    let ends = [&*self.pattern.a, &*self.pattern.b];
                    let [a, b] = ends.map(|list| get(list, slot) as usize);
                    let block = [xx, yy, zz, xy, xz, yz];
                    visit(a, a, block);
                    visit(b, b, block);
                    let minus = block.map(|x| -x);
                    visit(a, b, minus);
                    visit(b, a, minus);
                }
            }
        }
    }
}

/// Where a is positive, 1/a; else 0, and the lane is bad.
#[inline(always)]
fn reciprocal(a: Tile, bad: &mut [bool; WIDTH]) -> Tile {
    let mut out = a;
    for ((out, a), bad) in out.iter_mut().zip(a).zip(bad) {
        *out = 1.0 / a;
        *bad |= !(a > 0.0 && *out > 0.0);
    }
    out
}

/// Inverts eight blocks at a time as [`Sym3::inverse`] does one; a block that is not positive becomes its largest entry's.
#[inline(never)]
fn invert(planes: &mut [&mut [f32]; 6], rows: usize) {
    let mut i = 0;
    while i < rows {
        let [xx, yy, zz, xy, xz, yz] = &*planes;
        let [xx, yy, zz] = [load(xx, i), load(yy, i), load(zz, i)];
        let [xy, xz, yz] = [load(xy, i), load(xz, i), load(yz, i)];
        let mut bad = [false; WIDTH];
        let i1 = reciprocal(xx, &mut bad);
        let (l21, l31) = (mul(xy, i1), mul(xz, i1));
        let i2 = reciprocal(sub(yy, mul(l21, xy)), &mut bad);
        let s32 = sub(yz, mul(l31, xy));
        let l32 = mul(s32, i2);
        let i3 = reciprocal(sub(sub(zz, mul(l31, xz)), mul(l32, s32)), &mut bad);
        let m31 = sub(mul(l21, l32), l31);
        let (t21, t31, t32) = (mul(i2, l21), mul(i3, m31), mul(i3, l32));
        let inverse = [
            add(add(i1, mul(t21, l21)), mul(t31, m31)),
            add(i2, mul(t32, l32)),
            i3,
            sub([0.0; WIDTH], add(t21, mul(t31, l32))),
            t31,
            sub([0.0; WIDTH], t32),
        ];
        let mut largest = xx;
        for (largest, (y, z)) in largest.iter_mut().zip(yy.into_iter().zip(zz)) {
            *largest = larger(larger(*largest, y), z);
        }
        for (k, (plane, mut tile)) in planes.iter_mut().zip(inverse).enumerate() {
            for ((entry, bad), largest) in tile.iter_mut().zip(bad).zip(largest) {
                let instead = if k < 3 && largest > 0.0 { 1.0 / largest } else { 0.0 };
                *entry = if bad { instead } else { *entry };
            }
            store(plane, i, tile);
        }
        i += WIDTH;
    }
}
