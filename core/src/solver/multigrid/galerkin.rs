//! The numbers of every level, new in each step: A_{l+1} = PᵀA_l P with P piecewise constant. In spring form that is all
//! sums: of an aggregate's masses and held blocks, of the blocks of edges between two aggregates; edges inside one vanish.
//!
//! All is divided by σ, the largest mass or stiffness of the island, so that f32 holds it.

use super::block::{FULL, TIED};
use super::level::Level;
use super::planes::Planes;
use super::runs::LOOSE;
use super::strides::Strides;
use super::tile::{Tile6, WIDTH};
use super::words::{NONE, get, set};
use crate::force::Force;
use crate::hessian::Hessian;
use crate::real::Real;
use crate::sym3::Sym3;
use crate::system::System;

/// H/σ = αI + wwᵀ, `root` = 1/√σ
#[inline(always)]
fn tied<T: Real>(h: Hessian<T>, scale: T, root: T) -> [f32; TIED] {
    let [x, y, z] = h.w.map(|w| (w * root).to_f64() as f32);
    [(h.alpha * scale).to_f64() as f32, x, y, z]
}

#[inline(always)]
fn matrix([alpha, x, y, z]: [f32; TIED]) -> [f32; FULL] {
    Sym3::scalar(alpha).plus_outer([x, y, z]).0
}

#[inline(always)]
fn add_to_row(held: &mut [[f32; 6]], row: usize, block: [f32; 6]) {
    if let Some(held) = held.get_mut(row) {
        for (held, value) in held.iter_mut().zip(block) {
            *held += value;
        }
    }
}

impl Level<'_> {
    /// All numbers zero.
    fn clear(&mut self) {
        self.blocks.fill(0.0);
        self.loose.fill([[0.0; WIDTH]; 6]);
        self.mass.fill(0.0);
        self.held.fill([0.0; 6]);
        [&mut self.x, &mut self.r].into_iter().chain(&mut self.d).for_each(Planes::clear);
        self.held_count = 0;
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
        let root = scale.sqrt();
        for (mass, m) in self.mass.iter_mut().skip(WIDTH).zip(system.matrix.inertia.iter()) {
            *mass = (*m * scale).to_f64() as f32;
        }
        let rows = self.pattern.size.rows;
        let mut strides = Strides::new(self.pattern.runs, TIED);
        let mut slots = slot_of.iter();
        let mut last_held = NONE;
        system.each_spring(
            #[inline(always)]
            |row, other, h| {
                let place = slots.next().copied().unwrap_or(LOOSE) as usize;
                let h = tied(h, scale, root);
                if other >= rows {
                    if row as u32 != last_held {
                        last_held = row as u32;
                        set(self.pattern.held_rows, self.held_count, last_held);
                        self.held_count += 1;
                    }
                    add_to_row(self.held, row, matrix(h));
                } else if place & LOOSE as usize == 0 {
                    let stride = strides.of(place);
                    for (k, value) in h.into_iter().enumerate() {
                        if let Some(entry) = self.blocks.get_mut(place + k * stride) {
                            *entry = value;
                        }
                    }
                } else {
                    add_loose(self.loose, place, matrix(h));
                }
            },
        );
        let mut points = false;
        system.each_point(|row, h| {
            points = true;
            add_to_row(self.held, row, matrix(tied(h, scale, root)));
        });
        if points {
            self.list_held();
        }
    }

    /// Pᵀ`fine`P
    #[inline(never)]
    pub(super) fn coarsen(&mut self, fine: &Level<'_>) {
        self.clear();
        let pattern = &fine.pattern;
        for (aggregate, mass) in pattern.aggregate.iter().zip(fine.mass.iter().skip(WIDTH)) {
            if let Some(sum) = self.mass.get_mut(*aggregate as usize + WIDTH) {
                *sum += *mass;
            }
        }
        for row in pattern.held_rows.iter().take(fine.held_count) {
            let row = *row as usize;
            let aggregate = get(pattern.aggregate, row) as usize;
            add_to_row(self.held, aggregate, fine.held.get(row).copied().unwrap_or_default());
        }
        if fine.held_count > 0 {
            self.list_held();
        }
        let mut from_strides = Strides::new(pattern.runs, if fine.tied { TIED } else { FULL });
        let mut to_strides = Strides::new(self.pattern.runs, FULL);
        for (from, to) in pattern.from.iter().zip(pattern.to.iter()) {
            let (from, to) = (*from as usize, *to as usize);
            let block = if from & LOOSE as usize != 0 {
                loose_block(fine.loose, from & !(LOOSE as usize))
            } else {
                let stride = from_strides.of(from);
                let number = |k: usize| fine.blocks.get(from + k * stride).copied().unwrap_or(0.0);
                if fine.tied {
                    matrix([number(0), number(1), number(2), number(3)])
                } else {
                    [number(0), number(1), number(2), number(3), number(4), number(5)]
                }
            };
            if to & LOOSE as usize != 0 {
                add_loose(self.loose, to, block);
            } else {
                let stride = to_strides.of(to);
                for (k, value) in block.into_iter().enumerate() {
                    if let Some(entry) = self.blocks.get_mut(to + k * stride) {
                        *entry += value;
                    }
                }
            }
        }
    }

    /// Notes which rows are held.
    fn list_held(&mut self) {
        self.held_count = 0;
        for (row, _) in self.held.iter().enumerate().filter(|(_, held)| **held != [0.0; 6]) {
            set(self.pattern.held_rows, self.held_count, row as u32);
            self.held_count += 1;
        }
    }
}

/// The block of a loose edge.
#[inline(always)]
pub(super) fn loose_block(loose: &[Tile6], slot: usize) -> [f32; 6] {
    loose.get(slot / WIDTH).map_or([0.0; 6], |tile| lane(tile, slot % WIDTH))
}

/// Matrix k of a tile.
#[inline(always)]
pub(super) fn lane(tile: &Tile6, k: usize) -> [f32; 6] {
    tile.map(|entries| entries.get(k).copied().unwrap_or(0.0))
}

#[inline(always)]
fn add_loose(loose: &mut [Tile6], slot: usize, block: [f32; 6]) {
    let slot = slot & !(LOOSE as usize);
    if let Some(tile) = loose.get_mut(slot / WIDTH) {
        for (entries, value) in tile.iter_mut().zip(block) {
            if let Some(entry) = entries.get_mut(slot % WIDTH) {
                *entry += value;
            }
        }
    }
}
