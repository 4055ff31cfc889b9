//! What people read.

use std::io::{IsTerminal, Write};

use crate::diagnostic::Diagnostics;

/// Writes diagnostics to standard error, coloured on a terminal.
pub(super) fn complain(diagnostics: &Diagnostics) {
    let stderr = anstream::stderr();
    let color = std::io::stderr().is_terminal();
    // Nobody is left to be told that standard error is closed.
    let _ = writeln!(stderr.lock(), "{}", diagnostics.render(color).trim_end());
}

/// Writes a line to standard error.
pub(super) fn say(line: &str) {
    let _ = writeln!(anstream::stderr().lock(), "{line}");
}
