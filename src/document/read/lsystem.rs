//! Reading of L-systems.

use crate::catalogue::Shelf;
use crate::document::MetadataDocument;
use crate::document::lsystem::{
    LSystemDocument, ProductionDocument, StampDocument, TropismDocument, WordDocument,
};
use crate::document::mapping::FromNode as _;
use crate::document::node::{Key, Node, Value};
use crate::document::reader::{Fields, Reader};
use crate::document::shape::{Form, Member, Shape, key, keys};
use crate::document::{Written, WrittenNumber};
use crate::expression::Expression;
use crate::kind::Kind;

use super::base_element::{BASE_ELEMENT, BASE_ELEMENT_OF, BaseElementDocument};
use super::generator::read_random;
use super::metadata::{DESCRIPTION, LIKING};
use super::parameters::PARAMS;
use super::set::{FORMS, SET, read_set};
use super::space::{SPACE, read_space};
use super::turtle::{MEANING, read_symbol};
use super::word::{Text, WordReader};
use super::{KindTable, OfKind};

/// Keys of an L-system.
const LSYSTEM: Shape = Shape {
    what: "an L-system",
    keys: &[&DESCRIPTION, &LSYSTEM_ALONE, &LIKING],
    alternatives: &[],
    hint: "an L-system is a mapping of keys: `kfrac cat koch-lsystem` shows a short one",
};

/// Keys that only an L-system has.
const LSYSTEM_ALONE: [Member; 16] = keys![
    needed kind: Form::Words(&[Kind::LSystem.name()]), "The kind of file.";
    extends: Form::File(Shelf::LSYSTEMS),
        "Another L-system to start from, by name or by file. The keys written here replace its keys; \
         `params`, `style` and `view` merge entry by entry.";
    =SPACE;
    =PARAMS;
    alone axiom: Form::Text,
        "The word that all begins with: symbols, perhaps with arguments, such as `F` or `A(1, 10)`. \
         Blanks mean nothing."
            => "the L-system has no axiom", "axiom: F";
    alone productions: Form::Either(&[Form::Names(&Form::Either(&[Form::Text, Form::List(&Form::Either(&[Form::Text, Form::Mapping(&ALTERNATIVE)]), 1, None), Form::Mapping(&ALTERNATIVE)]), 0), Form::List(&Form::Either(&[Form::Text, Form::Mapping(&PRODUCTION)]), 0, None)]),
        "What replaces what: a mapping of symbols to words, or to lists of words of which one is \
         drawn; or a list of productions such as `A(w) : w > 1 -> F[A(w/2)]` and `A < B > C -> AB`."
            => "the L-system has no productions", "productions: {F: F+F--F+F}";
    angle: Form::Number,
        "By how much `+` turns counter-clockwise and `-` clockwise, in degrees; 90 if left out.";
    heading: Form::Either(&[Form::Number, Form::Place]),
        "Where the turtle looks first, in degrees counter-clockwise; 0, to the right, if left out. In space also a \
         vector: `[0, 1, 0]` is upwards.";
    up: Form::Place,
        "In space, the direction that lies above the turtle's back, as far as it is across the heading; that after the \
         least turn from [0, 0, 1], towards the viewer, if left out.";
    tropism: Form::Mapping(&TROPISM),
        "In space, what bends branches: after each line, the turtle turns by e·|H × T| radians about H × T, for its \
         heading H and the vector T of `towards` (ABOP, section 2.3.3).";
    stamps: Form::Names(&Form::Either(&[BASE_ELEMENT_OF, Form::Mapping(&SET)]), 0),
        "What `~(NAME)` places along the heading, a step long: base elements of the library, or written here, or sets in \
         their coordinates, such as another fractal. A name that is not listed is a base element of the library; \
         `~(leaf, 2)` is two steps long.";
    random: Form::Names(&Form::Expression, 0),
        "Variables that are drawn for every module that is replaced, for the arguments of its successor: \
         `uniform(a, b)`, `normal(mean, deviation)` or `choice(a, b, ...)`.";
    length: Form::Positive, "The length of a step; 1 if left out.";
    thinning: Form::Positive, "What `!` multiplies widths by; 0.7 if left out.";
    symbols: Form::Names(&MEANING, 0),
        "What the turtle does where it meets a symbol, where that is not as usual: an action, or a \
         list of actions. Arguments have names: `B(s)`.";
    ignore: Form::Text, "The symbols that contexts do not see.";
];

