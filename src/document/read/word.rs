//! Reading of words, which are strings of modules, and of productions.

use std::ops::Range;

use crate::diagnostic::Place;
use crate::document::lsystem::{ModuleDocument, WordDocument};
use crate::document::node::{Key, Node, Value};
use crate::document::reader::Reader;
use crate::document::{Written, WrittenNumber};
use crate::expression::Expression;

/// Maximum number of modules in all words of a file.
const MAX_MODULES: usize = 100_000;

/// Number of mistakes in a word after which it is not read further.
const MAX_MISTAKES: usize = 20;

/// A text with the source spans of its parts.
#[derive(Clone, Copy)]
pub(super) struct Text<'n> {
    text: &'n str,
    place: &'n Place,
    /// Whether the text equals its notation, without escapes and line breaks.
    exact: bool,
}

/// The part of a production before its arrow.
pub(super) struct Head {
    pub(super) left: Vec<ModuleDocument>,
    pub(super) predecessor: ModuleDocument,
    pub(super) right: Vec<ModuleDocument>,
    pub(super) condition: Option<WrittenNumber>,
}

/// A reader of the words of a file, which counts their modules.
pub(super) struct WordReader<'r> {
    pub(super) reader: &'r mut Reader,
    modules: usize,
}

impl<'n> Text<'n> {
    /// Returns the text of a scalar that is text or a number; `None` for other values.
    pub(super) fn of(node: &'n Node) -> Option<Self> {
        let text = match &node.value {
            Value::Text(text) => text,
            Value::Number(_) => node.written()?,
            _ => return None,
        };
        Some(Self::new(text, &node.place))
    }

    pub(super) fn of_key(key: &'n Key) -> Self {
        Self::new(&key.name, &key.place)
    }

    fn new(text: &'n str, place: &'n Place) -> Self {
        let exact = place.text() == text;
        Self { text, place, exact }
    }

    /// Returns the source span of a range of bytes, or of the whole text if it differs from its
    /// notation.
    fn at(&self, range: Range<usize>) -> Place {
        if self.exact {
            self.place.within(range)
        } else {
            self.place.clone()
        }
    }

    /// Returns the byte ranges before and after the first arrow.
    pub(super) fn at_arrow(&self) -> Option<(Range<usize>, Range<usize>)> {
        let arrow = self.text.find("->")?;
        Some((0..arrow, arrow + 2..self.text.len()))
    }

    fn all(&self) -> Range<usize> {
        0..self.text.len()
    }

    /// Returns the byte range of a part without surrounding white space.
    fn trimmed(&self, part: Range<usize>) -> Range<usize> {
        let text = &self.text[part.clone()];
        let start = part.start + (text.len() - text.trim_start().len());
        start..start + text.trim().len()
    }

    /// Returns the offset of the first occurrence of a character in a part, outside of parentheses.
    fn find(&self, character: char, part: Range<usize>) -> Option<usize> {
        let mut depth = 0u32;
        let mut characters = self.text[part.clone()].char_indices();
        let found = characters.find(|&(_, c)| {
            match c {
                '(' => depth += 1,
                ')' => depth = depth.saturating_sub(1),
                _ => {}
            }
            c == character && depth == 0
        });
        found.map(|(at, _)| part.start + at)
    }
}

/// Returns the text of the first of some arguments in brackets.
fn first_argument(arguments: &str) -> Option<&str> {
    let arguments = arguments.trim_start().strip_prefix('(')?;
    let end = arguments.find([',', ')'])?;
    Some(arguments[..end].trim())
}

impl<'r> WordReader<'r> {
    pub(super) fn new(reader: &'r mut Reader) -> Self {
        Self { reader, modules: 0 }
    }

    fn error(&mut self, place: &Place, message: impl Into<String>, hint: &str) {
        self.reader.error_with_hint(place, message, hint);
    }

    /// Reads the whole text as a word.
    pub(super) fn word(&mut self, text: Text<'_>) -> WordDocument {
        self.part(text, text.all())
    }

    /// Reads a part of a text as a word.
    pub(super) fn part(&mut self, text: Text<'_>, part: Range<usize>) -> WordDocument {
        let place = text.at(text.trimmed(part.clone()));
        let (modules, complete) = self.modules(text, part);
        WordDocument {
            modules,
            complete,
            place,
        }
    }

