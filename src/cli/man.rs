//! `kfrac man`: manual pages, generated from the help.

use std::io::{self, Write};
use std::path::PathBuf;

use clap::builder::PossibleValue;
use clap::{Arg, Command, ValueHint};
use clap_mangen::Man;
use clap_mangen::roff::{Roff, bold, roman};

use crate::diagnostic::did_you_mean;

use super::Failure;
use super::help::{self, HelpLine};
use super::output::{self, Output};

/// Prints a manual page, or writes all of them
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    /// Command whose page is printed [default: the page of kfrac itself]
    #[arg(value_name = "COMMAND", conflicts_with = "dir")]
    command: Option<String>,
    /// Writes all pages (kfrac.1, kfrac-grow.1 and so on) into a folder, which is created if necessary
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    dir: Option<PathBuf>,
}

const MORE: &str = "\
Examples:
  kfrac man | man -l -
      Shows the page of kfrac
  kfrac man grow | man -l -
      Shows the page of kfrac grow
  kfrac man --dir .
      Writes all pages into the current folder; man finds them in ~/.local/share/man/man1
";

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut command = super::command().disable_help_subcommand(true);
    command.build();
    if let Some(folder) = &arguments.dir {
        output::make_folder(folder)?;
        let pages = [&command].into_iter().chain(command.get_subcommands());
        for command in pages {
            let mut file = Output::create(&folder.join(format!("{}.1", name(command))))?;
            file.write_all(&page(command)?)?;
            file.finish()?;
        }
        return Ok(());
    }
    let asked = match &arguments.command {
        None => &command,
        Some(asked) => command.find_subcommand(asked).ok_or_else(|| {
            let names = command.get_subcommands().map(Command::get_name);
            let hint = did_you_mean(asked, names).map(|hint| format!(" ({hint})"));
            Failure::Usage(format!(
                "kfrac has no command '{asked}'{}",
                hint.unwrap_or_default()
            ))
        })?,
    };
    Ok(output::print(&String::from_utf8_lossy(&page(asked)?))?)
}

/// Returns the name of the page of a command.
fn name(command: &Command) -> &str {
    command.get_display_name().unwrap_or(command.get_name())
}

/// Returns the page of a command that has been built.
fn page(command: &Command) -> io::Result<Vec<u8>> {
    // The synopsis is that of the help, which does not repeat all options.
    let usage = command.clone().render_usage().to_string();
    let usage = usage.trim_start_matches("Usage: ").to_owned();
    let command = command
        .clone()
        .override_usage(usage)
        .subcommand_help_heading("COMMANDS")
        .mut_args(with_plain_values);
    let man = Man::new(command.clone());
    let mut page = Vec::new();
    let (name, version) = (name(&command), env!("CARGO_PKG_VERSION"));
    let title = name.to_uppercase();
    writeln!(page, r#".TH {title} 1 "" "kfrac {version}" "kfrac manual""#)?;
    man.render_name_section(&mut page)?;
    man.render_synopsis_section(&mut page)?;
    man.render_description_section(&mut page)?;
    let arguments = command.clone().mut_args(|argument| {
        let hide = !argument.is_positional();
        argument.help_heading("Arguments").hide(hide)
    });
    Man::new(arguments).render_options_section(&mut page)?;
    let options = command.clone().mut_args(|argument| {
        let hide = argument.is_positional();
        argument.hide(hide)
    });
    Man::new(options).render_options_section(&mut page)?;
    if command.has_subcommands() {
        man.render_subcommands_section(&mut page)?;
    }
    let mut rest = Roff::new();
    let more = command.get_after_long_help().map(ToString::to_string);
    for line in help::lines(&more.unwrap_or_default()) {
        match line {
            HelpLine::Heading(heading) => rest.control("SH", [heading.to_uppercase().as_str()]),
            HelpLine::Term(term) => rest.control("TP", []).text([bold(term)]),
            HelpLine::Meaning(meaning) => rest.text([roman(meaning)]),
        };
    }
    if !command.has_subcommands() {
        rest.control("SH", ["SEE ALSO"]);
        rest.text([bold("kfrac"), roman("(1)")]);
    }
    rest.to_writer(&mut page)?;
    Ok(page)
}

/// Lists values that need no explanation in one sentence instead of a list.
fn with_plain_values(argument: Arg) -> Arg {
    let values = argument.get_possible_values();
    let explained = values.iter().any(|value| value.get_help().is_some());
    if values.is_empty() || explained || !argument.get_action().takes_values() {
        return argument;
    }
    let names: Vec<_> = values.iter().map(PossibleValue::get_name).collect();
    let help = argument.get_long_help().or(argument.get_help());
    let help = help.map(ToString::to_string).unwrap_or_default();
    argument
        .hide_possible_values(true)
        .long_help(format!("{help}: {}", names.join(", ")))
}
