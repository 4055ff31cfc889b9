//! Tables of points: text files with one point per line.

use std::sync::Arc;

use crate::diagnostic::{Diagnostic, Place, Source};

use super::node::{Node, Value};

/// Reads a table as a list of points. A line has two numbers, separated by commas, semicolons or white
/// space. Empty lines and lines that begin with `#` are skipped; the first of the other lines may be a
/// heading.
pub(super) fn read(source: &Arc<Source>) -> Result<Node, Diagnostic> {
    let text = source.text();
    let mut points = Vec::new();
    let mut start = 0;
    let mut is_first = true;
    for line in text.split_inclusive('\n') {
        let place = Place::new(source, start..start + line.trim_end().len());
        start += line.len();
        let written = line.trim();
        if written.is_empty() || written.starts_with('#') {
            continue;
        }
        let separators = |c: char| c == ',' || c == ';' || c.is_whitespace();
        let cells = written.split(separators).filter(|cell| !cell.is_empty());
        let numbers: Option<Vec<f64>> = cells.map(|cell| cell.parse().ok()).collect();
        let numbers = numbers.filter(|all| all.iter().all(|number| number.is_finite()));
        match numbers.as_deref() {
            Some(&[x, y]) => points.push(point([x, y], place)),
            None if is_first => {}
            _ => {
                let message = "this is no point";
                return Err(Diagnostic::error(message)
                    .at(&place)
                    .hint("a line has two numbers, decimals with a point: 0.5, 1.25"));
            }
        }
        is_first = false;
    }
    Ok(Node {
        place: Place::new(source, 0..text.len().min(1)),
        value: Value::Sequence(points),
    })
}

fn point(coordinates: [f64; 2], place: Place) -> Node {
    let number = |value| Node {
        place: place.clone(),
        value: Value::Number(value),
    };
    Node {
        value: Value::Sequence(coordinates.map(number).into()),
        place,
    }
}
