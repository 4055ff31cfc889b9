//! HP-GL, the language of pen plotters (Hewlett-Packard 7470A, 1982, and later): strokes in units of 1/40 mm, y up, a number
//! for each pen.

use std::io::{self, Write};

use super::plot::{Page, Plot};

/// Plotter units in a millimetre.
const UNITS: f64 = 40.0;

/// Number of points in an instruction: more exceed the buffers of old plotters.
const POINTS: usize = 64;

/// Writes a plot.
pub(super) fn write(plot: &Plot, page: Page, out: &mut impl Write) -> io::Result<()> {
    out.write_all(b"IN;")?;
    let mut pen = None;
    plot.each(|layer, vertices, closed| {
        if pen.replace(layer) != Some(layer) {
            write!(out, "\nPU;SP{};", layer + 1)?;
        }
        let mut points = vertices
            .iter()
            .chain(vertices.first().filter(|_| closed))
            .map(|&vertex| page.place(vertex).map(|side| (side * UNITS).round()));
        if let Some([x, y]) = points.next() {
            write!(out, "\nPU{x},{y};")?;
        }
        let points: Vec<String> = points.map(|[x, y]| format!("{x},{y}")).collect();
        for points in points.chunks(POINTS) {
            write!(out, "PD{};", points.join(","))?;
        }
        Ok::<_, io::Error>(())
    })?;
    out.write_all(b"\nPU;SP0;\n")
}
