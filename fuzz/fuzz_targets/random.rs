//! Pseudorandom choices.

/// Generator of choices (Marsaglia's xorshift, 2003).
pub struct Random(u32);

impl Random {
    /// Creates the generator of a seed.
    pub fn new(seed: u32) -> Self {
        Self(seed.max(1))
    }

    /// Returns a number below a bound, or 0.
    pub fn below(&mut self, bound: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        self.0 as usize % bound.max(1)
    }

    /// Returns one of the choices; `None` if there are none.
    pub fn one_of<T: Clone>(&mut self, choices: &[T]) -> Option<T> {
        choices.get(self.below(choices.len())).cloned()
    }
}
