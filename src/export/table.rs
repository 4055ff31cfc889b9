//! Elements of approximants as a table.

use std::io::{self, Write};
use std::num::NonZero;

use crate::geometry::{BEYOND, DVec2, Direction};
use crate::graph::Graph;
use crate::grow::{
    Division, Element, FractalInfo, Growth, Ranks, Visitor, WalkError, Walked, walk_with,
};
use crate::parallel::with_team;
use crate::style::Named;

/// Format of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TableFormat {
    /// Comma-separated values with a header.
    Csv,
    /// One JSON object per line.
    JsonLines,
}

impl Named for TableFormat {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("csv", Self::Csv),
        ("json", Self::JsonLines),
        ("jsonl", Self::JsonLines),
        ("ndjson", Self::JsonLines),
    ];
}

/// Columns: the number and age of the fractal; the element's rank in it, its first and last point of
/// traversal in the model's units, whether it is fertile, its direction, whether it is visible.
///
/// Where maps may be arbitrary affine ones, six columns follow: x' = a x + c y + e, y' = b x + d y + f.
const COLUMNS: [&str; 16] = [
    "fractal",
    "age",
    "index",
    "x0",
    "y0",
    "x1",
    "y1",
    "fertile",
    "direction",
    "visible",
    "a",
    "b",
    "c",
    "d",
    "e",
    "f",
];

/// Number of columns of a table of similarities.
const WITHOUT_MAPS: usize = 10;

/// Grows a graph and writes the elements of the approximant as rows, in order of traversal.
///
/// Coordinates are the shortest decimals that read back as the same doubles. The bytes do not depend on the
/// number of threads.
///
/// # Errors
///
/// Returns an error if growing ends early, if an element has no finite coordinates, or if `out` fails.
pub fn write(
    graph: &Graph,
    growth: &Growth<'_>,
    format: TableFormat,
    threads: NonZero<usize>,
    out: &mut impl Write,
) -> Result<Walked, WalkError<io::Error>> {
    if format == TableFormat::Csv {
        let columns = if graph.is_affine() {
            &COLUMNS[..]
        } else {
            &COLUMNS[..WITHOUT_MAPS]
        };
        writeln!(out, "{}", columns.join(",")).map_err(WalkError::Visitor)?;
    }
    if let Some(progress) = growth.progress
        && let Ok(Some(elements)) = graph.check_size(growth.steps, growth.max_elements)
    {
        progress.expect(elements);
    }
    with_team(threads, |team| {
        let mut line = team.line(Rows::format);
        let mut write = |rows: &mut Rows| out.write_all(&rows.text);
        let fresh = || Collector {
            graph,
            fractal: FractalInfo::default(),
            goes_on: 0,
            rows: Vec::new(),
        };
        let division = Division {
            span: Some(MANY),
            ranks: Ranks::Unknown,
        };
        let walked = walk_with(team, graph, growth, division, fresh, |span, seam| {
            let goes_on = span.goes_on.min(span.rows.len());
            span.goes_on = 0;
            for row in &mut span.rows[..goes_on] {
                row.index += seam.before;
            }
            let mut rows = line.spare().unwrap_or_else(|| Rows::of(format));
            rows.rows.clear();
            std::mem::swap(&mut rows.rows, &mut span.rows);
            line.hand_on(rows, &mut write)
        })?;
        line.finish(&mut write).map_err(WalkError::Visitor)?;
        Ok(walked)
    })
}

/// Approximate number of rows that are written at once.
const MANY: u64 = 1 << 12;

/// The cells of a row.
struct Row {
    fractal: FractalInfo,
    index: u128,
    ends: [DVec2; 2],
    fertile: bool,
    direction: Direction,
    visible: bool,
    map: Option<[f64; 6]>,
}

/// Rows, and the text that is made of them.
struct Rows {
    format: TableFormat,
    rows: Vec<Row>,
    text: Vec<u8>,
}

