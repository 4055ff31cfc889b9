//! Bracketed strings: every instance in brackets of its own, in which the turtle turns, moves, and changes
//! the length of its steps.
//!
//! After every symbol the turtle continues one step ahead of where it met the symbol, so that the successor
//! is the same at every step. Where only the limit set is kept, everything that is replaced is drawn as a
//! line.

use std::fmt::Write as _;

use crate::build::written::{Entries, sequence};
use crate::document::node::Value;
use crate::geometry::DVec2;
use crate::rule::{BaseElement, Piece};

use super::super::number;
use super::super::structure::{PlacedObject, Structure};
use super::super::{Keeps, Refusal};
use super::{degrees, letter, letter_of};

/// A symbol: an object, or a shape that is kept, with its appearance.
#[derive(PartialEq)]
struct Symbol {
    object: Option<usize>,
    drawing: SymbolDrawing,
}

/// Drawing of a symbol.
#[derive(Clone, Copy, PartialEq)]
enum SymbolDrawing {
    Nothing,
    Line,
    /// The shape with this index.
    Shape(usize),
}

pub(super) fn write(structure: &Structure, keeps: Keeps) -> Result<Entries, Refusal> {
    let mut writer = Writer {
        structure,
        keeps,
        symbols: Vec::new(),
        reflects: false,
    };
    let axiom = writer.string(None)?;
    let strings: Result<Vec<_>, _> = (0..structure.objects.len())
        .map(|object| writer.string(Some(object)))
        .collect();
    let strings = strings?;
    let mut productions = Entries::default();
    let mut meanings = Entries::default();
    for (number, symbol) in writer.symbols.iter().enumerate() {
        let letter = letter(number)?;
        if let Some(object) = symbol.object {
            productions = productions.add(letter, Value::Text(strings[object].clone()));
        }
        let meaning = match symbol.drawing {
            SymbolDrawing::Line => Value::Text("draw".into()),
            SymbolDrawing::Shape(shape) => meaning(&structure.shapes[shape])?,
            SymbolDrawing::Nothing => Value::Text("move".into()),
        };
        if (letter, &meaning) != ('F', &Value::Text("draw".into())) {
            meanings = meanings.add(letter, meaning);
        }
    }
    let scale = Entries::default().set("scale", Value::Text("s".into()));
    meanings = meanings.add("@(s)", scale.value());
    if writer.reflects {
        meanings = meanings.add("!", Value::Text("reflect".into()));
    }
    Ok(Entries::default()
        .set("axiom", Value::Text(axiom))
        .set("productions", productions.value())
        .set("symbols", meanings.value()))
}

struct Writer<'s> {
    structure: &'s Structure,
    keeps: Keeps,
    /// Symbols met so far, in the order of their letters.
    symbols: Vec<Symbol>,
    /// Whether an instance is mirrored.
    reflects: bool,
}

impl Writer<'_> {
    /// Returns the string of an object, or of the scene.
    fn string(&mut self, object: Option<usize>) -> Result<String, Refusal> {
        let structure = self.structure;
        let all = structure.placed(object);
        let mut string = String::new();
        for placed in all {
            if placed.tint.is_some() {
                return Err(Refusal::Tint);
            }
            let symbol = self.letter(placed)?;
            let way = self.way(placed);
            // A single instance needs no way back.
            let is_alone = all.len() == 1 && object.is_none();
            let written = if is_alone {
                write!(string, "{way}{symbol}")
            } else {
                write!(string, "[{way}{symbol}]")
            };
            debug_assert!(written.is_ok(), "a string takes everything");
        }
        if object.is_some() {
            string.push_str("f(1)");
        }
        Ok(string)
    }

    /// Returns the commands that move the turtle to an instance.
    fn way(&mut self, placed: &PlacedObject) -> String {
        let mut way = String::new();
        let mut heading = DVec2::X;
        let mut turn = |way: &mut String, wanted: DVec2| {
            let angle = degrees(heading, wanted);
            heading = wanted;
            if angle != 0.0 {
                let (sign, angle) = if angle < 0.0 {
                    ('-', -angle)
                } else {
                    ('+', angle)
                };
                way.push_str(&format!("{sign}({})", number::text(angle)));
            }
        };
        let (place, along) = (placed.map.translation, placed.map.matrix2.x_axis);
        if place != DVec2::ZERO {
            turn(&mut way, place);
            way.push_str(&format!("f({})", number::text(place.length())));
        }
        turn(&mut way, along);
        if along.length() != 1.0 {
            way.push_str(&format!("@({})", number::text(along.length())));
        }
        if placed.map.matrix2.determinant() < 0.0 {
            self.reflects = true;
            way.push('!');
        }
        way
    }

    fn letter(&mut self, placed: &PlacedObject) -> Result<char, Refusal> {
        let is_line = self.structure.shapes[placed.shape].is_line();
        let drawing = match placed.object {
            Some(_) if self.keeps == Keeps::Limit => SymbolDrawing::Line,
            _ if !placed.visible => SymbolDrawing::Nothing,
            _ if is_line => SymbolDrawing::Line,
            _ if self.keeps == Keeps::Limit => return Err(Refusal::NoLines),
            _ => SymbolDrawing::Shape(placed.shape),
        };
        let symbol = Symbol {
            object: placed.object,
            drawing,
        };
        letter_of(&mut self.symbols, symbol)
    }
}

/// Returns the turtle's actions that draw a shape of the unit frame.
fn meaning(shape: &BaseElement) -> Result<Value, Refusal> {
    let action =
        |name: &str, number: f64| Entries::default().set(name, number::value(number)).value();
    let word = |name: &str| Value::Text(name.into());
    let mut actions = Vec::new();
    let (mut at, mut heading) = (DVec2::ZERO, DVec2::X);
    let mut go = |actions: &mut Vec<Value>, how: &str, to: DVec2| {
        let along = to - at;
        if along != DVec2::ZERO {
            let angle = degrees(heading, along);
            if angle != 0.0 {
                actions.push(action("turn", angle));
            }
            actions.push(action(how, along.length()));
            (at, heading) = (to, along);
        }
    };
    go(&mut actions, "move", shape.start());
    if shape.is_closed() {
        actions.extend([word("open"), word("vertex")]);
    }
    for piece in shape.pieces() {
        let Piece::Line(end) = *piece else {
            return Err(Refusal::Round);
        };
        go(&mut actions, "draw", end);
    }
    if shape.is_closed() {
        actions.push(word("close"));
    }
    go(&mut actions, "move", DVec2::X);
    let angle = degrees(heading, DVec2::X);
    if angle != 0.0 {
        actions.push(action("turn", angle));
    }
    Ok(sequence(actions))
}
