//! Texts that undo and redo bring back, byte for byte, with the set values of parameters that they replace, and with
//! their files.

use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;

use super::look::Look;
use super::origin::Origin;

/// Largest number of texts.
const MOST: usize = 2_000;

/// Largest number of bytes of all texts but the present one.
const MOST_BYTES: usize = 128 << 20;

/// Values of parameters that are set beside a text, by their names.
pub(super) type Settings = BTreeMap<String, String>;

/// Texts before and after the present one.
#[derive(Debug)]
pub(super) struct History {
    entries: VecDeque<Entry>,
    /// Index of the present text.
    now: usize,
    bytes: usize,
}

#[derive(Debug)]
struct Entry {
    text: Arc<str>,
    change: Change,
}

/// Change beside a text, from the text before.
#[derive(Debug, Default)]
pub(super) struct Change {
    /// Values that were set before, and that this text has.
    pub(super) written: Settings,
    /// File that was left for the one of this text; after undo, the one of this text.
    pub(super) left: Option<Box<Left>>,
}

/// A file that is left, and the look that it had.
#[derive(Debug)]
pub(super) struct Left {
    pub(super) origin: Origin,
    pub(super) look: Look,
}

impl From<Arc<str>> for Entry {
    fn from(text: Arc<str>) -> Self {
        Self {
            text,
            change: Change::default(),
        }
    }
}

impl History {
    /// Begins with a text.
    pub(super) fn new(text: Arc<str>) -> Self {
        Self {
            bytes: text.len(),
            entries: VecDeque::from([text.into()]),
            now: 0,
        }
    }

    /// Returns the present text.
    pub(super) fn text(&self) -> &Arc<str> {
        &self.entries[self.now].text
    }

    /// Adds a text after the present one, in place of those that undo has left; returns whether it differs.
    pub(super) fn push(&mut self, text: Arc<str>) -> bool {
        let is_other = *text != **self.text();
        if is_other {
            self.add(text.into());
        }
        is_other
    }

    /// Adds a text of another file.
    pub(super) fn open(&mut self, text: Arc<str>, left: Left) {
        let mut entry = Entry::from(text);
        entry.change.left = Some(left.into());
        self.add(entry);
    }

    fn add(&mut self, entry: Entry) {
        let undone = self.entries.drain(self.now + 1..);
        self.bytes -= undone.map(|entry| entry.text.len()).sum::<usize>();
        self.bytes += entry.text.len();
        self.entries.push_back(entry);
        while self.entries.len() > MOST || (self.bytes > MOST_BYTES && self.entries.len() > 2) {
            let first = self.entries.pop_front();
            self.bytes -= first.map_or(0, |entry| entry.text.len());
        }
        self.now = self.entries.len() - 1;
    }

    /// Notes values that were set before the present text was added, and that it has.
    pub(super) fn note_written(&mut self, values: Settings) {
        self.entries[self.now].change.written = values;
    }

    /// Returns whether there is a text before the present one.
    pub(super) fn can_undo(&self) -> bool {
        self.now > 0
    }

    /// Returns whether there is a text after the present one.
    pub(super) fn can_redo(&self) -> bool {
        self.now + 1 < self.entries.len()
    }

    /// Returns whether redo leads to another file.
    pub(super) fn leads_to_another(&self) -> bool {
        let mut later = self.entries.range(self.now + 1..);
        later.any(|entry| entry.change.left.is_some())
    }

    /// Goes back to the text before, if there is one; returns the change that is undone.
    pub(super) fn undo(&mut self) -> Option<&mut Change> {
        let undone = self.can_undo().then_some(self.now)?;
        self.now -= 1;
        Some(&mut self.entries[undone].change)
    }

    /// Goes forward to the text after, if there is one; returns the change that is done again.
    pub(super) fn redo(&mut self) -> Option<&mut Change> {
        self.can_redo().then(|| self.now += 1)?;
        Some(&mut self.entries[self.now].change)
    }
}

#[cfg(test)]
mod tests {
    use super::{History, MOST, Settings};

    #[test]
    fn texts_come_back_as_they_were() {
        let mut history = History::new("a: 1\r\n".into());
        assert!(history.undo().is_none());
        assert!(!history.push("a: 1\r\n".into()));
        assert!(history.push("a: 2 # two\n".into()) && history.push("\u{feff}a: 3".into()));
        assert!(history.undo().is_some() && history.undo().is_some() && history.undo().is_none());
        assert_eq!(&**history.text(), "a: 1\r\n");
        assert!(history.redo().is_some());
        assert_eq!(&**history.text(), "a: 2 # two\n");
        assert!(history.push("a: 4".into()));
        assert!(history.redo().is_none() && history.undo().is_some());
        assert_eq!(&**history.text(), "a: 2 # two\n");
    }

    #[test]
    fn more_than_a_thousand_texts_are_kept_and_memory_is_bounded() {
        let mut history = History::new("0".into());
        for number in 1..=3 * MOST {
            history.push(number.to_string().into());
        }
        let undone = std::iter::from_fn(|| history.undo().map(|_| ())).count();
        assert_eq!(undone, MOST - 1);
        let long = "x".repeat(60 << 20);
        for end in ["a", "b", "c", "d"] {
            history.push((long.clone() + end).into());
        }
        assert!(history.bytes <= 3 * (61 << 20));
        assert!(history.text().ends_with('d') && history.undo().is_some());
    }

    #[test]
    fn values_that_a_text_replaces_are_set_again() {
        let mut history = History::new("a: 1".into());
        let values = Settings::from([("a".into(), "2".into())]);
        assert!(history.push("a: 2".into()));
        history.note_written(values.clone());
        assert!(history.push("a: 2 # two".into()));
        assert_eq!(history.undo().unwrap().written, Settings::new());
        assert_eq!(history.undo().unwrap().written, values);
        assert_eq!(history.redo().unwrap().written, values);
        assert_eq!(history.redo().unwrap().written, Settings::new());
    }
}
