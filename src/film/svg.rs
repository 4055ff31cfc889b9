//! Films as SVG: one drawing whose attributes change, by animations of CSS (W3C, CSS Animations Level 1).
//!
//! Readers that ask for reduced motion see the first frame, or in a film that draws, the whole.

use std::fmt::Write as _;
use std::io::{self, Write};

use crate::render::{Labels, escaped};

use super::FilmOptions;

/// Elements of an SVG document, each a tag with its attributes in the order in which they are written.
struct Tag<'t> {
    /// Name with the slash of an end tag.
    name: &'t str,
    attributes: Vec<(&'t str, &'t str)>,
    /// Whether the tag has no content.
    is_empty: bool,
    /// Rules of a style sheet; empty in other tags.
    sheet: &'t str,
}

impl<'t> Tag<'t> {
    /// Reads the tags of a document of kfrac, from its root. Texts but style sheets are left out.
    fn read_all(document: &'t str) -> Vec<Self> {
        let parts = document.split('<').skip(1);
        let inside = parts.filter_map(|part| part.split_once('>'));
        let tag = |(inside, text)| {
            let tag = Self::read(inside);
            let sheet = if tag.name == "style" { text } else { "" };
            Self { sheet, ..tag }
        };
        inside.map(tag).collect()
    }

    fn read(inside: &'t str) -> Self {
        let is_empty = inside.ends_with('/') && !inside.starts_with('/');
        let inside = inside.strip_suffix('/').unwrap_or(inside);
        let (name, mut rest) = inside.split_once(' ').unwrap_or((inside, ""));
        let mut attributes = Vec::new();
        while let Some((name, after)) = rest.split_once("=\"") {
            let Some((value, after)) = after.split_once('"') else {
                break;
            };
            attributes.push((name.trim_start(), value));
            rest = after;
        }
        Self {
            name,
            attributes,
            is_empty,
            sheet: "",
        }
    }

    /// Returns the data of a path.
    fn data(&self) -> Option<&'t str> {
        let mut all = self.attributes.iter();
        all.find(|(name, _)| *name == "d").map(|(_, data)| *data)
    }

    /// Returns the subpaths of a path.
    fn lines(&self) -> Vec<&'t str> {
        self.data()
            .map_or_else(Vec::new, |data| subpaths(data).collect())
    }

    /// Iterates over the names of the attributes.
    fn names(&self) -> impl Iterator<Item = &'t str> {
        self.attributes.iter().map(|(name, _)| *name)
    }

    /// Returns the tag of a path with other data.
    fn with_data(&self, data: &'t str) -> Self {
        let attribute = |&(name, value): &(&'t str, &'t str)| match name {
            "d" => (name, data),
            _ => (name, value),
        };
        Self {
            attributes: self.attributes.iter().map(attribute).collect(),
            ..*self
        }
    }

    fn write(&self, style: &str, out: &mut String) {
        out.push('<');
        out.push_str(self.name);
        for (name, value) in &self.attributes {
            let _ = write!(out, " {name}=\"{value}\"");
        }
        out.push_str(style);
        out.push_str(if self.is_empty { "/>\n" } else { ">\n" });
        out.push_str(self.sheet);
    }
}

/// Tags that hold texts, which a film replaces by its own.
const TEXTS: [&str; 3] = ["title", "desc", "metadata"];

/// Returns the tags of a document that are drawn.
fn drawn<'t>(document: &'t str) -> Vec<Tag<'t>> {
    let is_text = |tag: &Tag<'_>| TEXTS.contains(&tag.name.trim_start_matches('/'));
    let mut tags = Tag::read_all(document);
    tags.retain(|tag| !is_text(tag));
    tags
}

