//! Random words for walkers side by side.

use crate::random::{GOLDEN, Pcg, mix};

/// Number of walkers side by side.
pub(super) const LANES: usize = 32;

/// SplitMix64 with a state derived from a seed and the number of a stream.
struct Seeds(u64);

impl Seeds {
    fn new(seed: u64, stream: u64) -> Self {
        // The states of streams are scattered on the cycle of 2⁶⁴.
        let seed = mix(seed.wrapping_add(GOLDEN));
        Self(mix(seed ^ stream.wrapping_mul(GOLDEN)))
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(GOLDEN);
        mix(self.0)
    }
}

/// A generator for every walker, all advanced together: xoshiro128+ (Blackman & Vigna 2021), whose upper bits
/// have the best quality.
pub(super) struct Lanes([[u32; LANES]; 4]);

impl Lanes {
    pub(super) fn new(seed: u64, stream: u64) -> Self {
        let mut seeds = Seeds::new(seed, stream);
        let mut state = [[0; LANES]; 4];
        for lane in 0..LANES {
            let (low, high) = (seeds.next(), seeds.next());
            let words = [low, low >> 32, high, high >> 32];
            #[expect(clippy::cast_possible_truncation, reason = "the lower half is meant")]
            for (words_of_lanes, word) in state.iter_mut().zip(words) {
                words_of_lanes[lane] = word as u32;
            }
            // The zero state is a fixed point of the generator.
            state[0][lane] |= u32::from(low == 0 && high == 0);
        }
        Self(state)
    }

    /// Draws a word for every walker.
    #[inline(always)]
    pub(super) fn draw(&mut self, words: &mut [u32; LANES]) {
        let [s0, s1, s2, s3] = &mut self.0;
        for lane in 0..LANES {
            let (a, b, c, d) = (s0[lane], s1[lane], s2[lane], s3[lane]);
            words[lane] = a.wrapping_add(d);
            let (c, d) = (c ^ a, d ^ b);
            s0[lane] = a ^ d;
            s1[lane] = b ^ c;
            s2[lane] = c ^ (b << 9);
            s3[lane] = d.rotate_left(11);
        }
    }
}

/// A generator for occasional draws.
#[derive(Clone, Debug)]
pub struct Scalar(Pcg);

impl Scalar {
    pub(super) fn new(seed: u64, stream: u64) -> Self {
        // The complement gives a stream different from the one by which walkers choose their maps.
        let mut seeds = Seeds::new(!seed, stream);
        let (low, high) = (seeds.next(), seeds.next());
        Self(Pcg::new(high, low))
    }

    /// Returns a random word.
    #[expect(clippy::cast_possible_truncation, reason = "the lower half is meant")]
    pub(super) fn word(&mut self) -> u32 {
        self.0.bits() as u32
    }

    /// Returns a number in [0, 1) with 53 random bits.
    pub(super) fn unit(&mut self) -> f64 {
        self.0.unit()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every picture depends on these values, which must never change.
    #[test]
    fn words_are_pinned() {
        let mut lanes = Lanes::new(7, 3);
        let mut words = [0; LANES];
        let mut draws = || {
            lanes.draw(&mut words);
            [words[0], words[31]]
        };
        let expected = [
            [1_326_433_753, 2_206_031_863],
            [1_477_126_234, 3_919_213_837],
        ];
        assert_eq!([draws(), draws()], expected);
        let mut scalar = Scalar::new(7, 3);
        assert_eq!([scalar.word(), scalar.word()], [404_801_860, 1_193_763_026]);
    }

    /// Steps from the state 1, 2, 3, 4, as in the authors' reference code.
    #[test]
    fn the_generator_is_xoshiro() {
        let mut lanes = Lanes([[1; LANES], [2; LANES], [3; LANES], [4; LANES]]);
        let mut words = [0; LANES];
        let mut drawn = Vec::new();
        for _ in 0..4 {
            lanes.draw(&mut words);
            drawn.push(words[5]);
        }
        assert_eq!(drawn, [5, 12_295, 25_178_119, 27_286_542]);
    }

    #[test]
    fn streams_and_seeds_are_apart() {
        let mut seen = std::collections::BTreeSet::new();
        let mut words = [0; LANES];
        for seed in 0..10 {
            for stream in 0..10 {
                let mut lanes = Lanes::new(seed, stream);
                for _ in 0..2 {
                    lanes.draw(&mut words);
                    seen.extend(words.map(u64::from));
                }
            }
        }
        // Among 6,400 words of 32 bits, 0.005 pairs are equal by chance on average.
        assert_eq!(seen.len(), 6_400);
    }
}
