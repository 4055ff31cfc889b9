//! Texts that undo and redo bring back, byte for byte.

use std::collections::VecDeque;
use std::sync::Arc;

/// Largest number of texts.
const MOST: usize = 2_000;

/// Largest number of bytes of all texts but the present one.
const MOST_BYTES: usize = 128 << 20;

/// Texts before and after the present one.
#[derive(Debug)]
pub(super) struct History {
    texts: VecDeque<Arc<str>>,
    /// Index of the present text.
    now: usize,
    bytes: usize,
}

impl History {
    /// Begins with a text.
    pub(super) fn new(text: Arc<str>) -> Self {
        Self {
            bytes: text.len(),
            texts: VecDeque::from([text]),
            now: 0,
        }
    }

    /// Returns the present text.
    pub(super) fn text(&self) -> &Arc<str> {
        &self.texts[self.now]
    }

    /// Adds a text after the present one, in place of those that undo has left; returns whether it differs.
    pub(super) fn push(&mut self, text: Arc<str>) -> bool {
        if *text == **self.text() {
            return false;
        }
        let left = self.texts.drain(self.now + 1..);
        self.bytes -= left.map(|text| text.len()).sum::<usize>();
        self.bytes += text.len();
        self.texts.push_back(text);
        while self.texts.len() > MOST || (self.bytes > MOST_BYTES && self.texts.len() > 2) {
            let first = self.texts.pop_front();
            self.bytes -= first.map_or(0, |text| text.len());
        }
        self.now = self.texts.len() - 1;
        true
    }

    /// Returns whether there is a text before the present one.
    pub(super) fn can_undo(&self) -> bool {
        self.now > 0
    }

    /// Returns whether there is a text after the present one.
    pub(super) fn can_redo(&self) -> bool {
        self.now + 1 < self.texts.len()
    }

    /// Goes back to the text before; returns whether there is one.
    pub(super) fn undo(&mut self) -> bool {
        let can = self.can_undo();
        self.now -= usize::from(can);
        can
    }

    /// Goes forward to the text after; returns whether there is one.
    pub(super) fn redo(&mut self) -> bool {
        let can = self.can_redo();
        self.now += usize::from(can);
        can
    }
}

#[cfg(test)]
mod tests {
    use super::{History, MOST};

    #[test]
    fn texts_come_back_as_they_were() {
        let mut history = History::new("a: 1\r\n".into());
        assert!(!history.undo());
        assert!(!history.push("a: 1\r\n".into()));
        assert!(history.push("a: 2 # two\n".into()) && history.push("\u{feff}a: 3".into()));
        assert!(history.undo() && history.undo() && !history.undo());
        assert_eq!(&**history.text(), "a: 1\r\n");
        assert!(history.redo());
        assert_eq!(&**history.text(), "a: 2 # two\n");
        assert!(history.push("a: 4".into()));
        assert!(!history.redo() && history.undo());
        assert_eq!(&**history.text(), "a: 2 # two\n");
    }

    #[test]
    fn more_than_a_thousand_texts_are_kept_and_memory_is_bounded() {
        let mut history = History::new("0".into());
        for number in 1..=3 * MOST {
            history.push(number.to_string().into());
        }
        let undone = std::iter::from_fn(|| history.undo().then_some(())).count();
        assert_eq!(undone, MOST - 1);
        let long = "x".repeat(60 << 20);
        for end in ["a", "b", "c", "d"] {
            history.push((long.clone() + end).into());
        }
        assert!(history.bytes <= 3 * (61 << 20));
        assert!(history.text().ends_with('d') && history.undo());
    }
}
