//! The evidence for a box-counting dimension: counts over sizes with the fitted line, and local
//! slopes below.

mod axis;
mod series;

pub use series::write_series;

use std::io::{self, Write};
use std::num::NonZero;

use crate::geometry::DVec2;
use crate::measure::{BoxCounting, Boxes, Estimate};
use crate::parallel::Team;
use crate::render::{
    Drawing, FINE, Format, Labels, Paint, Pen, Position, RenderError, Stroke, Surface, Tracer,
    position, write_drawing,
};
use crate::style::{Cap, Colour, Join};

use super::text::{Anchor, Font};
use axis::Axis;

/// The size in pixels.
const SIZE: [u32; 2] = [720, 660];

/// The sides of the two panels, in pixels from above and from the left.
const LEFT: f64 = 76.0;
const RIGHT: f64 = 700.0;
const COUNTS: [f64; 2] = [44.0, 404.0];
const SLOPES: [f64; 2] = [432.0, 600.0];

const WORDS: f64 = 14.0;
const INK: Colour = Colour::grey(30);
const PALE: Colour = Colour::grey(165);

fn blue(opacity: u8) -> Colour {
    Colour::of_rgba([58, 127, 192, opacity])
}

fn orange() -> Colour {
    Colour::of_rgba([205, 98, 30, 255])
}

/// How the plot is made.
#[derive(Clone, Debug)]
pub struct Options {
    /// The format.
    pub format: Format,
    /// What the sizes of boxes are measured in, as "pixels"; nothing where they have no unit.
    pub unit: Option<&'static str>,
    /// What the file says of itself. The title stands above the plot.
    pub labels: Labels,
}

/// Plots a measured dimension on white; tells its width and height in pixels.
///
/// # Errors
///
/// If `out` fails.
pub fn write(
    counting: &BoxCounting,
    options: &Options,
    out: &mut impl Write,
) -> Result<[u32; 2], RenderError> {
    let plot = Plot {
        counting,
        options,
        font: Font::new(),
    };
    let one = NonZero::<usize>::MIN;
    write_drawing(&plot, options.format, &options.labels, one, out)?;
    Ok(SIZE)
}

struct Plot<'a> {
    counting: &'a BoxCounting,
    options: &'a Options,
    font: Font,
}

impl Drawing for Plot<'_> {
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
        let boxes = &self.counting.boxes;
        let sizes = boxes.iter().map(|it| it.size);
        let across = Axis::logarithmic(sizes, [LEFT, RIGHT]);
        #[expect(clippy::cast_precision_loss, reason = "it is plotted")]
        let counts = boxes.iter().map(|it| it.count.max(1) as f64);
        let up = Axis::logarithmic(counts, [COUNTS[1], COUNTS[0]]);
        let mut pad = Pad {
            surface,
            font: &self.font,
        };
        let middle = f64::midpoint(LEFT, RIGHT);
        pad.text(
            &self.options.labels.title,
            17.0,
            DVec2::new(middle, 27.0),
            Anchor::Middle,
        )?;
        let slopes = self.slopes();
        if let Some(estimate) = &self.counting.estimate {
            self.range(&mut pad, estimate, &across)?;
        }
        frame(&mut pad, &across, &up, COUNTS, false)?;
        frame(&mut pad, &across, &slopes, SLOPES, true)?;
        if let Some(estimate) = &self.counting.estimate {
            self.fit(&mut pad, estimate, &across, &up, &slopes)?;
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
        let sides = format!("side of a box{}", unit.unwrap_or_default());
        pad.text(&sides, WORDS, DVec2::new(middle, 646.0), Anchor::Middle)?;
        pad.text(
            "boxes",
            WORDS,
            DVec2::new(10.0, COUNTS[0] - 12.0),
            Anchor::Start,
        )?;
        pad.text(
            "local slope",
            WORDS,
            DVec2::new(10.0, SLOPES[0] - 8.0),
            Anchor::Start,
        )?;
        Ok(())
    }
}

impl Plot<'_> {
    /// The axis of local slopes.
    fn slopes(&self) -> Axis {
        let value = self.counting.estimate.map(|estimate| estimate.value);
        let slopes = local_slopes(&self.counting.boxes).map(|(_, slope, _)| slope);
        Axis::linear(slopes.chain(value), [SLOPES[1], SLOPES[0]])
    }

    /// The range of the fit, shaded in both panels.
    fn range<S: Surface>(
        &self,
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

    /// The line of the fit, its slope below with two standard errors on both sides, and the value.
    fn fit<S: Surface>(
        &self,
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
        pad.line(&[line(fine), line(coarse)], orange(), 1.8)?;
        let [from, to] = estimate.range.map(|size| across.at(size));
        let error = 2.0 * estimate.std_error;
        let [low, high] = [-error, error].map(|error| slopes.clamped(estimate.value + error));
        pad.area([from, high], [to, low], Colour::of_rgba([205, 98, 30, 50]))?;
        let level = slopes.at(estimate.value);
        pad.line(
            &[DVec2::new(from, level), DVec2::new(to, level)],
            orange(),
            1.8,
        )?;
        let says = [
            format!("D = {:.4} ± {error:.4} (2 standard errors)", estimate.value),
            format!(
                "r² = {:.6}, {:.1} decades",
                estimate.r_squared,
                estimate.decades()
            ),
        ];
        for (text, baseline) in says.iter().zip([24.0, 44.0]) {
            let width = pad.font.width(text, WORDS);
            let at = DVec2::new(RIGHT - 12.0 - width, COUNTS[0] + baseline);
            pad.text(text, WORDS, at, Anchor::Start)?;
        }
        Ok(())
    }
}

