//! Parts of a picture, with their pixels and their coverage.

use std::ops::Range;
use std::sync::Arc;

use tiny_skia::{Color, Pixmap, PixmapPaint, Transform};

use crate::render::paint::Paint;
use crate::style::Colour;

use super::MAX_PIXELS;
use super::buffers::CoverageBuffers;
use super::coverage::{CoverageBuffer, WHOLE};
use super::split::ROWS;

/// Maximum number of pixels of pictures with coverage buffers; larger ones would take more memory with them
/// than the largest picture does without.
const MAX_COVERED: u64 = MAX_PIXELS * 4 / (4 + CoverageBuffer::BYTES);

/// Part of a picture, or all of it.
pub(super) struct PicturePart {
    pub(super) pixmap: Pixmap,
    /// Width and height of the part, in pixels.
    size: [u32; 2],
    /// Rows of it that are drawn.
    rows: Range<u32>,
    /// Position in the part that contains it, in pixels.
    corner: [u32; 2],
    /// Coverage that is not coloured yet: of paths, and of the strokes of paths that are filled too, which
    /// lie on top.
    layers: [Layer; 2],
}

/// Coverage in one colour.
#[derive(Default)]
struct Layer {
    /// Coverage buffers, once anything has been covered.
    planes: Option<Arc<CoverageBuffers>>,
    ink: Option<Colour>,
}

/// Coverage buffers of a part's layers.
pub(super) type Layers = [Option<Arc<CoverageBuffers>>; 2];

impl PicturePart {
    /// Creates a part of this one, with its rows that lie in the rows of this one, or a few more: the first
    /// is a multiple of [`ROWS`].
    pub(super) fn enter(&self, corner: [u32; 2], size: [u32; 2]) -> Option<Self> {
        let within = |row: u32| row.saturating_sub(corner[1]).min(size[1]);
        let [from, to] = [self.rows.start, self.rows.end].map(within);
        Self::of_rows(corner, size, from - from % ROWS..to, None)
    }

    /// Returns whether any of a part of this one lies in its rows.
    pub(super) fn shows(&self, corner: [u32; 2], size: [u32; 2]) -> bool {
        corner[1] < self.rows.end && corner[1].saturating_add(size[1]) > self.rows.start
    }

    /// Returns the rows that are drawn.
    pub(super) fn rows(&self) -> Range<u32> {
        self.rows.clone()
    }

    /// Creates some rows of a part, on the pixels of another picture of their size if there are any; `None` if it has no
    /// valid size.
    pub(super) fn of_rows(
        corner: [u32; 2],
        size: [u32; 2],
        rows: Range<u32>,
        spare: Option<Pixmap>,
    ) -> Option<Self> {
        let (width, height) = (size[0], rows.end - rows.start);
        let cleared = spare.map(|mut pixmap| {
            pixmap.fill(Color::TRANSPARENT);
            pixmap
        });
        Some(Self {
            pixmap: match cleared {
                Some(pixmap) => pixmap,
                None => Pixmap::new(width, height)?,
            },
            size,
            rows,
            corner,
            layers: Default::default(),
        })
    }

    /// Returns the part with coverage buffers that have been used for other rows, or for another picture.
    pub(super) fn on(mut self, layers: Layers) -> Self {
        for (layer, planes) in self.layers.iter_mut().zip(layers) {
            let planes = planes.and_then(Arc::into_inner);
            let moved = planes.and_then(|planes| planes.moved_to(self.size, &self.rows));
            layer.planes = moved.map(Arc::new);
        }
        self
    }

    /// Returns the width and height of the part, in pixels.
    pub(super) fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns whether the part is small enough for coverage buffers.
    pub(super) fn may_cover(&self) -> bool {
        let pixels = u64::from(self.pixmap.width()) * u64::from(self.pixmap.height());
        pixels <= MAX_COVERED
    }

    /// Returns the coverage buffers that exist.
    pub(super) fn planes(&self) -> Layers {
        self.layers.each_ref().map(|layer| layer.planes.clone())
    }

