//! Sheets: approximants side by side at one scale, each with its name and its number of elements.

mod space;

pub use space::{SpaceCell, write_in_space};

use std::io::Write;

use crate::geometry::DVec2;
use crate::graph::Graph;
use crate::grow::Growth;
use crate::parallel::Team;
use crate::render::{
    Canvas, Drawing, Options, Pen, Prepass, RenderError, Scene, Surface, pen, write_drawing,
};
use crate::style::{Colour, Style};

use crate::readable::counted;

use super::LABEL;
use super::text::{Anchor, Font};

/// Font size of captions, in pixels.
const CAPTION: f64 = 14.0;
/// Height of a caption, in pixels.
const CAPTION_HEIGHT: u32 = 24;
/// Space around cells, in pixels.
const GAP: u32 = 16;

/// One picture of a sheet.
pub struct Cell<'a> {
    /// Name of the approximant.
    pub name: String,
    /// Graph that the approximant is grown from.
    pub graph: &'a Graph,
    /// Options of its growth.
    pub growth: Growth<'a>,
}

/// Summary of a sheet that has been written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SheetSummary {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The number of elements of all approximants together.
    pub elements: u64,
}

/// Grows approximants and writes them side by side, in rows of `columns`. With `None`, the sides of the sheet
/// are about 4 to 3.
///
/// [`Options::size`] is the size of every picture, not of the sheet. All pictures show the same part of the
/// plane, the one that the largest approximant fills; colours by step mean the same in all of them.
///
/// # Errors
///
/// Returns an error if growing ends early, if there is nothing to draw or no room for it, or if `out` fails.
pub fn write(
    cells: &[Cell<'_>],
    columns: Option<u32>,
    options: &Options,
    out: &mut impl Write,
) -> Result<SheetSummary, RenderError> {
    let Options { style, view, .. } = options;
    let steps = cells.iter().map(|cell| cell.growth.steps).max();
    let mut surveys = Vec::new();
    for cell in cells {
        surveys.push(Prepass::of(
            cell.graph,
            &cell.growth,
            style,
            steps.unwrap_or_default(),
            options.threads,
        )?);
    }
    let canvas = Canvas::of(&surveys, view, options.size)?;
    let font = Font::new();
    let mut scenes = Vec::new();
    let mut elements = 0;
    for (cell, survey) in cells.iter().zip(&surveys) {
        let caption = format!(
            "{}: {}",
            cell.name,
            counted(&survey.elements.into(), "element")
        );
        scenes.push((caption, Scene::new(survey, &cell.growth, canvas)));
        elements += survey.elements;
    }
    let captions = scenes.iter().map(|(caption, _)| caption.as_str());
    let sheet = Sheet {
        grid: Grid::of(captions, &font, canvas.size(), columns),
        scenes,
        font,
        style,
    };
    write_drawing(&sheet, options, out)?;
    Ok(SheetSummary {
        size: sheet.size(),
        elements,
    })
}

/// Places of the pictures of a sheet.
struct Grid {
    count: u32,
    /// Width and height of every picture, in pixels.
    cell: [u32; 2],
    columns: u32,
    /// Width of a column, in pixels, without the gap.
    column: u32,
    /// Height of a row, in pixels, without the gap.
    row: u32,
}

impl Grid {
    fn of<'a>(
        captions: impl ExactSizeIterator<Item = &'a str>,
        font: &Font,
        cell: [u32; 2],
        columns: Option<u32>,
    ) -> Self {
        let count = captions.len();
        let widest = captions.map(|caption| font.width(caption, CAPTION));
        let widest = widest.fold(0.0, f64::max).ceil();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "captions are short"
        )]
        let widest = widest as u32;
        Self {
            count: u32::try_from(count).unwrap_or(u32::MAX),
            cell,
            columns: columns.unwrap_or_else(|| columns_for(count, cell)),
            column: cell[0].max(widest),
            row: cell[1] + CAPTION_HEIGHT,
        }
    }

    /// Returns width and height of the sheet.
    fn size(&self) -> [u32; 2] {
        let sides = [
            (self.columns.min(self.count), self.column),
            (self.count.div_ceil(self.columns), self.row),
        ];
        sides.map(|(count, side)| {
            side.saturating_add(GAP)
                .saturating_mul(count)
                .saturating_add(GAP)
        })
    }

    /// Returns the upper left corners of the columns and rows.
    fn corners(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        (0..self.count).map(|number| {
            let left = GAP + number % self.columns * (self.column + GAP);
            [left, GAP + number / self.columns * (self.row + GAP)]
        })
    }

    /// Returns the upper left corner of a picture at the corner of its column and row.
    fn picture(&self, [left, top]: [u32; 2]) -> [u32; 2] {
        [left + (self.column - self.cell[0]) / 2, top]
    }

    /// Draws the caption of the picture at the corner of its column and row.
    fn caption(
        &self,
        surface: &mut impl Surface,
        font: &Font,
        caption: &str,
        [left, top]: [u32; 2],
    ) -> Result<(), RenderError> {
        let middle = f64::from(left) + f64::from(self.column) / 2.0;
        let at = DVec2::new(middle, f64::from(top + self.cell[1]) + CAPTION + 2.0);
        font.draw(surface, caption, CAPTION, at, Anchor::Middle, LABEL)?;
        Ok(())
    }
}

struct Sheet<'a> {
    /// The approximants with their captions.
    scenes: Vec<(String, Scene<'a>)>,
    grid: Grid,
    font: Font,
    style: &'a Style,
}

impl Drawing for Sheet<'_> {
    fn size(&self) -> [u32; 2] {
        self.grid.size()
    }

    fn background(&self) -> Option<Colour> {
        self.style.ground()
    }

    fn pen(&self) -> Pen {
        pen(self.style)
    }

    fn draw<'w>(&'w self, surface: &mut impl Surface, team: &Team<'w>) -> Result<(), RenderError> {
        for ((caption, scene), corner) in self.scenes.iter().zip(self.grid.corners()) {
            if surface.enter(self.grid.picture(corner), self.grid.cell)? {
                scene.draw(surface, team)?;
                surface.leave()?;
            }
            self.grid.caption(surface, &self.font, caption, corner)?;
        }
        Ok(())
    }
}

/// Returns the number of columns for which the sides of the sheet are closest to 4 to 3.
fn columns_for(count: usize, [width, height]: [u32; 2]) -> u32 {
    let count = u32::try_from(count).unwrap_or(u32::MAX).max(1);
    let [width, height] = [
        width.saturating_add(GAP),
        height.saturating_add(CAPTION_HEIGHT + GAP),
    ];
    let off = |columns: u32| {
        let rows = count.div_ceil(columns);
        let ratio = f64::from(columns) * f64::from(width) / (f64::from(rows) * f64::from(height));
        libm::log(ratio * 3.0 / 4.0).abs()
    };
    let all = 1..=count.min(100);
    all.min_by(|&a, &b| off(a).total_cmp(&off(b))).unwrap_or(1)
}
