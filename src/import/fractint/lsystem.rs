//! L-systems: an angle, an axiom and rules, each in a line of its own or behind each other.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use crate::build::written::{Entries, sequence};
use crate::diagnostic::{Diagnostic, Diagnostics, Place};
use crate::document::node::Value;
use crate::style::Colour;

use super::commands::{self, Command, Heading};
use super::entries::{Entry, Word};
use super::palette;

/// Commands with numbers, which have no rules.
const RESERVED: &str = "/\\@C<>";

/// Other commands that are no letters: to have a rule, each needs an equals sign.
const COMMANDS: &str = "+-|![]";

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
    let axiom = balanced(commands::of(axiom, found), found);
    let mut rules = Rules::new();
    for (symbol, words) in &system.rules {
        let all = words.iter().flat_map(|word| commands::of(word, found));
        let all = all.collect();
        rules.push((*symbol, balanced(all, found)));
    }
    if found.has_errors() {
        return None;
    }
    // A rule that is never used says nothing.
    let used = used(&axiom, &rules);
    rules.retain(|(symbol, _)| used.contains(symbol));
    if rules.is_empty() {
        // Without rules every string is the axiom.
        let kept = axiom.iter().find(|command| symbol(**command).is_some());
        rules.extend(kept.and_then(|kept| Some((symbol(*kept)?, vec![*kept]))));
    }
    let writer = Writer::new(angle, &axiom, &rules);
    let productions = rules
        .iter()
        .fold(Entries::default(), |entries, (symbol, commands)| {
            entries.add(own(*symbol), Value::Text(writer.string(commands)))
        });
    let some = |entries: Entries| (!entries.is_empty()).then(|| entries.value());
    Some(
        Entries::default()
            .set("kind", Value::Text("lsystem".into()))
            .set("angle", Value::Text(format!("360/{angle}")))
            .set("axiom", Value::Text(writer.string(&axiom)))
            .set_some("productions", some(productions))
            .set_some("symbols", some(writer.symbols()))
            .set_some("style", writer.style()),
    )
}

/// Every rule's symbol, and what replaces it.
type Rules = Vec<(char, Vec<Command>)>;

/// The commands of a string, whose brackets must be balanced.
fn balanced(commands: Vec<(Command, Place)>, found: &mut Diagnostics) -> Vec<Command> {
    let mut open = Vec::new();
    let mut plain = Vec::new();
    for (command, place) in commands {
        match command {
            Command::Push => open.push(place),
            Command::Pop if open.pop().is_none() => {
                let wrong = Diagnostic::error("no bracket is open here").at(&place);
                found.push(wrong.hint("what a string closes, it has opened"));
            }
            _ => {}
        }
        plain.push(command);
    }
    for place in open {
        let wrong = Diagnostic::error("this bracket is not closed").at(&place);
        found.push(wrong.hint("it ends with ] in the same string"));
    }
    plain
}

/// The symbols that ever occur.
fn used(axiom: &[Command], rules: &Rules) -> BTreeSet<char> {
    let mut used = BTreeSet::new();
    let mut next = vec![axiom];
    while let Some(string) = next.pop() {
        for symbol in string.iter().filter_map(|command| symbol(*command)) {
            if used.insert(symbol) {
                let all = rules.iter().filter(|(of, _)| *of == symbol);
                next.extend(all.map(|(_, string)| string.as_slice()));
            }
        }
    }
    used
}

/// The character of a command without a number: what rules replace.
fn symbol(command: Command) -> Option<char> {
    Some(match command {
        Command::Step { heading, drawn } => letter(heading, drawn),
        Command::Turn(1) => '+',
        Command::Turn(_) => '-',
        Command::Back => '|',
        Command::Reverse => '!',
        Command::Push => '[',
        Command::Pop => ']',
        Command::Other(other) => other,
        Command::Degrees(_) | Command::Scale(_) | Command::Colour(_) | Command::Shift(_) => {
            return None;
        }
    })
}

/// Returns the symbol of kfrac's words for one of Fractint. Punctuation that words of kfrac split at becomes a
/// lower-case letter, for Fractint ignores case.
fn own(symbol: char) -> char {
    match symbol {
        '(' => 'a',
        ')' => 'b',
        ',' => 'c',
        '\'' => 'd',
        ':' => 'e',
        other => other,
    }
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
                    if !RESERVED.contains(symbol)
                        && (equals > 0 || (value.is_some() && !COMMANDS.contains(symbol))) =>
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
struct Writer<'c> {
    angle: u32,
    /// All commands there are.
    all: Vec<&'c Command>,
    /// The symbols that have rules.
    replaced: BTreeSet<char>,
    /// Which headings steps go by: turns of the other one change nothing.
    headings: [bool; 2],
    colours: Option<Colours>,
}

/// Which colours a palette has, by their numbers in Fractint's: the one first with which it begins.
enum Colours {
    /// These.
    Some(Vec<i64>),
    /// All: numbers are added to them.
    All,
}

