//! The numbers of every level, new in each step: A_{l+1} = Pᵀ(M_l + K_l/ω)P with P piecewise constant, A_l = M_l + K_l. In spring
//! form that is all sums: of an aggregate's masses and held blocks, of the blocks of edges between two aggregates; edges inside
//! one vanish.
//!
//! All is divided by σ, the largest mass or stiffness of the island, so that f32 holds it.

use super::block::{FULL, TIED};
use super::level::Level;
use super::planes::Planes;
use super::springs::{Springs, tied};
use super::strips::LOOSE;
use super::tile::{Tile6, WIDTH};
use super::words::{NONE, get, set};
use crate::force::Force;
use crate::real::{Real, to};
use crate::sym3::Sym3;

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

/// 1/ω: what a level's springs are to the next. Piecewise constant functions are too stiff there by about ω; masses are as they
/// are.
const SOFTER: f32 = 1.0 / 1.6;

#[inline(always)]
fn softer(block: [f32; FULL]) -> [f32; FULL] {
    block.map(|entry| entry * SOFTER)
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
        springs: &impl Springs<T, F>,
        place_of: &[[u32; 2]],
        scale: T,
    ) {
        let system = springs.system();
        let rows = self.pattern.size.rows;
        self.clear();
        let by = [scale, scale.sqrt()];
        for (mass, m) in self.mass.iter_mut().skip(WIDTH).zip(system.matrix.inertia.iter()) {
            *mass = to(*m * scale);
        }
        let mut places = place_of.iter();
        let mut last_held = NONE;
        springs.each_spring(
            #[inline(always)]
            |row, other, h| {
                let [place, mirrored] = places.next().copied().unwrap_or([LOOSE; 2]);
                let h = tied(h, by);
                if other >= rows {
                    if row as u32 != last_held {
                        last_held = row as u32;
                        set(self.pattern.held_rows, self.held_count, last_held);
                        self.held_count += 1;
                    }
                    add_to_row(self.held, row, matrix(h));
                } else if place & LOOSE == 0 {
                    for place in [place, mirrored] {
                        let first = first_number::<TIED>(place);
                        // One question for all of a block's numbers.
                        let Some(reach) = self.blocks.get_mut(first..first + REACH_OF_FOUR) else { continue };
                        for (k, value) in h.into_iter().enumerate() {
                            if let Some(entry) = reach.get_mut(k * WIDTH) {
                                *entry = value;
                            }
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
            add_to_row(self.held, row, matrix(tied(h, by)));
        });
        if points {
            self.list_held();
        }
    }

    /// Pᵀ`fine`P with softer springs.
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
            let held = fine.held.get(row).copied().unwrap_or_default();
            add_to_row(self.held, aggregate, softer(held));
        }
        if fine.held_count > 0 {
            self.list_held();
        }
        for (from, places) in pattern.from.iter().zip(pattern.to.iter()) {
            let block = if *from & LOOSE != 0 {
                loose_block(fine.loose, (*from & !LOOSE) as usize)
            } else if fine.tied {
                matrix(four(fine.blocks, first_number::<TIED>(*from)))
            } else {
                full(fine.blocks, first_number::<FULL>(*from))
            };
            let (block, [place, _]) = (softer(block), *places);
            if place & LOOSE != 0 {
                add_loose(self.loose, place, block);
                continue;
            }
            for place in places {
                let first = first_number::<FULL>(*place);
                let Some(reach) = self.blocks.get_mut(first..first + REACH) else { continue };
                for (k, value) in block.into_iter().enumerate() {
                    if let Some(entry) = reach.get_mut(k * WIDTH) {
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

/// Where the first of a block's numbers lies, by its place.
#[inline(always)]
const fn first_number<const NUMBERS: usize>(place: u32) -> usize {
    let (strip, lane) = (place as usize / WIDTH, place as usize % WIDTH);
    strip * (NUMBERS * WIDTH) + lane
}

/// How far a block's numbers reach, which lie a tile apart.
const REACH: usize = WIDTH * (FULL - 1) + 1;

/// A matrix's numbers.
#[inline(always)]
fn full(blocks: &[f32], first: usize) -> [f32; FULL] {
    let reach = blocks.get(first..first.wrapping_add(REACH)).unwrap_or(&[0.0; REACH]);
    [0, 1, 2, 3, 4, 5].map(|k| reach.get(k * WIDTH).copied().unwrap_or(0.0))
}

/// α and w.
#[inline(always)]
fn four(blocks: &[f32], first: usize) -> [f32; TIED] {
    let reach = blocks.get(first..first.wrapping_add(REACH_OF_FOUR)).unwrap_or(&[0.0; REACH_OF_FOUR]);
    [0, 1, 2, 3].map(|k| reach.get(k * WIDTH).copied().unwrap_or(0.0))
}

const REACH_OF_FOUR: usize = WIDTH * (TIED - 1) + 1;

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
fn add_loose(loose: &mut [Tile6], slot: u32, block: [f32; 6]) {
    let slot = (slot & !LOOSE) as usize;
    if let Some(tile) = loose.get_mut(slot / WIDTH) {
        for (entries, value) in tile.iter_mut().zip(block) {
            if let Some(entry) = entries.get_mut(slot % WIDTH) {
                *entry += value;
            }
        }
    }
}