const WEIGHT: Member = key(
    "weight",
    Form::Positive,
    "How often it is taken, relative to the others; 1 if left out.",
);

const ALTERNATIVE: Shape = Shape {
    what: "an alternative",
    keys: &[&keys![
        needed to: Form::Text, "The word that replaces the module."
            => "this alternative has no word";
        =WEIGHT;
    ]],
    alternatives: &[],
    hint: "F: [\"F[+F]F\", {to: \"F[-F]F\", weight: 2}]",
};

const PRODUCTION: Shape = Shape {
    what: "a production",
    keys: &[&keys![
        needed production: Form::Text, "The production: `F -> F[+F]F`."
            => "this entry has no production";
        weight: Form::Positive, "How often it is taken, relative to others with weights that fit.";
    ]],
    alternatives: &[],
    hint: "- \"F -> F[+F]F\", or - {production: \"F -> F[+F]F\", weight: 1/3}",
};

const TROPISM: Shape = Shape {
    what: "a tropism",
    keys: &[&keys![
        needed towards: Form::Place, "The vector T; its length counts."
            => "this tropism has no direction";
        needed e: Form::Number, "The susceptibility to bending, in radians."
            => "this tropism has no `e`";
    ]],
    alternatives: &[],
    hint: "tropism: {towards: [0, -1, 0], e: 0.22}",
};

/// Help text for words that YAML does not read as text.
const QUOTE: &str = "a word that begins with a bracket, or with another sign of YAML, needs quotes: \
                     F: \"[+F]F\"";

impl OfKind for LSystemDocument {
    const TABLE: &'static KindTable = &KindTable {
        shape: &LSYSTEM,
        about: "An L-system: a word, what replaces its symbols, and what a turtle draws of it.",
        stand_in: "{axiom: F, productions: {}}",
    };

    fn read(reader: &mut Reader, fields: &Fields<'_>, metadata: MetadataDocument) -> Self {
        let is_in_space = read_space(reader, fields);
        reader.is_in_space = is_in_space;
        for key in ["up", "tropism"] {
            if !is_in_space && fields.take(key).is_some() {
                let message = format!("`{key}` is known in space only");
                let hint = "write `space: 3` at the top";
                reader.error_with_hint(fields.place_of(key), message, hint);
            }
        }
        let heading_node = fields.take("heading");
        let vector = heading_node.filter(|node| matches!(node.value, Value::Sequence(_)));
        if let Some(node) = vector.filter(|_| !is_in_space) {
            let message = "in the plane, a heading is an angle";
            reader.error_with_hint(&node.place, message, "heading: 90");
        }
        let start_vector = vector.map(|node| Box::new(reader.point(node)));
        let start = match vector {
            Some(_) => None,
            None => heading_node.map(|node| reader.number(node)),
        };
        let up = fields.take("up").map(|node| Box::new(reader.point(node)));
        let tropism = fields.take("tropism").and_then(|node| {
            let fields = reader.fields(node, &TROPISM)?;
            Some(Box::new(TropismDocument {
                towards: reader.point(fields.take("towards")?),
                susceptibility: reader.number(fields.take("e")?),
            }))
        });
        let stamps = read_stamps(reader, fields);
        let random = read_random(reader, fields.take("random"));
        let [angle, length, thinning] =
            ["angle", "length", "thinning"].map(|key| fields.optional(reader, key));
        let mut words = WordReader::new(reader);
        let axiom = fields.take("axiom").and_then(|node| words.of(node));
        let productions = fields.take("productions");
        let productions =
            productions.map_or_else(Vec::new, |node| read_productions(&mut words, node));
        let symbols = fields.take("symbols").and_then(|node| {
            let hint = "symbols: {G: draw, \"*\": {turn: 36}}";
            let what = "a mapping of symbols to actions";
            words.reader.entries(node, what, hint)
        });
        let symbols = symbols.unwrap_or_default().iter();
        let symbols = symbols.filter_map(|(key, node)| read_symbol(&mut words, key, node));
        let symbols = symbols.collect();
        let ignored = fields.take("ignore").and_then(|node| words.of(node));
        let ignored = ignored.into_iter().flat_map(|word| word.modules);
        (reader.is_in_space, reader.may_lie_in_space) = (false, false);
        Self {
            metadata,
            is_in_space,
            angle,
            start,
            start_vector,
            up,
            tropism,
            stamps,
            random,
            length,
            thinning,
            axiom,
            productions,
            symbols,
            ignored: ignored.map(|module| module.character).collect(),
        }
    }
}

