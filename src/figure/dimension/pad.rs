//! Drawing of plots: a page with a title, framed panels, lines and dots.

use std::io::{self, Write};
use std::num::NonZero;

use crate::geometry::DVec2;
use crate::parallel::Team;
use crate::render::{
    self, Drawing, FINE, Paint, Pen, Position, RenderError, Stroke, Surface, Tracer, position,
    write_drawing,
};
use crate::style::{Cap, Colour, Join};

use super::super::text::{Anchor, Font};
use super::DimensionFigureOptions;
use super::axis::{Axis, Label};

/// Left side of all panels, in pixels.
pub(super) const LEFT: f64 = 76.0;
/// Right side of all panels, in pixels.
pub(super) const RIGHT: f64 = 700.0;

pub(super) const WORDS: f64 = 14.0;
const INK: Colour = Colour::grey(30);
const PALE: Colour = Colour::grey(165);

/// Returns the colour of measured values.
pub(super) fn blue(opacity: u8) -> Colour {
    Colour::of_rgba([58, 127, 192, opacity])
}

/// Returns the colour of fits, and of lines that join values.
pub(super) fn orange(opacity: u8) -> Colour {
    Colour::of_rgba([205, 98, 30, opacity])
}

/// Content of a page.
pub(super) trait Plot {
    /// Returns width and height in pixels.
    fn size(&self) -> [u32; 2];
    /// Draws the plot below the title.
    fn draw<S: Surface>(&self, pad: &mut Pad<'_, S>) -> io::Result<()>;
}

/// Writes a plot on white, under its title; returns width and height in pixels.
pub(super) fn write(
    plot: &(impl Plot + Sync),
    options: &DimensionFigureOptions,
    out: &mut impl Write,
) -> Result<[u32; 2], RenderError> {
    let page = Page {
        plot,
        title: &options.labels.title,
        font: Font::new(),
    };
    let options = render::Options {
        format: options.format,
        labels: options.labels.clone(),
        threads: NonZero::<usize>::MIN,
        ..render::Options::default()
    };
    write_drawing(&page, &options, out)?;
    Ok(plot.size())
}

struct Page<'a, P> {
    plot: &'a P,
    title: &'a str,
    font: Font,
}

impl<P: Plot + Sync> Drawing for Page<'_, P> {
    fn size(&self) -> [u32; 2] {
        self.plot.size()
    }

    fn background(&self) -> Option<Colour> {
        Some(Colour::grey(255))
    }

    fn pen(&self) -> Pen {
        pen(1.0)
    }

    fn draw<'w>(&'w self, surface: &mut impl Surface, _: &Team<'w>) -> Result<(), RenderError> {
        let mut pad = Pad {
            surface,
            font: &self.font,
        };
        let middle = DVec2::new(f64::midpoint(LEFT, RIGHT), 27.0);
        pad.text(self.title, 17.0, middle, Anchor::Middle)?;
        Ok(self.plot.draw(&mut pad)?)
    }
}

/// Draws the frame of a panel with the ticks and labels of its axes.
pub(super) fn frame<S: Surface>(
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

/// A surface with the font, in pixels.
pub(super) struct Pad<'s, S> {
    surface: &'s mut S,
    pub(super) font: &'s Font,
}

impl<S: Surface> Pad<'_, S> {
    pub(super) fn text(
        &mut self,
        text: &str,
        size: f64,
        at: DVec2,
        anchor: Anchor,
    ) -> io::Result<()> {
        self.font.draw(self.surface, text, size, at, anchor, INK)
    }

    /// Draws a number, or a power of ten with its exponent; the share `part` of its width lies left of the
    /// point.
    fn number(&mut self, label: &Label, at: DVec2, part: f64) -> io::Result<()> {
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

    /// Draws the label of the vertical axis, above its end.
    pub(super) fn beside(&mut self, words: &str, baseline: f64) -> io::Result<()> {
        self.text(words, WORDS, DVec2::new(10.0, baseline), Anchor::Start)
    }

    /// Draws the label of the horizontal axis, below it.
    pub(super) fn below(&mut self, words: &str, baseline: f64) -> io::Result<()> {
        let middle = f64::midpoint(LEFT, RIGHT);
        self.text(words, WORDS, DVec2::new(middle, baseline), Anchor::Middle)
    }

    pub(super) fn line(&mut self, points: &[DVec2], colour: Colour, width: f64) -> io::Result<()> {
        self.path(
            points,
            &Paint {
                fill: None,
                stroke: Some(Stroke {
                    colour,
                    pen: pen(width),
                }),
                has_holes: false,
            },
        )
    }

    pub(super) fn area(&mut self, from: [f64; 2], to: [f64; 2], colour: Colour) -> io::Result<()> {
        let corners = [from, [to[0], from[1]], to, [from[0], to[1]], from];
        self.path(
            &corners.map(DVec2::from_array),
            &Paint {
                fill: Some(colour),
                stroke: None,
                has_holes: false,
            },
        )
    }

    /// Draws a dot, pale where the fit does not use it.
    pub(super) fn dot(&mut self, at: DVec2, used: bool) -> io::Result<()> {
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
