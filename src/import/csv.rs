//! Tables of affine maps: a map in each row, its numbers in columns.
//!
//! A column holds one of the numbers of a map by its letter: in the plane x' = a x + b y + e and y' = c x + d y + f, in
//! space x' = a x + b y + c z + j, y' = d x + e y + f z + k and z' = g x + h y + i z + l, with the probability p.
//! [`MapColumns`] or the header of the table state the order.

use std::ffi::OsStr;
use std::ops::Range;
use std::path::Path;
use std::str::FromStr;
use std::sync::Arc;

use crate::build::NumberText;
use crate::diagnostic::{Diagnostic, Diagnostics, Place, Source};

use super::Imported;
use super::document::{Heading, file_of};
use super::maps::{Layout, System};

/// Letter of the probability of a map.
const PROBABILITY: char = 'p';

/// Other names of the column of probabilities in a header.
const PROBABILITIES: [&str; 4] = ["prob", "probability", "weight", "w"];

/// Columns of a table of maps, by their letters.
///
/// Read from a text such as `abcdefp`, `acbdef` (the order of SVG's `matrix()`, and of flam3) or `abecdf` (x' and y' one
/// after the other). A `-` stands for a column that is left out; commas and blanks have no meaning.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MapColumns {
    layout: Layout,
    /// Index of each letter of the layout among the columns, the probability last.
    places: Vec<Option<usize>>,
    /// Number of columns.
    count: usize,
}

/// A mistake in the columns of a table.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ColumnsError {
    /// A character is no letter of a number of a map.
    #[error("'{0}' is none of the columns a to f and p, in space a to l and p")]
    Unknown(String),
    /// A letter occurs more than once.
    #[error("there are two columns '{0}'")]
    Twice(char),
    /// Letters of a map are missing.
    #[error("there is no column {0}")]
    Missing(String),
}

impl FromStr for MapColumns {
    type Err = ColumnsError;

    fn from_str(text: &str) -> Result<Self, ColumnsError> {
        let columns = text.chars().filter(|c| !c.is_whitespace() && *c != ',');
        let columns = columns.map(|letter| match letter {
            '-' => Ok(None),
            letter if Layout::SPACE.letters.contains(letter) || letter == PROBABILITY => {
                Ok(Some(letter))
            }
            other => Err(ColumnsError::Unknown(other.to_string())),
        });
        Self::new(&columns.collect::<Result<Vec<_>, _>>()?)
    }
}

impl MapColumns {
    fn new(columns: &[Option<char>]) -> Result<Self, ColumnsError> {
        let is_in_space = |letter: &char| ('g'..='l').contains(letter);
        let layout = match columns.iter().flatten().any(is_in_space) {
            true => Layout::SPACE,
            false => Layout::PLANE,
        };
        let letters = layout.letters.chars().chain([PROBABILITY]);
        let place = |letter: char| {
            let mut places = (0..columns.len()).filter(|it| columns[*it] == Some(letter));
            match (places.next(), places.next()) {
                (_, Some(_)) => Err(ColumnsError::Twice(letter)),
                (place, None) => Ok(place),
            }
        };
        let places: Vec<_> = letters.clone().map(place).collect::<Result<_, _>>()?;
        let missing = letters.zip(&places).filter(|(_, place)| place.is_none());
        let missing = missing.map(|(letter, _)| letter);
        let missing: Vec<_> = missing
            .filter(|it| *it != PROBABILITY)
            .map(String::from)
            .collect();
        match missing.is_empty() {
            true => Ok(Self {
                layout,
                places,
                count: columns.len(),
            }),
            false => Err(ColumnsError::Missing(missing.join(", "))),
        }
    }

    /// Returns the columns of a table that does not state them, by their number.
    fn usual(count: usize) -> Option<Self> {
        let mut layouts = [Layout::PLANE, Layout::SPACE].into_iter();
        let layout = layouts.find(|layout| (count - 1..=count).contains(&layout.numbers()))?;
        let letters = layout.letters.chars().chain([PROBABILITY]);
        Self::new(&letters.take(count).map(Some).collect::<Vec<_>>()).ok()
    }

