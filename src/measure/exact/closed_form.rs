//! Closed forms: D = log λ / log 1/ρ where both are recognised.
//!
//! The growth λ is the spectral radius of a matrix of integers, and therefore an algebraic integer.
//! Recognised are integers and quadratic integers (t + √(t² − 4n))/2, and their roots. The ratio is searched
//! among roots, quadratic numbers and cosines of rational parts of the circle. There are few candidates, and
//! agreement is required to many digits: a coincidence occurs in about one of some million systems.

use std::fmt::Write;

/// Relative difference up to which growths and ratios count as equal.
const SAME: f64 = 2e-13;

/// Relative difference up to which dimensions count as equal: logarithms have more rounding errors, but
/// candidates are few.
const SAME_DIMENSION: f64 = 1e-12;

/// Maximum power of λ and of 1/ρ that is tried.
const MAX_POWER: u32 = 4;

/// Returns log λ / log 1/ρ as an expression of rule files; `None` where none is found.
///
/// `depth` is log 1/ρ.
pub(super) fn closed_form(growth: f64, depth: f64) -> Option<String> {
    let value = libm::log(growth) / depth;
    if growth == 1.0 {
        return Some("0".into());
    }
    if let Some(plain) = plain(value) {
        return Some(plain);
    }
    let base = libm::exp(depth);
    let integer = |value| whole(value, SAME).map(|number| number.to_string());
    let rational = |value| fraction(value, 1_000, SAME).map(Fraction::text);
    // The logarithm of √3 is better written as half of log 3.
    let surd = |value| quadratic(value, 1);
    let (a, mut over) = recognised(growth, integer).or_else(|| recognised(growth, surd))?;
    let (b, under) = recognised(base, rational).or_else(|| recognised(base, number))?;
    // D = log(over)/a · b/log(under).
    let mut factor = Fraction::new(i64::from(b), i64::from(a));
    if let (Ok(number), 1) = (over.parse::<i64>(), factor.under) {
        // 2 log 3/log 7 is log 9/log 7, which is used while it is short.
        if let Some(power) = number.checked_pow(b / a).filter(|power| *power < 10_000) {
            over = power.to_string();
            factor.over = 1;
        }
    }
    let (over, under) = without_powers(over, under);
    let quotient = format!("log({over})/log({under})");
    Some(if factor.over == 1 && factor.under == 1 {
        quotient
    } else if factor.under == 1 {
        format!("{}*{quotient}", factor.over)
    } else if factor.over == 1 {
        format!("log({over})/({}*log({under}))", factor.under)
    } else {
        format!(
            "{}*log({over})/({}*log({under}))",
            factor.over, factor.under
        )
    })
}

/// Returns a closed form from the value alone: an integer, or a fraction with a denominator of at most 4.
pub(super) fn plain(value: f64) -> Option<String> {
    fraction(value, 4, SAME_DIMENSION).map(Fraction::text)
}

/// Removes a power that two integers have in common: log 16/log 9 is log 4/log 3.
fn without_powers(over: String, under: String) -> (String, String) {
    let (Some(a), Some(b)) = (over.parse().ok(), under.parse().ok()) else {
        return (over, under);
    };
    let root = |value: i64, power: u32| {
        (2..1_000).find(|root: &i64| root.checked_pow(power) == Some(value))
    };
    let common = (2..=12)
        .rev()
        .find_map(|power| Some((root(a, power)?, root(b, power)?)));
    common.map_or((over, under), |(a, b)| (a.to_string(), b.to_string()))
}

/// Rounds a value that is an integer, or a fraction with a denominator of at most 4, up to rounding errors.
#[expect(clippy::cast_precision_loss, reason = "small whole numbers")]
pub(super) fn settled(value: f64) -> f64 {
    fraction(value, 4, SAME_DIMENSION).map_or(value, |found| found.over as f64 / found.under as f64)
}

/// Returns the smallest power of a number that is recognised, and its form.
fn recognised(value: f64, form: impl Fn(f64) -> Option<String>) -> Option<(u32, String)> {
    let mut power = 1.0;
    (1..=MAX_POWER).find_map(|exponent| {
        power *= value;
        Some((exponent, form(power)?))
    })
}

/// Recognises a number of the kinds that ratios are made of.
fn number(value: f64) -> Option<String> {
    quadratic(value, 12).or_else(|| cosine(value))
}

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME * a.abs().max(b.abs())
}

fn whole(value: f64, tolerance: f64) -> Option<i64> {
    // Among larger numbers, too many are close to an integer.
    const MOST: f64 = 1e5;
    let rounded = value.round();
    #[expect(clippy::cast_possible_truncation, reason = "a small whole number")]
    (rounded.abs() < MOST && (value - rounded).abs() <= tolerance * value.abs())
        .then_some(rounded as i64)
}

