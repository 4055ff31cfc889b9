use std::cell::Cell;
use std::io::{self, Read};

use csv::{ByteRecord, ErrorKind, ReaderBuilder, Trim};

use crate::geometry::DVec2;

/// The most points that a table may have: they take 16 bytes each.
const MOST_POINTS: usize = 1 << 27;

/// What is wrong with a table of points. Rows are counted from 1, the header included.
#[derive(Debug, thiserror::Error)]
pub enum TableError {
    /// The columns are not said, and there are not two.
    #[error(
        "the table has {columns} columns, and points have two: say which ones, as in --columns x,y"
    )]
    Columns {
        /// The number of columns.
        columns: usize,
    },
    /// A column that was asked for is not there.
    #[error("the table has no column '{name}'")]
    NoColumn {
        /// Its name.
        name: String,
    },
    /// A row has more or fewer columns than the first.
    #[error("row {row}: {found} columns, not {expected} as in the rows before")]
    Ragged {
        /// The row.
        row: u64,
        /// Its number of columns.
        found: u64,
        /// That of the first row.
        expected: u64,
    },
    /// A coordinate is not a number.
    #[error("row {row}: '{text}' is not a number")]
    NotANumber {
        /// The row.
        row: u64,
        /// What is there.
        text: String,
    },
    /// A coordinate is not finite.
    #[error("row {row}: the coordinate {text} is not finite")]
    NotFinite {
        /// The row.
        row: u64,
        /// What is there.
        text: String,
    },
    /// There are too many points.
    #[error("there are more than {MOST_POINTS} points")]
    TooMany,
    /// The table cannot be read.
    #[error("the table cannot be read: {0}")]
    Csv(csv::Error),
}

/// Reads points from CSV: comma-separated rows, with a header or without.
///
/// `columns` names the two columns with the coordinates, as the header has them or by number from
/// 1; a table of two columns needs none.
///
/// # Errors
///
/// If a row has no two finite numbers there, or as many columns as no other; if the table cannot be
/// read, or has more points than memory should hold.
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
        if points.len() == MOST_POINTS {
            return Err(TableError::TooMany);
        }
        let coordinate = |place| coordinate(&record, place, row);
        points.push(DVec2::new(coordinate(x)?, coordinate(y)?));
    }
    Ok(points)
}

/// The most bytes from one row to the next: a stream without ends of lines must not fill the memory.
const MOST_BYTES: usize = 1 << 24;

/// A reader that fails where a row is longer than [`MOST_BYTES`].
struct Rows<'a, R> {
    input: R,
    /// The bytes since the last row.
    bytes: &'a Cell<usize>,
}

impl<R: Read> Read for Rows<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.input.read(buffer)?;
        self.bytes.set(self.bytes.get() + count);
        if self.bytes.get() > MOST_BYTES {
            let message = format!("a row is not to have more than {MOST_BYTES} bytes");
            return Err(io::Error::new(io::ErrorKind::InvalidData, message));
        }
        Ok(count)
    }
}

/// Where the coordinates stand, by the first row.
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
    const MOST_CHARACTERS: usize = 40;
    let field = &record[place];
    let text = || {
        let text = String::from_utf8_lossy(field);
        text.chars().take(MOST_CHARACTERS).collect()
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
