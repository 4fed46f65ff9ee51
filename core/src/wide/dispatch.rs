//! Which instructions the lanes are compiled for. The kernel itself is compiled for the target as it is; a host may hand
//! in a way to run a job with wider ones.

/// Runs a job, perhaps compiled for more instructions than the rest of the program: the job is inlined into [`run`]. It
/// must not change what is computed (no fused multiply-add), so every implementation gives the same bits.
///
/// [`run`]: Dispatch::run
pub trait Dispatch: Copy {
    /// Runs it.
    fn run<R>(self, job: impl FnOnce() -> R) -> R;
}

/// The target's own instructions.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Portable;

impl Dispatch for Portable {
    #[inline(always)]
    fn run<R>(self, job: impl FnOnce() -> R) -> R {
        job()
    }
}
