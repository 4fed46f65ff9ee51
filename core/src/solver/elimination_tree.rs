//! The elimination tree of a pattern, for [`crate::solver::elimination`].
//!
//! The parent of column k is the first row below it in L's column k; these make a tree, whose postorder is as good an order and
//! puts columns of equal structure side by side. Row i of L consists of the paths in the tree from the k < i with Aᵢₖ ≠ 0 up to i:
//! walking them in the order of the rows counts the columns and then lists them, sorted as they come.
//!
//! Sources: Liu 1990, *The role of elimination trees in sparse factorization*; Davis, *Direct Methods for Sparse Linear Systems*,
//! chapter 4.

use crate::parts::Matrix;
use crate::real::Real;
use crate::solver::elimination::{Lists, NONE, NOT, Sizes, get, set};

/// Of so many entries of a panel one may be a zero.
const SPARE: usize = 8;

/// What the analysis works in.
pub(crate) struct Work<'a> {
    /// Row → where its neighbours are in `neighbour`
    pub(crate) from: &'a mut [u32],
    pub(crate) neighbour: &'a mut [u32],
    /// Row → position
    pub(crate) position: &'a mut [u32],
    pub(crate) parent: &'a mut [u32],
    pub(crate) mark: &'a mut [u32],
    pub(crate) head: &'a mut [u32],
    pub(crate) next: &'a mut [u32],
    pub(crate) count: &'a mut [u32],
}