impl Rows {
    fn of(format: TableFormat) -> Self {
        Self {
            format,
            rows: Vec::new(),
            text: Vec::new(),
        }
    }

    fn format(&mut self) {
        self.text.clear();
        let mut line = Cells {
            format: self.format,
            text: &mut self.text,
        };
        for row in &self.rows {
            line.row(row);
        }
    }
}

/// Writes the cells of rows as text.
struct Cells<'t> {
    format: TableFormat,
    text: &'t mut Vec<u8>,
}

impl Cells<'_> {
    fn row(&mut self, row: &Row) {
        let [from, to] = row.ends;
        self.whole(0, row.fractal.number);
        self.whole(1, u64::from(row.fractal.age));
        self.whole(2, row.index);
        self.coordinate(3, from.x);
        self.coordinate(4, from.y);
        self.coordinate(5, to.x);
        self.coordinate(6, to.y);
        self.flag(7, row.fertile);
        self.whole(8, u64::from(row.direction.number()));
        self.flag(9, row.visible);
        if let Some(map) = row.map {
            for (column, value) in (WITHOUT_MAPS..).zip(map) {
                self.coordinate(column, value);
            }
        }
        if self.format == TableFormat::JsonLines {
            self.text.push(b'}');
        }
        self.text.push(b'\n');
    }

    fn cell(&mut self, column: usize, text: &str) {
        if self.format == TableFormat::JsonLines {
            self.text
                .extend_from_slice(if column == 0 { b"{\"" } else { b",\"" });
            self.text.extend_from_slice(COLUMNS[column].as_bytes());
            self.text.extend_from_slice(b"\":");
        } else if column > 0 {
            self.text.push(b',');
        }
        self.text.extend_from_slice(text.as_bytes());
    }

    fn coordinate(&mut self, column: usize, value: f64) {
        // Adding zero turns −0 into 0.
        let mut buffer = zmij::Buffer::new();
        let text = buffer.format_finite(value + 0.0);
        self.cell(column, text.strip_suffix(".0").unwrap_or(text));
    }

    fn whole(&mut self, column: usize, value: impl itoa::Integer) {
        let mut buffer = itoa::Buffer::new();
        self.cell(column, buffer.format(value));
    }

    fn flag(&mut self, column: usize, value: bool) {
        self.cell(column, if value { "true" } else { "false" });
    }
}

/// Collects the rows of a span.
struct Collector<'g> {
    graph: &'g Graph,
    fractal: FractalInfo,
    /// Number of leading rows whose fractal began before the span.
    goes_on: usize,
    rows: Vec<Row>,
}

impl Visitor for Collector<'_> {
    type Error = io::Error;

    fn go_on(&mut self, fractal: FractalInfo) {
        self.fractal = fractal;
        self.goes_on = usize::MAX;
    }

    fn begin(&mut self, fractal: FractalInfo) -> io::Result<()> {
        self.fractal = fractal;
        self.goes_on = self.goes_on.min(self.rows.len());
        Ok(())
    }

    fn element(&mut self, element: &Element) -> io::Result<()> {
        let affine = self.graph.is_affine();
        let place = self.graph.place();
        let mut frame = element.frame;
        let is_in_range = frame.is_in_range();
        if affine && !place.is_identity() {
            frame = frame.conjugated(place);
        }
        let mut ends = frame.ends();
        if !affine && !place.is_identity() {
            ends = ends.map(|end| place.point(end));
        }
        if !is_in_range || !ends.iter().all(|end| end.is_finite()) || !frame.is_finite() {
            return Err(io::Error::new(io::ErrorKind::InvalidData, BEYOND));
        }
        let map = affine.then(|| frame.map().to_cols_array());
        self.rows.push(Row {
            fractal: self.fractal,
            index: element.index,
            ends,
            fertile: element.fertile,
            direction: element.frame.direction(),
            visible: self.graph.objects()[element.object].visible,
            map,
        });
        Ok(())
    }

    fn end(&mut self, _: bool) -> io::Result<()> {
        Ok(())
    }
}
