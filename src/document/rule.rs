//! The rule file.

use crate::diagnostic::{Diagnostics, Place};
use crate::rule::{Description, Placement};
use crate::style::{Style, View};

use super::node::{Node, Value};
use super::reader::{Fields, Reader};
use super::style::{read_style, read_view};
use super::{Number, Point, Written};

/// A production rule as written, with its components in it.
#[derive(Clone, Debug)]
pub struct RuleDocument {
    /// Title, source and the like.
    pub description: Description,
    /// The parameters, in the order of the file.
    pub params: Vec<ParameterDocument>,
    /// The initiator.
    pub initiator: InitiatorDocument,
    /// The generators by name; `generator` is one without a name.
    pub generators: Vec<(Written<String>, GeneratorDocument)>,
    /// The selection.
    pub select: Option<SelectDocument>,
    /// The base element of all elements that have none of their own.
    pub base_element: Option<BaseElementDocument>,
    /// What `grow` does without `--steps`.
    pub steps: Option<Number>,
    /// The published similarity dimension.
    pub dimension: Option<Number>,
    /// The set's own dimension, where copies overlap.
    pub hausdorff_dimension: Option<Number>,
    /// How it is drawn.
    pub style: Style,
    /// What part of the plane is drawn.
    pub view: View,
}

/// A parameter as written.
#[derive(Clone, Debug)]
pub struct ParameterDocument {
    /// Its name.
    pub name: Written<String>,
    /// Its value.
    pub value: Number,
    /// The least value that it may have.
    pub min: Option<Number>,
    /// The largest value that it may have.
    pub max: Option<Number>,
    /// What it means.
    pub about: Option<String>,
}

/// An initiator as written.
#[derive(Clone, Debug)]
pub struct InitiatorDocument {
    /// Points and elements.
    pub entries: Vec<Entry>,
    /// Whether one more element runs from the last point to the first.
    pub closed: bool,
    /// Whether elements join at all.
    pub connected: bool,
    /// Where it was written.
    pub place: Place,
}

/// A generator as written.
#[derive(Clone, Debug)]
pub struct GeneratorDocument {
    /// Drawn variables with their distributions.
    pub random: Vec<(Written<String>, Number)>,
    /// What moves its points.
    pub moves: Vec<MoveDocument>,
    /// Its parts.
    pub parts: Vec<PartDocument>,
    /// Where it was written.
    pub place: Place,
}

/// A part of a generator as written.
#[derive(Clone, Debug)]
pub struct PartDocument {
    /// Where its elements go.
    pub placement: Placement,
    /// Points and elements.
    pub entries: Vec<Entry>,
    /// Whether one more element runs from the last point to the first.
    pub closed: bool,
    /// Whether elements join at all.
    pub connected: bool,
    /// Where it was written.
    pub place: Place,
}

/// An entry of a list of elements.
#[derive(Clone, Debug)]
pub enum Entry {
    /// A point: where a chain starts, or an element to it with no more to say.
    Point(Point),
    /// An element.
    Element(Box<Listed>),
}

/// An element as written.
#[derive(Clone, Debug)]
pub struct Listed {
    /// Where it runs from, if that is written.
    pub from: Option<Point>,
    /// Where it runs to.
    pub to: Point,
    /// Its direction, 1 to 4.
    pub direction: Option<Number>,
    /// Whether it is replaced.
    pub fertile: bool,
    /// Whether it is drawn.
    pub visible: bool,
    /// Whether it may join the element before it.
    pub connected: bool,
    /// The generator that it names.
    pub generator: Option<Written<String>>,
    /// A base element of its own.
    pub base_element: Option<BaseElementDocument>,
    /// Where it was written.
    pub place: Place,
}

/// What moves the points of a generator, as written.
#[derive(Clone, Debug)]
pub struct MoveDocument {
    /// The angle, in degrees.
    pub rotate: Option<Number>,
    /// The factors along x and y.
    pub scale: Option<[Number; 2]>,
    /// The shift.
    pub shift: Option<Point>,
    /// The centre of turning and scaling.
    pub about: Option<Point>,
    /// The points that move.
    pub points: WhichPoints,
    /// Where it was written.
    pub place: Place,
}

/// The points that a move moves.
#[derive(Clone, Debug)]
pub enum WhichPoints {
    /// All but the two ends of what takes the element's place.
    Inner,
    /// All.
    All,
    /// Those with these numbers, from 0 in the order in which they are first written.
    Numbers(Vec<Number>),
}

