//! G-code for drawing machines and cutters (ISO 6983; RS-274): strokes in millimetres from the lower left corner, y up.

use std::io::{self, Write};

use super::options::Labels;
use super::plot::{Page, Plot};

/// Commands of a machine.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Machine {
    /// Speed of drawing in millimetres a minute; 1,500 by default.
    pub feed: f64,
    /// Command that raises the pen or stops cutting; `G0 Z5` by default.
    pub pen_up: String,
    /// Command that lowers the pen or starts cutting; `G1 Z0` by default.
    pub pen_down: String,
}

impl Default for Machine {
    fn default() -> Self {
        Self {
            feed: 1_500.0,
            pen_up: "G0 Z5".into(),
            pen_down: "G1 Z0".into(),
        }
    }
}

/// Writes a plot. The machine stops for a change of the pen (`M0`), and ends at the origin with its pen raised.
pub(super) fn write(
    plot: &Plot,
    page: Page,
    machine: &Machine,
    labels: &Labels,
    out: &mut impl Write,
) -> io::Result<()> {
    let [width, height] = page.size();
    // A comment ends with its line; what is not ASCII is a matter of the reader.
    let is_other = |c: char| !(' '..='~').contains(&c);
    let title = labels.title.replace(is_other, "?");
    writeln!(out, "; {title}\n; kfrac {}", env!("CARGO_PKG_VERSION"))?;
    writeln!(
        out,
        "; {width:.1} x {height:.1} mm, {} layers",
        plot.colours().count()
    )?;
    let Machine {
        feed,
        pen_up,
        pen_down,
    } = machine;
    // A machine that has no feed rate refuses to move the pen down.
    writeln!(out, "G21\nG90\nF{feed}\n{pen_up}")?;
    let colours: Vec<_> = plot.colours().collect();
    let mut pen = None;
    plot.each(|layer, vertices, closed| {
        let last = pen.replace(layer);
        if last != Some(layer) {
            if last.is_some() {
                out.write_all(b"M0\n")?;
            }
            writeln!(out, "; pen {}: {}", layer + 1, colours[layer])?;
        }
        let mut points = vertices.iter().chain(vertices.first().filter(|_| closed));
        if let Some(&start) = points.next() {
            let [x, y] = page.place(start);
            writeln!(out, "G0 X{x:.3} Y{y:.3}\n{pen_down}\nG1 F{feed}")?;
        }
        for &point in points {
            let [x, y] = page.place(point);
            writeln!(out, "G1 X{x:.3} Y{y:.3}")?;
        }
        writeln!(out, "{pen_up}")
    })?;
    out.write_all(b"G0 X0 Y0\nM2\n")
}
