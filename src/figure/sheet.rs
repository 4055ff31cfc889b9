//! Sheets: approximants side by side, each with its name and its number of elements.

mod pixels;

#[cfg(feature = "cli")]
pub(crate) use pixels::write_pixels;
pub use pixels::{SpaceCell, write_in_space};

use std::collections::BTreeMap;
use std::fmt;
use std::io::{self, Write};

use crate::geometry::DVec2;
use crate::graph::Graph;
use crate::grow::{Growth, WalkError};
use crate::parallel::Team;
use crate::render::{
    Canvas, Detail, Drawing, FINE, Layout, NoRoom, Options, Paint, Pen, Prepass, RenderError,
    Scene, Surface, pen, position, write_drawing,
};
use crate::style::{Blend, Colour, Named, Style, View};

use crate::readable::counted;

use super::LABEL;
use super::text::{Anchor, Font};

/// Font size of captions, in pixels.
const CAPTION: f64 = 14.0;
/// Height of a caption, in pixels.
const CAPTION_HEIGHT: u32 = 24;
/// Space around cells, in pixels.
const GAP: u32 = 16;

/// Part of the plane that each of several pictures shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum CellView {
    /// All pictures show one part, at one scale.
    #[default]
    All,
    /// Every picture shows the part that it fills.
    Each,
}

impl Named for CellView {
    const NAMES: &'static [(&'static str, Self)] = &[("all", Self::All), ("each", Self::Each)];
}

/// Arrangement of the pictures of a sheet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Arrangement {
    /// Number of pictures in a row. With `None`, the sides of the sheet are about 4 to 3.
    pub columns: Option<u32>,
    /// Part of the plane that each picture shows.
    pub fit: CellView,
}

/// One picture of a sheet.
pub struct Cell<'a> {
    /// Name of the approximant.
    pub name: String,
    /// Graph that the approximant is grown from.
    pub graph: &'a Graph,
    /// Options of its growth.
    pub growth: Growth<'a>,
    /// Style of the picture. A background that is not the one of the sheet fills the picture.
    pub style: &'a Style,
    /// Window and margin of the picture. They have no effect with [`CellView::All`].
    pub view: View,
    /// Size in pixels below which elements are not replaced; none if `None`.
    pub detail: Option<Detail>,
}

impl<'a> Cell<'a> {
    /// Makes the prepass of the picture with at most `most` elements. A detail refers to the scale of the options. Colours
    /// by step have a range of `steps`, unless the detail decides the number of steps.
    fn survey(
        &self,
        most: u64,
        steps: u32,
        options: &'a Options,
    ) -> Result<Survey<'a>, RenderError> {
        let growth = Growth {
            max_elements: most,
            ..self.growth
        };
        if self.detail.is_none() {
            let prepass = Prepass::of(self.graph, &growth, self.style, steps, options.threads)?;
            return Ok(Survey { prepass, growth });
        }
        let Layout {
            prepass, growth, ..
        } = Layout::find(self.graph, &growth, options)?;
        Ok(Survey { prepass, growth })
    }

    /// Returns the options of the picture, in a view and with a size of a sheet's options.
    fn options(&self, view: View, options: &Options) -> Options {
        Options {
            style: self.style.clone(),
            view,
            size: options.size,
            detail: self.detail,
            threads: options.threads,
            ..Options::default()
        }
    }
}

/// Prepass of a picture, and its growth, of as many steps as a detail takes.
struct Survey<'a> {
    prepass: Prepass<'a>,
    growth: Growth<'a>,
}

/// Summary of a sheet that has been written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SheetSummary {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The number of elements of all approximants together.
    pub elements: u64,
}

/// Error of a sheet that cannot be drawn.
#[derive(Debug)]
pub struct SheetError {
    /// Number of the picture that cannot be drawn, from 0; `None` if the error is not that of one picture.
    pub cell: Option<usize>,
    /// Error of that picture, or of the sheet.
    pub error: RenderError,
}

impl SheetError {
    fn of(cell: usize, error: RenderError) -> Self {
        Self {
            cell: Some(cell),
            error,
        }
    }
}

impl fmt::Display for SheetError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.cell {
            Some(cell) => write!(f, "picture {}: {}", cell + 1, self.error),
            None => self.error.fmt(f),
        }
    }
}

impl std::error::Error for SheetError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        self.error.source()
    }
}

impl<E: Into<RenderError>> From<E> for SheetError {
    fn from(error: E) -> Self {
        Self {
            cell: None,
            error: error.into(),
        }
    }
}

