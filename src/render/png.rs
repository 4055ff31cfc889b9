//! PNG: the paths of a picture, drawn by tiny-skia with antialiasing.

mod encode;

use std::io::{self, Write};

use tiny_skia::{
    FillRule, LineCap, LineJoin, Paint as Ink, PathBuilder, Pixmap, PixmapPaint, StrokeDash,
    Transform,
};

use crate::style::{Cap, Colour, Join};

use super::Labels;
use super::surface::{FINE, Paint, Position, Stroke, Surface};

/// The most pixels that a picture may have: two gibibytes.
const MOST_PIXELS: u64 = 1 << 29;

/// A path that is only stroked is drawn in pieces of about this many vertices,
const STROKE_CHUNK: usize = 1 << 17;

/// and one that is only filled in pieces of about this many, broken between subpaths.
const FILL_CHUNK: usize = 1 << 20;

/// SVG's limit of a mitre's length, in widths.
const MITER_LIMIT: f32 = 4.0;

/// A picture that memory should not be asked to hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "a PNG of {0} x {1} pixels takes {gigabytes:.1} GB of memory, and {most:.1} GB is the most; an SVG of this size takes none",
    size[0], size[1], gigabytes = bytes(.size), most = MOST_PIXELS as f64 * 4e-9
)]
pub struct TooManyPixels {
    /// Its width and height.
    pub size: [u32; 2],
}

/// The gigabytes that a picture takes.
fn bytes(size: &[u32; 2]) -> f64 {
    f64::from(size[0]) * f64::from(size[1]) * 4e-9
}

/// A picture in memory.
pub(super) struct Png {
    /// The picture, and the parts of it that have been entered, each with its corner.
    parts: Vec<(Pixmap, [u32; 2])>,
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
    /// Pieces of one path that is not opaque come together here before they are laid over the rest.
    layer: Option<Pixmap>,
}

impl Png {
    /// Begins a picture.
    pub(super) fn begin(size: [u32; 2], background: Option<Colour>) -> Result<Self, TooManyPixels> {
        let [width, height] = size;
        if u64::from(width) * u64::from(height) > MOST_PIXELS {
            return Err(TooManyPixels { size });
        }
        let mut pixmap = Pixmap::new(width, height).ok_or(TooManyPixels { size })?;
        if let Some(background) = background {
            let [red, green, blue, opacity] = background.rgba();
            pixmap.fill(tiny_skia::Color::from_rgba8(red, green, blue, opacity));
        }
        Ok(Self {
            parts: vec![(pixmap, [0, 0])],
            paint: Paint::default(),
            path: PathBuilder::new(),
            length: 0,
            start: [0.0; 2],
            pen: [0.0; 2],
            before: None,
            is_broken: false,
            layer: None,
        })
    }

    /// Encodes the picture.
    pub(super) fn write(mut self, labels: &Labels, out: &mut impl Write) -> io::Result<()> {
        let Some((pixmap, _)) = self.parts.pop() else {
            return Ok(());
        };
        // Into memory first: the encoder would not tell why `out` fails.
        let mut bytes = Vec::new();
        encode::encode(&pixmap, labels, &mut bytes)?;
        out.write_all(&bytes)
    }

    /// The pixels that are drawn on.
    fn pixmap(&mut self) -> &mut Pixmap {
        let Some((pixmap, _)) = self.parts.last_mut() else {
            unreachable!("a part is left only after it has been entered");
        };
        pixmap
    }

    /// Draws what there is of the path.
    fn flush(&mut self, is_whole: bool) {
        let builder = std::mem::take(&mut self.path);
        self.length = 0;
        let Some(path) = builder.finish() else { return };
        let opacity = self
            .paint
            .fill
            .or(self.paint.stroke.map(|stroke| stroke.colour))
            .map_or(255, |colour| colour.rgba()[3]);
        let in_pieces = opacity < 255 && (self.layer.is_some() || !is_whole);
        let paint = self.paint;
        if !in_pieces {
            draw(self.pixmap(), &path, &paint);
            return;
        }
        let (width, height) = (self.pixmap().width(), self.pixmap().height());
        let mut layer = self.layer.take().or_else(|| Pixmap::new(width, height));
        if let Some(layer) = &mut layer {
            draw(layer, &path, &opaque(paint));
            if is_whole {
                let over = PixmapPaint {
                    opacity: f32::from(opacity) / 255.0,
                    ..PixmapPaint::default()
                };
                let none = Transform::identity();
                self.pixmap()
                    .draw_pixmap(0, 0, layer.as_ref(), &over, none, None);
                return;
            }
        }
        self.layer = layer;
    }
}

impl Surface for Png {
    fn begin(&mut self, paint: &Paint) -> io::Result<()> {
        self.paint = *paint;
        Ok(())
    }

    #[inline]
    fn move_to(&mut self, to: Position) {
        let [x, y] = pixels(to);
        self.path.move_to(x, y);
        self.length += 1;
        (self.start, self.pen, self.before) = ([x, y], [x, y], None);
        self.is_broken = false;
    }

    #[inline]
    fn line_to(&mut self, to: Position) {
        let [x, y] = pixels(to);
        self.path.line_to(x, y);
        self.length += 1;
        self.before = Some(self.pen);
        self.pen = [x, y];
    }

    #[inline]
    fn curve_to(&mut self, a: Position, b: Position, to: Position) {
        let ([ax, ay], [bx, by], [x, y]) = (pixels(a), pixels(b), pixels(to));
        self.path.cubic_to(ax, ay, bx, by, x, y);
        // A curve is flattened to some lines.
        self.length += 4;
        self.before = None;
        self.pen = [x, y];
    }

    fn close(&mut self) {
        if self.is_broken {
            let [x, y] = self.start;
            self.path.line_to(x, y);
        } else {
            self.path.close();
        }
        (self.pen, self.before) = (self.start, None);
        if self.paint.stroke.is_none() && self.length > FILL_CHUNK {
            self.flush(false);
        }
    }

    #[inline]
    fn hand_on(&mut self) -> io::Result<()> {
        if self.length > STROKE_CHUNK && self.paint.fill.is_none() {
            self.flush(false);
            self.is_broken = true;
            // The last line comes again, so that its corner with the next one is drawn.
            let [x, y] = self.before.unwrap_or(self.pen);
            self.path.move_to(x, y);
            if self.before.is_some() {
                self.path.line_to(self.pen[0], self.pen[1]);
            }
        }
        Ok(())
    }

    fn end(&mut self) -> io::Result<()> {
        self.flush(true);
        Ok(())
    }

    fn enter(&mut self, corner: [u32; 2], [width, height]: [u32; 2]) -> io::Result<()> {
        let pixmap = Pixmap::new(width, height).ok_or(io::ErrorKind::OutOfMemory)?;
        self.parts.push((pixmap, corner));
        Ok(())
    }

    #[expect(clippy::cast_possible_wrap, reason = "pictures are smaller than that")]
    fn leave(&mut self) -> io::Result<()> {
        if let Some((part, [x, y])) = self.parts.pop() {
            let (over, none) = (PixmapPaint::default(), Transform::identity());
            self.pixmap()
                .draw_pixmap(x as i32, y as i32, part.as_ref(), &over, none, None);
        }
        Ok(())
    }

    fn label(&mut self, _: &str) {}
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
