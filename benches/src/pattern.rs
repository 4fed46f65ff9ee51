//! Where A's 3×3 blocks go in a compressed sparse column matrix.
//!
//! The pattern is that of the springs and stays as long as they do, so it is found once, and with it for every block that
//! `System::blocks` visits the three places in the array of values where its columns start. Filling the matrix anew is
//! then one pass of additions: what a program that reuses everything reusable has to do each step.

use hooke::Force;

use crate::scenario::Scenario;

/// Which entries a solver wants to see.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Part {
    Lower,
    Full,
}

/// A column of a block that is not stored.
const NOWHERE: u32 = u32::MAX;

/// The pattern of A and the way of each visited block into it.
pub(crate) struct Pattern {
    part: Part,
    /// Scalar columns' first entries, and one past the last.
    pub(crate) column: Vec<usize>,
    /// Scalar row of each entry, increasing within a column.
    pub(crate) row: Vec<usize>,
    /// Per visited block: is it on the diagonal, and where each of its three columns starts.
    slots: Vec<(bool, [u32; 3])>,
}

impl Part {
    /// The first row that is stored of column c of a block.
    fn from(self, diagonal: bool, c: usize) -> usize {
        if diagonal && self == Self::Lower { c } else { 0 }
    }
}

impl Pattern {
    /// The pattern of a scene's matrix. Its blocks are visited in the same order at every state.
    pub(crate) fn new<F: Force<f64> + Clone>(scenario: &mut Scenario<F>, part: Part) -> Self {
        let mut visited = Vec::new();
        let shown = scenario.systems(|system, _, _, first| {
            system.blocks(|i, j, _| visited.push((first + i, first + j)));
        });
        shown.expect("a step that was made before");
        Self::of(scenario.particle.len(), &visited, part)
    }

    /// The pattern of `n` block rows whose blocks are visited in this order.
    fn of(n: usize, visited: &[(usize, usize)], part: Part) -> Self {
        let stored = |i: usize, j: usize| part == Part::Full || i >= j;
        let mut rows = vec![Vec::new(); n];
        for &(i, j) in visited.iter().filter(|&&(i, j)| stored(i, j)) {
            rows[j].push(i);
        }
        let (mut column, mut row) = (vec![0], Vec::new());
        for (j, rows) in rows.iter_mut().enumerate() {
            rows.sort_unstable();
            rows.dedup();
            for c in 0..3 {
                for &i in rows.iter() {
                    row.extend((part.from(i == j, c)..3).map(|r| 3 * i + r));
                }
                column.push(row.len());
            }
        }
        let place = |i: usize, j: usize, c: usize| {
            let [from, to] = [column[3 * j + c], column[3 * j + c + 1]];
            let first = 3 * i + part.from(i == j, c);
            (from + row[from..to].partition_point(|r| *r < first)) as u32
        };
        let slots = visited
            .iter()
            .map(|&(i, j)| (i == j, [0, 1, 2].map(|c| if stored(i, j) { place(i, j, c) } else { NOWHERE })));
        let slots = slots.collect();
        Self { part, column, row, slots }
    }

    /// Number of stored entries.
    pub(crate) fn entries(&self) -> usize {
        self.row.len()
    }

    /// Assembles a step at the scene's present state: A's entries into `values`, the right side into `b`.
    pub(crate) fn fill<F: Force<f64> + Clone>(
        &self,
        scenario: &mut Scenario<F>,
        values: &mut [f64],
        b: &mut [f64],
    ) {
        values.fill(0.0);
        let mut slots = self.slots.iter();
        let shown = scenario.systems(|system, rhs, _, first| {
            b[3 * first..][..3 * rhs.len()].copy_from_slice(rhs.as_flattened());
            system.blocks(|_, _, block| {
                let Some((diagonal, starts)) = slots.next() else { return };
                self.add(*diagonal, *starts, &block, values);
            });
        });
        shown.expect("a step that was made before");
    }

    /// Adds one block.
    #[inline(always)]
    fn add(&self, diagonal: bool, starts: [u32; 3], block: &[[f64; 3]; 3], values: &mut [f64]) {
        if starts[0] == NOWHERE {
            return;
        }
        for (c, start) in starts.into_iter().enumerate() {
            let from = self.part.from(diagonal, c);
            for (value, row) in values[start as usize..].iter_mut().zip(&block[from..]) {
                *value += row[c];
            }
        }
    }

    /// Bytes of the map from blocks to values.
    pub(crate) fn map_bytes(&self) -> usize {
        size_of_val(self.slots.as_slice())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    /// The scene's matrix as the sum of the blocks that the kernel shows.
    fn dense(scenario: &mut Scenario<testing::Forces>) -> Vec<Vec<f64>> {
        let n = scenario.unknowns();
        let mut sum = vec![vec![0.0; n]; n];
        let shown = scenario.systems(|system, _, _, first| {
            system.blocks(|i, j, block| {
                for (r, row) in block.iter().enumerate() {
                    for (c, x) in row.iter().enumerate() {
                        sum[3 * (first + i) + r][3 * (first + j) + c] += x;
                    }
                }
            });
        });
        shown.unwrap();
        sum
    }

    #[test]
    fn a_matrix_filled_through_the_map_is_the_sum_of_the_kernels_blocks_bit_for_bit() {
        for name in ["cloth:5", "chain:7", "lattice:3x2x2", "pair"] {
            for part in [Part::Lower, Part::Full] {
                let mut scenario = testing::moving(name);
                let pattern = Pattern::new(&mut scenario, part);
                let (mut values, mut b) = (vec![1.0; pattern.entries()], vec![0.0; scenario.unknowns()]);
                pattern.fill(&mut scenario, &mut values, &mut b);
                let dense = dense(&mut scenario);
                let mut filled = vec![vec![0.0; dense.len()]; dense.len()];
                for (j, column) in pattern.column.windows(2).enumerate() {
                    for k in column[0]..column[1] {
                        assert!(k == column[0] || pattern.row[k] > pattern.row[k - 1], "rows increase");
                        filled[pattern.row[k]][j] = values[k];
                    }
                }
                for (i, row) in dense.iter().enumerate() {
                    let stored = if part == Part::Full { dense.len() } else { i + 1 };
                    assert_eq!(row[..stored], filled[i][..stored], "{name}, {part:?}, row {i}");
                    assert!(filled[i][stored..].iter().all(|x| *x == 0.0));
                }
                assert!(b.iter().any(|b| *b != 0.0));
            }
        }
    }
}
