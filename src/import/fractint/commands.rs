//! The commands of which the strings of L-systems are made.

use crate::diagnostic::{Diagnostic, Diagnostics, Place};

use super::entries::Word;

/// A command, as Fractint's manual has it (chapter "L-Systems").
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Command {
    /// `F` and `G`, or `D` and `M`: a step that is drawn or not, by the one heading or the other.
    Step { heading: Heading, drawn: bool },
    /// `+` and `-`, by the entry's angle; the factor is 1 or -1.
    Turn(i8),
    /// `\nn` and `/nn`: degrees, counter-clockwise, of the other heading.
    Degrees(Factor),
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
    Colour(i64),
    /// `<nn` and `>nn`: what is added to the number of the colour, or taken from it.
    Shift { by: i64, down: bool },
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
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Factor {
    number: f64,
    inverse: bool,
    root: bool,
    negative: bool,
}

impl Factor {
    /// As a formula.
    pub(super) fn formula(self) -> String {
        let number = self.number;
        let formula = match (self.inverse, self.root) {
            (false, false) => format!("{number}"),
            (false, true) => format!("sqrt({number})"),
            (true, false) => format!("1/{number}"),
            (true, true) => format!("1/sqrt({number})"),
        };
        match self.negative && number != 0.0 {
            true => format!("-{formula}"),
            false => formula,
        }
    }

    /// Whether the command before it turns it round: `/` does, `\` does not.
    pub(super) fn is_negative(self) -> bool {
        self.negative
    }

    /// Whether it is a number.
    fn is_finite(self) -> bool {
        self.number.is_finite() && !(self.inverse && self.number == 0.0)
    }

    /// The number of a colour.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "casts from floats saturate"
    )]
    fn whole(self) -> i64 {
        let number = if self.root {
            self.number.sqrt()
        } else {
            self.number
        };
        let number = if self.inverse { number.recip() } else { number };
        number as i64
    }
}

/// The commands of a string, each with its place; what is wrong in it is said.
pub(super) fn of(word: &Word, found: &mut Diagnostics) -> Vec<(Command, Place)> {
    let mut commands = Vec::new();
    let mut at = 0;
    while let Some(command) = word.text[at..].chars().next() {
        let start = at;
        at += command.len_utf8();
        let mut number = || {
            let (factor, length) = factor(&word.text[at..]);
            at += length;
            factor
        };
        let understood = match command {
            'F' | 'G' | 'D' | 'M' => Command::Step {
                heading: match command {
                    'F' | 'G' => Heading::Units,
                    _ => Heading::Degrees,
                },
                drawn: matches!(command, 'F' | 'D'),
            },
            '+' => Command::Turn(1),
            '-' => Command::Turn(-1),
            '|' => Command::Back,
            '!' => Command::Reverse,
            '[' => Command::Push,
            ']' => Command::Pop,
            '\\' => Command::Degrees(number()),
            '/' => Command::Degrees(Factor {
                negative: true,
                ..number()
            }),
            '@' => Command::Scale(number()),
            'C' => Command::Colour(number().whole()),
            '<' | '>' => Command::Shift {
                by: number().whole(),
                down: command == '>',
            },
            other => Command::Other(other),
        };
        let place = word.part(start..at);
        let wrong = match understood {
            Command::Scale(factor) if factor.number <= 0.0 || !factor.is_finite() => {
                Some("@ takes a number above 0")
            }
            Command::Degrees(factor) if !factor.is_finite() => Some("this angle is not finite"),
            _ => None,
        };
        if let Some(wrong) = wrong {
            let mistake = Diagnostic::error(wrong).at(&place);
            found.push(mistake.hint("@2 doubles steps, @I2 halves them, @Q2 takes a root"));
        }
        commands.push((understood, place));
    }
    commands
}

/// A number at the start of a text, and its length: nothing there is 0, and what comes behind a second
/// point does not count.
fn factor(text: &str) -> (Factor, usize) {
    let letters = text.len() - text.trim_start_matches(['I', 'Q']).len();
    let digits = &text[letters..];
    let length = digits
        .find(|c: char| !c.is_ascii_digit() && c != '.')
        .unwrap_or(digits.len());
    let digits = &digits[..length];
    let mut points = digits.match_indices('.').skip(1);
    let second = points.next().map_or(length, |(at, _)| at);
    let has = |letter| text[..letters].contains(letter);
    let factor = Factor {
        number: digits[..second].parse().unwrap_or(0.0),
        inverse: has('I'),
        root: has('Q'),
        negative: false,
    };
    (factor, letters + length)
}
