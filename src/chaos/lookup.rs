//! Tables of few numbers, in which all walkers look up at once.

use super::random::LANES;

/// Number of entries of a table: a power of two.
pub(super) const ENTRIES: usize = 32;

/// Method by which every walker looks up an entry of a table; places are taken modulo the number of entries.
///
/// A method is a parameter of the inner loop, for the registers that it uses are those of the function that calls it.
pub(super) trait LookUp: Fn(&[u32; ENTRIES], &[u32; LANES]) -> [u32; LANES] + Copy {}

impl<F: Fn(&[u32; ENTRIES], &[u32; LANES]) -> [u32; LANES] + Copy> LookUp for F {}

/// Looks up entries one by one.
#[inline(always)]
pub(super) fn one_by_one(table: &[u32; ENTRIES], places: &[u32; LANES]) -> [u32; LANES] {
    let mut found = [0; LANES];
    for lane in 0..LANES {
        found[lane] = table[places[lane] as usize % ENTRIES];
    }
    found
}

/// Looks up entries by permutations of the registers of AVX-512, which hold a table of 32 entries in two.
#[cfg(all(feature = "simd", target_arch = "x86_64"))]
#[inline]
#[target_feature(enable = "avx512f")]
pub(super) fn by_permutation(table: &[u32; ENTRIES], places: &[u32; LANES]) -> [u32; LANES] {
    use std::arch::x86_64::{__m512i, _mm512_permutex2var_epi32};

    let [low, high]: [__m512i; 2] = bytemuck::cast(*table);
    let places: [__m512i; 2] = bytemuck::cast(*places);
    let look_up = |places| _mm512_permutex2var_epi32(low, places, high);
    bytemuck::cast([look_up(places[0]), look_up(places[1])])
}
