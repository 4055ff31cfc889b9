//! The command line: one file a subcommand.

mod cat;
mod check;
mod grow;
mod info;
mod list;
mod output;
mod rule;
mod schema;
mod steps;
mod stop;
mod text;

use std::io;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::diagnostic::{Diagnostic, Diagnostics};

/// Grows, draws and measures linear fractals.
#[derive(Parser)]
#[command(name = "kfrac", version, max_term_width = 100)]
struct Arguments {
    /// A folder with rules and components, before the user's own and the embedded library
    #[arg(long, value_name = "DIR", global = true)]
    library: Vec<std::path::PathBuf>,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Grow(grow::Arguments),
    Info(info::Arguments),
    Cat(cat::Arguments),
    List(list::Arguments),
    Check(check::Arguments),
    Schema(schema::Arguments),
}

/// Why the program ends without having done its work.
#[derive(Debug)]
enum Failure {
    /// A file is wrong.
    File(Diagnostics),
    /// Something else is wrong with the input, or a limit was met.
    Input(anyhow::Error),
    /// The command line is wrong.
    Usage(String),
    /// What was to be said has been said.
    Said,
    /// The user stopped it.
    Interrupted,
}

impl From<Diagnostics> for Failure {
    fn from(diagnostics: Diagnostics) -> Self {
        Self::File(diagnostics)
    }
}

impl From<Diagnostic> for Failure {
    fn from(diagnostic: Diagnostic) -> Self {
        Self::File(diagnostic.into())
    }
}

impl From<anyhow::Error> for Failure {
    fn from(error: anyhow::Error) -> Self {
        Self::Input(error)
    }
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        Self::Input(error.into())
    }
}

/// Runs the program with the arguments of the process.
///
/// The exit status is 0 if its work is done (also if a reader closes the pipe), 1 if the input is
/// wrong, a limit was met or a file could not be written, 2 if the command line is wrong, 130 if it
/// was interrupted.
#[must_use]
pub fn run() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version go to standard output; a closed pipe is no failure.
            let printed = error.print();
            return match (error.exit_code(), printed) {
                (0, Err(error)) if error.kind() != io::ErrorKind::BrokenPipe => ExitCode::FAILURE,
                (0, _) => ExitCode::SUCCESS,
                _ => ExitCode::from(2),
            };
        }
    };
    let catalogue = match rule::catalogue(&arguments.library) {
        Ok(catalogue) => catalogue,
        Err(failure) => return report(&failure),
    };
    let result = match &arguments.command {
        Command::Grow(arguments) => grow::run(arguments, &catalogue),
        Command::Info(arguments) => info::run(arguments, &catalogue),
        Command::Cat(arguments) => cat::run(arguments, &catalogue),
        Command::List(arguments) => list::run(arguments, &catalogue),
        Command::Check(arguments) => check::run(arguments, &catalogue),
        Command::Schema(arguments) => schema::run(arguments),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => report(&failure),
    }
}

fn report(failure: &Failure) -> ExitCode {
    match failure {
        Failure::File(diagnostics) => {
            text::complain(diagnostics);
            ExitCode::FAILURE
        }
        Failure::Input(error) => {
            let closed = error
                .chain()
                .filter_map(|cause| cause.downcast_ref::<io::Error>())
                .any(|error| error.kind() == io::ErrorKind::BrokenPipe);
            if closed {
                return ExitCode::SUCCESS;
            }
            text::complain(&Diagnostic::error(format!("{error:#}")).into());
            ExitCode::FAILURE
        }
        Failure::Usage(message) => {
            text::complain(&Diagnostic::error(message.clone()).into());
            ExitCode::from(2)
        }
        Failure::Said => ExitCode::FAILURE,
        Failure::Interrupted => ExitCode::from(130),
    }
}
