use std::io::{self, Write};

use crate::graph::Graph;
use crate::grow::{Element, Fractal, Growth, Visitor, WalkError, Walked, walk};

/// How the rows of a table are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Comma-separated values with a header.
    Csv,
    /// One JSON object a line.
    JsonLines,
}

/// The columns: the fractal's number and age; the element's rank in it, its first and last point
/// of traversal in the rule's units, whether it is fertile, its direction, whether it is visible.
const COLUMNS: [&str; 10] = [
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
];

/// Grows a graph and writes the elements of the approximant, a row each, in order of traversal.
///
/// Coordinates are the shortest decimals that read back as the same doubles.
///
/// # Errors
///
/// If growing ends early, if an element has no finite coordinates, or if `out` fails.
pub fn write(
    graph: &Graph,
    growth: &Growth<'_>,
    format: Format,
    out: &mut impl Write,
) -> Result<Walked, WalkError<io::Error>> {
    if format == Format::Csv {
        writeln!(out, "{}", COLUMNS.join(",")).map_err(WalkError::Visitor)?;
    }
    if let Some(progress) = growth.progress
        && let Ok(Some(elements)) = graph.check_size(growth.steps, growth.most_elements)
    {
        progress.expect(elements);
    }
    let mut rows = Rows {
        graph,
        format,
        fractal: Fractal::default(),
        row: Vec::new(),
        out,
    };
    walk(graph, growth, &mut rows)
}

struct Rows<'a, W: Write> {
    graph: &'a Graph,
    format: Format,
    fractal: Fractal,
    row: Vec<u8>,
    out: &'a mut W,
}

impl<W: Write> Rows<'_, W> {
    fn cell(&mut self, column: usize, text: &str) {
        if self.format == Format::JsonLines {
            self.row
                .extend_from_slice(if column == 0 { b"{\"" } else { b",\"" });
            self.row.extend_from_slice(COLUMNS[column].as_bytes());
            self.row.extend_from_slice(b"\":");
        } else if column > 0 {
            self.row.push(b',');
        }
        self.row.extend_from_slice(text.as_bytes());
    }

    fn coordinate(&mut self, column: usize, value: f64) {
        // Adding zero turns −0 into 0.
        let mut buffer = zmij::Buffer::new();
        let text = buffer.format_finite(value + 0.0);
        self.cell(column, text.strip_suffix(".0").unwrap_or(text));
    }

    fn whole(&mut self, column: usize, value: u64) {
        let mut buffer = itoa::Buffer::new();
        self.cell(column, buffer.format(value));
    }

    fn flag(&mut self, column: usize, value: bool) {
        self.cell(column, if value { "true" } else { "false" });
    }
}

impl<W: Write> Visitor for Rows<'_, W> {
    type Error = io::Error;

    fn begin(&mut self, fractal: Fractal) -> io::Result<()> {
        self.fractal = fractal;
        Ok(())
    }

    fn element(&mut self, element: &Element) -> io::Result<()> {
        let [from, to] = element.frame.ends();
        if !(from.is_finite() && to.is_finite()) {
            let message = "an element lies beyond the range of numbers";
            return Err(io::Error::new(io::ErrorKind::InvalidData, message));
        }
        self.row.clear();
        self.whole(0, self.fractal.number);
        self.whole(1, u64::from(self.fractal.age));
        self.whole(2, element.index);
        self.coordinate(3, from.x);
        self.coordinate(4, from.y);
        self.coordinate(5, to.x);
        self.coordinate(6, to.y);
        self.flag(7, element.fertile);
        self.whole(8, u64::from(element.frame.direction.number()));
        self.flag(9, self.graph.objects()[element.object].visible);
        if self.format == Format::JsonLines {
            self.row.push(b'}');
        }
        self.row.push(b'\n');
        self.out.write_all(&self.row)
    }

    fn end(&mut self, _: bool) -> io::Result<()> {
        Ok(())
    }
}
