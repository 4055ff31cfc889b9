//! Mutations that leave much of a rule file intact: words, bracketed groups and lines are repeated, removed,
//! exchanged, or replaced by pieces of the dictionary.

use std::ops::Range;

use crate::random::Random;

/// Returns the text with up to three mutations.
pub fn mutated(text: &str, random: &mut Random) -> String {
    let mut text = text.to_owned();
    for _ in 0..=random.below(3) {
        let stretches = match random.below(4) {
            0 => lines(&text),
            1 => groups(&text),
            _ => words(&text),
        };
        let (Some(at), Some(other)) = (random.one_of(&stretches), random.one_of(&stretches)) else {
            continue;
        };
        let other = text[other].to_owned();
        match random.below(6) {
            0 => text.replace_range(at, ""),
            1 => text.insert_str(at.end, &other),
            2 => {
                let piece = piece(random);
                text.insert_str(at.end, &piece);
            }
            3 => {
                let piece = piece(random);
                text.replace_range(at, &piece);
            }
            4 if text[at.clone()].starts_with(['[', '{']) => {
                text.insert_str(at.end, &format!(", {other}"));
            }
            _ => text.replace_range(at, &other),
        }
    }
    text
}

fn lines(text: &str) -> Vec<Range<usize>> {
    let mut start = 0;
    let lines = text.split_inclusive('\n').map(|line| {
        start += line.len();
        start - line.len()..start
    });
    lines.collect()
}

/// Returns the ranges of bracketed groups, including the brackets.
fn groups(text: &str) -> Vec<Range<usize>> {
    let mut open = Vec::new();
    let mut groups = Vec::new();
    for (at, character) in text.char_indices() {
        match character {
            '[' | '{' | '(' => open.push(at),
            ']' | '}' | ')' => groups.extend(open.pop().map(|start| start..at + 1)),
            _ => {}
        }
    }
    groups
}

/// Returns the ranges of names and numbers.
fn words(text: &str) -> Vec<Range<usize>> {
    let in_word = |c: char| c.is_alphanumeric() || "_.".contains(c);
    let mut words: Vec<Range<usize>> = Vec::new();
    for (at, character) in text.char_indices().filter(|(_, c)| in_word(*c)) {
        let end = at + character.len_utf8();
        match words.last_mut() {
            Some(word) if word.end == at => word.end = end,
            _ => words.push(at..end),
        }
    }
    words
}

fn piece(random: &mut Random) -> String {
    let pieces: Vec<&str> = include_str!("../rule.dict")
        .lines()
        .filter_map(|line| line.strip_prefix('"')?.strip_suffix('"'))
        .collect();
    let piece = random.one_of(&pieces).unwrap_or_default();
    piece.replace("\\x0a", "\n").replace("\\x22", "\"")
}
