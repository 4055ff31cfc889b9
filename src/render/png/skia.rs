//! Paths that tiny-skia draws.

use std::ops::Range;

use tiny_skia::{
    FillRule, LineCap, LineJoin, Paint as Ink, PathBuilder, Pixmap, PixmapPaint, StrokeDash,
    Transform,
};

use crate::render::surface::{FINE, Paint, Position, Stroke};
use crate::style::{Cap, Colour, Join};

use super::split::split;

/// A path that is only stroked is drawn in pieces of about this many vertices,
const STROKE_CHUNK: usize = 1 << 17;

/// and one that is only filled in pieces of about this many, broken between subpaths.
const FILL_CHUNK: usize = 1 << 20;

/// SVG's limit of a mitre's length, in widths.
pub(super) const MITER_LIMIT: f32 = 4.0;

/// A path, in pieces if it is long.
#[derive(Default)]
pub(super) struct Outline {
    paint: Paint,
    path: PathBuilder,
    /// The number of vertices in the path.
    length: usize,
    /// Where the subpath starts.
    start: [f32; 2],
    /// The pen's position, and the one before it if a straight line leads from there.
    pen: [f32; 2],
    before: Option<[f32; 2]>,
    /// Whether the start of the subpath has been drawn in an earlier piece.
    is_broken: bool,
    /// The rows of the picture that are drawn, where it is drawn in bands.
    band: Option<[u32; 2]>,
    /// Pieces of one path that is not opaque come together here before they are laid over the rest.
    layer: Option<Pixmap>,
}

impl Outline {
    /// What is drawn of paths in a band of rows.
    pub(super) fn of_rows(rows: Range<u32>) -> Self {
        Self {
            band: Some([rows.start, rows.end]),
            ..Self::default()
        }
    }

    pub(super) fn begin(&mut self, paint: Paint) {
        self.paint = paint;
    }

    #[inline]
    pub(super) fn move_to(&mut self, to: Position) {
        let [x, y] = pixels(to);
        self.path.move_to(x, y);
        self.length += 1;
        (self.start, self.pen, self.before) = ([x, y], [x, y], None);
        self.is_broken = false;
    }

    #[inline]
    pub(super) fn line_to(&mut self, to: Position) {
        let [x, y] = pixels(to);
        self.path.line_to(x, y);
        self.length += 1;
        self.before = Some(self.pen);
        self.pen = [x, y];
    }

    #[inline]
    pub(super) fn curve_to(&mut self, a: Position, b: Position, to: Position) {
        let ([ax, ay], [bx, by], [x, y]) = (pixels(a), pixels(b), pixels(to));
        self.path.cubic_to(ax, ay, bx, by, x, y);
        // A curve is flattened to some lines.
        self.length += 4;
        self.before = None;
        self.pen = [x, y];
    }

    pub(super) fn close(&mut self, pixmap: &mut Pixmap) {
        if self.is_broken {
            let [x, y] = self.start;
            self.path.line_to(x, y);
        } else {
            self.path.close();
        }
        (self.pen, self.before) = (self.start, None);
        if self.paint.stroke.is_none() && self.length > FILL_CHUNK {
            self.flush(pixmap, false);
        }
    }

    /// Draws what there is of a long stroke.
    #[inline]
    pub(super) fn hand_on(&mut self, pixmap: &mut Pixmap) {
        if self.length > STROKE_CHUNK && self.paint.fill.is_none() {
            self.flush(pixmap, false);
            self.is_broken = true;
            // The last line comes again, so that its corner with the next one is drawn.
            let [x, y] = self.before.unwrap_or(self.pen);
            self.path.move_to(x, y);
            if self.before.is_some() {
                self.path.line_to(self.pen[0], self.pen[1]);
            }
        }
    }

    pub(super) fn end(&mut self, pixmap: &mut Pixmap) {
        self.flush(pixmap, true);
    }

