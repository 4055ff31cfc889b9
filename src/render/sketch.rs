//! Sketches: what a span of a walk draws, in positions on the picture.
//!
//! A sketch is made by any thread, without knowing what was drawn before; the painter puts the
//! sketches of all spans together, in order.

use std::io;
use std::ops::Range;
use std::sync::Arc;

use crate::geometry::DVec2;
use crate::grow::{Element, Enter, Fractal, Run, Stick, Subtree, Visitor};
use crate::rule::{BaseElement, Piece};
use crate::style::{ColorBy, Colour, Width};

use super::WIDTHS_AN_OCTAVE;
use super::aim::Aim;
use super::classes::Share;
use super::comb::Comb;
use super::hidden::Hidden;
use super::scene::{Pass, Scene};
use super::stamps::{LONGEST_RUN, Painted, Stamps};
use super::surface::{FINE, Position, Stamped, Tuft, position};

/// What tells paths apart: a new one is begun where this changes.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Look {
    pub(super) kind: Kind,
    /// The width of a stroke where widths differ, in steps of an eighth of an octave.
    pub(super) width: i32,
    /// Its colour, where what is drawn is tinted.
    pub(super) colour: Option<Colour>,
}

impl Look {
    /// Of tufts: a stroke as thin as there are.
    pub(super) const TUFTS: Self = Self {
        kind: Kind::Line,
        width: 0,
        colour: None,
    };

    /// Of the areas of fractals.
    pub(super) const AREA: Self = Self {
        kind: Kind::Area,
        width: 0,
        colour: None,
    };
}

/// What a path holds.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Kind {
    /// Open lines.
    Line,
    /// Closed paths of lines, stroked and filled.
    Ring,
    /// Fractals that are closed chains, filled without a stroke.
    Area,
    /// Closed base elements.
    Polygon,
}

/// Elements in a row, each joined to the one before, that look alike.
#[derive(Clone, Copy)]
pub(super) struct Line {
    pub(super) look: Look,
    /// Whether the first one joins what comes before.
    pub(super) joined: bool,
    /// Whether the first one starts, and the last one ends, where its frame does.
    pub(super) meets_frame: [bool; 2],
}

/// What is to be drawn through the next points of a sketch.
#[derive(Clone, Copy)]
pub(super) enum Mark {
    /// A fractal begins.
    Begin,
    /// Elements of a class come.
    Class(u64),
    /// A line begins at a point.
    Line(Line),
    /// A polygon begins at a point.
    Polygon(Look),
    /// Polygons that look alike, by number, each of so many vertices.
    Polygons {
        look: Look,
        vertices: usize,
        count: usize,
    },
    /// The outline of a fractal begins or goes on at a point.
    Area,
    /// Straight lines to so many points.
    Lines(usize),
    /// A curve, by three points.
    Curve,
    /// So many tufts.
    Tufts(usize),
    /// So many stamps of what looks alike.
    Stamps { look: Look, count: usize },
    /// The polygon is closed; whether it has returned to its start.
    Close { returned: bool },
    /// An open element that is not drawn, by its end, and whether its frame ends there.
    Skip { meets_frame: bool },
    /// An element that nothing can be joined to, not drawn.
    Break,
    /// The fractal ends; as [`Visitor::end`].
    End(bool),
}

/// Marks, and the points, tufts and stamps that they are about.
#[derive(Default)]
pub(super) struct Sketch {
    pub(super) marks: Vec<Mark>,
    pub(super) points: Vec<Position>,
    pub(super) tufts: Vec<Tuft>,
    pub(super) stamps: Vec<Stamped>,
}

/// The vertices of a closed outline after the first, if it has no curves and ends where it starts.
fn vertices(pieces: &[Piece]) -> Option<impl Iterator<Item = DVec2>> {
    let is_line = |piece: &Piece| matches!(piece, Piece::Line(_));
    let (_, sides) = pieces.split_last()?;
    pieces
        .iter()
        .all(is_line)
        .then(|| sides.iter().map(Piece::end))
}

