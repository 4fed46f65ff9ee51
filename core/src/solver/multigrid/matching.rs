//! Aggregates: which rows of a level become one row of the next. Passes of heaviest-edge pairwise matching in index
//! order: each group that is still alone takes the neighbour it is tied to most firmly. k passes make groups of up to 2ᵏ.
//!
//! An edge's weight is α + |w|² = s·k (+ θh c), its stiffness, whatever the state and whether it is clamped: so the
//! aggregates are those of the net at rest. It is computed in floats, so weights that differ by less than 1/256 count as
//! equal, and then the first met is taken: a regular grid keeps its order.
//!
//! Cost: O(springs) per pass, once per pattern. Source: Notay 2010, *An aggregation-based algebraic multigrid method*.

use super::words::{NONE, get, set};

/// What matching works in: `first` is one longer than the level has rows, `touching` has room for every edge twice.
pub(super) struct Scratch<'s> {
    /// Where each row's edges begin in `touching`
    pub(super) first: &'s mut [u32],
    pub(super) touching: &'s mut [u32],
    /// The smallest row of each row's group
    pub(super) group: &'s mut [u32],
    /// The next row of the same group
    pub(super) next: &'s mut [u32],
    /// Has this group found its partner in this pass?
    pub(super) taken: &'s mut [u32],
    /// How firmly each group is tied to the one being looked at
    pub(super) tie: &'s mut [f32],
}

/// Writes each row's aggregate; answers how many there are. `ends` of an edge are two rows, or NONE and then it is none.
pub(super) fn aggregate(
    passes: usize,
    ends: [&[u32]; 2],
    weight: &[f32],
    aggregate: &mut [u32],
    s: &mut Scratch<'_>,
) -> usize {
    let rows = s.group.len();
    touch(ends, s);
    for (i, (group, next)) in s.group.iter_mut().zip(s.next.iter_mut()).enumerate() {
        (*group, *next) = (i as u32, NONE);
    }
    s.tie.fill(0.0);
    for _ in 0..passes {
        s.taken.fill(0);
        for i in 0..rows as u32 {
            if get(s.group, i as usize) == i && get(s.taken, i as usize) == 0 {
                let partner = heaviest(i, ends, weight, s);
                if partner != NONE {
                    join(i, partner, s);
                }
            }
        }
    }
    let mut count = 0;
    for i in 0..rows {
        let root = get(s.group, i);
        let number = if root as usize == i { count } else { get(aggregate, root as usize) };
        count += u32::from(root as usize == i);
        set(aggregate, i, number);
    }
    count as usize
}

/// Lists each row's edges: a counting sort.
fn touch(ends: [&[u32]; 2], s: &mut Scratch<'_>) {
    let [a, b] = ends;
    s.first.fill(0);
    for row in a.iter().chain(b).filter(|row| **row != NONE) {
        set(s.first, *row as usize, get(s.first, *row as usize) + 1);
    }
    let mut sum = 0;
    for first in s.first.iter_mut() {
        sum += *first;
        *first = sum;
    }
    // Backwards from each row's end, so that edges end up in their order and `first` at the beginnings.
    for (edge, (a, b)) in a.iter().zip(b).enumerate().rev() {
        for row in [*a, *b].into_iter().filter(|row| *row != NONE) {
            let place = get(s.first, row as usize).wrapping_sub(1);
            set(s.first, row as usize, place);
            set(s.touching, place as usize, edge as u32);
        }
    }
}

/// Calls `visit(group, weight)` for each edge that leaves group i.
fn leaving(
    i: u32,
    ends: [&[u32]; 2],
    weight: &[f32],
    s: &mut Scratch<'_>,
    mut visit: impl FnMut(u32, f32, &mut f32, bool),
) {
    let [a, b] = ends;
    let mut row = i;
    while row != NONE {
        let edges = get(s.first, row as usize) as usize..get(s.first, row as usize + 1) as usize;
        for edge in s.touching.get(edges).unwrap_or_default() {
            let edge = *edge as usize;
            let (a, b) = (get(a, edge), get(b, edge));
            let group = get(s.group, if a == row { b } else { a } as usize);
            let taken = get(s.taken, group as usize) != 0;
            if let Some(tie) = s.tie.get_mut(group as usize).filter(|_| group != i) {
                visit(group, weight.get(edge).copied().unwrap_or(0.0), tie, taken);
            }
        }
        row = get(s.next, row as usize);
    }
}

/// The group that i is tied to most firmly among those still alone.
fn heaviest(i: u32, ends: [&[u32]; 2], weight: &[f32], s: &mut Scratch<'_>) -> u32 {
    let (mut best, mut most) = (NONE, 0.0);
    leaving(i, ends, weight, s, |group, weight, tie, taken| {
        *tie += weight;
        if !taken && (*tie > most * (1.0 + 1.0 / 256.0) || (group == best && *tie > most)) {
            (best, most) = (group, *tie);
        }
    });
    leaving(i, ends, weight, s, |_, _, tie, _| *tie = 0.0);
    best
}

/// Makes two groups one.
fn join(i: u32, partner: u32, s: &mut Scratch<'_>) {
    let mut last = i;
    while get(s.next, last as usize) != NONE {
        last = get(s.next, last as usize);
    }
    set(s.next, last as usize, partner);
    let mut row = partner;
    while row != NONE {
        set(s.group, row as usize, i);
        row = get(s.next, row as usize);
    }
    set(s.taken, i as usize, 1);
    set(s.taken, partner as usize, 1);
}
