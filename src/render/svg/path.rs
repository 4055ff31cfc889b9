//! Path data of integers: absolute at the start of a subpath, relative after it.
//!
//! Differences are taken between rounded positions, so that rounding errors do not accumulate along a path.

use crate::render::paint::Position;

/// Column near which lines are broken, to keep files readable and comparable.
const LINE: usize = 100;

/// Largest absolute value whose text is copied from a table.
const SMALL: i64 = 999;

const NUMBERS: usize = 1999;

/// Text of every small number, in the low bytes of a word, and its length in the highest byte.
static DIGITS: [[u8; 8]; NUMBERS] = digits();

#[expect(clippy::cast_possible_truncation, reason = "digits are small")]
const fn digits() -> [[u8; 8]; NUMBERS] {
    let mut table = [[0; 8]; NUMBERS];
    let mut number = -SMALL;
    while number <= SMALL {
        let mut word = [0; 8];
        let mut length = 0;
        if number < 0 {
            word[0] = b'-';
            length = 1;
        }
        let value = number.unsigned_abs();
        let mut power = 100;
        while power > 0 {
            if value >= power || power == 1 {
                word[length] = b'0' + (value / power % 10) as u8;
                length += 1;
            }
            power /= 10;
        }
        word[7] = length as u8;
        table[(number + SMALL) as usize] = word;
        number += 1;
    }
    table
}

/// Upper bound of the length of a command with its numbers.
const ROOM: usize = 256;

/// Writer of path data into a buffer.
#[derive(Default)]
pub(super) struct PathData {
    /// Buffer: the text up to `end`, and spare room.
    text: Vec<u8>,
    end: usize,
    line_start: usize,
    /// Letter that need not be repeated before the next numbers.
    command: u8,
    after_number: bool,
    pen: Position,
    start: Position,
}

impl PathData {
    /// Moves the text written so far to `out`.
    pub(super) fn drain(&mut self, out: &mut Vec<u8>) {
        out.extend_from_slice(&self.text[..self.end]);
        self.end = 0;
    }

    /// Begins a new path.
    pub(super) fn clear(&mut self) {
        (self.end, self.line_start) = (0, 0);
        (self.command, self.after_number) = (0, false);
    }

    /// Continues a path, on a new line.
    pub(super) fn go_on(&mut self, pen: Position, start: Position) {
        (self.pen, self.start) = (pen, start);
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
        self.make_room();
        self.push(b'z');
        self.command = 0;
        self.after_number = false;
        self.pen = self.start;
    }

    #[inline]
    fn make_room(&mut self) {
        if self.text.len() < self.end + ROOM {
            self.text.resize(2 * (self.end + ROOM), 0);
        }
    }

    #[inline]
    fn push(&mut self, byte: u8) {
        self.text[self.end] = byte;
        self.end += 1;
    }

    /// Begins a command.
    #[inline]
    fn letter(&mut self, letter: u8) {
        self.make_room();
        if self.command != letter || letter == b'M' {
            self.push(letter);
            self.command = letter;
            self.after_number = false;
        }
    }

    #[inline]
    fn number(&mut self, value: i64) {
        if self.after_number {
            if self.end - self.line_start > LINE {
                self.push(b'\n');
                self.line_start = self.end;
            } else if value >= 0 {
                self.push(b' ');
            }
        }
        self.after_number = true;
        let place = usize::try_from(value.wrapping_add(SMALL)).ok();
        if let Some(word) = place.and_then(|place| DIGITS.get(place)) {
            self.text[self.end..self.end + 8].copy_from_slice(word);
            self.end += usize::from(word[7]);
        } else {
            let mut buffer = itoa::Buffer::new();
            let text = buffer.format(value).as_bytes();
            self.text[self.end..self.end + text.len()].copy_from_slice(text);
            self.end += text.len();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::PathData;

    #[test]
    fn numbers_are_written_as_they_are_everywhere() {
        for range in [-1_100..1_100, -1_000_010..-999_990, i64::MAX - 2..i64::MAX] {
            for value in range {
                let mut path = PathData::default();
                path.move_to([value, value]);
                let mut text = Vec::new();
                path.drain(&mut text);
                let space = if value < 0 { "" } else { " " };
                assert_eq!(
                    String::from_utf8(text).unwrap(),
                    format!("M{value}{space}{value}")
                );
            }
        }
    }
}
