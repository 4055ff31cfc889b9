//! Headings of the turtle as exact fractions of a turn.

use std::collections::BTreeSet;

use crate::expression::{degrees, gcd};
use crate::geometry::DVec2;

use super::{Action, LSystem, Symbol};

/// The unit of headings, which are integers: equal parts of a turn, so that sums of turns are exact.
///
/// Where all angles of a system are known fractions of a turn, a turn has as many parts as their least common
/// denominator; otherwise 2⁶⁴. An angle of 25.7 degrees is 257/3600 of a turn, and the double next to 360/7
/// is 1/7 of one: the fraction has the least denominator up to 1000 for which the double is the nearest, or
/// else that of the angle's shortest decimal.
///
/// Guarantee: directions at multiples of 30 and 45 degrees have exact sines and cosines, and opposite
/// headings have opposite directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Compass {
    /// Parts of a turn; 0 stands for 2⁶⁴.
    parts: u64,
}

/// Limit of the number of parts, other than 2⁶⁴: 360 times as many are exact in a double.
const MAX_PARTS: u64 = 1 << 40;

/// Largest denominator that the search tries.
const MAX_DENOMINATOR: u32 = 1000;

impl Compass {
    /// Returns the compass for all angles that a system turns by.
    #[must_use]
    pub fn of(system: &LSystem) -> Self {
        let mut parts = Some(1);
        let written = angles(system).chain([Some(system.start)]);
        let different: BTreeSet<_> = written.map(|angle| angle.map(f64::to_bits)).collect();
        for angle in different {
            let denominator = angle.map(f64::from_bits).and_then(denominator);
            parts = parts
                .zip(denominator)
                .and_then(|(a, b)| (a / gcd(a, b)).checked_mul(b))
                .filter(|parts| *parts <= MAX_PARTS);
        }
        Self {
            parts: parts.unwrap_or(0),
        }
    }

    /// Returns the number of parts of a turn; 0 stands for 2⁶⁴.
    #[must_use]
    pub fn parts(self) -> u64 {
        self.parts
    }

    /// Converts an angle in degrees to parts, rounded to the nearest; one that is not finite becomes 0.
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "an angle below a turn has fewer parts than a turn, which fit; what is no number becomes 0"
    )]
    pub fn of_degrees(self, angle: f64) -> u64 {
        let turn = (angle % 360.0) / 360.0;
        if self.parts == 0 {
            // The parts of a negative angle wrap round.
            return (turn * 2f64.powi(64)) as i128 as u64;
        }
        let parts = (turn.abs() * self.parts as f64).round() as u64 % self.parts;
        if turn < 0.0 { self.back(parts) } else { parts }
    }

    /// Returns the sum of two headings.
    #[must_use]
    pub fn sum(self, a: u64, b: u64) -> u64 {
        match self.parts {
            0 => a.wrapping_add(b),
            parts => (a + b) % parts,
        }
    }

    /// Returns the opposite turn.
    #[must_use]
    pub fn back(self, turn: u64) -> u64 {
        match self.parts {
            0 => turn.wrapping_neg(),
            parts => (parts - turn) % parts,
        }
    }

    /// Converts a heading to degrees, from 0 up to but excluding 360.
    #[must_use]
    #[expect(
        clippy::cast_precision_loss,
        reason = "the parts fit, or are the finest that a double has"
    )]
    pub fn degrees(self, heading: u64) -> f64 {
        match self.parts {
            0 => heading as f64 / 2f64.powi(64) * 360.0,
            parts => (heading * 360) as f64 / parts as f64,
        }
    }

    /// Returns a heading as a fraction of a turn: numerator and denominator.
    pub(crate) fn fraction(self, heading: u64) -> [u128; 2] {
        let parts = if self.parts == 0 {
            1 << 64
        } else {
            self.parts.into()
        };
        [heading.into(), parts]
    }

    /// Returns the unit vector of a heading.
    #[must_use]
    pub fn direction(self, heading: u64) -> DVec2 {
        let angle = self.degrees(heading);
        DVec2::new(degrees::cos(angle), degrees::sin(angle))
    }
}

/// Iterates over all angles that the symbols of a system turn by; `None` for one that depends on arguments
/// unknown before rewriting.
fn angles(system: &LSystem) -> impl Iterator<Item = Option<f64>> {
    let turns = |symbol: &'_ Symbol| {
        let turns = symbol.meaning.iter().filter_map(|action| match action {
            Action::Turn(program) | Action::Rotate(program) => Some(program.clone()),
            _ => None,
        });
        turns.collect::<Vec<_>>()
    };
    let symbols = &system.symbols;
    let constant = symbols
        .iter()
        .filter(|symbol| symbol.arity == 0)
        .flat_map(turns)
        .map(|program| program.as_constant());
    let axiom = system.axiom.iter().flat_map(move |module| {
        let turns = turns(&symbols[module.symbol]);
        turns
            .into_iter()
            .map(|program| Some(program.eval(&module.arguments)))
    });
    let templates = system.productions.iter().flat_map(|p| &p.successor);
    let written = templates
        .filter(move |template| symbols[template.symbol].arity > 0)
        .flat_map(move |template| {
            let values = template.arguments.iter().map(|p| p.as_constant());
            let values: Option<Vec<f64>> = values.collect();
            let turns = turns(&symbols[template.symbol]).into_iter();
            turns.map(move |program| {
                let known = values.as_ref().map(|values| program.eval(values));
                known.or_else(|| program.as_constant())
            })
        });
    constant.chain(axiom).chain(written)
}

