//! Genes of curves by edge replacement, on the lattices of the Gaussian and the Eisenstein integers.
//!
//! A gene, such as `E 1 1 0 0 0 -1 0 0 1 1 0 0`, states the lattice, G or E, and four integers for each segment of a
//! generator: its vector a + b i or a + b ω with ω = exp(2πi/3), whether it is walked backwards, by a half turn, and whether
//! it is reflected (J. Ventrella, "The Family Tree of Fractal Curves", 2019). Each line of a text is a gene, with a name
//! before a colon; commas, semicolons and parentheses are blanks, and `#` begins a comment. A JSON list of objects with
//! `name` and `gene` is read too, as the presets of the add-on Fractal Family for Blender are written.

use std::path::Path;
use std::sync::Arc;

use crate::build::written::Entries;
use crate::diagnostic::{Diagnostic, Diagnostics, Place, Source};
use crate::document::node::{Node, Value};
use crate::geometry::Direction;

use super::Imported;
use super::curve::{self, Element};
use super::document::{Heading, file_of};
use super::lattice::Lattice;
use super::words::words;

/// Largest number of segments.
const MAX_SEGMENTS: usize = 1000;

/// Largest component of the vector of a segment: products of sums of them are exact.
const MAX_SIZE: i64 = 1000;

/// Numbers of a segment.
const SEGMENT: &str =
    "a segment is a b r m: its vector, 1 if it is walked backwards, 1 if it is reflected";

/// A segment of a generator.
struct Segment {
    vector: [i64; 2],
    direction: Direction,
    place: Place,
}

/// Reads the genes of a text; lines without one are reported.
pub(super) fn read(source: &Arc<Source>) -> (Vec<Imported>, Diagnostics) {
    let mut stray = Diagnostics::default();
    let stem = file_of(source).and_then(Path::file_stem);
    let stem = stem.map_or_else(
        || "curve".into(),
        |stem| stem.to_string_lossy().into_owned(),
    );
    let is_json = source.text().trim_start().starts_with(['[', '{']);
    let genes = match is_json {
        true => of_json(source, &mut stray),
        false => of_lines(source),
    };
    let imported = genes.into_iter().map(|(name, place)| {
        let mut found = Diagnostics::default();
        let converted = converted(&place, &mut found);
        let (about, own) =
            converted.map_or_else(Default::default, |(about, own)| (about, Some(own)));
        let heading = Heading {
            name: name.as_ref().unwrap_or(&stem),
            place: &place,
            about: &about,
            origin: "a gene of J. Ventrella's taxonomy",
        };
        heading.imported(own, found)
    });
    (imported.collect(), stray)
}

/// Returns the genes of a JSON list of objects, or of one object, with their names.
fn of_json(source: &Arc<Source>, stray: &mut Diagnostics) -> Vec<(Option<String>, Place)> {
    let node = match Node::parse(source) {
        Ok(node) => node,
        Err(mistakes) => {
            stray.extend(mistakes.iter().cloned());
            return Vec::new();
        }
    };
    let nodes = match &node.value {
        Value::Sequence(nodes) => &nodes[..],
        _ => std::slice::from_ref(&node),
    };
    let gene = |node: &Node| {
        let text = |key| match node.get(key) {
            Some(Node {
                value: Value::Text(text),
                place,
            }) => Some((text, place)),
            _ => None,
        };
        let Some((_, place)) = text("gene") else {
            let none = Diagnostic::error("this has no gene").at(&node.place.first_line());
            stray.push(
                none.hint("a curve is {\"name\": \"Dragon\", \"gene\": \"G 1 0 0 0 0 1 1 0\"}"),
            );
            return None;
        };
        let name = text("name").map(|(name, _)| name.trim().to_owned());
        Some((name.filter(|name| !name.is_empty()), place.clone()))
    };
    nodes.iter().filter_map(gene).collect()
}

/// Returns the genes of the lines of a text, with the names before their colons.
fn of_lines(source: &Arc<Source>) -> Vec<(Option<String>, Place)> {
    let text = source.text();
    let mut start = 0;
    let lines = text.split(['\n', '\r']).filter_map(|line| {
        let here = start;
        start += line.len() + 1;
        let content = line.split('#').next().unwrap_or_default().trim_end();
        let (name, before) = match content.rfind(':') {
            Some(colon) => (content[..colon].trim(), colon + 1),
            None => ("", 0),
        };
        let gene = &content[before..];
        let begin = here + before + gene.len() - gene.trim_start().len();
        let place = Place::new(source, begin..here + content.len());
        let name = name.trim_matches('"');
        let name = (!name.is_empty()).then(|| name.to_owned());
        (!content.is_empty()).then_some((name, place))
    });
    lines.collect()
}

