//! Tables of points: text with a point a line.

use std::sync::Arc;

use crate::diagnostic::{Diagnostic, Place, Source};

use super::node::{Node, Value};

/// The points of a table as a list: two numbers a line, with a comma, a semicolon or white space
/// between them. Empty lines and those that begin with `#` say nothing; the first line may be a heading.
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
