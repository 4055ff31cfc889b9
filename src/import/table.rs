//! Tables of points in CSV.

use std::cell::Cell;
use std::io::{self, Read};

use csv::{ByteRecord, ErrorKind, ReaderBuilder, Trim};

use crate::geometry::{DVec2, DVec3};

/// Limit of the number of points in a table; a point takes 16 bytes, or 24 in space.
pub(super) const MAX_POINTS: usize = 1 << 27;

/// An error in a table of points. Rows are numbered from 1, the header included.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TableError {
    /// No columns are named, and the table has neither two nor three, nor columns named x, y and z.
    #[error("the table has {columns} columns, and points have two or three: name these")]
    Columns {
        /// The number of columns.
        columns: usize,
    },
    /// A named column does not exist.
    #[error("the table has no column '{name}'")]
    NoColumn {
        /// Name of the column.
        name: String,
    },
    /// The number of columns of a row differs from that of the first.
    #[error("row {row}: {found} columns, not {expected} as in the rows before")]
    Ragged {
        /// Number of the row.
        row: u64,
        /// The number of columns of the row.
        found: u64,
        /// The number of columns of the first row.
        expected: u64,
    },
    /// A coordinate is not a number.
    #[error("row {row}: '{text}' is not a number")]
    NotANumber {
        /// Number of the row.
        row: u64,
        /// Text of the field, up to 40 characters.
        text: String,
    },
    /// A coordinate is not finite.
    #[error("row {row}: the coordinate {text} is not finite")]
    NotFinite {
        /// Number of the row.
        row: u64,
        /// Text of the field, up to 40 characters.
        text: String,
    },
    /// The table has more points than the limit.
    #[error("there are more than {MAX_POINTS} points")]
    TooMany,
    /// The table cannot be read.
    #[error("the table cannot be read: {0}")]
    Csv(csv::Error),
}

/// Points of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Table {
    /// Points of the plane.
    Plane(Vec<DVec2>),
    /// Points of space.
    Space(Vec<DVec3>),
}

/// Reads points from CSV: comma-separated rows, with or without a header.
///
/// `columns` names the two or three columns of the coordinates, by their names in the header or by number from 1; a
/// table of two or three columns needs none, nor does one whose header has x, y and z. The first row is a header if
/// none of its coordinates is a number. Lines that start with `#` are comments.
///
/// # Errors
///
/// Returns an error if the columns are not found, if a row does not hold finite numbers there or differs
/// in length from the first, if the table cannot be read, or if it has too many points.
pub fn read_points(input: impl Read, columns: Option<&[String]>) -> Result<Table, TableError> {
    let bytes = Cell::new(0);
    let mut reader = ReaderBuilder::new()
        .has_headers(false)
        .trim(Trim::All)
        .comment(Some(b'#'))
        .from_reader(Rows {
            input,
            bytes: &bytes,
        });
    let mut record = ByteRecord::new();
    let (mut plane, mut space) = (Vec::new(), Vec::new());
    let mut row = 0;
    let mut places: Option<Vec<usize>> = None;
    while reader.read_byte_record(&mut record).map_err(explained)? {
        row += 1;
        bytes.set(0);
        let is_first = places.is_none();
        let places = match &mut places {
            Some(places) => places,
            places => places.insert(find(&record, columns)?),
        };
        let is_header = |place: &usize| number(&record[*place]).is_none();
        if is_first && places.iter().all(is_header) {
            continue;
        }
        if plane.len().max(space.len()) == MAX_POINTS {
            return Err(TableError::TooMany);
        }
        let coordinate = |place| coordinate(&record, place, row);
        match places[..] {
            [x, y, z] => space.push(DVec3::new(coordinate(x)?, coordinate(y)?, coordinate(z)?)),
            [x, y, ..] => plane.push(DVec2::new(coordinate(x)?, coordinate(y)?)),
            _ => {}
        }
    }
    Ok(match space.is_empty() {
        true => Table::Plane(plane),
        false => Table::Space(space),
    })
}

/// Limit of the number of bytes between two rows: a stream without line ends must not fill the memory.
const MAX_BYTES: usize = 1 << 24;

/// A reader that fails where a row is longer than [`MAX_BYTES`].
struct Rows<'a, R> {
    input: R,
    /// The number of bytes since the last row.
    bytes: &'a Cell<usize>,
}

impl<R: Read> Read for Rows<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.input.read(buffer)?;
        self.bytes.set(self.bytes.get() + count);
        if self.bytes.get() > MAX_BYTES {
            let message = format!("a row is not to have more than {MAX_BYTES} bytes");
            return Err(io::Error::new(io::ErrorKind::InvalidData, message));
        }
        Ok(count)
    }
}

/// Returns the positions of the coordinates, by the first row.
fn find(first: &ByteRecord, columns: Option<&[String]>) -> Result<Vec<usize>, TableError> {
    let of_name = |name: &str| first.iter().position(|field| field == name.as_bytes());
    let Some(columns) = columns else {
        let named: Option<Vec<usize>> = ["x", "y", "z"].into_iter().map(of_name).collect();
        return match (named, first.len()) {
            (Some(named), _) => Ok(named),
            (None, columns @ 2..=3) => Ok((0..columns).collect()),
            (None, columns) => Err(TableError::Columns { columns }),
        };
    };
    let place = |name: &String| {
        let named = of_name(name);
        let numbered = || name.parse::<usize>().ok()?.checked_sub(1);
        let place = named.or_else(numbered).filter(|place| *place < first.len());
        place.ok_or_else(|| TableError::NoColumn { name: name.clone() })
    };
    columns.iter().map(place).collect()
}

fn number(field: &[u8]) -> Option<f64> {
    std::str::from_utf8(field).ok()?.parse().ok()
}

fn coordinate(record: &ByteRecord, place: usize, row: u64) -> Result<f64, TableError> {
    const MAX_CHARACTERS: usize = 40;
    let field = &record[place];
    let text = || {
        let text = String::from_utf8_lossy(field);
        text.chars().take(MAX_CHARACTERS).collect()
    };
    match number(field) {
        Some(value) if value.is_finite() => Ok(value),
        Some(_) => Err(TableError::NotFinite { row, text: text() }),
        None => Err(TableError::NotANumber { row, text: text() }),
    }
}

fn explained(error: csv::Error) -> TableError {
    match error.kind() {
        ErrorKind::UnequalLengths {
            pos: Some(position),
            expected_len,
            len,
        } => TableError::Ragged {
            row: position.record() + 1,
            found: *len,
            expected: *expected_len,
        },
        _ => TableError::Csv(error),
    }
}
