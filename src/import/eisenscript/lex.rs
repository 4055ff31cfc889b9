//! Words of EisenScript, after comments and definitions.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use crate::diagnostic::{Diagnostic, Diagnostics, Place, Source};
use crate::random::Pcg;

/// Largest number of words, with those of definitions.
const MAX_WORDS: usize = 200_000;

/// Largest number of words before definitions are applied, and of those that they yield on the way.
const MAX_LOOKS: usize = 1_000_000;

/// Largest depth of definitions that use others.
const MAX_DEPTH: usize = 16;

/// A word, in lower case, and the place at which it stands in the text.
#[derive(Clone, Debug)]
pub(super) struct Word {
    pub(super) text: String,
    pub(super) place: Place,
}

impl Word {
    /// Returns the finite number that the word is: a decimal number or a fraction of whole ones, `2/3`.
    pub(super) fn number(&self) -> Option<f64> {
        let value = match self.text.split_once('/') {
            Some((above, below)) => {
                let [above, below] = [above, below].map(|it| it.parse::<i32>().ok());
                f64::from(above?) / f64::from(below?)
            }
            None => {
                // Names such as `inf` and `nan` are parsed as well.
                let is_start = |c: char| c.is_ascii_digit() || "+-.".contains(c);
                let digits = self.text.starts_with(is_start).then_some(&self.text)?;
                digits.parse().ok()?
            }
        };
        Some(value).filter(|value: &f64| value.is_finite())
    }
}

/// Scanner of a text.
struct Scanner<'a> {
    source: &'a Arc<Source>,
    words: Vec<Word>,
    /// Texts of the words that a definition stands for.
    defined: BTreeMap<String, Vec<String>>,
    /// Number of words that definitions have been applied to.
    looks: usize,
    random: Pcg,
    found: &'a mut Diagnostics,
}

/// Returns the words of a text. Definitions apply to the text behind them, and `random[a,b]` is a number that a generator
/// draws.
pub(super) fn words(source: &Arc<Source>, random: Pcg, found: &mut Diagnostics) -> Vec<Word> {
    let mut scanner = Scanner {
        source,
        words: Vec::new(),
        defined: BTreeMap::new(),
        looks: 0,
        random,
        found,
    };
    let text = source.text();
    let mut at = 0;
    while at < text.len() {
        let rest = &text[at..];
        let line = || at + rest.find(['\n', '\r']).unwrap_or(rest.len());
        if rest.starts_with("//") {
            at = line();
        } else if let Some(comment) = rest.strip_prefix("/*") {
            at = match comment.find("*/") {
                Some(length) => at + length + 4,
                None => {
                    let open = Diagnostic::error("this comment is not closed");
                    let place = Place::new(source, at..at + 2);
                    scanner.found.push(open.at(&place).hint("*/ closes it"));
                    return scanner.words;
                }
            };
        } else if rest.starts_with('#') && starts_line(text, at) && !is_colour(rest) {
            scanner.directive(at..line());
            at = line();
        } else {
            let length = length_of_word(rest);
            let place = Place::new(source, at..at + length);
            if !rest.starts_with(char::is_whitespace) {
                scanner.push(&rest[..length], &place, 0);
            }
            if scanner.words.len() > MAX_WORDS || scanner.looks > MAX_LOOKS {
                let long = format!("this program has more than {MAX_WORDS} words");
                scanner.found.push(Diagnostic::error(long).at(&place));
                return scanner.words;
            }
            at += length;
        }
    }
    scanner.words
}

fn starts_line(text: &str, at: usize) -> bool {
    let before = text[..at].trim_end_matches([' ', '\t']);
    before.is_empty() || before.ends_with(['\n', '\r'])
}

/// Returns whether a text begins with a colour in hexadecimal digits.
fn is_colour(text: &str) -> bool {
    let digits = &text[1..];
    let end = digits.find(|c: char| !c.is_ascii_hexdigit());
    let (digits, rest) = digits.split_at(end.unwrap_or(digits.len()));
    digits.len() >= 3 && !rest.starts_with(|c: char| c.is_alphanumeric())
}

