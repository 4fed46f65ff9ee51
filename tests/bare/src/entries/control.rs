//! What a walk over calls must refuse, for the reason in its name: recursion, and a call through a pointer.

use core::hint::black_box;

/// Calls itself.
#[unsafe(export_name = "control::recursive")]
pub fn recursive(n: u32) -> u32 {
    if n < 2 { n } else { black_box(recursive(black_box(n - 1))) ^ recursive(n - 2) }
}

/// Calls what it is given.
#[unsafe(export_name = "control::indirect")]
pub fn indirect(f: fn(u32) -> u32, n: u32) -> u32 {
    f(n) ^ 1
}
