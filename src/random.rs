//! Random numbers that are the same on every machine and in every version: all draws and samples are made of them.

/// 2⁶⁴ divided by the golden ratio, odd: the increment of SplitMix64.
pub(crate) const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// Applies the finaliser of SplitMix64 (Steele, Lea & Flood 2014).
pub(crate) fn mix(z: u64) -> u64 {
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The generator PCG XSL RR 128/64 (MCG) (O'Neill, "PCG: A family of simple fast space-efficient statistically
/// good algorithms for random number generation", Harvey Mudd College, 2014).
#[derive(Clone, Debug)]
pub(crate) struct Pcg(u128);

impl Pcg {
    /// Creates a generator from the upper and the lower half of its state; the lowest bit does not count.
    pub(crate) fn new(high: u64, low: u64) -> Self {
        Self(u128::from(high) << 64 | u128::from(low) | 1)
    }

    /// Draws 64 random bits.
    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "the halves are meant")]
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self
            .0
            .wrapping_mul(0x2360_ed05_1fc6_5da4_4385_df64_9fcc_f645);
        ((self.0 >> 64) as u64 ^ self.0 as u64).rotate_right((self.0 >> 122) as u32)
    }

    /// Draws a number from [0, 1) with 53 random bits.
    #[inline]
    #[expect(clippy::cast_precision_loss, reason = "53 bits fit a double exactly")]
    pub(crate) fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::Pcg;

    /// The state 42 as in the author's reference code.
    #[test]
    fn the_generator_is_pcg() {
        let mut random = Pcg::new(0, 42);
        let drawn = [(); 4].map(|()| random.bits());
        let expected = [
            0x63b4_a3a8_13ce_700a,
            0x3829_5420_0617_ab24,
            0xa7fd_85ae_3fe9_50ce,
            0xd715_286a_a288_7737,
        ];
        assert_eq!(drawn, expected);
    }
}
