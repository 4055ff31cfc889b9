//! Painter: joins the sketches of a walk's spans to paths, in order.

use std::collections::BTreeSet;
use std::io;

use crate::grow::Seam;
use crate::style::{Cap, Colour, Join, Width};

use super::ShortCut;
use super::batch::BatchBuilder;
use super::contribution::ContributionMask;
use super::level_of_detail::LevelOfDetail;
use super::pen;
use super::scene::{Pass, Scene};
use super::sketch::{Kind, Line, Mark, PaintKey, SPECK_WIDTHS, Sketch, class_width};
use super::sprites::Sprites;
use super::surface::{FINE, Paint, Pen, Position, SpritePaint, Stroke, Surface};
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
    look: Option<PaintKey>,
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
            look: None,
            previous: None,
            ring: None,
            is_first: true,
            vertices: Vec::new(),
        }
    }

    /// Returns the simplified outlines, if the surface permits them.
    pub(super) fn coarse(&self) -> Option<&'a LevelOfDetail> {
        let is_taken = self.scene.short_cuts.has(ShortCut::LevelOfDetail);
        let grain = self.tracer.grain().filter(|_| is_taken)?;
        let coarse = || LevelOfDetail::of(self.scene.graph, grain);
        self.scene.coarse.get_or_init(coarse).as_ref()
    }

    /// Returns whether closed base elements that are narrower than a pixel are stroked.
    pub(super) fn broadens(&self) -> bool {
        let paint = self.paint(PaintKey {
            kind: Kind::Polygon,
            ..PaintKey::TUFTS
        });
        paint.stroke.is_none() && self.tracer.broadens(&paint)
    }

    /// Creates the comb that makes tufts, if the surface permits them.
    pub(super) fn comb(&self) -> Option<BatchBuilder> {
        let Width::Relative(width) = self.scene.style.width else {
            return None;
        };
        let stroke = self.paint(PaintKey::TUFTS).stroke?;
        let below = self.tracer.tufts_below(&stroke);
        let is_taken = self.scene.short_cuts.has(ShortCut::SegmentBatches);
        (is_taken && below > 0.0).then(|| BatchBuilder::new(width, stroke.pen, below))
    }

    /// Creates the sprites of a pass, if every class is painted in one opaque colour, or in two of which that of
    /// strokes lies on top.
    pub(super) fn sprites(&mut self, pass: Pass, aim: &ContributionMask) -> Option<Sprites<'a>> {
        if !Sprites::may_be(self.scene, pass) {
            return None;
        }
        let Scene { classes, style, .. } = self.scene;
        let kinds = self.kinds();
        // Areas lie below the strokes of their own path only.
        let is_one_path = kinds.len() == 1 && pass != Pass::Along && self.scene.has_one_width();
        let most = if is_one_path { 2 } else { 1 };
        let all = match pass {
            Pass::Along => classes.all(),
            Pass::Areas | Pass::Class(_) => 0..1,
        };
        let mut stencil: Option<SpritePaint> = None;
        for class in all.rev() {
            if pass == Pass::Along {
                self.colour = classes.colour(class, style);
            }
            let mut inks = BTreeSet::new();
            for &kind in &kinds {
                let paint = self.paint(PaintKey {
                    kind,
                    ..PaintKey::TUFTS
                });
                let own = self.tracer.stencil(&paint)?;
                stencil = Some(match stencil {
                    None => own,
                    Some(all) => SpritePaint {
                        pen: all.pen.or(own.pen),
                        outlines: all.outlines || own.outlines,
                    },
                });
                let stroke = paint.stroke.map(|stroke| stroke.colour);
                inks.extend([paint.fill, stroke].into_iter().flatten().map(Colour::rgba));
            }
            if inks.len() > most {
                return None;
            }
        }
        Sprites::new(self.scene, stencil?, aim.painted(self.scene, pass))
    }

    /// Returns the kinds of the paths that are drawn.
    fn kinds(&self) -> Vec<Kind> {
        let graph = self.scene.graph;
        let drawn = graph.objects().iter().filter(|object| object.visible);
        let is_closed = |base_element: usize| graph.base_elements()[base_element].is_closed();
        let closed: BTreeSet<bool> = drawn.map(|object| is_closed(object.base_element)).collect();
        let kind = |is_closed| if is_closed { Kind::Polygon } else { Kind::Line };
        closed.into_iter().map(kind).collect()
    }

    /// Ends the open path.
    pub(super) fn finish(mut self) -> io::Result<()> {
        self.end_path()
    }

    /// Paints the next span of the walk.
    pub(super) fn paint_span(&mut self, sketch: &Sketch, seam: Seam) -> io::Result<()> {
        let mut points = sketch.points.as_slice();
        let mut tufts = sketch.tufts.as_slice();
        let mut sprites = sketch.sprites.as_slice();
        let mut joined = seam.joined;
        for mark in &sketch.marks {
            if let Mark::Tufts(count) = *mark {
                let (now, rest) = tufts.split_at(count);
                tufts = rest;
                self.begin_path(PaintKey::TUFTS)?;
                self.tracer.tufts(now);
            }
            if let Mark::Sprites { look, count } = *mark {
                let (now, rest) = sprites.split_at(count);
                sprites = rest;
                self.begin_path(look)?;
                self.tracer.sprites(now);
            }
            self.mark(mark, joined, &mut points)?;
            // A class is not an element yet.
            joined |= !matches!(mark, Mark::Class(_));
        }
        Ok(())
    }

    /// Paints a mark and the points that belong to it. Elements that are marked as joined to the preceding
    /// one are so only if `joined` is set.
    fn mark(&mut self, mark: &Mark, joined: bool, points: &mut &[Position]) -> io::Result<()> {
        let mut next = || {
            let (first, rest) = points.split_first().unwrap_or((&[0; 2], &[]));
            *points = rest;
            *first
        };
        match *mark {
            Mark::Begin => {
                self.previous = None;
                self.ring = None;
                self.is_first = true;
                return Ok(());
            }
            Mark::End(joined) => return self.end(joined),
            Mark::Class(class) => return self.come_to(class),
            Mark::Lines(count) => {
                let (lines, rest) = points.split_at(count.min(points.len()));
                *points = rest;
                return self.lines(lines);
            }
            Mark::Polygons {
                look,
                vertices,
                count,
            } => {
                let (now, rest) = points.split_at((vertices * count).min(points.len()));
                *points = rest;
                self.previous = None;
                self.is_first = false;
                self.begin_path(look)?;
                return self.tracer.polygons(now, vertices);
            }
            Mark::Curve => {
                let (a, b, end) = (next(), next(), next());
                self.tracer.curve_to(a, b, end);
                self.reach(end);
                return self.hand_on();
            }
            Mark::Tufts(_) | Mark::Sprites { .. } => return self.hand_on(),
            Mark::Close { returned } => {
                self.tracer.close(returned);
                return self.tracer.hand_on();
            }
            Mark::Line(line) => {
                let joined = joined && line.joined;
                self.line(&Line { joined, ..line }, next())?;
            }
            Mark::Area => {
                let start = next();
                self.begin_path(PaintKey::AREA)?;
                if self.is_first {
                    self.tracer.move_to(start);
                } else {
                    self.tracer.line_to(start);
                }
            }
            Mark::Polygon(look) => {
                let start = next();
                self.previous = None;
                self.begin_path(look)?;
                self.tracer.move_to(start);
            }
            Mark::Skip { meets_frame } => {
                self.previous = Some(Previous {
                    end: next(),
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
    fn begin_path(&mut self, look: PaintKey) -> io::Result<()> {
        if self.look.is_some_and(|open| open.serves(look)) {
            return Ok(());
        }
        self.end_path()?;
        let paint = self.paint(look);
        self.tracer.begin(&paint)?;
        self.look = Some(look);
        Ok(())
    }

    fn paint(&self, look: PaintKey) -> Paint {
        let style = self.scene.style;
        let own = look.colour.or(self.colour);
        let colour = own.unwrap_or(style.lines());
        let mut pen = pen(style);
        let differ =
            matches!(style.width, Width::Relative(_)) || self.scene.graph.widest().is_some();
        if differ {
            pen.width = class_width(look.width) / FINE;
        }
        let stroke = |colour| Some(Stroke { colour, pen });
        let (fill, stroke) = match look.kind {
            Kind::Line => (None, stroke(colour)),
            Kind::Ring => (style.fill, stroke(colour)),
            Kind::Area => (style.fill, None),
            Kind::Speck => {
                let colour = own.unwrap_or(style.polygons());
                let pen = Pen {
                    width: f64::from(look.width) / SPECK_WIDTHS,
                    cap: Cap::Round,
                    join: Join::Round,
                    dash: 0.0,
                };
                (Some(colour), Some(Stroke { colour, pen }))
            }
            Kind::Polygon => (
                Some(own.unwrap_or(style.polygons())),
                style
                    .stroke
                    .filter(|_| style.outlines_polygons())
                    .and_then(stroke),
            ),
        };
        Paint {
            fill,
            stroke,
            has_holes: false,
        }
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

    /// Begins a line of elements, or continues one.
    fn line(&mut self, line: &Line, start: Position) -> io::Result<()> {
        self.begin_path(line.look)?;
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
        if self.look.is_some_and(PaintKey::is_of_polygons) {
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
        if self.look == Some(PaintKey::AREA) {
            self.tracer.close(false);
        } else if let (true, Some(meets_start), Some(previous)) = (joined, self.ring, self.previous)
            && previous.drawn
        {
            self.tracer.close(meets_start && previous.meets_frame);
        }
        // Polygons of different fractals share a path; lines begin a new one.
        if self.look.is_some_and(|look| !look.is_of_polygons()) {
            self.end_path()?;
        }
        Ok(())
    }
}