/// Whether an outline starts and ends where its frame does, in the order of traversal.
fn meets_frame(base_element: &BaseElement, reversed: bool) -> [bool; 2] {
    let [start, end] = base_element.ends_meet_frame();
    if reversed { [end, start] } else { [start, end] }
}

/// Whether no line leads to the end of an element that a pass does not paint.
pub(super) fn stands_alone(scene: &Scene<'_>) -> bool {
    let graph = scene.graph;
    let mut drawn = graph.objects().iter().filter(|object| object.visible);
    drawn.all(|object| {
        let base_element = &graph.base_elements()[object.base_element];
        base_element.is_closed() || base_element.ends_meet_frame() == [true; 2]
    })
}

/// Sketches what one walk over an approximant is for.
pub(super) struct Sketcher<'a> {
    scene: &'a Scene<'a>,
    pass: Pass,
    fractal: Fractal,
    pub(super) sketch: Sketch,
    /// What makes tufts, where the surface takes them.
    comb: Option<Arc<Comb>>,
    /// What need not be drawn, where that can be told,
    hidden: Option<Arc<Hidden>>,
    /// what many runs cover, drawn once,
    stamps: Option<Arc<Stamps>>,
    /// and the class that all of the span is of, if it is known.
    whole: Option<u64>,
    /// The class that the sketch has come to, where it holds all.
    class: Option<u64>,
    /// The mark of the line or area that the next element may go on with.
    open: Option<usize>,
    /// What the pass is to paint.
    aim: Arc<Aim>,
}

impl<'a> Sketcher<'a> {
    pub(super) fn new(
        scene: &'a Scene<'a>,
        pass: Pass,
        comb: Option<Arc<Comb>>,
        (hidden, stamps): (Option<Arc<Hidden>>, Option<Arc<Stamps>>),
        aim: Arc<Aim>,
    ) -> Self {
        Self {
            scene,
            pass,
            fractal: Fractal::default(),
            sketch: Sketch::default(),
            comb,
            hidden,
            stamps,
            whole: match pass {
                Pass::Class(class) => Some(class),
                Pass::Areas | Pass::Along => None,
            },
            class: None,
            open: None,
            aim,
        }
    }

    /// Begins the next sketch.
    pub(super) fn clear(&mut self) {
        self.sketch.marks.clear();
        self.sketch.points.clear();
        self.sketch.tufts.clear();
        self.sketch.stamps.clear();
        self.class = None;
        self.open = None;
        if self.pass == Pass::Along {
            self.whole = None;
        }
    }

    #[inline]
    fn position(&self, point: DVec2) -> Position {
        position(self.scene.canvas.pixel(point) * FINE)
    }

    /// Makes a mark that begins something new.
    fn mark(&mut self, mark: Mark) {
        self.open = None;
        self.sketch.marks.push(mark);
    }

    /// Makes a mark of an element that is not drawn. Only the last one in a row matters.
    fn pass_by(&mut self, mark: Mark) {
        if let Some(Mark::Skip { .. }) = self.sketch.marks.last() {
            self.sketch.points.pop();
        }
        if let Some(last @ (Mark::Skip { .. } | Mark::Break)) = self.sketch.marks.last_mut() {
            *last = mark;
        } else {
            self.mark(mark);
        }
    }

    /// What comes is of a class.
    fn come_to(&mut self, class: u64) {
        if self.class != Some(class) {
            self.class = Some(class);
            self.mark(Mark::Class(class));
        }
    }

    fn start_at(&mut self, start: DVec2) {
        let start = self.position(start);
        self.sketch.points.push(start);
    }

    #[inline]
    fn line_to(&mut self, end: DVec2) {
        let end = self.position(end);
        self.go_to(end);
    }

    #[inline]
    fn go_to(&mut self, end: Position) {
        self.sketch.points.push(end);
        if let Some(Mark::Lines(count)) = self.sketch.marks.last_mut() {
            *count += 1;
        } else {
            self.sketch.marks.push(Mark::Lines(1));
        }
    }

