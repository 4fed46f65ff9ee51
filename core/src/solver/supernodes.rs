//! The numbers of a sparse LDLᵀ: left-looking, supernode by supernode, each a dense panel.
//!
//! Panel s ← A's columns of s; −= W_d L_dᵀ for every earlier supernode d with a row in s (L_d = W_d S_d⁻¹: only the few rows
//! of L_d that meet s are formed, [`super::update`]); then its own columns eliminate each other. Who has a row in s next is
//! kept in linked lists. An update goes to its place at once where d's rows follow each other in s too; else it is summed
//! densely before it is scattered. [`super::substitution`] solves with the factor.
//!
//! Source: Ng & Peyton 1993 (left-looking block Cholesky).

use crate::force::Force;
use crate::real::{Real, to};
use crate::solver::elimination::{Lists, NONE, Sizes, get, set};
use crate::solver::panel::{Block, below, below_mut, divided, first, subtract, three, three_mut};
use crate::solver::pivot::inverse;
use crate::solver::update::{self, Panel};
use crate::sym3::Sym3;
use crate::system::System;
use crate::vec3::Vec3;

/// An island's factor and what it is made in.
pub(crate) struct Supernodes<'a, T> {
    pub(crate) lists: Lists<&'a [u32]>,
    pub(crate) panels: &'a mut [T],
    /// Two block columns of the longest panel
    pub(crate) update: &'a mut [T],
    /// Blocks of L: two for each block column of the widest panel
    pub(crate) l: &'a mut [Block<T>],
    /// A vector in elimination order
    pub(crate) vector: &'a mut [Vec3<T>],
    /// S⁻¹, in elimination order
    pub(crate) pivots: &'a mut [[T; 6]],
    /// Per supernode: the first in the list of those that update it, the next in the list that it is in itself, and its
    /// own first row that has not been used yet
    pub(crate) head: &'a mut [u32],
    pub(crate) next: &'a mut [u32],
    pub(crate) used: &'a mut [u32],
    /// Position → row of the present panel
    pub(crate) local: &'a mut [u32],
}

/// One supernode of the lists.
#[derive(Clone, Copy)]
pub(crate) struct Node<'a> {
    /// Its first position, and the first that is no longer its own
    pub(crate) first: usize,
    pub(crate) end: usize,
    /// The positions of its rows
    pub(crate) rows: &'a [u32],
    /// Where its panel is
    pub(crate) from: usize,
    pub(crate) to: usize,
}

impl<'a> Node<'a> {
    pub(crate) fn new(lists: &Lists<&'a [u32]>, s: usize) -> Self {
        let rows = lists.list.get(get(lists.from, s)..get(lists.from, s + 1)).unwrap_or_default();
        let (first, end) = (get(lists.first, s), get(lists.first, s + 1));
        Self { first, end, rows, from: get(lists.panel, s), to: get(lists.panel, s + 1) }
    }

    /// Numbers of a block column; not 0, so that a slice can be cut into such.
    pub(crate) fn length(&self) -> usize {
        (9 * self.rows.len()).max(1)
    }
}

impl<'a, T: Real> Supernodes<'a, T> {
    /// Cuts the workspace; `None` if it is too small.
    pub(crate) fn new(
        sizes: &Sizes,
        lists: Lists<&'a [u32]>,
        numbers: &'a mut [T],
        words: &'a mut [u32],
    ) -> Option<Self> {
        let (panels, numbers) = numbers.split_at_mut_checked(sizes.panels)?;
        let (update, numbers) = numbers.split_at_mut_checked(18 * sizes.longest)?;
        let (l, numbers) = numbers.split_at_mut_checked(18 * sizes.widest)?;
        let l = l.as_chunks_mut().0.as_chunks_mut().0;
        let (vector, numbers) = numbers.split_at_mut_checked(3 * sizes.rows)?;
        let vector = vector.as_chunks_mut().0;
        let pivots = numbers.get_mut(..6 * sizes.rows)?.as_chunks_mut().0;
        let (head, words) = words.split_at_mut_checked(sizes.supers)?;
        let (next, words) = words.split_at_mut_checked(sizes.supers)?;
        let (used, words) = words.split_at_mut_checked(sizes.supers)?;
        let local = words.get_mut(..sizes.rows)?;
        Some(Self { lists, panels, update, l, vector, pivots, head, next, used, local })
    }

    /// A into the panels, times `scale`. `blocks` is scratch.
    #[inline(never)]
    pub(crate) fn assemble<S: Real, F: Force<S>>(
        &mut self,
        system: &System<'_, S, F>,
        blocks: &mut [[S; 6]],
        scale: S,
    ) {
        for number in self.panels.iter_mut() {
            *number = T::ZERO;
        }
        let scaled = |block: [[S; 3]; 3]| block.map(|row| row.map(|x| to(scale * x)));
        system.diagonal(blocks);
        for s in 0..self.head.len() {
            let node = Node::new(&self.lists, s);
            let rows = self.lists.row.get(node.first..node.end).unwrap_or_default();
            for (k, row) in rows.iter().enumerate() {
                if let Some(block) = blocks.get(*row as usize) {
                    let at = node.from + k * (node.length() + 3);
                    add_block(self.panels, at, 3 * node.rows.len(), scaled(Sym3(*block).dense()));
                }
            }
        }
        let mut place = self.lists.place.as_chunks::<2>().0.iter();
        system.each_spring(|_, _, h| {
            if let Some([at, column]) = place.next()
                && *at != NONE
            {
                add_block(
                    self.panels,
                    *at as usize,
                    *column as usize,
                    scaled(h.dense()).map(|h| h.map(T::neg)),
                );
            }
        });
    }

