//! Pictures of approximants.
//!
//! A picture begins with a survey of what there is to draw and how large it is, which the graph
//! tells where it can and a walk where it cannot. One walk for every class of colour follows, or one
//! for all where no class comes after a later one, so that no element is held in memory. Spans of it
//! are sketched by any thread; a painter puts the sketches together, in order, to paths in whole
//! hundredths of a pixel, the same for every format.
//!
//! A plot takes these as strokes, and draws them again in another order; large PNGs are drawn in
//! bands. An SVG of nested instances takes neither walk nor survey: it is told by the graph.
//!
//! Limit sets to a detail whose elements would be more than pixels can tell, or have no area, are drawn
//! without a walk: see `cells`.
//!
//! Walks leave out what cannot be seen: what lies outside a window, what is smaller than a detail,
//! what lies where all is covered in its colour already; and where colours tell steps, maps or
//! generators, what nothing comes of in those that are painted. All that changes no pixel, whichever
//! thread draws first: neither threads nor timing show in any byte. In PNGs to a
//! detail, small runs of elements that lie alike may be drawn as stamps, which comes close: see
//! `stamps`.

mod aim;
mod bands;
mod canvas;
mod cells;
mod census;
mod classes;
mod coarse;
mod comb;
mod density;
mod dxf;
mod filled;
mod hidden;
mod instanced;
mod known;
mod layout;
mod painter;
mod pdf;
mod plot;
mod png;
mod scene;
mod sight;
mod sketch;
mod stamps;
mod surface;
mod survey;
mod svg;
mod tracer;
mod unit;
mod zoomed;

pub use canvas::{Canvas, NoRoom, Size};
pub use classes::Classes;
pub use density::{Density, Shades, Tone, write_density};
pub use instanced::{Instanced, NotInstanced};
pub use layout::{Detail, NoDetail};
pub use plot::{Pens, Plotted};
pub use png::TooManyPixels;
pub use survey::Survey;
pub use unit::Unit;
pub use zoomed::{Look, NoZoom, write_zoomed};

pub(crate) use scene::Scene;
pub(crate) use surface::{FINE, Paint, Pen, Position, Stroke, Surface, position};
pub(crate) use tracer::Tracer;

use std::convert::Infallible;
use std::io::{self, Write};
use std::num::NonZero;
use std::sync::atomic::AtomicBool;

use crate::graph::Graph;
use crate::grow::{Growth, WalkError};
use crate::heading::Heading;
use crate::parallel::{Team, all_cores, with_team};
use crate::style::{Colour, Named, Style, View, Width};
use crate::zoom::ZoomError;

use self::cells::Way;
use self::layout::Layout;
use self::pdf::Pdf;
use self::plot::Plot;
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
    /// more for every thread beside the first, as far as that makes no more than 200 MB; pictures that
    /// are larger than [`Options::in_one_piece`] in bands, one after another.
    Png,
    /// Portable document format, streamed: memory grows by a few bytes for 256 kB of content.
    ///
    /// Where an area is stroked with a colour that is not opaque, the fill does not show through
    /// the stroke.
    Pdf,
    /// Drawing exchange format of release 12: polylines in millimetres, always a plot.
    Dxf,
}

impl Format {
    /// Whether sizes in it are lengths as well as pixels.
    #[must_use]
    pub fn has_lengths(self) -> bool {
        self != Self::Png
    }
}

impl Named for Format {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("svg", Self::Svg),
        ("png", Self::Png),
        ("pdf", Self::Pdf),
        ("dxf", Self::Dxf),
    ];
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
    /// What size, strokes, margin and detail are counted in.
    pub unit: Unit,
    /// Whether it is drawn as single strokes, nothing twice, and the pen carried over short ways:
    /// for plotters and cutters. Nothing is filled, not even the background. This is done in memory,
    /// of some hundred bytes an edge.
    pub plot: bool,
    /// How many pens a plot takes; one for every colour where there are few, unless said otherwise.
    pub pens: Pens,
    /// Whether an SVG is made of nested instances, so that it grows with the graph and the number of
    /// steps and not with the elements. Other formats do not look at this; detail and plots are not
    /// for it.
    pub instanced: bool,
    /// The most pixels of a PNG that is drawn in one piece, 2^24 unless said otherwise. A larger one
    /// is drawn in bands, each of which leaves out what lies outside, as far as that can be told
    /// without growing it, but of plots; and twice, unless its colours are soon known to be many.
    pub in_one_piece: u64,
    /// The pixels of a band, 2^21 unless said otherwise, with which drawing takes less than 300 MB.
    /// The bytes do not depend on them, unless a path of many thousand vertices is drawn that is dashed,
    /// stroked more than 4 pixels wide, or filled with a colour that is not opaque.
    pub band: u64,
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
            unit: Unit::Pixel,
            plot: false,
            pens: Pens::default(),
            instanced: false,
            in_one_piece: 1 << 24,
            band: 1 << 21,
            detail: None,
            labels: Labels::default(),
            threads: all_cores(),
        }
    }
}