/// Recognises a quadratic number (t ± √s)/2d with integers t, s and d, where d is at most `most`; for `most`
/// = 1, algebraic integers only.
fn quadratic(value: f64, most: i64) -> Option<String> {
    const MAX_TRACE: i64 = 60;
    for under in 1..=most {
        #[expect(clippy::cast_precision_loss, reason = "small whole numbers")]
        let scaled = value * under as f64;
        for trace in 0..=MAX_TRACE {
            for trace in [trace, -trace] {
                // scaled = (trace + √square)/2.
                #[expect(clippy::cast_precision_loss, reason = "small whole numbers")]
                let root = 2.0 * scaled - trace as f64;
                let square = (root * root).round();
                // The difference has lost digits; the value itself is compared in the end.
                if (root * root - square).abs() > 1e-9 || !(1.0..4e3).contains(&square) {
                    continue;
                }
                #[expect(clippy::cast_possible_truncation, reason = "a whole number below 4000")]
                let square = square as i64;
                #[expect(clippy::cast_precision_loss, reason = "small whole numbers")]
                let found = (trace as f64 + (square as f64).sqrt()) / (2 * under) as f64;
                // The product of the conjugates of an algebraic integer is an integer.
                let integral = most > 1 || (trace * trace - square) % 4 == 0;
                if root > 0.0 && integral && same(found, value) {
                    return Some(surd(trace, square, 2 * under));
                }
            }
        }
    }
    None
}

/// Formats (a + √s)/d in lowest terms.
fn surd(trace: i64, square: i64, under: i64) -> String {
    let (mut outside, mut inside) = (1, square);
    for factor in (2..=64).rev() {
        while inside % (factor * factor) == 0 {
            (outside, inside) = (outside * factor, inside / (factor * factor));
        }
    }
    let common = divisor(divisor(trace.abs(), outside), under);
    let (trace, outside, under) = (trace / common, outside / common, under / common);
    let mut text = String::new();
    if outside != 1 {
        let _ = write!(text, "{outside}*");
    }
    let _ = write!(text, "sqrt({inside})");
    if trace != 0 {
        text = format!("{trace} + {text}");
    }
    match (under, trace) {
        (1, _) => text,
        (_, 0) => format!("{text}/{under}"),
        _ => format!("({text})/{under}"),
    }
}

/// Recognises 2 cos a or 2 (1 + cos a), where a is an integer number of degrees, or 180° times a fraction.
fn cosine(value: f64) -> Option<String> {
    const MAX_PARTS: i32 = 60;
    let of = |angle: f64, name: &dyn Fn() -> String| {
        let cosine = 2.0 * crate::expression::degrees::cos(angle);
        if same(value, cosine) {
            Some(format!("2*cos({})", name()))
        } else if same(value, 2.0 + cosine) {
            Some(format!("2*(1 + cos({}))", name()))
        } else {
            None
        }
    };
    (1..90)
        .find_map(|angle| of(f64::from(angle), &|| angle.to_string()))
        .or_else(|| {
            let parts = (3..=MAX_PARTS).flat_map(|under| (1..under).map(move |over| (over, under)));
            let mut parts = parts.filter(|(over, under)| 2 * over < *under);
            parts.find_map(|(over, under)| {
                let angle = f64::from(180 * over) / f64::from(under);
                of(angle, &|| format!("{}/{under}", 180 * over))
            })
        })
}

/// A fraction in lowest terms.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Fraction {
    over: i64,
    under: i64,
}

impl Fraction {
    fn new(over: i64, under: i64) -> Self {
        let common = divisor(over.abs(), under).max(1);
        Self {
            over: over / common,
            under: under / common,
        }
    }

    fn text(self) -> String {
        match self.under {
            1 => self.over.to_string(),
            under => format!("{}/{under}", self.over),
        }
    }
}

/// Returns the fraction with the smallest denominator, up to a maximum, that equals a number within a
/// relative tolerance.
fn fraction(value: f64, most: i64, tolerance: f64) -> Option<Fraction> {
    (1..=most).find_map(|under| {
        #[expect(clippy::cast_precision_loss, reason = "a small whole number")]
        let over = whole(value * under as f64, tolerance)?;
        Some(Fraction { over, under })
    })
}

fn divisor(a: i64, b: i64) -> i64 {
    if b == 0 { a } else { divisor(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::closed_form;

    fn of(growth: f64, base: f64) -> String {
        closed_form(growth, base.ln()).unwrap_or_default()
    }

    #[test]
    fn what_papers_print() {
        assert_eq!(of(4.0, 3.0), "log(4)/log(3)");
        assert_eq!(of(3.0, 3f64.sqrt()), "2");
        assert_eq!(of(8.0, 4.0), "3/2");
        let monkeys = f64::midpoint(1.0, 21f64.sqrt());
        assert_eq!(of(monkeys, 3f64.sqrt()), "2*log((1 + sqrt(21))/2)/log(3)");
        assert_eq!(of(4.0 + 7f64.sqrt(), 3.0), "log(4 + sqrt(7))/log(3)");
        assert_eq!(
            of(5.0, f64::midpoint(3.0, 5f64.sqrt())),
            "log(5)/log((3 + sqrt(5))/2)"
        );
        assert_eq!(of(2.0, 20.0 / 11.0), "log(2)/log(20/11)");
        let cesaro = 2.0 * (1.0 + 85f64.to_radians().cos());
        assert_eq!(of(4.0, cesaro), "log(4)/log(2*(1 + cos(85)))");
        assert_eq!(of(3f64.sqrt(), 2.0), "log(3)/(2*log(2))");
        assert_eq!(of(3.0, 7f64.sqrt()), "log(9)/log(7)");
        let sweep = 2.0 * (4.0 * std::f64::consts::TAU / 34.0).cos();
        assert_eq!(of(2.0, sweep), "log(2)/log(2*cos(720/17))");
    }

    #[test]
    fn what_is_not_recognised() {
        // λ³ = λ² + 2, and a transcendental number.
        assert_eq!(of(1.695_620_769_559_862, 2f64.sqrt()), "");
        assert_eq!(of(2.0, std::f64::consts::PI), "");
    }
}
