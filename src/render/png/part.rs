use tiny_skia::{Pixmap, PixmapPaint, Transform};

use crate::render::surface::Paint;
use crate::style::Colour;

use super::MOST_PIXELS;
use super::coverage::{Plane, WHOLE};

/// Pictures of more pixels have no plane of coverage: with it they would take more memory than the
/// largest.
const MOST_COVERED: u64 = MOST_PIXELS * 4 / (4 + Plane::BYTES);

/// A part of a picture, or all of it.
pub(super) struct Part {
    pub(super) pixmap: Pixmap,
    size: [u32; 2],
    /// Its place in what it is a part of.
    corner: [u32; 2],
    /// What is covered and not yet coloured, once something has been, and its colour.
    plane: Option<Plane>,
    ink: Option<Colour>,
}

impl Part {
    pub(super) fn new(corner: [u32; 2], size: [u32; 2]) -> Option<Self> {
        Some(Self {
            pixmap: Pixmap::new(size[0], size[1])?,
            size,
            corner,
            plane: None,
            ink: None,
        })
    }

    /// A part of the same size where something is covered, but nothing is coloured.
    pub(super) fn fork(&self) -> Option<Self> {
        Some(Self {
            size: self.size,
            ..Self::new([0, 0], [1, 1])?
        })
    }

    /// Covers what a fork does in a colour.
    pub(super) fn join(&mut self, fork: &Self, ink: Colour) {
        if self.ink != Some(ink) {
            self.settle();
        }
        let Some(forked) = &fork.plane else { return };
        self.ink = Some(ink);
        let plane = self.plane.get_or_insert_with(|| Plane::new(self.size));
        plane.add(forked);
    }

    /// Whether the part is small enough to have a plane.
    pub(super) fn may_cover(&self) -> bool {
        let [width, height] = self.size.map(u64::from);
        width * height <= MOST_COVERED
    }

    /// What paths cover, if any does.
    #[inline]
    pub(super) fn plane(&mut self) -> Option<&mut Plane> {
        self.plane.as_mut()
    }

    /// Whether a path of a colour goes on where others were covered, with nothing to be done.
    #[inline]
    pub(super) fn goes_on_in(&self, colour: Colour) -> bool {
        self.ink == Some(colour)
    }

    /// Begins a path. Paths of one opaque colour share the plane, whoever draws them: in what
    /// order they come does not show.
    pub(super) fn begin(&mut self, paint: &Paint, covers: bool) {
        let stroke = paint.stroke.map(|stroke| stroke.colour);
        let mut colours = [paint.fill, stroke].into_iter().flatten();
        if !colours.all(|colour| self.ink == Some(colour)) {
            self.settle();
        }
        if covers {
            self.ink = stroke.or(paint.fill);
            self.plane.get_or_insert_with(|| Plane::new(self.size));
        }
    }

    /// Ends a path.
    #[inline]
    pub(super) fn end(&mut self) {
        if self.ink.is_some_and(|ink| ink != ink.opaque()) {
            self.settle();
        }
    }

    /// Colours what has been covered.
    pub(super) fn settle(&mut self) {
        let (Some(plane), Some(ink)) = (&mut self.plane, self.ink.take()) else {
            return;
        };
        let [red, green, blue, opacity] = ink.rgba();
        let whole = WHOLE * 255;
        let data = self.pixmap.data_mut();
        plane.drain(|pixel, covered| {
            let part = covered * u32::from(opacity);
            let values = &mut data[4 * pixel..][..4];
            for (value, ink) in values.iter_mut().zip([red, green, blue, 255]) {
                let mixed = u32::from(ink) * part + u32::from(*value) * (whole - part);
                #[expect(clippy::cast_possible_truncation, reason = "a mean of bytes")]
                {
                    *value = ((mixed + whole / 2) / whole) as u8;
                }
            }
        });
    }

    /// Lays the part on what it is a part of.
    #[expect(clippy::cast_possible_wrap, reason = "pictures are smaller than that")]
    pub(super) fn lay_on(mut self, pixmap: &mut Pixmap) {
        self.settle();
        let [x, y] = self.corner;
        let (over, none) = (PixmapPaint::default(), Transform::identity());
        pixmap.draw_pixmap(x as i32, y as i32, self.pixmap.as_ref(), &over, none, None);
    }
}
