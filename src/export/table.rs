//! Elements of approximants as a table.

use std::io::{self, Write};
use std::num::NonZero;

use crate::geometry::{BEYOND, Direction};
use crate::graph::Graph;
use crate::grow::{
    Division, Element, FractalInfo, Growth, Ranks, Visitor, WalkError, Walked, walk_with,
};
use crate::parallel::with_team;
use crate::style::Named;

use super::listed::Listed;

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

/// Grows a graph and writes the elements of the approximant as rows, in order of traversal.
///
/// Columns are the number and age of the fractal; the element's rank in it, its first and last point of traversal in
/// the model's units, in space the unit vector upwards (its normal), whether it is fertile, its direction, and whether
/// it is visible. Where maps may be arbitrary affine ones, the entries of the map follow, column by column: in the
/// plane x' = a x + c y + e, y' = b x + d y + f, in space x' = a x + d y + g z + j, y' = b x + e y + h z + k,
/// z' = c x + f y + i z + l.
///
/// Coordinates are the shortest decimals that read back as the same doubles. The bytes do not depend on the
/// number of threads.
///
/// # Errors
///
/// Returns an error if growing ends early, if an element has no finite coordinates, or if `out` fails.
pub fn write<F: Listed>(
    graph: &Graph<F>,
    growth: &Growth<'_>,
    format: TableFormat,
    threads: NonZero<usize>,
    out: &mut impl Write,
) -> Result<Walked, WalkError<io::Error>> {
    if format == TableFormat::Csv {
        let columns = match graph.is_affine() {
            true => F::COLUMNS.len(),
            false => F::COLUMNS.len() - F::ENTRIES,
        };
        writeln!(out, "{}", F::COLUMNS[..columns].join(",")).map_err(WalkError::Visitor)?;
    }
    if let Some(progress) = growth.progress
        && let Ok(Some(elements)) = graph.check_size(growth.steps, growth.max_elements)
    {
        progress.expect(elements);
    }
    with_team(threads, |team| {
        let mut line = team.line(Rows::<F>::format);
        let mut write = |rows: &mut Rows<F>| out.write_all(&rows.text);
        let fresh = || Collector {
            graph,
            fractal: FractalInfo::default(),
            goes_on: 0,
            rows: Vec::new(),
        };
        let division = Division {
            span: Some(MANY),
            ranks: Ranks::Unknown,
            blocks: None,
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
struct Row<F: Listed> {
    fractal: FractalInfo,
    index: u128,
    coordinates: F::Coordinates,
    fertile: bool,
    direction: Direction,
    visible: bool,
    entries: Option<F::Entries>,
}

/// Rows, and the text that is made of them.
struct Rows<F: Listed> {
    format: TableFormat,
    rows: Vec<Row<F>>,
    text: Vec<u8>,
}

impl<F: Listed> Rows<F> {
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
            columns: F::COLUMNS.iter(),
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
    /// Names of the columns that follow in the row.
    columns: std::slice::Iter<'static, &'static str>,
    text: &'t mut Vec<u8>,
}

impl Cells<'_> {
    fn row<F: Listed>(&mut self, row: &Row<F>) {
        self.columns = F::COLUMNS.iter();
        let is_json = self.format == TableFormat::JsonLines;
        if is_json {
            self.text.push(b'{');
        }
        self.whole(row.fractal.number);
        self.whole(u64::from(row.fractal.age));
        self.whole(row.index);
        self.coordinates(row.coordinates.as_ref());
        self.flag(row.fertile);
        self.whole(u64::from(row.direction.number()));
        self.flag(row.visible);
        if let Some(entries) = &row.entries {
            self.coordinates(entries.as_ref());
        }
        // Every cell ends with a comma.
        self.text.pop();
        if is_json {
            self.text.push(b'}');
        }
        self.text.push(b'\n');
    }

    fn cell(&mut self, text: &str) {
        if self.format == TableFormat::JsonLines
            && let Some(column) = self.columns.next()
        {
            self.text.push(b'"');
            self.text.extend_from_slice(column.as_bytes());
            self.text.extend_from_slice(b"\":");
        }
        self.text.extend_from_slice(text.as_bytes());
        self.text.push(b',');
    }

    fn coordinates(&mut self, values: &[f64]) {
        for value in values {
            // Adding zero turns −0 into 0.
            let mut buffer = zmij::Buffer::new();
            let text = buffer.format_finite(value + 0.0);
            self.cell(text.strip_suffix(".0").unwrap_or(text));
        }
    }

    fn whole(&mut self, value: impl itoa::Integer) {
        let mut buffer = itoa::Buffer::new();
        self.cell(buffer.format(value));
    }

    fn flag(&mut self, value: bool) {
        self.cell(if value { "true" } else { "false" });
    }
}

/// Collects the rows of a span.
struct Collector<'g, F: Listed> {
    graph: &'g Graph<F>,
    fractal: FractalInfo,
    /// Number of leading rows whose fractal began before the span.
    goes_on: usize,
    rows: Vec<Row<F>>,
}

impl<F: Listed> Visitor<F> for Collector<'_, F> {
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

    fn element(&mut self, element: &Element<F>) -> io::Result<()> {
        let affine = self.graph.is_affine();
        let listed = element.frame.listed(self.graph.place(), affine);
        let (coordinates, entries) =
            listed.ok_or_else(|| io::Error::new(io::ErrorKind::InvalidData, BEYOND))?;
        self.rows.push(Row {
            fractal: self.fractal,
            index: element.index,
            coordinates,
            fertile: element.fertile,
            direction: element.frame.direction(),
            visible: element.visible,
            entries: affine.then_some(entries),
        });
        Ok(())
    }

    fn end(&mut self, _: bool) -> io::Result<()> {
        Ok(())
    }
}
