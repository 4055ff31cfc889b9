use std::io;

use crate::geometry::DVec2;
use crate::grow::{Element, Enter, Fractal, Run, Subtree, Visitor};
use crate::rule::{BaseElement, Piece};
use crate::style::{Colour, Width};

use super::classes::Share;
use super::scene::{Pass, Scene};
use super::surface::{FINE, Paint, Position, Stroke, Surface, position};
use super::tracer::Tracer;
use super::{WIDTHS_AN_OCTAVE, pen};

/// What tells paths apart: a new one is begun where this changes.
#[derive(Clone, Copy, PartialEq)]
struct Look {
    kind: Kind,
    /// The width of a relative stroke, in steps of an eighth of an octave.
    width: i32,
}

/// What a path holds.
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

/// Paints what one walk over an approximant is for.
pub(super) struct Painter<'a, 's, S> {
    scene: &'a Scene<'a>,
    pass: Pass,
    /// The class's colour, where colours tell something.
    colour: Option<Colour>,
    tracer: Tracer<'s, S>,
    look: Option<Look>,
    fractal: Fractal,
    previous: Option<Previous>,
    /// For a ring that has not been broken: whether its first element starts where its frame does.
    ring: Option<bool>,
    is_first: bool,
}

impl<'a, 's, S: Surface> Painter<'a, 's, S> {
    pub(super) fn new(scene: &'a Scene<'a>, pass: Pass, surface: &'s mut S) -> Self {
        Self {
            scene,
            pass,
            colour: match pass {
                Pass::Areas => None,
                Pass::Class(class) => scene.classes.colour(class, scene.style),
            },
            tracer: Tracer::new(surface),
            look: None,
            fractal: Fractal::default(),
            previous: None,
            ring: None,
            is_first: true,
        }
    }

    /// Ends what is still open.
    pub(super) fn finish(mut self) -> io::Result<()> {
        self.end_path()
    }

    #[inline]
    fn position(&self, point: DVec2) -> Position {
        position(self.scene.canvas.pixel(point) * FINE)
    }

    /// Goes on with the open path if it looks alike, or begins a new one.
    fn begin_path(&mut self, look: Look) -> io::Result<()> {
        if self.look == Some(look) {
            return Ok(());
        }
        self.end_path()?;
        let paint = self.paint(look);
        self.tracer.begin(&paint)?;
        self.look = Some(look);
        Ok(())
    }

    fn paint(&self, look: Look) -> Paint {
        let style = self.scene.style;
        let colour = self.colour.or(style.stroke).unwrap_or(Colour::BLACK);
        let mut pen = pen(style);
        if let Width::Relative(_) = style.width {
            pen.width = libm::exp2(f64::from(look.width) / WIDTHS_AN_OCTAVE) / FINE;
        }
        let stroke = |colour| Some(Stroke { colour, pen });
        let (fill, stroke) = match look.kind {
            Kind::Line => (None, stroke(colour)),
            Kind::Ring => (style.fill, stroke(colour)),
            Kind::Area => (style.fill, None),
            Kind::Polygon => (
                self.colour.or(style.fill).or(Some(colour)),
                style
                    .stroke
                    .filter(|_| style.outlines_polygons())
                    .and_then(stroke),
            ),
        };
        Paint { fill, stroke }
    }

    fn end_path(&mut self) -> io::Result<()> {
        if let Some(previous) = &mut self.previous {
            previous.drawn = false;
        }
        if self.look.take().is_some() {
            self.tracer.end()?;
        }
        Ok(())
    }

    fn polygon(&mut self, element: &Element, base_element: &BaseElement) -> io::Result<()> {
        let outlined = self.scene.style.outlines_polygons();
        let width = if outlined {
            self.width_class(element)
        } else {
            0
        };
        self.begin_path(Look {
            kind: Kind::Polygon,
            width,
        })?;
        let map = element.frame.map;
        // One orientation for all, so that what overlaps stays filled under the nonzero rule.
        let mirrored = map.matrix2.determinant() < 0.0;
        let backwards = (base_element.signed_area() < 0.0) != mirrored;
        let (start, pieces) = base_element.outline(backwards);
        self.tracer
            .move_to(self.position(map.transform_point2(start)));
        for piece in pieces {
            self.piece(&piece.transformed(&map));
        }
        let returned = matches!(pieces.last(), Some(Piece::Line(_)));
        self.tracer.close(returned);
        Ok(())
    }