    #[inline]
    fn piece(&mut self, piece: &Piece) {
        match *piece {
            Piece::Line(end) => self.line_to(end),
            Piece::Cubic(a, b, end) => {
                self.sketch.marks.push(Mark::Curve);
                [a, b, end]
                    .into_iter()
                    .for_each(|point| self.start_at(point));
            }
        }
    }

    fn polygon(&mut self, element: &Element, base_element: &BaseElement) {
        let outlined = self.scene.style.outlines_polygons();
        let width = if outlined {
            self.width_class(element)
        } else {
            0
        };
        let look = Look {
            kind: Kind::Polygon,
            width,
            colour: self.colour(element, self.scene.style.polygons()),
        };
        let map = element.frame.map;
        // One orientation for all, so that what overlaps stays filled under the nonzero rule.
        let mirrored = map.matrix2.determinant() < 0.0;
        let backwards = (base_element.signed_area() < 0.0) != mirrored;
        let (start, pieces) = base_element.outline(backwards);
        if let Some(vertices) = vertices(pieces) {
            self.polygon_of(look, pieces.len());
            [start]
                .into_iter()
                .chain(vertices)
                .for_each(|vertex| self.start_at(map.transform_point2(vertex)));
            return;
        }
        self.mark(Mark::Polygon(look));
        self.start_at(map.transform_point2(start));
        for piece in pieces {
            self.piece(&piece.transformed(&map));
        }
        let returned = matches!(pieces.last(), Some(Piece::Line(_)));
        self.mark(Mark::Close { returned });
    }

    /// One more polygon of a number of vertices.
    #[inline]
    fn polygon_of(&mut self, look: Look, sides: usize) {
        match self.sketch.marks.last_mut() {
            Some(Mark::Polygons {
                look: last,
                vertices,
                count,
            }) if *last == look && *vertices == sides => *count += 1,
            _ => self.mark(Mark::Polygons {
                look,
                vertices: sides,
                count: 1,
            }),
        }
    }

    /// Goes on along the outline of a fractal that is filled, whether it is drawn there or not.
    fn area(&mut self, element: &Element, base_element: &BaseElement) {
        let map = element.frame.map;
        let (start, pieces) = base_element.outline(element.frame.direction.is_reversed());
        let start = map.transform_point2(start);
        if self.open.is_some() {
            self.line_to(start);
        } else {
            self.mark(Mark::Area);
            self.start_at(start);
            self.open = Some(self.sketch.marks.len() - 1);
        }
        for piece in pieces {
            self.piece(&piece.transformed(&map));
        }
    }

    fn line(&mut self, element: &Element, base_element: &BaseElement) {
        let reversed = element.frame.direction.is_reversed();
        let map = element.frame.map;
        let look = Look {
            kind: self.kind(),
            width: self.width_class(element),
            colour: self.colour(element, self.scene.style.lines()),
        };
        let [meets_start, meets_end] = meets_frame(base_element, reversed);
        let (start, pieces) = base_element.outline(reversed);
        let start = map.transform_point2(start);
        let open = self.open.map(|open| &mut self.sketch.marks[open]);
        match open {
            Some(Mark::Line(line)) if element.joined && line.look == look => {
                let shares = line.meets_frame[1] && meets_start;
                line.meets_frame[1] = meets_end;
                if !shares {
                    self.line_to(start);
                }
            }
            _ => {
                self.mark(Mark::Line(Line {
                    look,
                    joined: element.joined,
                    meets_frame: [meets_start, meets_end],
                }));
                self.open = Some(self.sketch.marks.len() - 1);
                self.start_at(start);
            }
        }
        for piece in pieces {
            self.piece(&piece.transformed(&map));
        }
    }

    /// Lines of one class that end in these points, one after another.
    fn lines(&mut self, run: &Run<'_>, ends: &[DVec2], first: &Element) {
        self.see(first);
        let map = self.scene.canvas.map(run.map());
        let rest = ends[1..].iter();
        let rest = rest.map(|&end| position(map.transform_point2(end) * FINE));
        self.sketch.points.extend(rest);
        if let Some(Mark::Lines(count)) = self.sketch.marks.last_mut() {
            *count += ends.len() - 1;
        }
    }

