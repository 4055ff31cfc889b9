//! Pictures of approximants.
//!
//! A picture begins with a survey of what there is to draw and how large it is, which the graph
//! tells where it can and a walk where it cannot. One walk for every class of colour follows, so
//! that no element is held in memory. Spans of it are sketched by any thread; a painter puts the
//! sketches together, in order, to paths in whole hundredths of a pixel, the same for every format.
//! Walks leave out what cannot be seen: what lies outside a window, what is smaller than a detail;
//! and where colours tell steps, what is born later than they tell.

mod canvas;
mod classes;
mod comb;
mod density;
mod known;
mod layout;
mod painter;
mod png;
mod scene;
mod sight;
mod sketch;
mod surface;
mod survey;
mod svg;
mod tracer;
mod zoomed;

pub use canvas::{Canvas, NoRoom, Size};
pub use classes::Classes;
pub use density::{Density, Shades, Tone, write_density};
pub use layout::{Detail, NoDetail};
pub use png::TooManyPixels;
pub use survey::Survey;
pub use zoomed::{Look, NoZoom, write_zoomed};

pub(crate) use scene::Scene;
pub(crate) use surface::{FINE, Paint, Pen, Position, Stroke, Surface, position};
pub(crate) use tracer::Tracer;

use std::convert::Infallible;
use std::io::{self, Write};
use std::num::NonZero;

use crate::graph::Graph;
use crate::grow::{Growth, WalkError};
use crate::heading::Heading;
use crate::parallel::{Team, all_cores, with_team};
use crate::style::{Colour, Named, Style, View, Width};
use crate::zoom::ZoomError;

use self::layout::Layout;
use self::png::Png;
use self::svg::Svg;

/// Widths of strokes that are relative to their elements are rounded to so many steps an octave.
const WIDTHS_AN_OCTAVE: f64 = 8.0;

/// A format of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Scalable vector graphics, streamed: memory does not grow with the number of elements.
    Svg,
    /// Portable network graphics, antialiased, of four to sixteen bytes a pixel in memory, and twelve
    /// more for every thread beside the first, as far as that makes no more than 200 MB.
    Png,
}

impl Named for Format {
    const NAMES: &'static [(&'static str, Self)] = &[("svg", Self::Svg), ("png", Self::Png)];
}

/// What a file says of itself beside the picture.
#[derive(Clone, Debug, Default)]
pub struct Labels {
    /// The title.
    pub title: String,
    /// What is to be seen.
    pub description: String,
    /// What it takes to make the file again, as text.
    pub provenance: String,
}

/// How a picture is made.
#[derive(Clone, Debug)]
pub struct Options {
    /// The format; SVG unless said otherwise.
    pub format: Format,
    /// How elements are drawn.
    pub style: Style,
    /// What part of the plane is drawn; everything unless said otherwise.
    pub view: View,
    /// The size; 1024 pixels on the long side unless said otherwise.
    pub size: Size,
    /// Down to what size elements are replaced; to any unless said otherwise.
    pub detail: Option<Detail>,
    /// What the file says of itself.
    pub labels: Labels,
    /// The threads that grow and write it, as many as the machine has cores unless said otherwise.
    /// The bytes do not depend on them.
    pub threads: NonZero<usize>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            format: Format::Svg,
            style: Style::default(),
            view: View::default(),
            size: Size::Long(1024),
            detail: None,
            labels: Labels::default(),
            threads: all_cores(),
        }
    }
}

impl Options {
    /// The style and the view that a file proposes.
    #[must_use]
    pub fn of(heading: &Heading) -> Self {
        Self {
            style: heading.style.clone(),
            view: heading.view,
            ..Self::default()
        }
    }
}

/// A picture that has been written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Picture {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The number of steps: what growth says, or what it took to come to a detail.
    pub steps: u32,
    /// The number of elements, without those outside a window that have not been visited.
    pub elements: u64,
    /// The number of fractals, likewise.
    pub fractals: u64,
    /// Whether some may not have been visited because they lie outside a window.
    pub is_part: bool,
}

