//! A dimension as a function of a parameter, in the manner of Kaandorp 1987, figure 20.

use std::io::Write;
use std::num::NonZero;

use crate::geometry::DVec2;
use crate::parallel::Team;
use crate::render::{Drawing, Pen, RenderError, Surface, write_drawing};
use crate::style::Colour;

use super::super::text::{Anchor, Font};
use super::axis::Axis;
use super::{LEFT, Options, Pad, RIGHT, WORDS, blue, frame, orange, pen};

const SIZE: [u32; 2] = [720, 480];
const PANEL: [f64; 2] = [44.0, 420.0];

/// Plots dimensions over the values of a parameter on white, where there are any; tells width and
/// height in pixels.
///
/// # Errors
///
/// If `out` fails.
pub fn write_series(
    parameter: &str,
    dimensions: &[(f64, Option<f64>)],
    options: &Options,
    out: &mut impl Write,
) -> Result<[u32; 2], RenderError> {
    let series = Series {
        parameter,
        dimensions,
        options,
        font: Font::new(),
    };
    let one = NonZero::<usize>::MIN;
    write_drawing(&series, options.format, &options.labels, one, out)?;
    Ok(SIZE)
}

struct Series<'a> {
    parameter: &'a str,
    dimensions: &'a [(f64, Option<f64>)],
    options: &'a Options,
    font: Font,
}

impl Drawing for Series<'_> {
    fn size(&self) -> [u32; 2] {
        SIZE
    }

    fn background(&self) -> Option<Colour> {
        Some(Colour::grey(255))
    }

    fn pen(&self) -> Pen {
        pen(1.0)
    }

    fn draw<'w>(&'w self, surface: &mut impl Surface, _: &Team<'w>) -> Result<(), RenderError> {
        let values = self.dimensions.iter();
        let across = Axis::linear(values.clone().map(|(value, _)| *value), [LEFT, RIGHT]);
        let told = values.clone().filter_map(|(_, dimension)| *dimension);
        let up = Axis::linear(told, [PANEL[1], PANEL[0]]);
        let mut pad = Pad {
            surface,
            font: &self.font,
        };
        let middle = f64::midpoint(LEFT, RIGHT);
        let title = &self.options.labels.title;
        pad.text(title, 17.0, DVec2::new(middle, 27.0), Anchor::Middle)?;
        frame(&mut pad, &across, &up, PANEL, true)?;
        // A line joins neighbours that both have a dimension.
        for pair in self.dimensions.windows(2) {
            if let [(from, Some(first)), (to, Some(second))] = *pair {
                let ends = [(from, first), (to, second)];
                let ends = ends.map(|(x, y)| DVec2::new(across.at(x), up.at(y)));
                pad.line(&ends, orange(), 1.5)?;
            }
        }
        for (value, dimension) in self.dimensions {
            if let Some(dimension) = dimension {
                let at = DVec2::new(across.at(*value), up.at(*dimension));
                pad.line(&[at, at], blue(255), 6.0)?;
            }
        }
        let below = DVec2::new(middle, 466.0);
        pad.text(self.parameter, WORDS, below, Anchor::Middle)?;
        let beside = DVec2::new(10.0, PANEL[0] - 12.0);
        pad.text("dimension", WORDS, beside, Anchor::Start)?;
        Ok(())
    }
}
