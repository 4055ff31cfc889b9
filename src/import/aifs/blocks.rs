//! Lexical structure of AIFS texts: blocks, and the definitions that they consist of.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use crate::diagnostic::{Diagnostic, Diagnostics, Place, Source};

use super::syntax::{self, Expression, Parsed};

/// A block: `@ID:ParentID`, with lines of definitions.
pub(super) struct Block {
    /// Identifier, by which other blocks refer to it.
    pub(super) id: Option<String>,
    /// Identifier of the block whose definitions this one inherits.
    pub(super) parent: Option<(String, Place)>,
    /// Place of the line that begins the block.
    pub(super) place: Place,
    /// Name for people: `$n`.
    pub(super) name: Option<String>,
    /// Whether the block is only for others to refer to: `$a=h`.
    pub(super) is_hidden: bool,
    /// Definitions in their order.
    pub(super) definitions: Vec<Definition>,
    /// Index of each definition by its name.
    names: BTreeMap<String, usize>,
    /// Mistakes of the block's form.
    pub(super) found: Diagnostics,
}

/// A definition: `name=expression`. Names of settings begin with `$`.
pub(super) struct Definition {
    pub(super) name: String,
    /// Place of the name.
    pub(super) place: Place,
    /// Place of the expression.
    pub(super) value: Place,
    /// The expression; for settings other than `$dim` there is none.
    pub(super) expression: Option<Parsed<Expression>>,
}

impl Block {
    fn new(place: Place) -> Self {
        Self {
            id: None,
            parent: None,
            place,
            name: None,
            is_hidden: false,
            definitions: Vec::new(),
            names: BTreeMap::new(),
            found: Diagnostics::default(),
        }
    }

    /// Returns the block that a line `@ID:ParentID` begins.
    fn begun(place: Place) -> Self {
        let line = place.text();
        let colon = line.find(':').unwrap_or(line.len());
        let part = |range: Range<usize>| {
            let range = trimmed(line, range);
            (line[range.clone()].to_owned(), place.within(range))
        };
        let (id, parent) = (part(1..colon), part(line.len().min(colon + 1)..line.len()));
        let mut block = Self::new(place.clone());
        for (part, place) in [&id, &parent] {
            if !part.is_empty() && !syntax::is_name(part) {
                let wrong = Diagnostic::error(format!("'{part}' is not an identifier")).at(place);
                block
                    .found
                    .push(wrong.hint("a block begins with @ID:ParentID"));
            }
        }
        block.id = Some(id.0).filter(|id| !id.is_empty());
        block.parent = Some(parent).filter(|(parent, _)| !parent.is_empty());
        block
    }

    /// Returns the definition of a name in this block.
    pub(super) fn definition(&self, name: &str) -> Option<&Definition> {
        self.names.get(name).map(|at| &self.definitions[*at])
    }

    /// Adds a statement.
    fn add(&mut self, source: &Arc<Source>, statement: Range<usize>) {
        let text = &source.text()[statement.clone()];
        let Some((name, value)) = text.split_once('=') else {
            let place = Place::new(source, trimmed(source.text(), statement));
            let wrong = Diagnostic::error("this is no definition").at(&place);
            self.found
                .push(wrong.hint("a definition is name=expression"));
            return;
        };
        let middle = statement.start + name.len();
        let place = Place::new(source, trimmed(source.text(), statement.start..middle));
        let value_range = middle + 1..statement.end;
        let value_place = Place::new(source, trimmed(source.text(), value_range));
        // A name that begins with & is evaluated anew wherever it is used, which makes a difference for templates only.
        let name = name.trim();
        let name = name.strip_prefix('&').unwrap_or(name).trim();
        match name {
            "$n" => self.name = Some(value.trim().to_owned()).filter(|name| !name.is_empty()),
            "$a" => self.is_hidden = value.contains('h'),
            _ if !syntax::is_name(name.strip_prefix('$').unwrap_or(name)) => {
                let wrong = Diagnostic::error(format!("'{name}' is not a name")).at(&place);
                self.found.push(wrong);
            }
            _ => {
                let parse = !name.starts_with('$') || name == "$dim";
                let expression = parse.then(|| syntax::parse(&value_place));
                if self
                    .names
                    .insert(name.into(), self.definitions.len())
                    .is_some()
                {
                    let twice = format!("{name} is defined twice in this block");
                    self.found.push(Diagnostic::error(twice).at(&place));
                }
                self.definitions.push(Definition {
                    name: name.into(),
                    place,
                    value: value_place,
                    expression,
                });
            }
        }
    }
}

