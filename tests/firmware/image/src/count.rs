//! Instructions so far, under QEMU's deterministic instruction clock (`-icount`): instructions, not cycles.

use core::hint::black_box;

#[cfg(target_arch = "arm")]
mod clock {
    //! The first timer of these boards, 32 bits wide, counts down once in 40 ns (25 MHz); with `-icount shift=6` an
    //! instruction takes 64 ns. Spans up to 2.6 thousand million instructions, to ±1.
    const CONTROL: *mut u32 = 0x4000_0000 as *mut u32;
    const VALUE: *mut u32 = 0x4000_0004 as *mut u32;
    const RELOAD: *mut u32 = 0x4000_0008 as *mut u32;

    pub fn start() {
        // SAFETY: the timer's registers on the MPS2 boards; nothing else uses them here.
        unsafe {
            RELOAD.write_volatile(u32::MAX);
            VALUE.write_volatile(u32::MAX);
            CONTROL.write_volatile(1); // on, no interrupt
        }
    }

    pub fn ticks() -> u64 {
        // SAFETY: as above.
        u64::from(u32::MAX - unsafe { VALUE.read_volatile() })
    }

    pub fn instructions(from: u64, to: u64) -> u64 {
        to.saturating_sub(from) * 40 / 64
    }
}

#[cfg(any(target_arch = "riscv32", target_arch = "riscv64"))]
mod clock {
    //! `minstret`, the counter of retired instructions; with `-icount shift=0` it is exact.
    pub fn start() {}

    pub fn ticks() -> u64 {
        let low: usize;
        // SAFETY: reads a counter that machine mode may always read; touches no memory.
        unsafe { core::arch::asm!("csrr {}, minstret", out(reg) low, options(nomem, nostack)) }
        low as u64
    }

    pub fn instructions(from: u64, to: u64) -> u64 {
        u64::from((to as u32).wrapping_sub(from as u32))
    }
}

#[cfg(target_arch = "aarch64")]
mod clock {
    //! The architecture's timer counts once in 16 ns (62.5 MHz); with `-icount shift=0` an instruction takes 1 ns. To
    //! ±16.
    pub fn start() {}

    pub fn ticks() -> u64 {
        let ticks: u64;
        // SAFETY: reads a counter that may always be read here; touches no memory.
        unsafe { core::arch::asm!("isb", "mrs {}, cntvct_el0", out(reg) ticks, options(nomem, nostack)) }
        ticks
    }

    pub fn instructions(from: u64, to: u64) -> u64 {
        to.wrapping_sub(from) * 16
    }
}

/// Instructions that `work` takes, and what it answers.
pub fn instructions<X>(work: impl FnOnce() -> X) -> (u64, X) {
    clock::start();
    let from = clock::ticks();
    // Else the compiler may move the work past the clock, which it does not touch.
    let answer = black_box(black_box(work)());
    (clock::instructions(from, clock::ticks()), answer)
}
