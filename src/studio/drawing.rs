//! Pictures: the output of `kfrac grow`, held in memory.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use serde::Serialize;

use crate::catalogue::Catalogue;
use crate::cli::held::{Done, Held};
use crate::cli::{grow, map, show};
use crate::diagnostic::Source;
use crate::render::space::Sight;

use super::answer::Refusal;
use super::view::View;

/// Largest number of bytes of a picture.
pub(super) const MOST_BYTES: usize = 256 << 20;

/// Largest side of a picture in pixels.
pub(super) const MOST_PIXELS: u32 = 8_192;

/// Everything that a picture depends on.
#[derive(Clone, Debug)]
pub(super) struct Shot {
    pub(super) catalogue: Catalogue,
    pub(super) source: Arc<Source>,
    /// Name of the rule on the command line.
    pub(super) rule: String,
    /// Arguments without rule, size and view.
    pub(super) look: Vec<String>,
    pub(super) view: Option<View>,
    /// Degrees by which a set of the plane is turned.
    pub(super) turn: f64,
    pub(super) size: [u32; 2],
    /// Widths that pictures of the whole set show, where they have been drawn.
    pub(super) wholes: Arc<Wholes>,
}

/// Widths of pictures of whole sets, by their arguments.
#[derive(Debug, Default)]
pub(super) struct Wholes(Mutex<BTreeMap<Vec<String>, f64>>);

/// Picture with its numbers.
#[derive(Debug, Serialize)]
pub(super) struct Drawn {
    #[serde(skip)]
    pub(super) bytes: Vec<u8>,
    pub(super) summary: String,
    pub(super) notes: Vec<String>,
    pub(super) elements: Option<u64>,
    pub(super) steps: Option<u32>,
    pub(super) window: Option<[f64; 4]>,
    #[serde(skip)]
    pub(super) sight: Option<Sight>,
    /// Width and height in pixels.
    size: [u32; 2],
    /// The command that writes the same picture.
    pub(super) command: String,
    pub(super) seconds: f64,
}

impl Shot {
    /// Draws the picture, as a PNG.
    pub(super) fn draw(&self, held: &Arc<Held>) -> Result<Drawn, Refusal> {
        let start = std::time::Instant::now();
        let view = self.view_arguments(held)?;
        let (summary, done) = self.grown(&view, held)?;
        Ok(Drawn {
            summary,
            notes: done.notes,
            elements: done.elements,
            steps: done.steps,
            window: done.window,
            sight: done.sight,
            size: self.size,
            bytes: done.bytes,
            command: self.command(&view),
            seconds: start.elapsed().as_secs_f64(),
        })
    }

    /// Runs `grow` with the arguments of a view.
    fn grown(&self, view: &[String], held: &Arc<Held>) -> Result<(String, Done), Refusal> {
        let mut arguments = self.arguments(view);
        arguments.extend(["--format=png".into(), "--output=-".into()]);
        let summary = grow::hold(&arguments, &self.source, &self.catalogue, Arc::clone(held))?;
        Ok((summary, held.take()))
    }

    /// Writes a file by `grow`, and returns its summary.
    pub(super) fn export(
        &self,
        path: &std::path::Path,
        options: &[String],
        held: &Arc<Held>,
    ) -> Result<(String, Done), Refusal> {
        let mut arguments = self.arguments(&self.view_arguments(held)?);
        let Some(path) = path.to_str() else {
            return Err(Refusal::wrong("the name of the file is not Unicode"));
        };
        arguments.extend(options.iter().cloned());
        arguments.push(format!("--output={path}"));
        let summary = grow::hold(&arguments, &self.source, &self.catalogue, Arc::clone(held))?;
        Ok((summary, held.take()))
    }

    /// Draws a map of parameters behind which the other ones have the values of the picture; returns the bytes of a PNG.
    pub(super) fn map(&self, over: &[String], held: &Held) -> Result<Vec<u8>, Refusal> {
        let [width, height] = self.size;
        let mut arguments = vec![self.rule.clone(), format!("--size={width}x{height}")];
        arguments.extend(over.iter().map(|it| format!("--over={it}")));
        let settings = self.look.iter().filter(|it| it.starts_with("--set="));
        arguments.extend(settings.cloned());
        map::hold(&arguments, &self.source, &self.catalogue, held)?;
        Ok(held.take().bytes)
    }

    /// Draws the figure of the rule, as `kfrac show` does; returns the bytes of an SVG.
    pub(super) fn figure(&self, held: &Held) -> Result<Vec<u8>, Refusal> {
        let mut arguments = vec![self.rule.clone(), "--output=-".into()];
        let is_own = |it: &&String| it.starts_with("--set=") || it.starts_with("--from=");
        arguments.extend(self.look.iter().filter(is_own).cloned());
        show::hold(&arguments, &self.source, &self.catalogue, held)?;
        Ok(held.take().bytes)
    }

    fn arguments(&self, view: &[String]) -> Vec<String> {
        let [width, height] = self.size;
        let mut arguments = vec![self.rule.clone()];
        arguments.extend(self.look.iter().cloned());
        arguments.push(format!("--size={width}x{height}"));
        arguments.extend(view.iter().cloned());
        arguments
    }

    /// Returns the command that writes the picture to a file.
    pub(super) fn command(&self, view: &[String]) -> String {
        let stem = std::path::Path::new(&self.rule).file_stem();
        let stem = stem.map_or("fractal".into(), |stem| stem.to_string_lossy());
        let mut words = vec!["kfrac".to_owned(), "grow".to_owned()];
        words.extend(self.arguments(view));
        words.push(format!("--output={stem}.png"));
        let quoted = words.iter().map(|word| crate::cli::labels::quoted(word));
        quoted.collect::<Vec<_>>().join(" ")
    }

    /// Returns the arguments of the view. A window that doubles do not hold is a zoom, relative to the picture of the
    /// whole set, whose width is found first.
    pub(super) fn view_arguments(&self, held: &Arc<Held>) -> Result<Vec<String>, Refusal> {
        let Some(view) = &self.view else {
            return Ok(Vec::new());
        };
        if view.is_plain() {
            return Ok(view.window(self.size, self.turn));
        }
        let key = self.arguments(&[]);
        if let Some(whole) = self.wholes.get(&key) {
            return Ok(view.zoom(whole));
        }
        let probe = [
            "--zoom=1".to_owned(),
            format!("--at={},{}", view.middle[0], view.middle[1]),
        ];
        let (_, done) = self.grown(&probe, held)?;
        let Some([_, _, whole, _]) = done.window else {
            return Err(Refusal::wrong("the set has no picture to zoom into"));
        };
        self.wholes.set(key, whole);
        Ok(view.zoom(whole))
    }
}

impl Wholes {
    fn get(&self, key: &[String]) -> Option<f64> {
        let known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        known.get(key).copied()
    }

    fn set(&self, key: Vec<String>, whole: f64) {
        const MOST: usize = 64;
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if known.len() >= MOST {
            known.clear();
        }
        known.insert(key, whole);
    }

    /// Forgets all widths, which depend on the text.
    pub(super) fn forget(&self) {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clear();
    }
}
