//! This machine's vector instructions for the kernel's lanes: found once at run time, the same bits with any of them.

use hooke::Dispatch;

/// The widest instructions that this machine has.
#[derive(Debug, Clone, Copy)]
pub struct Host(pulp::Arch);

impl Host {
    /// Asks the processor.
    pub fn new() -> Self {
        Self(pulp::Arch::new())
    }
}

impl Default for Host {
    fn default() -> Self {
        Self::new()
    }
}

impl Dispatch for Host {
    #[inline(always)]
    fn run<R>(self, job: impl FnOnce() -> R) -> R {
        self.0.dispatch(job)
    }
}
