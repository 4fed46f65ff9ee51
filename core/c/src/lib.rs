//! The kernel for C: a scene in one buffer that the caller owns.
//!
//! A handle is the buffer's own address. The buffer begins with a header (magic word, sizes, counts, options), the
//! numbers and words of a [`hooke::SceneIn`] follow, and nothing in it is an address. Every call attaches to the buffer
//! anew and lets go of it before it returns. The alternative, a `SceneIn` value with its twenty-three slices stored at the
//! front of the buffer that they point into, would save the attaching (some hundred instructions) and cost what makes
//! this interface simple to trust: stored slices alias the buffer between calls, break when it is moved, and turn any
//! stray write into a wild pointer. So here every content of a buffer is a valid value of its type: what is damaged gives
//! an error or wrong numbers, never an access outside the buffer. A copy of a buffer is a copy of the scene.
//!
//! `unsafe` is what reads or writes through a caller's pointer, all of it in [`buffer`] and [`pointer`]; the exported
//! functions only pass pointers on. [`single`] is written by hand, `double` from it by `header.sh`, which also writes
//! `include/hooke.h`, where the interface is documented for its users.

#![no_std]
#![allow(non_camel_case_types)] // The types of `hooke.h`.
#![allow(clippy::missing_safety_doc)] // What a caller promises stands once, at the head of `hooke.h`.

mod buffer;
mod call;
mod double;
mod motion;
mod options;
mod pointer;
mod report;
mod single;
mod status;

/// A staticlib needs a panic handler; nothing reaches this one, as `tests/check.sh` shows by linking with `prove`.
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    #[cfg(feature = "prove")]
    {
        unsafe extern "C" {
            fn hooke_panicked() -> !;
        }
        // SAFETY: never linked; the check fails if this symbol is left in the library.
        unsafe { hooke_panicked() }
    }
    #[cfg(not(feature = "prove"))]
    loop {
        core::hint::spin_loop();
    }
}

/// What the panic check must catch: an index that the compiler cannot show to be in range.
#[cfg(feature = "sabotage")]
#[unsafe(no_mangle)]
pub extern "C" fn hooke_sabotage(i: usize) -> u8 {
    #[allow(clippy::indexing_slicing)]
    b"hooke"[i]
}
