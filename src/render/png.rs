//! PNG: the paths of a picture, antialiased. Narrow strokes, and opaque areas that are small or have very
//! many vertices, are drawn as coverage by any thread; there may be millions of them. tiny-skia draws the
//! rest.
//!
//! A pass takes less work than paths do by the [`Means`] that scene and surface permit: sprites, segment batches
//! and outlines of fewer vertices.

mod batch;
mod buffers;
mod chunk;
mod coverage;
mod encode;
mod flat;
mod level_of_detail;
mod means;
mod part;
mod raster;
mod region;
mod ring;
mod skia;
mod spare;
mod split;
mod sprites;
mod stroker;
#[cfg(test)]
mod tests;

pub(super) use coverage::SegmentBatch;
pub(super) use encode::{Colours, encode as write_pixels, encode_pieces};
pub(super) use level_of_detail::LevelOfDetail;
pub(super) use means::Means;
pub(super) use raster::PlacedSprite;
pub(crate) use raster::Raster;
pub(super) use spare::Spare;
pub(crate) use spare::Spares;
pub(super) use split::ROWS as BAND_ROWS;
pub(super) use sprites::{KeptSprites, Put};

use std::convert::Infallible;
use std::io::{self, Write};
use std::ops::Range;

pub(super) use tiny_skia::Pixmap;

use crate::parallel::{Pipeline, Team};
use crate::style::{Blend, Colour};

use self::chunk::{Chunk, Command};
pub(super) use self::coverage::flattened;
use self::coverage::{SpritePaint, bounding, has_room};
use self::part::PicturePart;
use self::region::Region;
use self::skia::Outline;
use self::stroker::{Stroker, Strokers, Trail};
use super::options::Options;
use super::paint::{Paint, Position, Stroke};
use super::surface::Surface;

/// Maximum number of pixels of a picture: two gibibytes.
const MAX_PIXELS: u64 = 1 << 29;

/// Error that a picture would take too much memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "a PNG of {0} x {1} pixels takes {gigabytes:.1} GB of memory, and {most:.1} GB is the most; an SVG of this size takes none",
    size[0], size[1], gigabytes = bytes(.size), most = MAX_PIXELS as f64 * 4e-9
)]
pub struct TooManyPixels {
    /// Width and height of the picture, in pixels.
    pub size: [u32; 2],
}

impl TooManyPixels {
    /// Returns an error if a picture would take too much memory.
    pub(crate) fn check(size: [u32; 2]) -> Result<(), Self> {
        let [width, height] = size.map(u64::from);
        if width * height > MAX_PIXELS {
            return Err(Self { size });
        }
        Ok(())
    }
}

/// Returns the memory that a picture takes, in gigabytes.
fn bytes(size: &[u32; 2]) -> f64 {
    f64::from(size[0]) * f64::from(size[1]) * 4e-9
}

/// Picture in memory.
pub(super) struct Png<'t, 'w> {
    /// Part of the picture that is drawn on.
    part: PicturePart,
    /// Parts from which it was entered.
    outer: Vec<PicturePart>,
    /// Shapes that are not submitted yet.
    chunk: Chunk,
    /// Pipeline that covers chunks.
    line: Pipeline<'t, 'w, Chunk>,
    threads: usize,
    strokers: Strokers,
    /// Stroker of the path, if its strokes are drawn as coverage.
    stroker: Option<Stroker>,
    /// State of the current subpath.
    trail: Trail,
    /// Whether the path may contain polygons that are drawn as coverage.
    covers: bool,
    /// Vertices of the current polygon.
    ring: Vec<Position>,
    /// Outlines with too many vertices for a polygon.
    region: Region,
    /// Portion of the path that tiny-skia draws.
    outline: Outline,
    /// Whether tiny-skia draws any portion.
    is_outlined: bool,
}

impl<'t, 'w> Png<'t, 'w> {
    /// Begins a picture.
    pub(super) fn begin(
        size: [u32; 2],
        background: Option<Colour>,
        spare: Spare,
        team: &'t Team<'w>,
    ) -> Result<Self, TooManyPixels> {
        let height = size[1];
        TooManyPixels::check(size)?;
        Self::begin_on(size, 0..height, Outline::default(), background, spare, team)
    }

