//! Reading of the turtle's interpretation of symbols.

use crate::diagnostic::did_you_mean;
use crate::document::lsystem::{ActionDocument, SymbolDocument};
use crate::document::node::{Key, Node, Value};
use crate::document::reader::Reader;
use crate::document::shape::{Form, Shape, keys};

use super::word::{Text, WordReader};

/// Actions without a number.
const WORDS: [&str; 13] = [
    "draw", "move", "glide", "push", "pop", "reflect", "swap", "open", "close", "vertex", "cut",
    "level", "nothing",
];

/// Actions that a turtle of the plane does not know.
const IN_SPACE: [&str; 3] = ["pitch", "roll", "level"];

/// An action, or a list of actions.
pub(super) const MEANING: Form = Form::Either(&[ONE, Form::List(&ONE, 0, None)]);

const ONE: Form = Form::Either(&[Form::Words(&WORDS), Form::Mapping(&ACTION)]);

const ACTION: Shape = Shape {
    what: "an action",
    keys: &[&keys![
        draw: Form::Number, "Draws a line of so many steps.";
        move: Form::Number, "Goes so many steps ahead and draws nothing.";
        glide: Form::Number, "Goes so many steps ahead; in a polygon it makes no vertex.";
        turn: Form::Number, "Turns by so many degrees, counter-clockwise.";
        rotate: Form::Number,
            "Turns by so many degrees, counter-clockwise also where turns are reflected.";
        pitch: Form::Number,
            "In space, turns about the direction to the left by so many degrees: down.";
        roll: Form::Number, "In space, turns about the heading by so many degrees.";
        scale: Form::Number, "Multiplies the length of all steps from here on.";
        width: Form::Positive, "Multiplies the width of lines from here on.";
        set_width: Form::Positive, "Sets the width, as a multiple of the file's.";
        colour: Form::Number, "Sets the colour: its number in the palette, from 0.";
        shift_colour: Form::Number, "Adds to the number of the colour.";
        stamp: Form::Text,
            "Places a stamp along the heading, a step long; with `scale` beside it, that many steps.";
    ]],
    alternatives: &[],
    hint: "draw, move, {draw: 1/2}, {turn: 36}, {scale: 1/2}, push, pop or another action",
};

/// Reads the interpretation of a symbol.
pub(super) fn read_symbol(
    words: &mut WordReader<'_>,
    key: &Key,
    node: &Node,
) -> Option<SymbolDocument> {
    let mut actions = Vec::new();
    match &node.value {
        Value::Sequence(entries) => {
            for node in entries {
                read_action(words, node, &mut actions);
            }
        }
        _ => read_action(words, node, &mut actions),
    }
    let mut word = words.word(Text::of_key(key));
    if word.complete && word.modules.len() != 1 {
        let message = "one symbol has a meaning";
        let hint = "write a symbol, perhaps with names for its arguments: G or B(s)";
        words.reader.error_with_hint(&key.place, message, hint);
        return None;
    }
    Some(SymbolDocument {
        symbol: word.modules.pop()?,
        actions,
    })
}

/// Returns whether the turtle knows an action. Reports one of space in the plane.
fn check_space(reader: &mut Reader, name: &str, node: &Node) -> bool {
    let is_known = reader.is_in_space || !IN_SPACE.contains(&name);
    if !is_known {
        let message = format!("`{name}` needs space, and the turtle lives in the plane");
        reader.error_with_hint(&node.place, message, "write `space: 3` at the top");
    }
    is_known
}

fn read_action(words: &mut WordReader<'_>, node: &Node, actions: &mut Vec<ActionDocument>) {
    let reader = &mut *words.reader;
    let Value::Text(name) = &node.value else {
        let Some(fields) = reader.fields(node, &ACTION) else {
            return;
        };
        for (name, node) in fields.in_order() {
            if !check_space(reader, name, node) {
                continue;
            }
            if name == "stamp" {
                let scale = fields.optional(reader, "scale");
                actions.extend(reader.name(node).map(|it| ActionDocument::Stamp(it, scale)));
                continue;
            }
            // Beside a stamp, the scale is that of the stamp.
            if name == "scale" && fields.take("stamp").is_some() {
                continue;
            }
            let number = reader.number(node);
            actions.push(match name {
                "draw" => ActionDocument::Draw(Some(number)),
                "move" => ActionDocument::Move(Some(number)),
                "glide" => ActionDocument::Glide(Some(number)),
                "turn" => ActionDocument::Turn(number),
                "rotate" => ActionDocument::Rotate(number),
                "pitch" => ActionDocument::Pitch(number),
                "roll" => ActionDocument::Roll(number),
                "scale" => ActionDocument::Scale(number),
                "width" => ActionDocument::Width(number),
                "set_width" => ActionDocument::SetWidth(number),
                "colour" => ActionDocument::Colour(number),
                _ => ActionDocument::ShiftColour(number),
            });
        }
        return;
    };
    if !check_space(reader, name, node) {
        return;
    }
    actions.push(match name.as_str() {
        "draw" => ActionDocument::Draw(None),
        "move" => ActionDocument::Move(None),
        "glide" => ActionDocument::Glide(None),
        "push" => ActionDocument::Push,
        "pop" => ActionDocument::Pop,
        "reflect" => ActionDocument::Reflect,
        "swap" => ActionDocument::Swap,
        "open" => ActionDocument::Open,
        "close" => ActionDocument::Close,
        "vertex" => ActionDocument::Vertex,
        "cut" => ActionDocument::Cut,
        "level" => ActionDocument::Level,
        "nothing" => return,
        name => {
            let mut numbered = ACTION.members();
            let hint = if numbered.any(|member| member.name == name) {
                format!("it needs a number: {{{name}: 1}}")
            } else {
                let names = WORDS
                    .into_iter()
                    .chain(ACTION.members().map(|member| member.name));
                did_you_mean(name, names).unwrap_or_else(|| ACTION.hint.into())
            };
            let message = format!("'{name}' is no action");
            reader.error_with_hint(&node.place, message, hint);
            return;
        }
    });
}
