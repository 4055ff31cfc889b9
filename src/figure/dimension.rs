//! Plots of box counting: counts over sizes with the fitted line, and local slopes below.

mod axis;
mod pad;
mod series;

pub use series::write_series;

use std::io::{self, Write};

use crate::geometry::DVec2;
use crate::measure::{BoxCounting, Boxes, Estimate};
use crate::render::{Format, Labels, RenderError, Surface};

use super::text::Anchor;
use axis::Axis;
use pad::{LEFT, Pad, Plot, RIGHT, WORDS, blue, frame, orange};

/// Width and height in pixels.
const SIZE: [u32; 2] = [720, 660];

/// Upper and lower side of the panel of counts, in pixels from the top.
const COUNTS: [f64; 2] = [44.0, 404.0];
/// Upper and lower side of the panel of local slopes, in pixels from the top.
const SLOPES: [f64; 2] = [432.0, 600.0];

/// Options of a plot.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct DimensionFigureOptions {
    /// Format of the file.
    pub format: Format,
    /// Unit of the sizes of boxes, such as "pixels"; `None` if they have no unit.
    pub unit: Option<&'static str>,
    /// Metadata of the file. The title stands above the plot.
    pub labels: Labels,
}

setters!(DimensionFigureOptions {
    format: Format,
    unit: Option<&'static str>,
    labels: Labels,
});

/// Plots a measured dimension on white; returns width and height in pixels.
///
/// # Errors
///
/// Returns an error if `out` fails.
pub fn write(
    counting: &BoxCounting,
    options: &DimensionFigureOptions,
    out: &mut impl Write,
) -> Result<[u32; 2], RenderError> {
    pad::write(&Evidence { counting, options }, options, out)
}

struct Evidence<'a> {
    counting: &'a BoxCounting,
    options: &'a DimensionFigureOptions,
}

impl Plot for Evidence<'_> {
    fn size(&self) -> [u32; 2] {
        SIZE
    }

    fn draw<S: Surface>(&self, pad: &mut Pad<'_, S>) -> io::Result<()> {
        let boxes = &self.counting.boxes;
        let sizes = boxes.iter().map(|it| it.size);
        let across = Axis::logarithmic(sizes, [LEFT, RIGHT]);
        #[expect(clippy::cast_precision_loss, reason = "it is plotted")]
        let counts = boxes.iter().map(|it| it.count.max(1) as f64);
        let up = Axis::logarithmic(counts, [COUNTS[1], COUNTS[0]]);
        let slopes = self.slopes();
        if let Some(estimate) = &self.counting.estimate {
            Self::range(pad, estimate, &across)?;
        }
        frame(pad, &across, &up, COUNTS, false)?;
        frame(pad, &across, &slopes, SLOPES, true)?;
        if let Some(estimate) = &self.counting.estimate {
            Self::fit(pad, estimate, &across, &up, &slopes)?;
        }
        for it in boxes {
            #[expect(clippy::cast_precision_loss, reason = "it is plotted")]
            let at = DVec2::new(across.at(it.size), up.at(it.count.max(1) as f64));
            pad.dot(at, it.used)?;
        }
        for (size, slope, used) in local_slopes(boxes) {
            pad.dot(DVec2::new(across.at(size), slopes.at(slope)), used)?;
        }
        let unit = self.options.unit.map(|unit| format!(" ({unit})"));
        pad.below(&format!("side of a box{}", unit.unwrap_or_default()), 646.0)?;
        pad.beside("boxes", COUNTS[0] - 12.0)?;
        pad.beside("local slope", SLOPES[0] - 8.0)
    }
}

impl Evidence<'_> {
    /// Returns the axis of local slopes.
    fn slopes(&self) -> Axis {
        let value = self.counting.estimate.map(|estimate| estimate.value);
        let slopes = local_slopes(&self.counting.boxes).map(|(_, slope, _)| slope);
        Axis::linear(slopes.chain(value), [SLOPES[1], SLOPES[0]])
    }

    /// Shades the range of the fit in both panels.
    fn range<S: Surface>(
        pad: &mut Pad<'_, S>,
        estimate: &Estimate,
        across: &Axis,
    ) -> io::Result<()> {
        let [from, to] = estimate.range.map(|size| across.at(size));
        for [top, bottom] in [COUNTS, SLOPES] {
            pad.area([from, top], [to, bottom], blue(26))?;
        }
        Ok(())
    }

    /// Draws the line of the fit, its slope with two standard errors on both sides in the panel below, and
    /// the value as text.
    fn fit<S: Surface>(
        pad: &mut Pad<'_, S>,
        estimate: &Estimate,
        across: &Axis,
        up: &Axis,
        slopes: &Axis,
    ) -> io::Result<()> {
        let line = |size: f64| {
            let count = libm::exp(estimate.intercept - estimate.value * libm::log(size));
            DVec2::new(across.at(size), up.at(count))
        };
        let [fine, coarse] = estimate.range;
        pad.line(&[line(fine), line(coarse)], orange(255), 1.8)?;
        let [from, to] = estimate.range.map(|size| across.at(size));
        let error = 2.0 * estimate.std_error;
        let [low, high] = [-error, error].map(|error| slopes.clamped(estimate.value + error));
        pad.area([from, high], [to, low], orange(50))?;
        let level = slopes.at(estimate.value);
        pad.line(
            &[DVec2::new(from, level), DVec2::new(to, level)],
            orange(255),
            1.8,
        )?;
        let lines = [
            format!("D = {:.4} ± {error:.4} (2 standard errors)", estimate.value),
            format!(
                "r² = {:.6}, {:.1} decades",
                estimate.r_squared,
                estimate.decades()
            ),
        ];
        for (text, baseline) in lines.iter().zip([24.0, 44.0]) {
            let width = pad.font.width(text, WORDS);
            let at = DVec2::new(RIGHT - 12.0 - width, COUNTS[0] + baseline);
            pad.text(text, WORDS, at, Anchor::Start)?;
        }
        Ok(())
    }
}

/// Iterates over the local slopes between neighbouring sizes: the geometric mean of the sizes, the slope, and
/// whether both sizes are used.
fn local_slopes(boxes: &[Boxes]) -> impl Iterator<Item = (f64, f64, bool)> {
    boxes.windows(2).filter_map(|pair| {
        let middle = (pair[0].size * pair[1].size).sqrt();
        Some((middle, pair[0].local_slope?, pair[0].used && pair[1].used))
    })
}
