//! Conversion of Fractint's systems of maps: rows of `a b c d e f p`, for x' = a x + b y + e and y' = c x + d
//! y + f; in entries with the remark `(3D)`, of `a b c d e f g h i j k l p`, for x' = a x + b y + c z + j, y' = d x +
//! e y + f z + k and z' = g x + h y + i z + l.

use crate::build::NumberText;
use crate::build::written::Entries;
use crate::diagnostic::{Diagnostic, Diagnostics};

use crate::import::maps::{Layout, System};

use super::entries::{Entry, Word};

/// Returns the number of numbers in a row: those of a map, and its probability.
fn row_length(layout: Layout) -> usize {
    layout.numbers() + 1
}

pub(in crate::import) fn write(entry: &Entry, found: &mut Diagnostics) -> Option<Entries> {
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
    let rows = numbers.chunks_exact(row_length(layout));
    if !rows.remainder().is_empty() && !found.has_errors() {
        found.push(unfinished(&numbers, layout));
    }
    let mut system = System::new(layout);
    for row in rows {
        let (map, weight) = row.split_at(layout.numbers());
        let map = map.iter().map(|(_, number)| NumberText::from(*number));
        let weight = weight.first().map(|(word, weight)| (*weight, &word.place));
        system.push(map.collect(), weight, found);
    }
    Some(system.entries(&entry.name, &entry.place, found))
}

/// Returns the error of numbers that do not fill their last row: at the one line that has too many or too few, or
/// else at the last row.
fn unfinished(numbers: &[(&Word, f64)], layout: Layout) -> Diagnostic {
    let row = row_length(layout);
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
    let letters: String = layout
        .letters
        .chars()
        .flat_map(|letter| [letter, ' '])
        .collect();
    let hint = format!("a map is {letters}p: its matrix by rows, its shift, its probability");
    let here = Diagnostic::error(message).at(&at.place).hint(hint);
    match layout.axes == 2 && numbers.len().is_multiple_of(row_length(Layout::SPACE)) {
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
