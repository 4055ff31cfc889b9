//! Adversarial scheduling for tests: arbitrary orders in which threads might work, and arbitrary delays in
//! what they know of each other, simulated on one thread and reproducible. A test thereby finds errors of
//! timing reliably.

use std::cell::Cell;

/// State of the generator, and the number of 256 queries for which the work of other threads is treated as
/// unknown.
#[derive(Clone, Copy)]
struct Adversary {
    state: u64,
    late: u64,
}

thread_local! {
    static ADVERSARY: Cell<Option<Adversary>> = const { Cell::new(None) };
}

/// Runs `body` with teams that execute jobs in an order determined by `seed`, and with `late` in 256 queries
/// answered as if the work of other threads were not yet known.
pub(crate) fn with_adversary<T>(seed: u64, late: u64, body: impl FnOnce() -> T) -> T {
    let state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    let before = ADVERSARY.replace(Some(Adversary { state, late }));
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

/// Returns `true` if the work of other threads is to be treated as unknown.
pub(crate) fn is_too_early() -> bool {
    let late = ADVERSARY.get().map_or(0, |adversary| adversary.late);
    late > 0 && next().is_some_and(|number| number % 256 < late)
}

/// Returns `true` if a piece of work is to be submitted while still small.
pub(crate) fn is_cut_short() -> bool {
    next().is_some_and(|number| number % 16 == 0)
}

/// Returns the next number of the generator (xorshift; Marsaglia 2003), or `None` without an adversary.
fn next() -> Option<u64> {
    let mut adversary = ADVERSARY.get()?;
    adversary.state ^= adversary.state << 13;
    adversary.state ^= adversary.state >> 7;
    adversary.state ^= adversary.state << 17;
    ADVERSARY.set(Some(adversary));
    Some(adversary.state >> 20)
}