/// A selection as written.
#[derive(Clone, Debug)]
pub enum SelectDocument {
    /// Conditions, tried in order.
    Cases(Vec<(Option<Number>, Written<String>)>, Place),
    /// By index.
    ByIndex(Vec<Written<String>>, Place),
    /// At random, by weight.
    AtRandom(Vec<(Written<String>, Number)>, Place),
}

/// A base element as written.
#[derive(Clone, Debug)]
pub struct BaseElementDocument {
    /// Its pieces; the first is its first point.
    pub pieces: Vec<PieceDocument>,
    /// Whether its last point is joined to its first.
    pub closed: bool,
    /// What comes to lie on (0, 0).
    pub from: Option<Point>,
    /// What comes to lie on (1, 0).
    pub to: Option<Point>,
    /// Where it was written.
    pub place: Place,
}

/// A piece of a base element as written.
#[derive(Clone, Debug)]
pub enum PieceDocument {
    /// A straight line to a point.
    Line(Point),
    /// A circular arc through a point to a point.
    Arc {
        /// Where it ends.
        to: Point,
        /// A point on it.
        through: Point,
    },
    /// A Bézier curve with one control point or two.
    Curve {
        /// Where it ends.
        to: Point,
        /// The control points.
        control: Vec<Point>,
    },
}

const DESCRIPTION: [&str; 5] = ["title", "about", "source", "tags", "format"];

/// Whether a key describes a file and has no meaning inside another.
pub(super) fn describes(key: &str) -> bool {
    DESCRIPTION.contains(&key)
}

/// Reads a rule; what is wrong is noted and replaced by something harmless.
pub(super) fn read(node: &Node, diagnostics: &mut Diagnostics) -> RuleDocument {
    let mut reader = Reader::default();
    let rule = read_rule(&mut reader, node);
    diagnostics.extend(reader.diagnostics);
    rule
}

fn read_rule(reader: &mut Reader, node: &Node) -> RuleDocument {
    let empty = Node {
        place: node.place.clone(),
        value: Value::Mapping(Vec::new()),
    };
    let mut fields = match reader.fields(
        node,
        "a rule (a mapping of keys)",
        "see `kfrac cat koch` for a short rule",
    ) {
        Some(fields) => fields,
        None => return read_rule(&mut Reader::default(), &empty),
    };
    if let Some(format) = fields.take("format")
        && !matches!(format.value, Value::Number(version) if version == 1.0)
    {
        reader.error_with_hint(
            &format.place,
            "this version of the format is not known",
            "format: 1",
        );
    }
    if let Some(kind) = fields.take("kind") {
        let known = matches!(&kind.value, Value::Text(kind) if kind == "rule");
        if !known {
            let message = format!("kind '{}' is not known", kind.place.text());
            reader.error_with_hint(&kind.place, message, "kind: rule, which may be left out");
        }
    }
    let description = read_description(reader, &mut fields);
    let params = read_params(reader, fields.take("params"));
    let initiator = match fields.take("initiator") {
        Some(node) => read_initiator(reader, node),
        None => {
            reader.error_with_hint(
                fields.place,
                "the rule has no initiator",
                "initiator: segment",
            );
            placeholder_initiator(fields.place)
        }
    };
    let generators = read_generators(reader, &mut fields);
    let select = fields
        .take("select")
        .and_then(|node| read_select(reader, node));
    let base_element = fields
        .take("base_element")
        .and_then(|node| read_base_element(reader, node));
    let rule = RuleDocument {
        description,
        params,
        initiator,
        generators,
        select,
        base_element,
        steps: reader.optional_number(fields.take("steps")),
        dimension: reader.optional_number(fields.take("dimension")),
        hausdorff_dimension: reader.optional_number(fields.take("hausdorff_dimension")),
        style: read_style(reader, fields.take("style")),
        view: read_view(reader, fields.take("view")),
    };
    // Named here so that it is suggested; a parent has been put in by now.
    fields.take("extends");
    reader.finish(fields, "a rule");
    rule
}

fn placeholder_initiator(place: &Place) -> InitiatorDocument {
    InitiatorDocument {
        entries: Vec::new(),
        closed: false,
        connected: true,
        place: place.clone(),
    }
}

