//! The commands of which the strings of L-systems are made.

use crate::diagnostic::{Diagnostic, Diagnostics};

use super::entries::Word;

/// A command, as Fractint's manual has it (chapter "L-Systems").
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Command {
    /// `F` and `G`, or `D` and `M`: a step that is drawn or not, by the one heading or the other.
    Step { heading: Heading, drawn: bool },
    /// `+` and `-`, by the entry's angle; the factor is 1 or -1.
    Turn(i8),
    /// `\nn` and `/nn`: degrees, counter-clockwise, of the other heading.
    Degrees(f64),
    /// `|`
    Back,
    /// `!`: from here on turns go the other way.
    Reverse,
    /// `@nn`: what steps are multiplied with from here on.
    Scale(Factor),
    /// `[`
    Push,
    /// `]`
    Pop,
    /// `Cnn`
    Colour(f64),
    /// `<nn` and `>nn`
    Shift(f64),
    /// Anything else draws nothing.
    Other(char),
}

/// The turtle has two headings that know nothing of each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Heading {
    /// That of `F`, `G`, `+`, `-` and `|`.
    Units,
    /// That of `D`, `M`, `\` and `/`.
    Degrees,
}

/// A number with `I` (its inverse) or `Q` (its root) before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Factor {
    number: f64,
    inverse: bool,
    root: bool,
}

impl Factor {
    /// As a formula.
    pub(super) fn formula(self) -> String {
        let number = self.number;
        match (self.inverse, self.root) {
            (false, false) => format!("{number}"),
            (false, true) => format!("sqrt({number})"),
            (true, false) => format!("1/{number}"),
            (true, true) => format!("1/sqrt({number})"),
        }
    }
}

/// The commands of a string; what is wrong in it is said.
pub(super) fn of(word: &Word, found: &mut Diagnostics) -> Vec<Command> {
    let mut commands = Vec::new();
    let mut at = 0;
    while let Some(command) = word.text[at..].chars().next() {
        let start = at;
        at += command.len_utf8();
        let mut takes_number = || {
            let (factor, length) = factor(&word.text[at..]);
            at += length;
            factor
        };
        let plain = |factor: Factor| (!factor.inverse && !factor.root).then_some(factor.number);
        let understood = match command {
            'F' | 'G' | 'D' | 'M' => Some(Command::Step {
                heading: match command {
                    'F' | 'G' => Heading::Units,
                    _ => Heading::Degrees,
                },
                drawn: matches!(command, 'F' | 'D'),
            }),
            '+' => Some(Command::Turn(1)),
            '-' => Some(Command::Turn(-1)),
            '|' => Some(Command::Back),
            '!' => Some(Command::Reverse),
            '[' => Some(Command::Push),
            ']' => Some(Command::Pop),
            '\\' => takes_number().and_then(plain).map(Command::Degrees),
            '/' => takes_number()
                .and_then(plain)
                .map(|degrees| Command::Degrees(-degrees)),
            '@' => takes_number()
                .filter(|factor| factor.number > 0.0)
                .map(Command::Scale),
            'C' => takes_number().and_then(plain).map(Command::Colour),
            '<' => takes_number().and_then(plain).map(Command::Shift),
            '>' => takes_number()
                .and_then(plain)
                .map(|shift| Command::Shift(-shift)),
            other => Some(Command::Other(other)),
        };
        match understood {
            Some(command) => commands.push(command),
            None => {
                let message = format!("{command} takes a number");
                found.push(Diagnostic::error(message).at(&word.part(start..at)));
            }
        }
    }
    commands
}

/// A number at the start of a text, and its length.
fn factor(text: &str) -> (Option<Factor>, usize) {
    let letters = text.len() - text.trim_start_matches(['I', 'Q']).len();
    let digits = &text[letters..];
    let length = digits
        .find(|c: char| !c.is_ascii_digit() && c != '.')
        .unwrap_or(digits.len());
    let has = |letter| text[..letters].contains(letter);
    let number = digits[..length].parse().ok();
    let factor = number.map(|number| Factor {
        number,
        inverse: has('I'),
        root: has('Q'),
    });
    (factor.filter(|_| letters <= 2), letters + length)
}
