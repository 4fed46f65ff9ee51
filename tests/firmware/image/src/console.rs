//! Text and the exit code, through semihosting.

use core::fmt;

use semihosting::io::Write;

/// Gathers a line before it hands it over: a call costs a stop of the core under a probe.
pub struct Console {
    line: [u8; 128],
    len: usize,
}

impl Console {
    /// With an empty line.
    pub const fn new() -> Self {
        Self { line: [0; 128], len: 0 }
    }

    fn flush(&mut self) -> fmt::Result {
        let line = self.line.get(..self.len).unwrap_or_default();
        self.len = 0;
        let mut out = semihosting::io::stdout().map_err(|_| fmt::Error)?;
        out.write_all(line).map_err(|_| fmt::Error)
    }
}

impl Default for Console {
    fn default() -> Self {
        Self::new()
    }
}

impl fmt::Write for Console {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for byte in text.bytes() {
            if let Some(place) = self.line.get_mut(self.len) {
                *place = byte;
                self.len += 1;
            }
            if byte == b'\n' || self.len == self.line.len() {
                self.flush()?;
            }
        }
        Ok(())
    }
}

/// Ends the program.
pub fn exit(code: i32) -> ! {
    semihosting::process::exit(code)
}
