//! Chunks of a document: collected in order, formatted on any thread.

use crate::render::paint::Position;

use super::path::PathData;

/// Approximate number of commands of a chunk. It does not depend on the number of threads, nor does the
/// output.
const COMMANDS: usize = 1 << 12;

#[derive(Clone, Copy)]
enum Command {
    Move,
    Line,
    Curve,
    Close,
    /// Other text of this many bytes.
    Text(u32),
}

/// Commands, and the text to which they are formatted.
#[derive(Default)]
pub(in crate::render) struct Chunk {
    commands: Vec<Command>,
    points: Vec<Position>,
    other: Vec<u8>,
    /// Current point and start of the subpath, if the chunk begins within a path.
    within: Option<[Position; 2]>,
    path: PathData,
    pub(super) text: Vec<u8>,
}

impl Chunk {
    pub(super) fn is_full(&self) -> bool {
        self.commands.len() >= COMMANDS
    }

    /// Empties the chunk.
    pub(super) fn begin(&mut self, within: Option<[Position; 2]>) {
        self.commands.clear();
        self.points.clear();
        self.other.clear();
        self.within = within;
    }

    #[inline]
    pub(super) fn move_to(&mut self, to: Position) {
        self.commands.push(Command::Move);
        self.points.push(to);
    }

    #[inline]
    pub(super) fn line_to(&mut self, to: Position) {
        self.commands.push(Command::Line);
        self.points.push(to);
    }

    pub(super) fn curve_to(&mut self, points: [Position; 3]) {
        self.commands.push(Command::Curve);
        self.points.extend(points);
    }

    pub(super) fn close(&mut self) {
        self.commands.push(Command::Close);
    }

    /// Adds text other than path data.
    pub(super) fn write(&mut self, text: &[u8]) {
        self.other.extend_from_slice(text);
        #[expect(clippy::cast_possible_truncation, reason = "tags are short")]
        let length = text.len() as u32;
        if let Some(Command::Text(before)) = self.commands.last_mut() {
            *before += length;
        } else {
            self.commands.push(Command::Text(length));
        }
    }

    /// Formats the commands as text.
    pub(super) fn format(&mut self) {
        self.text.clear();
        self.path.clear();
        if let Some([pen, start]) = self.within
            && !matches!(self.commands.first(), Some(Command::Text(_)))
        {
            self.text.push(b'\n');
            self.path.go_on(pen, start);
        }
        let mut points = self.points.iter().copied();
        let mut point = || points.next().unwrap_or_default();
        let mut other = self.other.as_slice();
        for &command in &self.commands {
            match command {
                Command::Move => self.path.move_to(point()),
                Command::Line => self.path.line_to(point()),
                Command::Curve => {
                    let (a, b, to) = (point(), point(), point());
                    self.path.curve_to(a, b, to);
                }
                Command::Close => self.path.close(),
                Command::Text(length) => {
                    self.path.drain(&mut self.text);
                    self.path.clear();
                    let (text, rest) = other.split_at(length as usize);
                    self.text.extend_from_slice(text);
                    other = rest;
                }
            }
        }
        self.path.drain(&mut self.text);
    }
}
