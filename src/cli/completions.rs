//! `kfrac completions`: what shells need to complete command lines.

mod parameters;

use std::ffi::OsString;
use std::fmt::Write as _;

use clap::Command;
use clap::builder::PossibleValuesParser;
use clap_complete::{Shell, generate};

use crate::catalogue::{Catalogue, Entry, Shelf};

use super::{Failure, help, output};

/// Prints a script that completes command lines of kfrac
///
/// The script knows commands, options, their values, and the rules and components that the library has
/// when it is made, and it asks kfrac for the parameters of a rule behind --set (bash, fish, zsh).
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    /// The shell
    #[arg(
        value_name = "SHELL",
        value_enum,
        required_unless_present = "parameters"
    )]
    shell: Option<Shell>,
    /// Lists the parameters of the rules on a command line; for the scripts
    #[arg(long, hide = true, conflicts_with = "shell")]
    parameters: bool,
    /// The command line
    #[arg(last = true, hide = true, requires = "parameters")]
    words: Vec<OsString>,
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

/// The commands that take a component as well.
const OF_COMPONENTS: [&str; 3] = ["show", "cat", "check"];

/// The commands that have `--set`.
const OF_PARAMETERS: [&str; 8] = [
    "grow", "sheet", "show", "info", "count", "dim", "convert", "compare",
];

/// The names that a library has.
#[derive(Default)]
struct Names {
    rules: Vec<String>,
    /// Those of components that no rule has, and those with their folders that a rule has.
    components: Vec<String>,
}

impl Names {
    fn of(catalogue: &Catalogue) -> Self {
        // A script is no place for names that a shell would take apart.
        let is_word = |name: &str| {
            name.chars()
                .all(|c| c.is_alphanumeric() || "-_.".contains(c))
        };
        let mut names = Self::default();
        for Entry { name, shelf, .. } in catalogue.entries() {
            if !is_word(&name) {
                continue;
            }
            if Shelf::grown().contains(&shelf) {
                names.rules.push(name);
                continue;
            }
            let found = catalogue.component_named(&name);
            names.components.push(match found {
                Some(found) if found.shelf == shelf => name,
                _ => format!("{}/{name}", shelf.folder()),
            });
        }
        names
    }

    fn for_command(&self, command: &str) -> Vec<String> {
        let components = OF_COMPONENTS.contains(&command).then_some(&self.components);
        let all = self.rules.iter().chain(components.into_iter().flatten());
        all.cloned().collect()
    }
}

pub(super) fn run(arguments: &Arguments, catalogue: &Catalogue) -> Result<(), Failure> {
    let Some(shell) = arguments.shell else {
        return Ok(output::print(&parameters::listed(&arguments.words))?);
    };
    let names = Names::of(catalogue);
    let script = match shell {
        // Where no rule matches, bash goes on to files.
        Shell::Bash => with_parameters_for_bash(&script(Shell::Bash, Some(&names))),
        Shell::Fish => with_rules_for_fish(script(Shell::Fish, None), &names),
        Shell::Zsh => with_rules_for_zsh(&script(Shell::Zsh, None), &names),
        other => script(other, None),
    };
    Ok(output::print(&script)?)
}

/// The script for a shell that completes these rules and nothing else where a rule is wanted, or,
/// where there are none, files.
fn script(shell: Shell, names: Option<&Names>) -> String {
    let command = super::command();
    let commands = command
        .get_subcommands()
        .map(|sub| sub.get_name().to_owned());
    let mut command = with_values(command.clone(), "man", "command", commands.collect());
    if let Some(names) = names {
        for (name, argument) in OF_RULES {
            command = with_values(command, name, argument, names.for_command(name));
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

/// With the parameters of the rule behind `--set`.
fn with_parameters_for_bash(script: &str) -> String {
    const FILES: &str = "                --set)
                    COMPREPLY=($(compgen -f \"${cur}\"))
";
    const PARAMETERS: &str = "                --set)
                    COMPREPLY=($(compgen -W \"$(\"$1\" completions --parameters -- \
\"${COMP_WORDS[@]}\" 2>/dev/null | cut -f 1)\" -- \"${cur}\"))
                    [[ ${#COMPREPLY[@]} -eq 0 ]] || compopt -o nospace 2>/dev/null
";
    script.replace(FILES, PARAMETERS)
}

/// With rules, and with the parameters of the one that is named, beside files.
fn with_rules_for_fish(mut script: String, names: &Names) -> String {
    let mut commands = OF_RULES.map(|(command, _)| command).to_vec();
    commands.dedup();
    for command in commands {
        let rules = names.for_command(command).join(" ");
        // Writing to a string does not fail.
        let _ = writeln!(
            script,
            r#"complete -c kfrac -n "__fish_kfrac_using_subcommand {command}" -a "{rules}""#
        );
    }
    for command in OF_PARAMETERS {
        let _ = writeln!(
            script,
            r#"complete -c kfrac -n "__fish_kfrac_using_subcommand {command}" -l set -x -a "(kfrac completions --parameters -- (commandline -op) 2>/dev/null)""#
        );
    }
    script
}

/// With rules beside files, and parameters: by functions, before the lines that start the completion.
fn with_rules_for_zsh(script: &str, names: &Names) -> String {
    const PARAMETERS: &str = r#"(( $+functions[_kfrac_parameters] )) ||
_kfrac_parameters() {
    local -a names
    names=(${(f)"$(kfrac completions --parameters -- "${words[@]}" 2>/dev/null)"})
    compadd -S '' -- ${names%%$'\t'*}
}

"#;
    let mut with_rules = String::new();
    // The command whose arguments are listed.
    let mut command = "";
    for line in script.lines() {
        if line.starts_with("if [ \"$funcstack[1]\"") {
            with_rules.push_str(PARAMETERS);
            for (function, command) in [(RULES, "grow"), (COMPONENTS, "cat")] {
                let rules = names.for_command(command).join(" ");
                let _ = write!(
                    with_rules,
                    "(( $+functions[{function}] )) ||\n{function}() {{\n    \
                     _alternative 'rules:rule:({rules})' 'files:file:_files'\n}}\n\n"
                );
            }
        }
        let is_case = line.starts_with('(') && line.ends_with(')');
        if is_case {
            command = line.trim_matches(['(', ')']);
        }
        let rules = OF_RULES.map(|(_, argument)| format!(":{argument} -- "));
        let wants_rule = rules.iter().any(|rule| line.contains(rule));
        let function = match OF_COMPONENTS.contains(&command) {
            true => COMPONENTS,
            false => RULES,
        };
        let line = match line.strip_suffix(r":_files' \") {
            Some(start) if wants_rule => format!(r"{start}:{function}' \"),
            _ => line.replace(":NAME=VALUE:_default'", ":NAME=VALUE:_kfrac_parameters'"),
        };
        with_rules.push_str(&line);
        with_rules.push('\n');
    }
    with_rules
}

/// The functions of zsh that complete rules, and rules and components.
const RULES: &str = "_kfrac_rules";
const COMPONENTS: &str = "_kfrac_components";
