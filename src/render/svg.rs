//! SVG: paths in whole hundredths of a pixel, streamed.

mod path;

use std::io::{self, Write};

use crate::style::{Cap, Colour, Join, Named};

use super::Labels;
use super::surface::{FINE, Paint, Pen, Position, Stroke, Surface};
use path::PathData;

/// Path data is handed on in pieces of about this many bytes.
const CHUNK: usize = 1 << 16;

/// An SVG document that is being written.
pub(super) struct Svg<W> {
    out: W,
    buffer: Vec<u8>,
    path: PathData,
    /// The pen that all strokes have that say nothing else.
    pen: Pen,
    /// The colour of strokes in the group that is open.
    group: Option<Colour>,
    label: Option<String>,
}

impl<W: Write> Svg<W> {
    /// Begins a document whose strokes are mostly drawn with `pen`.
    pub(super) fn begin(
        mut out: W,
        [width, height]: [u32; 2],
        background: Option<Colour>,
        pen: Pen,
        labels: &Labels,
    ) -> io::Result<Self> {
        let [wide, high] = fine([width, height]);
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
        if let Some(background) = background {
            let opacity = opacity("fill", background);
            writeln!(
                out,
                r#"<rect width="{wide}" height="{high}" fill="{background}"{opacity}/>"#
            )?;
        }
        // What all paths share.
        write!(out, r#"<g fill="none" stroke-width="{}""#, pen.width * FINE)?;
        if pen.cap != Cap::Butt {
            write!(out, r#" stroke-linecap="{}""#, pen.cap.name())?;
        }
        if pen.join != Join::Miter {
            write!(out, r#" stroke-linejoin="{}""#, pen.join.name())?;
        }
        out.write_all(b">\n")?;
        Ok(Self {
            out,
            buffer: Vec::with_capacity(2 * CHUNK),
            path: PathData::default(),
            pen,
            group: None,
            label: None,
        })
    }

    /// Ends the document.
    pub(super) fn finish(mut self) -> io::Result<()> {
        self.close_group();
        self.buffer.extend_from_slice(b"</g>\n</svg>\n");
        self.out.write_all(&self.buffer)
    }

    fn open_group(&mut self, colour: Colour) -> io::Result<()> {
        if self.group != Some(colour) {
            self.close_group();
            self.group = Some(colour);
            let opacity = opacity("stroke", colour);
            writeln!(self.buffer, r#"<g stroke="{colour}"{opacity}>"#)?;
        }
        Ok(())
    }

    fn close_group(&mut self) {
        if self.group.take().is_some() {
            self.buffer.extend_from_slice(b"</g>\n");
        }
    }

    /// The attributes in which a pen differs from that of the document.
    fn pen(&mut self, pen: Pen) -> io::Result<()> {
        let out = &mut self.buffer;
        if pen.width != self.pen.width {
            write!(out, r#" stroke-width="{:.1}""#, pen.width * FINE)?;
        }
        if pen.cap != self.pen.cap {
            write!(out, r#" stroke-linecap="{}""#, pen.cap.name())?;
        }
        if pen.join != self.pen.join {
            write!(out, r#" stroke-linejoin="{}""#, pen.join.name())?;
        }
        if pen.dash > 0.0 {
            write!(out, r#" stroke-dasharray="{:.1}""#, pen.dash * FINE)?;
        }
        Ok(())
    }
}

impl<W: Write> Surface for Svg<W> {
    fn begin(&mut self, paint: &Paint) -> io::Result<()> {
        if let Some(Stroke { colour, .. }) = paint.stroke {
            self.open_group(colour)?;
        }
        self.buffer.extend_from_slice(b"<path");
        if let Some(label) = self.label.take() {
            let label = escaped(&label).replace('"', "&quot;");
            write!(self.buffer, r#" aria-label="{label}""#)?;
        }
        if let Some(fill) = paint.fill {
            write!(self.buffer, r#" fill="{fill}"{}"#, opacity("fill", fill))?;
        }
        match paint.stroke {
            Some(stroke) => self.pen(stroke.pen)?,
            None if self.group.is_some() => self.buffer.extend_from_slice(br#" stroke="none""#),
            None => {}
        }
        self.buffer.extend_from_slice(b" d=\"");
        Ok(())
    }

    #[inline]
    fn move_to(&mut self, to: Position) {
        self.path.move_to(to);
    }

    #[inline]
    fn line_to(&mut self, to: Position) {
        self.path.line_to(to);
    }

    #[inline]
    fn curve_to(&mut self, a: Position, b: Position, to: Position) {
        self.path.curve_to(a, b, to);
    }

    #[inline]
    fn close(&mut self) {
        self.path.close();
    }

    #[inline]
    fn hand_on(&mut self) -> io::Result<()> {
        if self.path.len() > CHUNK {
            self.path.drain(&mut self.buffer);
            self.out.write_all(&self.buffer)?;
            self.buffer.clear();
        }
        Ok(())
    }

    fn end(&mut self) -> io::Result<()> {
        self.path.drain(&mut self.buffer);
        self.path.clear();
        self.buffer.extend_from_slice(b"\"/>\n");
        if self.buffer.len() > CHUNK {
            self.out.write_all(&self.buffer)?;
            self.buffer.clear();
        }
        Ok(())
    }

    fn enter(&mut self, corner: [u32; 2], size: [u32; 2]) -> io::Result<()> {
        self.close_group();
        let ([x, y], [width, height]) = (fine(corner), fine(size));
        writeln!(
            self.buffer,
            r#"<svg x="{x}" y="{y}" width="{width}" height="{height}" viewBox="0 0 {width} {height}">"#
        )
    }

    fn leave(&mut self) -> io::Result<()> {
        self.close_group();
        self.buffer.extend_from_slice(b"</svg>\n");
        Ok(())
    }

    fn label(&mut self, text: &str) {
        self.label = Some(text.into());
    }
}

/// Whole pixels in the units of positions.
fn fine(pixels: [u32; 2]) -> [u64; 2] {
    pixels.map(|side| u64::from(side) * 100)
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