    /// Lines of one class that need not join.
    fn sticks(&mut self, run: &Run<'_>, sticks: &[Stick], first: &Element) {
        self.see(first);
        let rest = sticks[1..].iter().map(|stick| (stick, stick.joined));
        self.draw_sticks(run, rest);
    }

    /// Draws lines, and says of each whether it joins the one before.
    fn draw_sticks<'b>(&mut self, run: &Run<'_>, sticks: impl Iterator<Item = (&'b Stick, bool)>) {
        let map = self.scene.canvas.map(run.map());
        let fine = |point: DVec2| position(map.transform_point2(point) * FINE);
        let whole = self.octave(run.map().matrix2.x_axis.length());
        let kind = self.kind();
        for (stick, joined) in sticks {
            let look = Look {
                kind,
                width: whole.map_or(0, |whole| width_class(whole + stick.octave)),
                colour: None,
            };
            let goes_on = match self.open.map(|open| &self.sketch.marks[open]) {
                Some(Mark::Line(line)) => joined && line.look == look,
                _ => false,
            };
            if !goes_on {
                self.mark(Mark::Line(Line {
                    look,
                    joined,
                    meets_frame: [true; 2],
                }));
                self.open = Some(self.sketch.marks.len() - 1);
                self.sketch.points.push(fine(stick.ends[0]));
            }
            self.go_to(fine(stick.ends[1]));
        }
    }

    /// Some elements of a run, by number, from which lines lead to no others.
    fn some(&mut self, run: &Run<'_>, elements: impl Iterator<Item = (usize, Element)>) {
        let mut next = 0;
        for (number, element) in elements {
            if number != next {
                self.pass_by(Mark::Break);
            }
            next = number + 1;
            self.see(&element);
        }
        if next as u64 != run.count() {
            self.pass_by(Mark::Break);
        }
    }

    /// Lines of one class, short and thin ones as tufts; whether there are any.
    fn tufts(&mut self, run: &Run<'_>, sticks: &[Stick]) -> bool {
        let (Some(comb), Some(last)) = (&self.comb, sticks.last()) else {
            return false;
        };
        let map = self.scene.canvas.map(run.map());
        let (combed, longer) = comb.comb(sticks, map.matrix2.x_axis.length());
        if combed.is_bald() {
            return false;
        }
        let apart = combed.apart.iter().flat_map(|apart| {
            let lines = sticks[apart.clone()].iter().enumerate();
            lines.map(|(number, stick)| (stick, number > 0 && stick.joined))
        });
        self.draw_sticks(run, apart);
        let before = self.sketch.tufts.len();
        self.sketch.tufts.extend(combed.tufts(map, longer));
        self.mark(Mark::Tufts(self.sketch.tufts.len() - before));
        self.pass_by(Mark::Skip { meets_frame: true });
        let end = position(map.transform_point2(last.ends[1]) * FINE);
        self.sketch.points.push(end);
        true
    }

    /// What of a run is painted, by a stamp; whether there is one.
    fn stamp(&mut self, run: &Run<'_>, painted: Painted) -> bool {
        let stamps = self.stamps.as_ref();
        let Some(stamped) = stamps.and_then(|stamps| stamps.of(self.scene, run, painted)) else {
            return false;
        };
        let graph = self.scene.graph;
        let is_open = |element: &Element| {
            let object = &graph.objects()[element.object];
            object.visible && !graph.base_elements()[object.base_element].is_closed()
        };
        let end = run.last().filter(is_open);
        let kind = if end.is_some() {
            Kind::Line
        } else {
            Kind::Polygon
        };
        let look = Look {
            kind,
            ..Look::TUFTS
        };
        self.sketch.stamps.push(stamped);
        // What joins the run goes on where it ends; of other runs nobody needs to know.
        match (self.sketch.marks.last_mut(), end) {
            (Some(Mark::Stamps { look: last, count }), None) if *last == look => *count += 1,
            (_, end) => {
                self.mark(Mark::Stamps { look, count: 1 });
                if let Some(end) = end {
                    self.pass_by(Mark::Skip { meets_frame: true });
                    self.start_at(end.frame.ends()[1]);
                }
            }
        }
        true
    }

