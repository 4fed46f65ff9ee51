//! A level's matrix, block by block: for the dense factors, and for whoever inspects a hierarchy.

use super::block::{Full, Kind, Tied};
use super::galerkin::{lane, loose_block};
use super::level::{Level, tiles};
use super::tile::WIDTH;
use crate::sym3::Sym3;

impl Level<'_> {
    /// The level's blocks as (row, column, block), to be added up.
    pub(super) fn each_block(&self, mut visit: impl FnMut(usize, usize, [f32; 6])) {
        let rows = self.pattern.size.rows;
        for (i, (mass, held)) in self.mass.iter().skip(WIDTH).zip(self.held.iter()).enumerate().take(rows) {
            visit(i, i, Sym3::scalar(*mass).0);
            visit(i, i, *held);
        }
        let mut edge = |a: usize, b: usize, block: [f32; 6]| {
            visit(a, a, block);
            visit(b, b, block);
            let minus = block.map(|x| -x);
            visit(a, b, minus);
            visit(b, a, minus);
        };
        if self.tied {
            self.each_tile::<Tied>(rows, &mut edge);
        } else {
            self.each_tile::<Full>(rows, &mut edge);
        }
        let [a, b] = &self.pattern.loose;
        for (k, (a, b)) in a.iter().zip(b.iter()).enumerate() {
            if (*b as usize) < rows {
                edge(*a as usize, *b as usize, loose_block(self.loose, k));
            }
        }
    }

    /// The edges of the strips, each at its lower row.
    fn each_tile<K: Kind>(&self, rows: usize, edge: &mut impl FnMut(usize, usize, [f32; 6])) {
        let count = rows.div_ceil(WIDTH);
        for (tile, edges) in tiles::<K>(&self.pattern.strips, self.blocks, [0, count]).enumerate() {
            for (offset, blocks) in edges.filter(|(offset, _)| **offset as i32 > 0) {
                let matrices = K::matrices(*blocks);
                for k in 0..WIDTH {
                    let a = WIDTH * tile + k;
                    let b = a + *offset as usize;
                    if b < rows {
                        edge(a, b, lane(&matrices, k));
                    }
                }
            }
        }
    }
}