    /// Begins a band of a picture: some of its rows, the first of which is a multiple of [`BAND_ROWS`]. Their
    /// contents do not depend on where bands begin.
    pub(super) fn begin_band(
        size: [u32; 2],
        rows: Range<u32>,
        background: Option<Colour>,
        spare: Spare,
        team: &'t Team<'w>,
    ) -> Result<Self, TooManyPixels> {
        let outline = Outline::of_rows(rows.clone());
        Self::begin_on(size, rows, outline, background, spare, team)
    }

    fn begin_on(
        size: [u32; 2],
        rows: Range<u32>,
        outline: Outline,
        background: Option<Colour>,
        mut spare: Spare,
        team: &'t Team<'w>,
    ) -> Result<Self, TooManyPixels> {
        let pixels = spare.take_pixels([size[0], rows.end - rows.start]);
        let part = PicturePart::of_rows([0, 0], size, rows, pixels);
        let mut part = part.ok_or(TooManyPixels { size })?.on(spare.layers);
        if let Some(background) = background {
            let [red, green, blue, opacity] = background.rgba();
            part.pixmap
                .fill(tiny_skia::Color::from_rgba8(red, green, blue, opacity));
        }
        Ok(Self {
            part,
            outer: Vec::new(),
            chunk: spare.chunk,
            line: team.line(Chunk::cover),
            threads: team.threads().get(),
            strokers: spare.strokers,
            stroker: None,
            trail: Trail::default(),
            covers: false,
            ring: Vec::new(),
            region: Region::default(),
            outline,
            is_outlined: false,
        })
    }

    /// Sets the mixing of paths that overlap, for drawings that are [separated](super::blended).
    pub(super) fn blending(mut self, blend: Blend) -> Self {
        self.outline.blend_by(blend);
        self
    }

    /// Returns the pixels of the rows, and memory for another band.
    pub(super) fn into_pixels(mut self) -> (Pixmap, Spare) {
        self.settle();
        let spare = Spare {
            pixmap: None,
            layers: self.part.planes(),
            chunk: self.chunk,
            strokers: self.strokers,
        };
        (self.part.pixmap, spare)
    }

    /// Encodes the picture, and returns memory for another one.
    pub(super) fn write(self, options: &Options, out: &mut impl Write) -> io::Result<Spare> {
        let (pixmap, spare) = self.into_pixels();
        encode::encode(&pixmap, &options.labels, options.png, out)?;
        Ok(Spare {
            pixmap: Some(pixmap),
            ..spare
        })
    }

    /// Draws lines of the path as coverage, one after another.
    #[inline]
    fn stroke(&mut self, to: impl IntoIterator<Item = Position>) {
        let trail = &mut self.trail;
        match self.stroker {
            Some(Stroker::Flat(_)) => self
                .chunk
                .list
                .lines(to.into_iter().inspect(|to| trail.go_to(*to))),
            Some(_) => self.chunk.list.lines(to),
            None => {}
        }
    }

    /// Submits the current chunk if it is full.
    #[inline]
    fn hand_on_chunk(&mut self) {
        if self.chunk.is_full() {
            self.next_chunk();
        }
    }

    fn next_chunk(&mut self) {
        let mut next = self.line.spare().unwrap_or_default();
        if let Some(stroker) = &self.stroker {
            self.chunk.lead_to(&mut next, stroker.clone(), &self.trail);
        }
        let mut chunk = std::mem::replace(&mut self.chunk, next);
        chunk.assign(self.part.planes_in_use());
        let Ok(()) = self.line.hand_on::<Infallible>(chunk, &mut |_| Ok(()));
    }

    /// Colours everything that has been covered, between two paths.
    fn settle(&mut self) {
        self.stroker = None;
        if self.line.is_idle() {
            // The work is not worth another thread.
            self.chunk.assign(self.part.planes_in_use());
            self.chunk.cover();
        } else if !self.chunk.is_empty() {
            self.next_chunk();
        }
        let Ok(()) = self.line.finish::<Infallible>(&mut |_| Ok(()));
        self.part.settle();
    }
}

