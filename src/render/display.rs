//! Display lists: drawings as commands with their operands, recorded in order and replayed on any thread.

use super::paint::Position;
use super::png::{PlacedSprite, SegmentBatch};

/// Command, with the number of its operands.
pub(super) enum Command<C, K> {
    /// Straight lines, each to a point.
    Lines(usize),
    /// Separate straight lines with equal keys.
    Segments { key: K, count: usize },
    /// Polygons with equal keys and equal numbers of vertices.
    Polygons { key: K, sides: usize, count: usize },
    /// Segment batches.
    Batches(usize),
    /// Sprites with equal keys.
    Sprites { key: K, count: usize },
    /// Any other command, which takes its points itself.
    Other(C),
}

/// Commands and operands. `C` are the commands beyond those of all lists, and `K` is the paint of a shape.
pub(super) struct DisplayList<C, K> {
    pub(super) commands: Vec<Command<C, K>>,
    pub(super) points: Vec<Position>,
    batches: Vec<SegmentBatch>,
    sprites: Vec<PlacedSprite>,
}

impl<C, K> Default for DisplayList<C, K> {
    fn default() -> Self {
        Self {
            commands: Vec::new(),
            points: Vec::new(),
            batches: Vec::new(),
            sprites: Vec::new(),
        }
    }
}

impl<C, K: Copy + PartialEq> DisplayList<C, K> {
    /// Removes everything.
    pub(super) fn clear(&mut self) {
        self.commands.clear();
        self.points.clear();
        self.batches.clear();
        self.sprites.clear();
    }

    /// Returns the largest number of commands or of operands of one kind.
    pub(super) fn size(&self) -> usize {
        let drawn = self.commands.len().max(self.points.len());
        drawn.max(self.batches.len()).max(self.sprites.len())
    }

    #[inline]
    pub(super) fn push(&mut self, command: C) {
        self.commands.push(Command::Other(command));
    }

    /// Adds a command with a point.
    #[inline]
    pub(super) fn push_at(&mut self, command: C, at: Position) {
        self.push(command);
        self.points.push(at);
    }

    /// Adds straight lines.
    #[inline]
    pub(super) fn lines(&mut self, to: impl IntoIterator<Item = Position>) {
        let before = self.points.len();
        self.points.extend(to);
        let added = self.points.len() - before;
        match self.commands.last_mut() {
            Some(Command::Lines(count)) => *count += added,
            _ => self.commands.push(Command::Lines(added)),
        }
    }

    /// Adds separate straight lines, by pairs of ends.
    #[inline]
    pub(super) fn segments(&mut self, key: K, ends: &[Position]) {
        self.points.extend_from_slice(ends);
        let added = ends.len() / 2;
        match self.commands.last_mut() {
            Some(Command::Segments { key: last, count }) if *last == key => *count += added,
            _ => self.commands.push(Command::Segments { key, count: added }),
        }
    }

    /// Adds a polygon of `sides` vertices, which the caller adds to the points.
    #[inline]
    pub(super) fn polygon(&mut self, key: K, sides: usize) -> &mut Vec<Position> {
        match self.commands.last_mut() {
            Some(Command::Polygons {
                key: last,
                sides: same,
                count,
            }) if *last == key && *same == sides => *count += 1,
            _ => self.commands.push(Command::Polygons {
                key,
                sides,
                count: 1,
            }),
        }
        &mut self.points
    }

    /// Adds segment batches.
    pub(super) fn batches(&mut self, batches: impl IntoIterator<Item = SegmentBatch>) {
        let before = self.batches.len();
        self.batches.extend(batches);
        let added = self.batches.len() - before;
        self.commands.push(Command::Batches(added));
    }

    /// Adds sprites.
    pub(super) fn sprites(&mut self, key: K, sprites: &[PlacedSprite]) {
        self.sprites.extend_from_slice(sprites);
        let added = sprites.len();
        match self.commands.last_mut() {
            Some(Command::Sprites { key: last, count }) if *last == key => *count += added,
            _ => self.commands.push(Command::Sprites { key, count: added }),
        }
    }

    /// Iterates over the commands with their operands.
    pub(super) fn replay(&self) -> Replay<'_, C, K> {
        Replay {
            commands: self.commands.iter(),
            points: &self.points,
            batches: &self.batches,
            sprites: &self.sprites,
        }
    }
}

/// Command with its operands.
pub(super) enum Step<'a, C, K> {
    /// Ends of straight lines.
    Lines(&'a [Position]),
    /// Pairs of ends of separate straight lines.
    Segments(K, &'a [Position]),
    /// Vertices of polygons, with the number of vertices of each.
    Polygons(K, usize, &'a [Position]),
    Batches(&'a [SegmentBatch]),
    Sprites(K, &'a [PlacedSprite]),
    /// Command whose points are still to be taken.
    Other(&'a C),
}

/// Replay of a list.
pub(super) struct Replay<'a, C, K> {
    commands: std::slice::Iter<'a, Command<C, K>>,
    points: &'a [Position],
    batches: &'a [SegmentBatch],
    sprites: &'a [PlacedSprite],
}

impl<'a, C, K> Replay<'a, C, K> {
    /// Takes the next point.
    #[inline]
    pub(super) fn point(&mut self) -> Position {
        take(&mut self.points, 1).first().copied().unwrap_or([0; 2])
    }
}

impl<'a, C, K: Copy> Iterator for Replay<'a, C, K> {
    type Item = Step<'a, C, K>;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        Some(match self.commands.next()? {
            Command::Lines(count) => Step::Lines(take(&mut self.points, *count)),
            Command::Segments { key, count } => {
                Step::Segments(*key, take(&mut self.points, 2 * count))
            }
            Command::Polygons { key, sides, count } => {
                Step::Polygons(*key, *sides, take(&mut self.points, sides * count))
            }
            Command::Batches(count) => Step::Batches(take(&mut self.batches, *count)),
            Command::Sprites { key, count } => Step::Sprites(*key, take(&mut self.sprites, *count)),
            Command::Other(command) => Step::Other(command),
        })
    }
}

/// Takes the next operands.
#[inline]
fn take<'a, T>(operands: &mut &'a [T], count: usize) -> &'a [T] {
    let (taken, rest) = operands.split_at(count.min(operands.len()));
    *operands = rest;
    taken
}
