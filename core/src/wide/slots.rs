//! Slots, for springs at many distances (tetrahedral meshes): rows sorted by how many springs they have, eight side by side,
//! and of each eight the k-th spring of every row in the k-th *slot*, eight springs wide (SELL-8 with the window σ = all rows).
//! A spring lies in two slots, one at each end, so that rows only gather: the *own* slots hold the springs that a row owns,
//! the *above* slots those that rows above it in the scene's order own, both in the order of the scene's list. A row's
//! terms are then added in the order of [`crate::System`], and the product has its bits.
//!
//! Each slot says where the other ends lie; those of rows that have no k-th spring point to the row itself, with a Hessian
//! of 0. Rows are sorted by (own, above), above alternately up and down, so that neighbours differ little: slots hold a fifth
//! more than the springs on a mesh of 700 particles, less on larger ones. A spring to a pin has a place of its own behind
//! the rows for that end. Slot 0 is all zeros: from it come the numbers of springs that are not there.
//!
//! Words: where each eight's slots begin, the other ends, where above slots have their numbers from, and each row's place.
//!
//! Source: Kreutzer, Hager, Wellein, Fehske, Bishop 2014, "A unified sparse matrix data format for efficient general sparse
//! matrix-vector multiplication on modern processors with wide SIMD units", SIAM J. Sci. Comput. 36(5).

use crate::parts::IslandParts;
use crate::real::Real;
use crate::wide::eight::WIDTH;
use crate::wide::layout::Layout;

/// How many there are of what.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Counts {
    pub(crate) rows: usize,
    pub(crate) places: usize,
    /// Slots of springs at the rows that own them, slot 0 too
    pub(crate) own: usize,
    /// Slots of springs at their other ends
    pub(crate) above: usize,
}

/// The words, cut.
#[derive(Clone, Copy)]
pub(crate) struct Slots<'w> {
    /// Where the own and the above slots of each eight rows begin; one more says where the last end
    pub(crate) starts: &'w [[u32; 2]],
    /// Places of the other ends
    pub(crate) own: &'w [[u32; WIDTH]],
    pub(crate) above: &'w [[u32; WIDTH]],
    /// Where each spring's numbers lie among the own slots, [`NUMBERS`] a slot
    pub(crate) source: &'w [[u32; WIDTH]],
    /// The place of each row
    pub(crate) places: &'w [u32],
}

/// Numbers of a slot's Hessians, and of its pulls.
pub(crate) const NUMBERS: usize = 4 * WIDTH;
/// Numbers of springs that rows are told apart by.
const KEYS: usize = 64;
/// More rows or springs than that are not counted: counts are kept as numbers of either precision.
const MOST: usize = 1 << 24;

impl Counts {
    const fn tiles(&self) -> usize {
        self.places / WIDTH
    }

    pub(crate) const fn words(&self) -> usize {
        2 * (self.tiles() + 1) + WIDTH * (self.own + 2 * self.above) + self.rows
    }
}

impl<'w> Slots<'w> {
    #[inline(always)]
    pub(crate) fn cut(counts: &Counts, words: &'w [u32]) -> Option<Self> {
        let (starts, rest) = words.split_at_checked(2 * (counts.tiles() + 1))?;
        let (own, rest) = rest.split_at_checked(WIDTH * counts.own)?;
        let (above, rest) = rest.split_at_checked(WIDTH * counts.above)?;
        let (source, rest) = rest.split_at_checked(WIDTH * counts.above)?;
        let (starts, own, above) = (starts.as_chunks().0, own.as_chunks().0, above.as_chunks().0);
        Some(Self { starts, own, above, source: source.as_chunks().0, places: rest.get(..counts.rows)? })
    }

    /// The own slots of an eight, or the above ones, from the first until before the last.
    #[inline(always)]
    pub(crate) fn range(&self, tile: usize, which: usize) -> core::ops::Range<usize> {
        let start =
            |tile: usize| self.starts.get(tile).and_then(|start| start.get(which)).map_or(0, |s| *s as usize);
        start(tile)..start(tile + 1)
    }
}

// What an island's scratch keeps of a row: how many springs end at it from above, ...
const ABOVE: usize = 0;
// ... and of a place in the order: the row by the first key, ...
const FIRST: usize = 1;
// ... and by both.
const ORDER: usize = 2;

/// A count kept as a number.
fn count<T: Real>(block: Option<&[T; 6]>, which: usize) -> usize {
    block.and_then(|block| block.get(which)).map_or(0, |x| x.to_f64() as usize)
}

fn set<T: Real>(block: Option<&mut [T; 6]>, which: usize, n: usize) {
    if let Some(x) = block.and_then(|block| block.get_mut(which)) {
        *x = T::from_count(n);
    }
}

