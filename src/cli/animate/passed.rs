//! Options of `kfrac grow` that hold for every frame.

use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Args, Command, Error, FromArgMatches};

use super::super::grow;

/// Options of `kfrac grow` that a film has in a form of its own, or that do not apply to its frames.
const OTHERS: [&str; 40] = [
    "rule",
    "set",
    "steps",
    "between",
    "output",
    "format",
    "watch",
    "open",
    "seed",
    "samples",
    "threads",
    "quiet",
    "zoom",
    "turn",
    "from",
    "depth",
    "plot",
    "pens",
    "occlude",
    "hatch",
    "hatch_spacing",
    "feed",
    "pen_up",
    "pen_down",
    "mesh",
    "size",
    "morph",
    "disk",
    "to",
    "share",
    "drawn",
    "initiator",
    "generator",
    "base_element",
    "tiles",
    "tile_size",
    "overlap",
    "level",
    "shard",
    "max_tiles",
];

/// Options of `kfrac animate` that change nothing of a film.
const WITHOUT_EFFECT: [&str; 5] = ["output", "format", "threads", "quiet", "only"];

/// Options of `kfrac grow` as they are given.
pub(super) struct FrameOptions {
    passed: Vec<String>,
}

/// All options of a film with their values, which are empty for flags. It is read before the options themselves, which
/// leave nothing to read.
pub(super) struct Given(Vec<(String, String)>);

impl FrameOptions {
    /// Returns the options as arguments.
    pub(super) fn arguments(&self) -> &[String] {
        &self.passed
    }

    /// Iterates over the options with their values, which are empty for flags.
    pub(super) fn named(&self) -> impl Iterator<Item = (&str, &str)> {
        let plain = self.passed.iter().filter_map(|it| it.strip_prefix("--"));
        plain.map(|it| it.split_once('=').unwrap_or((it, "")))
    }

    /// Returns the value of an option, if it is given.
    pub(super) fn value(&self, name: &str) -> Option<&str> {
        self.named()
            .find(|(own, _)| *own == name)
            .map(|(_, value)| value)
    }

    /// Returns whether an option is given.
    pub(super) fn gives(&self, name: &str) -> bool {
        self.value(name).is_some()
    }
}

/// Iterates over the options of `kfrac grow` that are passed on.
fn passed() -> Vec<Arg> {
    let all = grow::Arguments::augment_args(Command::new("grow"));
    let passed = all
        .get_arguments()
        .filter(|it| !OTHERS.contains(&it.get_id().as_str()));
    passed.cloned().collect()
}

impl Args for FrameOptions {
    fn augment_args(command: Command) -> Command {
        command.args(passed())
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for FrameOptions {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        let mut given = Vec::new();
        for option in passed() {
            let name = option.get_id().as_str();
            let Some(long) = option.get_long() else {
                continue;
            };
            if matches.value_source(name) != Some(ValueSource::CommandLine) {
                continue;
            }
            if matches!(option.get_action(), ArgAction::SetTrue) {
                given.push(format!("--{long}"));
                continue;
            }
            let values = matches.get_raw(name).into_iter().flatten();
            given.extend(values.map(|value| format!("--{long}={}", value.to_string_lossy())));
        }
        Ok(Self { passed: given })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Given {
    /// Returns all options.
    pub(super) fn all(&self) -> &[(String, String)] {
        &self.0
    }

    /// Returns the options that change the film, for labels.
    pub(super) fn labelled(&self) -> Vec<(String, String)> {
        let effective =
            { self.0.iter() }.filter(|(name, _)| !WITHOUT_EFFECT.contains(&name.as_str()));
        effective.cloned().collect()
    }
}

impl Args for Given {
    fn augment_args(command: Command) -> Command {
        command
    }

    fn augment_args_for_update(command: Command) -> Command {
        command
    }
}

impl FromArgMatches for Given {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        Ok(Self(all_given(matches)))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// Returns the options of a film as they are given.
fn all_given(matches: &ArgMatches) -> Vec<(String, String)> {
    let mut written = Vec::new();
    for id in matches.ids().map(clap::Id::as_str) {
        // Groups of options have the names of types.
        let is_option = !id.starts_with(char::is_uppercase) && !["rule", "library"].contains(&id);
        if !is_option || matches.value_source(id) != Some(ValueSource::CommandLine) {
            continue;
        }
        let name = match id {
            "is_loop" => "loop".to_owned(),
            id => id.replace('_', "-"),
        };
        let values = matches.try_get_raw(id).ok().flatten().into_iter().flatten();
        written.extend(values.map(|value| match value.to_string_lossy() {
            flag if flag == "true" => (name.clone(), String::new()),
            value => (name.clone(), value.into_owned()),
        }));
    }
    written
}
