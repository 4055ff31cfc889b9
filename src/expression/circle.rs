//! Sine and cosine of angles in degrees, to arbitrary precision.

use dashu_float::round::mode::HalfEven;
use dashu_float::{ConstCache, Context, FBig};
use dashu_int::IBig;
use dashu_int::ops::SquareRoot;

type Float = FBig<HalfEven, 2>;

/// Guard bits for rounding errors.
const SPARE: usize = 64;

/// Largest magnitude of angles in degrees: the reduction of larger ones needs more bits.
const LARGEST: f64 = 1e9;
/// Smallest magnitude of nonzero distances from a multiple of 90 degrees: the relative precision of
/// smaller ones needs more bits.
const SMALLEST: f64 = 1e-9;

/// A calculator of sines and cosines, which computes both at once and caches the last pair.
///
/// An angle is halved until few terms of a series suffice, and the result is doubled equally often
/// (Brent 1976, "Fast multiple-precision evaluation of elementary functions").
#[derive(Default)]
pub(super) struct Circle {
    /// The cached value of π, in multiples of 2^-n, with n.
    half: Option<(usize, IBig)>,
    last: Option<(usize, Float, [Float; 2])>,
}

impl Circle {
    /// Computes sine and cosine of an angle in degrees with errors of some multiples of 2^-`bits`.
    /// `near` is the double next to the angle. Returns `None` for angles outside the limits of this
    /// module.
    pub(super) fn sine_cosine(
        &mut self,
        near: f64,
        degrees: &Float,
        bits: usize,
        cache: &mut ConstCache,
    ) -> Option<[Float; 2]> {
        let quarters = (near / 90.0).round();
        let rest = near - 90.0 * quarters;
        if near.is_nan() || near.abs() > LARGEST || rest != 0.0 && rest.abs() < SMALLEST {
            return None;
        }
        if let Some((known, angle, pair)) = &self.last
            && *known == bits
            && angle == degrees
        {
            return Some(pair.clone());
        }
        let halvings = bits.isqrt() / 2;
        let unit = bits + 2 * halvings + SPARE;
        let shift = |number: &Float, by: usize| number.clone() << isize::try_from(by).unwrap_or(0);
        #[expect(clippy::cast_possible_truncation, reason = "it is limited")]
        let quarters = quarters as i64;
        let rest = shift(degrees, unit).to_int().value() - (IBig::from(90 * quarters) << unit);
        let radians = (&rest * self.half_turn(unit, cache) / 180_u8) >> unit;
        let is_negative = radians < IBig::ZERO;
        let [sine, cosine] = of_small(if is_negative { -radians } else { radians }, unit, halvings);
        let sine = if is_negative { -sine } else { sine };
        let pair = match quarters.rem_euclid(4) {
            0 => [sine, cosine],
            1 => [cosine, -sine],
            2 => [-sine, -cosine],
            _ => [-cosine, sine],
        };
        let float = |number: IBig| {
            let exponent = isize::try_from(unit).unwrap_or(isize::MAX);
            Float::from_parts(number, -exponent)
                .with_precision(bits)
                .value()
        };
        let pair = pair.map(float);
        self.last = Some((bits, degrees.clone(), pair.clone()));
        Some(pair)
    }

    /// Returns π in multiples of 2^-`bits`.
    fn half_turn(&mut self, bits: usize, cache: &mut ConstCache) -> IBig {
        let known = self.half.take().filter(|(known, _)| *known >= bits);
        let (known, pi) = known.unwrap_or_else(|| {
            let context = Context::<HalfEven>::new(bits + SPARE);
            let pi: Float = context.pi(Some(cache)).value();
            let exponent = isize::try_from(bits).unwrap_or(isize::MAX);
            (bits, (pi << exponent).to_int().value())
        });
        let short = &pi >> (known - bits);
        self.half = Some((known, pi));
        short
    }
}

/// Computes sine and cosine of an angle from 0 to slightly more than 45 degrees; all values are in
/// multiples of 2^-`bits`.
fn of_small(radians: IBig, bits: usize, halvings: usize) -> [IBig; 2] {
    let angle = radians >> halvings;
    let square = (&angle * &angle) >> bits;
    // The series is that of 1 − cos x, which avoids the cancellation of the cosine near 1.
    let mut term = &square >> 1;
    let mut versine = term.clone();
    for number in 1_u32.. {
        term = ((&term * &square) >> bits) / ((2 * number + 1) * (2 * number + 2));
        if term == IBig::ZERO {
            break;
        }
        if number % 2 == 1 {
            versine -= &term;
        } else {
            versine += &term;
        }
    }
    for _ in 0..halvings {
        // 1 − cos 2x = 4(1 − cos x) − 2(1 − cos x)²
        versine = (&versine << 2) - ((&versine * &versine) >> (bits - 1));
    }
    let one = IBig::ONE << bits;
    let (_, square) = (&versine * ((&one << 1) - &versine)).into_parts();
    [square.sqrt().into(), one - versine]
}

#[cfg(test)]
mod tests {
    use dashu_float::round::mode::HalfEven;
    use dashu_float::{ConstCache, Context};
    use dashu_int::IBig;
    use dashu_int::ops::BitTest;

    use super::{Circle, Float};

    #[test]
    fn sines_and_cosines_are_those_of_another_hand() {
        let (mut circle, mut cache) = (Circle::default(), ConstCache::new());
        // Lower precisions after higher ones use the cached value.
        for bits in [3_700_usize, 700, 200, 1_500, 65] {
            for near in [
                0.0,
                1e-6,
                7.5,
                30.0,
                44.999,
                45.0,
                45.001,
                60.0,
                90.0,
                137.5,
                180.0,
                225.0,
                300.123,
                359.999_999,
                1e6 + 0.1,
                -1e-8,
                -33.3,
                -100.0,
                -270.0,
            ] {
                let angle = Float::try_from(near).unwrap();
                let pair = circle.sine_cosine(near, &angle, bits, &mut cache);
                let context = Context::<HalfEven>::new(bits + 64);
                let sine = context.sin_unit(angle.repr(), 360, Some(&mut cache));
                let cosine = context.cos_unit(angle.repr(), 360, Some(&mut cache));
                for (found, known) in pair.unwrap().into_iter().zip([sine, cosine]) {
                    let units = |it: Float| -> IBig { (it << bits as isize).to_int().value() };
                    let apart = units(found) - units(known.unwrap().value());
                    assert!(apart.bit_len() <= 3, "{near} to {bits} bits: {apart}");
                }
            }
        }
    }

    #[test]
    fn what_needs_more_bits_is_left_to_others() {
        let (mut circle, mut cache) = (Circle::default(), ConstCache::new());
        for near in [1e-12, 90.0 + 1e-11, 1e12, f64::NAN, f64::INFINITY] {
            let angle = Float::try_from(near).unwrap_or(Float::ZERO);
            let pair = circle.sine_cosine(near, &angle, 300, &mut cache);
            assert!(pair.is_none(), "{near}");
        }
    }
}