    /// Goes on along the outline of a fractal that is filled, whether it is drawn there or not.
    fn area(&mut self, element: &Element, base_element: &BaseElement) -> io::Result<()> {
        self.begin_path(Look {
            kind: Kind::Area,
            width: 0,
        })?;
        let map = element.frame.map;
        let (start, pieces) = base_element.outline(element.frame.direction.is_reversed());
        let start = self.position(map.transform_point2(start));
        if self.is_first {
            self.tracer.move_to(start);
        } else {
            self.tracer.line_to(start);
        }
        for piece in pieces {
            self.piece(&piece.transformed(&map));
        }
        Ok(())
    }

    fn line(&mut self, element: &Element, base_element: &BaseElement) -> io::Result<()> {
        let reversed = element.frame.direction.is_reversed();
        let map = element.frame.map;
        self.begin_path(Look {
            kind: if self.scene.fills_strokes {
                Kind::Ring
            } else {
                Kind::Line
            },
            width: self.width_class(element),
        })?;
        let [meets_start, meets_end] = meets_frame(base_element, reversed);
        let (start, pieces) = base_element.outline(reversed);
        let start = map.transform_point2(start);
        let previous = self.previous.filter(|_| element.joined);
        let shares = previous.is_some_and(|previous| previous.meets_frame && meets_start);
        match previous {
            Some(Previous { drawn: true, .. }) if shares => {}
            Some(Previous { drawn: true, .. }) => self.tracer.line_to(self.position(start)),
            Some(Previous { end, .. }) if !shares => {
                self.tracer.move_to(self.position(end));
                self.tracer.line_to(self.position(start));
            }
            _ => self.tracer.move_to(self.position(start)),
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

    /// Lines of one class that end in these points, one after another.
    fn lines(&mut self, run: &Run<'_>, ends: &[DVec2], first: &Element) -> io::Result<()> {
        self.element(first)?;
        let map = self.scene.canvas.map(run.map());
        for &end in &ends[1..] {
            self.tracer
                .line_to(position(map.transform_point2(end) * FINE));
        }
        self.previous = ends.last().map(|&end| Previous {
            end: run.map().transform_point2(end),
            meets_frame: true,
            drawn: true,
        });
        self.tracer.hand_on()
    }

    #[inline]
    fn piece(&mut self, piece: &Piece) {
        match *piece {
            Piece::Line(end) => self.tracer.line_to(self.position(end)),
            Piece::Cubic(a, b, end) => {
                self.tracer
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
                let length = element.frame.stretch() * self.scene.graph.unit();
                let fine = width * length * self.scene.canvas.scale() * FINE;
                (WIDTHS_AN_OCTAVE * libm::log2(fine.max(1.0))).round() as i32
            }
        }
    }
}

impl<S: Surface> Visitor for Painter<'_, '_, S> {
    type Error = io::Error;

    fn takes_runs(&self) -> bool {
        !self.scene.sight.cuts()
    }

    fn begin(&mut self, fractal: Fractal) -> io::Result<()> {
        self.fractal = fractal;
        self.previous = None;
        self.ring = None;
        self.is_first = true;
        Ok(())
    }

    #[inline]
    fn enter(&mut self, subtree: &Subtree) -> Enter {
        self.scene.sight.enter(subtree)
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
        self.tracer.hand_on()
    }

    fn run(&mut self, run: &Run<'_>) -> io::Result<()> {
        let Scene { graph, classes, .. } = self.scene;
        let share = match self.pass {
            Pass::Areas => Share::Some,
            Pass::Class(class) => classes.share(run, &self.fractal, graph, class),
        };
        match (share, run.line(), run.first(), run.last()) {
            // Of what is not painted only the end matters, where the next line may begin.
            (Share::None, _, _, Some(last)) => self.element(&last),
            (Share::All, Some(ends), Some(first), _)
                if matches!(self.scene.style.width, Width::Pixels(_)) =>
            {
                self.lines(run, ends, &first)
            }
            _ => run
                .elements()
                .try_for_each(|element| self.element(&element)),
        }
    }

    fn end(&mut self, joined: bool) -> io::Result<()> {
        if self.pass == Pass::Areas && self.look.is_some() {
            self.tracer.close(false);
        } else if let (true, Some(meets_start), Some(previous)) = (joined, self.ring, self.previous)
            && previous.drawn
        {
            self.tracer.close(meets_start && previous.meets_frame);
        }
        // Polygons of different fractals stay in one path; lines begin a new one.
        if self.look.is_some_and(|look| look.kind != Kind::Polygon) {
            self.end_path()?;
        }
        Ok(())
    }
}
