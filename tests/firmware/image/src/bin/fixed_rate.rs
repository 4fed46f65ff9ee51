//! `core/examples/fixed_rate.rs`, on a board.
#![no_std]
#![no_main]

// Its `println` goes to the debugger.
#[macro_use]
extern crate semihosting;

#[path = "../../../../../core/examples/fixed_rate.rs"]
mod example;

/// Called by the startup code.
// SAFETY: the only `main` of this program.
#[unsafe(no_mangle)]
extern "C" fn main() -> ! {
    example::main();
    firmware_image::console::exit(0)
}
