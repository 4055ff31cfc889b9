//! Numbers as a person writes them.

/// Largest denominator of an expression: of the triangular grid of ninths, heights are multiples of sqrt(3)/18.
const DENOMINATORS: i64 = 24;

/// Largest numerator.
const NUMERATORS: i64 = 48;

/// Roots, as written.
const ROOTS: [(&str, f64); 4] = [
    ("", 1.0),
    ("sqrt(3)", 1.732_050_807_568_877_2),
    ("sqrt(2)", std::f64::consts::SQRT_2),
    ("phi", 1.618_033_988_749_895),
];

/// Returns the simplest expression of a value: a fraction with a denominator up to 24, or one of √2, √3 or the golden
/// ratio; `None` if none is equal to it within 1e-9.
pub(super) fn expression(value: f64) -> Option<String> {
    for (name, root) in ROOTS {
        for below in 1..=DENOMINATORS {
            let above = value / root * below as f64;
            let whole = above.round();
            if (whole / below as f64 * root - value).abs() > 1e-9 || whole.abs() > NUMERATORS as f64
            {
                continue;
            }
            if whole == 0.0 {
                return Some("0".into());
            }
            let sign = if whole < 0.0 { "-" } else { "" };
            let above = whole.abs();
            let front = match (name, above == 1.0) {
                ("", _) => format!("{above}"),
                (name, true) => name.to_owned(),
                (name, false) => format!("{above}*{name}"),
            };
            return Some(match below {
                1 => format!("{sign}{front}"),
                _ => format!("{sign}{front}/{below}"),
            });
        }
    }
    None
}

/// Returns a number with as many decimals as distinguish a length.
pub(super) fn decimals(value: f64, length: f64) -> String {
    let digits = (-libm::log10(length.clamp(1e-9, 1.0)))
        .ceil()
        .clamp(1.0, 9.0);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "from 1 to 9"
    )]
    let text = format!("{value:.*}", digits as usize);
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0" } else { text }.to_owned()
}

/// Returns a value as written: nicely where that is exact, or in decimals.
pub(super) fn written(value: f64, is_snapped: bool, length: f64) -> String {
    let nice = is_snapped.then(|| expression(value)).flatten();
    nice.unwrap_or_else(|| decimals(value, if is_snapped { 1e-9 } else { length }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn expressions_are_equal_to_their_values() {
        for (value, text) in [
            (0.0, "0"),
            (1.0 / 3.0, "1/3"),
            (-0.75, "-3/4"),
            (3.0_f64.sqrt() / 6.0, "sqrt(3)/6"),
            (-(2.0_f64.sqrt()), "-sqrt(2)"),
            (5.0 * 3.0_f64.sqrt() / 12.0, "5*sqrt(3)/12"),
            (2.0, "2"),
        ] {
            assert_eq!(expression(value).as_deref(), Some(text));
        }
        assert_eq!(expression(0.333), None);
        assert_eq!(expression(0.123_456), None);
    }

    #[test]
    fn decimals_are_those_of_a_pixel() {
        assert_eq!(decimals(0.123_456, 0.004), "0.123");
        assert_eq!(decimals(0.5, 0.004), "0.5");
        assert_eq!(decimals(-0.000_1, 0.01), "0");
        assert_eq!(written(0.5, true, 0.1), "1/2");
        assert_eq!(written(0.52, false, 0.01), "0.52");
    }
}
