//! Sheets of pixels: sets in space, approximants, members of a family or directions of view side by side, and points of
//! random iteration.

use std::io::Write;
use std::sync::atomic::AtomicBool;

use crate::geometry::Frame3;
use crate::graph::Graph;
use crate::parallel::Team;
use crate::render::space::{PAPER, SpaceOptions, pixels_in_space};
use crate::render::{Drawing, Options, Pen, Pixels, RenderError, Surface, draw_paths, pen};
use crate::style::{Colour, Style};

use super::super::text::Font;
use super::{Grid, SheetSummary};

/// One picture of a sheet.
pub struct SpaceCell<'a> {
    /// Caption of the picture.
    pub caption: String,
    /// Graph of the set.
    pub graph: &'a Graph<Frame3>,
    /// Number of steps; `None` for the limit set.
    pub steps: Option<u32>,
    /// Camera, shading and light.
    pub space: SpaceOptions,
    /// Style of the picture.
    pub style: &'a Style,
}

/// Draws sets in space side by side, in rows of `columns`, and writes them as PNG. With `None`, the sides of the sheet
/// are about 4 to 3.
///
/// [`Options::size`] is the size of every picture, not of the sheet. Every picture is fitted to what it shows.
///
/// # Errors
///
/// As for [`write_space`](crate::render::space::write_space).
pub fn write_in_space(
    cells: &[SpaceCell<'_>],
    columns: Option<u32>,
    options: &Options,
    cancel: Option<&AtomicBool>,
    out: &mut impl Write,
) -> Result<SheetSummary, RenderError> {
    let mut pictures = Vec::new();
    let mut elements = 0;
    for cell in cells {
        let own = Options {
            style: cell.style.clone(),
            ..options.clone()
        };
        let drawn = pixels_in_space(cell.graph, cell.steps, &own, &cell.space, cancel);
        let drawn = drawn?;
        elements += drawn.picture.elements;
        pictures.push((cell.caption.clone(), drawn.pixels));
    }
    let size = write_pixels(&pictures, columns, options, out)?;
    Ok(SheetSummary { size, elements })
}

/// Arranges pictures with their captions side by side, as [`write_in_space`] does, and writes them as PNG; returns the size.
pub(crate) fn write_pixels(
    pictures: &[(String, Pixels)],
    columns: Option<u32>,
    options: &Options,
    out: &mut impl Write,
) -> Result<[u32; 2], RenderError> {
    let side = |axis: usize| pictures.iter().map(|(_, it)| it.size()[axis]).max();
    let largest = [0, 1].map(|axis| side(axis).unwrap_or_default());
    let font = Font::new();
    let captions = pictures.iter().map(|(caption, _)| caption.as_str());
    let sheet = Captions {
        grid: Grid::of(captions, &font, largest, columns),
        pictures,
        font,
        style: &options.style,
    };
    let mut pixels = draw_paths(&sheet, options)?;
    for ((_, picture), corner) in pictures.iter().zip(sheet.grid.corners()) {
        pixels.put(picture, sheet.grid.picture(corner, picture.size()));
    }
    let size = pixels.size();
    pixels.write(options, out)?;
    Ok(size)
}

/// A sheet without its pictures.
struct Captions<'a> {
    pictures: &'a [(String, Pixels)],
    grid: Grid,
    font: Font,
    style: &'a Style,
}

impl Drawing for Captions<'_> {
    fn size(&self) -> [u32; 2] {
        self.grid.size()
    }

    fn background(&self) -> Option<Colour> {
        Some(self.style.background.unwrap_or(PAPER))
    }

    fn pen(&self) -> Pen {
        pen(self.style)
    }

    fn draw<'w>(&'w self, surface: &mut impl Surface, _: &Team<'w>) -> Result<(), RenderError> {
        for ((caption, _), corner) in self.pictures.iter().zip(self.grid.corners()) {
            let grid = &self.grid;
            grid.caption(surface, &self.font, caption, corner)?;
        }
        Ok(())
    }
}
