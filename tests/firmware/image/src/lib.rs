//! What the programs share: how they start, print and end. The same on every board: `main` is called with a stack and
//! cleared memory; text and the exit code go through semihosting, to QEMU or to a debug probe.
#![no_std]

pub mod console;
pub mod count;
pub mod minimal;
pub mod run;
pub mod stack;

#[cfg(target_arch = "aarch64")]
mod start_aarch64;

// The startup code of the other cores; named so that it is linked.
#[cfg(target_arch = "arm")]
use cortex_m_rt as _;
#[cfg(any(target_arch = "riscv32", target_arch = "riscv64"))]
use riscv_rt as _;

/// Nothing in the kernel can panic (that is shown by linking); should a program do, it says so and ends with 101.
#[panic_handler]
fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
    let mut console = console::Console::new();
    _ = core::fmt::Write::write_fmt(&mut console, format_args!("{info}\n"));
    console::exit(101)
}
