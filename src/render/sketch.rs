//! Sketches: the drawn contents of a span of a walk, in positions on the picture.
//!
//! A sketch is made by any thread, without knowledge of what was drawn before; the painter joins the sketches
//! of all spans, in order.

mod mark;
mod runs;
mod speck;
mod visit;

pub(super) use mark::{LineMark, Mark, Sketch};

use std::sync::Arc;

use crate::geometry::DVec2;
use crate::grow::{Element, FractalInfo};
use crate::rule::{BaseElement, Piece};
use crate::style::{ColorBy, Colour, Width};

use super::contribution::ContributionMask;
use super::display::Command;
use super::paint::{FINE, Position, position};
use super::paint_key::{PaintKey, PathKind, width_class};
use super::png::Means;
use super::scene::{Pass, Scene};

/// Returns the vertices of a closed outline after the first, if it has no curves. Its last line leads to its
/// start.
fn vertices(pieces: &[Piece]) -> Option<impl Iterator<Item = DVec2>> {
    let is_line = |piece: &Piece| matches!(piece, Piece::Line(_));
    let (_, sides) = pieces.split_last()?;
    pieces
        .iter()
        .all(is_line)
        .then(|| sides.iter().map(Piece::end))
}

/// Returns whether an outline starts and ends where its frame does, in the order of traversal.
fn meets_frame(base_element: &BaseElement, reversed: bool) -> [bool; 2] {
    let [start, end] = base_element.ends_meet_frame();
    if reversed { [end, start] } else { [start, end] }
}

/// Sketches the spans of a pass.
pub(super) struct Sketcher<'a> {
    scene: &'a Scene<'a>,
    pass: Pass,
    fractal: FractalInfo,
    pub(super) sketch: Sketch,
    mask: Arc<ContributionMask>,
    /// Whether closed base elements that are narrower than a pixel are stroked.
    broadens: bool,
    means: Means<'a>,
    /// Current class of the sketch, if it holds all classes.
    class: Option<u64>,
    /// Index of the mark of the line or area that the next element may continue.
    open: Option<usize>,
    /// Last width of a stroke, as a length if widths are relative, and its class.
    width: (f64, i32),
}

impl<'a> Sketcher<'a> {
    pub(super) fn new(
        scene: &'a Scene<'a>,
        pass: Pass,
        mask: Arc<ContributionMask>,
        broadens: bool,
        means: Means<'a>,
    ) -> Self {
        Self {
            scene,
            pass,
            fractal: FractalInfo::default(),
            sketch: Sketch::default(),
            mask,
            broadens,
            means,
            class: None,
            open: None,
            width: (f64::NAN, 0),
        }
    }

    /// Begins the next sketch.
    pub(super) fn clear(&mut self) {
        self.sketch.clear();
        self.class = None;
        self.open = None;
    }

    #[inline]
    fn position(&self, point: DVec2) -> Position {
        position(self.scene.canvas.pixel(point) * FINE)
    }

    /// Adds a mark that continues nothing.
    fn mark(&mut self, mark: Mark) {
        self.open = None;
        self.sketch.push(mark);
    }

    /// Adds a mark of an element that is not drawn. Only the last of successive ones matters.
    fn pass_by(&mut self, mark: Mark) {
        let last = self.sketch.commands.last();
        if let Some(Command::Other(Mark::Skip { .. })) = last {
            self.sketch.points.pop();
        }
        if let Some(Command::Other(Mark::Skip { .. } | Mark::Break)) = last {
            self.sketch.commands.pop();
        }
        self.mark(mark);
    }

