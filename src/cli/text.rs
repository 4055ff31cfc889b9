//! What people read.

use std::io::Write;

use num_bigint::BigUint;

use crate::diagnostic::Diagnostics;

/// Writes diagnostics to standard error, coloured where the terminal and the environment
/// (`NO_COLOR`, `CLICOLOR_FORCE`, `TERM`) want it: colours that are not wanted are taken out there.
pub(super) fn complain(diagnostics: &Diagnostics) {
    // Nobody is left to be told that standard error is closed.
    let _ = writeln!(
        anstream::stderr().lock(),
        "{}",
        diagnostics.render(true).trim_end()
    );
}

/// Writes a line to standard error; a name in it may hold anything, but is kept from the terminal's
/// controls.
pub(super) fn say(line: &str) {
    let line = line.replace(char::is_control, "\u{fffd}");
    let _ = writeln!(anstream::stderr().lock(), "{line}");
}

/// A whole number with commas between thousands; a very long one by its first digits and its size.
pub(super) fn grouped(number: &BigUint) -> String {
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
pub(super) fn bytes(count: u64) -> String {
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
pub(super) fn counted(number: &BigUint, noun: &str) -> String {
    let s = if *number == BigUint::from(1u8) {
        ""
    } else {
        "s"
    };
    format!("{} {noun}{s}", grouped(number))
}
