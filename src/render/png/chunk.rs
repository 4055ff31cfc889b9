//! A stretch of what is drawn as coverage: made in order, covered by any thread.

use crate::parallel::is_cut_short;
use crate::render::surface::{Position, Stamped, Tuft};

use super::coverage::Plane;
use super::nib::Nib;
use super::part::Layers;

/// Chunks have about this many commands or positions.
const MANY: usize = 1 << 14;

enum Command {
    /// Lines that come next are drawn with a nib.
    Nib(Nib),
    /// A subpath begins at a position.
    Start,
    /// A subpath goes on at a position.
    GoOn,
    /// Lines to so many positions, one after another.
    Lines(usize),
    /// Polygons of so many vertices each, by number, and whether they are parts of strokes.
    Polygons {
        vertices: usize,
        count: usize,
        of_strokes: bool,
    },
    /// So many tufts.
    Tufts(usize),
    /// So many stamps.
    Stamps(usize),
}

/// Commands, and what they are about.
#[derive(Default)]
pub(super) struct Chunk {
    /// Where it is drawn, once it may be.
    planes: Layers,
    commands: Vec<Command>,
    points: Vec<Position>,
    tufts: Vec<Tuft>,
    stamps: Vec<Stamped>,
}

impl Chunk {
    pub(super) fn is_empty(&self) -> bool {
        self.commands.is_empty()
    }

    pub(super) fn is_full(&self) -> bool {
        let most = self.commands.len().max(self.points.len());
        let apart = self.tufts.len().max(self.stamps.len());
        most.max(apart) >= MANY || is_cut_short()
    }

    #[inline]
    pub(super) fn nib(&mut self, nib: Nib) {
        self.commands.push(Command::Nib(nib));
    }

    #[inline]
    pub(super) fn start(&mut self, at: Position) {
        self.commands.push(Command::Start);
        self.points.push(at);
    }

    #[inline]
    pub(super) fn lines(&mut self, to: impl IntoIterator<Item = Position>) {
        let before = self.points.len();
        self.points.extend(to);
        let count = self.points.len() - before;
        if let Some(Command::Lines(lines)) = self.commands.last_mut() {
            *lines += count;
        } else {
            self.commands.push(Command::Lines(count));
        }
    }

    /// Adds a polygon that [`Plane::polygon`] covers, of a path or of a stroke.
    pub(super) fn polygon(&mut self, vertices: &[Position], of_stroke: bool) {
        self.points.extend_from_slice(vertices);
        let sides = vertices.len();
        match self.commands.last_mut() {
            Some(Command::Polygons {
                vertices,
                count,
                of_strokes,
            }) if *vertices == sides && *of_strokes == of_stroke => *count += 1,
            _ => self.commands.push(Command::Polygons {
                vertices: sides,
                count: 1,
                of_strokes: of_stroke,
            }),
        }
    }

    pub(super) fn tufts(&mut self, tufts: &[Tuft]) {
        self.tufts.extend_from_slice(tufts);
        self.commands.push(Command::Tufts(tufts.len()));
    }

    pub(super) fn stamps(&mut self, stamps: &[Stamped]) {
        self.stamps.extend_from_slice(stamps);
        self.commands.push(Command::Stamps(stamps.len()));
    }

    /// Lets `next` go on with a nib from a position.
    pub(super) fn lead_to(&mut self, next: &mut Self, nib: Nib, at: Position) {
        next.nib(nib);
        if let Some(Command::Start) = self.commands.last() {
            self.commands.pop();
            self.points.pop();
            next.start(at);
        } else {
            next.commands.push(Command::GoOn);
            next.points.push(at);
        }
    }

    /// Says where it is to be drawn: lines, and polygons of strokes, on the second planes if there are such.
    pub(super) fn assign(&mut self, planes: Layers) {
        self.planes = planes;
    }

    /// Covers what it covers, and empties it.
    pub(super) fn cover(&mut self) {
        match std::mem::take(&mut self.planes) {
            [Some(planes), None] => planes.with_one(|plane| self.cover_on(plane, None)),
            [Some(planes), Some(strokes)] => planes.with_one(|plane| {
                strokes.with_one(|strokes| self.cover_on(plane, Some(strokes)));
            }),
            [None, _] => {}
        }
        self.commands.clear();
        self.points.clear();
        self.tufts.clear();
        self.stamps.clear();
    }

    fn cover_on(&self, plane: &mut Plane, mut strokes: Option<&mut Plane>) {
        let (mut points, mut tufts) = (self.points.as_slice(), self.tufts.as_slice());
        let mut stamps = self.stamps.as_slice();
        let mut next = |count: usize| {
            let (next, rest) = points.split_at(count.min(points.len()));
            points = rest;
            next
        };
        let (mut nib, mut at) = (None, [0; 2]);
        for command in &self.commands {
            let over = strokes.as_deref_mut();
            match command {
                Command::Nib(next) => nib = Some(next.clone()),
                Command::Start => {
                    at = next(1).first().copied().unwrap_or(at);
                    if let Some(nib) = &mut nib {
                        nib.start(over.unwrap_or(&mut *plane), at);
                    }
                }
                Command::GoOn => {
                    at = next(1).first().copied().unwrap_or(at);
                    if let Some(nib) = &nib {
                        nib.go_on(over.unwrap_or(&mut *plane), at);
                    }
                }
                Command::Lines(count) => {
                    let lines = next(*count);
                    if let Some(nib) = &mut nib {
                        nib.lines(over.unwrap_or(&mut *plane), at, lines);
                    }
                    at = lines.last().copied().unwrap_or(at);
                }
                Command::Polygons {
                    vertices,
                    count,
                    of_strokes,
                } => {
                    let over = over.filter(|_| *of_strokes);
                    let plane = over.unwrap_or(&mut *plane);
                    for polygon in next(vertices * count).chunks_exact(*vertices) {
                        if *of_strokes {
                            plane.polygon(polygon);
                        } else {
                            plane.shape(polygon);
                        }
                    }
                }
                Command::Tufts(count) => {
                    let (now, rest) = tufts.split_at(*count);
                    now.iter().for_each(|tuft| {
                        plane.tuft(tuft.middle, tuft.extent, tuft.area, tuft.width)
                    });
                    tufts = rest;
                }
                Command::Stamps(count) => {
                    let (now, rest) = stamps.split_at(*count);
                    now.iter()
                        .for_each(|Stamped { stamp, pixel }| plane.stamp(stamp, *pixel));
                    stamps = rest;
                }
            }
        }
    }
}
