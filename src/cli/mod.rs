//! Command line: one module per subcommand, and helpers that they share.

pub(crate) mod animate;
mod camera;
mod cat;
mod chaos;
pub(crate) mod check;
mod compare;
mod completions;
pub(crate) mod component;
mod convert;
mod count;
mod dataset;
mod dim;
mod exchanged;
pub(crate) mod family;
mod fit;
mod format;
pub(crate) mod gallery;
mod goal;
pub(crate) mod grow;
mod growth;
pub(crate) mod held;
mod help;
mod import;
pub(crate) mod info;
mod input;
pub(crate) mod labels;
mod length;
mod light;
pub(crate) mod list;
mod man;
pub(crate) mod map;
mod morph;
pub(crate) mod new;
mod number;
mod output;
mod palette;
mod picture;
pub(crate) mod pixels;
mod progress;
pub(crate) mod readable;
mod redrawn;
mod rule;
mod schema;
mod shard;
mod sheet;
pub(crate) mod show;
mod skeleton;
mod space;
mod steps;
mod stop;
mod structure;
#[cfg(feature = "studio")]
mod studio;
mod system;
mod template;
mod text;
mod tween;
pub(crate) mod watch;

use crate::render::RenderError;
use std::ffi::OsString;
use std::io;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand, ValueHint};

use crate::diagnostic::{Diagnostic, Diagnostics};

/// Grows, draws and measures linear fractals
///
/// A production rule replaces the fertile elements of a shape by smaller copies of a generator, step by step
/// (J. A. Kaandorp, "Interactive generation of fractal objects", CWI report CS-R8706, 1987). Rules are YAML
/// files. `kfrac list` lists the built-in library of rules.
#[derive(Parser)]
#[command(name = "kfrac", version, max_term_width = 100, after_long_help = help::styled(MORE))]
struct Arguments {
    /// Folder of rules and components that is searched first
    ///
    /// May be given several times. The folders of KFRAC_LIBRARY, the user's data folder and the built-in
    /// library follow.
    #[arg(long, value_name = "DIR", global = true, display_order = 1000)]
    #[arg(value_hint = ValueHint::DirPath)]
    library: Vec<PathBuf>,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Grow(Box<grow::Arguments>),
    Sheet(Box<sheet::Arguments>),
    Animate(Box<animate::Arguments>),
    Map(map::Arguments),
    Show(show::Arguments),
    Info(info::Arguments),
    Count(count::Arguments),
    Dim(dim::Arguments),
    Morph(morph::Arguments),
    Skeleton(skeleton::Arguments),
    New(new::Arguments),
    Cat(cat::Arguments),
    List(list::Arguments),
    Check(check::Arguments),
    Convert(convert::Arguments),
    Import(import::Arguments),
    Compare(compare::Arguments),
    Fit(fit::Arguments),
    Dataset(dataset::Arguments),
    Completions(completions::Arguments),
    Man(man::Arguments),
    Schema(schema::Arguments),
    #[cfg(feature = "studio")]
    Studio(studio::Arguments),
}

/// Returns the definition of the command line, for manual pages and completions.
fn command() -> clap::Command {
    Arguments::command()
}

const MORE: &str = "\
Examples:
  kfrac grow pythagoras --steps 8
      Draws the Pythagoras tree after eight steps, into pythagoras.svg
  kfrac list dragon
      Lists the entries of the library with dragon in their name, title or tags
  kfrac info koch
      Describes the Koch curve and the number of elements at each step
  kfrac cat koch > mine.yaml
      Copies a rule as a starting point for a new one
  kfrac grow mine.yaml
      Draws the new rule

Exit status:
  0
      Success, also if the reader of a pipe closes it
  1
      The input is wrong, a limit was reached, or a file could not be written
  2
      The command line is wrong
  130
      Interrupted, as by Ctrl-C; unfinished files are removed

Environment:
  KFRAC_LIBRARY
      Folders with rules and components, separated as in PATH
  XDG_DATA_HOME
      The user's data folder [default: ~/.local/share]
  NO_COLOR, CLICOLOR_FORCE
      Disable colours in messages, or force them even where messages go to a pipe

Files:
  ~/.local/share/kfrac
      The user's own rules and components, in the folders rules, ifs, instancing, lsystems, \
initiators, generators and base_elements; rules may also lie in the folder itself. On Windows, \
the folder is %APPDATA%\\kfrac
";

/// Reason for which the program ends without a result.
#[derive(Debug)]
pub(crate) enum Failure {
    /// Errors in a file.
    File(Diagnostics),
    /// Another error in the input, or a limit that was reached.
    Input(anyhow::Error),
    /// Error in the command line.
    Usage(String),
    /// Failure that has been reported already.
    Reported,
}

impl Failure {
    /// Returns the failure of reading arguments, without the usage that follows its message.
    fn usage(error: &clap::Error) -> Self {
        let text = error.to_string();
        let first = text.lines().next().unwrap_or_default();
        Self::Usage(first.strip_prefix("error: ").unwrap_or(first).to_owned())
    }

