//! Films: key frames of the parameters, as arguments of `kfrac animate`.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::cli::animate;
use crate::cli::held::{Done, Held};
use crate::cli::labels::quoted;
use crate::expression::PARTS;

use super::answer::Refusal;
use super::drawing::Shot;
use super::look::Look;

/// Values of parameters, by their names.
type Values = BTreeMap<String, String>;

/// Largest number of key frames.
const MOST: usize = 1_000;

/// Largest number of frames.
const MOST_FRAMES: u32 = 10_000;

/// Key frames, at equal times, and the course between them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Film {
    /// Values of all parameters.
    keys: Vec<Values>,
    frames: Option<u32>,
    fps: Option<f64>,
    /// Course of time; empty for the default.
    ease: String,
    #[serde(rename = "loop")]
    is_loop: bool,
    bounce: bool,
    smooth: bool,
}

impl Film {
    /// Refuses films without bounds.
    pub(super) fn check(&self) -> Result<(), Refusal> {
        let are_few = self.keys.len() <= MOST && self.keys.iter().all(|key| key.len() <= MOST);
        let values = self.keys.iter().flatten();
        let are_short = values
            .map(|(name, value)| name.len() + value.len())
            .sum::<usize>()
            < 1 << 18;
        let is_short = self.frames.is_none_or(|it| it <= MOST_FRAMES) && self.ease.len() < 16;
        match are_few && are_short && is_short {
            true => Ok(()),
            false => Err(Refusal::wrong(format!(
                "a film of the studio has up to {MOST} key frames and {MOST_FRAMES} frames"
            ))),
        }
    }

    /// Keeps the parameters that a text has.
    pub(super) fn retain(&mut self, known: impl Fn(&str) -> bool) {
        for key in &mut self.keys {
            key.retain(|name, _| known(name));
        }
        self.keys.retain(|key| !key.is_empty());
    }

    /// Returns the options of `animate`.
    fn options(&self) -> Result<Vec<String>, Refusal> {
        let [first, _, ..] = &self.keys[..] else {
            return Err(Refusal::wrong(
                "a film has two key frames at least: add those of the present values",
            ));
        };
        let mut options = Vec::new();
        for name in first.keys() {
            let values: Option<Vec<&str>> = { self.keys.iter() }
                .map(|key| key.get(name).map(String::as_str))
                .collect();
            let Some(values) = values else {
                continue;
            };
            let is_one = values.iter().all(|value| *value == values[0]);
            let written = if is_one {
                values[0].into()
            } else {
                values.join(",")
            };
            options.push(format!("--set={name}={written}"));
        }
        let frames = self.frames.map(|it| format!("--frames={it}"));
        let fps = self.fps.map(|it| format!("--fps={it}"));
        let ease = (!self.ease.is_empty()).then(|| format!("--ease={}", self.ease));
        options.extend([frames, fps, ease].into_iter().flatten());
        let flags = [
            ("--loop", self.is_loop && !self.bounce),
            ("--bounce", self.bounce),
            ("--smooth", self.smooth),
        ];
        let flags = flags.into_iter().filter(|(_, is_set)| *is_set);
        options.extend(flags.map(|(flag, _)| flag.to_owned()));
        Ok(options)
    }

    /// Returns the values of the parameters in every frame.
    fn frames(&self, shot: &Shot) -> Result<Vec<Values>, Refusal> {
        let mut arguments = vec![shot.rule.clone()];
        arguments.extend(self.options()?);
        let frames = animate::values(&arguments, &shot.source, &shot.catalogue)?;
        Ok(frames.into_iter().map(joined).collect())
    }
}

/// Joins the parts of complex parameters.
fn joined(values: Vec<(String, String)>) -> Values {
    let [real, imaginary] = PARTS;
    let mut joined: Values = BTreeMap::new();
    for (name, value) in values {
        if let Some(whole) = name.strip_suffix(real) {
            joined.insert(whole.into(), format!("[{value}"));
        } else if let Some(whole) = name.strip_suffix(imaginary) {
            let begun = joined.entry(whole.into()).or_default();
            begun.push_str(&format!(",{value}]"));
        } else {
            joined.insert(name, value);
        }
    }
    joined
}

impl Shot {
    /// Returns the arguments of a film with the look of a picture.
    fn film_arguments(&self, look: &Look, held: &Arc<Held>) -> Result<Vec<String>, Refusal> {
        let mut arguments = vec![self.rule.clone()];
        let others = self.look.iter().filter(|it| !it.starts_with("--set="));
        arguments.extend(others.cloned());
        arguments.extend(look.film.options()?);
        arguments.extend(self.view_arguments(held)?);
        Ok(arguments)
    }

    /// Returns the values of all frames, and the command that writes the film, without its size and file.
    pub(super) fn film(&self, look: &Look, held: &Arc<Held>) -> Result<Value, Refusal> {
        let sets = look.film.frames(self)?;
        let arguments = self.film_arguments(look, held)?;
        let words = ["kfrac".to_owned(), "animate".to_owned()].into_iter();
        let words: Vec<_> = words.chain(arguments).map(|word| quoted(&word)).collect();
        Ok(json!({ "sets": sets, "command": words.join(" ") }))
    }

    /// Writes a film, and returns its summary.
    pub(super) fn export_film(
        &self,
        look: &Look,
        path: &Path,
        held: &Arc<Held>,
    ) -> Result<(String, Done), Refusal> {
        let mut arguments = self.film_arguments(look, held)?;
        let Some(path) = path.to_str() else {
            return Err(Refusal::wrong("the name of the file is not Unicode"));
        };
        let [width, height] = self.size;
        let file = [
            format!("--size={width}x{height}"),
            format!("--output={path}"),
        ];
        arguments.extend(file);
        let own = Arc::clone(held);
        let summary = animate::hold(&arguments, &self.source, &self.catalogue, own)?;
        let named = summary.strip_prefix(path);
        let unnamed = named.and_then(|rest| rest.strip_prefix(": "));
        Ok((unnamed.unwrap_or(&summary).into(), held.take()))
    }
}
