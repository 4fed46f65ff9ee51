//! Lists in a borrowed buffer.

/// No row, no edge.
pub(super) const NONE: u32 = u32::MAX;

/// What lies past the end is [`NONE`].
#[inline(always)]
pub(super) fn get(list: &[u32], i: usize) -> u32 {
    list.get(i).copied().unwrap_or(NONE)
}

#[inline(always)]
pub(super) fn set(list: &mut [u32], i: usize, value: u32) {
    if let Some(place) = list.get_mut(i) {
        *place = value;
    }
}

/// Takes the first n items off a buffer; `None`, and nothing is taken, if it has not so many.
#[inline]
pub(super) fn take<'a, X>(pool: &mut &'a mut [X], n: usize) -> Option<&'a mut [X]> {
    let whole = core::mem::take(pool);
    if n > whole.len() {
        *pool = whole;
        return None;
    }
    let (first, rest) = whole.split_at_mut_checked(n)?;
    *pool = rest;
    Some(first)
}

/// Leaves out some numbers, fewer than `line`, so that the next begins a line of the cache.
pub(super) fn align(pool: &mut &mut [f32], line: usize) -> Option<()> {
    let away = pool.as_ptr().align_offset(line * size_of::<f32>());
    take(pool, if away < line { away } else { 0 }).map(|_| ())
}
