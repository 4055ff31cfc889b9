use std::io::{self, Write};

use crate::geometry::DVec2;
use crate::graph::Graph;
use crate::grow::{Element, Fractal, Visitor};
use crate::render::path::{PathData, Position};
use crate::render::{Canvas, Classes};
use crate::rule::{BaseElement, Piece};
use crate::style::{Colour, Style, Width};

use super::{FINE, opacity};
use crate::render::WIDTHS_AN_OCTAVE;

/// Path data is handed on in pieces of about this many bytes.
const CHUNK: usize = 1 << 16;

/// How a path element is painted: a new one is begun where this changes.
#[derive(Clone, Copy, PartialEq)]
struct Paint {
    kind: Kind,
    /// The width of a relative stroke, in steps of an eighth of an octave.
    width: i32,
}

/// What a path element holds.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// Open lines.
    Line,
    /// Closed paths of lines, stroked and filled.
    Ring,
    /// Fractals that are closed chains, filled without a stroke.
    Area,
    /// Closed base elements.
    Polygon,
}

impl Paint {
    fn strokes(self, style: &Style) -> bool {
        match self.kind {
            Kind::Line | Kind::Ring => true,
            Kind::Polygon => style.outlines_polygons(),
            Kind::Area => false,
        }
    }
}

/// Where the element before ended.
#[derive(Clone, Copy)]
struct Previous {
    end: DVec2,
    /// Whether that is the end of the element's frame.
    meets_frame: bool,
    /// Whether the pen has drawn it.
    drawn: bool,
}

impl Previous {
    /// The end of an open element that the pen has not drawn.
    fn at_end(element: &Element, base_element: &BaseElement) -> Self {
        let reversed = element.frame.direction.is_reversed();
        let (start, pieces) = base_element.outline(reversed);
        let end = pieces.last().map_or(start, Piece::end);
        Self {
            end: element.frame.map.transform_point2(end),
            meets_frame: meets_frame(base_element, reversed)[1],
            drawn: false,
        }
    }
}

/// Whether an outline starts and ends where its frame does, in the order of traversal.
fn meets_frame(base_element: &BaseElement, reversed: bool) -> [bool; 2] {
    let [start, end] = base_element.ends_meet_frame();
    if reversed { [end, start] } else { [start, end] }
}

/// What is drawn, and how.
#[derive(Clone, Copy)]
pub(super) struct Scene<'a> {
    pub(super) graph: &'a Graph,
    pub(super) style: &'a Style,
    pub(super) canvas: &'a Canvas,
    pub(super) classes: &'a Classes,
}

/// What one walk paints.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Pass {
    /// The areas of fractals that are closed chains, under everything else.
    Areas,
    /// The elements of a class.
    Class(u64),
}

impl Pass {
    /// The walks that a picture takes, and whether strokes bring their fills with them.
    pub(super) fn all(scene: &Scene<'_>, classes: Vec<u64>) -> (Vec<Self>, bool) {
        let Scene { graph, style, .. } = scene;
        let mut passes = Vec::new();
        // One path for both, where stroke and colour never change along a fractal.
        let together = graph.draws_closed_paths()
            && matches!(style.width, Width::Pixels(_))
            && scene.classes.keep_fractals_whole();
        if style.fill.is_some() && !together {
            passes.push(Self::Areas);
        }
        passes.extend(classes.into_iter().map(Self::Class));
        (passes, together)
    }
}

/// Writes the elements of one class.
pub(super) struct Painter<'a, W: Write> {
    scene: Scene<'a>,
    pass: Pass,
    /// The class's colour, where colours tell something.
    colour: Option<Colour>,
    out: &'a mut W,
    buffer: Vec<u8>,
    path: PathData,
    paint: Option<Paint>,
    group_is_open: bool,
    fractal: Fractal,
    previous: Option<Previous>,
    /// For a ring that has not been broken: whether its first element starts where its frame does.
    ring: Option<bool>,
    is_first: bool,
    /// Whether closed paths are filled as they are stroked.
    fills: bool,
}

impl<'a, W: Write> Painter<'a, W> {
    pub(super) fn new(scene: Scene<'a>, pass: Pass, together: bool, out: &'a mut W) -> Self {
        Self {
            scene,
            pass,
            colour: match pass {
                Pass::Areas => None,
                Pass::Class(class) => scene.classes.colour(class, scene.style),
            },
            fills: together && scene.style.fill.is_some(),
            out,
            buffer: Vec::with_capacity(2 * CHUNK),
            path: PathData::default(),
            paint: None,
            group_is_open: false,
            fractal: Fractal::default(),
            previous: None,
            ring: None,
            is_first: true,
        }
    }

