//! Any order in which threads might work, and anything that they might not know of each other yet, made
//! on one thread, so that a test finds what hangs on timing at once and every time.

use std::cell::Cell;

/// The state of its generator, and how many of 256 questions come before what others have done is
/// known.
#[derive(Clone, Copy)]
struct Adversary {
    state: u64,
    late: u64,
}

thread_local! {
    static ADVERSARY: Cell<Option<Adversary>> = const { Cell::new(None) };
}

/// Runs `body` as if teams that it makes were of threads that take work in an order that `seed` tells,
/// and learn `late` in 256 times too late what is covered.
pub(crate) fn with_adversary<T>(seed: u64, late: u64, body: impl FnOnce() -> T) -> T {
    let state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    let before = ADVERSARY.replace(Some(Adversary { state, late }));
    let result = body();
    ADVERSARY.set(before);
    result
}

/// Whether there is one.
pub(super) fn is_here() -> bool {
    ADVERSARY.get().is_some()
}

/// One of so many, by number: the first unless an adversary picks another one.
pub(crate) fn pick(count: usize) -> usize {
    match (next(), u64::try_from(count)) {
        (Some(number), Ok(count @ 1..)) => usize::try_from(number % count).unwrap_or(0),
        _ => 0,
    }
}

/// Whether a thread comes too early to know what others have done.
pub(crate) fn is_too_early() -> bool {
    let late = ADVERSARY.get().map_or(0, |adversary| adversary.late);
    late > 0 && next().is_some_and(|number| number % 256 < late)
}

/// Whether a piece of work is handed on however small it is.
pub(crate) fn is_cut_short() -> bool {
    next().is_some_and(|number| number % 16 == 0)
}

/// The next of a row of numbers (xorshift; Marsaglia 2003).
fn next() -> Option<u64> {
    let mut adversary = ADVERSARY.get()?;
    adversary.state ^= adversary.state << 13;
    adversary.state ^= adversary.state >> 7;
    adversary.state ^= adversary.state << 17;
    ADVERSARY.set(Some(adversary));
    Some(adversary.state >> 20)
}
