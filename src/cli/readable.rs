//! Numbers, sizes and times formatted for messages.

pub(super) use crate::readable::{counted, grouped};

/// Formats a number to twelve decimals, without trailing zeros; in scientific notation if `unit`, the
/// order of magnitude of the context, is not within 1e-3 to 1e3, or if the number reaches 1e15.
pub(super) fn decimal(value: f64, unit: f64) -> String {
    if is_plain(value, unit) {
        return trimmed(&format!("{value:.12}")).into();
    }
    scientific(value, unit, 12)
}

/// Formats a number to six decimals; in scientific notation under the conditions of [`decimal`].
pub(super) fn measure(value: f64, unit: f64) -> String {
    if is_plain(value, unit) {
        return format!("{value:.6}");
    }
    scientific(value, unit, 6)
}

/// Returns whether decimal notation shows only digits that a double has.
fn is_plain(value: f64, unit: f64) -> bool {
    const LONG: f64 = 1e15;
    (1e-3..1e3).contains(&unit) && value.abs() < LONG
}

fn scientific(value: f64, unit: f64, digits: usize) -> String {
    const NOTHING: f64 = 1e-12;
    if value.abs() < NOTHING * unit {
        return "0".into();
    }
    let text = format!("{value:.digits$e}");
    match text.split_once('e') {
        Some((mantissa, "0")) => trimmed(mantissa).into(),
        Some((mantissa, exponent)) => format!("{}e{exponent}", trimmed(mantissa)),
        None => text,
    }
}

/// Returns a decimal without trailing zeros.
fn trimmed(text: &str) -> &str {
    match text.trim_end_matches('0').trim_end_matches('.') {
        "-0" => "0",
        text => text,
    }
}

/// Formats a number of bytes with a decimal prefix (powers of 1000), to two or three digits.
#[expect(clippy::cast_precision_loss, reason = "three digits are shown")]
pub(super) fn bytes(count: u64) -> String {
    let (value, unit) = in_bytes(count as f64);
    if unit == "B" || value >= 99.95 {
        format!("{value:.0} {unit}")
    } else {
        format!("{value:.1} {unit}")
    }
}

/// Formats an estimated number of bytes to two digits.
pub(crate) fn rough_bytes(count: f64) -> String {
    let (value, unit) = in_bytes(two_digits(count));
    if value >= 1e6 {
        format!("{value:.0e} {unit}")
    } else if unit == "B" || value >= 9.95 {
        format!("{} {unit}", thousands(value))
    } else {
        format!("{value:.1} {unit}")
    }
}

/// Returns the value in the unit that leaves at most three digits before the point, as far as there are
/// prefixes.
fn in_bytes(mut value: f64) -> (f64, &'static str) {
    let mut unit = "B";
    for larger in ["kB", "MB", "GB", "TB", "PB", "EB", "ZB", "YB"] {
        // A value that rounds to 1000 belongs to the next unit.
        if value < 999.5 {
            break;
        }
        value /= 1000.0;
        unit = larger;
    }
    (value, unit)
}

/// Rounds a number to two significant digits.
pub(super) fn two_digits(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}

/// Formats a time in the largest suitable unit, to at most two significant digits.
pub(crate) fn duration(seconds: f64) -> String {
    const UNITS: [(f64, &str); 5] = [
        (365.25 * 24.0 * 3600.0, "years"),
        (24.0 * 3600.0, "days"),
        (3600.0, "h"),
        (60.0, "min"),
        (1.0, "s"),
    ];
    let Some((length, unit)) = UNITS
        .into_iter()
        .find(|(length, _)| seconds >= 1.5 * length)
    else {
        return if seconds < 0.5 {
            "less than 1 s"
        } else {
            "1 s"
        }
        .into();
    };
    let value = two_digits(seconds / length);
    let number = if value >= 1e6 {
        format!("{value:.0e}")
    } else {
        thousands(value)
    };
    format!("{number} {unit}")
}

/// Formats a number below 2^64, rounded to an integer, with commas between thousands.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "casts from floats saturate, and larger numbers are written in another way"
)]
fn thousands(value: f64) -> String {
    grouped(&(value.round() as u64).into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_numbers_have_exponents() {
        for (value, unit, expected) in [
            (0.5, 1.0, "0.5"),
            (-1e-15, 1.0, "0"),
            (4.213_991_769_547_3, 1.0, "4.213991769547"),
            (1.2e300, 1.0, "1.2e300"),
            (-4.25e14, 1.0, "-425000000000000"),
            (f64::INFINITY, 1.0, "inf"),
            (1.25e-299, 1e-300, "1.25e-299"),
            (1e-320, 1e-300, "0"),
            (1.0, 1e-300, "1"),
        ] {
            assert_eq!(decimal(value, unit), expected);
        }
    }

    #[test]
    fn bytes_have_units() {
        let cases = [
            (0, "0 B"),
            (999, "999 B"),
            (1000, "1.0 kB"),
            (12_345, "12.3 kB"),
            (99_960, "100 kB"),
            (999_600, "1.0 MB"),
            (2_500_000_000, "2.5 GB"),
            (u64::MAX, "18.4 EB"),
        ];
        for (count, expected) in cases {
            assert_eq!(bytes(count), expected);
        }
    }

    #[test]
    fn rough_bytes_have_two_digits_and_units_for_any_size() {
        let cases = [
            (0.4, "0 B"),
            (996.0, "1.0 kB"),
            (12_345.0, "12 kB"),
            (123_456.0, "120 kB"),
            (9.96e6, "10 MB"),
            (7e12, "7.0 TB"),
            (3e17, "300 PB"),
            (3.14e21, "3.1 ZB"),
            (1.24e25, "12 YB"),
            (1.24e28, "12,000 YB"),
            (1.24e36, "1e12 YB"),
            (1e300, "1e276 YB"),
        ];
        for (count, expected) in cases {
            assert_eq!(rough_bytes(count), expected);
        }
    }

    #[test]
    fn durations_are_rough() {
        let cases = [
            (0.0, "less than 1 s"),
            (1.2, "1 s"),
            (2.6, "3 s"),
            (47.0, "47 s"),
            (89.0, "89 s"),
            (90.0, "2 min"),
            (250.0, "4 min"),
            (6_000.0, "2 h"),
            (1e5, "28 h"),
            (1e6, "12 days"),
            (4e7, "460 days"),
            (5e7, "2 years"),
            (1e12, "32,000 years"),
            (1e16, "3e8 years"),
        ];
        for (seconds, expected) in cases {
            assert_eq!(duration(seconds), expected);
        }
    }
}