/// Local slopes between two sizes, at their geometric mean; used if both are.
fn local_slopes(boxes: &[Boxes]) -> impl Iterator<Item = (f64, f64, bool)> {
    boxes.windows(2).filter_map(|pair| {
        let middle = (pair[0].size * pair[1].size).sqrt();
        Some((middle, pair[0].local_slope?, pair[0].used && pair[1].used))
    })
}

/// The frame of a panel with the ticks and labels of its axes.
fn frame<S: Surface>(
    pad: &mut Pad<'_, S>,
    across: &Axis,
    up: &Axis,
    [top, bottom]: [f64; 2],
    labelled: bool,
) -> io::Result<()> {
    let corners = [
        [LEFT, top],
        [RIGHT, top],
        [RIGHT, bottom],
        [LEFT, bottom],
        [LEFT, top],
    ];
    pad.line(&corners.map(DVec2::from_array), INK, 1.0)?;
    for tick in across.ticks() {
        let length = if tick.label.is_some() { 7.0 } else { 4.0 };
        for (from, inward) in [(bottom, -length), (top, length)] {
            let from = DVec2::new(tick.at, from);
            pad.line(&[from, from + DVec2::new(0.0, inward)], INK, 1.0)?;
        }
        if let (Some(label), true) = (&tick.label, labelled) {
            pad.number(label, DVec2::new(tick.at, bottom + 19.0), 0.5)?;
        }
    }
    for tick in up.ticks() {
        let length = if tick.label.is_some() { 7.0 } else { 4.0 };
        for (from, inward) in [(LEFT, length), (RIGHT, -length)] {
            let from = DVec2::new(from, tick.at);
            pad.line(&[from, from + DVec2::new(inward, 0.0)], INK, 1.0)?;
        }
        if let Some(label) = &tick.label {
            pad.number(label, DVec2::new(LEFT - 8.0, tick.at + 5.0), 1.0)?;
        }
    }
    Ok(())
}

/// A surface to draw on, in pixels.
struct Pad<'s, S> {
    surface: &'s mut S,
    font: &'s Font,
}

impl<S: Surface> Pad<'_, S> {
    fn text(&mut self, text: &str, size: f64, at: DVec2, anchor: Anchor) -> io::Result<()> {
        self.font.draw(self.surface, text, size, at, anchor, INK)
    }

    /// A number, or a power of ten with its exponent; `part` of it stands before the point.
    fn number(&mut self, label: &axis::Label, at: DVec2, part: f64) -> io::Result<()> {
        const SMALL: f64 = 10.0;
        let (base, exponent) = label.parts();
        let width = self.font.width(&base, WORDS - 1.0);
        let all = width + self.font.width(&exponent, SMALL);
        let from = at - DVec2::new(all * part, 0.0);
        self.text(&base, WORDS - 1.0, from, Anchor::Start)?;
        if exponent.is_empty() {
            return Ok(());
        }
        self.text(
            &exponent,
            SMALL,
            from + DVec2::new(width, -6.0),
            Anchor::Start,
        )
    }

    fn line(&mut self, points: &[DVec2], colour: Colour, width: f64) -> io::Result<()> {
        self.path(
            points,
            &Paint {
                fill: None,
                stroke: Some(Stroke {
                    colour,
                    pen: pen(width),
                }),
            },
        )
    }

    fn area(&mut self, from: [f64; 2], to: [f64; 2], colour: Colour) -> io::Result<()> {
        let corners = [from, [to[0], from[1]], to, [from[0], to[1]], from];
        self.path(
            &corners.map(DVec2::from_array),
            &Paint {
                fill: Some(colour),
                stroke: None,
            },
        )
    }

    /// A dot, pale where the fit does not use it.
    fn dot(&mut self, at: DVec2, used: bool) -> io::Result<()> {
        let colour = if used { blue(255) } else { PALE };
        self.line(&[at, at], colour, 6.0)
    }

    fn path(&mut self, points: &[DVec2], paint: &Paint) -> io::Result<()> {
        let mut tracer = Tracer::new(self.surface);
        tracer.begin(paint)?;
        for (number, &point) in points.iter().enumerate() {
            let at: Position = position(point * FINE);
            if number == 0 {
                tracer.move_to(at);
            } else {
                tracer.line_to(at);
            }
        }
        tracer.end()
    }
}

fn pen(width: f64) -> Pen {
    Pen {
        width,
        cap: Cap::Round,
        join: Join::Round,
        dash: 0.0,
    }
}