    fn width_class(&self, element: &Element) -> i32 {
        let Scene { graph, style, .. } = self.scene;
        if let (Width::Pixels(width), Some(_)) = (style.width, graph.widest()) {
            return width_class(libm::log2(width * element.coat.width() * FINE));
        }
        self.octave(element.frame.stretch() * element.coat.width())
            .map_or(0, width_class)
    }

    /// The logarithm to base 2 of the width that the stroke of an element of a length has, in
    /// hundredths of a pixel, if widths are relative.
    fn octave(&self, length: f64) -> Option<f64> {
        match self.scene.style.width {
            Width::Pixels(_) => None,
            Width::Relative(width) => Some(libm::log2(
                width * length * self.scene.graph.unit() * self.scene.canvas.scale() * FINE,
            )),
        }
    }

    /// The colour of an element that is tinted and has a colour of its own.
    #[inline]
    fn colour(&self, element: &Element, own: Colour) -> Option<Colour> {
        let Scene { graph, style, .. } = self.scene;
        let is_tinted = graph.tints() && style.color_by == ColorBy::Tint;
        is_tinted.then(|| element.coat.on(own))
    }

    /// Whether nothing that becomes of an element can be seen any more.
    #[inline]
    fn is_hidden(&self, subtree: &Subtree) -> bool {
        let (Some(hidden), Some(class)) = (&self.hidden, self.whole) else {
            return false;
        };
        hidden.hides(self.scene, subtree, class)
    }

    fn kind(&self) -> Kind {
        if self.scene.fills_strokes {
            Kind::Ring
        } else {
            Kind::Line
        }
    }

    #[inline]
    fn see(&mut self, element: &Element) {
        let Scene { graph, classes, .. } = self.scene;
        let object = &graph.objects()[element.object];
        let base_element = &graph.base_elements()[object.base_element];
        let is_closed = base_element.is_closed();
        let is_drawn = match self.pass {
            Pass::Areas if self.fractal.is_ring && !is_closed => {
                return self.area(element, base_element);
            }
            Pass::Areas => return self.pass_by(Mark::Break),
            Pass::Class(class) => {
                object.visible && classes.of(element, &self.fractal, graph) == class
            }
            Pass::Along => {
                if object.visible {
                    self.come_to(classes.of(element, &self.fractal, graph));
                }
                object.visible
            }
        };
        match (is_drawn, is_closed) {
            (true, true) => self.polygon(element, base_element),
            (true, false) => self.line(element, base_element),
            (false, false) if object.visible => {
                let reversed = element.frame.direction.is_reversed();
                let [_, meets_frame] = meets_frame(base_element, reversed);
                self.pass_by(Mark::Skip { meets_frame });
                let (start, pieces) = base_element.outline(reversed);
                let end = pieces.last().map_or(start, Piece::end);
                self.start_at(element.frame.map.transform_point2(end));
            }
            _ => self.pass_by(Mark::Break),
        }
    }
}

/// The width of a relative stroke in steps, from the logarithm of its width; not less than one
/// hundredth of a pixel.
#[expect(
    clippy::cast_possible_truncation,
    reason = "casts from floats saturate"
)]
pub(super) fn width_class(octave: f64) -> i32 {
    // Rounded, as it is not negative.
    (WIDTHS_AN_OCTAVE * octave.max(0.0) + 0.5) as i32
}

/// The width of a class in hundredths of a pixel: there are eight to an octave.
pub(super) fn class_width(class: i32) -> f64 {
    // exp2 of eighths, for there may be a path for every element.
    const EIGHTHS: [f64; 8] = [
        1.0,
        1.090_507_732_665_257_7,
        1.189_207_115_002_721,
        1.296_839_554_651_009_6,
        std::f64::consts::SQRT_2,
        1.542_210_825_407_940_7,
        1.681_792_830_507_429,
        1.834_008_086_409_342_4,
    ];
    libm::ldexp(EIGHTHS[class.rem_euclid(8) as usize], class.div_euclid(8))
}

