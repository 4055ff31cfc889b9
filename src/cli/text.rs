//! Messages to the user, on standard error.

use std::io::Write;

use crate::diagnostic::Diagnostics;

/// Writes diagnostics to standard error, with colours if the terminal and the environment (`NO_COLOR`,
/// `CLICOLOR_FORCE`, `TERM`) allow them: `anstream` strips unwanted colours.
pub(super) fn print_diagnostics(diagnostics: &Diagnostics) {
    // A failure of standard error cannot be reported.
    let _ = writeln!(
        anstream::stderr().lock(),
        "{}",
        diagnostics.render(true).trim_end()
    );
}

/// Writes a line to standard error. Control characters, which names may contain, are replaced.
pub(super) fn print_message(line: &str) {
    let line = line.replace(char::is_control, "\u{fffd}");
    let _ = writeln!(anstream::stderr().lock(), "{line}");
}
