//! Points of random iteration as a table.

use std::io::{self, Write};
use std::sync::atomic::AtomicBool;

use crate::chaos::RandomPoint;
use crate::grow::{Progress, WalkError};
use crate::parallel::is_cancelled;

use super::TableFormat;

/// Rows between two checks for cancellation.
const MANY: u64 = 1 << 12;

/// Writes the points of a random walk as rows, in their order: the point's coordinates, and the number, from
/// 1, of the map that produced it; condensation sets are numbered after the maps.
///
/// Coordinates are the shortest decimals that read back as the same doubles.
///
/// # Errors
///
/// Returns an error if the walk is cancelled, or if `out` fails.
pub fn write_points(
    points: impl Iterator<Item = RandomPoint>,
    format: TableFormat,
    cancel: Option<&AtomicBool>,
    progress: Option<&Progress>,
    out: &mut impl Write,
) -> Result<(), WalkError<io::Error>> {
    if format == TableFormat::Csv {
        writeln!(out, "x,y,map").map_err(WalkError::Visitor)?;
    }
    for (number, point) in (1u64..).zip(points) {
        if number.is_multiple_of(MANY) {
            if is_cancelled(cancel) {
                return Err(WalkError::Cancelled);
            }
            if let Some(progress) = progress {
                progress.count(MANY);
            }
        }
        let (mut x, mut y) = (zmij::Buffer::new(), zmij::Buffer::new());
        let (x, y) = (
            coordinate(&mut x, point.place.x),
            coordinate(&mut y, point.place.y),
        );
        let map = point.map + 1;
        match format {
            TableFormat::Csv => writeln!(out, "{x},{y},{map}"),
            TableFormat::JsonLines => writeln!(out, r#"{{"x":{x},"y":{y},"map":{map}}}"#),
        }
        .map_err(WalkError::Visitor)?;
    }
    Ok(())
}

fn coordinate(buffer: &mut zmij::Buffer, value: f64) -> &str {
    // Adding zero turns −0 into 0.
    let text = buffer.format(value + 0.0);
    text.strip_suffix(".0").unwrap_or(text)
}
