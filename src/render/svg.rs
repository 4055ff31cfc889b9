//! SVG: paths in integer hundredths of a pixel, streamed.

mod chunk;
mod path;

use std::io::{self, Write};

use crate::parallel::{Pipeline, Team};
use crate::style::{Blend, Cap, Colour, Join, Named};

use super::drawing::Page;
use super::paint::{FINE, Paint, Pen, Position, Stroke};
use super::surface::Surface;
use chunk::Chunk;

/// SVG document that is being written.
pub(super) struct Svg<'t, 'w, W> {
    out: W,
    chunk: Chunk,
    /// Pipeline that formats chunks of the document.
    line: Pipeline<'t, 'w, Chunk>,
    /// Current point and start of the subpath.
    at: [Position; 2],
    /// Stroke attributes that paths inherit.
    pen: Pen,
    /// Stroke colour of the open group.
    group: Option<Colour>,
    /// Number of layers so far, if groups are Inkscape layers; these are at the top level of the document,
    /// where plotter software expects them.
    layers: Option<u32>,
    label: Option<String>,
}

impl<'t, 'w, W: Write> Svg<'t, 'w, W> {
    /// Begins a document.
    pub(super) fn begin(mut out: W, page: &Page<'_>, team: &'t Team<'w>) -> io::Result<Self> {
        begin_document(&mut out, page)?;
        let Page {
            pen, has_layers, ..
        } = *page;
        if !has_layers {
            writeln!(out, "<g{}>", shared(pen))?;
        }
        Ok(Self {
            out,
            chunk: Chunk::default(),
            line: team.line(Chunk::format),
            at: [[0, 0]; 2],
            pen,
            group: None,
            layers: has_layers.then_some(0),
            label: None,
        })
    }

    /// Ends the document.
    pub(super) fn finish(mut self) -> io::Result<()> {
        self.close_group();
        if self.layers.is_none() {
            self.text("</g>\n");
        }
        self.text("</svg>\n");
        self.next_chunk(None)?;
        let out = &mut self.out;
        self.line.finish(&mut |chunk| out.write_all(&chunk.text))
    }

    /// Submits the chunk and begins the next one; `within` is the state of the path if that continues.
    fn next_chunk(&mut self, within: Option<[Position; 2]>) -> io::Result<()> {
        let mut next = self.line.spare().unwrap_or_default();
        next.begin(within);
        let chunk = std::mem::replace(&mut self.chunk, next);
        let out = &mut self.out;
        self.line
            .hand_on(chunk, &mut |chunk| out.write_all(&chunk.text))
    }

    fn open_group(&mut self, colour: Colour) {
        if self.group != Some(colour) {
            self.close_group();
            self.group = Some(colour);
            let opacity = opacity("stroke", colour);
            self.text("<g");
            if let Some(layers) = &mut self.layers {
                *layers += 1;
                // Plotter software takes the number at the start of the name as that of the pen.
                let layer = format!(
                    r#" id="layer{layers}" inkscape:groupmode="layer" inkscape:label="{layers} {colour}"{}"#,
                    shared(self.pen)
                );
                self.text(&layer);
            }
            self.text(&format!(" stroke=\"{colour}\"{opacity}>\n"));
        }
    }

    fn close_group(&mut self) {
        if self.group.take().is_some() {
            self.text("</g>\n");
        }
    }

    fn text(&mut self, text: &str) {
        self.chunk.write(text.as_bytes());
    }