    /// Returns the columns that a header names; names without a meaning are reported, and their columns left out.
    fn of_header(header: &Row, found: &mut Diagnostics) -> Option<Self> {
        let column = |field: &Place| {
            let name = field.text().to_ascii_lowercase();
            let mut letters = name.chars();
            match (letters.next(), letters.next()) {
                _ if PROBABILITIES.contains(&&name[..]) => Some(PROBABILITY),
                (Some(letter), None) => (Layout::SPACE.letters.contains(letter)
                    || letter == PROBABILITY)
                    .then_some(letter),
                _ => None,
            }
        };
        let columns: Vec<_> = header.fields.iter().map(column).collect();
        match Self::new(&columns) {
            Ok(known) => {
                for (field, _) in header
                    .fields
                    .iter()
                    .zip(columns)
                    .filter(|it| it.1.is_none())
                {
                    let message = format!("the column '{}' is left out", field.text());
                    found.push(Diagnostic::warning(message).at(field));
                }
                Some(known)
            }
            Err(mistake) => {
                let mistake = Diagnostic::error(mistake.to_string()).at(&header.place);
                found.push(mistake.hint(
                    "columns are a b c d e f and p, for x' = a x + b y + e and y' = c x + d y + f: \
                     --columns names them in their order",
                ));
                None
            }
        }
    }
}

/// A row of a table.
struct Row {
    place: Place,
    fields: Vec<Place>,
}

/// Reads a table as one entry with the name of its file; a text without rows has no entries.
pub(super) fn read(
    source: &Arc<Source>,
    columns: Option<&MapColumns>,
) -> (Vec<Imported>, Diagnostics) {
    let mut rows = rows(source).peekable();
    let Some(first) = rows.peek() else {
        return (Vec::new(), Diagnostics::default());
    };
    let place = first.place.clone();
    let stem = file_of(source).and_then(Path::file_stem);
    let name = stem.map_or_else(|| "maps".into(), OsStr::to_string_lossy);
    let mut found = Diagnostics::default();
    let header = rows.next_if(|row| row.fields.iter().all(|field| number(field).is_none()));
    let columns = match (columns, header, rows.peek()) {
        (Some(columns), ..) => Some(columns.clone()),
        (None, Some(header), _) => MapColumns::of_header(&header, &mut found),
        (None, None, Some(row)) => unstated(row, &mut found),
        (None, None, None) => None,
    };
    let own = columns.map(|columns| {
        let mut system = System::new(columns.layout);
        for row in rows {
            add(&mut system, &row, &columns, &mut found);
        }
        system.entries(&name, &place, &mut found)
    });
    let heading = Heading {
        name: &name,
        place: &place,
        about: "",
        origin: "a table of maps",
    };
    (vec![heading.imported(own, found)], Diagnostics::default())
}

/// Returns the columns of a table without a header, which are reported.
fn unstated(row: &Row, found: &mut Diagnostics) -> Option<MapColumns> {
    let count = row.fields.len();
    let columns = MapColumns::usual(count);
    let order = match &columns {
        Some(columns) if count > columns.layout.numbers() => {
            format!("{}{PROBABILITY}", columns.layout.letters)
        }
        Some(columns) => columns.layout.letters.into(),
        None => {
            let message = format!("this row has {count} columns, and a map has 6 or 7");
            let message = Diagnostic::error(message).at(&row.place);
            found.push(message.hint(
                "maps are a b c d e f and p, in space a to l and p: --columns names the columns, with - for those \
                 that are left out",
            ));
            return None;
        }
    };
    let message = format!("the order of the columns is not stated: {order} is assumed");
    let hint = "--columns states it; acbdef is the order of SVG and flam3, abecdf has x' before y'";
    found.push(Diagnostic::warning(message).at(&row.place).hint(hint));
    columns
}