    /// Draws what there is of the path.
    fn flush(&mut self, pixmap: &mut Pixmap, is_whole: bool) {
        if self.path.is_empty() && self.layer.is_none() {
            return;
        }
        let builder = std::mem::take(&mut self.path);
        self.length = 0;
        let Some(path) = builder.finish() else { return };
        let paint = self.paint;
        let opacity = paint
            .fill
            .or(paint.stroke.map(|stroke| stroke.colour))
            .map_or(255, |colour| colour.rgba()[3]);
        let in_pieces = opacity < 255 && (self.layer.is_some() || !is_whole);
        let draw = |pixmap: &mut Pixmap, paint: &Paint| match self.band {
            None => draw(pixmap, &path, paint),
            Some(rows) => draw_band(pixmap, &path, paint, rows),
        };
        if !in_pieces {
            draw(pixmap, &paint);
            return;
        }
        let (width, height) = (pixmap.width(), pixmap.height());
        let mut layer = self.layer.take().or_else(|| Pixmap::new(width, height));
        if let Some(layer) = &mut layer {
            draw(layer, &opaque(paint));
            if is_whole {
                let over = PixmapPaint {
                    opacity: f32::from(opacity) / 255.0,
                    ..PixmapPaint::default()
                };
                let none = Transform::identity();
                pixmap.draw_pixmap(0, 0, layer.as_ref(), &over, none, None);
                return;
            }
        }
        self.layer = layer;
    }
}

/// A position in pixels.
#[inline]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    reason = "what lies on the picture is exact to 0.01 pixels"
)]
fn pixels(position: Position) -> [f32; 2] {
    position.map(|fine| (fine as f64 / FINE) as f32)
}

fn draw(pixmap: &mut Pixmap, path: &tiny_skia::Path, paint: &Paint) {
    let none = Transform::identity();
    if let Some(fill) = paint.fill {
        pixmap.fill_path(path, &ink(fill), FillRule::Winding, none, None);
    }
    // A stroke of no width is nothing, not a hairline.
    if let Some(stroke) = paint.stroke
        && stroke.pen.width > 0.0
    {
        pixmap.stroke_path(path, &ink(stroke.colour), &shape(&stroke), none, None);
    }
}

/// Draws what rows of a picture show of a path.
fn draw_band(pixmap: &mut Pixmap, path: &tiny_skia::Path, paint: &Paint, rows: [u32; 2]) {
    let none = Transform::identity();
    let mut fill = |path: Option<tiny_skia::Path>, colour| {
        if let Some(path) = path {
            pixmap.fill_path(&path, &ink(colour), FillRule::Winding, none, None);
        }
    };
    if let Some(colour) = paint.fill {
        fill(split(path, rows), colour);
    }
    if let Some(stroke) = paint.stroke
        && stroke.pen.width > 0.0
        && let Some(outline) = path.stroke(&shape(&stroke), 1.0)
    {
        fill(split(&outline, rows), stroke.colour);
    }
}

fn ink(colour: Colour) -> Ink<'static> {
    let mut ink = Ink::default();
    let [red, green, blue, opacity] = colour.rgba();
    ink.set_color_rgba8(red, green, blue, opacity);
    ink
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "widths need no more than f32"
)]
fn shape(Stroke { pen, .. }: &Stroke) -> tiny_skia::Stroke {
    let dash = pen.dash as f32;
    tiny_skia::Stroke {
        width: pen.width as f32,
        miter_limit: MITER_LIMIT,
        line_cap: match pen.cap {
            Cap::Round => LineCap::Round,
            Cap::Butt => LineCap::Butt,
            Cap::Square => LineCap::Square,
        },
        line_join: match pen.join {
            Join::Round => LineJoin::Round,
            Join::Bevel => LineJoin::Bevel,
            Join::Miter => LineJoin::Miter,
        },
        // None where there are no dashes.
        dash: StrokeDash::new(vec![dash, dash], 0.0),
    }
}

fn opaque(paint: Paint) -> Paint {
    Paint {
        fill: paint.fill.map(Colour::opaque),
        stroke: paint.stroke.map(|stroke| Stroke {
            colour: stroke.colour.opaque(),
            ..stroke
        }),
    }
}
