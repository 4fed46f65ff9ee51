//! Instructions so far, under QEMU's deterministic instruction clock (`-icount`): instructions, not cycles.

#[cfg(target_arch = "arm")]
mod clock {
    //! SysTick counts 40 ns a tick on these boards (25 MHz); with `-icount shift=6` an instruction takes 64 ns. It is
    //! 24 bits wide and counts down: a longer span than 10 million instructions is answered as 0, not counted.
    const CONTROL: *mut u32 = 0xe000_e010 as *mut u32;
    const RELOAD: *mut u32 = 0xe000_e014 as *mut u32;
    const VALUE: *mut u32 = 0xe000_e018 as *mut u32;
    const ALL: u32 = 0x00ff_ffff;

    pub fn start() {
        // SAFETY: SysTick's registers on every Cortex-M; nothing else uses them here.
        unsafe {
            RELOAD.write_volatile(ALL);
            VALUE.write_volatile(0);
            CONTROL.write_volatile(0b101); // on, the core's clock, no interrupt
            while VALUE.read_volatile() == 0 {} // until the first tick has loaded it
        }
        came_round(); // its first load does not count
    }

    pub fn ticks() -> u64 {
        // SAFETY: as above.
        u64::from(ALL - unsafe { VALUE.read_volatile() })
    }

    /// Has the counter come round since it was last asked? Reading clears the answer.
    fn came_round() -> bool {
        const COUNTED_TO_ZERO: u32 = 1 << 16;
        // SAFETY: as above.
        unsafe { CONTROL.read_volatile() & COUNTED_TO_ZERO != 0 }
    }

    pub fn instructions(from: u64, to: u64) -> u64 {
        if came_round() { 0 } else { to.saturating_sub(from) * 40 / 64 }
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
    //! Not counted: no counter of instructions without a performance monitor.
    pub fn start() {}

    pub fn ticks() -> u64 {
        0
    }

    pub fn instructions(_: u64, _: u64) -> u64 {
        0
    }
}

/// Instructions that `work` takes, and what it answers.
pub fn instructions<X>(work: impl FnOnce() -> X) -> (u64, X) {
    clock::start();
    let from = clock::ticks();
    let answer = work();
    (clock::instructions(from, clock::ticks()), answer)
}
