//! Commands in the strings of Fractint's L-systems.

use crate::diagnostic::{Diagnostic, Diagnostics, Place};

use super::entries::Word;

/// A command of Fractint's manual (chapter "L-Systems").
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Command {
    /// `F` and `G`, or `D` and `M`: a step with a line or without, in the direction of one heading or the
    /// other.
    Step { heading: Heading, drawn: bool },
    /// `+` and `-`: a turn by the entry's angle, times 1 or −1.
    Turn(i8),
    /// `\nn` and `/nn`: a turn of the other heading by degrees, counter-clockwise or clockwise.
    Degrees(Factor),
    /// `|`: a half turn.
    Back,
    /// `!`: reverses the direction of all later turns.
    Reverse,
    /// `@nn`: multiplies the length of later steps.
    Scale(Factor),
    /// `[`: saves the state.
    Push,
    /// `]`: restores the state.
    Pop,
    /// `Cnn`: sets the colour index.
    Colour(i64),
    /// `<nn` and `>nn`: adds to the colour index, or subtracts from it.
    Shift { by: i64, down: bool },
    /// Any other character, which draws nothing.
    Other(char),
}

/// One of the turtle's two independent headings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Heading {
    /// Heading of `F`, `G`, `+`, `-` and `|`.
    Units,
    /// Heading of `D`, `M`, `\` and `/`.
    Degrees,
}

/// A number with the prefixes `I` (its inverse) or `Q` (its square root).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Factor {
    number: f64,
    inverse: bool,
    root: bool,
    negative: bool,
}

impl Factor {
    /// Formats the number as an expression.
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

    /// Returns whether the command before the number negates it: `/` does, `\` does not.
    pub(super) fn is_negative(self) -> bool {
        self.negative
    }

    /// Returns whether the number and its inverse, where it is taken, are finite.
    fn is_finite(self) -> bool {
        self.number.is_finite() && !(self.inverse && self.number == 0.0)
    }

    /// Returns the number as a colour index, truncated and saturating.
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

/// Returns the commands of a string, each with its place; errors are added to `found`.
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

/// Parses a number at the start of a text; returns it with its length. A missing number is 0, and text from a
/// second decimal point on is ignored.
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