/// Adds the map of a row to a system.
fn add(system: &mut System, row: &Row, columns: &MapColumns, found: &mut Diagnostics) {
    let count = row.fields.len();
    if count != columns.count {
        let message = format!("this row has {count} columns, not {}", columns.count);
        found.push(Diagnostic::error(message).at(&row.place));
        return;
    }
    let mut numbers = Vec::new();
    for field in columns.places.iter().flatten().map(|at| &row.fields[*at]) {
        match number(field) {
            Some(value) => numbers.push((value, field)),
            None => {
                let wrong = Diagnostic::error(format!("'{}' is not a number", field.text()));
                found.push(
                    wrong
                        .at(field)
                        .hint("numbers are finite, as in 0.5, -1e-3 or 1/3"),
                );
            }
        }
    }
    let expected = columns.places.iter().flatten().count();
    if numbers.len() < expected {
        return;
    }
    let weight = (expected > columns.layout.numbers()).then(|| numbers.pop());
    let weight = weight.flatten().map(|((value, _), place)| (value, place));
    let map = numbers.into_iter().map(|((_, text), _)| text);
    system.push(map.collect(), weight, found);
}

/// Returns the value of a field, a number or a quotient of numbers, with the number as written in a file.
fn number(field: &Place) -> Option<(f64, NumberText)> {
    let finite = |text: &str| {
        let is_written = text.bytes().all(|byte| b"+-.0123456789eE".contains(&byte));
        let number: f64 = text.parse().ok().filter(|_| is_written)?;
        number.is_finite().then_some(number)
    };
    let text = field.text();
    match text.split_once('/') {
        None => finite(text).map(|value| (value, value.into())),
        Some((above, below)) => {
            let (above, below) = (finite(above.trim())?, finite(below.trim())?);
            let value = above / below;
            let exact = format!("{above}/{below}");
            value.is_finite().then(|| (value, exact.into()))
        }
    }
}

/// Iterates over the rows of a text, without comments from `#` on, and without empty rows.
fn rows(source: &Arc<Source>) -> impl Iterator<Item = Row> + '_ {
    let text = source.text();
    let mut start = 0;
    let lines = text.split(['\n', '\r']).map(move |line| {
        let range = start..start + line.len();
        start = range.end + 1;
        range
    });
    lines.filter_map(move |range| {
        let line = &text[range.clone()];
        let commented = line.find('#').unwrap_or(line.len());
        let line = trimmed(text, range.start..range.start + commented);
        (!line.is_empty()).then(|| Row {
            fields: fields(source, line.clone()),
            place: Place::new(source, line),
        })
    })
}

/// Returns the fields of a row, which commas separate, or else semicolons, or tabs, or blanks; without their quotes.
fn fields(source: &Arc<Source>, row: Range<usize>) -> Vec<Place> {
    let text = &source.text()[row.clone()];
    let separator = [',', ';', '\t'].into_iter().find(|it| text.contains(*it));
    let mut start = row.start;
    let is_end = |c: char| match separator {
        Some(separator) => c == separator,
        None => c.is_whitespace(),
    };
    let fields = text.split_inclusive(is_end).map(|field| {
        let length = field.trim_end_matches(is_end).len();
        let range = start..start + length;
        start += field.len();
        range
    });
    let mut fields: Vec<_> = fields.collect();
    if separator.is_none() {
        fields.retain(|field| !field.is_empty());
    } else if text.ends_with(is_end) {
        fields.push(row.end..row.end);
    }
    let fields = fields.into_iter().map(|field| {
        let field = trimmed(source.text(), field);
        let inner = &source.text()[field.clone()];
        let quoted = inner.len() >= 2 && inner.starts_with('"') && inner.ends_with('"');
        let field = match quoted {
            true => trimmed(source.text(), field.start + 1..field.end - 1),
            false => field,
        };
        Place::new(source, field)
    });
    fields.collect()
}

/// Returns a range of a text without the blanks at its ends.
fn trimmed(text: &str, range: Range<usize>) -> Range<usize> {
    let part = &text[range.clone()];
    let start = range.start + part.len() - part.trim_start().len();
    start..start + part.trim().len()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests;
