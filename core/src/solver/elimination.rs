//! Which entries a sparse LDLᵀ has: found once per pattern, from indices alone.
//!
//! Rows are eliminated in the caller's order, or in one that is as good and puts columns of equal structure side by side
//! ([`crate::solver::elimination_tree`]): they become one *supernode*, a dense panel. What is found goes to a record, lists in the
//! caller's words: which rows each supernode has, and where in its panel each spring's block begins.
//!
//! Cost: O(entries of L + springs·α). Memory, words: [`FIXED`] + 2 per row, 2 per spring, 3 per supernode, 1 per row of a
//! supernode; while it works 7 per row and 2 per spring more.
//!
//! Sources: Davis, *Direct Methods for Sparse Linear Systems*, chapter 4; the manner of asking for memory is QDLDL's.

use crate::parts::Matrix;
use crate::real::Real;
use crate::solver::elimination_tree::{Work, each_edge};

/// No such index.
pub(crate) const NONE: u32 = u32::MAX;

/// Words at the head of a record: see [`Sizes`].
pub(crate) const FIXED: usize = 9;

/// How large an island's factor is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Sizes {
    pub(crate) rows: usize,
    pub(crate) edges: usize,
    pub(crate) supers: usize,
    /// Rows of all supernodes together
    pub(crate) listed: usize,
    /// Numbers of all panels together
    pub(crate) panels: usize,
    /// Rows of the longest panel
    pub(crate) longest: usize,
    /// Columns of the widest panel
    pub(crate) widest: usize,
}

impl Sizes {
    /// Words of a whole record.
    pub(crate) fn words(&self) -> usize {
        FIXED + 2 * self.rows + 2 * self.edges + 3 * (self.supers + 1) + self.listed
    }

    /// Words of scratch while factoring.
    pub(crate) fn scratch(&self) -> usize {
        3 * self.supers + self.rows
    }

    /// Numbers: panels, an update and the rows of L that make it, a permuted vector, pivots.
    pub(crate) fn numbers(&self) -> usize {
        self.panels + 18 * (self.longest + self.widest) + 9 * self.rows
    }
}

/// The lists of a record.
pub(crate) struct Lists<W> {
    /// Position in the elimination → row
    pub(crate) row: W,
    /// Position → supernode
    pub(crate) of: W,
    /// Spring → where its block begins among the numbers, and the length of a column there; pairs
    pub(crate) place: W,
    /// Supernode → its first position
    pub(crate) first: W,
    /// Supernode → where its rows begin in `list`
    pub(crate) from: W,
    /// Supernode → where its panel begins among the numbers
    pub(crate) panel: W,
    /// Positions of the supernodes' rows, its own columns first, ascending
    pub(crate) list: W,
}

/// Cuts a record, header taken off, into its lists.
pub(crate) fn lists<'a>(sizes: &Sizes, words: &'a [u32]) -> Option<Lists<&'a [u32]>> {
    let (row, words) = words.split_at_checked(sizes.rows)?;
    let (of, words) = words.split_at_checked(sizes.rows)?;
    let (place, words) = words.split_at_checked(2 * sizes.edges)?;
    let (first, words) = words.split_at_checked(sizes.supers + 1)?;
    let (from, words) = words.split_at_checked(sizes.supers + 1)?;
    let (panel, words) = words.split_at_checked(sizes.supers + 1)?;
    let list = words.get(..sizes.listed)?;
    Some(Lists { row, of, place, first, from, panel, list })
}

#[inline(always)]
pub(crate) fn get(list: &[u32], i: usize) -> usize {
    list.get(i).copied().unwrap_or(NONE) as usize
}

#[inline(always)]
pub(crate) fn set(list: &mut [u32], i: usize, value: usize) {
    if let Some(place) = list.get_mut(i) {
        *place = value as u32;
    }
}

pub(crate) const NOT: usize = NONE as usize;

fn cut<'a>(words: &mut &'a mut [u32], n: usize) -> Option<&'a mut [u32]> {
    let (front, rest) = core::mem::take(words).split_at_mut_checked(n)?;
    *words = rest;
    Some(front)
}