impl<'c> Writer<'c> {
    fn new(angle: u32, axiom: &'c [Command], rules: &'c Rules) -> Self {
        let strings = rules.iter().flat_map(|(_, string)| string);
        let all: Vec<_> = axiom.iter().chain(strings).collect();
        let goes_by = |wanted: Heading| {
            all.iter().any(
                |command| matches!(command, Command::Step { heading, .. } if *heading == wanted),
            )
        };
        let headings = [Heading::Units, Heading::Degrees].map(goes_by);
        let shifts = |command: &&Command| matches!(command, Command::Shift(by) if *by != 0);
        let mut set = BTreeSet::new();
        for command in &all {
            if let Command::Colour(colour) = command {
                set.insert(colour.rem_euclid(palette::COLOURS));
            }
        }
        let colours = if all.iter().any(shifts) {
            Some(Colours::All)
        } else if set.is_empty() {
            None
        } else {
            set.remove(&palette::FIRST);
            Some(Colours::Some(
                [palette::FIRST].into_iter().chain(set).collect(),
            ))
        };
        Self {
            angle,
            all,
            replaced: rules.iter().map(|(symbol, _)| *symbol).collect(),
            headings,
            colours,
        }
    }

    /// Whether steps go by both headings, so that the second one is our second one.
    fn has_both(&self) -> bool {
        self.headings == [true; 2]
    }

    /// Whether turns by degrees have a symbol of their own: where `+` and `-` have other meanings.
    fn has_slashes(&self) -> bool {
        let is_replaced = ['+', '-'].iter().any(|sign| self.replaced.contains(sign));
        self.has_both() || is_replaced
    }

    fn string(&self, commands: &[Command]) -> String {
        let mut string = String::new();
        let [units, degrees] = self.headings;
        for command in commands {
            let written = match *command {
                // These turn what nothing goes by.
                Command::Degrees(_) if !degrees => Ok(()),
                Command::Turn(_) | Command::Back if !units && !self.is_replaced(*command) => Ok(()),
                Command::Degrees(turn) => {
                    let formula = turn.formula();
                    match formula.strip_prefix('-') {
                        _ if self.has_slashes() => write!(string, "/({formula})"),
                        Some(clockwise) => write!(string, "-({clockwise})"),
                        None => write!(string, "+({formula})"),
                    }
                }
                Command::Scale(factor) => write!(string, "@({})", factor.formula()),
                Command::Colour(colour) => write!(string, "'({})", self.colour(colour)),
                Command::Shift(0) => Ok(()),
                Command::Shift(shift) => write!(string, ";({shift})"),
                other => symbol(other).map_or(Ok(()), |symbol| string.write_char(own(symbol))),
            };
            debug_assert!(written.is_ok(), "a string takes everything");
        }
        string
    }

    fn is_replaced(&self, command: Command) -> bool {
        symbol(command).is_some_and(|symbol| self.replaced.contains(&symbol))
    }

    /// The number of a colour in our palette.
    fn colour(&self, colour: i64) -> usize {
        let number = colour.rem_euclid(palette::COLOURS);
        let place = match &self.colours {
            Some(Colours::Some(all)) => all.iter().position(|known| *known == number),
            _ => usize::try_from((number - palette::FIRST).rem_euclid(palette::COLOURS)).ok(),
        };
        place.unwrap_or(0)
    }

    /// What symbols mean, where it is not what they always do.
    fn symbols(&self) -> Entries {
        let text = |text: &str| Value::Text(text.into());
        let action = |name: &str, value: &str| Entries::default().set(name, text(value)).value();
        let swapped = |value: Value| sequence([text("swap"), value, text("swap")]);
        let turns_back = self.angle % 2 == 1 && self.headings[0];
        let reverses = self.all.contains(&&Command::Reverse);
        let mut symbols = Entries::default();
        for &&command in &self.all {
            let meaning = match command {
                Command::Step { heading, drawn } => {
                    let meaning = text(if drawn { "draw" } else { "move" });
                    match heading {
                        Heading::Units if drawn => continue,
                        Heading::Degrees if self.has_both() => swapped(meaning),
                        _ => meaning,
                    }
                }
                Command::Turn(_) | Command::Back if !self.headings[0] => {
                    if !self.is_replaced(command) {
                        continue;
                    }
                    text("nothing")
                }
                // The largest turn below a half one, always the same way.
                Command::Back if turns_back => {
                    let turn = format!("-180 + 180/{}", self.angle);
                    action(if reverses { "rotate" } else { "turn" }, &turn)
                }
                Command::Degrees(_) if self.has_both() => swapped(action("turn", "a")),
                Command::Degrees(_) if self.headings[1] && self.has_slashes() => {
                    action("turn", "a")
                }
                Command::Reverse => text("reflect"),
                Command::Scale(_) => action("scale", "s"),
                Command::Shift(by) if by != 0 => action("shift_colour", "n"),
                Command::Other('{' | '}' | '.' | '&' | '^') => text("nothing"),
                _ => continue,
            };
            let name = match command {
                Command::Degrees(_) => "/(a)".into(),
                Command::Scale(_) => "@(s)".into(),
                Command::Shift(_) => ";(n)".into(),
                other => symbol(other).map(own).into_iter().collect::<String>(),
            };
            symbols = symbols.set(&name, meaning);
        }
        symbols
    }

    /// The colours, on black as Fractint draws.
    fn style(&self) -> Option<Value> {
        let numbers: Vec<i64> = match self.colours.as_ref()? {
            Colours::Some(all) => all.clone(),
            Colours::All => (0..palette::COLOURS)
                .map(|place| palette::FIRST + place)
                .collect(),
        };
        let text = |colour: Colour| Value::Text(colour.to_string());
        let colours = numbers.into_iter().map(|number| text(palette::vga(number)));
        let style = Entries::default().set("background", text(Colour::BLACK));
        Some(style.set("palette", sequence(colours)).value())
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
