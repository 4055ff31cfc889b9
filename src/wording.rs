//! Numbers as people read them.

use crate::graph::Count;

/// A whole number with commas between thousands; a very long one by its first digits and its size.
pub(crate) fn grouped(number: &Count) -> String {
    const LONG: usize = 60;
    let digits = number.to_string();
    if digits.len() > LONG {
        return format!("{}.{}e{}", &digits[..1], &digits[1..4], digits.len() - 1);
    }
    let mut text = String::with_capacity(digits.len() * 4 / 3);
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// A number of bytes in powers of a thousand.
pub(crate) fn bytes(count: u64) -> String {
    #[expect(clippy::cast_precision_loss, reason = "two digits are shown")]
    let mut value = count as f64;
    let mut unit = "B";
    for larger in ["kB", "MB", "GB", "TB"] {
        if value < 1000.0 {
            break;
        }
        value /= 1000.0;
        unit = larger;
    }
    if unit == "B" || value >= 100.0 {
        format!("{value:.0} {unit}")
    } else {
        format!("{value:.1} {unit}")
    }
}

/// "1 element", "2 elements".
pub(crate) fn counted(number: &Count, noun: &str) -> String {
    let s = if *number == Count::from(1u64) {
        ""
    } else {
        "s"
    };
    format!("{} {noun}{s}", grouped(number))
}
