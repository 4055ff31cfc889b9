//! Pictures of approximants.
//!
//! A picture begins with a prepass over the elements to draw, their number and their box, from the graph where it
//! determines them and by a walk elsewhere. One walk for every class of colour follows, or one for all where
//! classes do not interleave, so that no element is held in memory. Any thread sketches spans of it; a painter
//! joins the sketches, in order, to paths in whole hundredths of a pixel, equal for every format.
//!
//! A plot takes the paths as strokes, and draws them in another order; large PNGs are drawn in bands. An SVG
//! of nested instances is made from the graph, without a walk.
//!
//! Limit sets are drawn without a walk, by `cells`, where a detail takes more elements than there are pixels, or
//! elements have no area.
//!
//! Walks leave out subtrees that cannot be seen, outside a window or below a detail; and where colours distinguish
//! steps, maps or generators, subtrees without elements of the class that is painted. None of this changes a
//! pixel, and neither threads nor timing show in any byte. In PNGs to a detail, small runs of elements in equal positions may be
//! drawn as sprites, with small differences: see `png::sprites`. Whatever serves pixels alone lies in `png`, behind
//! one method of surfaces.

mod bands;
mod canvas;
mod cells;
mod census;
mod classes;
mod contribution;
mod culling;
mod density;
mod display;
mod drawing;
mod dxf;
mod error;
mod instanced;
mod known;
mod layout;
mod paint_key;
mod painter;
mod pdf;
mod pixels;
mod plot;
mod png;
mod prepass;
mod scene;
mod short_cuts;
mod sketch;
mod surface;
mod svg;
mod tracer;
mod unit;
mod zoomed;

pub use canvas::{Canvas, NoRoom, Size};
pub(crate) use classes::Classes;
pub use density::{Density, Shades, Tone, write_density};
pub use error::{Remedy, RenderError};
pub use instanced::{Instanced, NotInstanced};
pub use layout::{Detail, NoDetail};
pub use pixels::{Pixels, pixels};
pub use plot::{Pens, Plotted};
pub use png::{PngEncoding, TooManyPixels};
pub(crate) use prepass::Prepass;
pub use short_cuts::{ShortCut, ShortCuts};
pub use unit::Unit;
pub use zoomed::{NoZoom, ZoomTarget, write_zoomed};

pub(crate) use scene::Scene;
pub(crate) use surface::{FINE, Paint, Pen, Position, Stroke, Surface, position};
pub(crate) use tracer::Tracer;

use std::io::Write;
use std::num::NonZero;
use std::sync::atomic::AtomicBool;

use crate::graph::Graph;
use crate::grow::Growth;
use crate::metadata::Metadata;
use crate::parallel::{Team, all_cores, with_team};
use crate::style::{Colour, Named, Style, View, Width};

use self::cells::Way;
use self::pdf::Pdf;
use self::plot::Plot;
use self::png::Png;
use self::svg::Svg;

/// Number of steps per octave that relative stroke widths are rounded to.
const WIDTHS_AN_OCTAVE: f64 = 8.0;

/// A format of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
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
    /// Returns whether sizes can be lengths as well as pixels.
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

/// Metadata of a picture.
#[derive(Clone, Debug, Default)]
pub struct Labels {
    /// The title.
    pub title: String,
    /// Description of the picture.
    pub description: String,
    /// Text from which the file can be made again.
    pub provenance: String,
}

/// Options of a picture.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Options {
    /// Format; SVG by default.
    pub format: Format,
    /// Style of elements.
    pub style: Style,
    /// Window of the plane; everything by default.
    pub view: View,
    /// Size; 1024 pixels on the long side by default.
    pub size: Size,
    /// Unit of size, strokes, margin and detail.
    pub unit: Unit,
    /// Whether the picture is drawn as single strokes, none twice, in an order with short ways of the pen
    /// between them: for plotters and cutters. Nothing is filled, not even the background. Takes some hundred
    /// bytes of memory per edge.
    pub plot: bool,
    /// Number of pens of a plot; by default one for every colour where there are few.
    pub pens: Pens,
    /// Whether an SVG is made of nested instances, so that its size depends on the graph and the number of
    /// steps and not on the elements. Has no effect on other formats; excludes detail and plots.
    pub instanced: bool,
    /// Largest number of pixels of a PNG that is drawn in one piece; 2^24 by default. A larger one is drawn in
    /// bands, each of which culls elements outside it, except in plots; and twice, unless its colours are
    /// soon known to be many.
    pub in_one_piece: u64,
    /// Number of pixels of a band; 2^21 by default, with which drawing takes less than 300 MB. The bytes do not
    /// depend on it, unless a path of many thousand vertices is drawn that is dashed, stroked more than 4
    /// pixels wide, or filled with a colour that is not opaque.
    pub band: u64,
    /// Encoding of a PNG.
    pub png: PngEncoding,
    /// Size below which elements are not replaced; none by default.
    pub detail: Option<Detail>,
    /// Short cuts that drawing may take; all by default.
    pub short_cuts: ShortCuts,
    /// Metadata of the file.
    pub labels: Labels,
    /// Number of threads; by default that of the machine's cores. The bytes do not depend on it.
    pub threads: NonZero<usize>,
}

