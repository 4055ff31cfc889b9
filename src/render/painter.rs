//! Painter: joins the sketches of a walk's spans to paths, in order.

use std::io;

use crate::grow::Seam;
use crate::style::Colour;

use super::display::{Replay, Step};
use super::paint::Position;
use super::paint_key::{PaintKey, PathKind};
use super::png::Raster;
use super::scene::{Pass, Scene};
use super::sketch::{LineMark, Mark, Sketch};
use super::surface::Surface;
use super::tracer::Tracer;

/// Number of vertices after which the surface may hand on the drawn portion of a path.
const MANY: usize = 256;

/// End of the preceding element.
#[derive(Clone, Copy)]
struct Previous {
    end: Position,
    /// Whether it is the end of the element's frame.
    meets_frame: bool,
    /// Whether it has been drawn.
    drawn: bool,
}

/// Paints a pass from the sketches of its spans.
pub(super) struct Painter<'a, 's, S> {
    scene: &'a Scene<'a>,
    /// Colour of the class, if colours depend on classes.
    colour: Option<Colour>,
    /// Current class, if one walk paints all classes.
    class: Option<u64>,
    tracer: Tracer<'s, S>,
    key: Option<PaintKey>,
    previous: Option<Previous>,
    /// For a ring that is unbroken so far, whether its first element starts where its frame does.
    ring: Option<bool>,
    is_first: bool,
    /// Scratch memory for the ends of successive lines.
    vertices: Vec<Position>,
}

impl<'a, 's, S: Surface> Painter<'a, 's, S> {
    pub(super) fn new(scene: &'a Scene<'a>, pass: Pass, surface: &'s mut S) -> Self {
        Self {
            scene,
            colour: match pass {
                Pass::Areas | Pass::Along => None,
                Pass::Class(class) => scene.classes.colour(class, scene.style),
            },
            class: None,
            tracer: Tracer::new(surface),
            key: None,
            previous: None,
            ring: None,
            is_first: true,
            vertices: Vec::new(),
        }
    }

    /// Ends the open path.
    pub(super) fn finish(mut self) -> io::Result<()> {
        self.end_path()
    }

    /// Paints the next span of the walk. Elements that are marked as joined to the preceding one are so only if
    /// they follow another one or `seam.joined` is set.
    pub(super) fn paint_span(&mut self, sketch: &Sketch, seam: Seam) -> io::Result<()> {
        let mut replay = sketch.replay();
        let mut joined = seam.joined;
        while let Some(step) = replay.next() {
            // A class is not an element yet.
            let is_class = matches!(step, Step::Other(Mark::Class(_)));
            match step {
                Step::Lines(ends) => self.lines(ends)?,
                Step::Segments(key, ends) => self.segments(key, ends)?,
                Step::Polygons(key, sides, vertices) => {
                    (self.previous, self.is_first) = (None, false);
                    self.begin_path(key)?;
                    self.tracer.polygons(vertices, sides)?;
                }
                Step::Batches(batches) => {
                    self.begin_path(PaintKey::of(PathKind::Line))?;
                    self.put(|raster| raster.batches(batches))?;
                }
                Step::Sprites(key, sprites) => {
                    self.begin_path(key)?;
                    self.put(|raster| raster.sprites(sprites))?;
                }
                Step::Other(mark) => self.mark(mark, joined, &mut replay)?,
            }
            joined |= !is_class;
        }
        Ok(())
    }

    /// Draws what takes no outline, regardless of the position of the pen.
    fn put(&mut self, draw: impl FnOnce(&mut dyn Raster)) -> io::Result<()> {
        if let Some(raster) = self.tracer.surface().raster() {
            draw(raster);
        }
        self.hand_on()
    }

    /// Paints a mark and the points that belong to it.
    fn mark(
        &mut self,
        mark: &Mark,
        joined: bool,
        points: &mut Replay<'_, Mark, PaintKey>,
    ) -> io::Result<()> {
        match *mark {
            Mark::Begin => {
                self.previous = None;
                self.ring = None;
                self.is_first = true;
                return Ok(());
            }
            Mark::End(joined) => return self.end(joined),
            Mark::Class(class) => return self.come_to(class),
            Mark::Curve => {
                let [a, b, end] = [(); 3].map(|()| points.point());
                self.tracer.curve_to(a, b, end);
                self.reach(end);
                return self.hand_on();
            }
            Mark::Close { returned } => {
                self.tracer.close(returned);
                return self.tracer.hand_on();
            }
            Mark::Line(line) => {
                let joined = joined && line.joined;
                self.line(&LineMark { joined, ..line }, points.point())?;
            }
            Mark::Area => {
                let start = points.point();
                self.begin_path(PaintKey::of(PathKind::Area))?;
                if self.is_first {
                    self.tracer.move_to(start);
                } else {
                    self.tracer.line_to(start);
                }
            }
            Mark::Polygon(key) => {
                self.previous = None;
                self.begin_path(key)?;
                self.tracer.move_to(points.point());
            }
            Mark::Skip { meets_frame } => {
                self.previous = Some(Previous {
                    end: points.point(),
                    meets_frame,
                    drawn: false,
                });
            }
            Mark::Break => self.previous = None,
        }
        self.is_first = false;
        Ok(())
    }

