//! How much room a hierarchy may take. A level that would take more than what is left is not made: the one before is the
//! coarsest then.

use super::block::FULL;
use super::level;
use super::record::RECORD;
use super::tile::WIDTH;

/// At most so many levels.
pub(super) const LEVELS: usize = 7;
/// An island or level of so few rows is solved by dense factors.
pub(super) const DENSE: usize = 24;
/// Unknowns of the largest dense matrix.
pub(super) const UNKNOWNS: usize = 3 * DENSE;

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
    FULL * (2 * most_edges(springs) + LEVELS * WIDTH)
}

/// Words that an island keeps.
pub(super) const fn words_kept(rows: usize, springs: usize) -> usize {
    // A loose edge has its ends, a run six edges or more; from and to.
    RECORD + springs + 4 * most_edges(springs) + LEVELS * 2 * (WIDTH - 1) + 2 * most_rows(rows)
}

/// Words that the analysis of an island works in.
pub(super) const fn words_worked_in(rows: usize, springs: usize) -> usize {
    7 * springs + 4 * rows + 2
}

/// Numbers that an island works in.
pub(super) const fn numbers(rows: usize, springs: usize) -> usize {
    // Rows of all levels, and what each level has once.
    let levels = level::numbers(most_rows(rows)) + (LEVELS - 1) * level::numbers(0) + most_numbers(springs);
    let weights = rows + 2 * springs;
    UNKNOWNS * UNKNOWNS + if levels > weights { levels } else { weights }
}
