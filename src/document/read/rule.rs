//! Reading of production rules.

use crate::catalogue::Shelf;
use crate::document::node::Node;
use crate::document::reader::Reader;
use crate::document::rule::{InitiatorDocument, RuleDocument};
use crate::document::shape::{Form, Member, Shape, keys, way};
use crate::kind::Kind;

use super::base_element::{BASE_ELEMENT_OF, read_base_element};
use super::elements::{ELEMENTS, INITIATOR, read_initiator};
use super::generator::{GENERATOR_OF, read_generators};
use super::metadata::{DESCRIPTION, LIKING, read_heading};
use super::parameters::PARAMS;
use super::select::{SELECTION_OF, read_select};

/// Keys of a production rule.
pub(in crate::document) const RULE: Shape = Shape {
    what: "a rule",
    keys: &[&DESCRIPTION, &RULE_ALONE, &LIKING],
    ways: &[
        way(&["generator"], &["generators"]),
        way(&["generators"], &["generator"]),
    ],
    hint: "a rule is a mapping of keys: `kfrac cat koch` shows a short one",
};

/// Keys that only a production rule has.
const RULE_ALONE: [Member; 8] = keys![
    kind: Form::Words(&[Kind::Rule.name()]), "The kind of file; may be left out.";
    extends: Form::File(Shelf::RULES),
        "Another rule to start from, by name or by file. The keys written here replace its keys; \
         `params`, `style` and `view` merge entry by entry.";
    =PARAMS;
    alone initiator: Form::Either(&[Form::File(Shelf::Initiators), ELEMENTS, Form::Mapping(&INITIATOR)]),
        "What the growth starts from: a name from the library, a list of points and elements, or a \
         mapping."
        => "the rule has no initiator", "initiator: segment";
    generator: GENERATOR_OF,
        "What replaces an element at every step: a name from the library, a list of points and \
         elements from [0, 0] to [1, 0], or a mapping.";
    generators: Form::Names(&GENERATOR_OF, 1),
        "Several generators, each under a name; `select`, or `use` on an element, says which one \
         replaces which element.";
    select: SELECTION_OF,
        "Which of several generators replaces an element: by conditions tried in order, by index, or \
         at random.";
    base_element: BASE_ELEMENT_OF,
        "What an element looks like: a name from the library, or an outline. A line, if left out.";
];

/// Reads a rule whose parents and components are inlined. `complete` states that all of them were
/// found.
pub(super) fn read_rule(reader: &mut Reader, node: &Node, complete: bool) -> Option<RuleDocument> {
    let fields = reader.fields(node, &RULE)?;
    let initiator = match fields.take("initiator") {
        Some(node) => read_initiator(reader, node),
        None => InitiatorDocument::missing(fields.place),
    };
    let heading = read_heading(reader, &fields);
    let mut rule = RuleDocument {
        heading,
        initiator,
        generators: read_generators(reader, &fields),
        select: fields.take("select").map(|node| read_select(reader, node)),
        base_element: fields
            .take("base_element")
            .and_then(|node| read_base_element(reader, node)),
    };
    rule.heading.complete = complete && !reader.names_are_missing;
    Some(rule)
}
