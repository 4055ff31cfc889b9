//! Completion of the parameters that `--set` accepts on an unfinished command line.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fmt::Write as _;
use std::path::PathBuf;

use clap::{Arg, Command};

use crate::cli::{command, input, rule};

use super::rule_arguments;

/// Lists the parameters of the rules on a command line, one per line: `NAME=`, a tab, and the description.
///
/// Errors are ignored, because the command line is unfinished.
pub(super) fn listed(words: &[OsString]) -> String {
    let Typed { folders, rules } = Typed::read(words);
    let mut parameters = BTreeMap::new();
    let catalogue = rule::catalogue(&folders);
    for rule in rules {
        let known = catalogue.as_ref().ok().and_then(|catalogue| {
            // Pipes and devices could block, and are not read.
            let is_special = rule.metadata().is_ok_and(|metadata| !metadata.is_file());
            if is_special || rule.as_os_str() == "-" {
                return None;
            }
            let source = rule::open(&rule, catalogue).ok()?;
            input::document(&source, catalogue).ok()
        });
        let known = known
            .iter()
            .flat_map(|document| &document.metadata().params);
        for parameter in known {
            let name = &parameter.called().value;
            let mut about = parameter.about.as_deref().unwrap_or_default();
            // For a complex parameter, the description of both parts.
            if let (Some(_), Some((_, of_both))) = (&parameter.whole, about.split_once(": ")) {
                about = of_both;
            }
            let about = about.split_whitespace().collect::<Vec<_>>().join(" ");
            parameters.insert(name.clone(), about);
        }
    }
    let mut text = String::new();
    for (name, about) in parameters {
        // Writing to a string does not fail.
        let _ = writeln!(text, "{name}=\t{about}");
    }
    text
}

/// Rules and options on an unfinished command line.
#[derive(Default)]
struct Typed {
    folders: Vec<PathBuf>,
    rules: Vec<PathBuf>,
}

impl Typed {
    /// Parses the words of a command line, with or without the name of the program. Unknown options are
    /// assumed to take no value.
    fn read(words: &[OsString]) -> Self {
        let mut typed = Self::default();
        let (program, rules) = (command(), rule_arguments());
        let mut inside: Option<&Command> = None;
        let words = joined(words);
        let mut words = words.iter();
        while let Some(word) = words.next() {
            let text = word.to_string_lossy();
            if text.starts_with('-') && text.len() > 1 {
                let name = text.split('=').next().unwrap_or_default();
                let of = |command: &Command| find(command, name).cloned();
                let option = inside.and_then(of).or_else(|| of(&program));
                let takes = option.is_some_and(|it| it.get_action().takes_values());
                let value = match text.split_once('=') {
                    Some((_, value)) => Some(value.into()),
                    None if takes => words.next().cloned(),
                    None => None,
                };
                if name == "--library" {
                    typed.folders.extend(value.map(PathBuf::from));
                }
            } else if let Some(command) = inside {
                let takes = { rules.iter() }.filter(|(of, _)| of == command.get_name());
                // A shell may repeat the command.
                let is_command = typed.rules.is_empty() && text == command.get_name();
                if typed.rules.len() < takes.count() && !is_command {
                    typed.rules.push(word.into());
                }
            } else {
                inside = program.find_subcommand(&*text);
            }
        }
        typed
    }
}

/// Returns the option with a name, which includes its dashes.
fn find<'a>(command: &'a Command, name: &str) -> Option<&'a Arg> {
    command.get_arguments().find(|argument| {
        let long = argument.get_long().map(|long| format!("--{long}"));
        let short = argument.get_short().map(|short| format!("-{short}"));
        long.as_deref() == Some(name) || short.as_deref() == Some(name)
    })
}

/// Joins words that bash splits at `=`.
fn joined(words: &[OsString]) -> Vec<OsString> {
    let mut all: Vec<OsString> = Vec::new();
    let mut is_open = false;
    for word in words {
        let is_sign = word == "=";
        match all.last_mut() {
            Some(last) if is_sign || is_open => last.push(word),
            _ => all.push(word.clone()),
        }
        is_open = is_sign;
    }
    all
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::Typed;

    #[test]
    fn rules_are_found_among_options() {
        for (line, rules) in [
            ("kfrac grow koch --set", "koch"),
            ("kfrac grow --steps 5 -o a.svg koch", "koch"),
            ("kfrac grow --set angle = 30 --quiet koch", "koch"),
            ("kfrac grow --set=angle=30 koch --set an", "koch"),
            ("grow koch --set", "koch"),
            ("grow grow koch --set", "koch"),
            ("kfrac --library own grow mine", "mine"),
            (
                "kfrac compare --tolerance 0.1 koch dragon other",
                "koch dragon",
            ),
            ("kfrac list koch", ""),
            ("kfrac grow", ""),
        ] {
            let words: Vec<_> = line.split(' ').map(Into::into).collect();
            let typed = Typed::read(&words);
            let found = typed.rules.iter().map(|rule| rule.to_string_lossy());
            assert_eq!(found.collect::<Vec<_>>().join(" "), rules, "{line}");
            let own = line.contains("own").then(|| PathBuf::from("own"));
            assert!(typed.folders.iter().eq(&own), "{line}");
        }
    }
}
