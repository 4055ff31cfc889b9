//! Films as files describe them.

use clap::error::ErrorKind;
use clap::{Args as _, Command, FromArgMatches};

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::{Document, FilmOption};

use super::super::Failure;
use super::Arguments;

/// Options of which at most one is in effect.
const EXCLUSIVE: [&[&str]; 1] = [&["loop", "bounce"]];

/// Returns the arguments of a film with the options of the file, where the command line does not give them.
pub(super) fn complete(
    arguments: &Arguments,
    document: &Document,
) -> Result<Option<Arguments>, Failure> {
    let options = &document.metadata().animation;
    if options.is_empty() {
        return Ok(None);
    }
    let wrong = mistakes(document);
    if wrong.has_errors() {
        return Err(wrong.into());
    }
    let given = arguments.given.all();
    let is_given = |option: &&FilmOption| {
        given.iter().any(|(name, value)| match option.name {
            "set" => name == "set" && parameter(value) == parameter(&option.value.value),
            own => {
                let excludes = |set: &&&[&str]| set.contains(&own) && set.contains(&name.as_str());
                name == own || EXCLUSIVE.iter().any(|set| excludes(&set))
            }
        })
    };
    let own = options.iter().filter(|option| !is_given(option));
    let own = own.map(|it| (it.name.to_owned(), it.value.value.clone()));
    let all = given.iter().cloned().chain(own);
    let all: Vec<_> = all.map(|(name, value)| argument(&name, &value)).collect();
    let rule = arguments.rule.as_os_str().to_owned();
    let words = std::iter::once(rule).chain(all.into_iter().map(Into::into));
    let usage = |error: clap::Error| Failure::usage(&error);
    let matches = command().try_get_matches_from(words).map_err(usage)?;
    Arguments::from_arg_matches(&matches)
        .map(Some)
        .map_err(usage)
}

/// Returns the mistakes in the description of a film: values that its options do not take, and unknown parameters.
pub(in crate::cli) fn mistakes(document: &Document) -> Diagnostics {
    let mut found = Diagnostics::default();
    let metadata = document.metadata();
    for option in &metadata.animation {
        let place = &option.value.place;
        let words = [
            "rule".to_owned(),
            argument(option.name, &option.value.value),
        ];
        if let Err(error) = command().try_get_matches_from(words)
            && error.kind() == ErrorKind::ValueValidation
        {
            let reason = std::error::Error::source(&error).map(ToString::to_string);
            let reason = reason.unwrap_or_else(|| "the value is not valid".into());
            found.push(Diagnostic::error(format!("{}: {reason}", option.name)).at(place));
        }
        let name = parameter(&option.value.value);
        if option.name == "set"
            && !metadata
                .params
                .iter()
                .any(|it| it.name.value == name || it.called().value == name)
        {
            let message = format!("there is no parameter '{name}'");
            found.push(
                Diagnostic::error(message)
                    .at(place)
                    .hint(metadata.instead_of(name)),
            );
        }
    }
    found
}

/// Returns the name of the parameter that `NAME=VALUE` sets.
fn parameter(assignment: &str) -> &str {
    assignment.split('=').next().unwrap_or_default().trim()
}

fn argument(name: &str, value: &str) -> String {
    match value {
        "" => format!("--{name}"),
        value => format!("--{name}={value}"),
    }
}

fn command() -> Command {
    Arguments::augment_args(Command::new("animate").no_binary_name(true))
}