fn read_description(reader: &mut Reader, fields: &mut Fields<'_>) -> Description {
    let mut text = |key| fields.take(key).and_then(|node| reader.text(node));
    let (title, about, source) = (text("title"), text("about"), text("source"));
    let tags = fields.take("tags").map_or(&[][..], |node| {
        reader.list(node, "a list of tags", "tags: [curve, koch]")
    });
    Description {
        title,
        about,
        source,
        tags: tags.iter().filter_map(|tag| reader.text(tag)).collect(),
    }
}

fn read_params(reader: &mut Reader, node: Option<&Node>) -> Vec<ParameterDocument> {
    let Some(node) = node else { return Vec::new() };
    let hint = "params: {angle: 45}";
    let Value::Mapping(entries) = &node.value else {
        reader.mismatch(node, "a mapping of parameters", hint);
        return Vec::new();
    };
    let mut params = Vec::new();
    for (key, node) in entries {
        let name = Written {
            value: key.name.clone(),
            place: key.place.clone(),
        };
        if !matches!(node.value, Value::Mapping(_)) {
            let value = reader.number(node);
            params.push(ParameterDocument {
                name,
                value,
                min: None,
                max: None,
                about: None,
            });
            continue;
        }
        let hint = "angle: {value: 45, min: 5, max: 85, about: \"what it means\"}";
        let Some(mut fields) = reader.fields(node, "a parameter", hint) else {
            continue;
        };
        let Some(value) = fields.take("value") else {
            reader.error_with_hint(
                &key.place,
                format!("parameter '{}' has no value", key.name),
                hint,
            );
            continue;
        };
        params.push(ParameterDocument {
            name,
            value: reader.number(value),
            min: reader.optional_number(fields.take("min")),
            max: reader.optional_number(fields.take("max")),
            about: fields.take("about").and_then(|node| reader.text(node)),
        });
        reader.finish(fields, "a parameter");
    }
    params
}

/// The list of elements of an initiator or of a part.
fn read_entries(reader: &mut Reader, node: &Node) -> Vec<Entry> {
    let hint =
        "a list of points and elements: - [0, 0], then - [1, 0] or - {to: [1, 0], fertile: false}";
    let mut entries = Vec::new();
    let list = reader.list(node, "a list of elements", hint);
    for entry in list {
        match &entry.value {
            Value::Sequence(_) => {
                entries.extend(reader.point(entry).map(Entry::Point));
            }
            _ => entries.extend(read_element(reader, entry).map(|e| Entry::Element(Box::new(e)))),
        }
    }
    let elements = entries
        .iter()
        .filter(|entry| matches!(entry, Entry::Element(_)))
        .count();
    if entries.len() < list.len() || !matches!(node.value, Value::Sequence(_)) {
        // Something in it is wrong, and has been said.
    } else if elements == 0 && entries.len() < 2 {
        reader.error_with_hint(&node.place, "there is no element in this list", hint);
    }
    if let Some(Entry::Element(first)) = entries.first()
        && first.from.is_none()
        && entries.len() == list.len()
    {
        let place = first.place.clone();
        reader.error_with_hint(
            &place,
            "the first element does not say where it runs from",
            "begin the list with a point, - [0, 0], or give the element `from`",
        );
    }
    entries
}

fn read_element(reader: &mut Reader, node: &Node) -> Option<Listed> {
    let hint =
        "an element is written {to: [1, 0]}, {from: [0, 0], to: [1, 0]} or as a point, [1, 0]";
    let mut fields = reader.fields(node, "a point or an element", hint)?;
    let from = fields.take("from").map(|node| reader.point(node));
    let to = fields.take("to").map(|node| reader.point(node));
    if to.is_none() {
        reader.error_with_hint(
            &node.place,
            "this element does not say where it runs to",
            hint,
        );
    }
    let element = Listed {
        from: from.clone().flatten(),
        to: to.flatten().unwrap_or_else(|| {
            let zero = reader.number(&Node {
                place: node.place.clone(),
                value: Value::Number(0.0),
            });
            Point {
                x: zero.clone(),
                y: zero,
                place: node.place.clone(),
            }
        }),
        direction: reader.optional_number(fields.take("direction")),
        fertile: reader.flag(fields.take("fertile"), true),
        visible: reader.flag(fields.take("visible"), true),
        connected: reader.flag(fields.take("connected"), true),
        generator: fields.take("use").and_then(|node| name(reader, node)),
        base_element: fields
            .take("base_element")
            .and_then(|node| read_base_element(reader, node)),
        place: node.place.clone(),
    };
    reader.finish(fields, "an element");
    (from.is_none() || element.from.is_some()).then_some(element)
}

