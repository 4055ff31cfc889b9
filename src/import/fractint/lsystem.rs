//! L-systems: an angle, an axiom and rules, each in a line of its own or behind each other.

use std::fmt::Write as _;

use crate::build::written::Entries;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::node::Value;

use super::commands::{self, Command, Heading};
use super::entries::{Entry, Word};

/// Symbols that have no rules.
const RESERVED: &str = "+-/\\@|!C<>[]";

/// What an entry says.
#[derive(Default)]
struct System<'e> {
    /// Turns are 360 degrees divided by it.
    angle: Option<u32>,
    axiom: Option<&'e Word>,
    /// Every rule's symbol, and the strings that make it up.
    rules: Vec<(char, Vec<&'e Word>)>,
}

pub(super) fn write(entry: &Entry, found: &mut Diagnostics) -> Option<Entries> {
    let system = System::read(entry, found);
    let missing =
        |what: &str| Diagnostic::error(format!("{} has no {what}", entry.name)).at(&entry.place);
    if system.axiom.is_none() {
        found.push(missing("axiom"));
    }
    if system.angle.is_none() && !found.has_errors() {
        found.push(missing("angle").hint("Angle 6 stands for turns of a sixth of the circle"));
    }
    let (angle, axiom) = (system.angle?, system.axiom?);
    let axiom = commands::of(axiom, found);
    let rules = system.rules.iter().map(|(symbol, words)| {
        let commands = words.iter().flat_map(|word| commands::of(word, found));
        (*symbol, commands.collect::<Vec<_>>())
    });
    let rules: Vec<_> = rules.collect();
    let all = || {
        axiom
            .iter()
            .chain(rules.iter().flat_map(|(_, commands)| commands))
    };
    let writer = Writer::new(entry, angle, all(), found)?;
    let productions = rules
        .iter()
        .fold(Entries::default(), |entries, (symbol, commands)| {
            entries.add(*symbol, Value::Text(writer.string(commands)))
        });
    let symbols = writer.symbols(all());
    let some = |entries: Entries| (!entries.is_empty()).then(|| entries.value());
    Some(
        Entries::default()
            .set("kind", Value::Text("lsystem".into()))
            .set("angle", Value::Text(format!("360/{angle}")))
            .set("axiom", Value::Text(writer.string(&axiom)))
            .set_some("productions", some(productions))
            .set_some("symbols", some(symbols)),
    )
}

impl<'e> System<'e> {
    fn read(entry: &'e Entry, found: &mut Diagnostics) -> Self {
        let mut system = Self::default();
        let mut words = entry.words.as_slice();
        while let [word, rest @ ..] = words {
            let equals = rest.iter().take_while(|word| word.text == "=").count();
            let rest = &rest[equals..];
            // What follows is its value, unless it begins something else.
            let begins = |rest: &[Word]| match rest {
                [next, behind @ ..] => {
                    next.starts_line || behind.first().is_some_and(|word| word.text == "=")
                }
                [] => true,
            };
            let (value, behind) = match rest {
                [value, behind @ ..] if !begins(rest) => (Some(value), behind),
                _ => (None, rest),
            };
            let mut characters = word.text.chars();
            let letter = characters.next().filter(|_| characters.next().is_none());
            words = behind;
            match (word.text.as_str(), letter, value) {
                ("AXIOM", _, Some(axiom)) => system.axiom = Some(axiom),
                ("ANGLE", _, Some(angle)) => system.set_angle(angle, found),
                ("AXIOM" | "ANGLE", _, None) => {
                    let message = format!("{} says nothing", word.text.to_ascii_lowercase());
                    found.push(Diagnostic::error(message).at(&word.place));
                }
                (_, Some(symbol), _) if equals > 0 && RESERVED.contains(symbol) => {
                    let message = format!("{symbol} is a command and has no rule");
                    found.push(Diagnostic::error(message).at(&word.place));
                }
                (_, Some(symbol), _)
                    if !RESERVED.contains(symbol) && (equals > 0 || value.is_some()) =>
                {
                    system.add_rule(symbol, value);
                }
                _ => {
                    let message = format!("'{}' is not understood", word.written());
                    let place = Diagnostic::error(message).at(&word.place);
                    found
                        .push(place.hint(
                            "a line says Angle n, Axiom string, or X=string, without blanks",
                        ));
                    words = &entry.words[entry.words.len() - rest.len()..];
                }
            }
        }
        system
    }

    fn set_angle(&mut self, word: &Word, found: &mut Diagnostics) {
        match word.text.parse() {
            Ok(angle @ 3..) => self.angle = Some(angle),
            _ => {
                let wrong = format!(
                    "the angle '{}' is not a whole number from 3",
                    word.written()
                );
                found.push(Diagnostic::error(wrong).at(&word.place));
            }
        }
    }

    /// Several rules of one symbol are one, in parts.
    fn add_rule(&mut self, symbol: char, value: Option<&'e Word>) {
        match self.rules.iter_mut().find(|(known, _)| *known == symbol) {
            Some((_, words)) => words.extend(value),
            None => self.rules.push((symbol, value.into_iter().collect())),
        }
    }
}

