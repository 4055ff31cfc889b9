//! Path data of SVG in whole numbers: absolute where a subpath starts, relative from there on.
//!
//! Positions are rounded once, and differences are taken between rounded positions, so that errors
//! do not add up along a path.

/// A position in the units of the path.
pub(super) type Position = [i64; 2];

/// Lines are broken near this column, so that files can be read and compared.
const LINE: usize = 100;

/// Writes path data into a buffer.
#[derive(Default)]
pub(super) struct PathData {
    text: Vec<u8>,
    line_start: usize,
    /// The letter that the next numbers may follow without repeating it.
    command: u8,
    after_number: bool,
    pen: Position,
    start: Position,
    /// A vertex that is not written yet: the last one of a closed path is left out.
    held: Option<Position>,
    /// Whether the subpath has a vertex beside its start.
    has_length: bool,
    open: bool,
}

impl PathData {
    /// The bytes that wait to be written out.
    pub(super) fn len(&self) -> usize {
        self.text.len()
    }

    /// Takes what has been written so far.
    pub(super) fn drain(&mut self, out: &mut Vec<u8>) {
        let column = self.text.len().wrapping_sub(self.line_start);
        out.append(&mut self.text);
        self.line_start = 0usize.wrapping_sub(column);
    }

    pub(super) fn move_to(&mut self, to: Position) {
        self.finish();
        self.letter(b'M');
        self.number(to[0]);
        self.number(to[1]);
        (self.pen, self.start) = (to, to);
        self.has_length = false;
        self.open = true;
    }

    pub(super) fn line_to(&mut self, to: Position) {
        if self.held != Some(to) {
            self.flush_held();
            self.held = Some(to);
        }
    }

    pub(super) fn curve_to(&mut self, a: Position, b: Position, to: Position) {
        self.flush_held();
        if [a, b, to] == [self.pen; 3] {
            return;
        }
        self.letter(b'c');
        let [x, y] = self.pen;
        for value in [a[0] - x, a[1] - y, b[0] - x, b[1] - y, to[0] - x, to[1] - y] {
            self.number(value);
        }
        self.pen = to;
        self.has_length = true;
    }

    /// Closes the subpath; `returned` tells that its last vertex is its first, which is then not
    /// written twice.
    pub(super) fn close(&mut self, returned: bool) {
        if returned || self.held == Some(self.start) {
            self.held = None;
        }
        self.flush_held();
        if self.has_length {
            self.text.push(b'z');
            self.command = 0;
            self.after_number = false;
        } else {
            self.dot();
        }
        self.open = false;
    }

    /// Ends the subpath where the pen is.
    pub(super) fn finish(&mut self) {
        if !self.open {
            return;
        }
        self.flush_held();
        if !self.has_length {
            self.dot();
        }
        self.open = false;
    }

    /// A line of no length, which a round cap makes a dot.
    fn dot(&mut self) {
        self.letter(b'h');
        self.number(0);
    }

    fn flush_held(&mut self) {
        let Some(to) = self.held.take() else { return };
        // A vertex that rounds to the one before adds nothing.
        if to == self.pen {
            return;
        }
        self.letter(b'l');
        self.number(to[0] - self.pen[0]);
        self.number(to[1] - self.pen[1]);
        self.pen = to;
        self.has_length = true;
    }

    fn letter(&mut self, letter: u8) {
        if self.command != letter || letter == b'M' {
            self.text.push(letter);
            self.command = letter;
            self.after_number = false;
        }
    }

    fn number(&mut self, value: i64) {
        if self.after_number {
            if self.text.len().wrapping_sub(self.line_start) > LINE {
                self.text.push(b'\n');
                self.line_start = self.text.len();
            } else if value >= 0 {
                self.text.push(b' ');
            }
        }
        let mut buffer = itoa::Buffer::new();
        self.text.extend_from_slice(buffer.format(value).as_bytes());
        self.after_number = true;
    }
}
