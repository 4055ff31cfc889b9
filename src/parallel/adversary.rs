//! Adversarial scheduling for tests: arbitrary orders in which threads might work, simulated on one thread and
//! reproducible. A test thereby finds errors of timing reliably.

use std::cell::Cell;

thread_local! {
    /// State of the generator.
    static ADVERSARY: Cell<Option<u64>> = const { Cell::new(None) };
}

/// Runs `body` with teams that execute jobs in an order determined by `seed`.
pub(crate) fn with_adversary<T>(seed: u64, body: impl FnOnce() -> T) -> T {
    let state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    let before = ADVERSARY.replace(Some(state));
    let result = body();
    ADVERSARY.set(before);
    result
}

/// Returns `true` if an adversary is active.
pub(super) fn is_here() -> bool {
    ADVERSARY.get().is_some()
}

/// Returns an index below `count`: 0 unless an adversary picks another one.
pub(crate) fn pick(count: usize) -> usize {
    match (next(), u64::try_from(count)) {
        (Some(number), Ok(count @ 1..)) => usize::try_from(number % count).unwrap_or(0),
        _ => 0,
    }
}

/// Returns `true` if a piece of work is to be submitted while still small.
pub(crate) fn is_cut_short() -> bool {
    next().is_some_and(|number| number % 16 == 0)
}

/// Returns the next number of the generator (xorshift; Marsaglia 2003), or `None` without an adversary.
fn next() -> Option<u64> {
    let mut state = ADVERSARY.get()?;
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    ADVERSARY.set(Some(state));
    Some(state >> 20)
}
