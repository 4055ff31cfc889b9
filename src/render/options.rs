//! Options of a picture.

use std::num::NonZero;

use crate::metadata::Metadata;
use crate::parallel::all_cores;
use crate::style::{ColorBy, Colour, Named, Style, Tone, View};

use super::canvas::Size;
use super::density::{Density, Shades};
use super::gcode::Machine;
use super::plot::{Hatch, Pens};
use super::png::Spares;
use super::short_cuts::ShortCuts;
use super::unit::Unit;

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
    /// Hewlett-Packard graphics language: strokes in units of 1/40 mm, always a plot.
    Hpgl,
    /// G-code: strokes in millimetres with the commands of a [`Machine`], always a plot.
    GCode,
}

impl Format {
    /// Returns whether sizes can be lengths as well as pixels.
    #[must_use]
    pub fn has_lengths(self) -> bool {
        self != Self::Png
    }

    /// Returns whether pictures are always plots.
    #[must_use]
    pub fn is_plot(self) -> bool {
        matches!(self, Self::Dxf | Self::Hpgl | Self::GCode)
    }
}

impl Named for Format {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("svg", Self::Svg),
        ("png", Self::Png),
        ("pdf", Self::Pdf),
        ("dxf", Self::Dxf),
        ("hpgl", Self::Hpgl),
        ("gcode", Self::GCode),
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

impl Labels {
    /// Iterates over the texts of PNG and its relatives, with their keywords: those that are not empty.
    pub(crate) fn texts(&self) -> impl Iterator<Item = (&'static str, String)> {
        let all = [
            ("Title", self.title.as_str()),
            ("Description", &self.description),
            ("Software", concat!("kfrac ", env!("CARGO_PKG_VERSION"))),
            ("Comment", &self.provenance),
        ];
        let texts = all.into_iter().filter(|(_, text)| !text.is_empty());
        texts.map(|(keyword, text)| (keyword, text.replace('\0', "")))
    }
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
    /// Whether opaque areas of a plot hide what lies under them; true by default.
    pub occlude: bool,
    /// Hatching of the filled areas of a plot, in the colours of their fills, unless that is the background's (white by
    /// default); none by default.
    pub hatch: Option<Hatch>,
    /// Commands of the machine that reads G-code.
    pub machine: Machine,
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
    /// Share of the length of all outlines, from 0 to 1, to which the picture is drawn, in the order in which a pen
    /// draws them: colour after colour, and in a colour along the elements. Has no effect on instanced SVG and on formats
    /// that are always plots.
    pub drawn: f64,
    /// Tone by which the pixels of a PNG show how many elements cover them, in one ink, or in the palette if the style is coloured
    /// [by hits](crate::style::ColorBy::Hits); `None` for elements on top of each other. Has no effect on plots.
    pub tone: Option<Tone>,
    /// Exponent above 0 of those tones: they are raised to its inverse; 1 by default.
    pub gamma: f64,
    /// Encoding of a PNG.
    pub png: PngEncoding,
    /// Size below which elements are not replaced; none by default.
    pub detail: Option<Detail>,
    /// Short cuts that drawing may take; all by default.
    pub short_cuts: ShortCuts,
    /// Memory of finished pictures, for those that follow; none by default.
    pub(crate) spares: Spares,
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
    occlude: bool,
    hatch: Option<Hatch>,
    machine: Machine,
    instanced: bool,
    in_one_piece: u64,
    band: u64,
    drawn: f64,
    tone: Option<Tone>,
    gamma: f64,
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
            size: Size::default(),
            unit: Unit::Pixel,
            plot: false,
            pens: Pens::default(),
            occlude: true,
            hatch: None,
            machine: Machine::default(),
            instanced: false,
            in_one_piece: 1 << 24,
            band: 1 << 21,
            drawn: 1.0,
            tone: None,
            gamma: 1.0,
            png: PngEncoding::default(),
            detail: None,
            short_cuts: ShortCuts::default(),
            spares: Spares::default(),
            labels: Labels::default(),
            threads: all_cores(),
        }
    }
}

impl Options {
    /// Returns the appearance of hits, if they are to be shown.
    pub(super) fn density(&self) -> Option<Density> {
        let tone = self.tone.filter(|_| !self.plot)?;
        let shades = match self.style.color_by {
            ColorBy::Hits => Shades::Palette(self.style.palette.clone()),
            _ => Shades::Ink(self.style.polygons()),
        };
        Some(Density {
            tone,
            gamma: self.gamma,
            shades,
            background: self.style.ground(),
            png: self.png,
            ..Density::default()
        })
    }

    /// Returns whether a PNG is drawn in one piece.
    pub(super) fn draws_in_one_piece(&self, [width, height]: [u32; 2]) -> bool {
        u64::from(width) * u64::from(height) <= self.in_one_piece
    }

    /// Completes the options of a picture that is looked at. A margin that the view leaves open is that of the
    /// [size](Size::margin); around a window it is 0, and in plots, whose size is that of the drawing. Without a background, PNG and PDF
    /// have white paper; [`Colour::TRANSPARENT`] takes it away.
    #[must_use]
    pub fn on_paper(mut self) -> Self {
        let is_plot = self.plot || self.format.is_plot();
        if self.view.margin.is_none() && self.view.window.is_none() && !is_plot {
            self.view.margin = Some(self.size.margin());
        }
        if matches!(self.format, Format::Png | Format::Pdf) && !is_plot {
            self.style.background.get_or_insert(Colour::WHITE);
        }
        self
    }

    /// Returns options with the style and the view that a file proposes.
    #[must_use]
    pub fn of(metadata: &Metadata) -> Self {
        Self {
            style: metadata.style.clone(),
            view: metadata.view,
            ..Self::default()
        }
    }
}

/// Size down to which elements are replaced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detail {
    /// Size in pixels, above 0: shorter elements are not replaced. They are drawn as in their approximant, and
    /// seed nothing.
    ///
    /// Elements that lead to seeds placed as the initiator are replaced at any size.
    pub pixels: f64,
    /// Whether the number of steps follows from the detail; the number given for the growth is then only a
    /// limit.
    pub decides_steps: bool,
}

/// Encoding of the pixels of a PNG. By default, no more bits a pixel than the colours need, in small files.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct PngEncoding {
    /// Whether pixels are compressed faster, to larger files.
    pub fast: bool,
    /// Whether pixels are grey levels of 8 bits, by luma (ITU-R BT.709), with an alpha channel of 8 bits unless all
    /// are opaque.
    pub grey: bool,
    /// Whether the pixels themselves take the place of a PNG: red, green, blue and alpha in a byte each, row after row.
    pub(crate) raw: bool,
}

setters!(PngEncoding {
    fast: bool,
    grey: bool
});

#[cfg(feature = "cli")]
impl PngEncoding {
    /// Returns the encoding that leaves pixels as they are.
    pub(crate) fn raw() -> Self {
        Self {
            raw: true,
            ..Self::default()
        }
    }
}