/// Writes a film of drawings that have the same elements: `frames` are SVG documents. If the film `closes`, its last
/// frame passes over into the first one.
///
/// # Errors
///
/// If the frames have different elements, or if `out` fails.
pub(crate) fn write_frames(
    frames: &[Vec<u8>],
    options: &FilmOptions,
    closes: bool,
    out: &mut dyn Write,
) -> io::Result<()> {
    let documents: Vec<_> = frames
        .iter()
        .map(|it| String::from_utf8_lossy(it))
        .collect();
    let frames: Vec<Vec<Tag<'_>>> = documents.iter().map(|it| drawn(it)).collect();
    let Some((first, others)) = frames.split_first() else {
        return Ok(());
    };
    for (number, frame) in others.iter().enumerate() {
        if !are_alike(first, frame) {
            return Err(io::Error::new(
                io::ErrorKind::InvalidData,
                format!(
                    "frame {} does not have the lines of the first one, and an animated SVG moves lines: write a .gif or .png",
                    number + 1
                ),
            ));
        }
    }
    let mut film = Document::new(options);
    let last = others.last().unwrap_or(first);
    for (place, tag) in first.iter().enumerate() {
        let mut names = Vec::new();
        for (at, (name, _)) in tag.attributes.iter().enumerate() {
            let values = frames.iter().map(|frame| frame[place].attributes[at].1);
            let values: Vec<&str> = values.collect();
            if values.iter().all(|it| *it == values[0]) {
                continue;
            }
            let Some(property) = Property::of(name) else {
                let message = format!("an animated SVG cannot change the attribute {name}");
                return Err(io::Error::new(io::ErrorKind::InvalidData, message));
            };
            let end = if closes { first } else { last };
            let end = end[place].attributes[at].1;
            let key = film.keyframes(|frame| property.value(values[frame]), &property.value(end));
            let steps = match property.is_even(&values) {
                true => "linear",
                false => "step-end",
            };
            names.push(format!("{key} {steps}"));
        }
        let course = film.style(&names);
        tag.write(&course, &mut film.body);
        if place == 0 {
            film.head();
        }
    }
    film.write(out)
}

/// Writes a film that draws a document line by line, as a pen does: `shares` are those of the whole way, by frame. An area
/// is filled when its outline is complete. If the film `closes`, its last frame passes over into the first one.
///
/// # Errors
///
/// If `out` fails.
pub(crate) fn write_drawn(
    document: &[u8],
    shares: &[f64],
    options: &FilmOptions,
    closes: bool,
    out: &mut dyn Write,
) -> io::Result<()> {
    let document = String::from_utf8_lossy(document);
    let tags = drawn(&document);
    let lines = tags.iter().flat_map(Tag::lines);
    let length: f64 = lines.map(length_of).sum();
    let mut film = Document::new(options);
    let mut way = 0.0;
    for (place, tag) in tags.iter().enumerate() {
        if tag.data().is_none() {
            tag.write("", &mut film.body);
        }
        if place == 0 {
            film.head();
        }
        for line in tag.lines() {
            let own = length_of(line);
            let ends = [way / length, (way + own) / length];
            way += own;
            let state = |share: f64| state(share, ends);
            let last = if closes {
                shares[0]
            } else {
                shares[shares.len() - 1]
            };
            let key = film.keyframes(|frame| state(shares[frame]), &state(last));
            let style = format!(
                r#" pathLength="1" stroke-dasharray="1"{}"#,
                film.style(&[format!("{key} linear")])
            );
            tag.with_data(line).write(&style, &mut film.body);
        }
    }
    film.write(out)
}

/// Returns the declarations for a line between two shares of the way, of which a share is drawn.
fn state(share: f64, [start, end]: [f64; 2]) -> String {
    if share <= start && share < 1.0 {
        return "visibility:hidden;stroke-dashoffset:1;fill-opacity:0".into();
    }
    if share >= end {
        return "visibility:visible;stroke-dashoffset:0;fill-opacity:1".into();
    }
    let left = (end - share) / (end - start);
    format!(
        "visibility:visible;stroke-dashoffset:{};fill-opacity:0",
        plain(left)
    )
}

/// Iterates over the subpaths of path data, each of which begins at an absolute position.
fn subpaths(data: &str) -> impl Iterator<Item = &str> {
    let mut starts: Vec<usize> = data.match_indices('M').map(|(at, _)| at).collect();
    starts.push(data.len());
    let ends: Vec<usize> = starts[1..].to_vec();
    let ranges = starts.into_iter().zip(ends);
    ranges.map(move |(from, to)| data[from..to].trim_end())
}

