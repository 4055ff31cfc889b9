//! Conversion of Fractint's L-systems: an angle, an axiom and rules, on lines of their own or one after
//! another.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use crate::build::written::{Entries, sequence};
use crate::diagnostic::{Diagnostic, Diagnostics, Place};
use crate::document::node::Value;
use crate::style::Colour;

use super::commands::{self, Command, Heading};
use super::entries::{Entry, Word};
use super::palette;

/// Commands with numbers, and those that are not letters; a rule of one of them needs an equals sign.
const COMMANDS: &str = "+-|![]/\\@C<>";

/// Content of an entry.
#[derive(Default)]
struct LSystemEntry<'e> {
    /// Divisor of 360 degrees that gives the angle of a turn.
    angle: Option<u32>,
    axiom: Option<&'e Word>,
    /// Rules: the symbol of each, and the strings that its successor consists of.
    rules: Vec<(char, Vec<&'e Word>)>,
}

pub(in crate::import) fn write(entry: &Entry, found: &mut Diagnostics) -> Option<Entries> {
    let system = LSystemEntry::read(entry, found);
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
    // Rules of symbols that never occur are left out.
    let used = used(&axiom, &rules);
    rules.retain(|(symbol, _)| used.contains(symbol));
    if rules.is_empty() {
        // Without rules every word is the axiom: a symbol that replaces itself keeps it.
        let is_kept = |command: &&Command| {
            argument(**command).is_none() && !matches!(command, Command::Push | Command::Pop)
        };
        let kept = axiom.iter().find(is_kept);
        rules.extend(kept.map(|kept| (symbol(*kept), vec![*kept])));
    }
    let writer = Writer::new(angle, &axiom, &rules);
    let productions = rules
        .iter()
        .fold(Entries::default(), |entries, (symbol, commands)| {
            entries.add(
                writer.predecessor(*symbol),
                Value::Text(writer.string(commands)),
            )
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

/// Rules: the symbol of each, and the commands that replace it.
type Rules = Vec<(char, Vec<Command>)>;

/// Returns the commands of a string, and reports brackets that are not balanced.
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

/// Returns the symbols that occur in some word.
fn used(axiom: &[Command], rules: &Rules) -> BTreeSet<char> {
    let mut used = BTreeSet::new();
    let mut next = vec![axiom];
    while let Some(string) = next.pop() {
        for symbol in string.iter().map(|command| symbol(*command)) {
            if used.insert(symbol) {
                let all = rules.iter().filter(|(of, _)| *of == symbol);
                next.extend(all.map(|(_, string)| string.as_slice()));
            }
        }
    }
    used
}

/// Returns the character of a command, by which rules replace it regardless of its number.
fn symbol(command: Command) -> char {
    match command {
        Command::Step { heading, drawn } => letter(heading, drawn),
        Command::Turn(1) => '+',
        Command::Turn(_) => '-',
        Command::Degrees(turn) if turn.is_negative() => '/',
        Command::Degrees(_) => '\\',
        Command::Back => '|',
        Command::Reverse => '!',
        Command::Scale(_) => '@',
        Command::Push => '[',
        Command::Pop => ']',
        Command::Colour(_) => 'C',
        Command::Shift { down: false, .. } => '<',
        Command::Shift { down: true, .. } => '>',
        Command::Other(other) => other,
    }
}

/// Returns the name of the argument that a command's number becomes.
fn argument(command: Command) -> Option<char> {
    match command {
        Command::Degrees(_) => Some('a'),
        Command::Scale(_) => Some('s'),
        Command::Colour(_) | Command::Shift { .. } => Some('n'),
        _ => None,
    }
}

/// Returns the symbol of kfrac's words for one of Fractint. Punctuation that words of kfrac split at, and
/// commands that kfrac writes otherwise, become lower-case letters, for Fractint ignores case.
fn own(symbol: char) -> char {
    match symbol {
        '(' => 'a',
        ')' => 'b',
        ',' => 'c',
        '\'' => 'd',
        ':' => 'e',
        '\\' => '/',
        '/' => 'g',
        'C' => '\'',
        '<' => ';',
        '>' => 'h',
        other => other,
    }
}

impl<'e> LSystemEntry<'e> {
    fn read(entry: &'e Entry, found: &mut Diagnostics) -> Self {
        let mut system = Self::default();
        let mut words = entry.words.as_slice();
        while let [word, rest @ ..] = words {
            let equals = rest.iter().take_while(|word| word.text == "=").count();
            let rest = &rest[equals..];
            // The next word is the value, unless it begins another definition.
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
                    let message = format!("{} has no value", word.text.to_ascii_lowercase());
                    found.push(Diagnostic::error(message).at(&word.place));
                }
                (_, Some(symbol), _)
                    if equals > 0 || (value.is_some() && !COMMANDS.contains(symbol)) =>
                {
                    system.add_rule(symbol, value);
                }
                _ => {
                    let message = format!("'{}' is not understood", word.written());
                    let place = Diagnostic::error(message).at(&word.place);
                    found.push(
                        place.hint("a line is Angle n, Axiom string, or X=string, without blanks"),
                    );
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

    /// Adds a rule. Several rules of one symbol are joined, as parts of one string.
    fn add_rule(&mut self, symbol: char, value: Option<&'e Word>) {
        match self.rules.iter_mut().find(|(known, _)| *known == symbol) {
            Some((_, words)) => words.extend(value),
            None => self.rules.push((symbol, value.into_iter().collect())),
        }
    }
}

/// Writer of commands in the notation of kfrac.
struct Writer<'c> {
    angle: u32,
    /// Commands of the axiom and of all rules.
    all: Vec<&'c Command>,
    /// Symbols that have rules.
    replaced: BTreeSet<char>,
    /// Whether any step uses the first and the second heading; turns of an unused heading have no effect.
    headings: [bool; 2],
    colours: Option<Colours>,
}

/// Colours of the palette, by their indices in Fractint's; the initial colour comes first.
enum Colours {
    /// The colours with these indices.
    Some(Vec<i64>),
    /// All colours, because commands add to the index.
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
        let shifts = |command: &&Command| matches!(command, Command::Shift { by, .. } if *by != 0);
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

    /// Returns whether steps use both headings; the second one then becomes the turtle's second heading.
    fn has_both(&self) -> bool {
        self.headings == [true; 2]
    }

    /// Returns whether turns by degrees need symbols of their own: where steps use both headings, or a turn
    /// has a rule.
    fn has_slashes(&self) -> bool {
        let mut turns = ['+', '-', '/', '\\'].iter();
        self.has_both() || turns.any(|turn| self.replaced.contains(turn))
    }

    /// Returns whether a command and its opposite have symbols of their own, for a rule replaces one of them.
    /// Elsewhere one symbol, with numbers of both signs, serves both.
    fn is_apart(&self, command: Command) -> bool {
        let pair = match command {
            Command::Degrees(_) => ['/', '\\'],
            Command::Shift { .. } => ['<', '>'],
            _ => return false,
        };
        pair.iter().any(|symbol| self.replaced.contains(symbol))
    }

    /// Returns the symbol of a command in words.
    fn name(&self, command: Command) -> char {
        match command {
            Command::Degrees(_) if !self.is_apart(command) => '/',
            Command::Shift { .. } if !self.is_apart(command) => ';',
            other => own(symbol(other)),
        }
    }

    fn string(&self, commands: &[Command]) -> String {
        let mut string = String::new();
        for command in commands {
            let (command, name) = (*command, self.name(*command));
            let written = match command {
                Command::Degrees(_)
                | Command::Turn(_)
                | Command::Back
                | Command::Shift { by: 0, .. }
                    if !self.is_replaced(command) && !self.acts(command) =>
                {
                    Ok(())
                }
                Command::Degrees(turn) => {
                    let formula = turn.formula();
                    match formula.strip_prefix('-') {
                        _ if self.has_slashes() => write!(string, "{name}({formula})"),
                        Some(clockwise) => write!(string, "-({clockwise})"),
                        None => write!(string, "+({formula})"),
                    }
                }
                Command::Scale(factor) => write!(string, "{name}({})", factor.formula()),
                Command::Colour(colour) => write!(string, "{name}({})", self.colour(colour)),
                Command::Shift { by, down: false } => write!(string, "{name}({by})"),
                Command::Shift { by, down: true } => write!(string, "{name}({})", -by),
                _ => string.write_char(name),
            };
            debug_assert!(written.is_ok(), "a string takes everything");
        }
        string
    }

    /// Returns whether a turn changes a heading that steps go by, and a change of the colour the colour.
    fn acts(&self, command: Command) -> bool {
        let [units, degrees] = self.headings;
        match command {
            Command::Turn(_) | Command::Back => units,
            Command::Degrees(_) => degrees,
            Command::Shift { by, .. } => by != 0,
            _ => true,
        }
    }

    fn is_replaced(&self, command: Command) -> bool {
        self.replaced.contains(&symbol(command))
    }

    /// Returns the predecessor of a production: a symbol, with the name of its argument if it has one.
    fn predecessor(&self, replaced: char) -> String {
        let command = self
            .all
            .iter()
            .find(|command| symbol(***command) == replaced);
        let argument = command.and_then(|command| argument(**command));
        let name = own(replaced);
        argument.map_or_else(|| name.into(), |argument| format!("{name}({argument})"))
    }

    /// Returns the index of a colour in the palette that is written.
    fn colour(&self, colour: i64) -> usize {
        let number = colour.rem_euclid(palette::COLOURS);
        let place = match &self.colours {
            Some(Colours::Some(all)) => all.iter().position(|known| *known == number),
            _ => usize::try_from((number - palette::FIRST).rem_euclid(palette::COLOURS)).ok(),
        };
        place.unwrap_or(0)
    }

    /// Returns the meanings of symbols that differ from the default ones.
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
                // The largest multiple of the angle below a half turn, in the same direction always.
                Command::Back if turns_back => {
                    let turn = format!("-180 + 180/{}", self.angle);
                    action(if reverses { "rotate" } else { "turn" }, &turn)
                }
                Command::Degrees(_) if !self.acts(command) => {
                    if !self.is_replaced(command) {
                        continue;
                    }
                    text("nothing")
                }
                Command::Degrees(_) if self.has_both() => swapped(action("turn", "a")),
                Command::Degrees(_) if self.has_slashes() => action("turn", "a"),
                Command::Reverse => text("reflect"),
                Command::Scale(_) => action("scale", "s"),
                Command::Shift { .. } if self.acts(command) => action("shift_colour", "n"),
                Command::Other('{' | '}' | '.' | '&' | '^') => text("nothing"),
                _ => continue,
            };
            let mut name = self.name(command).to_string();
            if let Some(argument) = argument(command) {
                let _ = write!(name, "({argument})");
            }
            symbols = symbols.set(&name, meaning);
        }
        symbols
    }

    /// Returns the style: the palette on a black background, as in Fractint.
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