fn read_stamps(reader: &mut Reader, fields: &Fields<'_>) -> Vec<(Written<String>, StampDocument)> {
    let Some(node) = fields.take("stamps") else {
        return Vec::new();
    };
    let hint = "stamps: {leaf: leaf, petal: {points: [[0, 0], [1/2, 1/4], [1, 0]], closed: true}}";
    let entries = reader.entries(node, "a mapping of names to base elements and sets", hint);
    let mut stamps = Vec::new();
    for (key, node) in entries.unwrap_or_default() {
        let name = Written {
            value: key.name.clone(),
            place: key.place.clone(),
        };
        // `solid` is known to base elements, too.
        let is_base_element = BASE_ELEMENT.members().any(|it| node.get(it.name).is_some());
        let is_set = !is_base_element && FORMS.iter().any(|it| node.get(it.name).is_some());
        let stamp = if is_set {
            let fields = reader.fields(node, &SET);
            fields.map(|fields| StampDocument::Set(Box::new(read_set(reader, &fields))))
        } else {
            Box::<BaseElementDocument>::from_node(reader, node).map(StampDocument::BaseElement)
        };
        stamps.extend(stamp.map(|stamp| (name, stamp)));
    }
    stamps
}

fn read_productions(words: &mut WordReader<'_>, node: &Node) -> Vec<ProductionDocument> {
    let mut productions = Vec::new();
    match &node.value {
        Value::Mapping(entries) => {
            for (key, node) in entries {
                read_entry(words, key, node, &mut productions);
            }
        }
        Value::Sequence(entries) => {
            for node in entries {
                productions.extend(read_production(words, node));
            }
        }
        _ => {
            let what = "a mapping of symbols to words";
            words
                .reader
                .mismatch(node, what, "productions: {F: F+F--F+F}");
        }
    }
    productions
}

/// Reads an entry of a list of productions, in the notation with an arrow.
fn read_production(words: &mut WordReader<'_>, node: &Node) -> Option<ProductionDocument> {
    let (text, weight) = match &node.value {
        Value::Mapping(entries) => {
            if let [(key, value)] = entries.as_slice()
                && PRODUCTION.members().all(|member| member.name != key.name)
                && value.written().is_some_and(|text| text.contains("->"))
            {
                let message = "YAML reads the ':' as that of a mapping";
                let hint = format!("quote the production: \"{}\"", node.place.text().trim());
                words.reader.error_with_hint(&key.place, message, hint);
                return None;
            }
            let fields = words.reader.fields(node, &PRODUCTION)?;
            let weight = fields.optional(words.reader, "weight");
            (fields.take("production")?, weight)
        }
        _ => (node, None),
    };
    let Some(written) = Text::of(text) else {
        words.reader.mismatch(text, "a production", PRODUCTION.hint);
        return None;
    };
    let Some((head, successor)) = written.at_arrow() else {
        let message = "a production has an arrow";
        let hint = "write F -> F+F, or a mapping of symbols to words: F: F+F";
        words.reader.error_with_hint(&text.place, message, hint);
        return None;
    };
    let head = words.head(written, head);
    let successor = words.part(written, successor);
    let head = head?;
    Some(ProductionDocument {
        left: head.left,
        predecessor: head.predecessor,
        right: head.right,
        condition: head.condition,
        successor,
        weight,
    })
}

