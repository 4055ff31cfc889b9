//! Points of random iteration as a table.

use std::io::{self, Write};
use std::sync::atomic::AtomicBool;

use crate::chaos::RandomPoint;
use crate::geometry::Point;
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
pub fn write_points<P: Point>(
    points: impl Iterator<Item = RandomPoint<P>>,
    format: TableFormat,
    cancel: Option<&AtomicBool>,
    progress: Option<&Progress>,
    out: &mut impl Write,
) -> Result<(), WalkError<io::Error>> {
    let axes = &["x", "y", "z"][..P::DIMENSION];
    if format == TableFormat::Csv {
        writeln!(out, "{},map", axes.join(",")).map_err(WalkError::Visitor)?;
    }
    let mut row = String::new();
    for (number, point) in (1u64..).zip(points) {
        if number.is_multiple_of(MANY) {
            if is_cancelled(cancel) {
                return Err(WalkError::Cancelled);
            }
            if let Some(progress) = progress {
                progress.count(MANY);
            }
        }
        row.clear();
        for (axis, value) in axes.iter().zip(point.place.coordinates()) {
            let mut buffer = zmij::Buffer::new();
            let value = coordinate(&mut buffer, value);
            match format {
                TableFormat::Csv => row.extend([value, ","]),
                TableFormat::JsonLines => row.extend(["\"", axis, "\":", value, ","]),
            }
        }
        let map = point.map + 1;
        match format {
            TableFormat::Csv => writeln!(out, "{row}{map}"),
            TableFormat::JsonLines => writeln!(out, r#"{{{row}"map":{map}}}"#),
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
