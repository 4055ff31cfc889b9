//! Parsing of EisenScript.
//!
//! A program is a sequence of `rule NAME MODIFIERS { … }`, of `set KEY VALUE` and of actions; the latter stand in rules, too.
//! An action is a name, `{ … } name`, or loops before a name, `3 * { … } 4 * { … } name`. Case does not count.

use std::collections::BTreeMap;

use crate::diagnostic::{Diagnostic, Diagnostics, Place, did_you_mean};
use crate::random::Pcg;

use crate::style::Colour;

use super::colour::{self, Colouring, Pool};
use super::lex::Word;
use super::motion::{Motion, Movement, reflection};
use super::program::{Action, Alternative, Loop, Program, Rule, Settings, TOP, Target};

/// Largest number of definitions of rules.
const MAX_ALTERNATIVES: usize = 1000;

/// Largest number of errors that are reported.
const MAX_ERRORS: usize = 20;

/// Primitives without a counterpart.
const UNKNOWN_SHAPES: [&str; 3] = ["tube", "template", "triangle"];

const TRANSFORMATIONS: &str =
    "transformations are x y z, rx ry rz, s, m, fx fy fz, reflect, hue, sat, b, a, color and blend";

/// Result of parsing: an error has been reported.
type Parsed<T> = Result<T, ()>;

struct Parser<'a> {
    words: &'a [Word],
    at: usize,
    /// Rules by name.
    rules: BTreeMap<&'a str, usize>,
    settings: Settings,
    pool: Pool,
    random: Pcg,
    found: &'a mut Diagnostics,
    errors: usize,
}

/// Parses the words of a program, of which there are some. Reports mistakes; the program is complete without them.
pub(super) fn program(words: &[Word], random: Pcg, found: &mut Diagnostics) -> Option<Program> {
    let first = words.first()?;
    let mut rules = BTreeMap::new();
    let mut names = Vec::new();
    for pair in words.windows(2) {
        if pair[0].text == "rule" && !rules.contains_key(&pair[1].text[..]) {
            rules.insert(&pair[1].text[..], names.len());
            names.push(Rule {
                name: pair[1].text.clone(),
                alternatives: Vec::new(),
            });
        }
    }
    let mut parser = Parser {
        words,
        at: 0,
        rules,
        settings: Settings::default(),
        pool: Pool::default(),
        random,
        found,
        errors: 0,
    };
    let mut alternatives = vec![Alternative {
        rule: None,
        place: first.place.clone(),
        weight: 1.0,
        depth: None,
        successor: None,
        actions: Vec::new(),
    }];
    while parser.peek().is_some() && parser.errors < MAX_ERRORS {
        let start = parser.at;
        let parsed = match parser.text() {
            "rule" => parser.rule().map(|alternative| {
                if let Some(rule) = alternative.rule {
                    names[rule].alternatives.push(alternatives.len());
                }
                alternatives.push(alternative);
            }),
            "set" => parser.set(true),
            _ => {
                let action = parser.action();
                action.map(|action| alternatives[TOP].actions.push(action))
            }
        };
        if alternatives.len() > MAX_ALTERNATIVES {
            let many = format!("this program has more than {MAX_ALTERNATIVES} rules");
            parser
                .found
                .push(Diagnostic::error(many).at(&words[start].place));
            return None;
        }
        if parsed.is_err() {
            parser.recover(start);
        }
    }
    Some(Program {
        alternatives,
        rules: names,
        settings: parser.settings,
    })
}