/// Analyses an island and writes its record, header left out, to the front of `words`, whose end is scratch. `Err` tells how
/// many words it lacks, as far as is known: the whole only once there is room to find out.
pub(crate) fn analyse<T: Real>(
    matrix: &Matrix<'_, T>,
    order: &[u32],
    words: &mut [u32],
) -> Result<Sizes, usize> {
    let (rows, edges) = (matrix.own.len(), matrix.other.len());
    let (fixed, scratch) = (2 * rows + 2 * edges, 7 * rows + 2 + 2 * edges);
    let least = fixed + scratch;
    let room = words.len();
    let Some((front, mut back)) =
        room.checked_sub(scratch).filter(|_| room >= least).and_then(|at| words.split_at_mut_checked(at))
    else {
        return Err(least);
    };
    let work = (|| {
        let back = &mut back;
        Some(Work {
            from: cut(back, rows + 1)?,
            neighbour: cut(back, 2 * edges)?,
            position: cut(back, rows)?,
            parent: cut(back, rows)?,
            mark: cut(back, rows)?,
            head: cut(back, rows + 1)?,
            next: cut(back, rows)?,
            count: cut(back, rows)?,
        })
    })();
    let (Some(mut work), Some((row, rest))) = (work, front.split_at_mut_checked(rows)) else {
        return Err(least);
    };
    number(matrix, order, row, work.position);
    work.connect(matrix);
    work.grow_tree(row);
    work.postorder(row);
    work.count(row);
    let sizes = work.sizes(edges);
    let needed = sizes.words() - FIXED + scratch;
    let Some((of, rest)) = rest.split_at_mut_checked(rows).filter(|_| room >= needed) else {
        return Err(needed);
    };
    let mut rest = rest;
    let lists = (|| {
        let rest = &mut rest;
        Some(Lists {
            row,
            of,
            place: cut(rest, 2 * edges)?,
            first: cut(rest, sizes.supers + 1)?,
            from: cut(rest, sizes.supers + 1)?,
            panel: cut(rest, sizes.supers + 1)?,
            list: cut(rest, sizes.listed)?,
        })
    })();
    let Some(mut lists) = lists else { return Err(needed) };
    work.gather(&mut lists);
    place(matrix, work.position, &mut lists);
    Ok(sizes)
}

/// Positions by the caller's order; rows that it does not name come last, in their own.
fn number<T: Real>(matrix: &Matrix<'_, T>, order: &[u32], row: &mut [u32], position: &mut [u32]) {
    position.fill(NONE);
    let mut k = 0;
    let named = order.iter().filter_map(|i| matrix.rows.row(*i as usize));
    for r in named.chain(0..row.len()) {
        if get(position, r) == NOT && r < row.len() {
            set(position, r, k);
            set(row, k, r);
            k += 1;
        }
    }
}

/// Where each spring's block goes: the column of its end that is eliminated first, the row of the other.
fn place<T: Real>(matrix: &Matrix<'_, T>, position: &[u32], lists: &mut Lists<&mut [u32]>) {
    let Lists { of, place, first, from, panel, list, .. } = lists;
    place.fill(NONE);
    each_edge(matrix, |edge, a, b| {
        let (a, b) = (get(position, a), get(position, b));
        let (column, row) = if a < b { (a, b) } else { (b, a) };
        let s = get(of, column);
        let rows = list.get(get(from, s)..get(from, s + 1)).unwrap_or_default();
        let Ok(at) = rows.binary_search(&(row as u32)) else { return };
        let within = column.saturating_sub(get(first, s));
        set(place, 2 * edge, get(panel, s) + within * 9 * rows.len() + 3 * at);
        set(place, 2 * edge + 1, 3 * rows.len());
    });
}

/// A word that tells patterns apart: of the particles, of who owns how many springs, and where these end. Four sums that do
/// not wait for each other.
pub(crate) fn fingerprint<T: Real>(matrix: &Matrix<'_, T>) -> u32 {
    let mut sums = [2_166_136_261_u32, 374_761_393, 668_265_263, 3_266_489_917];
    for list in [matrix.rows.particle, matrix.own, matrix.other] {
        let (fours, rest) = list.as_chunks::<4>();
        for four in fours {
            for (sum, word) in sums.iter_mut().zip(four) {
                *sum = (*sum ^ *word).wrapping_mul(16_777_619);
            }
        }
        for (sum, word) in sums.iter_mut().zip(rest) {
            *sum = (*sum ^ *word).wrapping_mul(16_777_619);
        }
    }
    let [a, b, c, d] = sums;
    [b, c, d].into_iter().fold(a, |sum, word| (sum ^ word).wrapping_mul(16_777_619))
}