/// Returns the colours of the two layers of coverage, for colours of areas and strokes.
fn inks(fill: Option<Colour>, stroke: Option<Colour>) -> [Option<Colour>; 2] {
    match (fill, stroke) {
        (Some(fill), Some(stroke)) if fill != stroke => [Some(fill), Some(stroke)],
        (fill, stroke) => [stroke.or(fill), None],
    }
}

impl Surface for Png<'_, '_> {
    #[inline]
    fn begin(&mut self, paint: &Paint) -> io::Result<()> {
        // There may be a path for every stroke, each of another width.
        let is_joined = self.outline.is_joined();
        if let (Some(stroke), None) = (paint.stroke, paint.fill)
            && is_joined
            && self.part.continues_in(stroke.colour)
            && let Some(stroker) = self.strokers.stroker(stroke.pen)
        {
            self.chunk.stroker(stroker.clone());
            self.stroker = Some(stroker);
            (self.covers, self.is_outlined) = (false, false);
            return Ok(());
        }
        if self.part.settles_before(paint) {
            self.settle();
        }
        let may_cover = is_joined && self.part.may_cover();
        let stroke = paint.stroke.filter(|_| may_cover);
        self.stroker = stroke.and_then(|stroke| self.strokers.stroker(stroke.pen));
        let strokes = self.stroker.is_some();
        let is_opaque = paint.fill.is_some_and(|fill| fill == fill.opaque());
        // Holes would be filled if subpaths were covered one by one.
        self.covers =
            may_cover && is_opaque && !paint.has_holes && (paint.stroke.is_none() || strokes);
        let stroke = paint.stroke.map(|stroke| stroke.colour);
        let inks = inks(
            paint.fill.filter(|_| self.covers),
            stroke.filter(|_| strokes),
        );
        if self.covers || strokes {
            self.part.begin(inks, self.threads);
        }
        if let Some(stroker) = &self.stroker {
            self.chunk.stroker(stroker.clone());
        }
        let rest = Paint {
            stroke: paint.stroke.filter(|_| !strokes),
            ..*paint
        };
        self.is_outlined = rest != Paint::default();
        if self.covers {
            self.region.begin(self.part.size()[0], self.part.rows());
        }
        self.outline.begin(rest);
        Ok(())
    }

    #[inline]
    fn move_to(&mut self, to: Position) {
        self.trail = Trail::of(to);
        if self.stroker.is_some() {
            self.chunk.list.push_at(Command::Start, to);
        }
        if self.covers {
            self.end_ring();
            self.ring.push(to);
        } else if self.is_outlined {
            self.outline.move_to(to);
        }
    }

    #[inline]
    fn line_to(&mut self, to: Position) {
        self.stroke([to]);
        self.trail.at = to;
        if self.covers {
            self.ring_to([to].into_iter());
        } else if self.is_outlined {
            self.outline.line_to(to);
        }
    }

    #[inline]
    fn lines_to(&mut self, to: &[Position]) {
        if self.is_outlined {
            return to.iter().for_each(|&to| self.line_to(to));
        }
        self.stroke(to.iter().copied());
        self.trail.at = to.last().copied().unwrap_or(self.trail.at);
    }

    fn segments(&mut self, ends: &[Position]) {
        let segments = ends.as_chunks().0;
        let Some(&[from, to]) = segments.last() else {
            return;
        };
        if self.covers || self.is_outlined {
            for &[from, to] in segments {
                self.move_to(from);
                self.line_to(to);
            }
            return;
        }
        if self.stroker.is_some() {
            self.chunk.list.segments((), ends);
        }
        self.trail = Trail::of(from);
        self.trail.go_to(to);
    }

    #[inline]
    fn curve_to(&mut self, a: Position, b: Position, to: Position) {
        let curve = [self.trail.at, a, b, to];
        self.stroke(flattened(curve));
        self.trail.at = to;
        if self.covers {
            self.ring_to(bounding(curve));
        } else if self.is_outlined {
            self.outline.curve_to(a, b, to);
        }
    }