impl Options {
    /// Whether a PNG is drawn in one piece.
    fn draws_in_one_piece(&self, [width, height]: [u32; 2]) -> bool {
        u64::from(width) * u64::from(height) <= self.in_one_piece
    }

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
    /// The number of steps: what growth says, or what it took to come to a detail; no fewer than that
    /// where there are more elements than have been counted.
    pub steps: u32,
    /// The number of elements, without those outside a window that have not been visited; of a limit set,
    /// that of the lines and dots that it is drawn with.
    pub elements: u64,
    /// Whether the limit set itself is drawn, by what it meets of a grid within pixels, for its elements
    /// are too many or become flat.
    pub is_limit: bool,
    /// Whether there are more: to a PNG's detail they need not be counted, for what lies where all is
    /// covered is not grown.
    pub has_more: bool,
    /// The number of fractals, likewise.
    pub fractals: u64,
    /// Whether some may not have been visited because they lie outside a window.
    pub is_part: bool,
    /// What is known where nothing comes into its window: of that which is drawn, all outlines have
    /// boxes that lie outside.
    pub empty: Option<Empty>,
    /// What it takes as a plot, if it is one.
    pub plotted: Option<Plotted>,
    /// What it is made of, if that is nested instances; its elements are then not counted.
    pub instanced: Option<Instanced>,
}

/// A window that shows nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Empty {
    /// Where there is something, if that is told: about the point X,Y of a [`Look`].
    pub nearest: Option<Nearest>,
}

/// What is nearest to the middle of a zoomed picture that shows nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// How far it is, in the rule's units, to a thousandth.
    pub distance: f64,
    /// How much larger than the whole the picture may be that shows it at its edge.
    pub factor: f64,
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
    /// It cannot be made of nested instances.
    #[error(transparent)]
    NotInstanced(#[from] NotInstanced),
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
    if options.instanced && options.format == Format::Svg {
        return instanced::write(graph, growth, options, out);
    }
    let Layout {
        survey,
        canvas,
        growth,
    } = match Way::find(graph, growth, options)? {
        Way::Elements(layout) => *layout,
        Way::Cells(cells) => {
            write_in(&cells, options, growth.cancel, out)?;
            return Ok(cells.picture());
        }
    };
    let in_bands = options.format == Format::Png && !options.draws_in_one_piece(canvas.size());
    if in_bands && !options.plot {
        bands::write_survey(&survey, &growth, canvas, options, out)?;
        return Ok(picture(&survey, canvas, growth.steps, None));
    }
    let scene = Scene::new(&survey, &growth, canvas);
    let plotted = write_in(&scene, options, growth.cancel, out)?;
    Ok(picture(&survey, canvas, growth.steps, plotted))
}

/// What has been written.
fn picture(survey: &Survey<'_>, canvas: Canvas, steps: u32, plotted: Option<Plotted>) -> Picture {
    Picture {
        size: canvas.size(),
        steps,
        elements: survey.elements,
        has_more: survey.has_more,
        fractals: survey.fractals,
        is_part: survey.sight().is_bounded(),
        empty: survey.shows_nothing().then(Empty::default),
        plotted,
        instanced: None,
        is_limit: false,
    }
}

/// Writes a drawing as a file.
pub(crate) fn write_drawing(
    drawing: &impl Drawing,
    options: &Options,
    out: &mut impl Write,
) -> Result<(), RenderError> {
    write_in(drawing, options, None, out).map(|_| ())
}

/// Writes a drawing, as strokes if that is asked for; tells what those take.
fn write_in(
    drawing: &impl Drawing,
    options: &Options,
    cancel: Option<&AtomicBool>,
    out: &mut impl Write,
) -> Result<Option<Plotted>, RenderError> {
    let format = match options.format {
        Format::Svg => PathFormat::Svg,
        Format::Png => PathFormat::Png,
        Format::Pdf => PathFormat::Pdf,
        Format::Dxf => {
            let plot = Plot::of(drawing, options, cancel)?;
            dxf::write(&plot, options.unit, &options.labels, out)?;
            return Ok(Some(plot.plotted));
        }
    };
    if options.plot {
        let plot = Plot::of(drawing, options, cancel)?;
        write_paths(&plot, format, options, cancel, out)?;
        return Ok(Some(plot.plotted));
    }
    write_paths(drawing, format, options, cancel, out)?;
    Ok(None)
}

/// The formats that any paths can be written in, one after another.
#[derive(Clone, Copy)]
enum PathFormat {
    Svg,
    Png,
    Pdf,
}

/// What vector graphics begin with.
#[derive(Clone, Copy)]
struct Page<'a> {
    size: [u32; 2],
    unit: Unit,
    background: Option<Colour>,
    /// The pen of most strokes.
    pen: Pen,
    labels: &'a Labels,
    /// Whether every colour comes once, as a layer.
    has_layers: bool,
}

fn write_paths(
    drawing: &impl Drawing,
    format: PathFormat,
    options: &Options,
    cancel: Option<&AtomicBool>,
    out: &mut impl Write,
) -> Result<(), RenderError> {
    if matches!(format, PathFormat::Png) && !options.draws_in_one_piece(drawing.size()) {
        return bands::write_drawing(drawing, options, cancel, out);
    }
    let page = Page {
        size: drawing.size(),
        unit: options.unit,
        background: drawing.background(),
        pen: drawing.pen(),
        labels: &options.labels,
        has_layers: options.plot,
    };
    with_team(options.threads, |team| match format {
        PathFormat::Svg => {
            let mut svg = Svg::begin(out, &page, team)?;
            drawing.draw(&mut svg, team)?;
            Ok(svg.finish()?)
        }
        PathFormat::Png => {
            let mut png = Png::begin(page.size, page.background, team)?;
            drawing.draw(&mut png, team)?;
            Ok(png.write(page.labels, out)?)
        }
        PathFormat::Pdf => {
            let mut pdf = Pdf::begin(out, &page, team)?;
            drawing.draw(&mut pdf, team)?;
            Ok(pdf.finish()?)
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