fn read_initiator(reader: &mut Reader, node: &Node) -> InitiatorDocument {
    if let Value::Sequence(_) = node.value {
        return InitiatorDocument {
            entries: read_entries(reader, node),
            closed: false,
            connected: true,
            place: node.place.clone(),
        };
    }
    let hint = "a name from the library (initiator: segment), a list of points, or {elements: [...], closed: true}";
    let Some(mut fields) = reader.fields(node, "an initiator", hint) else {
        return placeholder_initiator(&node.place);
    };
    let initiator = InitiatorDocument {
        entries: required_entries(reader, &mut fields, "an initiator"),
        closed: reader.flag(fields.take("closed"), false),
        connected: reader.flag(fields.take("connected"), true),
        place: node.place.clone(),
    };
    reader.finish(fields, "an initiator");
    initiator
}

fn required_entries(reader: &mut Reader, fields: &mut Fields<'_>, what: &str) -> Vec<Entry> {
    if let Some(node) = fields.take("elements") {
        return read_entries(reader, node);
    }
    reader.error_with_hint(
        fields.place,
        format!("{what} needs `elements`"),
        "elements: [[0, 0], [1, 0]]",
    );
    Vec::new()
}

fn read_generators(
    reader: &mut Reader,
    fields: &mut Fields<'_>,
) -> Vec<(Written<String>, GeneratorDocument)> {
    let (one, several) = (fields.take("generator"), fields.take("generators"));
    match (one, several) {
        (Some(node), None) => {
            let name = Written {
                value: "generator".into(),
                place: node.place.clone(),
            };
            read_generator(reader, node)
                .map(|generator| (name, generator))
                .into_iter()
                .collect()
        }
        (None, Some(node)) => {
            let hint = "generators: {grow: [...], seed: [...]}";
            let Value::Mapping(entries) = &node.value else {
                reader.mismatch(node, "a mapping of generators by name", hint);
                return Vec::new();
            };
            if entries.is_empty() {
                reader.error_with_hint(&node.place, "there is no generator", hint);
            }
            let mut generators = Vec::new();
            for (key, node) in entries {
                let name = Written {
                    value: key.name.clone(),
                    place: key.place.clone(),
                };
                generators.extend(read_generator(reader, node).map(|generator| (name, generator)));
            }
            generators
        }
        (Some(node), Some(_)) => {
            reader.error_with_hint(
                &node.place,
                "`generator` and `generators` cannot stand together",
                "`generators` takes any number of generators by name",
            );
            Vec::new()
        }
        (None, None) => {
            reader.error_with_hint(
                fields.place,
                "the rule has no generator",
                "generator: [[0, 0], [1/3, 0], [1/2, sqrt(3)/6], [2/3, 0], [1, 0]]",
            );
            Vec::new()
        }
    }
}

fn read_generator(reader: &mut Reader, node: &Node) -> Option<GeneratorDocument> {
    if let Value::Sequence(_) = node.value {
        return Some(GeneratorDocument {
            random: Vec::new(),
            moves: Vec::new(),
            parts: vec![PartDocument {
                placement: Placement::Stays,
                entries: read_entries(reader, node),
                closed: false,
                connected: true,
                place: node.place.clone(),
            }],
            place: node.place.clone(),
        });
    }
    let hint = "a name from the library (generator: koch), a list of points, or {elements: [...]} or {parts: [...]}";
    let mut fields = reader.fields(node, "a generator", hint)?;
    let random = read_random(reader, fields.take("random"));
    let moves = match fields.take("move") {
        None => Vec::new(),
        Some(Node {
            value: Value::Sequence(entries),
            ..
        }) => entries
            .iter()
            .filter_map(|entry| read_move(reader, entry))
            .collect(),
        Some(node) => read_move(reader, node).into_iter().collect(),
    };
    let parts = match fields.take("parts") {
        Some(parts) => {
            if fields.has("elements") {
                reader.error_with_hint(
                    &parts.place,
                    "`parts` and `elements` cannot stand together",
                    "put the elements into a part of their own: - elements: [...]",
                );
                fields.take("elements");
            }
            let hint = "parts: [{elements: [...]}, {seeds: true, elements: [...]}]";
            let list = reader.list(parts, "a list of parts", hint);
            if list.is_empty() {
                reader.error_with_hint(&parts.place, "there is no part in this list", hint);
            }
            list.iter()
                .filter_map(|part| read_part(reader, part))
                .collect()
        }
        None => vec![PartDocument {
            placement: Placement::Stays,
            entries: required_entries(reader, &mut fields, "a generator"),
            closed: false,
            connected: reader.flag(fields.take("connected"), true),
            place: node.place.clone(),
        }],
    };
    reader.finish(fields, "a generator");
    Some(GeneratorDocument {
        random,
        moves,
        parts,
        place: node.place.clone(),
    })
}