    #[inline]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "casts from floats saturate"
    )]
    fn position(&self, point: DVec2) -> Position {
        let fine = self.scene.canvas.pixel(point) * FINE;
        [fine.x.round() as i64, fine.y.round() as i64]
    }

    /// Goes on with the open path element if it is painted alike, or begins a new one.
    fn begin_path(&mut self, paint: Paint) -> io::Result<()> {
        if self.paint == Some(paint) {
            return Ok(());
        }
        self.end_path()?;
        let stroke = self
            .colour
            .or(self.scene.style.stroke)
            .unwrap_or(Colour::BLACK);
        if !self.group_is_open {
            self.group_is_open = true;
            let opacity = opacity("stroke", stroke);
            writeln!(self.buffer, r#"<g stroke="{stroke}"{opacity}>"#)?;
        }
        self.buffer.extend_from_slice(b"<path");
        match paint.kind {
            Kind::Line => {}
            Kind::Ring => self.attribute("fill", self.scene.style.fill)?,
            Kind::Area => {
                self.attribute("fill", self.scene.style.fill)?;
                self.buffer.extend_from_slice(br#" stroke="none""#);
            }
            Kind::Polygon => {
                self.attribute(
                    "fill",
                    self.colour.or(self.scene.style.fill).or(Some(stroke)),
                )?;
                if self.scene.style.outlines_polygons() {
                    self.attribute("stroke", self.scene.style.stroke)?;
                } else {
                    self.buffer.extend_from_slice(br#" stroke="none""#);
                }
            }
        }
        if let (Width::Relative(_), true) =
            (self.scene.style.width, paint.strokes(self.scene.style))
        {
            let width = libm::exp2(f64::from(paint.width) / WIDTHS_AN_OCTAVE);
            write!(self.buffer, r#" stroke-width="{width:.1}""#)?;
        }
        self.buffer.extend_from_slice(b" d=\"");
        self.paint = Some(paint);
        Ok(())
    }

    /// A colour that differs from the group's.
    fn attribute(&mut self, name: &str, colour: Option<Colour>) -> io::Result<()> {
        let Some(colour) = colour else { return Ok(()) };
        write!(
            self.buffer,
            r#" {name}="{colour}"{}"#,
            opacity(name, colour)
        )
    }

    fn end_path(&mut self) -> io::Result<()> {
        if self.paint.take().is_some() {
            self.path.finish();
            self.path.drain(&mut self.buffer);
            self.path = PathData::default();
            self.buffer.extend_from_slice(b"\"/>\n");
        }
        if let Some(previous) = &mut self.previous {
            previous.drawn = false;
        }
        self.hand_on(CHUNK)
    }

    /// Hands the buffer on once it holds more than `most` bytes.
    fn hand_on(&mut self, most: usize) -> io::Result<()> {
        if self.buffer.len() > most {
            self.out.write_all(&self.buffer)?;
            self.buffer.clear();
        }
        Ok(())
    }

    pub(super) fn close_group(mut self) -> io::Result<()> {
        self.end_path()?;
        if self.group_is_open {
            self.buffer.extend_from_slice(b"</g>\n");
        }
        self.hand_on(0)
    }

    fn polygon(&mut self, element: &Element, base_element: &BaseElement) -> io::Result<()> {
        let outlined = self.scene.style.outlines_polygons();
        let width = if outlined {
            self.width_class(element)
        } else {
            0
        };
        self.begin_path(Paint {
            kind: Kind::Polygon,
            width,
        })?;
        let map = element.frame.map;
        // One orientation for all, so that what overlaps stays filled under the nonzero rule.
        let mirrored = element.frame.direction.is_mirrored();
        let backwards = (base_element.signed_area() < 0.0) != mirrored;
        let (start, pieces) = base_element.outline(backwards);
        self.path
            .move_to(self.position(map.transform_point2(start)));
        for piece in pieces {
            self.piece(&piece.transformed(&map));
        }
        let returned = matches!(pieces.last(), Some(Piece::Line(_)));
        self.path.close(returned);
        Ok(())
    }

    /// Goes on along the outline of a fractal that is filled, whether it is drawn there or not.
    fn area(&mut self, element: &Element, base_element: &BaseElement) -> io::Result<()> {
        self.begin_path(Paint {
            kind: Kind::Area,
            width: 0,
        })?;
        let map = element.frame.map;
        let (start, pieces) = base_element.outline(element.frame.direction.is_reversed());
        let start = self.position(map.transform_point2(start));
        if self.is_first {
            self.path.move_to(start);
        } else {
            self.path.line_to(start);
        }
        for piece in pieces {
            self.piece(&piece.transformed(&map));
        }
        Ok(())
    }

    fn line(&mut self, element: &Element, base_element: &BaseElement) -> io::Result<()> {
        let reversed = element.frame.direction.is_reversed();
        let map = element.frame.map;
        self.begin_path(Paint {
            kind: if self.fills { Kind::Ring } else { Kind::Line },
            width: self.width_class(element),
        })?;
        let [meets_start, meets_end] = meets_frame(base_element, reversed);
        let (start, pieces) = base_element.outline(reversed);
        let start = map.transform_point2(start);
        let previous = self.previous.filter(|_| element.joined);
        let shares = previous.is_some_and(|previous| previous.meets_frame && meets_start);
        match previous {
            Some(Previous { drawn: true, .. }) if shares => {}
            Some(Previous { drawn: true, .. }) => self.path.line_to(self.position(start)),
            Some(Previous { end, .. }) if !shares => {
                self.path.move_to(self.position(end));
                self.path.line_to(self.position(start));
            }
            _ => self.path.move_to(self.position(start)),
        }
        if self.is_first {
            self.ring = element.joined.then_some(meets_start);
        } else if !previous.is_some_and(|previous| previous.drawn) {
            self.ring = None;
        }
        for piece in pieces {
            self.piece(&piece.transformed(&map));
        }
        let end = pieces
            .last()
            .map_or(start, |piece| map.transform_point2(piece.end()));
        self.previous = Some(Previous {
            end,
            meets_frame: meets_end,
            drawn: true,
        });
        Ok(())
    }

    #[inline]
    fn piece(&mut self, piece: &Piece) {
        match *piece {
            Piece::Line(end) => self.path.line_to(self.position(end)),
            Piece::Cubic(a, b, end) => {
                self.path
                    .curve_to(self.position(a), self.position(b), self.position(end));
            }
        }
    }

    #[expect(
        clippy::cast_possible_truncation,
        reason = "casts from floats saturate"
    )]
    fn width_class(&self, element: &Element) -> i32 {
        match self.scene.style.width {
            Width::Pixels(_) => 0,
            Width::Relative(width) => {
                let fine = width * element.frame.length() * self.scene.canvas.scale() * FINE;
                (WIDTHS_AN_OCTAVE * libm::log2(fine.max(1.0))).round() as i32
            }
        }
    }
}

impl<W: Write> Visitor for Painter<'_, W> {
    type Error = io::Error;

    fn begin(&mut self, fractal: Fractal) -> io::Result<()> {
        self.fractal = fractal;
        self.previous = None;
        self.ring = None;
        self.is_first = true;
        Ok(())
    }

    #[inline]
    fn element(&mut self, element: &Element) -> io::Result<()> {
        let Scene { graph, classes, .. } = self.scene;
        let object = &graph.objects()[element.object];
        let base_element = &graph.base_elements()[object.base_element];
        let class = classes.of(element, &self.fractal, graph);
        if self.pass == Pass::Areas {
            if self.fractal.is_ring && !base_element.is_closed() {
                self.area(element, base_element)?;
            }
        } else if !object.visible || base_element.is_closed() {
            self.previous = None;
            if object.visible && self.pass == Pass::Class(class) {
                self.polygon(element, base_element)?;
            }
        } else if self.pass == Pass::Class(class) {
            self.line(element, base_element)?;
        } else {
            self.previous = Some(Previous::at_end(element, base_element));
        }
        self.is_first = false;
        if self.path.len() > CHUNK {
            self.path.drain(&mut self.buffer);
            self.hand_on(CHUNK)?;
        }
        Ok(())
    }

    fn end(&mut self, joined: bool) -> io::Result<()> {
        if self.pass == Pass::Areas && self.paint.is_some() {
            self.path.close(false);
        } else if let (true, Some(meets_start), Some(previous)) = (joined, self.ring, self.previous)
            && previous.drawn
        {
            self.path.close(meets_start && previous.meets_frame);
        }
        // Polygons of different fractals stay in one path; lines begin a new one.
        if self.paint.is_some_and(|paint| paint.kind != Kind::Polygon) {
            self.end_path()?;
        }
        Ok(())
    }
}
