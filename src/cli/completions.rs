//! `kfrac completions`: scripts that complete command lines.

mod parameters;

use std::ffi::OsString;
use std::fmt::Write as _;

use clap::builder::PossibleValuesParser;
use clap::{Command, ValueHint};
use clap_complete::{Shell, generate};

use crate::catalogue::{Catalogue, LibraryFile, Shelf};

use super::{Failure, help, output};

/// Prints a shell completion script
///
/// The script completes commands, options, their values, and the rules and components that are in the library
/// when the script is generated. For the parameters of a rule after --set, it runs kfrac (bash, fish, zsh).
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    /// Shell
    #[arg(
        value_name = "SHELL",
        value_enum,
        required_unless_present = "parameters"
    )]
    shell: Option<Shell>,
    /// Lists the parameters of the rules on a command line, for the scripts
    #[arg(long, hide = true, conflicts_with = "shell")]
    parameters: bool,
    /// Command line
    #[arg(last = true, hide = true, requires = "parameters")]
    words: Vec<OsString>,
}

const MORE: &str = "\
Examples:
  kfrac completions bash > ~/.local/share/bash-completion/completions/kfrac
      For bash with bash-completion; without it, add source <(kfrac completions bash) to ~/.bashrc
  kfrac completions zsh > ~/.zfunc/_kfrac
      For zsh, if ~/.zfunc is in fpath before compinit runs
  kfrac completions fish > ~/.config/fish/completions/kfrac.fish
      For fish
  kfrac completions powershell >> $PROFILE
      For PowerShell
";

/// Returns the commands that take a rule, with the name of that argument.
fn rule_arguments() -> Vec<(String, String)> {
    let command = super::command();
    let arguments = command.get_subcommands().flat_map(|command| {
        let paths = { command.get_positionals() }
            .filter(|argument| argument.get_value_hint() == ValueHint::AnyPath);
        paths.map(|path| (command.get_name().to_owned(), path.get_id().to_string()))
    });
    arguments.collect()
}

/// Commands that also take a component.
const OF_COMPONENTS: [&str; 3] = ["show", "cat", "check"];

/// Names in a library.
#[derive(Default)]
struct Names {
    rules: Vec<String>,
    /// Names of components; those that are also names of rules are preceded by their folder.
    components: Vec<String>,
}

impl Names {
    fn of(catalogue: &Catalogue) -> Self {
        // Names that a shell would split are left out of the script.
        let is_word = |name: &str| {
            name.chars()
                .all(|c| c.is_alphanumeric() || "-_.".contains(c))
        };
        let mut names = Self::default();
        for LibraryFile { name, shelf, .. } in catalogue.entries() {
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
        // bash falls back to files if no rule matches.
        Shell::Bash => with_parameters_for_bash(&script(Shell::Bash, Some(&names))),
        Shell::Fish => with_rules_for_fish(script(Shell::Fish, None), &names),
        Shell::Zsh => with_rules_for_zsh(&script(Shell::Zsh, None), &names),
        other => script(other, None),
    };
    Ok(output::print(&script)?)
}

/// Returns the generated script. With `names`, arguments that take a rule complete these names only, and
/// otherwise files.
fn script(shell: Shell, names: Option<&Names>) -> String {
    let command = super::command();
    let commands = command
        .get_subcommands()
        .map(|sub| sub.get_name().to_owned());
    let mut command = with_values(command.clone(), "man", "command", commands.collect());
    if let Some(names) = names {
        for (name, argument) in rule_arguments() {
            command = with_values(command, &name, &argument, names.for_command(&name));
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

/// Adds the parameters of the rule after `--set`.
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

/// Adds rules, and the parameters of the given rule, besides files.
fn with_rules_for_fish(mut script: String, names: &Names) -> String {
    let mut commands = rule_arguments();
    commands.dedup_by(|one, other| one.0 == other.0);
    for (command, _) in commands {
        let rules = names.for_command(&command).join(" ");
        // Writing to a string does not fail.
        let _ = writeln!(
            script,
            r#"complete -c kfrac -n "__fish_kfrac_using_subcommand {command}" -a "{rules}""#
        );
    }
    let command = super::command();
    let has_set = |command: &&Command| command.get_arguments().any(|it| it.get_id() == "set");
    for command in command.get_subcommands().filter(has_set) {
        let command = command.get_name();
        let _ = writeln!(
            script,
            r#"complete -c kfrac -n "__fish_kfrac_using_subcommand {command}" -l set -x -a "(kfrac completions --parameters -- (commandline -op) 2>/dev/null)""#
        );
    }
    script
}

/// Adds rules besides files, and parameters, by functions in front of the lines that start the completion.
fn with_rules_for_zsh(script: &str, names: &Names) -> String {
    const PARAMETERS: &str = r#"(( $+functions[_kfrac_parameters] )) ||
_kfrac_parameters() {
    local -a names
    names=(${(f)"$(kfrac completions --parameters -- "${words[@]}" 2>/dev/null)"})
    compadd -S '' -- ${names%%$'\t'*}
}

"#;
    let rules = rule_arguments();
    let mut with_rules = String::new();
    // Command whose arguments are listed.
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
        let mut arguments = rules.iter().map(|(_, argument)| format!(":{argument} -- "));
        let wants_rule = arguments.any(|argument| line.contains(&argument));
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

/// Functions of the zsh script that complete rules, and rules and components.
const RULES: &str = "_kfrac_rules";
const COMPONENTS: &str = "_kfrac_components";
