//! Blocks: parts of a figure with a size, composed in rows and columns.

use crate::geometry::{DAffine2, DVec2};
use crate::render::{FINE, Paint, Position, RenderError, Surface, Tracer};
use crate::rule::Piece;
use crate::style::Colour;

use super::super::text::{Anchor, Font};

/// An open or closed path in pixels, with the y axis down.
#[derive(Clone, Debug)]
pub(super) struct Outline {
    pub(super) start: DVec2,
    pub(super) pieces: Vec<Piece>,
    pub(super) closed: bool,
}

impl Outline {
    pub(super) fn line(from: DVec2, to: DVec2) -> Self {
        Self {
            start: from,
            pieces: vec![Piece::Line(to)],
            closed: false,
        }
    }

    pub(super) fn circle(centre: DVec2, radius: f64) -> Self {
        // Each quarter of the circle is a cubic.
        let handle = 0.552_284_75 * radius;
        let mut out = DVec2::new(radius, 0.0);
        let mut pieces = Vec::new();
        let start = centre + out;
        for _ in 0..4 {
            let next = out.perp();
            let (a, b) = (out + next * handle / radius, next + out * handle / radius);
            pieces.push(Piece::Cubic(centre + a, centre + b, centre + next));
            out = next;
        }
        Self {
            start,
            pieces,
            closed: true,
        }
    }

    pub(super) fn transformed(&self, map: &DAffine2) -> Self {
        let pieces = self.pieces.iter().map(|piece| piece.transformed(map));
        Self {
            start: map.transform_point2(self.start),
            pieces: pieces.collect(),
            closed: self.closed,
        }
    }
}

/// A drawable item of a block.
#[derive(Clone, Debug)]
pub(super) enum BlockItem {
    /// A path, its paint, and the text that it stands for.
    Path(Vec<Outline>, Paint, Option<&'static str>),
    /// A line of text: its font size, the start of its baseline and its colour.
    Text(String, f64, DVec2, Colour),
}

/// A part of a figure: items and the size that they take.
#[derive(Clone, Debug, Default)]
pub(super) struct Block {
    pub(super) size: DVec2,
    pub(super) items: Vec<BlockItem>,
}

impl Block {
    /// Returns lines of text of a font size, flush left or centred.
    pub(super) fn text(font: &Font, lines: Vec<String>, size: f64, centred: bool) -> Self {
        let leading = (1.35 * size).round();
        let widths: Vec<_> = lines.iter().map(|line| font.width(line, size)).collect();
        let width = widths.iter().copied().fold(0.0, f64::max);
        let mut block = Self::default();
        for (line, own) in lines.into_iter().zip(widths) {
            let left = if centred { (width - own) / 2.0 } else { 0.0 };
            let baseline = block.size.y + (1.05 * size).round();
            let at = DVec2::new(left, baseline);
            block
                .items
                .push(BlockItem::Text(line, size, at, super::LABEL));
            block.size.y += leading;
        }
        block.size.x = width;
        block
    }

    /// Puts another block onto this one, with its corner at a point; the size grows to contain it.
    pub(super) fn put(&mut self, other: Self, at: DVec2) {
        let map = DAffine2::from_translation(at);
        let moved = other.items.into_iter().map(|item| match item {
            BlockItem::Path(outlines, paint, label) => {
                let outlines = outlines.iter().map(|it| it.transformed(&map)).collect();
                BlockItem::Path(outlines, paint, label)
            }
            BlockItem::Text(text, size, from, colour) => {
                BlockItem::Text(text, size, from + at, colour)
            }
        });
        self.items.extend(moved);
        self.size = self.size.max(at + other.size);
    }

    /// Returns the block centred in a width.
    pub(super) fn centred_in(self, width: f64) -> Self {
        let left = ((width - self.size.x) / 2.0).round();
        let mut centred = Self::default();
        centred.put(self, DVec2::new(left, 0.0));
        centred.size.x = width;
        centred
    }

    /// Returns blocks side by side, each vertically centred; blocks without width are left out.
    pub(super) fn row(blocks: Vec<Self>, gap: f64) -> Self {
        let height = blocks.iter().map(|it| it.size.y).fold(0.0, f64::max);
        let mut row = Self::default();
        for block in blocks.into_iter().filter(|block| block.size.x > 0.0) {
            let left = if row.size.x > 0.0 {
                row.size.x + gap
            } else {
                0.0
            };
            let top = ((height - block.size.y) / 2.0).round();
            row.put(block, DVec2::new(left, top));
        }
        row
    }

    /// Returns blocks below each other, flush left or centred; blocks without height are left out.
    pub(super) fn column(blocks: Vec<Self>, gap: f64, centred: bool) -> Self {
        let width = blocks.iter().map(|it| it.size.x).fold(0.0, f64::max);
        let mut column = Self::default();
        for block in blocks.into_iter().filter(|block| block.size.y > 0.0) {
            let top = if column.size.y > 0.0 {
                column.size.y + gap
            } else {
                0.0
            };
            let space = width - block.size.x;
            let left = if centred { (space / 2.0).round() } else { 0.0 };
            column.put(block, DVec2::new(left, top));
        }
        column
    }

    /// Returns blocks in rows that are at most `width` wide, unless a single block is wider.
    pub(super) fn flow(blocks: Vec<Self>, gap: DVec2, width: f64) -> Self {
        let mut lines: Vec<Vec<Self>> = Vec::new();
        let mut used = f64::INFINITY;
        for block in blocks {
            used += gap.x + block.size.x;
            if used > width {
                used = block.size.x;
                lines.push(Vec::new());
            }
            if let Some(line) = lines.last_mut() {
                line.push(block);
            }
        }
        let lines = lines.into_iter().map(|line| Self::row(line, gap.x));
        Self::column(lines.collect(), gap.y, false)
    }

    /// Draws the block, scaled by `scale`, with its corner at `corner`.
    pub(super) fn draw(
        &self,
        surface: &mut impl Surface,
        font: &Font,
        scale: f64,
        corner: DVec2,
    ) -> Result<(), RenderError> {
        let map = DAffine2::from_scale_angle_translation(DVec2::splat(scale), 0.0, corner);
        for item in &self.items {
            match item {
                BlockItem::Path(outlines, paint, label) => {
                    if let Some(label) = label {
                        surface.label(label);
                    }
                    let mut tracer = Tracer::new(surface);
                    tracer.begin(&scaled(*paint, scale))?;
                    for outline in outlines {
                        trace(&mut tracer, &outline.transformed(&map));
                    }
                    tracer.end()?;
                }
                BlockItem::Text(text, size, at, colour) => {
                    let at = map.transform_point2(*at);
                    font.draw(surface, text, size * scale, at, Anchor::Start, *colour)?;
                }
            }
        }
        Ok(())
    }
}

fn trace(tracer: &mut Tracer<'_, impl Surface>, outline: &Outline) {
    tracer.move_to(position(outline.start));
    for piece in &outline.pieces {
        match *piece {
            Piece::Line(to) => tracer.line_to(position(to)),
            Piece::Cubic(a, b, to) => tracer.curve_to(position(a), position(b), position(to)),
        }
    }
    if outline.closed {
        tracer.close(matches!(outline.pieces.last(), Some(Piece::Line(_))));
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "casts from floats saturate"
)]
fn position(pixel: DVec2) -> Position {
    [pixel.x, pixel.y].map(|value| (value * FINE).round() as i64)
}

fn scaled(mut paint: Paint, scale: f64) -> Paint {
    if let Some(stroke) = &mut paint.stroke {
        stroke.pen.width *= scale;
        stroke.pen.dash *= scale;
    }
    paint
}
