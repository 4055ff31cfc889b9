//! Templates of FractaSketch, a program by P. Van Roy, as its later version by D. Loehr writes them (`.fsk`).
//!
//! A template is a point `x y`, and lines `t x y` from the point before; y points down. Copies of the template replace its
//! lines: its base line, from the first point to the last, is laid on a line of the type t = 1 as it is, 2 reflected, 3
//! reflected and from the end to the start, 4 by a half turn from the end to the start. Lines of type 5 are drawn and kept,
//! those of type 6 are neither drawn nor replaced.

use std::path::Path;
use std::sync::Arc;

use crate::build::PointText;
use crate::build::written::Entries;
use crate::diagnostic::{Diagnostic, Diagnostics, Place, Source};
use crate::geometry::{DVec2, Direction};

use super::Imported;
use super::curve::{self, Element};
use super::document::{Heading, file_of};
use super::lattice::Lattice;
use super::words::words;

/// Largest number of lines.
const MAX_LINES: usize = 10_000;

/// Largest coordinate, in pixels.
const MAX_COORDINATE: f64 = 1e6;

/// A line of a template to a point, in coordinates with y upwards.
struct Line {
    kind: u8,
    to: DVec2,
    place: Place,
}

/// Reads a template as one entry with the name of its file; an empty text has no entries.
pub(super) fn read(source: &Arc<Source>) -> (Vec<Imported>, Diagnostics) {
    let whole = Place::new(source, 0..source.text().len());
    let words = words(&whole, char::is_whitespace);
    let Some(first) = words.first() else {
        return (Vec::new(), Diagnostics::default());
    };
    let stem = file_of(source).and_then(Path::file_stem);
    let stem = stem.map_or_else(|| "template".into(), |stem| stem.to_string_lossy());
    let mut found = Diagnostics::default();
    let own = converted(&words, &mut found);
    let heading = Heading {
        name: &stem,
        place: first,
        about: "",
        origin: "for FractaSketch",
    };
    (vec![heading.imported(own, found)], Diagnostics::default())
}

fn converted(words: &[Place], found: &mut Diagnostics) -> Option<Entries> {
    let (start, lines) = template(words, found)?;
    let end = lines.last()?.to;
    let base = end - start;
    if base == DVec2::ZERO {
        let place = &lines.last()?.place;
        let closed = Diagnostic::error("the template ends where it begins: it has no base line");
        found.push(closed.at(place));
        return None;
    }
    let mut from = start;
    for line in &lines {
        let length = line.to.distance(from);
        from = line.to;
        if line.kind < 5 && length >= base.length() {
            let long = "this line is replaced, and not shorter than the base line";
            let long = Diagnostic::error(long).at(&line.place);
            found.push(long.hint("type 5 is a line that is kept, and 6 one that is not drawn"));
        }
    }
    if lines.iter().all(|line| line.kind >= 5) {
        found.push(Diagnostic::error("no line is replaced").at(&words[0]));
    }
    let elements = lines.iter().map(|line| Element {
        to: placed(line.to - start, base),
        direction: match line.kind {
            2 => Direction::YReflected,
            3 => Direction::XReflected,
            4 => Direction::BothReflected,
            _ => Direction::Normal,
        },
        is_fertile: line.kind < 5,
        is_visible: line.kind < 6,
    });
    Some(curve::rule(elements.collect()))
}

/// Returns the point of a template whose base line is the unit segment: exactly, where coordinates are whole.
fn placed(point: DVec2, base: DVec2) -> crate::document::node::Value {
    let is_whole = |point: DVec2| point == point.round();
    if is_whole(point) && is_whole(base) {
        #[expect(clippy::cast_possible_truncation, reason = "coordinates are limited")]
        let [point, base] = [point, base].map(|it| [it.x as i64, it.y as i64]);
        let lattice = Lattice::Gaussian;
        return lattice.point(lattice.times_conjugate(point, base), lattice.norm(base));
    }
    let quotient = point.rotate(DVec2::new(base.x, -base.y)) / base.length_squared();
    PointText::from(quotient).0
}

/// Returns the first point and the lines of a template.
fn template(words: &[Place], found: &mut Diagnostics) -> Option<(DVec2, Vec<Line>)> {
    let (point, rest) = words.split_at_checked(2).unwrap_or((words, &[]));
    let rows = rest.chunks_exact(3);
    let last = rows.remainder().first().or_else(|| words.first());
    if point.len() < 2 || rest.is_empty() || !rows.remainder().is_empty() {
        let message = match rest.len() % 3 {
            0 => "this template has no lines".to_owned(),
            count => format!("the last line has {count} of 3 numbers"),
        };
        let few = last.map(|place| Diagnostic::error(message).at(place));
        found.extend(few.map(|it| {
            it.hint("a template is a point x y, and lines of a type and a point, t x y")
        }));
        return None;
    }
    if rows.len() > MAX_LINES {
        let message = format!("this template has more than {MAX_LINES} lines");
        found.push(Diagnostic::error(message).at(&rest[0]));
        return None;
    }
    let mut coordinate = |word: &Place| {
        let value = word.text().parse::<f64>().ok();
        let value = value.filter(|it| it.abs() <= MAX_COORDINATE);
        if value.is_none() {
            let message = format!("'{}' is no coordinate up to {MAX_COORDINATE}", word.text());
            found.push(Diagnostic::error(message).at(word));
        }
        value
    };
    let start = [0, 1].map(|at: usize| coordinate(&point[at]));
    let places = rows
        .clone()
        .map(|row| [1, 2].map(|at: usize| coordinate(&row[at])));
    let places: Vec<_> = places.collect();
    let kinds: Vec<_> = rows.clone().map(|row| kind(&row[0], found)).collect();
    let point = |[x, y]: [Option<f64>; 2]| Some(DVec2::new(x?, -y?));
    let lines = rows.zip(places).zip(kinds).map(|((row, at), kind)| {
        let span = row[0].range().start..row[2].range().end;
        Some(Line {
            kind: kind?,
            to: point(at)?,
            place: Place::new(row[0].source(), span),
        })
    });
    Some((point(start)?, lines.collect::<Option<_>>()?))
}

fn kind(word: &Place, found: &mut Diagnostics) -> Option<u8> {
    let kind = word
        .text()
        .parse()
        .ok()
        .filter(|kind| (1..=6).contains(kind));
    if kind.is_none() {
        let message = format!("'{}' is no type of a line from 1 to 6", word.text());
        found.push(Diagnostic::error(message).at(word));
    }
    kind
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests;