impl Parser<'_> {
    fn peek(&self) -> Option<&Word> {
        self.words.get(self.at)
    }

    /// Returns the text of the next word; that of the end is empty.
    fn text(&self) -> &str {
        self.peek().map_or("", |word| &word.text)
    }

    /// Returns the place of the next word, or of the last one.
    fn place(&self) -> Place {
        let at = self.at.min(self.words.len() - 1);
        self.words[at].place.clone()
    }

    /// Skips a word if it is next.
    fn skip(&mut self, text: &str) -> bool {
        let is_next = self.peek().is_some_and(|word| word.text == text);
        self.at += usize::from(is_next);
        is_next
    }

    fn error<T>(&mut self, message: String, place: &Place, hint: &str) -> Parsed<T> {
        self.errors += 1;
        self.found
            .push(Diagnostic::error(message).at(place).hint(hint));
        Err(())
    }

    fn warn(&mut self, message: String, place: &Place) {
        self.found.push(Diagnostic::warning(message).at(place));
    }

    /// Reports that the next word is not what is expected.
    fn unexpected<T>(&mut self, expected: &str, hint: &str) -> Parsed<T> {
        let message = match self.peek() {
            Some(word) => format!("'{}' where {expected} is expected", word.text),
            None => format!("the program ends where {expected} is expected"),
        };
        let place = self.place();
        self.error(message, &place, hint)
    }

    /// Goes on behind the statement with a mistake: at the next line that does not belong to a list of transformations.
    fn recover(&mut self, start: usize) {
        self.at = self.at.max(start + 1);
        let line = |word: &Word| word.place.line();
        let before = line(&self.words[self.at.min(self.words.len()) - 1]);
        while self
            .peek()
            .is_some_and(|word| line(word) == before && word.text != "rule")
        {
            self.at += 1;
        }
    }

    fn number(&mut self, of: &str) -> Parsed<f64> {
        match self.peek().and_then(Word::number) {
            Some(number) => {
                self.at += 1;
                Ok(number)
            }
            None => self.unexpected(&format!("a number of '{of}'"), "3, -0.5 or 2/3"),
        }
    }

    fn whole(&mut self, of: &str) -> Parsed<i32> {
        match self.peek().and_then(|word| word.text.parse().ok()) {
            Some(number) => {
                self.at += 1;
                Ok(number)
            }
            None => self.unexpected(&format!("a whole number of '{of}'"), "such as 10"),
        }
    }

    /// Parses a rule, whose name is known.
    fn rule(&mut self) -> Parsed<Alternative> {
        const HINT: &str = "rule NAME md 10 { … }";
        self.at += 1;
        let place = self.place();
        let name = match self.peek() {
            Some(word) if !"{}*>".contains(&word.text[..]) => word.text.clone(),
            _ => return self.unexpected("the name of a rule", HINT),
        };
        self.at += 1;
        if Target::from_name(&name).is_some() || UNKNOWN_SHAPES.contains(&&name[..]) {
            let message = format!("'{name}' is a primitive, and no rule can have its name");
            return self.error(message, &place, "take another name");
        }
        let mut alternative = Alternative {
            rule: self.rules.get(&name[..]).copied(),
            place,
            weight: 1.0,
            depth: None,
            successor: None,
            actions: Vec::new(),
        };
        while !self.skip("{") {
            let place = self.place();
            match self.text() {
                "w" | "weight" => {
                    self.at += 1;
                    alternative.weight = self.number("weight")?;
                    if alternative.weight < 0.0 {
                        let message = format!("the weight {} is negative", alternative.weight);
                        return self.error(message, &place, "a weight is a number from 0");
                    }
                }
                "md" | "maxdepth" => {
                    self.at += 1;
                    // A rule is applied once before its depth counts.
                    alternative.depth = match self.whole("maxdepth")? {
                        -1 => None,
                        depth => Some(u32::try_from(depth).unwrap_or(0).max(1)),
                    };
                    if self.skip(">") {
                        alternative.successor = Some(self.target()?);
                    }
                }
                _ => return self.unexpected("a modifier or {", HINT),
            }
        }
        while !self.skip("}") {
            let start = self.at;
            let parsed = match self.text() {
                "" => return self.unexpected("the } of a rule", HINT),
                "rule" => return self.unexpected("an action or }", HINT),
                "set" => self.set(false),
                _ => self.action().map(|action| alternative.actions.push(action)),
            };
            if parsed.is_err() {
                if self.errors >= MAX_ERRORS {
                    return Err(());
                }
                self.recover(start);
            }
        }
        Ok(alternative)
    }

    fn action(&mut self) -> Parsed<Action> {
        const HINT: &str = "{ x 1 } box, or 10 * { x 1 } box";
        let place = self.place();
        let mut loops = Vec::new();
        if self.text() == "{" {
            let (motion, colouring) = self.transformation()?;
            loops.push(Loop {
                count: 1,
                motion,
                colouring,
            });
        }
        while self.peek().and_then(Word::number).is_some() {
            // A loop has one copy at least.
            let count = self.whole("a loop")?.max(1);
            if !self.skip("*") {
                return self.unexpected("the * of a loop", HINT);
            }
            let (motion, colouring) = self.transformation()?;
            loops.push(Loop {
                count: u32::try_from(count).unwrap_or(1),
                motion,
                colouring,
            });
        }
        let target = self.target()?;
        Ok(Action {
            loops,
            target,
            place,
        })
    }

    /// Parses the name of a rule or of a primitive, possibly with a class: `box::shiny`.
    fn target(&mut self) -> Parsed<Target> {
        let place = self.place();
        let name = self.text().to_owned();
        if let Some(rule) = self.rules.get(&name[..]) {
            let rule = Target::Rule(*rule);
            self.at += 1;
            return Ok(rule);
        }
        let (shape, class) = match name.split_once("::") {
            Some((shape, class)) => (shape, Some(class)),
            None => (&name[..], None),
        };
        if let Some(target) = Target::from_name(shape) {
            self.at += 1;
            if let Some(class) = class {
                self.warn(format!("the class '{class}' is left out"), &place);
            }
            return Ok(target);
        }
        let bare = shape.split('[').next().unwrap_or(shape);
        if UNKNOWN_SHAPES.contains(&bare) {
            let message = format!("there is no counterpart of '{bare}'");
            let hint = "box, sphere, cylinder, line, dot, grid and mesh are drawn";
            return self.error(message, &place, hint);
        }
        if name.is_empty() || "{}*>".contains(&name[..]) || name == "rule" || name == "set" {
            let hint = "{ x 1 } box, or 10 * { x 1 } box";
            return self.unexpected("the name of a rule or of a primitive", hint);
        }
        let hint = did_you_mean(&name, self.rules.keys().copied());
        let hint = hint.unwrap_or_else(|| format!("rule {name} {{ … }} defines it"));
        self.error(format!("there is no rule '{name}'"), &place, &hint)
    }

    /// Parses a list of transformations in braces.
    fn transformation(&mut self) -> Parsed<(Motion, Colouring)> {
        if !self.skip("{") {
            return self.unexpected("the { of a transformation", "10 * { x 1 } box");
        }
        let mut motion = Motion::default();
        let mut colouring = Colouring::default();
        while !self.skip("}") {
            let place = self.place();
            let name = self.text().to_owned();
            self.at += 1;
            let mut is_colour = true;
            match &name[..] {
                "x" | "y" | "z" => {
                    let mut by = [0.0; 3];
                    by[axis(&name)] = self.number(&name)?;
                    motion.push(Movement::Translate(by));
                    is_colour = false;
                }
                "rx" | "ry" | "rz" => {
                    let angle = self.number(&name)?;
                    motion.push(Movement::Turn(axis(&name), angle));
                    is_colour = false;
                }
                "fx" | "fy" | "fz" => {
                    let mut by = [1.0; 3];
                    by[axis(&name)] = -1.0;
                    motion.push(Movement::Scale(by));
                    is_colour = false;
                }
                "s" => {
                    let first = self.number("s")?;
                    let mut by = [first; 3];
                    if self.peek().and_then(Word::number).is_some() {
                        by[1] = self.number("s")?;
                        by[2] = self.number("s")?;
                    }
                    motion.push(Movement::Scale(by));
                    is_colour = false;
                }
                "m" | "matrix" => {
                    let mut rows = [[0.0; 3]; 3];
                    for entry in rows.as_flattened_mut() {
                        *entry = self.number("m")?;
                    }
                    motion.push(Movement::Matrix(rows));
                    is_colour = false;
                }
                "reflect" => {
                    let mut across = [0.0; 3];
                    for entry in &mut across {
                        *entry = self.number("reflect")?;
                    }
                    let Some(movements) = reflection(across) else {
                        let hint = "reflect 1 0 0 reflects in the plane x = 0";
                        return self.error("this vector is 0".into(), &place, hint);
                    };
                    movements.into_iter().for_each(|it| motion.push(it));
                    is_colour = false;
                }
                "h" | "hue" => colouring.hue += self.number("hue")?,
                "sat" => self.factor(&mut colouring, 0, "sat")?,
                "b" | "brightness" | "v" => self.factor(&mut colouring, 1, "brightness")?,
                "a" | "alpha" => self.factor(&mut colouring, 2, "alpha")?,
                "color" | "c" | "colour" => colouring.absolute = Some(self.colour(true)?),
                "blend" => {
                    let colour = self.colour(false)?;
                    let strength = self.number("blend")?;
                    if strength < 0.0 {
                        let message = format!("the strength {strength} is negative");
                        return self.error(message, &place, "blend red 0.5");
                    }
                    let share = strength / (1.0 + strength);
                    colouring.blend = Some((colour, share)).filter(|_| share > 0.0);
                }
                _ => {
                    self.at -= 1;
                    return self.unexpected("a transformation", TRANSFORMATIONS);
                }
            }
            if is_colour {
                colouring.places.push(place);
            }
        }
        Ok((motion, colouring.completed()))
    }

    fn factor(&mut self, colouring: &mut Colouring, part: usize, name: &str) -> Parsed<()> {
        colouring.factors.0[part] *= self.number(name)?.max(0.0);
        Ok(())
    }

    /// Parses a colour, or draws a random one.
    fn colour(&mut self, may_be_random: bool) -> Parsed<Colour> {
        let place = self.place();
        if may_be_random && self.skip("random") {
            let drawn = self.pool.draw(&mut self.random);
            let message = format!("one colour, {drawn}, is drawn for all copies");
            self.warn(message, &place);
            return Ok(drawn);
        }
        match colour::parse(self.text()) {
            Some(colour) => {
                self.at += 1;
                Ok(colour)
            }
            None => self.unexpected("a colour", "red, #f00 or #ff0000"),
        }
    }

    /// Parses a setting; those in rules have no counterpart.
    fn set(&mut self, is_outside: bool) -> Parsed<()> {
        self.at += 1;
        let place = self.place();
        let key = self.text().to_owned();
        self.at += 1;
        let value_place = self.place();
        let (Some(value), false) = (self.peek().map(|word| word.text.clone()), key.is_empty())
        else {
            return self.unexpected("the value of a setting", "set maxdepth 100");
        };
        let known = match &key[..] {
            "maxdepth" | "md" | "maxobjects" | "seed" | "background" | "colorpool" => is_outside,
            _ => false,
        };
        if !known {
            self.at += 1;
            let within = if is_outside { "" } else { " within a rule" };
            let message = format!("'set {key}'{within} has no counterpart, and is left out");
            self.warn(message, &place);
            return Ok(());
        }
        match &key[..] {
            "maxdepth" | "md" => {
                let depth = self.whole("maxdepth")?;
                self.settings.generations = u32::try_from(depth).unwrap_or(0);
            }
            "maxobjects" => {
                let objects = self.whole("maxobjects")?;
                self.settings.objects = u64::try_from(objects).unwrap_or(0);
            }
            "seed" if value == "initial" => self.at += 1,
            "seed" => self.settings.seed = u64::from(self.whole("seed")?.unsigned_abs()),
            "background" => self.settings.background = Some(self.colour(false)?),
            _ => match Pool::parse(&value) {
                Some(pool) => {
                    self.at += 1;
                    self.pool = pool;
                }
                None => {
                    let message = format!("'{value}' is no pool of colours here");
                    let hint = "randomhue, randomrgb, greyscale, or a list such as list:red,white";
                    return self.error(message, &value_place, hint);
                }
            },
        }
        Ok(())
    }
}

/// Returns the number of the axis that ends a name.
fn axis(name: &str) -> usize {
    match name.as_bytes().last() {
        Some(b'x') => 0,
        Some(b'y') => 1,
        _ => 2,
    }
}