setters!(Options {
    format: Format,
    style: Style,
    view: View,
    size: Size,
    unit: Unit,
    plot: bool,
    pens: Pens,
    instanced: bool,
    in_one_piece: u64,
    band: u64,
    png: PngEncoding,
    detail: Option<Detail>,
    labels: Labels,
    threads: NonZero<usize>,
});

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
            png: PngEncoding::default(),
            detail: None,
            short_cuts: ShortCuts::default(),
            labels: Labels::default(),
            threads: all_cores(),
        }
    }
}

impl Options {
    /// Returns whether a PNG is drawn in one piece.
    fn draws_in_one_piece(&self, [width, height]: [u32; 2]) -> bool {
        u64::from(width) * u64::from(height) <= self.in_one_piece
    }

    /// Returns options with the style and the view that a file proposes.
    #[must_use]
    pub fn of(heading: &Metadata) -> Self {
        Self {
            style: heading.style.clone(),
            view: heading.view,
            ..Self::default()
        }
    }
}

/// A picture that has been written.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Picture {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Number of steps: that of the growth, or the one that a detail took.
    pub steps: u32,
    /// Number of elements, without those outside a window that were not visited; of a limit set, that of the
    /// lines and dots that it is drawn with.
    pub elements: u64,
    /// Whether the limit set itself is drawn, by the cells of a grid within pixels that it meets, because its
    /// elements are too many or become flat.
    pub is_limit: bool,
    /// Number of fractals, with the same limits.
    pub fractals: u64,
    /// Whether elements outside a window may not have been visited.
    pub is_part: bool,
    /// Present if nothing meets the window: the boxes of all outlines lie outside.
    pub empty: Option<Empty>,
    /// Lengths and strokes of a plot.
    pub plotted: Option<Plotted>,
    /// Numbers of symbols and instances, if the picture is made of nested instances; its elements are not counted then.
    pub instanced: Option<Instanced>,
}

/// A window that shows nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Empty {
    /// Nearest visible point, if it is known: of a [`ZoomTarget`].
    pub nearest: Option<Nearest>,
}

/// Point nearest to the middle of a zoomed picture that shows nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Nearest {
    /// Distance in the rule's units, to a thousandth.
    pub distance: f64,
    /// Largest magnification of a picture that shows the point at its edge.
    pub factor: f64,
}

/// Drawing that any format takes.
pub(crate) trait Drawing {
    /// Width and height in pixels.
    fn size(&self) -> [u32; 2];
    /// Colour of the background.
    fn background(&self) -> Option<Colour>;
    /// Pen of most strokes.
    fn pen(&self) -> Pen;
    /// Draws onto a surface.
    fn draw<'w>(&'w self, surface: &mut impl Surface, team: &Team<'w>) -> Result<(), RenderError>;
}

/// Grows a graph and writes the approximant as a picture.
///
/// # Errors
///
/// If growing ends early, if there is nothing to draw or no room for it, if a detail cannot be reached, or
/// if `out` fails.
pub fn write(
    graph: &Graph,
    growth: &Growth<'_>,
    options: &Options,
    out: &mut impl Write,
) -> Result<Picture, RenderError> {
    if options.instanced && options.format == Format::Svg {
        return instanced::write(graph, growth, options, out);
    }
    let layout = match Way::find(graph, growth, options)? {
        Way::Elements(layout) => layout,
        Way::Cells(cells) => {
            write_in(&cells, options, growth.cancel, out)?;
            return Ok(cells.picture());
        }
    };
    let (size, cancel) = (layout.canvas.size(), growth.cancel);
    if options.format == Format::Png && !options.plot && !options.draws_in_one_piece(size) {
        bands::write_layout(&layout, options, out)?;
        return Ok(layout.picture(None));
    }
    let plotted = write_in(&layout.scene(), options, cancel, out)?;
    Ok(layout.picture(plotted))
}

/// Writes a drawing as a file.
pub(crate) fn write_drawing(
    drawing: &impl Drawing,
    options: &Options,
    out: &mut impl Write,
) -> Result<(), RenderError> {
    write_in(drawing, options, None, out).map(|_| ())
}

/// Writes a drawing, as strokes if the options ask for a plot; returns the numbers of the plot.
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

/// Format of paths in their order.
#[derive(Clone, Copy)]
enum PathFormat {
    Svg,
    Png,
    Pdf,
}

/// Head of a vector graphic.
#[derive(Clone, Copy)]
struct Page<'a> {
    size: [u32; 2],
    unit: Unit,
    background: Option<Colour>,
    /// The pen of most strokes.
    pen: Pen,
    labels: &'a Labels,
    /// Whether every colour occurs once, as a layer.
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
            Ok(png.write(options, out)?)
        }
        PathFormat::Pdf => {
            let mut pdf = Pdf::begin(out, &page, team)?;
            drawing.draw(&mut pdf, team)?;
            Ok(pdf.finish()?)
        }
    })
}

/// Returns the pen of a style; of one pixel where widths are relative.
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