    /// Declares the class of the following elements.
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
        self.sketch.lines([end]);
    }

    #[inline]
    fn piece(&mut self, piece: &Piece) {
        match *piece {
            Piece::Line(end) => self.line_to(end),
            Piece::Cubic(a, b, end) => {
                self.sketch.push(Mark::Curve);
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
        let map = *element.frame.map();
        let narrow = self.broadens.then(|| {
            let map = self.scene.canvas.map(&map);
            speck::width(base_element, &map)
        });
        let (kind, width) = match narrow.flatten() {
            Some(width) => (PathKind::Speck, width),
            None => (PathKind::Polygon, width),
        };
        let key = PaintKey {
            kind,
            width,
            colour: self.colour(element, self.scene.style.polygons()),
        };
        // All polygons have one orientation, so that overlaps stay filled under the nonzero rule.
        let mirrored = map.matrix2.determinant() < 0.0;
        if let Some(corners) = self.corners(element) {
            let map = self.scene.canvas.map(&map);
            let place = |corner: &DVec2| position(map.transform_point2(*corner) * FINE);
            let points = self.vertices(key, corners.len());
            if mirrored {
                points.extend(corners.iter().rev().map(place));
            } else {
                points.extend(corners.iter().map(place));
            }
            return;
        }
        let backwards = (base_element.signed_area() < 0.0) != mirrored;
        let (start, pieces) = base_element.outline(backwards);
        if let Some(vertices) = vertices(pieces) {
            let canvas = self.scene.canvas;
            let place = |vertex| position(canvas.pixel(map.transform_point2(vertex)) * FINE);
            let vertices = [start].into_iter().chain(vertices).map(place);
            self.vertices(key, pieces.len()).extend(vertices);
            return;
        }
        self.mark(Mark::Polygon(key));
        self.start_at(map.transform_point2(start));
        for piece in pieces {
            self.piece(&piece.transformed(&map));
        }
        let returned = matches!(pieces.last(), Some(Piece::Line(_)));
        self.mark(Mark::Close { returned });
    }

    /// Adds a polygon of `sides` vertices, which the caller adds.
    #[inline]
    fn vertices(&mut self, key: PaintKey, sides: usize) -> &mut Vec<Position> {
        self.open = None;
        self.sketch.polygon(key, sides)
    }

    /// Returns the corners of the simplified outline of an element, in its unit frame, if it is simplified.
    fn corners(&self, element: &Element) -> Option<&'a [DVec2]> {
        let Scene { graph, canvas, .. } = self.scene;
        let object = &graph.objects()[element.object];
        let pixels = element.frame.stretch() * canvas.scale();
        self.means
            .outlines?
            .corners(graph, object.base_element, pixels)
    }

    /// Continues the outline of a filled fractal, whether it is visible there or not.
    fn area(&mut self, element: &Element, base_element: &BaseElement) {
        let map = *element.frame.map();
        let (start, pieces) = base_element.outline(element.frame.direction().is_reversed());
        let start = map.transform_point2(start);
        if self.open.is_some() {
            self.line_to(start);
        } else {
            self.mark(Mark::Area);
            self.start_at(start);
            self.open = Some(self.sketch.commands.len() - 1);
        }
        for piece in pieces {
            self.piece(&piece.transformed(&map));
        }
    }

    fn line(&mut self, element: &Element, base_element: &BaseElement) {
        let reversed = element.frame.direction().is_reversed();
        let map = *element.frame.map();
        let key = PaintKey {
            kind: self.kind(),
            width: self.width_class(element),
            colour: self.colour(element, self.scene.style.lines()),
        };
        let [meets_start, meets_end] = meets_frame(base_element, reversed);
        let (start, pieces) = base_element.outline(reversed);
        let start = self.position(map.transform_point2(start));
        let open = self.open.map(|open| &mut self.sketch.commands[open]);
        match open {
            Some(Command::Other(Mark::Line(line))) if element.joined && line.key == key => {
                let shares = line.meets_frame[1] && meets_start;
                line.meets_frame[1] = meets_end;
                if !shares {
                    self.go_to(start);
                }
            }
            _ => {
                self.mark(Mark::Line(LineMark {
                    key,
                    joined: element.joined,
                    meets_frame: [meets_start, meets_end],
                }));
                self.open = Some(self.sketch.commands.len() - 1);
                self.sketch.points.push(start);
            }
        }
        // The area of a ring depends on its curves, which are therefore not simplified.
        let corners = self.corners(element).filter(|_| key.kind == PathKind::Line);
        if let Some([first, between @ .., last]) = corners {
            let map = self.scene.canvas.map(&map);
            let mut go_to = |corner: &DVec2| {
                self.go_to(position(map.transform_point2(*corner) * FINE));
            };
            if reversed {
                between.iter().rev().chain([first]).for_each(&mut go_to);
            } else {
                between.iter().chain([last]).for_each(&mut go_to);
            }
            return;
        }
        for piece in pieces {
            self.piece(&piece.transformed(&map));
        }
    }

    fn width_class(&mut self, element: &Element) -> i32 {
        let Scene { graph, style, .. } = self.scene;
        let width = match style.width {
            Width::Pixels(_) if graph.widest().is_none() => return 0,
            Width::Pixels(width) => width * element.appearance.width(),
            Width::Relative(_) => element.frame.stretch() * element.appearance.width(),
        };
        if width != self.width.0 {
            let octave = match style.width {
                Width::Pixels(_) => libm::log2(width * FINE),
                Width::Relative(_) => self.octave(width).unwrap_or(0.0),
            };
            self.width = (width, width_class(octave));
        }
        self.width.1
    }

    /// Returns the logarithm to base 2 of the stroke width of an element of a given length, in hundredths of
    /// a pixel, if widths are relative.
    fn octave(&self, length: f64) -> Option<f64> {
        match self.scene.style.width {
            Width::Pixels(_) => None,
            Width::Relative(width) => Some(libm::log2(
                width * length * self.scene.graph.unit() * self.scene.canvas.scale() * FINE,
            )),
        }
    }

    /// Returns the colour of an element that has one of its own, by its frame or by a tint on the colour `own`.
    #[inline]
    fn colour(&self, element: &Element, own: Colour) -> Option<Colour> {
        let Scene { graph, style, .. } = self.scene;
        if let Some(frames) = &self.scene.frames {
            return Some(frames.at(element, graph));
        }
        let is_tinted = graph.tints() && style.color_by == ColorBy::Tint;
        is_tinted.then(|| element.appearance.on(own))
    }

    fn kind(&self) -> PathKind {
        if self.scene.fills_strokes {
            PathKind::Ring
        } else {
            PathKind::Line
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
                let reversed = element.frame.direction().is_reversed();
                let [_, meets_frame] = meets_frame(base_element, reversed);
                self.pass_by(Mark::Skip { meets_frame });
                let (start, pieces) = base_element.outline(reversed);
                let end = pieces.last().map_or(start, Piece::end);
                self.start_at(element.frame.apply(end));
            }
            _ => self.pass_by(Mark::Break),
        }
    }
}
