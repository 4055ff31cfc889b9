//! SVG of nested instances: one symbol for each object and number of steps, composed of the symbols of the
//! instances that replace the object. The size of the file grows with the graph and the number of steps, not
//! with the number of elements (Hart 1992, section 2).
//!
//! Symbols are drawn in the unit frames of their objects; maps are attributes of their instances. Colours are
//! set where the initiator is instanced, once for each class, and classes have symbols of their own if
//! needed. Strokes of a width in pixels do not scale; relative widths scale with their elements. Browsers
//! compute in single precision: instances scaled below its smallest number, 1e-45, are not visible.

mod drawing;
mod ends;
mod file;
mod glb;
mod nested;
mod pov;
mod refusal;
mod symbols;
mod text;
#[cfg(feature = "threemf")]
mod threemf;
mod usda;

pub use file::{SceneFormat, write_scene};
pub use refusal::NotInstanced;

use std::io::{self, Write};

use crate::geometry::Bounds;
use crate::graph::Graph;
use crate::grow::Growth;

use super::canvas::Canvas;
use super::drawing::Page;
use super::error::RenderError;
use super::known::Purpose;
use super::options::{Format, Options};
use super::picture::Picture;
use super::prepass::Prepass;
use super::svg::begin_document;
use drawing::Drawing;

/// Maximum number of symbols, all of which are held in memory.
const MAX_SYMBOLS: usize = 1 << 18;

/// Limits of the work of a file.
#[derive(Clone, Copy)]
struct Work {
    /// Number of symbols.
    symbols: usize,
    /// Number of instances of which the symbols and the picture consist; texts of maps and of points count as several.
    instances: usize,
}

impl Work {
    /// Limits for a file that is written.
    const FILE: Self = Self {
        symbols: MAX_SYMBOLS,
        instances: usize::MAX,
    };

    fn of(purpose: Purpose) -> Self {
        match purpose {
            Purpose::Drawing => Self::FILE,
            Purpose::Estimate(_) => Self {
                instances: 1 << 20,
                ..Self::FILE
            },
        }
    }

    /// Deducts instances; returns whether so many are left.
    fn take(&mut self, instances: usize) -> bool {
        let left = self.instances.checked_sub(instances);
        self.instances = left.unwrap_or(0);
        left.is_some()
    }
}

/// Largest distance, in pixels, of the bounding box from the picture: single precision resolves a sixteenth
/// of a pixel there.
const FARTHEST: f64 = 1_048_576.0;

/// Writes an approximant as nested instances.
pub(super) fn write(
    graph: &Graph,
    growth: &Growth<'_>,
    options: &Options,
    out: &mut impl Write,
) -> Result<Picture, RenderError> {
    write_for(Purpose::Drawing, graph, growth, options, out)
}

/// Returns the length in bytes of an SVG of nested instances, which is written to a counter; `None` where it cannot be made,
/// or not with little work: if the symbols instance more than 2²⁰ elements and symbols, of which those of different maps count
/// as several, or if more than 20,000 elements would have to be grown.
pub(crate) fn length(
    graph: &Graph,
    options: &Options,
    steps: u32,
    bounds: &dyn Fn(u32) -> Option<Bounds>,
) -> Option<u64> {
    const MAX_GROWN: u64 = 20_000;
    /// Number of points of the outlines of all elements that are grown.
    const MAX_POINTS: u64 = 1 << 20;
    struct Length(u64);
    impl Write for Length {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0 += bytes.len() as u64;
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }
    let options = Options {
        format: Format::Svg,
        ..options.clone()
    };
    let outlines = graph.base_elements().iter();
    let longest = outlines.map(|outline| outline.pieces().len()).max();
    let affordable = MAX_POINTS / longest.unwrap_or(1).max(1) as u64;
    let growth = Growth {
        max_elements: MAX_GROWN.min(affordable),
        ..Growth::steps(steps)
    };
    let mut length = Length(0);
    let purpose = Purpose::Estimate(bounds);
    write_for(purpose, graph, &growth, &options, &mut length).ok()?;
    Some(length.0)
}

fn write_for(
    purpose: Purpose<'_>,
    graph: &Graph,
    growth: &Growth<'_>,
    options: &Options,
    out: &mut impl Write,
) -> Result<Picture, RenderError> {
    let Options {
        style, view, size, ..
    } = options;
    refusal::check(graph, style, growth.steps)?;
    let steps = growth.steps;
    let prepass = match Prepass::outlined(graph, growth, style, steps, graph.seeds, purpose) {
        Some(prepass) => prepass,
        None => Prepass::new(graph, style, steps).walked(growth, options.threads)?,
    };
    let canvas = Canvas::of([&prepass], view, *size)?;
    if !is_near(&canvas, &prepass.bounds) {
        return Err(NotInstanced::TooClose.into());
    }
    let (classes, painted) = prepass.classes();
    let drawing = Drawing::new(graph, growth, options, classes, Work::of(purpose));
    let page = Page {
        size: canvas.size(),
        unit: options.unit,
        background: style.ground(),
        pen: super::paint::pen(style),
        labels: &options.labels,
        blend: style.blend,
        has_default_ink: style.has_default_ink(),
        has_layers: false,
    };
    begin_document(out, &page)?;
    let instanced = drawing.write(&canvas, &painted, out)?;
    out.write_all(b"</svg>\n")?;
    Ok(Picture {
        is_limit: false,
        size: canvas.size(),
        window: Some(canvas.window()),
        steps,
        elements: prepass.elements,
        fractals: prepass.fractals,
        is_part: false,
        empty: None,
        plotted: None,
        instanced: Some(instanced),
    })
}

fn is_near(canvas: &Canvas, bounds: &Bounds) -> bool {
    let corners = [bounds.min(), bounds.max()].map(|corner| canvas.pixel(corner));
    corners
        .iter()
        .all(|corner| corner.abs().max_element() <= FARTHEST)
}
