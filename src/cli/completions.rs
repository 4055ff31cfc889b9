//! `kfrac completions`: what shells need to complete command lines.

use std::fmt::Write as _;

use clap::Command;
use clap::builder::PossibleValuesParser;
use clap_complete::{Shell, generate};

use crate::catalogue::{Catalogue, Shelf};

use super::{Failure, help, output};

/// Prints a script that completes command lines of kfrac
///
/// The script knows commands, options, their values, and the rules that the library has when it is
/// made (bash, fish, zsh).
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    /// The shell
    #[arg(value_name = "SHELL", value_enum)]
    shell: Shell,
}

const MORE: &str = "\
Examples:
  kfrac completions bash > ~/.local/share/bash-completion/completions/kfrac
      For bash with bash-completion; without it, put source <(kfrac completions bash) into ~/.bashrc
  kfrac completions zsh > ~/.zfunc/_kfrac
      For zsh, where ~/.zfunc is in fpath before compinit is run
  kfrac completions fish > ~/.config/fish/completions/kfrac.fish
      For fish
  kfrac completions powershell >> $PROFILE
      For PowerShell
";

/// The commands that take a rule, and the argument that is it.
const OF_RULES: [(&str, &str); 11] = [
    ("grow", "rule"),
    ("sheet", "rule"),
    ("show", "rule"),
    ("info", "rule"),
    ("count", "rule"),
    ("dim", "rule"),
    ("cat", "rule"),
    ("check", "files"),
    ("convert", "rule"),
    ("compare", "a"),
    ("compare", "b"),
];

pub(super) fn run(arguments: &Arguments, catalogue: &Catalogue) -> Result<(), Failure> {
    let entries = catalogue.entries();
    let rules = entries
        .iter()
        .filter(|entry| Shelf::grown().contains(&entry.shelf));
    // A script is no place for names that a shell would take apart.
    let is_word = |name: &str| {
        name.chars()
            .all(|c| c.is_alphanumeric() || "-_.".contains(c))
    };
    let rules: Vec<_> = rules
        .map(|entry| entry.name.clone())
        .filter(|name| is_word(name))
        .collect();
    let script = match arguments.shell {
        // Where no rule matches, bash goes on to files.
        Shell::Bash => script(Shell::Bash, &rules),
        Shell::Fish => with_rules_for_fish(script(Shell::Fish, &[]), &rules.join(" ")),
        Shell::Zsh => with_rules_for_zsh(&script(Shell::Zsh, &[]), &rules.join(" ")),
        other => script(other, &[]),
    };
    Ok(output::print(&script)?)
}

/// The script for a shell that completes these rules and nothing else where a rule is wanted, or,
/// where there are none, files.
fn script(shell: Shell, rules: &[String]) -> String {
    let command = super::command();
    let names = command
        .get_subcommands()
        .map(|sub| sub.get_name().to_owned());
    let mut command = with_values(command.clone(), "man", "command", names.collect());
    if !rules.is_empty() {
        for (name, argument) in OF_RULES {
            command = with_values(command, name, argument, rules.to_vec());
        }
    }
    let mut script = Vec::new();
    generate(shell, &mut command, "kfrac", &mut script);
    String::from_utf8_lossy(&script).into_owned()
}

fn with_values(command: Command, name: &str, argument: &str, values: Vec<String>) -> Command {
    let parser = PossibleValuesParser::new(values);
    command.mut_subcommand(name, |command| {
        command.mut_arg(argument, |argument| argument.value_parser(parser))
    })
}

/// With rules beside files.
fn with_rules_for_fish(mut script: String, rules: &str) -> String {
    let mut commands = OF_RULES.map(|(command, _)| command).to_vec();
    commands.dedup();
    for command in commands {
        // Writing to a string does not fail.
        let _ = writeln!(
            script,
            r#"complete -c kfrac -n "__fish_kfrac_using_subcommand {command}" -a "{rules}""#
        );
    }
    script
}

/// With rules beside files: by a function, before the lines that start the completion.
fn with_rules_for_zsh(script: &str, rules: &str) -> String {
    let mut with_rules = String::new();
    for line in script.lines() {
        if line.starts_with("if [ \"$funcstack[1]\"") {
            let _ = write!(
                with_rules,
                "(( $+functions[_kfrac_rules] )) ||\n_kfrac_rules() {{\n    \
                 _alternative 'rules:rule:({rules})' 'files:file:_files'\n}}\n\n"
            );
        }
        let rules = OF_RULES.map(|(_, argument)| format!(":{argument} -- "));
        let wants_rule = rules.iter().any(|rule| line.contains(rule));
        let line = match line.strip_suffix(r":_files' \") {
            Some(start) if wants_rule => format!(r"{start}:_kfrac_rules' \"),
            _ => line.to_owned(),
        };
        with_rules.push_str(&line);
        with_rules.push('\n');
    }
    with_rules
}
