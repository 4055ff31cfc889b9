//! Paths that are drawn by tiny-skia.

use std::ops::Range;

use tiny_skia::{
    BlendMode, FillRule, LineCap, LineJoin, Paint as Ink, PathBuilder, PathSegment, Pixmap,
    PixmapMut, PixmapPaint, Point, StrokeDash, Transform,
};

use crate::render::paint::{FINE, Paint, Position, Stroke};
use crate::style::{Blend, Cap, Colour, Join};

use super::split::{ROWS, split};

/// Approximate number of vertices of the pieces in which a path is drawn that is only stroked.
const STROKE_CHUNK: usize = 1 << 17;

/// Approximate number of vertices of the pieces, broken between subpaths, in which a path is drawn that is
/// only filled. A path that has more nevertheless is filled some rows at a time, each of about as many
/// vertices: filling takes many times the memory of the vertices.
const FILL_CHUNK: usize = 1 << 20;

/// SVG's limit of the length of a mitre, in widths.
pub(super) const MITER_LIMIT: f32 = 4.0;

/// Path, drawn in pieces if it is long.
#[derive(Default)]
pub(super) struct Outline {
    paint: Paint,
    path: PathBuilder,
    /// Number of vertices of the path.
    length: usize,
    /// Start of the subpath.
    start: [f32; 2],
    /// Position of the pen.
    pen: [f32; 2],
    /// Previous position, if a straight line leads from there.
    before: Option<[f32; 2]>,
    /// Whether the start of the subpath has been drawn in an earlier piece.
    is_broken: bool,
    /// First row of the band and first row after it, if the picture is drawn in bands.
    band: Option<[u32; 2]>,
    /// Whether paths are joined, and covered by others; otherwise each is mixed with those before it.
    blend: Blend,
    /// Layer that collects the pieces of a translucent path before it is laid over the rest.
    layer: Option<Pixmap>,
}

impl Outline {
    /// Creates an outline for a band of rows.
    pub(super) fn of_rows(rows: Range<u32>) -> Self {
        Self {
            band: Some([rows.start, rows.end]),
            ..Self::default()
        }
    }

    /// Moves to another band of rows, if the picture is drawn in bands.
    pub(super) fn move_to_rows(&mut self, rows: &Range<u32>) {
        if let Some(band) = &mut self.band {
            *band = [rows.start, rows.end];
        }
    }

    pub(super) fn begin(&mut self, paint: Paint) {
        self.paint = paint;
    }

    /// Sets the mixing of paths.
    pub(super) fn blend_by(&mut self, blend: Blend) {
        self.blend = blend;
    }

    /// Returns whether overlapping parts of a path are one area.
    pub(super) fn is_joined(&self) -> bool {
        self.blend == Blend::Joined
    }

    #[inline]
    pub(super) fn move_to(&mut self, to: Position) {
        self.move_to_pixel(pixels(to));
    }

    fn move_to_pixel(&mut self, [x, y]: [f32; 2]) {
        self.path.move_to(x, y);
        self.length += 1;
        (self.start, self.pen, self.before) = ([x, y], [x, y], None);
        self.is_broken = false;
    }

    #[inline]
    pub(super) fn line_to(&mut self, to: Position) {
        self.line_to_pixel(pixels(to));
    }

    #[inline]
    fn line_to_pixel(&mut self, [x, y]: [f32; 2]) {
        self.path.line_to(x, y);
        self.length += 1;
        self.before = Some(self.pen);
        self.pen = [x, y];
    }

    #[inline]
    pub(super) fn curve_to(&mut self, a: Position, b: Position, to: Position) {
        self.curve_to_pixel(pixels(a), pixels(b), pixels(to));
    }

