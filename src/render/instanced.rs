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

use std::io::Write;

use crate::geometry::Bounds;
use crate::graph::Graph;
use crate::grow::Growth;

use super::canvas::Canvas;
use super::drawing::Page;
use super::error::RenderError;
use super::options::Options;
use super::picture::Picture;
use super::prepass::Prepass;
use super::svg::begin_document;
use drawing::Drawing;

/// Maximum number of symbols, all of which are held in memory.
const MAX_SYMBOLS: usize = 1 << 18;

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
    let Options {
        style, view, size, ..
    } = options;
    refusal::check(graph, style, growth.steps)?;
    let steps = growth.steps;
    let prepass = match Prepass::outlined(graph, growth, style, steps, graph.seeds) {
        Some(prepass) => prepass,
        None => Prepass::new(graph, style, steps).walked(growth, options.threads)?,
    };
    let canvas = Canvas::of([&prepass], view, *size)?;
    if !is_near(&canvas, &prepass.bounds) {
        return Err(NotInstanced::TooClose.into());
    }
    let (classes, painted) = prepass.classes();
    let drawing = Drawing::new(graph, growth, options, classes);
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