/// Sorts the rows, in the blocks, and counts the slots. `None` if slots would be mostly zeros.
#[inline(never)]
pub(crate) fn arrange<T: Real>(island: &mut IslandParts<'_, T>) -> Option<Layout> {
    let (own, others) = (island.matrix.own, island.matrix.other);
    let (rows, springs) = (own.len(), others.len());
    if rows == 0 || rows > MOST || springs > MOST {
        return None;
    }
    let blocks = &mut *island.block;
    blocks.iter_mut().for_each(|block| *block = [T::ZERO; 6]);
    let mut anchors = 0;
    for other in others {
        match blocks.get_mut(*other as usize) {
            Some([above, ..]) => *above += T::ONE,
            None => anchors += 1,
        }
    }
    let owns = |row: usize| own.get(row).map_or(0, |own| core::cmp::min(*own as usize, KEYS - 1));
    let least = |n: usize| core::cmp::min(n, KEYS - 1);
    sort(
        blocks,
        |_, k| k,
        FIRST,
        |blocks, row| {
            let above = least(count(blocks.get(row), ABOVE));
            // Up and down in turn.
            if owns(row) % 2 == 0 { above } else { KEYS - 1 - above }
        },
    );
    sort(blocks, |blocks, k| count(blocks.get(k), FIRST), ORDER, |_, row| owns(row));
    let mut counts = Counts { rows, places: rows.next_multiple_of(WIDTH), own: 1, above: 0 };
    each_tile(own, blocks, rows, |_, own, above| {
        (counts.own, counts.above) = (counts.own + own, counts.above + above)
    });
    let slots = counts.own + counts.above;
    let behind = usize::next_multiple_of(anchors, WIDTH);
    let mut layout = Layout::none();
    (layout.places, layout.behind, layout.springs, layout.slots) =
        (counts.places, behind, springs, Some(counts));
    (WIDTH * slots <= 3 * springs).then_some(layout)
}

/// Sorts rows by a key, rows of one key in the order that they are told in.
fn sort<T: Real>(
    blocks: &mut [[T; 6]],
    row_of: impl Fn(&[[T; 6]], usize) -> usize,
    to: usize,
    key: impl Fn(&[[T; 6]], usize) -> usize,
) {
    let mut starts = [0_u32; KEYS];
    for row in 0..blocks.len() {
        if let Some(start) = starts.get_mut(key(blocks, row)) {
            *start += 1;
        }
    }
    let mut sum = 0;
    for start in &mut starts {
        (*start, sum) = (sum, sum + *start);
    }
    for k in 0..blocks.len() {
        let row = row_of(blocks, k);
        if let Some(start) = starts.get_mut(key(blocks, row)) {
            set(blocks.get_mut(*start as usize), to, row);
            *start += 1;
        }
    }
}

/// Visits the eights: which, and how many own and above slots each has.
fn each_tile<T: Real>(
    own: &[u32],
    blocks: &[[T; 6]],
    rows: usize,
    mut visit: impl FnMut(usize, usize, usize),
) {
    for (tile, first) in (0..rows).step_by(WIDTH).enumerate() {
        let mut most = [0; 2];
        for k in first..core::cmp::min(first + WIDTH, rows) {
            let row = count(blocks.get(k), ORDER);
            let has = [own.get(row).map_or(0, |own| *own as usize), count(blocks.get(row), ABOVE)];
            for (most, has) in most.iter_mut().zip(has) {
                *most = core::cmp::max(*most, has);
            }
        }
        visit(tile, most[0], most[1]);
    }
}

/// Writes the words of an island that was just arranged.
#[inline(never)]
pub(crate) fn fill<T: Real>(
    island: &mut IslandParts<'_, T>,
    counts: &Counts,
    words: &mut [u32],
) -> Option<()> {
    let (starts, rest) = words.split_at_mut_checked(2 * (counts.tiles() + 1))?;
    let (ends, rest) = rest.split_at_mut_checked(WIDTH * counts.own)?;
    let (above, rest) = rest.split_at_mut_checked(WIDTH * counts.above)?;
    let (source, places) = rest.split_at_mut_checked(WIDTH * counts.above)?;
    let (starts, ends, above) =
        (starts.as_chunks_mut::<2>().0, ends.as_chunks_mut().0, above.as_chunks_mut().0);
    let source = source.as_chunks_mut().0;
    let (own, others) = (island.matrix.own, island.matrix.other);
    let blocks = &mut *island.block;
    let mut next = [1, 0];
    if let Some(first) = starts.first_mut() {
        *first = next;
    }
    each_tile(own, blocks, counts.rows, |tile, own, more| {
        // What is not there ends where it begins, and is nothing.
        let itself: [u32; WIDTH] = core::array::from_fn(|lane| (WIDTH * tile + lane) as u32);
        let [o, a] = next.map(|next: u32| next as usize);
        for ends in ends.get_mut(o..o + own).into_iter().chain(above.get_mut(a..a + more)) {
            ends.fill(itself);
        }
        next = [(o + own) as u32, (a + more) as u32];
        if let Some(start) = starts.get_mut(tile + 1) {
            *start = next;
        }
    });
    source.fill([0, 1, 2, 3, 4, 5, 6, 7]);
    for place in 0..counts.rows {
        *places.get_mut(count(blocks.get(place), ORDER))? = place as u32;
    }
    for block in blocks.iter_mut() {
        set(Some(block), ABOVE, 0);
    }
    let start = |place: usize, which: usize| Some(*starts.get(place / WIDTH)?.get(which)? as usize);
    let mut others = others.iter();
    let mut anchors = counts.places as u32;
    for (row, own) in own.iter().enumerate() {
        let at = *places.get(row)? as usize;
        for (k, other) in others.by_ref().take(*own as usize).enumerate() {
            let other = *other as usize;
            let slot = start(at, 0)? + k;
            let end = ends.get_mut(slot)?.get_mut(at % WIDTH)?;
            if other >= counts.rows {
                *end = anchors;
                anchors += 1;
                continue;
            }
            let far = *places.get(other)? as usize;
            *end = far as u32;
            let before = count(blocks.get(other), ABOVE);
            set(blocks.get_mut(other), ABOVE, before + 1);
            let higher = start(far, 1)? + before;
            *above.get_mut(higher)?.get_mut(far % WIDTH)? = at as u32;
            *source.get_mut(higher)?.get_mut(far % WIDTH)? = (NUMBERS * slot + at % WIDTH) as u32;
        }
    }
    Some(())
}
