//! Tracing of paths onto a surface, without redundant vertices.

use std::io;

use crate::render::paint::{Paint, Position};
use crate::render::surface::Surface;

/// Traces paths onto a surface. Redundant vertices are left out; a subpath without length becomes a dot.
pub(crate) struct Tracer<'s, S: ?Sized> {
    surface: &'s mut S,
    pen: Position,
    start: Position,
    /// Vertex that is not drawn yet: the last vertex of a closed path is left out.
    held: Option<Position>,
    /// Whether the subpath has a vertex other than its start.
    has_length: bool,
    open: bool,
}

impl<'s, S: Surface + ?Sized> Tracer<'s, S> {
    pub(crate) fn new(surface: &'s mut S) -> Self {
        Self {
            surface,
            pen: [0, 0],
            start: [0, 0],
            held: None,
            has_length: false,
            open: false,
        }
    }

    /// Returns the surface.
    pub(crate) fn surface(&mut self) -> &mut S {
        self.surface
    }

    /// Begins a path.
    pub(crate) fn begin(&mut self, paint: &Paint) -> io::Result<()> {
        self.surface.begin(paint)
    }

    /// Begins a subpath.
    pub(crate) fn move_to(&mut self, to: Position) {
        self.finish();
        self.surface.move_to(to);
        (self.pen, self.start) = (to, to);
        self.has_length = false;
        self.open = true;
    }

    pub(crate) fn line_to(&mut self, to: Position) {
        if self.held != Some(to) {
            self.draw_held();
            self.held = Some(to);
        }
    }

    /// Draws straight lines to vertices, one after another, and removes redundant ones.
    pub(crate) fn lines_to(&mut self, vertices: &mut Vec<Position>) {
        self.draw_held();
        vertices.dedup();
        let stays = usize::from(vertices.first() == Some(&self.pen));
        self.held = vertices.pop();
        let drawn = vertices.get(stays..).unwrap_or_default();
        if let Some(&last) = drawn.last() {
            self.surface.lines_to(drawn);
            self.pen = last;
            self.has_length = true;
        }
    }

    /// Draws separate straight lines, by pairs of ends.
    pub(crate) fn segments(&mut self, ends: &[Position]) {
        self.finish();
        self.surface.segments(ends);
    }

    pub(crate) fn curve_to(&mut self, a: Position, b: Position, to: Position) {
        self.draw_held();
        if [a, b, to] == [self.pen; 3] {
            return;
        }
        self.surface.curve_to(a, b, to);
        self.pen = to;
        self.has_length = true;
    }

    /// Draws polygons of `sides` vertices each.
    pub(crate) fn polygons(&mut self, mut vertices: &[Position], sides: usize) -> io::Result<()> {
        self.finish();
        loop {
            let raster = self.surface.raster();
            let drawn = raster.map_or(0, |raster| raster.polygons(vertices, sides));
            vertices = &vertices[drawn * sides..];
            let Some((polygon, rest)) = vertices.split_at_checked(sides.max(1)) else {
                return self.surface.hand_on();
            };
            self.move_to(polygon[0]);
            polygon[1..].iter().for_each(|&vertex| self.line_to(vertex));
            self.close(false);
            self.surface.hand_on()?;
            vertices = rest;
        }
    }

    /// Closes the subpath. `returned` states that its last vertex equals its first, which is then not drawn
    /// twice.
    pub(crate) fn close(&mut self, returned: bool) {
        if returned || self.held == Some(self.start) {
            self.held = None;
        }
        self.draw_held();
        if self.has_length {
            self.surface.close();
        } else {
            self.surface.line_to(self.pen);
        }
        self.open = false;
    }

    /// Ends the subpath at its last vertex.
    fn finish(&mut self) {
        if !self.open {
            return;
        }
        self.draw_held();
        if !self.has_length {
            self.surface.line_to(self.pen);
        }
        self.open = false;
    }

    fn draw_held(&mut self) {
        let Some(to) = self.held.take() else { return };
        // A vertex that rounds to the one before is redundant.
        if to == self.pen {
            return;
        }
        self.surface.line_to(to);
        self.pen = to;
        self.has_length = true;
    }

    /// Hands on the drawn portion of the path, if it is large.
    pub(crate) fn hand_on(&mut self) -> io::Result<()> {
        self.surface.hand_on()
    }

    /// Ends the path.
    pub(crate) fn end(&mut self) -> io::Result<()> {
        self.finish();
        self.surface.end()
    }
}
