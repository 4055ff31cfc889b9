//! Writing of pictures in all formats.

use std::io::Write;
use std::sync::atomic::AtomicBool;

use crate::graph::Graph;
use crate::grow::Growth;
use crate::parallel::with_team;

use super::cells::DrawingMethod;
use super::drawing::{Drawing, Page};
use super::error::RenderError;
use super::options::{Format, Options};
use super::pdf::Pdf;
use super::pen_way::PenWay;
use super::picture::Picture;
use super::plot::{Plot, Plotted};
use super::png::{Png, write_pixels};
use super::svg::Svg;
use super::{bands, blended, dxf, gcode, hits, hpgl, instanced, plot};

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
    let layout = match DrawingMethod::find(graph, growth, options)? {
        DrawingMethod::Elements(layout) => layout,
        DrawingMethod::Cells(cells) => {
            write_in(&cells, options, growth.cancel, out)?;
            return Ok(cells.picture());
        }
    };
    let (size, cancel) = (layout.canvas.size(), growth.cancel);
    let is_whole = !options.plot && options.drawn >= 1.0 && options.tone.is_none();
    if options.format == Format::Png && is_whole && !options.draws_in_one_piece(size) {
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
pub(super) fn write_in(
    drawing: &impl Drawing,
    options: &Options,
    cancel: Option<&AtomicBool>,
    out: &mut impl Write,
) -> Result<Option<Plotted>, RenderError> {
    let format = match options.format {
        Format::Svg => PathFormat::Svg,
        Format::Png => PathFormat::Png,
        Format::Pdf => PathFormat::Pdf,
        format @ (Format::Dxf | Format::Hpgl | Format::GCode) => {
            let plot = Plot::of(drawing, options, cancel)?;
            let page = plot::Page::of(&plot, options.unit);
            match format {
                Format::Hpgl => hpgl::write(&plot, page, out)?,
                Format::GCode => gcode::write(&plot, page, &options.machine, &options.labels, out)?,
                _ => dxf::write(&plot, page, &options.labels, out)?,
            }
            return Ok(Some(plot.plotted));
        }
    };
    if options.plot {
        let plot = Plot::of(drawing, options, cancel)?;
        write_so_far(&plot, format, options, cancel, out)?;
        return Ok(Some(plot.plotted));
    }
    write_so_far(drawing, format, options, cancel, out)?;
    Ok(None)
}

/// Format of paths in their order.
#[derive(Clone, Copy)]
enum PathFormat {
    Svg,
    Png,
    Pdf,
}

/// Writes the part of a drawing that the options ask for.
fn write_so_far(
    drawing: &impl Drawing,
    format: PathFormat,
    options: &Options,
    cancel: Option<&AtomicBool>,
    out: &mut impl Write,
) -> Result<(), RenderError> {
    if options.drawn >= 1.0 {
        return write_paths(drawing, format, options, cancel, out);
    }
    let so_far = PenWay {
        drawing,
        share: options.drawn,
    };
    write_paths(&so_far, format, options, cancel, out)
}

fn write_paths(
    drawing: &impl Drawing,
    format: PathFormat,
    options: &Options,
    cancel: Option<&AtomicBool>,
    out: &mut impl Write,
) -> Result<(), RenderError> {
    if matches!(format, PathFormat::Png)
        && let Some(density) = options.density()
    {
        let pixmap = with_team(options.threads, |team| {
            hits::pixmap(drawing, &density, team)
        })?;
        return Ok(write_pixels(&pixmap, &options.labels, options.png, out)?);
    }
    if matches!(format, PathFormat::Png) && !options.draws_in_one_piece(drawing.size()) {
        return bands::write_drawing(drawing, options, cancel, out);
    }
    let page = Page {
        size: drawing.size(),
        unit: options.unit,
        background: drawing.background(),
        pen: drawing.pen(),
        blend: drawing.blend(),
        has_default_ink: drawing.has_default_ink() && !options.plot,
        labels: &options.labels,
        has_layers: options.plot,
    };
    with_team(options.threads, |team| match format {
        PathFormat::Svg => {
            let mut svg = Svg::begin(out, &page, team)?;
            blended::draw(drawing, &mut svg, team)?;
            Ok(svg.finish()?)
        }
        PathFormat::Png => {
            let spare = options.spares.take();
            let png = Png::begin(page.size, page.background, spare, team)?;
            let mut png = png.blending(page.blend);
            blended::draw(drawing, &mut png, team)?;
            options.spares.put(png.write(options, out)?);
            Ok(())
        }
        PathFormat::Pdf => {
            let mut pdf = Pdf::begin(out, &page, team)?;
            blended::draw(drawing, &mut pdf, team)?;
            Ok(pdf.finish()?)
        }
    })
}