/// Returns the length of a subpath; that of a curve is the mean of its chord and its control polygon (Gravesen 1997, with
/// the weights of a cubic curve).
fn length_of(subpath: &str) -> f64 {
    let mut length = 0.0;
    let mut at = [0.0; 2];
    let mut start = at;
    let far = |from: [f64; 2], to: [f64; 2]| libm::hypot(to[0] - from[0], to[1] - from[1]);
    for (command, numbers) in path_data(subpath) {
        let points = numbers.as_chunks::<2>().0;
        let place =
            |point: &[f64; 2], origin: [f64; 2]| [point[0] + origin[0], point[1] + origin[1]];
        match command {
            'M' => {
                at = points.first().copied().unwrap_or_default();
                start = at;
            }
            'c' => {
                for curve in points.as_chunks::<3>().0 {
                    let [a, b, to] = curve.each_ref().map(|it| place(it, at));
                    let polygon = far(at, a) + far(a, b) + far(b, to);
                    length += f64::midpoint(far(at, to), polygon);
                    at = to;
                }
            }
            'z' => {
                length += far(at, start);
                at = start;
            }
            'l' | 'L' => {
                for point in points {
                    let to = match command {
                        'l' => place(point, at),
                        _ => *point,
                    };
                    length += far(at, to);
                    at = to;
                }
            }
            _ => {}
        }
    }
    length
}

/// Returns whether two drawings have the same elements with the same attributes.
fn are_alike(a: &[Tag<'_>], b: &[Tag<'_>]) -> bool {
    a.len() == b.len()
        && a.iter()
            .zip(b)
            .all(|(a, b)| a.name == b.name && a.names().eq(b.names()))
}

/// Property of CSS that an attribute sets.
#[derive(Clone, Copy)]
enum Property<'n> {
    /// Data of a path.
    Path,
    /// Map of coordinates.
    Transform,
    /// Any other attribute that is a property.
    Plain(&'n str),
}

impl<'n> Property<'n> {
    /// Returns the property of an attribute; `None` if CSS has none.
    fn of(name: &'n str) -> Option<Self> {
        match name {
            "d" => Some(Self::Path),
            "transform" => Some(Self::Transform),
            "fill" | "stroke" | "stroke-width" | "fill-opacity" | "stroke-opacity" | "opacity" => {
                Some(Self::Plain(name))
            }
            _ => None,
        }
    }

    /// Returns the declaration of a value.
    fn value(self, value: &str) -> String {
        match self {
            Self::Path => format!("d:path(\"{}\")", value.replace('\n', " ")),
            Self::Transform => format!("transform:{}", with_units(value)),
            Self::Plain(name) => format!("{name}:{value}"),
        }
    }

    /// Returns whether values pass over into each other: path data with the same commands does.
    fn is_even(self, values: &[&str]) -> bool {
        match self {
            Self::Path => {
                let first = commands(values[0]);
                values.iter().all(|it| commands(it) == first)
            }
            Self::Transform | Self::Plain(_) => true,
        }
    }
}

/// Returns the commands of path data, each with the number of its numbers.
fn commands(data: &str) -> Vec<(char, usize)> {
    path_data(data)
        .map(|(command, numbers)| (command, numbers.len()))
        .collect()
}

/// Iterates over the commands of path data with their numbers.
fn path_data(data: &str) -> impl Iterator<Item = (char, Vec<f64>)> {
    let starts = data
        .char_indices()
        .filter(|(_, it)| it.is_ascii_alphabetic());
    let starts: Vec<(usize, char)> = starts.collect();
    let ends: Vec<usize> = { starts.iter().skip(1) }
        .map(|it| it.0)
        .chain([data.len()])
        .collect();
    let parts = starts.into_iter().zip(ends);
    let parts: Vec<_> = parts
        .map(|((at, command), end)| (command, numbers(&data[at + 1..end])))
        .collect();
    parts.into_iter()
}