    /// Begins a class, unless it is the current one.
    fn come_to(&mut self, class: u64) -> io::Result<()> {
        if self.class == Some(class) {
            return Ok(());
        }
        self.end_path()?;
        self.class = Some(class);
        self.colour = self.scene.classes.colour(class, self.scene.style);
        Ok(())
    }

    /// Continues the open path if it has a matching paint key, or begins a new one.
    fn begin_path(&mut self, key: PaintKey) -> io::Result<()> {
        if self.key.is_some_and(|open| open.serves(key)) {
            return Ok(());
        }
        self.end_path()?;
        self.tracer.begin(&key.paint(self.scene, self.colour))?;
        self.key = Some(key);
        Ok(())
    }

    fn end_path(&mut self) -> io::Result<()> {
        if let Some(previous) = &mut self.previous {
            previous.drawn = false;
        }
        if self.key.take().is_some() {
            self.tracer.end()?;
        }
        Ok(())
    }

    /// Begins a line of elements, or continues one.
    fn line(&mut self, line: &LineMark, start: Position) -> io::Result<()> {
        self.begin_path(line.key)?;
        let [meets_start, meets_end] = line.meets_frame;
        let previous = self.previous.filter(|_| line.joined);
        let shares = previous.is_some_and(|previous| previous.meets_frame && meets_start);
        match previous {
            Some(Previous { drawn: true, .. }) if shares => {}
            Some(Previous { drawn: true, .. }) => self.tracer.line_to(start),
            Some(Previous { end, .. }) if !shares => {
                self.tracer.move_to(end);
                self.tracer.line_to(start);
            }
            _ => self.tracer.move_to(start),
        }
        if self.is_first {
            self.ring = line.joined.then_some(meets_start);
        } else if !previous.is_some_and(|previous| previous.drawn) {
            self.ring = None;
        }
        self.previous = Some(Previous {
            end: start,
            meets_frame: meets_end,
            drawn: true,
        });
        Ok(())
    }

    /// Draws lines that nothing joins.
    fn segments(&mut self, key: PaintKey, ends: &[Position]) -> io::Result<()> {
        (self.previous, self.ring, self.is_first) = (None, None, false);
        self.begin_path(key)?;
        for ends in ends.chunks(2 * MANY) {
            self.tracer.segments(ends);
            self.hand_on()?;
        }
        Ok(())
    }

    fn lines(&mut self, ends: &[Position]) -> io::Result<()> {
        for ends in ends.chunks(MANY) {
            self.vertices.clear();
            self.vertices.extend_from_slice(ends);
            self.tracer.lines_to(&mut self.vertices);
            self.hand_on()?;
        }
        if let Some(&end) = ends.last() {
            self.reach(end);
        }
        Ok(())
    }

    /// Permits the surface to hand on the drawn portion of the path; a polygon stays in one piece.
    fn hand_on(&mut self) -> io::Result<()> {
        if self.key.is_some_and(PaintKey::is_of_polygons) {
            return Ok(());
        }
        self.tracer.hand_on()
    }

    /// Records the end of the drawn line.
    fn reach(&mut self, end: Position) {
        if let Some(previous) = &mut self.previous {
            previous.end = end;
        }
    }

    fn end(&mut self, joined: bool) -> io::Result<()> {
        if self.key == Some(PaintKey::of(PathKind::Area)) {
            self.tracer.close(false);
        } else if let (true, Some(meets_start), Some(previous)) = (joined, self.ring, self.previous)
            && previous.drawn
        {
            self.tracer.close(meets_start && previous.meets_frame);
        }
        // Polygons of different fractals share a path; lines begin a new one.
        if self.key.is_some_and(|key| !key.is_of_polygons()) {
            self.end_path()?;
        }
        Ok(())
    }
}