/// Reads an entry of a mapping of predecessors to successors.
fn read_entry(
    words: &mut WordReader<'_>,
    key: &Key,
    node: &Node,
    productions: &mut Vec<ProductionDocument>,
) {
    let written = Text::of_key(key);
    let alternatives = match &node.value {
        Value::Sequence(entries) => {
            if let [entry] = entries.as_slice()
                && entry.written().is_some()
            {
                let message = "this is a list of one word";
                let hint = format!("quote the bracket: \"[{}]\"", entry.place.text());
                words.reader.error_with_hint(&node.place, message, hint);
            } else if entries.is_empty() {
                let message = "this is an empty list";
                words.reader.error_with_hint(&node.place, message, QUOTE);
            }
            let one = |node: &Node| Written {
                value: Expression::number(1.0),
                place: node.place.clone(),
            };
            entries
                .iter()
                .filter_map(|entry| {
                    let (word, weight) = read_alternative(words, entry)?;
                    Some((word, Some(weight.unwrap_or_else(|| one(entry)))))
                })
                .collect()
        }
        _ => read_alternative(words, node)
            .into_iter()
            .collect::<Vec<_>>(),
    };
    let Some(head) = words.head(written, 0..key.name.len()) else {
        return;
    };
    for (successor, weight) in alternatives {
        productions.push(ProductionDocument {
            left: head.left.clone(),
            predecessor: head.predecessor.clone(),
            right: head.right.clone(),
            condition: head.condition.clone(),
            successor,
            weight,
        });
    }
}

/// Reads a successor, possibly with a weight.
fn read_alternative(
    words: &mut WordReader<'_>,
    node: &Node,
) -> Option<(WordDocument, Option<WrittenNumber>)> {
    let Value::Mapping(entries) = &node.value else {
        if let Some(text) = Text::of(node)
            && let Some((before, _)) = text.at_arrow()
        {
            let place = node.within(before.end..before.end + 2);
            let message = "an arrow does not belong in a mapping";
            let hint = "write a list of productions: - \"A(w) : w > 1 -> A(w/2)\"";
            words.reader.error_with_hint(&place, message, hint);
            return None;
        }
        return Some((words.of(node)?, None));
    };
    let known = |name: &str| ALTERNATIVE.members().any(|member| member.name == name);
    if !entries.iter().any(|(key, _)| known(&key.name)) {
        let message = "YAML reads this as a mapping, a word is needed";
        words.reader.error_with_hint(&node.place, message, QUOTE);
        return None;
    }
    let fields = words.reader.fields(node, &ALTERNATIVE)?;
    let weight = fields.optional(words.reader, "weight");
    Some((words.of(fields.take("to")?)?, weight))
}

impl WordReader<'_> {
    /// Reads a node as a word. Reports a node that is not a word and returns `None`.
    fn of(&mut self, node: &Node) -> Option<WordDocument> {
        if let Some(text) = Text::of(node) {
            return Some(self.word(text));
        }
        let hint = match node.value {
            Value::Null => "quote a word that begins with '#', '~' or '!'; nothing at all is \"\"",
            _ => QUOTE,
        };
        self.reader.mismatch(node, "a word", hint);
        None
    }
}
