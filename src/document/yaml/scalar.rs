//! Resolution of plain scalars, and the inverse for numbers.

use crate::document::node::Value;

/// Resolves a plain scalar by the core schema of YAML 1.2, but with `true`, `false` and `null` in lower
/// case only and with finite numbers only.
pub(super) fn resolve(plain: &str) -> Value {
    match plain {
        "" | "~" | "null" => Value::Null,
        "true" => Value::Bool(true),
        "false" => Value::Bool(false),
        _ => match parse_number(plain) {
            Some(number) => Value::Number(number),
            None => Value::Text(plain.to_owned()),
        },
    }
}

fn parse_number(text: &str) -> Option<f64> {
    let radix = |digits, radix| u32::from_str_radix(digits, radix).ok().map(f64::from);
    match text.as_bytes() {
        [b'0', b'x', digit, ..] if digit.is_ascii_hexdigit() => radix(&text[2..], 16),
        [b'0', b'o', digit, ..] if digit.is_ascii_digit() => radix(&text[2..], 8),
        // Rust also parses "inf" and "nan", which are not numbers in YAML.
        bytes if bytes.iter().any(u8::is_ascii_digit) => {
            text.parse().ok().filter(|number: &f64| number.is_finite())
        }
        _ => None,
    }
}

/// Formats a number with the fewest digits that parse to the same value.
pub(in crate::document) fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || (1e-5..1e15).contains(&size) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::{Value, number, resolve};

    #[test]
    fn plain_scalars_are_numbers_words_or_text() {
        for (text, value) in [
            ("0", 0.0),
            ("-0", 0.0),
            ("007", 7.0),
            ("+5", 5.0),
            (".5", 0.5),
            ("-.5e-3", -0.0005),
            ("1.", 1.0),
            ("1e3", 1000.0),
            ("0x1F", 31.0),
            ("0o17", 15.0),
        ] {
            assert_eq!(resolve(text), Value::Number(value), "{text}");
        }
        for text in [
            "1/3",
            "yes",
            "on",
            "No",
            "True",
            "NULL",
            ".inf",
            ".nan",
            "inf",
            "nan",
            "NaN",
            "1_000",
            "1e",
            "e1",
            ".",
            "-",
            "+",
            "--1",
            "1e999",
            "0x",
            "0xg",
            "0o9",
            "0x+1",
            "0xffffffffff",
            "infinity1",
        ] {
            assert_eq!(resolve(text), Value::Text(text.to_owned()));
        }
        assert_eq!(resolve("~"), Value::Null);
        assert_eq!(resolve("false"), Value::Bool(false));
    }

    #[test]
    fn numbers_are_written_as_they_are_read() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "-0"),
            (45.0, "45"),
            (0.1, "0.1"),
            (1e-7, "1e-7"),
            (1e21, "1e21"),
            (1.0 / 3.0, "0.3333333333333333"),
            (f64::MAX, "1.7976931348623157e308"),
            (f64::MIN_POSITIVE, "2.2250738585072014e-308"),
        ] {
            assert_eq!(number(value), text);
            assert_eq!(resolve(text), Value::Number(value));
        }
    }
}
