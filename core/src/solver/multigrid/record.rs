//! What is kept of an island's hierarchy from step to step: a record of its sizes, the springs' places, the levels' patterns.

use super::level::Size;
use super::sizes::LEVELS;
use super::strips::Extent;
use super::words::take;

/// What is known of an island's hierarchy.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Shape {
    pub(super) levels: usize,
    pub(super) size: [Size; LEVELS],
}

/// Words of the record: two of fingerprint, springs, levels, and of each level rows, strips, the farthest offset, loose tiles,
/// edges between aggregates.
pub(super) const RECORD: usize = 4 + 5 * LEVELS;

/// Reads a record; `None` if it is of another pattern.
pub(super) fn recall(record: &[u32], fingerprint: [u32; 2], rows: usize, springs: usize) -> Option<Shape> {
    let mut words = record.iter().map(|word| *word as usize);
    let mut next = || words.next();
    let [low, high] = fingerprint.map(|word| word as usize);
    let same = next()? == low && next()? == high && next()? == springs;
    let mut shape = Shape { levels: next()?, ..Shape::default() };
    for size in &mut shape.size {
        let (rows, strips, farthest, loose, cross) = (next()?, next()?, next()?, next()?, next()?);
        *size = Size { rows, extent: Extent { strips, farthest, loose }, cross };
    }
    let [first, ..] = shape.size;
    (same && first.rows == rows && (1..=LEVELS).contains(&shape.levels)).then_some(shape)
}

/// Writes it.
pub(super) fn remember(record: &mut [u32], fingerprint: [u32; 2], springs: usize, shape: &Shape) {
    let [low, high] = fingerprint;
    let head = [low, high, springs as u32, shape.levels as u32];
    let sizes = shape.size.iter().flat_map(|Size { rows, extent, cross }| {
        [*rows, extent.strips, extent.farthest, extent.loose, *cross].map(|word| word as u32)
    });
    for (place, word) in record.iter_mut().zip(head.into_iter().chain(sizes)) {
        *place = word;
    }
}

/// Leaves the record and the springs' places; what follows are the levels' patterns.
pub(super) fn skip_record<'a>(kept: &mut &'a mut [u32], springs: usize) -> Option<&'a mut [[u32; 2]]> {
    take(kept, RECORD)?;
    Some(take(kept, 2 * springs)?.as_chunks_mut().0)
}
