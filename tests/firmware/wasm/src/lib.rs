//! The jobs as a WebAssembly module that imports nothing: `run` writes their traces into the module's memory.
#![no_std]

use core::fmt::{self, Write};
use core::sync::atomic::{AtomicUsize, Ordering};

use static_cell::ConstStaticCell;

const ROOM: usize = 64 * 1024;
static TEXT: ConstStaticCell<[u8; ROOM]> = ConstStaticCell::new([0; ROOM]);
static LENGTH: AtomicUsize = AtomicUsize::new(0);

struct Text(&'static mut [u8]);

impl Write for Text {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let start = LENGTH.load(Ordering::Relaxed);
        let end = start + text.len();
        self.0.get_mut(start..end).ok_or(fmt::Error)?.copy_from_slice(text.as_bytes());
        LENGTH.store(end, Ordering::Relaxed);
        Ok(())
    }
}

/// Runs all jobs, once; answers where the text is. A job that fails says so in it.
// SAFETY: the only function of this name.
#[unsafe(no_mangle)]
pub extern "C" fn run() -> *const u8 {
    let mut text = Text(TEXT.take());
    for job in firmware_jobs::ALL {
        if let Err(why) = job.run(&mut text) {
            _ = writeln!(text, "\nfailed {} {}: {why:?}", job.name, job.precision);
        }
    }
    text.0.as_ptr()
}

/// How long the text is.
// SAFETY: the only function of this name.
#[unsafe(no_mangle)]
pub extern "C" fn length() -> usize {
    LENGTH.load(Ordering::Relaxed)
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    core::arch::wasm32::unreachable()
}
