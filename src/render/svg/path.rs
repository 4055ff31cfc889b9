//! Path data in whole numbers: absolute where a subpath starts, relative from there on.
//!
//! Differences are taken between rounded positions, so that errors do not add up along a path.

use crate::render::surface::Position;

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
}

impl PathData {
    /// The number of bytes that wait to be written out.
    pub(super) fn len(&self) -> usize {
        self.text.len()
    }

    /// Takes what has been written so far.
    pub(super) fn drain(&mut self, out: &mut Vec<u8>) {
        let column = self.text.len().wrapping_sub(self.line_start);
        out.append(&mut self.text);
        self.line_start = 0usize.wrapping_sub(column);
    }

    #[inline]
    pub(super) fn move_to(&mut self, to: Position) {
        self.letter(b'M');
        self.number(to[0]);
        self.number(to[1]);
        (self.pen, self.start) = (to, to);
    }

    #[inline]
    pub(super) fn line_to(&mut self, to: Position) {
        if to == self.pen {
            self.letter(b'h');
            self.number(0);
            return;
        }
        self.letter(b'l');
        self.number(to[0] - self.pen[0]);
        self.number(to[1] - self.pen[1]);
        self.pen = to;
    }

    pub(super) fn curve_to(&mut self, a: Position, b: Position, to: Position) {
        self.letter(b'c');
        let [x, y] = self.pen;
        for value in [a[0] - x, a[1] - y, b[0] - x, b[1] - y, to[0] - x, to[1] - y] {
            self.number(value);
        }
        self.pen = to;
    }

    pub(super) fn close(&mut self) {
        self.text.push(b'z');
        self.command = 0;
        self.after_number = false;
        self.pen = self.start;
    }

    #[inline]
    fn letter(&mut self, letter: u8) {
        if self.command != letter || letter == b'M' {
            self.text.push(letter);
            self.command = letter;
            self.after_number = false;
        }
    }

    #[inline]
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
