//! Figures of the difference of two sets: the pixels of the first only, of the second only and of both, in
//! three colours.

use std::io::Write;

use crate::geometry::DVec2;
use crate::parallel::Team;
use crate::render::{
    Canvas, Drawing, FINE, Options, Paint, Pen, RenderError, Surface, TooManyPixels, position,
    write_drawing,
};
use crate::saturating::whole;
use crate::style::{Cap, Colour, Join};

/// Colours of the pixels in the first set only, in the second only, and in both; distinguishable with any
/// colour vision (Okabe and Ito 2008).
pub const COLOURS: [Colour; 3] = [
    Colour::of_rgba([0xd5, 0x5e, 0x00, 255]),
    Colour::of_rgba([0x00, 0x72, 0xb2, 255]),
    Colour::of_rgba([0x99, 0x99, 0x99, 255]),
];

/// Draws the pixels that hold points of two sets; returns the number of pixels of every colour.
///
/// A pixel of one set counts as one of both if a neighbour, corners included, belongs to the other set:
/// rounding and points that stand for discs then make no difference.
///
/// # Errors
///
/// Returns an error if the picture is too large, or if `out` fails.
pub fn write(
    canvas: Canvas,
    sets: [&PixelSet; 2],
    options: &Options,
    out: &mut impl Write,
) -> Result<[u64; 3], RenderError> {
    let planes = sets.map(|pixels| pixels.plane.as_slice());
    let difference = Difference {
        canvas,
        classes: classes(&canvas, &planes),
        background: options.style.background,
    };
    let counts = [0, 1, 2].map(|class| {
        let of_class = difference.classes.iter().filter(|found| **found == class);
        of_class.count() as u64
    });
    write_drawing(&difference, options, out)?;
    Ok(counts)
}

/// The pixels of a picture that hold points of a set.
#[derive(Clone, Debug)]
pub struct PixelSet {
    canvas: Canvas,
    plane: Vec<bool>,
}

impl PixelSet {
    /// Returns an empty set of pixels.
    ///
    /// # Errors
    ///
    /// Returns an error if the picture is too large to be held in memory as a whole.
    pub fn new(canvas: Canvas) -> Result<Self, TooManyPixels> {
        let size = canvas.size();
        TooManyPixels::check(size)?;
        let [width, height] = size.map(|side| side as usize);
        Ok(Self {
            canvas,
            plane: vec![false; width * height],
        })
    }

    /// Returns half a pixel in the units of the set: the radius to cover the set by, if points of the cover
    /// are added.
    #[must_use]
    pub fn radius(&self) -> f64 {
        0.5 / self.canvas.scale()
    }

    /// Adds a point; points outside the picture are ignored.
    pub fn add(&mut self, point: DVec2) {
        let [width, height] = self.canvas.size().map(|side| side as usize);
        let pixel = self.canvas.pixel(point);
        if pixel.min_element() < 0.0 {
            return;
        }
        let [column, row] = pixel.to_array().map(whole);
        if column < width && row < height {
            self.plane[row * width + column] = true;
        }
    }
}

/// Class of pixels that belong to neither set.
const NONE: u8 = 3;

/// Returns the class of every pixel, row by row: 0 and 1 for one set only, 2 for both, [`NONE`] for neither.
fn classes(canvas: &Canvas, planes: &[&[bool]; 2]) -> Vec<u8> {
    let [width, height] = canvas.size().map(|side| side as usize);
    let near = |plane: &[bool], place: usize| {
        let (column, row) = (place % width, place / width);
        let around = |at: usize, most: usize| at.saturating_sub(1)..(at + 2).min(most);
        let mut rows = around(row, height);
        rows.any(|row| around(column, width).any(|column| plane[row * width + column]))
    };
    let class = |place: usize| match [planes[0][place], planes[1][place]] {
        [true, true] => 2,
        [true, false] if near(planes[1], place) => 2,
        [false, true] if near(planes[0], place) => 2,
        [true, false] => 0,
        [false, true] => 1,
        [false, false] => NONE,
    };
    (0..width * height).map(class).collect()
}

struct Difference {
    canvas: Canvas,
    classes: Vec<u8>,
    background: Option<Colour>,
}

impl Drawing for Difference {
    fn size(&self) -> [u32; 2] {
        self.canvas.size()
    }

    fn background(&self) -> Option<Colour> {
        self.background
    }

    fn pen(&self) -> Pen {
        Pen {
            width: 1.0,
            cap: Cap::Round,
            join: Join::Round,
            dash: 0.0,
        }
    }

    fn draw<'w>(&'w self, surface: &mut impl Surface, _: &Team<'w>) -> Result<(), RenderError> {
        let width = self.canvas.size()[0] as usize;
        for (class, colour) in (0..).zip(COLOURS) {
            surface.begin(&Paint {
                fill: Some(colour),
                stroke: None,
                has_holes: false,
            })?;
            for (row, pixels) in (0u32..).zip(self.classes.chunks(width)) {
                let mut column = 0u32;
                for run in pixels.chunk_by(|a, b| a == b) {
                    let end = column + u32::try_from(run.len()).unwrap_or_default();
                    if run[0] == class {
                        rectangle(surface, [column, row], [end, row + 1]);
                    }
                    column = end;
                }
                surface.hand_on()?;
            }
            surface.end()?;
        }
        Ok(())
    }
}

fn rectangle(surface: &mut impl Surface, from: [u32; 2], to: [u32; 2]) {
    let corner = |x: u32, y: u32| position(DVec2::new(f64::from(x), f64::from(y)) * FINE);
    surface.move_to(corner(from[0], from[1]));
    surface.line_to(corner(to[0], from[1]));
    surface.line_to(corner(to[0], to[1]));
    surface.line_to(corner(from[0], to[1]));
    surface.close();
}
