//! The limit under which every target runs: what reading an input takes is bounded by its length.

use nabiki_exchange::Budget;
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Memory for a byte of a budget, which counts half of what is made and nothing of what is dropped at once; as in the tests of
/// hostile files.
const TIMES_BUDGET: usize = 3;

/// Reads an input of `length` bytes.
///
/// # Panics
/// If that took more memory than its length allows.
pub fn within_budget(length: usize, read: impl FnOnce()) {
    let before = MEMORY.current_usage();
    MEMORY.reset_peak_usage();
    read();
    let used = MEMORY.peak_usage().saturating_sub(before);
    let most = TIMES_BUDGET * Budget::of(length as u64).most() as usize;
    assert!(used <= most, "{length} bytes took {used} bytes of memory, more than {most}");
}
