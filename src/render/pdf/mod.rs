//! PDF: the paths of a picture on one page, streamed, with its colours, opacities, caps and joins.
//!
//! The page's content is compressed in pieces, on any thread; of a piece that has been written, only its
//! offset in the file stays in memory.

mod file;

use std::collections::BTreeSet;
use std::io::{self, Write};

use crate::parallel::{Pipeline, Team};
use crate::style::{Blend, Cap, Colour, Join};

use super::drawing::Page;
use super::options::Labels;
use super::paint::{FINE, Paint, Pen, Position};
use super::surface::Surface;
use file::{File, Piece, real};

/// Longest side of a page, in its units.
const LONGEST: f64 = 14_400.0;

/// Points per millimetre: the default unit of a page is a point.
const POINTS: f64 = 72.0 / 25.4;

/// Operators that fill a path and stroke it again. `B` alone would let the stroke replace the fill below it.
const TWICE: &str = "f S";

/// Opacity of fills or strokes.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Opacity {
    of_strokes: bool,
    value: u8,
}

/// Graphics state set by the content so far.
#[derive(Clone, Copy, Default)]
struct GraphicsState {
    fill: Option<Colour>,
    stroke: Option<Colour>,
    pen: Option<Pen>,
}

/// Page that is being written.
pub(super) struct Pdf<'t, 'w, W> {
    file: File<W>,
    piece: Piece,
    line: Pipeline<'t, 'w, Piece>,
    /// Width and height, in the page's units.
    page: [f64; 2],
    /// Points per unit of the page.
    user_unit: f64,
    /// Current graphics state.
    state: GraphicsState,
    /// States outside of the parts that have been entered.
    outer: Vec<GraphicsState>,
    opacities: BTreeSet<Opacity>,
    /// Operator that paints the current path.
    operator: &'static str,
    /// Place in the piece where the current path begins.
    path: usize,
    /// Parts of the current path that have been handed on, if it is drawn twice.
    handed_on: Vec<u8>,
    labels: Labels,
    /// Blend mode of all paths, unless it is the normal one.
    blend: Option<&'static str>,
}

impl<'t, 'w, W: Write> Pdf<'t, 'w, W> {
    pub(super) fn begin(out: W, page: &Page<'_>, team: &'t Team<'w>) -> io::Result<Self> {
        let Page {
            size,
            unit,
            background,
            labels,
            blend,
            ..
        } = *page;
        let point = unit.millimetres() * POINTS;
        let sides = size.map(|side| f64::from(side) * point);
        let user_unit = (sides[0].max(sides[1]) / LONGEST).ceil().max(1.0);
        let page = sides.map(|side| side / user_unit);
        let mut pdf = Self {
            file: File::begin(out)?,
            piece: Piece::default(),
            line: team.line(Piece::pack),
            page,
            user_unit,
            state: GraphicsState::default(),
            outer: Vec::new(),
            opacities: BTreeSet::new(),
            operator: "n",
            path: 0,
            handed_on: Vec::new(),
            labels: labels.clone(),
            blend: match blend {
                Blend::Joined | Blend::Normal => None,
                Blend::Multiply => Some("Multiply"),
                Blend::Add | Blend::Screen => Some("Screen"),
            },
        };
        // Positions are in hundredths of a unit of the picture, from its upper left corner, y down.
        let scale = real(point / user_unit / FINE);
        let height = real(page[1]);
        pdf.text(&format!("{scale} 0 0 -{scale} 0 {height} cm\n4 M\n"));
        if let Some(background) = background {
            pdf.paint(&Paint {
                fill: Some(background),
                stroke: None,
                has_holes: false,
            });
            let [wide, high] = size.map(|side| u64::from(side) * 100);
            pdf.text(&format!("0 0 {wide} {high} re f\n"));
        }
        if pdf.blend.is_some() {
            pdf.text("/Blend gs\n");
        }
        Ok(pdf)
    }

    /// Ends the page and the file.
    pub(super) fn finish(mut self) -> io::Result<()> {
        self.next_piece()?;
        let file = &mut self.file;
        self.line.finish(&mut |piece| file.piece(piece))?;
        let states = self.opacities.iter().map(|opacity| {
            let value = real(f64::from(opacity.value) / 255.0);
            let key = if opacity.of_strokes { "CA" } else { "ca" };
            format!("/{}<</{key} {value}>>", name(*opacity))
        });
        let blend = self.blend.map(|mode| format!("/Blend<</BM/{mode}>>"));
        let states: String = states.chain(blend).collect();
        let resources = format!("<</ExtGState<<{states}>>>>");
        let [width, height] = self.page.map(real);
        let user_unit = match self.user_unit {
            1.0 => String::new(),
            larger => format!("/UserUnit {}", real(larger)),
        };
        let page = format!("/MediaBox[0 0 {width} {height}]{user_unit}/Resources{resources}");
        self.file.finish(&page, &self.labels)
    }

    fn next_piece(&mut self) -> io::Result<()> {
        let mut next = self.line.spare().unwrap_or_default();
        next.text.clear();
        let piece = std::mem::replace(&mut self.piece, next);
        let file = &mut self.file;
        self.line.hand_on(piece, &mut |piece| file.piece(piece))
    }

    fn text(&mut self, text: &str) {
        self.piece.text.extend_from_slice(text.as_bytes());
    }