/// Grows approximants and writes them side by side, in rows.
///
/// [`Options::size`] is the size of every picture, not of the sheet. With [`CellView::All`], all pictures show the
/// part of the plane that all approximants fill together, or the window of [`Options::view`]. Colours by step mean
/// the same in all pictures of a graph. [`Options::style`] has the background of the sheet. The limit of the number of
/// elements of a picture counts those of the pictures before it as well.
///
/// # Errors
///
/// Returns an error if growing ends early, if there is nothing to draw or no room for it, or if `out` fails.
pub fn write(
    cells: &[Cell<'_>],
    arrangement: Arrangement,
    options: &Options,
    out: &mut impl Write,
) -> Result<SheetSummary, SheetError> {
    let own_view = |cell: &Cell<'_>| match arrangement.fit {
        CellView::All => options.view,
        CellView::Each => cell.view,
    };
    let owns: Vec<_> = { cells.iter() }
        .map(|cell| cell.options(own_view(cell), options))
        .collect();
    let shown;
    let (mut surveys, mut elements) = surveys_of(cells, &owns)?;
    let common = match arrangement.fit {
        CellView::All => {
            let prepasses = surveys.iter().map(|it| &it.prepass);
            Some(Canvas::of(prepasses, &options.view, options.size)?)
        }
        CellView::Each => None,
    };
    if let Some(common) = &common
        && options.view.window.is_none()
        && cells.iter().any(|cell| cell.detail.is_some())
    {
        // The scale of the sheet is that of a detail.
        let view = View {
            window: Some(common.window()),
            margin: Some(0.0),
        };
        let all = cells.iter().map(|cell| cell.options(view, options));
        shown = all.collect::<Vec<_>>();
        (surveys, elements) = surveys_of(cells, &shown)?;
    }
    let font = Font::new();
    let mut pictures = Vec::new();
    let mut captions = Vec::new();
    for (number, (cell, survey)) in cells.iter().zip(&surveys).enumerate() {
        let own = || {
            let own = Canvas::of([&survey.prepass], &cell.view, options.size);
            own.map_err(|error: NoRoom| SheetError::of(number, error.into()))
        };
        let canvas = common.map_or_else(own, Ok)?;
        let count = counted(&survey.prepass.elements.into(), "element");
        captions.push(format!("{}: {count}", cell.name));
        pictures.push(ScenePicture {
            scene: Scene::new(&survey.prepass, &survey.growth, canvas),
            size: canvas.size(),
            background: cell.style.ground(),
        });
    }
    let side = |axis: usize| pictures.iter().map(|it| it.size[axis]).max();
    let largest = [0, 1].map(|axis| side(axis).unwrap_or_default());
    let names = captions.iter().map(String::as_str);
    let sheet = Sheet {
        grid: Grid::of(names, &font, largest, arrangement.columns),
        pictures,
        captions,
        font,
        style: &options.style,
        fills: !(options.plot || options.format.is_plot()),
    };
    write_drawing(&sheet, options, out)?;
    Ok(SheetSummary {
        size: sheet.size(),
        elements,
    })
}

/// Makes the prepasses of all pictures, each with its options; also returns the number of all elements.
fn surveys_of<'a>(
    cells: &[Cell<'a>],
    options: &'a [Options],
) -> Result<(Vec<Survey<'a>>, u64), SheetError> {
    let mut deepest = BTreeMap::new();
    for cell in cells {
        let steps: &mut u32 = deepest.entry(&raw const *cell.graph).or_default();
        *steps = cell.growth.steps.max(*steps);
    }
    let mut elements = 0;
    let mut surveys = Vec::new();
    for (number, (cell, own)) in cells.iter().zip(options).enumerate() {
        let steps = deepest[&(&raw const *cell.graph)];
        let limit = cell.growth.max_elements;
        let survey = cell.survey(limit.saturating_sub(elements), steps, own);
        let survey = survey.map_err(|error| match error {
            RenderError::Walk(WalkError::TooManyElements { .. }) => {
                let error = WalkError::TooManyElements { limit };
                SheetError::of(number, RenderError::Walk(error))
            }
            error => SheetError::of(number, error),
        })?;
        elements += survey.prepass.elements;
        surveys.push(survey);
    }
    Ok((surveys, elements))
}

/// Places of the pictures of a sheet.
struct Grid {
    count: u32,
    /// Width and height of the largest picture, in pixels.
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

    /// Returns the upper left corner of a picture of a size, in the middle of the place at the corner of its column
    /// and row.
    fn picture(&self, [left, top]: [u32; 2], [width, height]: [u32; 2]) -> [u32; 2] {
        let top = top + (self.cell[1] - height) / 2;
        [left + (self.column - width) / 2, top]
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

/// Picture of a sheet, without its caption.
struct ScenePicture<'a> {
    scene: Scene<'a>,
    /// Width and height in pixels.
    size: [u32; 2],
    background: Option<Colour>,
}

impl ScenePicture<'_> {
    /// Fills the picture with its background.
    fn fill(&self, surface: &mut impl Surface) -> io::Result<()> {
        let paint = Paint {
            fill: self.background,
            ..Paint::default()
        };
        let [width, height] = position(DVec2::from_array(self.size.map(f64::from)) * FINE);
        surface.begin(&paint)?;
        surface.move_to([0, 0]);
        surface.lines_to(&[[width, 0], [width, height], [0, height]]);
        surface.close();
        surface.end()
    }
}

struct Sheet<'a> {
    pictures: Vec<ScenePicture<'a>>,
    captions: Vec<String>,
    grid: Grid,
    font: Font,
    style: &'a Style,
    /// Whether backgrounds of pictures are drawn.
    fills: bool,
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

    fn blend(&self) -> Blend {
        self.style.blend
    }

    fn draw<'w>(&'w self, surface: &mut impl Surface, team: &Team<'w>) -> Result<(), RenderError> {
        let all = self.pictures.iter().zip(&self.captions);
        for ((picture, caption), corner) in all.zip(self.grid.corners()) {
            let at = self.grid.picture(corner, picture.size);
            if surface.enter(at, picture.size)? {
                let is_own =
                    picture.background.is_some() && picture.background != self.background();
                if self.fills && is_own {
                    picture.fill(surface)?;
                }
                picture.scene.draw(surface, team)?;
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