/// Returns the length of the word at the start of a text: a blank, a sign, or all up to the next one, outside brackets.
fn length_of_word(text: &str) -> usize {
    let mut is_inside = false;
    for (at, character) in text.char_indices() {
        let is_end = character.is_whitespace() || "{}*>".contains(character);
        let is_comment = text[at..].starts_with("//") || text[at..].starts_with("/*");
        if is_inside && !matches!(character, '\n' | '\r' | '{' | '}') {
            is_inside = character != ']';
        } else if at == 0 && is_end {
            return character.len_utf8();
        } else if is_end || is_comment {
            return at;
        } else {
            is_inside = character == '[';
        }
    }
    text.len()
}

impl Scanner<'_> {
    /// Reads the line of a directive.
    fn directive(&mut self, range: Range<usize>) {
        let line = &self.source.text()[range.clone()];
        let line = line.split("//").next().unwrap_or(line);
        let place = Place::new(
            self.source,
            range.start..range.start + line.trim_end().len(),
        );
        let mut parts = line.split_whitespace();
        if parts.next().map(str::to_ascii_lowercase).as_deref() != Some("#define") {
            let other = Diagnostic::error("this directive is unknown").at(&place);
            self.found.push(other.hint("#define NAME VALUE"));
            return;
        }
        let Some(name) = parts.next() else {
            let nameless = Diagnostic::error("this defines no name").at(&place);
            self.found.push(nameless.hint("#define NAME VALUE"));
            return;
        };
        // A range such as (float:0-90) is that of a slider.
        let value = parts.take_while(|word| !is_slider(word));
        let value = value.collect::<Vec<_>>().join(" ");
        let mut words = Vec::new();
        let mut at = 0;
        while at < value.len() {
            let length = length_of_word(&value[at..]).max(1);
            let word = &value[at..at + length];
            if !word.trim().is_empty() {
                words.push(word.to_owned());
            }
            at += length;
        }
        self.defined.insert(name.to_owned(), words);
    }

    /// Appends a word, or the words that it stands for.
    fn push(&mut self, text: &str, place: &Place, depth: usize) {
        self.looks += 1;
        if self.words.len() > MAX_WORDS || self.looks > MAX_LOOKS {
            return;
        }
        let (sign, name) = match text.strip_prefix(['-', '+']) {
            Some(name) => (&text[..1], name),
            None => ("", text),
        };
        let defined = self.defined.get(text).map(|words| ("", words));
        let defined = defined.or_else(|| self.defined.get(name).map(|words| (sign, words)));
        if let Some((sign, words)) = defined {
            if depth == MAX_DEPTH {
                let message = format!("'{name}' is defined by itself");
                self.found.push(Diagnostic::error(message).at(place));
                return;
            }
            let words = words.clone();
            for (number, word) in words.iter().enumerate() {
                let sign = if number == 0 { sign } else { "" };
                let word = match (sign, word.strip_prefix('-')) {
                    ("-", Some(negative)) => negative.to_owned(),
                    _ => format!("{sign}{word}"),
                };
                self.push(&word, place, depth + 1);
            }
            return;
        }
        let text = text.to_lowercase();
        let text = self.drawn(&text).unwrap_or(text);
        self.words.push(Word {
            text,
            place: place.clone(),
        });
    }

    /// Returns a number from the range of `random[a,b]`.
    fn drawn(&mut self, text: &str) -> Option<String> {
        let (sign, range) = match text.strip_prefix('-') {
            Some(range) => (-1.0, range),
            None => (1.0, text),
        };
        let range = range.strip_prefix("random[")?.strip_suffix(']')?;
        let (first, last) = range.split_once(',')?;
        let [first, last] = [first, last].map(|it| it.trim().parse::<f64>().ok());
        let (first, last) = (first?, last?);
        let value = sign * (first + (last - first) * self.random.unit());
        let value = (value * 1e4).round() / 1e4;
        Some(value.to_string())
    }
}

fn is_slider(word: &str) -> bool {
    ["(float:", "(int:"].iter().any(|it| word.starts_with(it))
}
