//! Integers formatted for messages.

use crate::count::Count;

/// Formats an integer with commas between thousands; one of more than 60 digits in scientific notation,
/// with its first four digits.
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

/// Formats a number with a noun in the singular or plural: "1 element", "2 elements".
pub(crate) fn counted(number: &Count, noun: &str) -> String {
    let s = if *number == Count::from(1u64) {
        ""
    } else {
        "s"
    };
    format!("{} {noun}{s}", grouped(number))
}
