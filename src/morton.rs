//! Keys that interleave the bits of coordinates (Morton 1966): keys of larger boxes are prefixes.

/// Interleaves the bits of the first two or three coordinates, of 32 or 21 bits.
#[inline]
pub(crate) fn interleaved(dimension: usize, [x, y, z]: [u32; 3]) -> u64 {
    if dimension < 3 {
        spread(x) | spread(y) << 1
    } else {
        spread3(x) | spread3(y) << 1 | spread3(z) << 2
    }
}

/// Returns the two or three coordinates of a key, completed by zeros.
#[inline]
pub(crate) fn separated(dimension: usize, key: u64) -> [u32; 3] {
    if dimension < 3 {
        [gathered(key), gathered(key >> 1), 0]
    } else {
        [0, 1, 2].map(|axis| gathered3(key >> axis))
    }
}

/// Spreads the bits of a number to the even positions.
#[inline]
fn spread(number: u32) -> u64 {
    let mut bits = u64::from(number);
    bits = (bits | bits << 16) & 0x0000_ffff_0000_ffff;
    bits = (bits | bits << 8) & 0x00ff_00ff_00ff_00ff;
    bits = (bits | bits << 4) & 0x0f0f_0f0f_0f0f_0f0f;
    bits = (bits | bits << 2) & 0x3333_3333_3333_3333;
    (bits | bits << 1) & 0x5555_5555_5555_5555
}

/// Gathers the bits at even positions of a key.
#[inline]
#[expect(clippy::cast_possible_truncation, reason = "32 bits are left")]
pub(crate) fn gathered(key: u64) -> u32 {
    let mut bits = key & 0x5555_5555_5555_5555;
    for (step, mask) in GATHERED.iter().enumerate() {
        bits = (bits | bits >> (1 << step)) & mask;
    }
    bits as u32
}

/// Masks of the bits after each step of gathering.
const GATHERED: [u64; 5] = [
    0x3333_3333_3333_3333,
    0x0f0f_0f0f_0f0f_0f0f,
    0x00ff_00ff_00ff_00ff,
    0x0000_ffff_0000_ffff,
    0x0000_0000_ffff_ffff,
];

/// Masks of the bits after each step of spreading 21 bits to every third position.
const SPREAD: [u64; 5] = [
    0x001f_0000_0000_ffff,
    0x001f_0000_ff00_00ff,
    0x100f_00f0_0f00_f00f,
    0x10c3_0c30_c30c_30c3,
    0x1249_2492_4924_9249,
];

/// Spreads the lowest 21 bits of a number to every third position.
#[inline]
fn spread3(number: u32) -> u64 {
    let mut bits = u64::from(number) & 0x001f_ffff;
    for (step, mask) in SPREAD.iter().enumerate() {
        bits = (bits | bits << (32 >> step)) & mask;
    }
    bits
}

/// Gathers the bits at every third position of a key.
#[inline]
#[expect(clippy::cast_possible_truncation, reason = "21 bits are left")]
fn gathered3(key: u64) -> u32 {
    let mut bits = key & SPREAD[4];
    for (step, mask) in [SPREAD[3], SPREAD[2], SPREAD[1], SPREAD[0], 0x001f_ffff]
        .iter()
        .enumerate()
    {
        bits = (bits | bits >> (2 << step)) & mask;
    }
    bits as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_come_back_from_their_key() {
        for at in [
            [0, 1, 2],
            [0x1f_ffff, 0, 0x15_5555],
            [0x0f_0f0f, 0x12_3456, 1],
        ] {
            assert_eq!(separated(3, interleaved(3, at)), at);
            assert_eq!(separated(2, interleaved(2, at)), [at[0], at[1], 0]);
        }
        assert_eq!(interleaved(3, [1, 0, 1]), 0b101);
        assert_eq!(interleaved(3, [0, 2, 0]), 0b010_000);
    }
}