    /// Returns whether the reason is a picture in which nothing is visible.
    pub(crate) fn draws_nothing(&self) -> bool {
        match self {
            Self::Input(error) => error
                .downcast_ref::<RenderError>()
                .is_some_and(RenderError::draws_nothing),
            _ => false,
        }
    }

    /// Returns the message.
    #[cfg(feature = "studio")]
    pub(crate) fn message(&self) -> String {
        match self {
            Self::File(diagnostics) => {
                let messages = diagnostics.iter().map(|it| it.message());
                messages.collect::<Vec<_>>().join("; ")
            }
            Self::Input(error) => format!("{error:#}"),
            Self::Usage(message) => message.clone(),
            Self::Reported => String::new(),
        }
    }
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

impl From<crate::Error> for Failure {
    fn from(error: crate::Error) -> Self {
        match error {
            crate::Error::Invalid(diagnostics) => Self::File(diagnostics),
            error => Self::Input(error.into()),
        }
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
/// Returns exit status 0 on success (also if a reader closes the pipe), 1 if the input is wrong, a limit was
/// reached or a file could not be written, 2 if the command line is wrong. If a signal interrupts the
/// program, the process ends here, with status 130.
#[must_use]
pub fn run() -> ExitCode {
    stop::listen();
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => return refused(&error),
    };
    let arguments = match &arguments.command {
        Command::Grow(grow) => {
            let given: Vec<_> = std::env::args_os().collect();
            match grow.again(&given) {
                None => arguments,
                Some(Err(failure)) => return report(&failure),
                Some(Ok(all)) => match Arguments::overridden(all) {
                    Ok(arguments) => arguments,
                    Err(error) => return refused(&error),
                },
            }
        }
        _ => arguments,
    };
    let catalogue = match rule::catalogue(&arguments.library) {
        Ok(catalogue) => catalogue,
        Err(failure) => return report(&failure),
    };
    let result = match &arguments.command {
        Command::Grow(arguments) => grow::run(arguments, &catalogue),
        Command::Show(arguments) => show::run(arguments, &catalogue),
        Command::Sheet(arguments) => sheet::run(arguments, &catalogue),
        Command::Animate(arguments) => animate::run(arguments, &catalogue),
        Command::Map(arguments) => map::run(arguments, &catalogue),
        Command::Info(arguments) => info::run(arguments, &catalogue),
        Command::Count(arguments) => count::run(arguments, &catalogue),
        Command::Dim(arguments) => dim::run(arguments, &catalogue),
        Command::Morph(arguments) => morph::run(arguments),
        Command::Skeleton(arguments) => skeleton::run(arguments),
        Command::New(arguments) => new::run(arguments),
        Command::Cat(arguments) => cat::run(arguments, &catalogue),
        Command::List(arguments) => list::run(arguments, &catalogue),
        Command::Check(arguments) => check::run(arguments, &catalogue),
        Command::Convert(arguments) => convert::run(arguments, &catalogue),
        Command::Import(arguments) => import::run(arguments),
        Command::Compare(arguments) => compare::run(arguments, &catalogue),
        Command::Fit(arguments) => fit::run(arguments),
        Command::Dataset(arguments) => dataset::run(arguments, &catalogue),
        Command::Completions(arguments) => completions::run(arguments, &catalogue),
        Command::Man(arguments) => man::run(arguments),
        Command::Schema(arguments) => schema::run(arguments),
        #[cfg(feature = "studio")]
        Command::Studio(arguments) => studio::run(arguments, catalogue.clone()),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => report(&failure),
    }
}

impl Arguments {
    /// Parses a command line in which later options of `grow` override earlier ones.
    fn overridden(line: Vec<OsString>) -> Result<Self, clap::Error> {
        let command = Self::command();
        let command = command.mut_subcommand("grow", |grow| grow.args_override_self(true));
        Self::from_arg_matches(&command.try_get_matches_from(line)?)
    }
}

/// Prints the message about arguments that are not accepted, or help.
fn refused(error: &clap::Error) -> ExitCode {
    // Help and version go to standard output.
    match (error.exit_code(), error.print()) {
        (0, Ok(())) => ExitCode::SUCCESS,
        (0, Err(error)) => {
            let error = anyhow::Error::new(error).context(output::NO_STANDARD_OUTPUT);
            report(&error.into())
        }
        _ => ExitCode::from(2),
    }
}

fn report(failure: &Failure) -> ExitCode {
    match failure {
        Failure::File(diagnostics) => {
            text::print_diagnostics(diagnostics);
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
            text::print_diagnostics(&Diagnostic::error(format!("{error:#}")).into());
            ExitCode::FAILURE
        }
        Failure::Usage(message) => {
            text::print_diagnostics(&Diagnostic::error(message.clone()).into());
            ExitCode::from(2)
        }
        Failure::Reported => ExitCode::FAILURE,
    }
}
