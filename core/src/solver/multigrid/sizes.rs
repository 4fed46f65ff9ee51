//! How much room a hierarchy may take. A level that would take more than what is left is not made: the one before is the
//! coarsest then.

use super::block::FULL;
use super::record::RECORD;
use super::tile::WIDTH;
use super::{inner, level};

/// At most so many levels.
pub(super) const LEVELS: usize = 7;
/// An island or level of so few rows is solved by dense factors.
pub(super) const DENSE: usize = 24;
/// Unknowns of the largest dense matrix.
pub(super) const UNKNOWNS: usize = 3 * DENSE;

/// Levels of an island: each has two thirds of the rows before it at most.
const fn most_levels(rows: usize) -> usize {
    let (mut levels, mut rest) = (1, rows);
    while rest > DENSE && levels < LEVELS {
        rest = rest * 2 / 3;
        levels += 1;
    }
    levels
}

/// Rows of all levels of an island.
pub(super) const fn most_rows(rows: usize) -> usize {
    rows + rows / 2 + 8
}

/// Edges of all levels of an island.
pub(super) const fn most_edges(springs: usize) -> usize {
    springs + springs / 2 + 8
}

/// Numbers of the blocks of all levels of an island.
pub(super) const fn most_numbers(springs: usize) -> usize {
    // Each twice in strips, once if loose.
    2 * FULL * (springs + springs / 8 + LEVELS * WIDTH)
}

/// Words that an island keeps.
pub(super) const fn words_kept(rows: usize, springs: usize) -> usize {
    // A loose edge has its ends, a strip half an edge or more; from and to.
    let once = most_levels(rows) * (2 * (WIDTH - 1) + 2);
    RECORD + 2 * springs + 5 * most_edges(springs) + once + 2 * most_rows(rows) + most_rows(rows) / WIDTH
}

/// Words that the islands of a scene keep.
pub(super) const fn words_kept_by_all(rows: usize, springs: usize) -> usize {
    // One that is solved directly keeps nothing; of others there are n/25 at most. The smallest have two levels, and larger
    // ones fewer levels per row.
    let smallest = words_kept(DENSE + 1, 0) - 2 * (most_rows(DENSE + 1) - most_rows(0));
    words_kept(rows, springs) + rows / (DENSE + 1) * smallest
}

/// Words that the analysis of an island works in.
pub(super) const fn words_worked_in(rows: usize, springs: usize) -> usize {
    7 * springs + 4 * rows + 2
}

/// Numbers that an island works in.
pub(super) const fn numbers(rows: usize, springs: usize) -> usize {
    // Rows of all levels, and what each level has once and to fill its last tile up.
    let once = (most_levels(rows) - 1) * level::numbers(WIDTH - 1);
    let levels = level::numbers(most_rows(rows)) + once + most_numbers(springs) + inner::numbers(rows);
    let weights = rows + 2 * springs;
    UNKNOWNS * UNKNOWNS + if levels > weights { levels } else { weights }
}