/// Returns the blocks of a text; what belongs to no block is reported.
pub(super) fn of(source: &Arc<Source>, stray: &mut Diagnostics) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    let mut statement: Option<Range<usize>> = None;
    let mut depth = 0_usize;
    let prelude = prelude(source, stray);
    for line in lines(source.text(), prelude) {
        let text = &source.text()[line.clone()];
        let head = text.trim_start();
        if head.starts_with('@') {
            if let (Some(open), Some(block)) = (statement.take(), blocks.last_mut()) {
                block.add(source, open);
            }
            depth = 0;
            let line = trimmed(source.text(), without_comment(text, &line));
            match head.starts_with("@@") {
                true => directive(&Place::new(source, line), stray),
                false => blocks.push(Block::begun(Place::new(source, line))),
            }
            continue;
        }
        // A name for people may contain any character.
        let line = match head.starts_with("$n") && statement.is_none() {
            true => line,
            false => without_comment(text, &line),
        };
        let Some(block) = blocks.last_mut() else {
            let line = trimmed(source.text(), line);
            if !line.is_empty() {
                let place = Place::new(source, line);
                stray.push(Diagnostic::warning("this belongs to no block").at(&place));
            }
            continue;
        };
        let start = statement.as_ref().map_or(line.start, |open| open.start);
        for character in source.text()[line.clone()].chars() {
            match character {
                '[' | '(' => depth += 1,
                ']' | ')' => depth = depth.saturating_sub(1),
                _ => {}
            }
        }
        let whole = start..line.end;
        if depth > 0 && !head.starts_with('$') {
            statement = Some(whole);
            continue;
        }
        (statement, depth) = (None, 0);
        let end = source.text()[whole.clone()].trim_end_matches([';', ' ', '\t']);
        let whole = whole.start..whole.start + end.len();
        if !trimmed(source.text(), whole.clone()).is_empty() {
            block.add(source, whole);
        }
    }
    if let (Some(open), Some(block)) = (statement, blocks.last_mut()) {
        block.add(source, open);
    }
    blocks
}

/// Returns the length of a JavaScript module before the blocks, which a line `@@` ends and which is reported.
fn prelude(source: &Arc<Source>, stray: &mut Diagnostics) -> usize {
    let mut lines = lines(source.text(), 0);
    let Some(end) = lines.find(|line| source.text()[line.clone()].trim() == "@@") else {
        return 0;
    };
    let first = trimmed(source.text(), 0..end.start);
    if !first.is_empty() {
        let place = Place::new(source, first).first_line();
        let script = Diagnostic::warning("JavaScript is not run").at(&place);
        stray.push(script.hint("blocks that it makes are not read: save them as AIFS"));
    }
    end.end
}

fn directive(place: &Place, stray: &mut Diagnostics) {
    if place.text().starts_with("@@import") {
        let import = Diagnostic::warning("other files are not read").at(place);
        stray.push(import.hint("put their blocks into this file"));
    }
}

/// Iterates over the lines of a text from an offset on.
fn lines(text: &str, from: usize) -> impl Iterator<Item = Range<usize>> + '_ {
    let mut start = from;
    text[from..].split(['\n', '\r']).map(move |line| {
        let range = start..start + line.len();
        start = range.end + 1;
        range
    })
}

/// Returns the range of a line up to its comment.
fn without_comment(text: &str, line: &Range<usize>) -> Range<usize> {
    line.start..line.start + text.find('#').unwrap_or(text.len())
}

/// Returns a range of a text without the blanks at its ends.
fn trimmed(text: &str, range: Range<usize>) -> Range<usize> {
    let part = &text[range.clone()];
    let start = range.start + part.len() - part.trim_start().len();
    start..start + part.trim().len()
}