    /// Reads the modules in a part of a text. Also returns whether the part was read completely.
    fn modules(&mut self, text: Text<'_>, part: Range<usize>) -> (Vec<ModuleDocument>, bool) {
        let mut modules = Vec::new();
        let mistakes = self.reader.diagnostics.len();
        let mut at = part.start;
        loop {
            let rest = &text.text[at..part.end];
            let blanks = rest.len() - rest.trim_start().len();
            let Some(character) = rest.trim_start().chars().next() else {
                return (modules, true);
            };
            let start = at + blanks;
            let end = start + character.len_utf8();
            let place = text.at(start..end);
            if self.modules == MAX_MODULES {
                let message = "the words hold more than 100,000 modules";
                self.error(&place, message, "a few more steps make long words");
                return (modules, false);
            }
            self.modules += 1;
            if let Some(message) = match character {
                '(' => Some("there is no symbol for these arguments"),
                ')' => Some("no round bracket is open here"),
                ',' => Some("a comma stands between arguments only"),
                _ => None,
            } {
                self.error(
                    &place,
                    message,
                    "a module is a symbol, perhaps with arguments: A(w, l/2)",
                );
                return (modules, false);
            }
            let (arguments, next) = match self.arguments(text, end..part.end) {
                Some(found) => found,
                None => return (modules, false),
            };
            let name = (character == '~').then(|| first_argument(&text.text[end..next]));
            modules.push(ModuleDocument {
                character,
                arguments,
                name: name.flatten().map(str::to_owned),
                place: text.at(start..text.trimmed(start..next).end),
            });
            at = next;
            if self.reader.diagnostics.len() >= mistakes + MAX_MISTAKES {
                return (modules, false);
            }
        }
    }

    /// Reads the arguments, if there are any, at the beginning of a part of a text, and returns the
    /// offset of their end. Reports an unclosed parenthesis and returns `None`.
    fn arguments(
        &mut self,
        text: Text<'_>,
        part: Range<usize>,
    ) -> Option<(Vec<WrittenNumber>, usize)> {
        let rest = &text.text[part.clone()];
        let part = part.start + (rest.len() - rest.trim_start().len())..part.end;
        if !text.text[part.clone()].starts_with('(') {
            return Some((Vec::new(), part.start));
        }
        let mut arguments = Vec::new();
        let mut depth = 0u32;
        let mut start = part.start + 1;
        for (at, character) in text.text[part.clone()].char_indices() {
            let at = part.start + at;
            match character {
                '(' => depth += 1,
                ')' => depth -= 1,
                _ => {}
            }
            let ends = depth == 0;
            if ends || (depth == 1 && character == ',') {
                arguments.push(self.number(text, start..at));
                start = at + 1;
            }
            if ends {
                return Some((arguments, at + 1));
            }
        }
        let place = text.at(part.start..part.start + 1);
        self.error(&place, "this bracket is not closed", "arguments end with )");
        None
    }

    /// Parses a part of a text as an expression.
    fn number(&mut self, text: Text<'_>, part: Range<usize>) -> WrittenNumber {
        let part = text.trimmed(part);
        // An empty expression is shown at the parenthesis or comma that follows it.
        let shown = part.start..part.end.max(part.start + 1);
        let place = text.at(part.clone());
        let formula = self.reader.formula(&text.text[part.clone()], &place);
        let value = formula.unwrap_or_else(|error| {
            let range = part.start + error.range.start..part.start + error.range.end;
            let place = text.at(if part.is_empty() { shown } else { range });
            self.reader.diagnostics.push(error.at(&place));
            Expression::unknown()
        });
        Written { value, place }
    }

    /// Reads the part before the arrow: contexts, the strict predecessor and a condition.
    pub(super) fn head(&mut self, text: Text<'_>, part: Range<usize>) -> Option<Head> {
        let colon = text.find(':', part.clone());
        let pattern = part.start..colon.unwrap_or(part.end);
        let left = text.find('<', pattern.clone());
        let middle = left.map_or(pattern.start, |at| at + 1)..pattern.end;
        let right = text.find('>', middle.clone());
        let contexts = [
            left.map(|at| (at, pattern.start..at)),
            right.map(|at| (at, at + 1..pattern.end)),
        ];
        let mut sides = [Vec::new(), Vec::new()];
        for (side, context) in sides.iter_mut().zip(contexts) {
            if let Some((at, part)) = context {
                let (modules, complete) = self.modules(text, part);
                if modules.is_empty() && complete {
                    let place = text.at(at..at + 1);
                    let hint = "contexts are written LEFT < PREDECESSOR > RIGHT";
                    self.error(&place, "there is no context on this side", hint);
                }
                *side = modules;
            }
        }
        let middle = middle.start..right.unwrap_or(middle.end);
        let (mut replaced, complete) = self.modules(text, middle.clone());
        if !complete {
            return None;
        }
        let condition = colon.map(|at| at + 1..part.end);
        let condition = condition.filter(|part| text.text[part.clone()].trim() != "*");
        let condition = condition.map(|part| self.number(text, part));
        if replaced.len() != 1 {
            let (place, message) = match replaced.get(1) {
                Some(second) => (
                    second.place.clone(),
                    format!("a production replaces one module, not {}", replaced.len()),
                ),
                None => (
                    text.at(text.trimmed(part)),
                    "the module that is replaced is missing".into(),
                ),
            };
            let hint = "F -> F+F; what must stand around it is written A < F > B -> F+F";
            self.error(&place, message, hint);
        }
        let [left, right] = sides;
        Some(Head {
            left,
            predecessor: replaced.drain(..).next()?,
            right,
            condition,
        })
    }
}
