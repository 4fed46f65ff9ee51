//! Which entries a sparse LDLᵀ has: found once per pattern, from indices alone.
//!
//! Rows are eliminated in the caller's order. The parent of column k is the first row below it in L's column k; these make a
//! tree (Liu), whose postorder is as good an order and puts columns of equal structure side by side: they become one
//! *supernode*, a dense panel. Row i of L consists of the paths in the tree from the k < i with Aᵢₖ ≠ 0 up to i: walking them
//! in the order of the rows counts the columns and then lists them, sorted as they come.
//!
//! Cost: O(entries of L + springs·α). Memory, words: [`FIXED`] + 2 per row, 2 per spring, 3 per supernode, 1 per row of a
//! supernode; while it works 7 per row and 2 per spring more.
//!
//! Sources: Liu 1990 (elimination tree); Davis, *Direct Methods for Sparse Linear Systems*, chapter 4; the manner of asking for
//! memory is QDLDL's.

use crate::parts::Matrix;
use crate::real::Real;

/// Of so many entries of a panel one may be a zero.
const SPARE: usize = 8;
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

const NOT: usize = NONE as usize;

/// What the analysis works in.
struct Work<'a> {
    /// Row → where its neighbours are in `neighbour`
    from: &'a mut [u32],
    neighbour: &'a mut [u32],
    /// Row → position
    position: &'a mut [u32],
    parent: &'a mut [u32],
    mark: &'a mut [u32],
    head: &'a mut [u32],
    next: &'a mut [u32],
    count: &'a mut [u32],
}

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

impl Work<'_> {
    /// Each row's neighbours.
    fn connect<T: Real>(&mut self, matrix: &Matrix<'_, T>) {
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
    fn grow_tree(&mut self, row: &[u32]) {
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
    fn postorder(&mut self, row: &mut [u32]) {
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
    fn count(&mut self, row: &[u32]) {
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

    fn sizes(&self, edges: usize) -> Sizes {
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
    fn gather(&mut self, lists: &mut Lists<&mut [u32]>) {
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
fn each_edge<T: Real>(matrix: &Matrix<'_, T>, mut visit: impl FnMut(usize, usize, usize)) {
    let mut others = matrix.other.iter().enumerate();
    for (row, own) in matrix.own.iter().enumerate() {
        for (edge, other) in others.by_ref().take(*own as usize) {
            if (*other as usize) < matrix.own.len() {
                visit(edge, row, *other as usize);
            }
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
