//! Figures of skeletons over their pictures, a pixel of the figure for a pixel of the picture.

use std::io::Write;

use crate::bits::Bits;
use crate::geometry::DVec2;
use crate::morphology::{Skeleton, SkeletonPoint, SkeletonSubsets};
use crate::parallel::Team;
use crate::render::{
    Drawing, FINE, Options, Paint, Pen, Position, RenderError, Stroke, Surface, TooManyPixels,
    position, write_drawing,
};
use crate::saturating::real;
use crate::style::{Cap, Colour, Join};

/// Colours of the picture, of branches and centres of maximal disks, of branch points, and of ends (Okabe and Ito
/// 2008).
pub const COLOURS: [Colour; 4] = [
    Colour::grey(215),
    Colour::of_rgba([0x00, 0x72, 0xb2, 255]),
    Colour::of_rgba([0xd5, 0x5e, 0x00, 255]),
    Colour::of_rgba([0x00, 0x9e, 0x73, 255]),
];

/// Draws a picture with the branches, branch points and ends of its connected skeleton.
///
/// # Errors
///
/// Returns an error if the picture is too large to be drawn, or if `out` fails.
pub fn write_connected(
    bits: &Bits,
    skeleton: &Skeleton,
    options: &Options,
    out: &mut impl Write,
) -> Result<(), RenderError> {
    Figure::new(bits, Content::Connected(skeleton), options)?.write(options, out)
}

/// Draws a picture with the centres of its maximal disks.
///
/// # Errors
///
/// As for [`write_connected`].
pub fn write_subsets(
    bits: &Bits,
    subsets: &SkeletonSubsets,
    options: &Options,
    out: &mut impl Write,
) -> Result<(), RenderError> {
    Figure::new(bits, Content::Subsets(subsets), options)?.write(options, out)
}

enum Content<'a> {
    Connected(&'a Skeleton),
    Subsets(&'a SkeletonSubsets),
}

struct Figure<'a> {
    size: [u32; 2],
    bits: &'a Bits,
    content: Content<'a>,
    background: Option<Colour>,
}

impl<'a> Figure<'a> {
    fn new(bits: &'a Bits, content: Content<'a>, options: &Options) -> Result<Self, RenderError> {
        let size =
            [bits.width(), bits.height()].map(|side| u32::try_from(side).unwrap_or(u32::MAX));
        TooManyPixels::check(size)?;
        Ok(Self {
            size,
            bits,
            content,
            background: options.style.background,
        })
    }

    fn write(&self, options: &Options, out: &mut impl Write) -> Result<(), RenderError> {
        write_drawing(self, options, out)
    }
}

const PEN: Pen = Pen {
    width: 1.0,
    cap: Cap::Square,
    join: Join::Round,
    dash: 0.0,
};

impl Drawing for Figure<'_> {
    fn size(&self) -> [u32; 2] {
        self.size
    }

    fn background(&self) -> Option<Colour> {
        self.background
    }

    fn pen(&self) -> Pen {
        PEN
    }

    fn draw<'w>(&'w self, surface: &mut impl Surface, _: &Team<'w>) -> Result<(), RenderError> {
        let [picture, line, junction, end] = COLOURS;
        areas(surface, picture, self.bits)?;
        match self.content {
            Content::Subsets(subsets) => areas(surface, line, &subsets.centres()),
            Content::Connected(skeleton) => {
                lines(surface, line, skeleton)?;
                let node = |is_wanted: fn(usize) -> bool| {
                    let mut bits = Bits::new(self.bits.width(), self.bits.height());
                    let nodes = skeleton.nodes().iter();
                    for node in nodes.filter(|node| is_wanted(node.branches.len())) {
                        bits.set(node.point.column, node.point.row);
                    }
                    bits
                };
                areas(surface, end, &node(|branches| branches < 3))?;
                areas(surface, junction, &node(|branches| branches > 2))
            }
        }
    }
}

/// Draws the runs of pixels of a set.
fn areas(surface: &mut impl Surface, colour: Colour, bits: &Bits) -> Result<(), RenderError> {
    surface.begin(&Paint {
        fill: Some(colour),
        stroke: None,
        has_holes: false,
    })?;
    let mut run: Option<[usize; 3]> = None;
    for [column, row] in bits.set_boxes() {
        match &mut run {
            Some([own, _, end]) if *own == row && *end == column => *end += 1,
            _ => {
                if let Some(run) = run.replace([row, column, column + 1]) {
                    rectangle(surface, run);
                    surface.hand_on()?;
                }
            }
        }
    }
    if let Some(run) = run {
        rectangle(surface, run);
    }
    Ok(surface.end()?)
}

fn rectangle(surface: &mut impl Surface, [row, from, to]: [usize; 3]) {
    surface.move_to(corner(from, row));
    surface.line_to(corner(to, row));
    surface.line_to(corner(to, row + 1));
    surface.line_to(corner(from, row + 1));
    surface.close();
}

fn corner(column: usize, row: usize) -> Position {
    position(DVec2::new(real(column), real(row)) * FINE)
}

/// Draws the branches along the centres of their pixels.
fn lines(
    surface: &mut impl Surface,
    colour: Colour,
    skeleton: &Skeleton,
) -> Result<(), RenderError> {
    let middle = |point: &SkeletonPoint| {
        position((DVec2::new(real(point.column), real(point.row)) + 0.5) * FINE)
    };
    surface.begin(&Paint {
        fill: None,
        stroke: Some(Stroke { colour, pen: PEN }),
        has_holes: false,
    })?;
    for branch in skeleton.branches() {
        if let [first, others @ ..] = &branch.points[..] {
            surface.move_to(middle(first));
            others
                .iter()
                .for_each(|point| surface.line_to(middle(point)));
        }
        surface.hand_on()?;
    }
    Ok(surface.end()?)
}