/// Returns a description of a gene, and the keys of its document.
fn converted(place: &Place, found: &mut Diagnostics) -> Option<(String, Entries)> {
    let (lattice, segments) = segments(place, found)?;
    let mut ends = Vec::new();
    let mut end = [0, 0];
    for segment in &segments {
        end = [end[0] + segment.vector[0], end[1] + segment.vector[1]];
        ends.push(end);
    }
    let norm = lattice.norm(end);
    let (name, [a, b]) = (lattice.name(), end);
    for segment in &segments {
        let own = lattice.norm(segment.vector);
        if own >= norm || own == 0 {
            let message = match own {
                0 => "this segment has no length".to_owned(),
                _ => format!(
                    "this segment is not shorter than the curve, which is of the family {name}({a}, {b})"
                ),
            };
            found.push(Diagnostic::error(message).at(&segment.place));
        }
    }
    let elements = segments.iter().zip(ends).map(|(segment, at)| Element {
        to: lattice.point(lattice.times_conjugate(at, end), norm),
        direction: segment.direction,
        is_fertile: true,
        is_visible: true,
    });
    let own = curve::rule(elements.collect());
    let about = format!(
        "Family {name}({a}, {b}) of norm {norm}, gene {}.",
        place.text().trim()
    );
    Some((about, own))
}

/// Returns the lattice and the segments of a gene; `None` if it is not read.
fn segments(place: &Place, found: &mut Diagnostics) -> Option<(Lattice, Vec<Segment>)> {
    let words = words(place, |c| c.is_whitespace() || ",;()".contains(c));
    let lattice = words.first().and_then(|word| match word.text() {
        "G" | "g" => Some(Lattice::Gaussian),
        "E" | "e" => Some(Lattice::Eisenstein),
        _ => None,
    });
    let Some(lattice) = lattice else {
        let first = words.first().unwrap_or(place);
        let unknown = Diagnostic::error("a gene begins with its lattice").at(first);
        found.push(
            unknown.hint("G is that of the Gaussian integers, E that of the Eisenstein integers"),
        );
        return None;
    };
    let numbers = &words[1..];
    let rest = numbers.len() % 4;
    if rest != 0 || numbers.is_empty() {
        let at = numbers.len() - rest;
        let last = numbers.get(at).unwrap_or(place);
        let message = match numbers.is_empty() {
            true => "this gene has no segments".to_owned(),
            false => format!("the last segment has {rest} of 4 numbers"),
        };
        found.push(Diagnostic::error(message).at(last).hint(SEGMENT));
        return None;
    }
    if numbers.len() / 4 > MAX_SEGMENTS {
        let message = format!("this gene has more than {MAX_SEGMENTS} segments");
        found.push(Diagnostic::error(message).at(place));
        return None;
    }
    let mut number = |word: &Place, range: std::ops::RangeInclusive<i64>| {
        let number = word.text().parse().ok().filter(|it| range.contains(it));
        if number.is_none() {
            let (least, most) = (range.start(), range.end());
            let message = format!(
                "'{}' is no whole number from {least} to {most}",
                word.text()
            );
            found.push(Diagnostic::error(message).at(word).hint(SEGMENT));
        }
        number
    };
    let segments: Vec<Option<Segment>> = numbers
        .chunks_exact(4)
        .map(|words| {
            let sizes = [0, 1].map(|at: usize| number(&words[at], -MAX_SIZE..=MAX_SIZE));
            let flags = [2, 3].map(|at: usize| number(&words[at], 0..=1));
            let direction = match (flags[0]?, flags[1]?) {
                (0, 0) => Direction::Normal,
                (0, _) => Direction::YReflected,
                (_, 0) => Direction::BothReflected,
                (..) => Direction::XReflected,
            };
            let span = words[0].range().start..words[3].range().end;
            Some(Segment {
                vector: [sizes[0]?, sizes[1]?],
                direction,
                place: Place::new(place.source(), span),
            })
        })
        .collect();
    let segments: Option<Vec<Segment>> = segments.into_iter().collect();
    Some((lattice, segments?))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests;