    fn close(&mut self) {
        self.stroke([self.trail.start]);
        if let Some(Stroker::Flat(_)) = self.stroker {
            self.chunk.list.push(Command::Close);
        }
        self.trail.at = self.trail.start;
        self.trail.is_open = false;
        if !self.ring.is_empty() {
            self.end_ring();
        } else if self.covers {
            self.close_region();
        } else if self.is_outlined {
            self.outline.close(&mut self.part.pixmap);
        }
    }

    #[inline]
    fn hand_on(&mut self) -> io::Result<()> {
        if self.is_outlined {
            self.outline.hand_on(&mut self.part.pixmap);
        }
        self.hand_on_chunk();
        Ok(())
    }

    #[inline]
    fn end(&mut self) -> io::Result<()> {
        if let Some(Stroker::Flat(_)) = self.stroker.take() {
            self.chunk.list.push(Command::End);
        }
        if self.covers {
            self.end_ring();
            self.region.close();
            self.cover_region();
        }
        if self.is_outlined {
            self.outline.end(&mut self.part.pixmap);
        }
        if self.part.settles_after() {
            self.settle();
        }
        self.hand_on_chunk();
        Ok(())
    }

    fn broadens(&self, paint: &Paint) -> bool {
        // Opaque areas are covered at least a pixel wide.
        paint.fill.is_some_and(|fill| fill != fill.opaque())
    }

    fn raster(&mut self) -> Option<&mut dyn Raster> {
        Some(self)
    }

    fn enter(&mut self, corner: [u32; 2], size: [u32; 2]) -> io::Result<bool> {
        if !self.part.shows(corner, size) {
            return Ok(false);
        }
        let part = self.part.enter(corner, size);
        let part = part.ok_or(io::ErrorKind::OutOfMemory)?;
        self.settle();
        self.outline.move_to_rows(&part.rows());
        self.outer.push(std::mem::replace(&mut self.part, part));
        Ok(true)
    }

    fn leave(&mut self) -> io::Result<()> {
        self.settle();
        if let Some(outer) = self.outer.pop() {
            let part = std::mem::replace(&mut self.part, outer);
            part.lay_on(&mut self.part);
            self.outline.move_to_rows(&self.part.rows());
        }
        Ok(())
    }
}

impl Raster for Png<'_, '_> {
    fn polygons(&mut self, vertices: &[Position], sides: usize) -> usize {
        if !self.covers || self.stroker.is_some() {
            return 0;
        }
        self.end_ring();
        let polygons = vertices.chunks_exact(sides);
        let covered = polygons.take_while(|polygon| has_room(polygon));
        covered
            .map(|polygon| {
                self.chunk.polygon(polygon);
                self.hand_on_chunk();
            })
            .count()
    }

    fn takes_batches(&self, paint: &Paint) -> bool {
        let is_plain = |Stroke { colour, pen }| pen.dash == 0.0 && colour == colour.opaque();
        paint.stroke.is_some_and(is_plain) && self.part.may_cover()
    }

    fn batches(&mut self, batches: &[SegmentBatch]) {
        self.chunk.list.batches(batches.iter().copied());
    }

    fn sprite_paint(&mut self, paint: &Paint) -> Option<SpritePaint> {
        let pen = match paint.stroke.map(|stroke| self.strokers.stroker(stroke.pen)) {
            None => None,
            Some(Some(Stroker::Round(pen))) => Some(pen),
            Some(Some(Stroker::Hair(_) | Stroker::Flat(_)) | None) => return None,
        };
        let stroke = paint.stroke.map(|stroke| stroke.colour);
        let mut inks = [paint.fill, stroke].into_iter().flatten();
        let outlines = paint.fill.is_some() && pen.is_some();
        let is_opaque = inks.all(|ink| ink == ink.opaque());
        (is_opaque && self.part.may_cover()).then_some(SpritePaint { pen, outlines })
    }

    fn sprites(&mut self, sprites: &[PlacedSprite]) {
        self.chunk.list.sprites((), sprites);
    }
}
