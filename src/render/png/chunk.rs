//! Chunks of shapes that are drawn as coverage: assembled in order, covered by any thread.

use std::sync::Arc;

use crate::parallel::is_cut_short;
use crate::render::surface::{PlacedSprite, Position, SegmentBatch};

use super::coverage::CoverageBuffer;
use super::part::Layers;
use super::region::Region;
use super::stroker::{Hand, Stroker, Trail};

/// Approximate number of commands or positions of a chunk.
const MANY: usize = 1 << 14;

enum Command {
    /// Stroker of the following lines.
    Stroker(Stroker),
    /// Beginning of a subpath, at a position.
    Start,
    /// Continuation of a subpath from another chunk.
    GoOn(Box<Trail>),
    /// Closing or end of a subpath.
    Close,
    End,
    /// Number of lines, each to a position.
    Lines(usize),
    /// Polygons with equal numbers of vertices.
    Polygons {
        vertices: usize,
        count: usize,
    },
    /// Rows of a region, from the first to the last.
    Region(Arc<Region>, [i64; 2]),
    /// Number of tufts.
    Tufts(usize),
    /// Number of sprites.
    Sprites(usize),
}

/// Commands with their operands.
#[derive(Default)]
pub(super) struct Chunk {
    /// Coverage buffers on which the chunk is drawn, once assigned.
    planes: Layers,
    commands: Vec<Command>,
    points: Vec<Position>,
    tufts: Vec<SegmentBatch>,
    sprites: Vec<PlacedSprite>,
}

impl Chunk {
    pub(super) fn is_empty(&self) -> bool {
        self.commands.is_empty()
    }

    pub(super) fn is_full(&self) -> bool {
        let most = self.commands.len().max(self.points.len());
        let apart = self.tufts.len().max(self.sprites.len());
        most.max(apart) >= MANY || is_cut_short()
    }

    /// Returns the number of positions.
    #[cfg(test)]
    pub(super) fn positions(&self) -> usize {
        self.points.len()
    }

    #[inline]
    pub(super) fn stroker(&mut self, stroker: Stroker) {
        self.commands.push(Command::Stroker(stroker));
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

    /// Closes a subpath of lines.
    pub(super) fn close(&mut self) {
        self.commands.push(Command::Close);
    }

    /// Ends a subpath of lines.
    pub(super) fn end(&mut self) {
        self.commands.push(Command::End);
    }

    /// Adds a polygon that [`CoverageBuffer::shape`] covers.
    pub(super) fn polygon(&mut self, polygon: &[Position]) {
        self.points.extend_from_slice(polygon);
        let sides = polygon.len();
        match self.commands.last_mut() {
            Some(Command::Polygons { vertices, count }) if *vertices == sides => *count += 1,
            _ => self.commands.push(Command::Polygons {
                vertices: sides,
                count: 1,
            }),
        }
    }

    /// Adds some rows of a region.
    pub(super) fn region(&mut self, region: Arc<Region>, rows: [i64; 2]) {
        self.commands.push(Command::Region(region, rows));
    }

    pub(super) fn tufts(&mut self, tufts: &[SegmentBatch]) {
        self.tufts.extend_from_slice(tufts);
        self.commands.push(Command::Tufts(tufts.len()));
    }

    pub(super) fn sprites(&mut self, sprites: &[PlacedSprite]) {
        self.sprites.extend_from_slice(sprites);
        self.commands.push(Command::Sprites(sprites.len()));
    }

    /// Makes `next` continue the current subpath with a stroker.
    pub(super) fn lead_to(&mut self, next: &mut Self, stroker: Stroker, trail: &Trail) {
        let is_flat = matches!(stroker, Stroker::Flat(_));
        next.stroker(stroker);
        if let (Some(Command::Start), false) = (self.commands.last(), is_flat) {
            self.commands.pop();
            self.points.pop();
            next.start(trail.at);
        } else {
            next.commands.push(Command::GoOn(Box::new(*trail)));
        }
    }

    /// Assigns the coverage buffers: lines are drawn on the second ones if there are any.
    pub(super) fn assign(&mut self, planes: Layers) {
        self.planes = planes;
    }

    /// Executes the commands, and empties the chunk.
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
        self.sprites.clear();
    }

    fn cover_on(&self, plane: &mut CoverageBuffer, mut strokes: Option<&mut CoverageBuffer>) {
        let (mut points, mut tufts) = (self.points.as_slice(), self.tufts.as_slice());
        let mut sprites = self.sprites.as_slice();
        let mut next = |count: usize| {
            let (next, rest) = points.split_at(count.min(points.len()));
            points = rest;
            next
        };
        let (mut hand, mut at) = (None, [0; 2]);
        for command in &self.commands {
            let over = strokes.as_deref_mut().unwrap_or(&mut *plane);
            match command {
                Command::Stroker(next) => hand = Some(Hand::of(next, over.picture())),
                Command::Start => {
                    at = next(1).first().copied().unwrap_or(at);
                    if let Some(hand) = &mut hand {
                        hand.start(over, at);
                    }
                }
                Command::GoOn(trail) => {
                    at = trail.at;
                    if let Some(hand) = &mut hand {
                        hand.go_on(over, trail);
                    }
                }
                Command::Lines(count) => {
                    let lines = next(*count);
                    if let Some(hand) = &mut hand {
                        hand.lines(over, at, lines);
                    }
                    at = lines.last().copied().unwrap_or(at);
                }
                Command::Close => {
                    if let Some(hand) = &mut hand {
                        hand.close(over);
                    }
                }
                Command::End => {
                    if let Some(hand) = &mut hand {
                        hand.end(over);
                    }
                }
                Command::Polygons { vertices, count } => {
                    for polygon in next(vertices * count).chunks_exact(*vertices) {
                        plane.shape(polygon);
                    }
                }
                Command::Region(region, rows) => region.cover(plane, *rows),
                Command::Tufts(count) => {
                    let (now, rest) = tufts.split_at(*count);
                    now.iter().for_each(|tuft| {
                        plane.tuft(tuft.middle, tuft.extent, tuft.area, tuft.width)
                    });
                    tufts = rest;
                }
                Command::Sprites(count) => {
                    let (now, rest) = sprites.split_at(*count);
                    for PlacedSprite { sprite, pixel } in now {
                        over.sprite(&sprite.strokes, *pixel);
                    }
                    for PlacedSprite { sprite, pixel } in now {
                        plane.sprite(&sprite.areas, *pixel);
                    }
                    sprites = rest;
                }
            }
        }
    }
}