    /// Factors what was assembled. `false` if a pivot is not positive.
    #[inline(always)]
    pub(crate) fn factor(&mut self) -> bool {
        self.head.fill(NONE);
        for s in 0..self.head.len() {
            let node = Node::new(&self.lists, s);
            for (local, position) in node.rows.iter().enumerate() {
                set(self.local, *position as usize, local);
            }
            let mut d = get(self.head, s);
            while let Some(next) = self.next.get(d).copied().filter(|_| d != NONE as usize) {
                self.take_from(d, &node);
                d = next as usize;
            }
            let Some(panel) = self.panels.get_mut(node.from..node.to) else { return false };
            let Some(pivots) = self.pivots.get_mut(node.first..node.end) else { return false };
            if !eliminate(panel, node.length(), pivots, self.l) {
                return false;
            }
            self.queue(s, &node, node.end.saturating_sub(node.first));
        }
        true
    }

    /// Puts s, whose rows from `used` on are still to be used, into the list of the supernode that its next row is in.
    fn queue(&mut self, s: usize, node: &Node<'_>, used: usize) {
        if let Some(position) = node.rows.get(used) {
            let at = get(self.lists.of, *position as usize);
            set(self.used, s, used);
            set(self.next, s, get(self.head, at));
            set(self.head, at, s);
        }
    }

    /// Takes what supernode d does to `node`, two block columns at a time.
    #[inline(always)]
    fn take_from(&mut self, d: usize, node: &Node<'_>) {
        let source = Node::new(&self.lists, d);
        let mut q = get(self.used, d);
        let Some((done, panel)) = self.panels.split_at_mut_checked(node.from) else { return };
        let numbers = done.get(source.from..source.to).unwrap_or_default();
        let pivots = self.pivots.get(source.first..source.end).unwrap_or_default();
        let within = |q: usize| source.rows.get(q).map(|p| *p as usize).filter(|p| *p < node.end);
        let stride = source.length() / 3;
        while let Some(position) = within(q) {
            let rows = source.rows.get(q..).unwrap_or_default();
            let w = Panel { numbers, stride, from: 3 * q };
            let height = 3 * rows.len();
            let second = within(q + 1);
            // Where all of the source's rows follow each other in the target too, no update is put down in between.
            let at = get(self.local, position);
            let last = rows.last().map_or(NONE as usize, |last| get(self.local, *last as usize));
            let dense = last == at.saturating_add(rows.len()).saturating_sub(1);
            let to = node.length() / 3;
            let from = position.saturating_sub(node.first).saturating_mul(node.length());
            let place = if dense { panel.get_mut(from.saturating_add(3 * at)..) } else { None };
            match (second, place) {
                (Some(second), Some(y)) if second == position + 1 => {
                    let l = form(self.l, numbers, stride, q, pivots);
                    update::subtract::<T, 2, false>(y, to, height, w, l);
                    q += 2;
                }
                (None, Some(y)) => {
                    let l = form(self.l, numbers, stride, q, pivots);
                    update::subtract::<T, 1, false>(y, to, height, w, l);
                    q += 1;
                }
                (Some(second), _) => {
                    let l = form(self.l, numbers, stride, q, pivots);
                    let Some(update) = self.update.get_mut(..6 * height) else { return };
                    update::subtract::<T, 2, true>(update, height, height, w, l);
                    let Some((one, two)) = update.split_at_mut_checked(3 * height) else { return };
                    if let (Some(target), Some(update)) = (column_mut(panel, node, position), three(one)) {
                        scatter(target, update, rows, self.local);
                    }
                    if let (Some(target), Some(update)) = (column_mut(panel, node, second), three(two)) {
                        scatter(target, below(update, 1), rows.get(1..).unwrap_or_default(), self.local);
                    }
                    q += 2;
                }
                _ => {
                    let l = form(self.l, numbers, stride, q, pivots);
                    let Some(update) = self.update.get_mut(..3 * height) else { return };
                    update::subtract::<T, 1, true>(update, height, height, w, l);
                    if let (Some(target), Some(update)) = (column_mut(panel, node, position), three(update)) {
                        scatter(target, update, rows, self.local);
                    }
                    q += 1;
                }
            }
        }
        self.queue(d, &source, q);
    }
}

