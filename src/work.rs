//! Work of a thread, counted where it may be much.
//!
//! A unit of work takes about 20 ns. The count is the same on every machine; it does not limit anything by itself.

use std::cell::Cell;

thread_local! {
    static COUNTED: Cell<u64> = const { Cell::new(0) };
}

/// Adds to the work of this thread.
pub(crate) fn count(work: usize) {
    COUNTED.set(COUNTED.get().wrapping_add(work as u64));
}

/// Returns the work of this thread since some earlier count of it.
pub(crate) fn since(earlier: u64) -> u64 {
    counted().wrapping_sub(earlier)
}

/// Returns the work that was counted on this thread so far.
pub(crate) fn counted() -> u64 {
    COUNTED.get()
}
