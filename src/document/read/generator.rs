//! Reading of generators: their parts, random variables and moves.

use crate::catalogue::Shelf;
use crate::document::mapping::{FromNode, mapping};
use crate::document::node::{Node, Value};
use crate::document::reader::{Fields, Reader};
use crate::document::rule::{GeneratorDocument, PartDocument, WhichPoints};
use crate::document::shape::{Form, Shape, alternative, keys};
use crate::document::{TurnDocument, Written, WrittenNumber, WrittenPoint};
use crate::rule::Placement;

use super::elements::{ELEMENTS, about_elements};
use super::parameters::written;
use super::space::{
    FACTORS_HINT, InSpace, SPACE_OF_COMPONENT, TURN, is_turn, read_factors, read_turns,
};

pub(in crate::document) const GENERATOR: Shape = Shape {
    what: "a generator",
    keys: &[&keys![
        =SPACE_OF_COMPONENT;
        elements: ELEMENTS, about_elements!();
        parts: Form::List(&Form::Mapping(&PART), 1, None),
            "Several lists, in place of `elements`: parts that take the element's place, and parts \
             that seed.";
        random: Form::Names(&Form::Expression, 0),
            "Variables that are drawn anew for every element that is replaced: `uniform(a, b)`, \
             `normal(mean, deviation)` or `choice(a, b, ...)`. In space, `NAME: by_edge(normal(0, 1))` is drawn for each \
             edge, and neighbours draw the same: NAME_01, NAME_12, NAME_20.";
        move: Form::Either(&[Form::Mapping(&MOVE), Form::List(&Form::Mapping(&MOVE), 0, None)]),
            "Moves points of the generator: one move, or a list of moves that act one after the other.";
        connected: Form::Flag(true), "Whether elements join each other at all; beside `elements` only.";
    ]],
    alternatives: &[
        alternative(&["elements"], &["parts"]),
        alternative(&["parts"], &["elements", "connected"]),
    ],
    hint: "a name from the library (generator: koch), a list of points, or {elements: [...]} or \
           {parts: [...]}",
};

const PART: Shape = Shape {
    what: "a part",
    keys: &[&keys![
        seeds: Form::Flag(false),
            "Whether the part starts a new fractal of age 0, instead of taking the element's place.";
        placed: Form::Words(&[AS_INITIATOR, IN_ELEMENT]),
            "`initiator`: a seed as large and as upright as the initiator, where the element starts. \
             `element`, or left out: in the element's own frame.";
        closed: Form::Flag(false),
            "Whether one more element runs from the last point back to the first; for a part that \
             seeds.";
        connected: Form::Flag(true), "Whether elements join each other at all.";
        needed elements: ELEMENTS, about_elements!()
            => "a part needs `elements`", "elements: [[0, 0], [1, 0]]";
    ]],
    alternatives: &[],
    hint: "- {seeds: true, elements: [...]}",
};

mapping! {
    /// A move of points of a generator, as written.
    struct MoveDocument: MOVE = "a move", "move: {rotate: tilt, about: [1/2, 1]}";
    rotate: Option<RotateDocument> =
        Form::Either(&[Form::Number, Form::Mapping(&TURN), Form::List(&Form::Mapping(&TURN), 1, None)]),
        "An angle in degrees, counter-clockwise; in space about the z axis, or a turn about another, or a list of turns \
         in order.";
    scale: Option<Vec<WrittenNumber>> = Form::Either(&[Form::Number, Form::Place]),
        "A factor, or one along x and one along y; in space also along z.";
    translate: Option<WrittenPoint> = Form::Place, "What is added last: [x, y], in space [x, y, z].";
    shift: Option<WrittenPoint> = Form::Place, "Another name of `translate`.";
    about: Option<WrittenPoint> = Form::Place,
        "The centre of scaling and turning; [0, 0] if left out.";
    points: WhichPoints =
        Form::Either(&[Form::Words(&[ALL]), Form::List(&Form::Whole(0, None), 0, None)]),
        "The points that move: `all`, or their numbers from 0 in the order in which they are \
         written; all but the two ends, if left out.";
}

/// Notations of a generator.
pub(super) const GENERATOR_OF: Form = Form::Either(&[
    Form::File(Shelf::Generators),
    ELEMENTS,
    Form::Mapping(&GENERATOR),
]);