/// Writes commands as a file of ours has them.
struct Writer {
    angle: u32,
    /// The heading that steps go by; turns of the other one change nothing.
    heading: Heading,
}

impl Writer {
    fn new<'c>(
        entry: &Entry,
        angle: u32,
        all: impl Iterator<Item = &'c Command> + Clone,
        found: &mut Diagnostics,
    ) -> Option<Self> {
        let steps = |wanted: Heading| {
            all.clone().any(
                |command| matches!(command, Command::Step { heading, .. } if *heading == wanted),
            )
        };
        let error = |message: &str| Diagnostic::error(message).at(&entry.place);
        let heading = match (steps(Heading::Units), steps(Heading::Degrees)) {
            (true, true) => {
                let two = error("F or G and D or M have headings of their own");
                found.push(two.hint("here there is only one: write it with F, G, + and - alone"));
                return None;
            }
            (false, true) => Heading::Degrees,
            _ => Heading::Units,
        };
        let writer = Self { angle, heading };
        let any = |wanted: fn(&Command) -> bool| all.clone().any(wanted);
        let turns_back = angle % 2 == 1 && any(|command| *command == Command::Back);
        if turns_back && any(|command| *command == Command::Reverse) && heading == Heading::Units {
            let message = "| of an odd angle always turns the same way, also after !";
            found.push(error(message).hint("here ! reverses it too"));
            return None;
        }
        for command in all.clone() {
            if matches!(command, Command::Other('(' | ')' | ',' | '\'')) {
                found.push(error("parentheses, commas and quotes cannot be symbols"));
                return None;
            }
        }
        let colours = any(|command| matches!(command, Command::Colour(_) | Command::Shift(_)));
        if colours && any(|command| *command == Command::Push) {
            let message = "colours are taken back at ], as headings are";
            found.push(Diagnostic::warning(message).at(&entry.place));
        }
        if any(|command| matches!(command, Command::Degrees(_))) && heading == Heading::Units {
            let message = "\\ and / do not turn F and G: they are left out";
            found.push(Diagnostic::warning(message).at(&entry.place));
        }
        Some(writer)
    }

    fn string(&self, commands: &[Command]) -> String {
        let mut string = String::new();
        for command in commands {
            let written = match (*command, self.heading) {
                (Command::Step { heading, drawn }, _) => {
                    string.push(letter(heading, drawn));
                    Ok(())
                }
                (Command::Turn(1), Heading::Units) => string.write_str("+"),
                (Command::Turn(_), Heading::Units) => string.write_str("-"),
                (Command::Back, Heading::Units) => string.write_str("|"),
                (Command::Degrees(degrees), Heading::Degrees) if degrees < 0.0 => {
                    write!(string, "-({})", -degrees)
                }
                (Command::Degrees(degrees), Heading::Degrees) => write!(string, "+({degrees})"),
                // These turn what nothing goes by.
                (Command::Turn(_) | Command::Back | Command::Degrees(_), _) => Ok(()),
                (Command::Reverse, _) => string.write_str("!"),
                (Command::Scale(factor), _) => write!(string, "@({})", factor.formula()),
                (Command::Push, _) => string.write_str("["),
                (Command::Pop, _) => string.write_str("]"),
                (Command::Colour(colour), _) => write!(string, "'({colour})"),
                (Command::Shift(shift), _) => write!(string, ";({shift})"),
                (Command::Other(other), _) => string.write_char(other),
            };
            debug_assert!(written.is_ok(), "a string takes everything");
        }
        string
    }

    /// What symbols mean, where it is not what they always do.
    fn symbols<'c>(&self, all: impl Iterator<Item = &'c Command>) -> Entries {
        let text = |text: &str| Value::Text(text.into());
        let action = |name: &str, value: &str| Entries::default().set(name, text(value)).value();
        all.fold(Entries::default(), |symbols, command| match *command {
            Command::Step { heading, drawn } if (heading, drawn) != (Heading::Units, true) => {
                let meaning = if drawn { "draw" } else { "move" };
                symbols.set(&letter(heading, drawn).to_string(), text(meaning))
            }
            Command::Back if self.angle % 2 == 1 && self.heading == Heading::Units => {
                let turn = format!("-180 + 180/{}", self.angle);
                symbols.set("|", action("turn", &turn))
            }
            Command::Reverse => symbols.set("!", text("reflect")),
            Command::Scale(_) => symbols.set("@(s)", action("scale", "s")),
            Command::Shift(_) => symbols.set(";(n)", action("shift_colour", "n")),
            Command::Other(other @ ('{' | '}' | '.' | '&' | '^')) => {
                symbols.set(&other.to_string(), text("nothing"))
            }
            _ => symbols,
        })
    }
}

fn letter(heading: Heading, drawn: bool) -> char {
    match (heading, drawn) {
        (Heading::Units, true) => 'F',
        (Heading::Units, false) => 'G',
        (Heading::Degrees, true) => 'D',
        (Heading::Degrees, false) => 'M',
    }
}
