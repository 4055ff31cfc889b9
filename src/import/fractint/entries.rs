//! Lexical structure of Fractint's files: entries, and the words that they consist of.

use std::ops::Range;
use std::sync::Arc;

use crate::diagnostic::{Diagnostic, Diagnostics, Place, Source};

/// An entry: `Name { words }`.
#[derive(Clone, Debug)]
pub(in crate::import) struct Entry {
    pub(super) name: String,
    /// Place of the name.
    pub(super) place: Place,
    /// Remark in parentheses after the name, such as `3D`.
    pub(super) remark: Option<String>,
    pub(super) words: Vec<Word>,
    comments: Vec<String>,
    pub(super) found: Diagnostics,
}

/// A sequence of characters without blanks, in capital letters because Fractint ignores case.
#[derive(Clone, Debug)]
pub(super) struct Word {
    pub(super) text: String,
    pub(super) place: Place,
    /// Whether the word is the first of its line.
    pub(super) starts_line: bool,
}

impl Word {
    /// Returns the word as written in the file.
    pub(super) fn written(&self) -> &str {
        &self.place.source().text()[self.place.range()]
    }

    /// Returns the place of a part of the word. Offsets agree with those of the file because capitalisation
    /// changes ASCII letters only.
    pub(super) fn part(&self, range: Range<usize>) -> Place {
        let start = self.place.range().start;
        Place::new(self.place.source(), start + range.start..start + range.end)
    }
}

impl Entry {
    /// Returns the text of the comments, one line each.
    pub(super) fn comment(&self) -> String {
        self.comments.join("\n")
    }

    fn add_line(&mut self, source: &Arc<Source>, start: usize, line: &str) {
        let (words, comment) = line.split_once(';').unwrap_or((line, ""));
        let comment = comment.trim_matches(|c: char| c == ';' || c.is_whitespace());
        if !comment.is_empty() {
            self.comments.push(comment.replace(char::is_control, " "));
        }
        for (number, range) in words_of(words).enumerate() {
            let place = Place::new(source, start + range.start..start + range.end);
            self.words.push(Word {
                text: words[range].to_ascii_uppercase(),
                place,
                starts_line: number == 0,
            });
        }
    }
}

/// Iterates over the ranges of the words in a line. An equals sign is a word of its own.
fn words_of(line: &str) -> impl Iterator<Item = Range<usize>> + '_ {
    let mut at = 0;
    std::iter::from_fn(move || {
        let is_end = |c: char| c.is_whitespace() || c == '=';
        at += line[at..].find(|c: char| !c.is_whitespace())?;
        let start = at;
        let length = match line[start..].find(is_end) {
            Some(0) => 1,
            Some(length) => length,
            None => line.len() - start,
        };
        at = start + length;
        Some(start..at)
    })
}

/// Returns the entries of a text, except those that are called `comment`.
pub(super) fn of(source: &Arc<Source>, stray: &mut Diagnostics) -> Vec<Entry> {
    let text = source.text();
    let mut entries = Vec::new();
    let mut open: Option<Entry> = None;
    let mut start = 0;
    while start < text.len() {
        // The rest of a line, up to a brace outside a comment.
        let rest = &text[start..];
        let length = rest.find(['\n', '\r']).unwrap_or(rest.len());
        let line = &rest[..length];
        let commented = line.find(';').unwrap_or(length);
        let brace = if open.is_some() { '}' } else { '{' };
        let at = line[..commented].find(brace);
        let end = at.map_or(length, |at| at);
        match &mut open {
            Some(entry) => entry.add_line(source, start, &line[..end]),
            None if at.is_some() => open = Some(named(source, start..start + end)),
            None => wander(source, start..start + commented, stray),
        }
        if at.is_some() && brace == '}' {
            entries.extend(open.take());
        }
        start += end + 1;
    }
    if let Some(mut entry) = open {
        let open = Diagnostic::error(format!("{} is not closed", entry.name)).at(&entry.place);
        entry.found.push(open.hint("there is a } missing"));
        entries.push(entry);
    }
    entries.retain(|entry| !entry.name.eq_ignore_ascii_case("comment"));
    entries
}

/// Returns an entry with the name and the remark before its brace.
fn named(source: &Arc<Source>, range: Range<usize>) -> Entry {
    let place = trimmed(source, range);
    let line = &source.text()[place.range()];
    let (name, remark) = match line.split_once('(') {
        Some((name, remark)) => (name, Some(remark.trim_end_matches(')').trim().to_owned())),
        None => (line, None),
    };
    let mut found = Diagnostics::default();
    let name = name.trim();
    if name.is_empty() {
        let place = Place::new(source, place.range().start..place.range().end + 1);
        let nameless = Diagnostic::warning("an entry has no name").at(&place);
        found.push(nameless.hint("it is called unnamed"));
    }
    Entry {
        name: if name.is_empty() { "unnamed" } else { name }.to_owned(),
        place,
        remark,
        words: Vec::new(),
        comments: Vec::new(),
        found,
    }
}

/// Reports a line that belongs to no entry, unless it is blank.
fn wander(source: &Arc<Source>, range: Range<usize>, stray: &mut Diagnostics) {
    let place = trimmed(source, range);
    if !place.range().is_empty() {
        stray.push(Diagnostic::warning("this belongs to no entry").at(&place));
    }
}

fn trimmed(source: &Arc<Source>, range: Range<usize>) -> Place {
    let line = &source.text()[range.clone()];
    let start = range.start + line.len() - line.trim_start().len();
    Place::new(source, start..start + line.trim().len())
}
