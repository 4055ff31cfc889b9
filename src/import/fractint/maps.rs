//! Conversion of Fractint's systems of maps: rows of `a b c d e f p`, for x' = a x + b y + e and y' = c x + d
//! y + f.

use crate::build::NumberText;
use crate::build::written::{Entries, sequence};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::node::Value;

use super::entries::{Entry, Word};

/// The number of numbers in a row: matrix, translation and probability.
const ROW: usize = 7;

pub(super) fn write(entry: &Entry, found: &mut Diagnostics) -> Option<Entries> {
    if let Some(remark) = &entry.remark {
        let message = if remark.eq_ignore_ascii_case("3d") {
            "the maps are of space".to_owned()
        } else {
            format!("'({remark})' is not understood")
        };
        found.push(Diagnostic::error(message).at(&entry.place));
        return None;
    }
    let numbers = entry.words.iter().filter_map(|word| {
        let number = number(word);
        if number.is_none() {
            let message = format!("'{}' is not a number", word.written());
            found.push(Diagnostic::error(message).at(&word.place));
        }
        Some((word, number?))
    });
    let numbers: Vec<_> = numbers.collect();
    let (rows, rest) = numbers.as_chunks::<ROW>();
    if let (Some((word, _)), false) = (rest.first(), found.has_errors()) {
        let message = format!("the last map has {} of {ROW} numbers", rest.len());
        let row = Diagnostic::error(message).at(&word.place);
        found.push(
            row.hint("a map is a b c d e f p: its matrix by rows, its shift, its probability"),
        );
    }
    let mut maps = Vec::new();
    for row in rows {
        let [a, b, c, d, e, f, p] = row.map(|(_, number)| number);
        if p > 0.0 {
            maps.push(map([[a, b], [c, d]], [e, f], p));
        } else {
            let message = format!("the probability {p} is not positive: this map is left out");
            found.push(Diagnostic::warning(message).at(&row[ROW - 1].0.place));
        }
    }
    if maps.is_empty() && !found.has_errors() {
        let message = format!("{} has no maps", entry.name);
        found.push(Diagnostic::error(message).at(&entry.place));
    }
    Some(
        Entries::default()
            .set("kind", Value::Text("ifs".into()))
            .set("maps", sequence(maps)),
    )
}

fn number(word: &Word) -> Option<f64> {
    let is_written = word
        .text
        .bytes()
        .all(|byte| b"+-.0123456789E".contains(&byte));
    let number: f64 = word.text.parse().ok().filter(|_| is_written)?;
    number.is_finite().then_some(number)
}

fn map(matrix: [[f64; 2]; 2], shift: [f64; 2], weight: f64) -> Value {
    let value = |number: f64| NumberText::from(number + 0.0).0;
    let row = |row: [f64; 2]| sequence(row.map(value));
    let map = Entries::default().set("matrix", sequence(matrix.map(row)));
    map.set_some("shift", (shift != [0.0; 2]).then(|| row(shift)))
        .set("weight", value(weight))
        .value()
}