/// Why a picture is not made.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// The walk ended early.
    #[error(transparent)]
    Walk(WalkError<Infallible>),
    /// The picture has no room for what is to be drawn.
    #[error(transparent)]
    NoRoom(#[from] NoRoom),
    /// The detail cannot be come to.
    #[error(transparent)]
    NoDetail(#[from] NoDetail),
    /// There is nothing to zoom into.
    #[error(transparent)]
    Zoom(#[from] ZoomError),
    /// What the picture is to show is not told so far down.
    #[error(transparent)]
    NoZoom(#[from] NoZoom),
    /// The picture is larger than memory may be.
    #[error(transparent)]
    TooManyPixels(#[from] TooManyPixels),
    /// The picture cannot be written.
    #[error(transparent)]
    Io(#[from] io::Error),
}

impl From<WalkError<io::Error>> for RenderError {
    fn from(error: WalkError<io::Error>) -> Self {
        match error {
            WalkError::Visitor(error) => Self::Io(error),
            WalkError::TooManyElements { limit } => {
                Self::Walk(WalkError::TooManyElements { limit })
            }
            WalkError::TooLong { limit } => Self::Walk(WalkError::TooLong { limit }),
            WalkError::NotFinite(error) => Self::Walk(WalkError::NotFinite(error)),
            WalkError::Cancelled => Self::Walk(WalkError::Cancelled),
        }
    }
}

impl From<WalkError<Infallible>> for RenderError {
    fn from(error: WalkError<Infallible>) -> Self {
        Self::Walk(error)
    }
}

/// Something that can be drawn in any format.
pub(crate) trait Drawing {
    /// Width and height in pixels.
    fn size(&self) -> [u32; 2];
    /// The colour behind everything.
    fn background(&self) -> Option<Colour>;
    /// The pen that most strokes are drawn with.
    fn pen(&self) -> Pen;
    /// Draws it.
    fn draw<'w>(&'w self, surface: &mut impl Surface, team: &Team<'w>) -> Result<(), RenderError>;
}

/// Grows a graph and writes the approximant as a picture.
///
/// # Errors
///
/// If growing ends early, if there is nothing to draw or no room for it, if a detail cannot be come
/// to, or if `out` fails.
pub fn write(
    graph: &Graph,
    growth: &Growth<'_>,
    options: &Options,
    out: &mut impl Write,
) -> Result<Picture, RenderError> {
    let Layout {
        survey,
        canvas,
        growth,
    } = Layout::find(graph, growth, options)?;
    let scene = Scene::new(&survey, &growth, canvas);
    let Options {
        format,
        labels,
        threads,
        ..
    } = options;
    write_drawing(&scene, *format, labels, *threads, out)?;
    Ok(Picture {
        size: canvas.size(),
        steps: growth.steps,
        elements: survey.elements,
        fractals: survey.fractals,
        is_part: survey.sight().is_bounded(),
    })
}

/// Writes a drawing as a file.
pub(crate) fn write_drawing(
    drawing: &impl Drawing,
    format: Format,
    labels: &Labels,
    threads: NonZero<usize>,
    out: &mut impl Write,
) -> Result<(), RenderError> {
    let (size, background) = (drawing.size(), drawing.background());
    with_team(threads, |team| match format {
        Format::Svg => {
            let mut svg = Svg::begin(out, size, background, drawing.pen(), labels, team)?;
            drawing.draw(&mut svg, team)?;
            Ok(svg.finish()?)
        }
        Format::Png => {
            let mut png = Png::begin(size, background, team)?;
            drawing.draw(&mut png, team)?;
            Ok(png.write(labels, out)?)
        }
    })
}

/// The pen of a style; where widths are relative, one of a pixel.
pub(crate) fn pen(style: &Style) -> Pen {
    Pen {
        width: match style.width {
            Width::Pixels(width) => width,
            Width::Relative(_) => 1.0,
        },
        cap: style.cap,
        join: style.join,
        dash: 0.0,
    }
}
