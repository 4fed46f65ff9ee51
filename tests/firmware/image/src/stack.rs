//! How deep the stack gets: the free part is painted, the work done, and what is left of the paint counted.

const PAINT: u32 = 0xdec0_ded0;
/// How much is painted, in words: 8 KiB, which is free on every board that runs this.
const WORDS: usize = 2048;
/// Not painted, in words: room for the frames of `paint` and `left` themselves.
const MARGIN: usize = 64;

/// Bytes of stack that `work` takes below its caller's frame; the margin if it takes less.
#[inline(never)]
pub fn used(work: impl FnOnce()) -> usize {
    let mut here = 0_u32;
    // What is below the frame that holds it is free.
    let top = (&raw mut here).wrapping_sub(MARGIN);
    paint(top);
    work();
    4 * (WORDS - left(top) + MARGIN)
}

#[inline(never)]
fn paint(top: *mut u32) {
    for i in 1..=WORDS {
        // SAFETY: free stack, further down than this function's own frame; no interrupt runs.
        unsafe { top.wrapping_sub(i).write_volatile(PAINT) }
    }
}

/// Words of paint left at the far end.
#[inline(never)]
fn left(top: *mut u32) -> usize {
    // SAFETY: written by `paint`, never freed.
    let whole = |i: &usize| unsafe { top.wrapping_sub(*i).read_volatile() } == PAINT;
    (1..=WORDS).rev().take_while(whole).count()
}