impl Visitor for Sketcher<'_> {
    type Error = io::Error;

    fn takes_runs(&self) -> bool {
        !self.scene.sight.cuts()
    }

    fn longest_run(&self) -> u64 {
        self.stamps.as_ref().map_or(u64::MAX, |_| LONGEST_RUN)
    }

    fn cuts(&self) -> Option<f64> {
        self.scene.sight.shortest()
    }

    fn go_on(&mut self, fractal: Fractal) {
        self.fractal = fractal;
    }

    fn expect(&mut self, ranks: Range<u64>) {
        if self.pass == Pass::Along {
            self.whole = self.scene.classes.of_ranks(&ranks);
        }
    }

    fn begin(&mut self, fractal: Fractal) -> io::Result<()> {
        self.fractal = fractal;
        self.mark(Mark::Begin);
        Ok(())
    }

    #[inline]
    fn enter(&mut self, subtree: &Subtree) -> Enter {
        match self.scene.sight.enter(subtree) {
            Enter::Replace
                if !self.aim.may_paint(self.scene, subtree) || self.is_hidden(subtree) =>
            {
                Enter::Skip
            }
            enter => enter,
        }
    }

    #[inline]
    fn element(&mut self, element: &Element) -> io::Result<()> {
        self.see(element);
        Ok(())
    }

    fn run(&mut self, run: &Run<'_>) -> io::Result<()> {
        let Scene { graph, classes, .. } = self.scene;
        let share = match self.pass {
            Pass::Areas => Share::Some,
            Pass::Class(_) if self.aim.paints_all_of(run.object()) => Share::All,
            Pass::Class(class) => classes.share(run, &self.fractal, graph, class),
            Pass::Along => {
                let ends = [run.first(), run.last()].map(|element| {
                    element.map_or(0, |element| classes.of(&element, &self.fractal, graph))
                });
                if ends[0] == ends[1] {
                    self.come_to(ends[0]);
                    Share::All
                } else {
                    Share::Some
                }
            }
        };
        let one_width = matches!(self.scene.style.width, Width::Pixels(_));
        let line = run.line().filter(|_| one_width);
        match (share, line, run.sticks(), run.first(), run.last()) {
            // Of what is not painted only the end matters, where the next line may begin.
            (Share::None, _, _, _, Some(last)) => self.see(&last),
            (Share::All, ..) if self.stamp(run, Painted::All) => {}
            (Share::All, _, Some(sticks), ..) if self.tufts(run, sticks) => {}
            (Share::All, Some(ends), _, Some(first), _) => self.lines(run, ends, &first),
            (Share::All, _, Some(sticks), Some(first), _) => self.sticks(run, sticks, &first),
            _ => match (self.pass, self.aim.steps.clone()) {
                (_, Some(steps))
                    if self.stamp(run, Painted::Steps(*steps.start(), *steps.end())) => {}
                (_, Some(steps)) => self.some(run, run.born_in(steps)),
                (Pass::Class(class), None)
                    if self.aim.tells_objects() && self.stamp(run, Painted::Class(class)) => {}
                (Pass::Class(class), None) if self.aim.stands_alone => {
                    let fractal = self.fractal;
                    let is_of = |element: &Element| classes.of(element, &fractal, graph) == class;
                    self.some(run, run.chosen(is_of));
                }
                _ => run.elements().for_each(|element| self.see(&element)),
            },
        }
        Ok(())
    }

    fn end(&mut self, joined: bool) -> io::Result<()> {
        self.mark(Mark::End(joined));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::{WIDTHS_AN_OCTAVE, class_width, width_class};

    #[test]
    fn classes_of_widths_are_steps_of_octaves() {
        for class in 0..100 {
            let octave = f64::from(class) / WIDTHS_AN_OCTAVE;
            assert!((class_width(class) / libm::exp2(octave) - 1.0).abs() < 1e-15);
            for off in [-0.06, 0.06] {
                assert_eq!(width_class(octave + off), class);
            }
        }
        assert_eq!(width_class(-5.0), 0);
    }
}