/// Returns the denominator of an angle in degrees as a fraction of a turn; `None` if it does not fit 64 bits.
fn denominator(angle: f64) -> Option<u64> {
    if let Some(q) = least_denominator(angle) {
        return Some(q.into());
    }
    let text = angle.abs().to_string();
    let (units, decimals) = text.split_once('.').unwrap_or((&text, ""));
    let scale = 10u64.checked_pow(u32::try_from(decimals.len()).ok()?)?;
    let numerator: u64 = format!("{units}{decimals}").parse().ok()?;
    let turn = scale.checked_mul(360)?;
    Some(turn / gcd(numerator, turn))
}

/// Returns whether an angle is the double next to a multiple of 1/q of a turn.
fn is_multiple(angle: f64, q: u32) -> bool {
    let q = f64::from(q);
    360.0 * (angle * q / 360.0).round() / q == angle
}

/// Returns the least denominator, up to the largest that is tried, of a fraction of a turn to which an angle is the nearest
/// double.
///
/// A fraction that is nearer than 1/(2q²) is a convergent of the angle's continued fraction (Legendre): the others need no
/// trial.
fn least_denominator(angle: f64) -> Option<u32> {
    /// Bound below which the rounding of an angle is less than that distance.
    const FAR: f64 = (1u64 << 40) as f64;
    /// Number of bits of a double's mantissa.
    const DIGITS: i32 = 53;
    let angle = angle.abs();
    if angle.is_nan() || angle >= FAR {
        return (1..=MAX_DENOMINATOR).find(|q| is_multiple(angle, *q));
    }
    let (mantissa, exponent) = libm::frexp(angle);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "it is a whole number of 53 bits"
    )]
    let mut above = u128::from(libm::ldexp(mantissa, DIGITS) as u64);
    let shift = (DIGITS - exponent).unsigned_abs();
    // Smaller angles are less than half of any fraction.
    let mut below = Some(360u128).filter(|_| shift <= u64::BITS)? << shift;
    let (mut before, mut q) = (1u128, 0u128);
    while below > 0 {
        let next = (above / below).saturating_mul(q).saturating_add(before);
        (before, q) = (q, next);
        let tried = u32::try_from(q).ok().filter(|q| *q <= MAX_DENOMINATOR)?;
        if is_multiple(angle, tried) {
            return Some(tried);
        }
        (above, below) = (below, above % below);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::{Compass, MAX_DENOMINATOR, MAX_PARTS, denominator, is_multiple, least_denominator};
    use crate::geometry::DVec2;

    #[test]
    fn angles_are_fractions_of_a_turn() {
        for (angle, parts) in [
            (0.0, 1),
            (60.0, 6),
            (-90.0, 4),
            (22.5, 16),
            (36.0, 10),
            (25.7, 3600),
            (360.0 / 7.0, 7),
            (180.0 / 7.0, 14),
            (720.0, 1),
            (85.123, 360_000),
        ] {
            assert_eq!(denominator(angle), Some(parts), "{angle}");
        }
        assert_eq!(denominator(f64::NAN), None);
        let odd = denominator(std::f64::consts::LN_2);
        assert!(odd.is_none_or(|parts| parts > MAX_PARTS));
    }

    #[test]
    fn convergents_have_the_least_denominators() {
        let fractions = (1..=MAX_DENOMINATOR).step_by(7).flat_map(|q| {
            let below = f64::from(q);
            [1.0, 2.0, 5.0, 77.0, 998.0].map(|p| 360.0 * p / below)
        });
        let decimals = (1..2_000u32).map(|number| f64::from(number * 37) / 1000.0);
        let others = [
            0.0,
            1e-300,
            5e-324,
            0.01,
            0.179,
            0.36,
            1e11,
            1e13,
            1e300,
            f64::NAN,
        ];
        for angle in fractions.chain(decimals).chain(others) {
            let least = (1..=MAX_DENOMINATOR).find(|q| is_multiple(angle, *q));
            assert_eq!(least_denominator(angle), least, "{angle}");
            assert_eq!(least_denominator(-angle), least, "{angle}");
        }
    }

    #[test]
    fn turns_add_up_exactly() {
        for parts in [7, 3600, 0] {
            let compass = Compass { parts };
            for angle in [51.4, -51.4, 25.7, 359.9, -1e-3, 1080.0] {
                let turn = compass.of_degrees(angle);
                assert_eq!(compass.sum(turn, compass.back(turn)), 0);
                assert_eq!(compass.of_degrees(-angle), compass.back(turn));
            }
        }
        let compass = Compass { parts: 6 };
        let there = compass.direction(compass.of_degrees(-60.0));
        assert_eq!(there, DVec2::new(0.5, -(3f64.sqrt()) / 2.0));
        assert_eq!(compass.degrees(5), 300.0);
    }

    /// An angle that is unknown before rewriting keeps the precision of a double.
    #[test]
    fn unknown_angles_are_fine() {
        let compass = Compass { parts: 0 };
        for angle in [1.0, 17.123_456_789, 0.000_1, 300.0] {
            let there = compass.degrees(compass.of_degrees(angle));
            assert!((there - angle).abs() < 1e-13, "{angle} {there}");
        }
        assert_eq!(compass.direction(1 << 62), DVec2::Y);
    }
}