const AS_INITIATOR: &str = "initiator";
const IN_ELEMENT: &str = "element";
/// Keyword for all points of a generator.
const ALL: &str = "all";

const SEVERAL: &str = "generators: {grow: [...], seed: [...]}";

type Named = (Written<String>, GeneratorDocument);

/// Reads the generators of a rule, from `generator` or `generators`.
pub(super) fn read_generators(reader: &mut Reader, fields: &Fields<'_>) -> Vec<Named> {
    let (one, several) = (fields.take("generator"), fields.take("generators"));
    let mut generators = Vec::new();
    match (one, several) {
        (Some(_), Some(_)) => {
            reader.error_with_hint(
                fields.place_of("generator"),
                "`generator` and `generators` cannot stand together",
                "`generators` takes any number of generators by name",
            );
            // The selection may refer to either.
            reader.names_are_missing = true;
        }
        (None, None) => reader.error_with_hint(
            &fields.place.first_line(),
            "the rule has no generator",
            "generator: [[0, 0], [1/3, 0], [1/2, sqrt(3)/6], [2/3, 0], [1, 0]]",
        ),
        _ => {}
    }
    if let Some(node) = several {
        let entries = reader.names(node, "a mapping of generators by name", SEVERAL);
        if matches!(&node.value, Value::Mapping(all) if all.is_empty()) {
            reader.error_with_hint(&node.place, "there is no generator in it", SEVERAL);
        }
        let entries = entries.iter();
        generators.extend(entries.map(|(key, node)| (written(key), read_generator(reader, node))));
    }
    if let Some(node) = one {
        let name = Written {
            value: "generator".into(),
            place: fields.place_of("generator").clone(),
        };
        generators.push((name, read_generator(reader, node)));
    }
    generators
}

fn read_generator(reader: &mut Reader, node: &Node) -> GeneratorDocument {
    let mut generator = GeneratorDocument {
        random: Vec::new(),
        moves: Vec::new(),
        parts: Vec::new(),
        place: node.place.clone(),
    };
    let part = |entries: Option<_>, connected| PartDocument {
        placement: Placement::Stays,
        entries: entries.unwrap_or_default(),
        closed: false,
        connected,
        place: node.place.clone(),
    };
    if let Value::Sequence(_) = node.value {
        let entries = Vec::from_node(reader, node);
        generator.parts.push(part(entries, true));
        return generator;
    }
    if reader.is_component(node) {
        return generator;
    }
    let Some(fields) = reader.fields(node, &GENERATOR) else {
        return generator;
    };
    let _: Option<InSpace> = fields.read(reader, "space");
    generator.random = read_random(reader, fields.take("random"));
    generator.moves = read_moves(reader, fields.take("move"));
    let Some(parts) = fields.take("parts") else {
        if fields.take("elements").is_none() {
            let message = "a generator needs `elements`";
            let hint = "elements: [[0, 0], [1, 0]]";
            reader.error_with_hint(&fields.place.first_line(), message, hint);
        }
        let connected = fields.read(reader, "connected").unwrap_or(true);
        let entries = fields.read(reader, "elements");
        generator.parts.push(part(entries, connected));
        return generator;
    };
    if fields.take("elements").is_some() {
        reader.error_with_hint(
            fields.place_of("elements"),
            "`parts` and `elements` cannot stand together",
            "put the elements into a part of their own: - elements: [...]",
        );
    }
    if let Some(connected) = fields.take("connected") {
        reader.error_with_hint(
            &connected.place,
            "`connected` belongs to a part where there are parts",
            "- {connected: false, elements: [...]}",
        );
    }
    let hint = "parts: [{elements: [...]}, {seeds: true, elements: [...]}]";
    let list = reader.filled(parts, "a list of parts", "part", hint);
    let parts = list.iter().filter_map(|part| read_part(reader, part));
    generator.parts.extend(parts);
    generator
}

