//! [`exponentials`]: how many this thread has evaluated.

use std::cell::Cell;

thread_local! {
    static EXPONENTIALS: Cell<u64> = const { Cell::new(0) };
}

/// Number of exponentials and logarithms that this thread has evaluated along rays and for tables, one for each wavelength: the work of
/// a solution, a table or a ray is a difference of two such numbers, on a single thread. Only builds with debug assertions count; elsewhere
/// it is 0.
pub fn exponentials() -> u64 {
    EXPONENTIALS.get()
}

/// Adds what has been evaluated to the [`exponentials`].
#[inline(always)]
pub fn count_exponentials(more: usize) {
    // Counting takes a hundredth of the time of a solution.
    if cfg!(debug_assertions) {
        EXPONENTIALS.set(EXPONENTIALS.get() + more as u64);
    }
}
