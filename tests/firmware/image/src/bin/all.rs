//! Every job, one after the other.
#![no_std]
#![no_main]

/// Called by the startup code.
// SAFETY: the only `main` of this program.
#[unsafe(no_mangle)]
extern "C" fn main() -> ! {
    firmware_image::run::run(firmware_jobs::ALL)
}
