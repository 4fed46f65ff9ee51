//! Memory, counted: heap bytes of one piece of work, and the peak of the whole process.

use peak_alloc::PeakAlloc;

#[global_allocator]
static HEAP: PeakAlloc = PeakAlloc;

/// Runs `job`; answers the most heap bytes that it held at once on top of what there was.
pub(crate) fn peak_of<X>(job: impl FnOnce() -> X) -> (X, usize) {
    let before = HEAP.current_usage();
    HEAP.reset_peak_usage();
    let x = job();
    (x, HEAP.peak_usage().saturating_sub(before))
}

/// Runs `job`; answers the heap bytes that its result holds.
pub(crate) fn held_by<X>(job: impl FnOnce() -> X) -> (X, usize) {
    let before = HEAP.current_usage();
    let x = job();
    (x, HEAP.current_usage().saturating_sub(before))
}

/// Starts the peak anew at what is resident now, where the system can.
pub(crate) fn forget_peak() {
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}

/// The most memory that this process (its children left out) has had resident, bytes; `None` where the system does
/// not say.
pub(crate) fn peak_resident() -> Option<usize> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    line.split_whitespace().nth(1)?.parse::<usize>().ok().map(|kib| kib * 1024)
}