    /// Writes the attributes in which strokes differ from those of the document.
    fn pen(&mut self, pen: Pen) {
        if pen.width != self.pen.width {
            self.text(&format!(r#" stroke-width="{:.1}""#, pen.width * FINE));
        }
        if pen.cap != self.pen.cap {
            self.text(&format!(r#" stroke-linecap="{}""#, pen.cap.name()));
        }
        if pen.join != self.pen.join {
            self.text(&format!(r#" stroke-linejoin="{}""#, pen.join.name()));
        }
        if pen.dash > 0.0 {
            self.text(&format!(r#" stroke-dasharray="{:.1}""#, pen.dash * FINE));
        }
    }
}

impl<W: Write> Surface for Svg<'_, '_, W> {
    fn begin(&mut self, paint: &Paint) -> io::Result<()> {
        if let Some(Stroke { colour, .. }) = paint.stroke {
            self.open_group(colour);
        }
        self.text("<path");
        if let Some(label) = self.label.take() {
            let label = escaped(&label).replace('"', "&quot;");
            self.text(&format!(r#" aria-label="{label}""#));
        }
        if let Some(fill) = paint.fill {
            self.text(&format!(r#" fill="{fill}"{}"#, opacity("fill", fill)));
        }
        match paint.stroke {
            Some(stroke) => self.pen(stroke.pen),
            None if self.group.is_some() => self.text(r#" stroke="none""#),
            None => {}
        }
        self.text(" d=\"");
        Ok(())
    }

    #[inline]
    fn move_to(&mut self, to: Position) {
        self.at = [to, to];
        self.chunk.move_to(to);
    }

    #[inline]
    fn line_to(&mut self, to: Position) {
        self.at[0] = to;
        self.chunk.line_to(to);
    }

    #[inline]
    fn curve_to(&mut self, a: Position, b: Position, to: Position) {
        self.at[0] = to;
        self.chunk.curve_to([a, b, to]);
    }

    #[inline]
    fn close(&mut self) {
        self.at[0] = self.at[1];
        self.chunk.close();
    }

    #[inline]
    fn hand_on(&mut self) -> io::Result<()> {
        if self.chunk.is_full() {
            return self.next_chunk(Some(self.at));
        }
        Ok(())
    }

    fn end(&mut self) -> io::Result<()> {
        self.text("\"/>\n");
        if self.chunk.is_full() {
            return self.next_chunk(None);
        }
        Ok(())
    }

    fn broadens(&self, _: &Paint) -> bool {
        true
    }

    fn enter(&mut self, corner: [u32; 2], size: [u32; 2]) -> io::Result<bool> {
        self.close_group();
        let ([x, y], [width, height]) = (fine(corner), fine(size));
        self.text(&format!(
            "<svg x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\">\n"
        ));
        Ok(true)
    }

    fn leave(&mut self) -> io::Result<()> {
        self.close_group();
        self.text("</svg>\n");
        Ok(())
    }

    fn label(&mut self, text: &str) {
        self.label = Some(text.into());
    }
}

/// Rule that turns black to white where a page is dark.
const ON_DARK_PAGES: &str =
    "@media(prefers-color-scheme:dark){[stroke='#000000']{stroke:#fff}[fill='#000000']{fill:#fff}}";

/// Writes the head of a document: the root's tag, the metadata and the background.
pub(super) fn begin_document(out: &mut impl Write, page: &Page<'_>) -> io::Result<()> {
    let Page {
        size,
        unit,
        background,
        labels,
        blend,
        has_default_ink,
        has_layers,
        ..
    } = *page;
    let [wide, high] = fine(size);
    let [width, height] = size.map(|side| unit.length(side));
    let namespace = if has_layers {
        r#" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape""#
    } else {
        ""
    };
    writeln!(
        out,
        r#"<svg xmlns="http://www.w3.org/2000/svg"{namespace} width="{width}" height="{height}" viewBox="0 0 {wide} {high}">"#
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
    if has_default_ink && background.is_none() {
        writeln!(out, "<style>{ON_DARK_PAGES}</style>")?;
    }
    let mode = match blend {
        Blend::Joined | Blend::Normal => None,
        Blend::Multiply => Some("multiply"),
        Blend::Add => Some("plus-lighter"),
        Blend::Screen => Some("screen"),
    };
    if let Some(mode) = mode {
        writeln!(out, "<style>path{{mix-blend-mode:{mode}}}</style>")?;
    }
    if let Some(background) = background {
        let opacity = opacity("fill", background);
        writeln!(
            out,
            r#"<rect width="{wide}" height="{high}" fill="{background}"{opacity}/>"#
        )?;
    }
    Ok(())
}

/// Returns the attributes that all paths share.
fn shared(pen: Pen) -> String {
    let (width, ends) = (pen.width * FINE, ends_and_corners(pen));
    format!(r#" fill="none" stroke-width="{width}"{ends}"#)
}

/// Returns the attributes for caps and joins that differ from the defaults of SVG.
pub(super) fn ends_and_corners(pen: Pen) -> String {
    let mut text = String::new();
    if pen.cap != Cap::Butt {
        text.push_str(&format!(r#" stroke-linecap="{}""#, pen.cap.name()));
    }
    if pen.join != Join::Miter {
        text.push_str(&format!(r#" stroke-linejoin="{}""#, pen.join.name()));
    }
    text
}

/// Converts pixels to the units of positions.
fn fine(pixels: [u32; 2]) -> [u64; 2] {
    pixels.map(|side| u64::from(side) * 100)
}

/// Escapes text for XML, and removes characters that XML excludes.
pub(crate) fn escaped(text: &str) -> String {
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

/// Returns the opacity attribute of a colour; empty if it is opaque.
pub(super) fn opacity(what: &str, colour: Colour) -> String {
    if colour.opacity() < 1.0 {
        format!(r#" {what}-opacity="{:.3}""#, colour.opacity())
    } else {
        String::new()
    }
}
