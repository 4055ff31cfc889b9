//! Fast hash for short keys from trusted input: it does not resist chosen collisions.

use std::collections::{HashMap, HashSet};
use std::hash::{BuildHasherDefault, Hasher};

use crate::random::GOLDEN;

/// Map with the fast hash; nothing iterates over it, because the order of its entries is arbitrary.
pub(crate) type FastMap<K, V> = HashMap<K, V, BuildHasherDefault<FastHasher>>;

/// Set with the fast hash; nothing iterates over it, because the order of its entries is arbitrary.
pub(crate) type FastSet<K> = HashSet<K, BuildHasherDefault<FastHasher>>;

/// Hasher that folds the two halves of a 128-bit product for each word.
#[derive(Default)]
pub(crate) struct FastHasher(u64);

impl Hasher for FastHasher {
    fn write(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            self.write_u64(u64::from_le_bytes(word));
        }
    }

    fn write_u8(&mut self, value: u8) {
        self.write_u64(value.into());
    }

    fn write_u32(&mut self, value: u32) {
        self.write_u64(value.into());
    }

    #[inline]
    fn write_u64(&mut self, word: u64) {
        // The rotation makes the order of words matter, and the constant makes words of 0 change the
        // state.
        let state = self.0.rotate_left(23) ^ 0x2545_F491_4F6C_DD1D;
        let mixed = u128::from(state ^ word) * u128::from(GOLDEN);
        #[expect(clippy::cast_possible_truncation, reason = "both halves are used")]
        {
            self.0 = (mixed >> 64) as u64 ^ mixed as u64;
        }
    }

    fn write_i64(&mut self, value: i64) {
        self.write_u64(value.cast_unsigned());
    }

    fn write_usize(&mut self, value: usize) {
        self.write_u64(value as u64);
    }

    fn finish(&self) -> u64 {
        self.0
    }
}
