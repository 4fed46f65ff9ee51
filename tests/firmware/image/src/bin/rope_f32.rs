//! The rope in `f32` alone: fits the 16 KiB of a micro:bit.
#![no_std]
#![no_main]

/// Called by the startup code.
// SAFETY: the only `main` of this program.
#[unsafe(no_mangle)]
extern "C" fn main() -> ! {
    firmware_image::run::run(&[firmware_jobs::rope::F32])
}
