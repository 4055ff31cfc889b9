//! What people read.

use std::io::Write;

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
