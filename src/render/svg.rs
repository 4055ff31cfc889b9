//! SVG: connected elements as paths, polygons as subpaths of one orientation, streamed.
//!
//! Coordinates are whole hundredths of a pixel, so no point is off by more than 0.01 pixels at the
//! picture's size. Colours are painted class by class, one walk each.

mod painter;

use std::io::{self, Write};

use crate::geometry::{Bounds, DVec2};
use crate::graph::Graph;
use crate::grow::{Growth, walk};
use crate::style::{Cap, Colour, Join, Named, Style, View, Width};

use super::{Canvas, NoRoom, RenderError, Size, Survey};
use painter::{Painter, Pass, Scene};

/// Units of the file's coordinates to a pixel.
const FINE: f64 = 100.0;

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

/// A picture that has been written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Picture {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The number of elements of the approximant.
    pub elements: u64,
    /// The number of fractals.
    pub fractals: u64,
}

/// Grows a graph and writes the approximant as SVG.
///
/// # Errors
///
/// If growing ends early, if there is nothing to draw or no room for it, or if `out` fails.
pub fn write(
    graph: &Graph,
    growth: &Growth<'_>,
    style: &Style,
    view: &View,
    size: Size,
    labels: &Labels,
    out: &mut impl Write,
) -> Result<Picture, RenderError> {
    let mut survey = Survey::new(graph, style, growth.steps);
    walk(graph, growth, &mut survey)?;
    let (bounds, pad) = match view.window {
        Some([x, y, width, height]) => {
            let corner = DVec2::new(x, y);
            (Bounds::new(corner, corner + DVec2::new(width, height)), 0.0)
        }
        None => (survey.bounds, survey.overhang()),
    };
    let canvas = Canvas::fit(&bounds, size, view.margin + pad)?;
    if !survey.bounds.is_empty() && !canvas.holds(&survey.bounds) {
        return Err(NoRoom::TooClose.into());
    }
    let (classes, painted) = survey.classes();

    write_head(out, &canvas, style, labels)?;
    let scene = Scene {
        graph,
        style,
        canvas: &canvas,
        classes: &classes,
    };
    let (passes, together) = Pass::all(&scene, painted);
    for pass in passes {
        let mut painter = Painter::new(scene, pass, together, out);
        walk(graph, growth, &mut painter)?;
        painter.close_group()?;
    }
    out.write_all(b"</g>\n</svg>\n")?;
    Ok(Picture {
        size: canvas.size(),
        elements: survey.elements,
        fractals: survey.fractals,
    })
}

fn write_head(
    out: &mut impl Write,
    canvas: &Canvas,
    style: &Style,
    labels: &Labels,
) -> io::Result<()> {
    let [width, height] = canvas.size();
    let (wide, high) = (u64::from(width) * 100, u64::from(height) * 100);
    writeln!(
        out,
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {wide} {high}">"#
    )?;
    writeln!(out, "<title>{}</title>", escaped(&labels.title))?;
    writeln!(out, "<desc>{}</desc>", escaped(&labels.description))?;
    if !labels.provenance.is_empty() {
        writeln!(
            out,
            "<metadata>\n{}</metadata>",
            escaped(&labels.provenance)
        )?;
    }
    if let Some(background) = style.background {
        let opacity = opacity("fill", background);
        writeln!(
            out,
            r#"<rect width="{wide}" height="{high}" fill="{background}"{opacity}/>"#
        )?;
    }
    // What all paths share.
    out.write_all(br#"<g fill="none""#)?;
    if let Width::Pixels(width) = style.width {
        write!(out, r#" stroke-width="{}""#, width * FINE)?;
    }
    if style.cap != Cap::Butt {
        write!(out, r#" stroke-linecap="{}""#, style.cap.name())?;
    }
    if style.join != Join::Miter {
        write!(out, r#" stroke-linejoin="{}""#, style.join.name())?;
    }
    out.write_all(b">\n")
}

/// Text as XML may hold it.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '\n' | '\t' => escaped.push(character),
            '\u{fffe}' | '\u{ffff}' => {}
            control if control.is_control() => {}
            other => escaped.push(other),
        }
    }
    escaped
}

/// The attribute for a colour that is not opaque.
fn opacity(what: &str, colour: Colour) -> String {
    if colour.opacity() < 1.0 {
        format!(r#" {what}-opacity="{:.3}""#, colour.opacity())
    } else {
        String::new()
    }
}