    #[inline]
    fn command(&mut self, positions: &[Position], operator: u8) {
        let text = &mut self.piece.text;
        let mut number = itoa::Buffer::new();
        for value in positions.iter().flatten() {
            text.extend_from_slice(number.format(*value).as_bytes());
            text.push(b' ');
        }
        text.extend_from_slice(&[operator, b'\n']);
    }

    /// Sets the graphics state for the next path, where it differs.
    fn paint(&mut self, paint: &Paint) {
        let stroke = paint.stroke.map(|stroke| stroke.colour);
        for (colour, of_strokes) in [(paint.fill, false), (stroke, true)] {
            let GraphicsState { fill, stroke, .. } = &mut self.state;
            let last = if of_strokes { stroke } else { fill };
            let before = *last;
            let Some(colour) = colour.filter(|&colour| before != Some(colour)) else {
                continue;
            };
            *last = Some(colour);
            let [red, green, blue, value] = colour.rgba();
            // The initial state is opaque.
            if before.map_or(255, |before| before.rgba()[3]) != value {
                let opacity = Opacity { of_strokes, value };
                self.opacities.insert(opacity);
                self.text(&format!("/{} gs\n", name(opacity)));
            }
            let [red, green, blue] = [red, green, blue].map(|part| real(f64::from(part) / 255.0));
            let operator = if of_strokes { "RG" } else { "rg" };
            self.text(&format!("{red} {green} {blue} {operator}\n"));
        }
        if let Some(stroke) = paint.stroke
            && self.state.pen != Some(stroke.pen)
        {
            self.state.pen = Some(stroke.pen);
            self.pen(stroke.pen);
        }
    }

    fn pen(&mut self, pen: Pen) {
        let cap = match pen.cap {
            Cap::Butt => 0,
            Cap::Round => 1,
            Cap::Square => 2,
        };
        let join = match pen.join {
            Join::Miter => 0,
            Join::Round => 1,
            Join::Bevel => 2,
        };
        let width = real(pen.width * FINE);
        let dash = match pen.dash {
            0.0 => String::new(),
            dash => real(dash * FINE),
        };
        self.text(&format!("{width} w {cap} J {join} j [{dash}] 0 d\n"));
    }
}

impl<W: Write> Surface for Pdf<'_, '_, W> {
    fn begin(&mut self, paint: &Paint) -> io::Result<()> {
        // A stroke of width 0 would be drawn as the thinnest possible line.
        let stroke = paint.stroke.filter(|stroke| stroke.pen.width > 0.0);
        let paint = Paint { stroke, ..*paint };
        self.paint(&paint);
        self.path = self.piece.text.len();
        self.operator = match (paint.fill, paint.stroke) {
            (Some(_), Some(stroke)) if stroke.colour.rgba()[3] < 255 && self.blend.is_none() => {
                TWICE
            }
            (Some(_), Some(_)) => "B",
            (Some(_), None) => "f",
            (None, Some(_)) => "S",
            (None, None) => "n",
        };
        Ok(())
    }

    #[inline]
    fn move_to(&mut self, to: Position) {
        self.command(&[to], b'm');
    }

    #[inline]
    fn line_to(&mut self, to: Position) {
        self.command(&[to], b'l');
    }

    fn curve_to(&mut self, a: Position, b: Position, to: Position) {
        self.command(&[a, b, to], b'c');
    }

    fn close(&mut self) {
        self.command(&[], b'h');
    }

    #[inline]
    fn hand_on(&mut self) -> io::Result<()> {
        if self.piece.is_full() {
            if self.operator == TWICE {
                self.handed_on
                    .extend_from_slice(&self.piece.text[self.path..]);
                self.path = 0;
            }
            return self.next_piece();
        }
        Ok(())
    }

    fn end(&mut self) -> io::Result<()> {
        let mut operator = self.operator;
        if operator == TWICE {
            self.operator = "S";
            let mut path = std::mem::take(&mut self.handed_on);
            path.extend_from_slice(&self.piece.text[self.path..]);
            self.text("f\n");
            // Pieces end between commands.
            for command in path.split_inclusive(|byte| *byte == b'\n') {
                self.hand_on()?;
                self.piece.text.extend_from_slice(command);
            }
            path.clear();
            self.handed_on = path;
            operator = "S";
        }
        self.text(&format!("{operator}\n"));
        self.hand_on()
    }

    fn broadens(&self, _: &Paint) -> bool {
        true
    }

    fn enter(&mut self, corner: [u32; 2], size: [u32; 2]) -> io::Result<bool> {
        let [x, y] = corner.map(|side| u64::from(side) * 100);
        let [wide, high] = size.map(|side| u64::from(side) * 100);
        self.outer.push(self.state);
        self.text(&format!("q 1 0 0 1 {x} {y} cm 0 0 {wide} {high} re W n\n"));
        Ok(true)
    }

    fn leave(&mut self) -> io::Result<()> {
        self.text("Q\n");
        // The operator restores the state from before the part.
        self.state = self.outer.pop().unwrap_or_default();
        Ok(())
    }
}

/// Returns the resource name of an opacity.
fn name(opacity: Opacity) -> String {
    let what = if opacity.of_strokes { 'S' } else { 'F' };
    format!("{what}{}", opacity.value)
}
