//! The arithmetic of walkers, in single and double precision.

use std::ops::{Add, Div, Mul, Sub};

use super::lookup::{ENTRIES, LookUp};
use super::random::LANES;

/// Floating-point numbers of walkers. Sums and products are those of IEEE 754, each rounded separately, and
/// are the same on every machine.
pub(super) trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + PartialOrd
{
    const ZERO: Self;

    /// Smallest number from which, up to twice as much, the representable numbers are exactly the integers.
    const WHOLE: Self;

    fn of(value: f64) -> Self;

    /// Looks up an entry of a table for every walker, if numbers have 32 bits by `look_up`.
    fn look_up(
        table: &[Self; ENTRIES],
        places: &[u32; LANES],
        look_up: impl LookUp,
    ) -> [Self; LANES];

    /// Returns the lower bits of the mantissa: for a number from [`WHOLE`](Self::WHOLE) on, the difference to
    /// it.
    fn mantissa(self) -> u32;

    /// Returns the integer part of a number from 0 to 2²². Unlike a saturating cast, the computation has no
    /// special cases, and can be vectorised over walkers.
    #[inline(always)]
    fn floor(self) -> u32 {
        let rounded = self + Self::WHOLE;
        let is_up = rounded - Self::WHOLE > self;
        rounded.mantissa().wrapping_sub(u32::from(is_up))
    }
}

impl Real for f32 {
    const ZERO: Self = 0.0;
    const WHOLE: Self = 8_388_608.0;

    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "rounding is what is meant")]
    fn of(value: f64) -> Self {
        value as Self
    }

    #[inline(always)]
    fn look_up(
        table: &[Self; ENTRIES],
        places: &[u32; LANES],
        look_up: impl LookUp,
    ) -> [Self; LANES] {
        // Loops, which are compiled for the vectors of the caller, unlike `map`.
        let (mut bits, mut found) = ([0; ENTRIES], [0.0; LANES]);
        for (bits, value) in bits.iter_mut().zip(table) {
            *bits = value.to_bits();
        }
        let looked_up = look_up(&bits, places);
        for (found, bits) in found.iter_mut().zip(looked_up) {
            *found = Self::from_bits(bits);
        }
        found
    }

    #[inline(always)]
    fn mantissa(self) -> u32 {
        self.to_bits() & 0x007f_ffff
    }
}

impl Real for f64 {
    const ZERO: Self = 0.0;
    const WHOLE: Self = 4_503_599_627_370_496.0;

    #[inline(always)]
    fn of(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn look_up(table: &[Self; ENTRIES], places: &[u32; LANES], _: impl LookUp) -> [Self; LANES] {
        let mut found = [0.0; LANES];
        for lane in 0..LANES {
            found[lane] = table[places[lane] as usize % ENTRIES];
        }
        found
    }

    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "the lower bits are meant")]
    fn mantissa(self) -> u32 {
        self.to_bits() as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_parts_are_exact() {
        for whole in [0u32, 1, 2, 3, 4, 1023, 1024, 4095, 1 << 20, (1 << 22) - 1] {
            let value = f64::from(whole);
            for part in [0.0, 0.25, 0.5, 0.75] {
                assert_eq!((value + part).floor(), f64::from(whole));
                assert_eq!(Real::floor(value + part), whole);
                assert_eq!(Real::floor(f32::of(value + part)), whole);
            }
            assert_eq!(Real::floor((value + 1.0).next_down()), whole);
            assert_eq!(Real::floor(f32::of(value + 1.0).next_down()), whole);
        }
    }
}
