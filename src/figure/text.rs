//! Text of figures, drawn as outlines of Noto Sans: identical in every viewer, on every machine and in every
//! format.

use std::io;

use skrifa::instance::{LocationRef, Size};
use skrifa::metrics::GlyphMetrics;
use skrifa::outline::{DrawSettings, OutlinePen};
use skrifa::{FontRef, GlyphId, MetadataProvider};

use crate::geometry::DVec2;
use crate::render::{FINE, Paint, Position, Surface, Tracer, position};
use crate::style::Colour;

/// Font of all labels.
pub(super) struct Font {
    face: FontRef<'static>,
    advances: GlyphMetrics<'static>,
    units_per_em: f64,
}

/// Position of a label relative to its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    /// The label begins at the point.
    Start,
    /// The label is centred at the point.
    Middle,
}

impl Font {
    pub(super) fn new() -> Self {
        let face = match FontRef::new(notosans::REGULAR_TTF) {
            Ok(face) => face,
            Err(error) => unreachable!("the font is whole: {error}"),
        };
        let location = LocationRef::default();
        Self {
            advances: face.glyph_metrics(Size::unscaled(), location),
            units_per_em: face.metrics(Size::unscaled(), location).units_per_em.into(),
            face,
        }
    }

    /// Returns the pixels in a unit of the font, where an em has `size` pixels.
    fn scale(&self, size: f64) -> f64 {
        size / self.units_per_em
    }

    fn glyph(&self, character: char) -> GlyphId {
        self.face.charmap().map(character).unwrap_or_default()
    }

    fn advance(&self, glyph: GlyphId) -> f64 {
        self.advances
            .advance_width(glyph)
            .unwrap_or_default()
            .into()
    }

    /// Returns the width of a text in pixels.
    pub(super) fn width(&self, text: &str, size: f64) -> f64 {
        let glyphs = text.chars().map(|character| self.glyph(character));
        glyphs.map(|glyph| self.advance(glyph)).sum::<f64>() * self.scale(size)
    }

    /// Returns a text broken into lines of at most `width` pixels: between words, and within words that are
    /// too long.
    pub(super) fn wrap(&self, text: &str, size: f64, width: f64) -> Vec<String> {
        let mut lines = Vec::new();
        let mut line = String::new();
        for word in text.split_whitespace() {
            if !line.is_empty() && self.width(&format!("{line} {word}"), size) > width {
                lines.push(std::mem::take(&mut line));
            }
            if !line.is_empty() {
                line.push(' ');
            }
            for character in word.chars() {
                line.push(character);
                if self.width(&line, size) > width && line.chars().count() > 1 {
                    line.pop();
                    lines.push(std::mem::replace(&mut line, character.into()));
                }
            }
        }
        lines.extend((!line.is_empty()).then_some(line));
        lines
    }

    /// Draws a text of `size` pixels an em, with its baseline at `at` in pixels, y down.
    pub(super) fn draw(
        &self,
        surface: &mut impl Surface,
        text: &str,
        size: f64,
        at: DVec2,
        anchor: Anchor,
        colour: Colour,
    ) -> io::Result<()> {
        let before = match anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => self.width(text, size) / 2.0,
        };
        surface.label(text);
        let mut outline = Outline {
            tracer: Tracer::new(surface),
            origin: at - DVec2::new(before, 0.0),
            scale: self.scale(size),
            pen: DVec2::ZERO,
        };
        outline.tracer.begin(&Paint {
            fill: Some(colour),
            stroke: None,
            has_holes: true,
        })?;
        let outlines = self.face.outline_glyphs();
        let settings = || DrawSettings::unhinted(Size::unscaled(), LocationRef::default());
        for character in text.chars() {
            let glyph = self.glyph(character);
            if let Some(glyph) = outlines.get(glyph)
                && let Err(error) = glyph.draw(settings(), &mut outline)
            {
                unreachable!("the font is whole: {error}");
            }
            outline.origin.x += self.advance(glyph) * outline.scale;
        }
        outline.tracer.end()
    }
}

/// Draws the outlines of glyphs on a surface.
struct Outline<'s, S> {
    tracer: Tracer<'s, S>,
    /// Origin of the glyph, in pixels.
    origin: DVec2,
    scale: f64,
    /// The last point, in units of the font.
    pen: DVec2,
}

impl<S: Surface> Outline<'_, S> {
    fn position(&self, point: DVec2) -> Position {
        position((self.origin + DVec2::new(point.x, -point.y) * self.scale) * FINE)
    }
}

impl<S: Surface> OutlinePen for Outline<'_, S> {
    fn move_to(&mut self, x: f32, y: f32) {
        self.pen = point(x, y);
        self.tracer.move_to(self.position(self.pen));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.pen = point(x, y);
        self.tracer.line_to(self.position(self.pen));
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let (control, to) = (point(x1, y1), point(x, y));
        // A parabola is also a cubic.
        let (a, b) = (
            self.pen.lerp(control, 2.0 / 3.0),
            to.lerp(control, 2.0 / 3.0),
        );
        self.tracer
            .curve_to(self.position(a), self.position(b), self.position(to));
        self.pen = to;
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let (a, b, to) = (point(x1, y1), point(x2, y2), point(x, y));
        self.tracer
            .curve_to(self.position(a), self.position(b), self.position(to));
        self.pen = to;
    }

    fn close(&mut self) {
        self.tracer.close(false);
    }
}

fn point(x: f32, y: f32) -> DVec2 {
    DVec2::new(x.into(), y.into())
}

#[cfg(test)]
mod tests {
    use super::Font;

    #[test]
    fn lines_are_no_wider_than_they_may_be_and_lose_nothing() {
        let font = Font::new();
        let text = "  some words,\nand averyverylongwordthatfitsinnoline λ ";
        let lines = font.wrap(text, 10.0, 60.0);
        assert!(lines.len() > 3, "{lines:?}");
        assert!(lines.iter().all(|line| font.width(line, 10.0) <= 60.0));
        let letters = |text: &str| text.split_whitespace().collect::<String>();
        assert_eq!(letters(&lines.concat()), letters(text));
        assert_eq!(font.wrap(text, 10.0, 1e3).len(), 1);
        assert_eq!(font.wrap("", 10.0, 60.0), Vec::<String>::new());
        // A width below that of a letter puts one letter on each line.
        assert_eq!(font.wrap("ab", 10.0, 1.0), ["a", "b"]);
    }
}