fn read_part(reader: &mut Reader, node: &Node) -> Option<PartDocument> {
    let mut fields = reader.fields(node, "a part", "- {seeds: true, elements: [...]}")?;
    let seeds = reader.flag(fields.take("seeds"), false);
    let placed = fields.take("placed");
    let mut placement = if seeds {
        Placement::Seeds
    } else {
        Placement::Stays
    };
    if let Some(placed) = placed {
        match &placed.value {
            Value::Text(text) if text == "initiator" && seeds => {
                placement = Placement::SeedsAsInitiator;
            }
            Value::Text(text) if text == "element" => {}
            Value::Text(text) if text == "initiator" => reader.error_with_hint(
                &placed.place,
                "only a part that seeds can be placed as the initiator",
                "{seeds: true, placed: initiator, elements: [...]}",
            ),
            _ => reader.error_with_hint(
                &placed.place,
                format!("'{}' is no placement", placed.place.text()),
                "placed: initiator, or nothing for the element's own frame",
            ),
        }
    }
    let closed_node = fields.take("closed");
    let closed = reader.flag(closed_node, false);
    if let (true, false, Some(node)) = (closed, seeds, closed_node) {
        reader.error_with_hint(
            &node.place,
            "only a part that seeds can be closed",
            "a part that takes the element's place goes on with its neighbours",
        );
    }
    let part = PartDocument {
        placement,
        entries: required_entries(reader, &mut fields, "a part"),
        closed: closed && seeds,
        connected: reader.flag(fields.take("connected"), true),
        place: node.place.clone(),
    };
    reader.finish(fields, "a part");
    Some(part)
}

fn read_random(reader: &mut Reader, node: Option<&Node>) -> Vec<(Written<String>, Number)> {
    let Some(node) = node else { return Vec::new() };
    let Value::Mapping(entries) = &node.value else {
        reader.mismatch(
            node,
            "a mapping of variables",
            "random: {tilt: \"uniform(-20, 20)\"}",
        );
        return Vec::new();
    };
    entries
        .iter()
        .map(|(key, node)| {
            let name = Written {
                value: key.name.clone(),
                place: key.place.clone(),
            };
            (name, reader.number(node))
        })
        .collect()
}

fn read_move(reader: &mut Reader, node: &Node) -> Option<MoveDocument> {
    let hint = "move: {rotate: tilt, about: [1/2, 1]}";
    let mut fields = reader.fields(node, "a move", hint)?;
    let scale = fields.take("scale").and_then(|node| match &node.value {
        Value::Sequence(_) => reader.point(node).map(|point| [point.x, point.y]),
        _ => {
            let scale = reader.number(node);
            Some([scale.clone(), scale])
        }
    });
    let points = match fields.take("points") {
        None => WhichPoints::Inner,
        Some(Node {
            value: Value::Text(text),
            ..
        }) if text == "all" => WhichPoints::All,
        Some(node) => {
            let list = reader.list(node, "a list of point numbers, or `all`", "points: [1, 2]");
            WhichPoints::Numbers(list.iter().map(|entry| reader.number(entry)).collect())
        }
    };
    let moving = MoveDocument {
        rotate: reader.optional_number(fields.take("rotate")),
        scale,
        shift: fields.take("shift").and_then(|node| reader.point(node)),
        about: fields.take("about").and_then(|node| reader.point(node)),
        points,
        place: node.place.clone(),
    };
    reader.finish(fields, "a move");
    Some(moving)
}

fn name(reader: &mut Reader, node: &Node) -> Option<Written<String>> {
    reader.text(node).map(|value| Written {
        value,
        place: node.place.clone(),
    })
}

