//! Unbounded counts in decimal, for forecasts.

use std::cmp::Ordering;
use std::fmt;
use std::iter::Sum;
use std::ops::AddAssign;

/// Natural number of any size.
///
/// Forecasts add numbers and print every one of them. The representation is decimal, so that printing
/// takes no longer than adding.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Count {
    /// Digits to the base [`BASE`], least significant first, without leading zeros.
    limbs: Vec<u64>,
}

const DIGITS: usize = 18;
const BASE: u64 = 1_000_000_000_000_000_000;

impl Count {
    /// Returns the number of decimal digits; 1 for 0.
    #[must_use]
    pub fn digits(&self) -> usize {
        match self.limbs.split_last() {
            Some((top, rest)) => rest.len() * DIGITS + top.ilog10() as usize + 1,
            None => 1,
        }
    }

    /// Returns the number as a double, to within a few units in the last place; infinity beyond the
    /// range.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "the value is rounded")]
    pub fn to_f64(&self) -> f64 {
        if self.limbs.len() * DIGITS > f64::MAX_10_EXP as usize + 2 * DIGITS {
            return f64::INFINITY;
        }
        let limbs = self.limbs.iter().rev();
        limbs.fold(0.0, |value, &limb| value * BASE as f64 + limb as f64)
    }

    /// Returns the number, or `None` if it exceeds 64 bits.
    #[must_use]
    pub fn to_u64(&self) -> Option<u64> {
        let limbs = self.limbs.iter().rev();
        limbs.copied().try_fold(0u64, |value, limb| {
            value.checked_mul(BASE)?.checked_add(limb)
        })
    }
}

impl From<u64> for Count {
    fn from(mut value: u64) -> Self {
        let mut limbs = Vec::new();
        while value > 0 {
            limbs.push(value % BASE);
            value /= BASE;
        }
        Self { limbs }
    }
}

impl From<usize> for Count {
    fn from(value: usize) -> Self {
        (value as u64).into()
    }
}

impl AddAssign<&Self> for Count {
    fn add_assign(&mut self, other: &Self) {
        if self.limbs.len() < other.limbs.len() {
            self.limbs.resize(other.limbs.len(), 0);
        }
        let mut carry = false;
        for (index, limb) in self.limbs.iter_mut().enumerate() {
            let added = match other.limbs.get(index) {
                Some(added) => *added,
                None if carry => 0,
                None => return,
            };
            let sum = *limb + added + u64::from(carry);
            carry = sum >= BASE;
            *limb = if carry { sum - BASE } else { sum };
        }
        if carry {
            self.limbs.push(1);
        }
    }
}

impl<'a> Sum<&'a Self> for Count {
    fn sum<I: Iterator<Item = &'a Self>>(counts: I) -> Self {
        counts.fold(Self::default(), |mut sum, count| {
            sum += count;
            sum
        })
    }
}

impl Ord for Count {
    fn cmp(&self, other: &Self) -> Ordering {
        let longer = self.limbs.len().cmp(&other.limbs.len());
        longer.then_with(|| self.limbs.iter().rev().cmp(other.limbs.iter().rev()))
    }
}

impl PartialOrd for Count {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Formats the number in decimal digits.
impl fmt::Display for Count {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut text = String::with_capacity(self.digits());
        let mut buffer = itoa::Buffer::new();
        let (top, rest) = self.limbs.split_last().unwrap_or((&0, &[]));
        text.push_str(buffer.format(*top));
        for limb in rest.iter().rev() {
            let digits = buffer.format(*limb);
            text.push_str(&"000000000000000000"[digits.len()..]);
            text.push_str(digits);
        }
        f.pad_integral(true, "", &text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_two_are_exact() {
        let mut power = Count::from(1u64);
        for exponent in 0..256u32 {
            let expected = 1u128.checked_shl(exponent);
            if let Some(expected) = expected.filter(|_| exponent < 128) {
                assert_eq!(power.to_string(), expected.to_string());
                assert_eq!(power.to_u64(), u64::try_from(expected).ok());
            }
            assert_eq!(power.digits(), power.to_string().len());
            let ratio = power.to_f64() / f64::from(exponent).exp2();
            assert!((ratio - 1.0).abs() < 1e-14, "2^{exponent}: {ratio}");
            let same = power.clone();
            power += &same;
            assert!(same < power);
        }
        assert_eq!(
            power.to_string(),
            "115792089237316195423570985008687907853269984665640564039457584007913129639936"
        );
    }

    #[test]
    fn carries_run_through_all_digits() {
        let mut nines = Count {
            limbs: vec![BASE - 1; 3],
        };
        nines += &Count::from(1u64);
        assert_eq!(nines.to_string(), format!("1{}", "0".repeat(54)));
        let mut one = Count::from(1u64);
        one += &nines;
        assert_eq!(one.to_string(), format!("1{}1", "0".repeat(53)));
        assert!(nines < one);
    }

    #[test]
    fn small_and_huge_numbers_are_converted() {
        let zero = Count::from(0u64);
        assert_eq!((zero.to_string().as_str(), zero.digits()), ("0", 1));
        assert_eq!(zero.to_u64(), Some(0));
        assert_eq!(Count::from(u64::MAX).to_u64(), Some(u64::MAX));
        let huge = Count { limbs: vec![1; 20] };
        assert_eq!((huge.to_u64(), huge.to_f64()), (None, f64::INFINITY));
    }
}
