//! Collection of a drawing as strokes and areas.

use std::io;

use crate::render::options::Options;
use crate::render::paint::{Paint, Position};
use crate::render::surface::Surface;
use crate::style::Colour;

use super::areas::{AreaPaint, Areas, Turn};
use super::clip::{ClipWindow, flattened};
use super::points::Points;
use super::strokes::Strokes;

/// Surface that collects a drawing as strokes.
pub(super) struct Plotter {
    window: ClipWindow,
    outer: Vec<ClipWindow>,
    pub(super) points: Points,
    /// Strokes of each colour.
    pub(super) layers: Vec<(Colour, Strokes)>,
    /// Layer of the current path.
    layer: usize,
    /// Current point of the path and start of its subpath, in the picture.
    at: Position,
    start: Position,
    /// Position of the pen while it is down.
    pen: Option<Position>,
    is_full: bool,
    pub(super) fills: Fills,
}

/// Filled areas of a plot that is being collected.
pub(super) struct Fills {
    /// Whether opaque areas hide what lies under them.
    hide: bool,
    /// Whether areas are hatched, unless they have the colour of the paper.
    hatched: bool,
    paper: Colour,
    pub(super) areas: Areas,
    /// Paint of the current path, if it is filled with an effect on the plot.
    paint: Option<AreaPaint>,
    /// Whether all subpaths of the path are one area; otherwise each is an area by itself.
    is_one: bool,
    /// Vertices of the current subpath.
    contour: Vec<Position>,
    /// Number of strokes of the current layer that have a turn.
    counted: usize,
}

impl Fills {
    pub(super) fn new(options: &Options, background: Option<Colour>) -> Self {
        Self {
            hide: options.occlude,
            hatched: options.hatch.is_some(),
            paper: background.map_or(Colour::WHITE, Colour::opaque),
            areas: Areas::default(),
            paint: None,
            is_one: false,
            contour: Vec::new(),
            counted: 0,
        }
    }
}

impl Plotter {
    pub(super) fn new(size: [u32; 2], fills: Fills) -> Self {
        Self {
            window: ClipWindow::of(size),
            outer: Vec::new(),
            points: Points::default(),
            layers: Vec::new(),
            layer: 0,
            at: [0; 2],
            start: [0; 2],
            pen: None,
            is_full: false,
            fills,
        }
    }

    /// Returns the layer of a colour.
    fn layer_of(&mut self, colour: Colour) -> usize {
        let known = self.layers.iter().position(|layer| layer.0 == colour);
        known.unwrap_or_else(|| {
            self.layers.push((colour, Strokes::default()));
            self.layers.len() - 1
        })
    }

    /// Adds a vertex to the outline of an area.
    fn bound(&mut self, vertex: Position) {
        if self.fills.paint.is_some() {
            self.fills.contour.push(vertex);
        }
    }

    fn draw_to(&mut self, to: Position) {
        let from = std::mem::replace(&mut self.at, to);
        let Some([from, to]) = self.window.clip([from, to]) else {
            return;
        };
        let Some((_, strokes)) = self.layers.get_mut(self.layer) else {
            return;
        };
        if self.pen != Some(from) {
            match self.points.at(from) {
                Some(point) => strokes.begin(point),
                None => self.is_full = true,
            }
        }
        match self.points.at(to) {
            Some(point) => strokes.go_on(point),
            None => self.is_full = true,
        }
        self.pen = Some(to);
    }

    /// Ends the subpath.
    fn lift(&mut self) {
        self.pen = None;
        if let Some((_, strokes)) = self.layers.get_mut(self.layer) {
            strokes.end();
        }
        if self.fills.paint.is_some() {
            let contour = std::mem::take(&mut self.fills.contour);
            self.fills.areas.add(&contour, self.window.corners());
            if !self.fills.is_one {
                self.take_turn();
            }
        }
    }

    /// Adds the area and the strokes since the last turn to the order.
    fn take_turn(&mut self) {
        let fills = &mut self.fills;
        let strokes = self.layers.get(self.layer).map_or(0, |it| it.1.len());
        let area = fills.paint.and_then(|paint| fills.areas.finish(paint));
        fills.areas.follow(Turn {
            layer: self.layer,
            strokes: strokes - fills.counted,
            area,
        });
        fills.counted = strokes;
    }
}

impl Surface for Plotter {
    fn begin(&mut self, paint: &Paint) -> io::Result<()> {
        let fill = paint.fill.filter(|fill| fill.rgba()[3] > 0);
        let is_hatched = |fill: &Colour| self.fills.hatched && fill.opaque() != self.fills.paper;
        let hatched = fill.filter(is_hatched);
        let hatched = hatched.map(|fill| self.layer_of(fill.opaque()));
        let stroke = paint.stroke.map(|stroke| stroke.colour);
        let colour = stroke.or(paint.fill).unwrap_or(Colour::BLACK).opaque();
        self.layer = self.layer_of(colour);
        let fills = &mut self.fills;
        fills.counted = self.layers[self.layer].1.len();
        fills.is_one = paint.has_holes;
        let hides = fills.hide && fill.is_some_and(|fill| fill == fill.opaque());
        fills.paint = (hides || hatched.is_some()).then_some(AreaPaint { hides, hatched });
        Ok(())
    }

    fn move_to(&mut self, to: Position) {
        self.lift();
        self.at = self.window.place(to);
        self.start = self.at;
        self.bound(self.at);
    }

    fn line_to(&mut self, to: Position) {
        let to = self.window.place(to);
        self.bound(to);
        self.draw_to(to);
    }

    fn curve_to(&mut self, a: Position, b: Position, to: Position) {
        let [a, b, to] = [a, b, to].map(|position| self.window.place(position));
        for vertex in flattened([self.at, a, b, to]) {
            self.bound(vertex);
            self.draw_to(vertex);
        }
    }

    fn close(&mut self) {
        self.draw_to(self.start);
        self.lift();
    }

    fn hand_on(&mut self) -> io::Result<()> {
        if self.is_full {
            return Err(too_many_points());
        }
        Ok(())
    }

    fn end(&mut self) -> io::Result<()> {
        self.lift();
        self.take_turn();
        self.fills.paint = None;
        self.hand_on()
    }

    fn enter(&mut self, corner: [u32; 2], size: [u32; 2]) -> io::Result<bool> {
        let part = self.window.part(corner, size);
        self.outer.push(std::mem::replace(&mut self.window, part));
        Ok(true)
    }

    fn leave(&mut self) -> io::Result<()> {
        self.window = self.outer.pop().unwrap_or(self.window);
        Ok(())
    }
}

/// Returns the error of a plot with too many points, or with points too far away.
pub(super) fn too_many_points() -> io::Error {
    io::Error::other("a plot has room for 2^32 points")
}