    fn curve_to_pixel(&mut self, [ax, ay]: [f32; 2], [bx, by]: [f32; 2], [x, y]: [f32; 2]) {
        self.path.cubic_to(ax, ay, bx, by, x, y);
        // Curves are flattened to several lines.
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

    /// Draws the accumulated portion of a long stroke.
    #[inline]
    pub(super) fn hand_on(&mut self, pixmap: &mut Pixmap) {
        if self.length > STROKE_CHUNK && self.paint.fill.is_none() {
            self.flush(pixmap, false);
            self.is_broken = true;
            // The last line is repeated, so that its corner with the next one is drawn.
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

    /// Draws the accumulated portion of the path.
    fn flush(&mut self, pixmap: &mut Pixmap, is_whole: bool) {
        if self.path.is_empty() && self.layer.is_none() {
            return;
        }
        let builder = std::mem::take(&mut self.path);
        let is_long = self.length > FILL_CHUNK && self.paint.fill.is_some();
        let pieces = self.length / FILL_CHUNK + 1;
        self.length = 0;
        let Some(path) = builder.finish() else { return };
        let paint = self.paint;
        let opacity = paint
            .fill
            .or(paint.stroke.map(|stroke| stroke.colour))
            .map_or(255, |colour| colour.rgba()[3]);
        let in_pieces = opacity < 255 && (self.layer.is_some() || !is_whole);
        let blend = self.blend;
        let draw = |pixmap: &mut Pixmap, paint: &Paint| match self.band {
            band if is_long => draw_long(pixmap, &path, (paint, blend), band, pieces),
            None => draw(pixmap, &path, (paint, blend)),
            Some(rows) => draw_band(pixmap, &path, (paint, blend), rows),
        };
        if !in_pieces {
            let is_mixed = !matches!(blend, Blend::Joined | Blend::Normal);
            match paint.stroke {
                Some(stroke) if is_mixed && !is_long && paint.fill.is_some() => {
                    draw_as_one(pixmap, &path, (&paint, blend), (&stroke, self.band));
                }
                _ => draw(pixmap, &paint),
            }
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

/// Converts a position to pixels.
#[inline]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    reason = "what lies on the picture is exact to 0.01 pixels"
)]
fn pixels(position: Position) -> [f32; 2] {
    position.map(|fine| (fine as f64 / FINE) as f32)
}

fn draw(pixmap: &mut Pixmap, path: &tiny_skia::Path, (paint, blend): (&Paint, Blend)) {
    let none = Transform::identity();
    if let Some(fill) = paint.fill {
        pixmap.fill_path(path, &ink(fill, blend), FillRule::Winding, none, None);
    }
    // A stroke of width 0 is empty, not a hairline.
    if let Some(stroke) = paint.stroke
        && stroke.pen.width > 0.0
    {
        pixmap.stroke_path(
            path,
            &ink(stroke.colour, blend),
            &shape(&stroke),
            none,
            None,
        );
    }
}

/// Draws a path whose stroke covers its fill before both together are mixed with what lies below.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    reason = "casts from floats saturate, and pictures are small"
)]
fn draw_as_one(
    pixmap: &mut Pixmap,
    path: &tiny_skia::Path,
    (paint, blend): (&Paint, Blend),
    (stroke, band): (&Stroke, Option<[u32; 2]>),
) {
    let reach = stroke.pen.width as f32 / 2.0 * MITER_LIMIT + 1.0;
    let bounds = path.bounds();
    let rows = band.unwrap_or([0, pixmap.height()]);
    let within = |[from, to]: [f32; 2], [least, most]: [u32; 2]| {
        let side = |value: f32| (value as u32).clamp(least, most);
        [side(from - reach), side((to + reach).ceil())]
    };
    let [left, right] = within([bounds.left(), bounds.right()], [0, pixmap.width()]);
    let [top, bottom] = within([bounds.top(), bounds.bottom()], rows);
    let moved = path.clone();
    let moved = moved.transform(Transform::from_translate(-(left as f32), -(top as f32)));
    let layer = Pixmap::new(right - left, bottom - top);
    if let (Some(mut layer), Some(moved)) = (layer, moved) {
        draw(&mut layer, &moved, (paint, Blend::Normal));
        let mixed = PixmapPaint {
            blend_mode: mode(blend),
            ..PixmapPaint::default()
        };
        let at = [left, top].map(u32::cast_signed);
        let none = Transform::identity();
        pixmap.draw_pixmap(at[0], at[1], layer.as_ref(), &mixed, none, None);
    }
}

/// Draws a path of many vertices: fills some rows at a time, and strokes it in pieces.
fn draw_long(
    pixmap: &mut Pixmap,
    path: &tiny_skia::Path,
    (paint, blend): (&Paint, Blend),
    band: Option<[u32; 2]>,
    pieces: usize,
) {
    let [width, height] = [pixmap.width(), pixmap.height()];
    if let Some(colour) = paint.fill {
        let rows = (height as usize / pieces + 1).next_multiple_of(ROWS as usize);
        let row = 4 * width as usize;
        let mut top = band.map_or(0, |[top, _]| top);
        for bytes in pixmap.data_mut().chunks_mut(row * rows) {
            #[expect(clippy::cast_possible_truncation, reason = "rows of a picture")]
            let rows = (bytes.len() / row) as u32;
            let piece = split(path, [top, top + rows]);
            let part = PixmapMut::from_bytes(bytes, width, rows);
            if let (Some(piece), Some(mut part)) = (piece, part) {
                let none = Transform::identity();
                part.fill_path(&piece, &ink(colour, blend), FillRule::Winding, none, None);
            }
            top += rows;
        }
    }
    let mut stroked = Outline {
        paint: Paint {
            fill: None,
            ..*paint
        },
        band,
        blend,
        ..Outline::default()
    };
    let pixel = |point: Point| [point.x, point.y];
    for segment in path.segments().filter(|_| paint.stroke.is_some()) {
        match segment {
            PathSegment::MoveTo(to) => stroked.move_to_pixel(pixel(to)),
            PathSegment::LineTo(to) => stroked.line_to_pixel(pixel(to)),
            PathSegment::CubicTo(a, b, to) => {
                stroked.curve_to_pixel(pixel(a), pixel(b), pixel(to));
            }
            PathSegment::QuadTo(..) => unreachable!("paths have lines and cubic curves"),
            PathSegment::Close => stroked.close(pixmap),
        }
        stroked.hand_on(pixmap);
    }
    stroked.end(pixmap);
}

/// Draws the part of a path that lies in the given rows of a picture.
fn draw_band(
    pixmap: &mut Pixmap,
    path: &tiny_skia::Path,
    (paint, blend): (&Paint, Blend),
    rows: [u32; 2],
) {
    let none = Transform::identity();
    let mut fill = |path: Option<tiny_skia::Path>, colour| {
        if let Some(path) = path {
            pixmap.fill_path(&path, &ink(colour, blend), FillRule::Winding, none, None);
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

fn mode(blend: Blend) -> BlendMode {
    match blend {
        Blend::Joined | Blend::Normal => BlendMode::SourceOver,
        Blend::Multiply => BlendMode::Multiply,
        Blend::Add => BlendMode::Plus,
        Blend::Screen => BlendMode::Screen,
    }
}

fn ink(colour: Colour, blend: Blend) -> Ink<'static> {
    let mut ink = Ink {
        blend_mode: mode(blend),
        ..Ink::default()
    };
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
        // `None` without dashes.
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
        has_holes: false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a jagged star of many vertices.
    fn star() -> tiny_skia::Path {
        const COUNT: u32 = 300_000;
        let mut path = PathBuilder::new();
        for number in 0..COUNT {
            let turn = f64::from(number) / f64::from(COUNT) * std::f64::consts::TAU;
            let radius = 20.0 + 7.0 * libm::sin(7.0 * turn) + 0.3 * f64::from(number % 2);
            let place = [
                40.0 + radius * libm::cos(turn),
                30.0 + radius * libm::sin(turn),
            ];
            #[expect(clippy::cast_possible_truncation, reason = "pixels are given in f32")]
            let [x, y] = place.map(|place| place as f32);
            if number == 0 {
                path.move_to(x, y);
            } else {
                path.line_to(x, y);
            }
        }
        path.close();
        path.finish().unwrap()
    }

    fn differences(a: &Pixmap, b: &Pixmap) -> Vec<u8> {
        let values = a.data().iter().zip(b.data());
        values.map(|(a, b)| a.abs_diff(*b)).collect()
    }

    #[test]
    fn a_long_path_is_drawn_as_a_whole_one() {
        let path = star();
        let fill = Paint {
            fill: Some(Colour::of_rgba([250, 120, 0, 255])),
            stroke: None,
            has_holes: false,
        };
        let stroke = Stroke {
            colour: Colour::BLACK,
            pen: crate::render::paint::Pen {
                width: 1.2,
                cap: Cap::Butt,
                join: Join::Miter,
                dash: 0.0,
            },
        };
        let both = Paint {
            stroke: Some(stroke),
            ..fill
        };
        for paint in [fill, both] {
            let [mut whole, mut long] = [(); 2].map(|()| Pixmap::new(80, 60).unwrap());
            draw(&mut whole, &path, (&paint, Blend::Joined));
            draw_long(&mut long, &path, (&paint, Blend::Joined), None, 4);
            let differences = differences(&whole, &long);
            let sum: u64 = differences.iter().map(|&off| u64::from(off)).sum();
            let mean = sum as f64 / differences.len() as f64;
            assert!(mean < 0.1, "{mean}");
            // Pieces of a stroke overlap where it is divided.
            let far = differences.iter().filter(|&&off| off > 16).count();
            assert!(far <= if paint.stroke.is_some() { 20 } else { 0 }, "{far}");
            assert!(whole.data().iter().any(|&value| value > 0));
        }
    }

    #[test]
    fn rows_of_a_long_path_do_not_depend_on_the_pieces() {
        let path = star();
        let paint = Paint {
            fill: Some(Colour::BLACK),
            stroke: None,
            has_holes: false,
        };
        let mut whole = Pixmap::new(80, 60).unwrap();
        draw_long(&mut whole, &path, (&paint, Blend::Joined), None, 4);
        let mut band = Pixmap::new(80, 20).unwrap();
        draw_long(&mut band, &path, (&paint, Blend::Joined), Some([20, 40]), 3);
        assert!(band.data() == &whole.data()[4 * 80 * 20..4 * 80 * 40]);
    }
}