fn read_select(reader: &mut Reader, node: &Node) -> Option<SelectDocument> {
    let hint = "a list of {when: CONDITION, use: NAME} that ends with {use: NAME}, or {by_index: [NAME, NAME]}, \
                or {at_random: {NAME: WEIGHT}}";
    if let Value::Sequence(entries) = &node.value {
        let mut cases = Vec::new();
        for entry in entries {
            let Some(mut fields) = reader.fields(entry, "a case of the selection", hint) else {
                continue;
            };
            let when = fields.take("when").map(|node| reader.number(node));
            match fields.take("use") {
                Some(node) => cases.extend(name(reader, node).map(|generator| (when, generator))),
                None => reader.error_with_hint(&entry.place, "this case names no generator", hint),
            }
            reader.finish(fields, "a case of the selection");
        }
        return (cases.len() == entries.len())
            .then(|| SelectDocument::Cases(cases, node.place.clone()));
    }
    let mut fields = reader.fields(node, "a selection", hint)?;
    let by_index = fields.take("by_index");
    let at_random = fields.take("at_random");
    let selection = match (by_index, at_random) {
        (Some(list), None) => {
            let names = reader.list(list, "a list of generators", "by_index: [gen0, gen1]");
            let names: Vec<_> = names
                .iter()
                .filter_map(|entry| name(reader, entry))
                .collect();
            Some(SelectDocument::ByIndex(names, list.place.clone()))
        }
        (None, Some(weights)) => {
            let Value::Mapping(entries) = &weights.value else {
                reader.mismatch(
                    weights,
                    "a mapping of weights",
                    "at_random: {gen0: 3, gen1: 1}",
                );
                return None;
            };
            let weights_of = entries.iter().map(|(key, node)| {
                let name = Written {
                    value: key.name.clone(),
                    place: key.place.clone(),
                };
                (name, reader.number(node))
            });
            Some(SelectDocument::AtRandom(
                weights_of.collect(),
                weights.place.clone(),
            ))
        }
        (Some(_), Some(_)) => {
            reader.error_with_hint(
                &node.place,
                "a selection goes by index or at random, not both",
                hint,
            );
            None
        }
        (None, None) => {
            reader.error_with_hint(&node.place, "this selection selects nothing", hint);
            None
        }
    };
    reader.finish(fields, "a selection");
    selection
}

fn read_base_element(reader: &mut Reader, node: &Node) -> Option<BaseElementDocument> {
    let hint = "a name from the library (base_element: triangle), or {points: [[0, 0], [1/2, 1], [1, 0]], closed: true}";
    let mut fields = reader.fields(node, "a base element", hint)?;
    let mut pieces = Vec::new();
    match fields.take("points") {
        Some(points) => {
            for entry in reader.list(points, "a list of points", hint) {
                pieces.extend(read_piece(reader, entry));
            }
        }
        None => reader.error_with_hint(&node.place, "a base element needs `points`", hint),
    }
    let base_element = BaseElementDocument {
        pieces,
        closed: reader.flag(fields.take("closed"), false),
        from: fields.take("from").and_then(|node| reader.point(node)),
        to: fields.take("to").and_then(|node| reader.point(node)),
        place: node.place.clone(),
    };
    reader.finish(fields, "a base element");
    Some(base_element)
}

fn read_piece(reader: &mut Reader, node: &Node) -> Option<PieceDocument> {
    if let Value::Sequence(_) = node.value {
        return reader.point(node).map(PieceDocument::Line);
    }
    let hint =
        "a piece is a point, {arc: [x, y], through: [x, y]} or {curve: [x, y], control: [[x, y]]}";
    let mut fields = reader.fields(node, "a point or a round piece", hint)?;
    let piece = if let Some(to) = fields.take("arc") {
        let to = reader.point(to);
        match fields.take("through") {
            Some(through) => {
                let through = reader.point(through);
                to.zip(through)
                    .map(|(to, through)| PieceDocument::Arc { to, through })
            }
            None => {
                reader.error_with_hint(
                    &node.place,
                    "an arc needs a point that it goes through",
                    hint,
                );
                None
            }
        }
    } else if let Some(to) = fields.take("curve") {
        let to = reader.point(to);
        let control = fields.take("control").map_or(&[][..], |node| {
            reader.list(node, "a list of control points", hint)
        });
        let control: Vec<_> = control
            .iter()
            .filter_map(|node| reader.point(node))
            .collect();
        if !(1..=2).contains(&control.len()) {
            reader.error_with_hint(&node.place, "a curve has one control point or two", hint);
            return None;
        }
        to.map(|to| PieceDocument::Curve { to, control })
    } else {
        reader.error_with_hint(&node.place, "this is no piece of a base element", hint);
        None
    };
    reader.finish(fields, "a piece");
    piece
}
