//! Every public function of the kernel behind a symbol of its own, in both precisions, so that a linker can be asked
//! what it reaches: no allocator (there is none to link), no std, and no panic (its handler calls a symbol that must
//! not be left in the library); and so that a walk over its calls can tell how deep the stack gets.
#![no_std]

#[cfg(not(feature = "sabotage"))]
mod entries;
#[cfg(not(feature = "sabotage"))]
mod entry_point;
#[cfg(not(feature = "sabotage"))]
mod shared;

unsafe extern "C" {
    fn hooke_panicked() -> !;
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    // SAFETY: never linked; the check fails if this symbol is reachable.
    unsafe { hooke_panicked() }
}

/// What must be caught: an index that the compiler cannot show to be in range. Alone, since nobody asks for the others then.
#[cfg(feature = "sabotage")]
#[unsafe(no_mangle)]
pub extern "C" fn sabotage(list: &[f64; 8], i: usize) -> f64 {
    list[i]
}
