//! Conversion of Fractint's systems of maps: rows of `a b c d e f p`, for x' = a x + b y + e and y' = c x + d
//! y + f; in entries with the remark `(3D)`, of `a b c d e f g h i j k l p`, for x' = a x + b y + c z + j, y' = d x +
//! e y + f z + k and z' = g x + h y + i z + l.

use crate::build::NumberText;
use crate::build::written::{Entries, sequence};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::node::Value;

use super::entries::{Entry, Word};

/// Layout of the rows of an entry: a matrix by rows, a translation, and a probability.
#[derive(Clone, Copy)]
struct Layout {
    /// Number of coordinates of a point.
    axes: usize,
    /// Letters of the numbers in a row.
    letters: &'static str,
}

impl Layout {
    const PLANE: Self = Self {
        axes: 2,
        letters: "a b c d e f p",
    };

    const SPACE: Self = Self {
        axes: 3,
        letters: "a b c d e f g h i j k l p",
    };

    /// Returns the number of numbers in a row.
    fn row(self) -> usize {
        self.axes * (self.axes + 1) + 1
    }
}

pub(super) fn write(entry: &Entry, found: &mut Diagnostics) -> Option<Entries> {
    let layout = match entry.remark.as_deref() {
        None => Layout::PLANE,
        Some(remark) if remark.eq_ignore_ascii_case("3d") => Layout::SPACE,
        Some(remark) => {
            let message = format!("'({remark})' is not understood");
            let remark = Diagnostic::error(message).at(&entry.place);
            found.push(remark.hint("(3D) is for maps of space"));
            return None;
        }
    };
    let numbers = entry.words.iter().filter_map(|word| {
        let number = number(word);
        if number.is_none() {
            let message = format!("'{}' is not a number", word.written());
            found.push(Diagnostic::error(message).at(&word.place));
        }
        Some((word, number?))
    });
    let numbers: Vec<_> = numbers.collect();
    let rows = numbers.chunks_exact(layout.row());
    if !rows.remainder().is_empty() && !found.has_errors() {
        found.push(unfinished(&numbers, layout));
    }
    let mut maps = Vec::new();
    for row in rows {
        let values: Vec<f64> = row.iter().map(|(_, number)| *number).collect();
        let (weight, map) = (values[layout.row() - 1], &values[..layout.row() - 1]);
        if weight > 0.0 {
            maps.push(written(map, weight, layout));
        } else {
            let message = format!("the probability {weight} is not positive: this map is left out");
            found.push(Diagnostic::warning(message).at(&row[layout.row() - 1].0.place));
        }
    }
    if maps.is_empty() && !found.has_errors() {
        let message = format!("{} has no maps", entry.name);
        found.push(Diagnostic::error(message).at(&entry.place));
    }
    let kind = Entries::default().set("kind", Value::Text("ifs".into()));
    let space = (layout.axes == 3).then_some(Value::Number(3.0));
    Some(kind.set_some("space", space).set("maps", sequence(maps)))
}

/// Returns the error of numbers that do not fill their last row: at the one line that has too many or too few, or
/// else at the last row.
fn unfinished(numbers: &[(&Word, f64)], layout: Layout) -> Diagnostic {
    let row = layout.row();
    let lines = numbers.chunk_by(|_, (word, _)| !word.starts_line);
    let uneven: Vec<_> = lines.filter(|line| line.len() % row != 0).collect();
    let (at, message) = match uneven[..] {
        [line] if line.len() < numbers.len() => {
            let count = line.len();
            (
                line[0].0,
                format!("this line has {count} numbers, and a map has {row}"),
            )
        }
        _ => {
            let count = numbers.len() % row;
            let first = numbers[numbers.len() - count].0;
            (first, format!("the last map has {count} of {row} numbers"))
        }
    };
    let letters = layout.letters;
    let hint = format!("a map is {letters}: its matrix by rows, its shift, its probability");
    let here = Diagnostic::error(message).at(&at.place).hint(hint);
    match layout.axes == 2 && numbers.len().is_multiple_of(Layout::SPACE.row()) {
        true => here.hint("maps of space have (3D) after the name of the entry"),
        false => here,
    }
}

fn number(word: &Word) -> Option<f64> {
    let is_written = word
        .text
        .bytes()
        .all(|byte| b"+-.0123456789E".contains(&byte));
    let number: f64 = word.text.parse().ok().filter(|_| is_written)?;
    number.is_finite().then_some(number)
}

/// Writes a map from the numbers of its matrix and its shift.
fn written(map: &[f64], weight: f64, layout: Layout) -> Value {
    let value = |number: f64| NumberText::from(number + 0.0).0;
    let row = |row: &[f64]| sequence(row.iter().map(|number| value(*number)));
    let (matrix, shift) = map.split_at(layout.axes * layout.axes);
    let map = Entries::default().set("matrix", sequence(matrix.chunks(layout.axes).map(row)));
    map.set_some(
        "shift",
        shift.iter().any(|it| *it != 0.0).then(|| row(shift)),
    )
    .set("weight", value(weight))
    .value()
}