/// Adds a symmetric block at a place of a panel whose columns are so long.
#[inline(always)]
fn add_block<T: Real>(panels: &mut [T], at: usize, length: usize, block: [[T; 3]; 3]) {
    for (c, column) in block.into_iter().enumerate() {
        let at = at + c * length;
        for (number, h) in panels.get_mut(at..at + 3).unwrap_or_default().iter_mut().zip(column) {
            *number += h;
        }
    }
}

/// target += update, block rows of the update going where `local` says: as many at once as follow each other there.
#[inline(always)]
fn scatter<T: Real>(target: [&mut [T]; 3], update: [&[T]; 3], rows: &[u32], local: &[u32]) {
    let [t0, t1, t2] = target;
    let [u0, u1, u2] = update;
    let mut from = 0;
    while let Some(first) = rows.get(from) {
        let at = get(local, *first as usize);
        let later = rows.get(from + 1..).unwrap_or_default();
        let more =
            later.iter().zip(1..).take_while(|(row, k)| get(local, **row as usize) == at.wrapping_add(*k));
        let to = from + 1 + more.count();
        let numbers = 3 * (to - from);
        add(t0, 3 * at, u0, 3 * from, numbers);
        add(t1, 3 * at, u1, 3 * from, numbers);
        add(t2, 3 * at, u2, 3 * from, numbers);
        from = to;
    }
}

/// So many numbers of y, from `at` on, += those of x from `from` on.
#[inline(always)]
fn add<T: Real>(y: &mut [T], at: usize, x: &[T], from: usize, numbers: usize) {
    let y = y.get_mut(at..at.saturating_add(numbers)).unwrap_or_default();
    for (y, x) in y.iter_mut().zip(x.get(from..).unwrap_or_default()) {
        *y += *x;
    }
}

/// The block column of a position in its node's panel.
#[inline(always)]
fn column_mut<'p, T>(panel: &'p mut [T], node: &Node<'_>, position: usize) -> Option<[&'p mut [T]; 3]> {
    let from = position.saturating_sub(node.first).saturating_mul(node.length());
    panel.get_mut(from..from.saturating_add(node.length())).and_then(three_mut)
}

/// L's B block rows from `q` on, of every block column.
#[inline(always)]
fn form<'l, T: Real, const B: usize>(
    room: &'l mut [Block<T>],
    numbers: &[T],
    stride: usize,
    q: usize,
    pivots: &[[T; 6]],
) -> &'l [[Block<T>; B]] {
    let l = room.as_chunks_mut::<B>().0.get_mut(..pivots.len()).unwrap_or_default();
    let mut column = 3 * q;
    for (blocks, pivot) in l.iter_mut().zip(pivots) {
        for (b, block) in blocks.iter_mut().enumerate() {
            for (c, row) in block.iter_mut().enumerate() {
                let w = |k: usize| numbers.get(column + k * stride + 3 * b + c).copied().unwrap_or(T::ZERO);
                *row = Sym3(*pivot).mul([w(0), w(1), w(2)]);
            }
        }
        column += 3 * stride;
    }
    l
}

/// The columns of one panel eliminate each other, two at a time; `pivots` gets their S⁻¹.
#[inline(always)]
fn eliminate<T: Real>(panel: &mut [T], length: usize, pivots: &mut [[T; 6]], room: &mut [Block<T>]) -> bool {
    let stride = length / 3;
    let mut k = 0;
    while k < pivots.len() {
        let Some((before, [pivot, rest @ ..])) = pivots.split_at_mut_checked(k) else { return false };
        let Some((done, todo)) = panel.split_at_mut_checked(k.saturating_mul(length)) else { return false };
        let w = Panel { numbers: done, stride, from: 3 * k };
        let height = stride.saturating_sub(3 * k);
        let two = !rest.is_empty();
        let Some(y) = todo.get_mut(3 * k..) else { return false };
        if k > 0 && two {
            update::subtract::<T, 2, false>(y, stride, height, w, form(room, done, stride, k, before));
        } else if k > 0 {
            update::subtract::<T, 1, false>(y, stride, height, w, form(room, done, stride, k, before));
        }
        let Some((column, later)) = todo.split_at_mut_checked(length) else { return false };
        let Some(inverted) = column_pivot(column, k) else { return false };
        *pivot = inverted.0;
        k += 1;
        if let [second, ..] = rest {
            let (Some(w), Some(y)) = (three(column), later.get_mut(..length).and_then(three_mut)) else {
                return false;
            };
            let w = below(w, k);
            subtract(below_mut(y, k), w, &divided(first(w), &inverted));
            let Some(inverted) = later.get(..length).and_then(|column| column_pivot(column, k)) else {
                return false;
            };
            *second = inverted.0;
            k += 1;
        }
    }
    true
}

/// The inverse of a block column's pivot, at block row k.
#[inline(always)]
fn column_pivot<T: Real>(column: &[T], k: usize) -> Option<Sym3<T>> {
    let [[xx, ..], [xy, yy, _], [xz, yz, zz]] = first(below(three(column)?, k));
    inverse(Sym3([xx, yy, zz, xy, xz, yz]))
}