fn read_part(reader: &mut Reader, node: &Node) -> Option<PartDocument> {
    let fields = reader.fields(node, &PART)?;
    let seeds = fields.take("seeds");
    // An unreadable value may have been meant as true.
    let unreadable = seeds.is_some_and(|node| !matches!(node.value, Value::Bool(_)));
    let seeds = fields.read(reader, "seeds").unwrap_or(false) || unreadable;
    let mut placement = if seeds {
        Placement::Seeds
    } else {
        Placement::Stays
    };
    if let Some(placed) = fields.take("placed") {
        match &placed.value {
            Value::Text(text) if text == AS_INITIATOR && seeds => {
                placement = Placement::SeedsAsInitiator;
            }
            Value::Text(text) if text == IN_ELEMENT => {}
            Value::Text(text) if text == AS_INITIATOR => reader.error_with_hint(
                &placed.place,
                "only a part that seeds can be placed as the initiator",
                "{seeds: true, placed: initiator, elements: [...]}",
            ),
            _ => reader.error_with_hint(
                &placed.place.first_line(),
                format!("'{}' is no placement", placed.place.first_line().text()),
                "placed: initiator, or nothing for the element's own frame",
            ),
        }
    }
    let closed = fields.read(reader, "closed").unwrap_or(false);
    if let (true, false, Some(node)) = (closed, seeds, fields.take("closed")) {
        reader.error_with_hint(
            &node.place,
            "only a part that seeds can be closed",
            "a part that takes the element's place goes on with its neighbours",
        );
    }
    Some(PartDocument {
        placement,
        entries: fields.read(reader, "elements")?,
        closed: closed && seeds,
        connected: fields.read(reader, "connected")?,
        place: node.place.clone(),
    })
}

/// Reads variables with their distributions.
pub(super) fn read_random(
    reader: &mut Reader,
    node: Option<&Node>,
) -> Vec<(Written<String>, WrittenNumber)> {
    let Some(node) = node else { return Vec::new() };
    let hint = "random: {tilt: \"uniform(-20, 20)\"}";
    let entries = reader.names(node, "a mapping of variables", hint);
    entries
        .iter()
        .map(|(key, node)| (written(key), reader.number(node)))
        .collect()
}

/// Reads one move or a list of moves.
fn read_moves(reader: &mut Reader, node: Option<&Node>) -> Vec<MoveDocument> {
    let Some(node) = node else { return Vec::new() };
    let moves = match &node.value {
        Value::Sequence(moves) => moves.as_slice(),
        _ => std::slice::from_ref(node),
    };
    moves
        .iter()
        .filter_map(|node| read_move(reader, node))
        .collect()
}

fn read_move(reader: &mut Reader, node: &Node) -> Option<MoveDocument> {
    let moved = MoveDocument::from_node(reader, node)?;
    if matches!(&node.value, Value::Mapping(entries) if entries.is_empty()) {
        reader.error_with_hint(&node.place, "this move moves nothing", MOVE.hint);
    }
    Some(moved)
}

/// The turn of a move as written.
#[derive(Clone, Debug)]
pub enum RotateDocument {
    /// An angle, counter-clockwise; in space about the z axis.
    Angle(WrittenNumber),
    /// In space, turns about axes, in order.
    Turns(Vec<TurnDocument>),
}

impl FromNode for RotateDocument {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        match is_turn(node) {
            true if reader.is_in_space => read_turns(reader, node).map(Self::Turns),
            true => {
                let message = "a turn about an axis lies in space";
                reader.error_with_hint(
                    &node.place,
                    message,
                    "in the plane, a turn is an angle: rotate: 30",
                );
                None
            }
            false => Some(Self::Angle(reader.number(node))),
        }
    }
}

/// Reads the factors of a move: two in the plane, and two or three in space.
impl FromNode for Vec<WrittenNumber> {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        match &node.value {
            Value::Sequence(entries) if reader.is_in_space && entries.len() == 3 => {
                read_factors(reader, node, "factors", FACTORS_HINT).map(Into::into)
            }
            Value::Sequence(_) => Some(reader.pair(node).into()),
            _ if reader.is_in_space => {
                read_factors(reader, node, "factors", FACTORS_HINT).map(Into::into)
            }
            _ => Some(reader.pair(node).into()),
        }
    }
}

impl FromNode for WhichPoints {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        if matches!(&node.value, Value::Text(text) if text == ALL) {
            return Some(Self::All);
        }
        let list = reader.list(node, "a list of point numbers, or `all`", "points: [1, 2]");
        let numbers = list.iter().map(|entry| reader.number(entry));
        Some(Self::Numbers(numbers.collect()))
    }

    fn absent(_: &Fields<'_>, _: &'static str) -> Option<Self> {
        Some(Self::Inner)
    }
}
