//! The `kfrac` program: see [`kfrac::cli`].

use std::process::ExitCode;

fn main() -> ExitCode {
    kfrac::cli::run()
}