/// Returns the numbers of a text, which a minus separates too.
fn numbers(text: &str) -> Vec<f64> {
    let spaced = text.replace('-', " -");
    let all = spaced.split(|it: char| it.is_whitespace() || it == ',');
    all.filter_map(|it| it.parse().ok()).collect()
}

/// Returns a transform of SVG as one of CSS: lengths have units.
fn with_units(transform: &str) -> String {
    let mut text = String::new();
    for part in transform.split_inclusive(')') {
        let Some((name, inside)) = part.split_once('(') else {
            continue;
        };
        let unit = match name.trim() {
            "translate" => "px",
            "rotate" | "skewX" | "skewY" => "deg",
            _ => "",
        };
        let all = numbers(inside.trim_end_matches(')'));
        let all: Vec<_> = all.iter().map(|it| format!("{it}{unit}")).collect();
        let _ = write!(text, "{}({})", name.trim(), all.join(","));
    }
    text
}

/// Document of a film that is being written.
struct Document<'o> {
    options: &'o FilmOptions,
    /// Rules of the style sheet.
    rules: String,
    /// Number of animations.
    count: usize,
    body: String,
    /// Place in the body at which the head belongs.
    at_head: usize,
    /// Number of seconds.
    seconds: f64,
}

impl<'o> Document<'o> {
    fn new(options: &'o FilmOptions) -> Self {
        let rate = options.rate;
        Self {
            options,
            rules: String::new(),
            count: 0,
            body: String::new(),
            at_head: 0,
            seconds: f64::from(options.frames) * f64::from(rate.seconds) / f64::from(rate.frames),
        }
    }

    /// Notes the place at which the head belongs.
    fn head(&mut self) {
        self.at_head = self.body.len();
    }

    /// Adds the key frames of one property, and returns their name. Successive equal values are left out.
    fn keyframes(&mut self, value: impl Fn(usize) -> String, end: &str) -> String {
        let frames = self.options.frames as usize;
        let name = format!("k{}", self.count);
        self.count += 1;
        let _ = write!(self.rules, "@keyframes {name}{{");
        let mut before = String::new();
        let all: Vec<String> = (0..frames).map(value).collect();
        for (frame, own) in all.iter().enumerate() {
            let after = all.get(frame + 1).map_or(end, String::as_str);
            if *own == before && *own == *after {
                continue;
            }
            let _ = write!(self.rules, "{}{{{own}}}", percent(frame, frames));
            before.clone_from(own);
        }
        let _ = writeln!(self.rules, "100%{{{end}}}}}");
        name
    }

    /// Returns the attribute by which an element takes part in animations: their names, each with its course.
    fn style(&self, names: &[String]) -> String {
        if names.is_empty() {
            return String::new();
        }
        let count = if self.options.repeats {
            "infinite"
        } else {
            "both"
        };
        let seconds = plain(self.seconds);
        let all = names.iter().map(|it| format!("{it} {seconds}s {count}"));
        let all: Vec<_> = all.collect();
        format!(r#" class="moving" style="animation:{}""#, all.join(","))
    }

    /// Writes the document.
    fn write(self, out: &mut dyn Write) -> io::Result<()> {
        let Labels {
            title,
            description,
            provenance,
        } = &self.options.labels;
        let (before, after) = self.body.split_at(self.at_head);
        write!(
            out,
            "{before}<title>{}</title>\n<desc>{}</desc>\n",
            escaped(title),
            escaped(description)
        )?;
        write!(out, "<metadata>\n{}</metadata>\n", escaped(provenance))?;
        write!(
            out,
            "<style>\n{}@media (prefers-reduced-motion:reduce){{.moving{{animation:none!important}}}}\n</style>\n{after}",
            self.rules
        )
    }
}

/// Returns the time of a frame as a percentage.
fn percent(frame: usize, frames: usize) -> String {
    #[expect(clippy::cast_precision_loss, reason = "a film has few frames")]
    let share = 100.0 * frame as f64 / frames as f64;
    format!("{}%", plain(share))
}

/// Formats a number with at most four decimals.
fn plain(value: f64) -> String {
    let text = format!("{value:.4}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    text.to_owned()
}

#[cfg(test)]
mod tests;
