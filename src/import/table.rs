//! Tables of points in CSV.

use std::cell::Cell;
use std::io::{self, Read};

use csv::{ByteRecord, ErrorKind, ReaderBuilder, Trim};

use crate::geometry::DVec2;

/// Limit of the number of points in a table; a point takes 16 bytes.
const MAX_POINTS: usize = 1 << 27;

/// An error in a table of points. Rows are numbered from 1, the header included.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TableError {
    /// No columns are named, and the table does not have two.
    #[error("the table has {columns} columns, and points have two: name two of them")]
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

/// Reads points from CSV: comma-separated rows, with or without a header.
///
/// `columns` names the two columns of the coordinates, by their names in the header or by number from 1; a
/// table of two columns needs none. The first row is a header if neither of its coordinates is a number.
/// Lines that start with `#` are comments.
///
/// # Errors
///
/// Returns an error if the columns are not found, if a row does not hold two finite numbers there or differs
/// in length from the first, if the table cannot be read, or if it has too many points.
pub fn read_points(
    input: impl Read,
    columns: Option<&[String; 2]>,
) -> Result<Vec<DVec2>, TableError> {
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
    let mut points = Vec::new();
    let mut row = 0;
    let mut places = None;
    while reader.read_byte_record(&mut record).map_err(explained)? {
        row += 1;
        bytes.set(0);
        let [x, y] = match places {
            Some(places) => places,
            None => {
                let found = find(&record, columns)?;
                places = Some(found);
                let is_header = |place: usize| number(&record[place]).is_none();
                if found.into_iter().all(is_header) {
                    continue;
                }
                found
            }
        };
        if points.len() == MAX_POINTS {
            return Err(TableError::TooMany);
        }
        let coordinate = |place| coordinate(&record, place, row);
        points.push(DVec2::new(coordinate(x)?, coordinate(y)?));
    }
    Ok(points)
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
fn find(first: &ByteRecord, columns: Option<&[String; 2]>) -> Result<[usize; 2], TableError> {
    let Some([x, y]) = columns else {
        return match first.len() {
            2 => Ok([0, 1]),
            columns => Err(TableError::Columns { columns }),
        };
    };
    let place = |name: &String| {
        let named = first.iter().position(|field| field == name.as_bytes());
        let numbered = || name.parse::<usize>().ok()?.checked_sub(1);
        let place = named.or_else(numbered).filter(|place| *place < first.len());
        place.ok_or_else(|| TableError::NoColumn { name: name.clone() })
    };
    Ok([place(x)?, place(y)?])
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