impl Work<'_> {
    /// Each row's neighbours.
    pub(crate) fn connect<T: Real>(&mut self, matrix: &Matrix<'_, T>) {
        let rows = matrix.own.len();
        self.from.fill(0);
        each_edge(matrix, |_, a, b| {
            for end in [a, b] {
                set(self.from, end, get(self.from, end) + 1);
            }
        });
        let mut end = 0;
        for from in self.from.iter_mut() {
            end += *from;
            *from = end;
        }
        each_edge(matrix, |_, a, b| {
            for (near, far) in [(a, b), (b, a)] {
                let place = get(self.from, near).saturating_sub(1);
                set(self.from, near, place);
                set(self.neighbour, place, far);
            }
        });
        debug_assert!(get(self.from, rows) == end as usize);
    }

    /// Visits the positions k < i with Aᵢₖ ≠ 0.
    #[inline(always)]
    fn earlier(
        from: &[u32],
        neighbour: &[u32],
        position: &[u32],
        row: usize,
        i: usize,
    ) -> impl Iterator<Item = usize> {
        let range = get(from, row)..get(from, row + 1);
        let neighbours = neighbour.get(range).unwrap_or_default();
        neighbours.iter().map(move |r| get(position, *r as usize)).filter(move |k| *k < i)
    }

    /// Parents, by paths that are shortened on the way (in `mark`).
    pub(crate) fn grow_tree(&mut self, row: &[u32]) {
        let Self { from, neighbour, position, parent, mark, .. } = self;
        parent.fill(NONE);
        mark.fill(NONE);
        for (i, r) in row.iter().enumerate() {
            for k in Self::earlier(from, neighbour, position, *r as usize, i) {
                let mut k = k;
                while k < i {
                    let above = get(mark, k);
                    set(mark, k, i);
                    if above == NOT {
                        set(parent, k, i);
                    }
                    k = above;
                }
            }
        }
    }

    /// Renumbers positions by a postorder of the tree.
    pub(crate) fn postorder(&mut self, row: &mut [u32]) {
        let Self { position, parent, head, next, count, .. } = self;
        let rows = row.len();
        head.fill(NONE);
        for k in (0..rows).rev() {
            let above = get(parent, k).min(rows);
            set(next, k, get(head, above));
            set(head, above, k);
        }
        let (mut k, mut node) = (0, get(head, rows));
        while node < rows {
            while get(head, node) < rows {
                node = get(head, node);
            }
            set(count, node, k);
            k += 1;
            while get(next, node) >= rows && get(parent, node) < rows {
                node = get(parent, node);
                set(count, node, k);
                k += 1;
            }
            node = get(next, node);
        }
        for k in 0..rows {
            let above = get(parent, k);
            set(next, get(count, k), if above < rows { get(count, above) } else { NOT });
        }
        for (parent, next) in parent.iter_mut().zip(next.iter()) {
            *parent = *next;
        }
        for (r, position) in position.iter_mut().enumerate() {
            *position = get(count, *position as usize) as u32;
            set(row, *position as usize, r);
        }
    }

    /// Walks the rows of L: (row i, column k), i ascending.
    #[inline(always)]
    fn walk(&mut self, row: &[u32], mut visit: impl FnMut(usize, usize, &mut [u32], &mut [u32])) {
        let Self { from, neighbour, position, parent, mark, count, head, .. } = self;
        mark.fill(NONE);
        for (i, r) in row.iter().enumerate() {
            set(mark, i, i);
            visit(i, i, count, head);
            for k in Self::earlier(from, neighbour, position, *r as usize, i) {
                let mut k = k;
                while k < i && get(mark, k) != i {
                    set(mark, k, i);
                    visit(i, k, count, head);
                    k = get(parent, k);
                }
            }
        }
    }

    /// How many entries each column of L has, its pivot included.
    pub(crate) fn count(&mut self, row: &[u32]) {
        self.count.fill(0);
        self.walk(row, |_, k, count, _| set(count, k, get(count, k) + 1));
    }

    /// Visits the supernodes: (first column, end, rows). A column joins the one before it, a child of its own in the tree, if
    /// of the panel's entries no more than one in [`SPARE`] is then a zero: longer panels give that back (measured on cloths).
    fn each_supernode(&self, mut visit: impl FnMut(usize, usize, usize)) {
        let (mut first, columns) = (0, self.count.len());
        let mut entries = 0;
        for k in 0..columns {
            let last = k + 1 == columns;
            entries += get(self.count, k);
            // The panel if the next column joins: a trapezium, and how many of it are entries of L.
            let next = get(self.count, k + 1);
            let (wide, long) = (k + 2 - first, k + 1 - first + next);
            let all = wide * long - wide * (wide - 1) / 2;
            let zeros = all.saturating_sub(entries + next);
            if last || get(self.parent, k) != k + 1 || SPARE * zeros > all {
                visit(first, k + 1, k - first + get(self.count, k));
                (first, entries) = (k + 1, 0);
            }
        }
    }

    pub(crate) fn sizes(&self, edges: usize) -> Sizes {
        let rows = self.count.len();
        let mut sizes = Sizes { rows, edges, supers: 0, listed: 0, panels: 0, longest: 0, widest: 0 };
        self.each_supernode(|first, end, length| {
            sizes.supers += 1;
            sizes.listed += length;
            sizes.panels += 9 * length * (end - first);
            sizes.longest = if length > sizes.longest { length } else { sizes.longest };
            sizes.widest = if end - first > sizes.widest { end - first } else { sizes.widest };
        });
        sizes
    }

    /// The supernodes and their rows: their own columns, and what the last of these has below it.
    pub(crate) fn gather(&mut self, lists: &mut Lists<&mut [u32]>) {
        let Lists { row, of, first, from, panel, list, .. } = lists;
        let (mut s, mut listed, mut numbers) = (0, 0, 0);
        self.each_supernode(|begin, end, length| {
            set(first, s, begin);
            set(from, s, listed);
            set(panel, s, numbers);
            for (at, k) in (begin..end).enumerate() {
                set(of, k, s);
                set(list, listed + at, k);
            }
            s += 1;
            listed += length;
            numbers += 9 * length * (end - begin);
        });
        set(first, s, row.len());
        set(from, s, listed);
        set(panel, s, numbers);
        for s in 0..s {
            let columns = get(first, s + 1) - get(first, s);
            set(self.head, s, get(from, s) + columns);
        }
        self.walk(row, |i, k, _, head| {
            let s = get(of, k);
            if i > k && get(first, s + 1) == k + 1 {
                let place = get(head, s);
                set(list, place, i);
                set(head, s, place + 1);
            }
        });
    }
}

/// Springs between two rows: (spring, row, row).
#[inline(always)]
pub(crate) fn each_edge<T: Real>(matrix: &Matrix<'_, T>, mut visit: impl FnMut(usize, usize, usize)) {
    let mut others = matrix.other.iter().enumerate();
    for (row, own) in matrix.own.iter().enumerate() {
        for (edge, other) in others.by_ref().take(*own as usize) {
            if (*other as usize) < matrix.own.len() {
                visit(edge, row, *other as usize);
            }
        }
    }
}