    /// Returns the coverage buffers in use: of paths, and of the strokes on top of them if these are
    /// separate.
    pub(super) fn planes_in_use(&self) -> Layers {
        let in_use = |layer: &Layer| layer.planes.clone().filter(|_| layer.ink.is_some());
        self.layers.each_ref().map(in_use)
    }

    /// Returns whether a path of this colour is covered together with the preceding ones, without
    /// preparation.
    #[inline]
    pub(super) fn continues_in(&self, colour: Colour) -> bool {
        self.layers[0].ink == Some(colour) && self.layers[1].ink.is_none()
    }

    /// Returns whether coverage must be coloured before a path begins. Paths of one opaque colour share the
    /// buffers, since their order has no effect.
    pub(super) fn settles_before(&self, paint: &Paint) -> bool {
        let stroke = paint.stroke.map(|stroke| stroke.colour);
        let mut colours = [paint.fill, stroke].into_iter().flatten();
        let ink = self.layers[0].ink;
        ink.is_some() && !colours.all(|colour| ink == Some(colour))
    }

    /// Begins a path that covers anything, in one colour, or in two for its area and its stroke.
    pub(super) fn begin(&mut self, inks: [Option<Colour>; 2], threads: usize) {
        for (number, ink) in inks
            .into_iter()
            .enumerate()
            .filter(|(_, ink)| ink.is_some())
        {
            self.made_planes(number, threads);
            self.layers[number].ink = ink;
        }
    }

    fn made_planes(&mut self, layer: usize, threads: usize) -> &Arc<CoverageBuffers> {
        let planes = || Arc::new(CoverageBuffers::new(self.size, self.rows.clone(), threads));
        self.layers[layer].planes.get_or_insert_with(planes)
    }

    /// Returns whether coverage must be coloured before the next path, regardless of that path.
    #[inline]
    pub(super) fn settles_after(&self) -> bool {
        let [paths, strokes] = self.layers.each_ref().map(|layer| layer.ink);
        strokes.is_some() || paths.is_some_and(|ink| ink != ink.opaque())
    }

    /// Colours the coverage, once all threads have finished.
    pub(super) fn settle(&mut self) {
        let (pixels, _) = self.pixmap.data_mut().as_chunks_mut::<4>();
        for Layer { planes, ink } in &mut self.layers {
            let (Some(planes), Some(ink)) = (planes, ink.take()) else {
                continue;
            };
            let [red, green, blue, opacity] = ink.rgba();
            const FULL: u32 = WHOLE * 255;
            let is_grey = red == green && green == blue;
            planes.drain(pixels, |values, covered| {
                let part = covered * u32::from(opacity);
                if part == FULL {
                    *values = [red, green, blue, 255];
                    return;
                }
                #[expect(clippy::cast_possible_truncation, reason = "a mean of bytes")]
                let mix = |ink: u8, value: u8| {
                    let mixed = u32::from(ink) * part + u32::from(value) * (FULL - part);
                    ((mixed + FULL / 2) / FULL) as u8
                };
                let [first, second, third, alpha] = *values;
                *values = if is_grey && first == second && second == third && alpha == 255 {
                    let grey = mix(red, first);
                    [grey, grey, grey, 255]
                } else {
                    [
                        mix(red, first),
                        mix(green, second),
                        mix(blue, third),
                        mix(255, alpha),
                    ]
                };
            });
        }
    }

    /// Draws the part onto the part that contains it.
    #[expect(clippy::cast_possible_wrap, reason = "pictures are smaller than that")]
    pub(super) fn lay_on(self, other: &mut Self) {
        let [x, y] = self.corner.map(|side| side as i32);
        let top = y + self.rows.start as i32 - other.rows.start as i32;
        let (over, none) = (PixmapPaint::default(), Transform::identity());
        let own = self.pixmap.as_ref();
        other.pixmap.draw_pixmap(x, top, own, &over, none, None);
    }
}
