//! Chunks of shapes that are drawn as coverage: assembled in order, covered by any thread.

use std::sync::Arc;

use crate::parallel::is_cut_short;
use crate::render::display::{self, DisplayList, Step};
use crate::render::paint::Position;

use super::coverage::CoverageBuffer;
use super::part::Layers;
use super::region::Region;
use super::stroker::{Hand, Stroker, Trail};

/// Approximate number of commands or positions of a chunk.
const MANY: usize = 1 << 14;

/// Command of a chunk.
pub(super) enum Command {
    /// Stroker of the following lines.
    Stroker(Stroker),
    /// Beginning of a subpath, at a position.
    Start,
    /// Continuation of a subpath from another chunk.
    GoOn(Box<Trail>),
    /// Closing or end of a subpath.
    Close,
    End,
    /// Rows of a region, from the first to the last.
    Region(Arc<Region>, [i64; 2]),
}

/// Shapes to be covered.
#[derive(Default)]
pub(super) struct Chunk {
    /// Coverage buffers on which the chunk is drawn, once assigned.
    planes: Layers,
    pub(super) list: DisplayList<Command, ()>,
}

impl Chunk {
    pub(super) fn is_empty(&self) -> bool {
        self.list.commands.is_empty()
    }

    pub(super) fn is_full(&self) -> bool {
        self.list.size() >= MANY || is_cut_short()
    }

    #[inline]
    pub(super) fn stroker(&mut self, stroker: Stroker) {
        self.list.push(Command::Stroker(stroker));
    }

    /// Adds a polygon that [`CoverageBuffer::shape`] covers.
    #[inline]
    pub(super) fn polygon(&mut self, polygon: &[Position]) {
        let points = self.list.polygon((), polygon.len());
        points.extend_from_slice(polygon);
    }

    /// Makes `next` continue the current subpath with a stroker.
    pub(super) fn lead_to(&mut self, next: &mut Self, stroker: Stroker, trail: &Trail) {
        let is_flat = matches!(stroker, Stroker::Flat(_));
        next.stroker(stroker);
        let last = self.list.commands.last();
        if let (Some(display::Command::Other(Command::Start)), false) = (last, is_flat) {
            self.list.commands.pop();
            self.list.points.pop();
            next.list.push_at(Command::Start, trail.at);
        } else {
            next.list.push(Command::GoOn(Box::new(*trail)));
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
        self.list.clear();
    }

    fn cover_on(&self, plane: &mut CoverageBuffer, mut strokes: Option<&mut CoverageBuffer>) {
        let (mut hand, mut at) = (None::<Hand>, [0; 2]);
        let mut replay = self.list.replay();
        while let Some(step) = replay.next() {
            let over = strokes.as_deref_mut().unwrap_or(&mut *plane);
            match (step, &mut hand) {
                (Step::Lines(lines), hand) => {
                    if let Some(hand) = hand {
                        hand.lines(over, at, lines);
                    }
                    at = lines.last().copied().unwrap_or(at);
                }
                (Step::Segments((), ends), hand) => {
                    if let Some(hand) = hand {
                        hand.segments(over, ends);
                    }
                    at = ends.last().copied().unwrap_or(at);
                }
                (Step::Polygons((), sides, vertices), _) => {
                    for polygon in vertices.chunks_exact(sides) {
                        plane.shape(polygon);
                    }
                }
                (Step::Batches(batches), _) => {
                    batches.iter().for_each(|batch| plane.batch(batch));
                }
                (Step::Sprites((), sprites), _) => {
                    for placed in sprites {
                        over.sprite(&placed.sprite.strokes, placed.pixel);
                    }
                    for placed in sprites {
                        plane.sprite(&placed.sprite.areas, placed.pixel);
                    }
                }
                (Step::Other(Command::Stroker(next)), hand) => {
                    *hand = Some(Hand::of(next, over.picture()));
                }
                (Step::Other(Command::Region(region, rows)), _) => region.cover(plane, *rows),
                (Step::Other(Command::Start), hand) => {
                    at = replay.point();
                    if let Some(hand) = hand {
                        hand.start(over, at);
                    }
                }
                (Step::Other(Command::GoOn(trail)), hand) => {
                    at = trail.at;
                    if let Some(hand) = hand {
                        hand.go_on(over, trail);
                    }
                }
                (Step::Other(Command::Close), Some(hand)) => hand.close(over),
                (Step::Other(Command::End), Some(hand)) => hand.end(over),
                (Step::Other(Command::Close | Command::End), None) => {}
            }
        }
    }
}
