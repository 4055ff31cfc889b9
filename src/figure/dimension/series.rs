//! Plots of a dimension as a function of a parameter, in the manner of Kaandorp 1987, figure 20.

use std::io::{self, Write};

use crate::geometry::DVec2;
use crate::render::{RenderError, Surface};

use super::DimensionFigureOptions;
use super::axis::Axis;
use super::pad::{self, LEFT, Pad, Plot, RIGHT, frame, orange};

const SIZE: [u32; 2] = [720, 480];
const PANEL: [f64; 2] = [44.0, 420.0];

/// Plots dimensions over the values of a parameter on white; returns width and height in pixels. Values
/// without a dimension are left out.
///
/// # Errors
///
/// Returns an error if `out` fails.
pub fn write_series(
    parameter: &str,
    dimensions: &[(f64, Option<f64>)],
    options: &DimensionFigureOptions,
    out: &mut impl Write,
) -> Result<[u32; 2], RenderError> {
    let series = Series {
        parameter,
        dimensions,
    };
    pad::write(&series, options, out)
}

struct Series<'a> {
    parameter: &'a str,
    dimensions: &'a [(f64, Option<f64>)],
}

impl Plot for Series<'_> {
    fn size(&self) -> [u32; 2] {
        SIZE
    }

    fn draw<S: Surface>(&self, pad: &mut Pad<'_, S>) -> io::Result<()> {
        let values = self.dimensions.iter();
        let across = Axis::linear(values.clone().map(|(value, _)| *value), [LEFT, RIGHT]);
        let known = values.clone().filter_map(|(_, dimension)| *dimension);
        let up = Axis::linear(known, [PANEL[1], PANEL[0]]);
        frame(pad, &across, &up, PANEL, true)?;
        let at = |value: f64, dimension: f64| DVec2::new(across.at(value), up.at(dimension));
        // A line joins neighbouring values that both have a dimension.
        for pair in self.dimensions.windows(2) {
            if let [(from, Some(first)), (to, Some(second))] = *pair {
                pad.line(&[at(from, first), at(to, second)], orange(255), 1.5)?;
            }
        }
        for &(value, dimension) in self.dimensions {
            if let Some(dimension) = dimension {
                pad.dot(at(value, dimension), true)?;
            }
        }
        pad.below(self.parameter, 466.0)?;
        pad.beside("similarity dimension", PANEL[0] - 12.0)
    }
}
