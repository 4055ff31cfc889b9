//! Reading of production rules.

use crate::catalogue::Shelf;
use crate::document::MetadataDocument;
use crate::document::reader::{Fields, Reader};
use crate::document::rule::RuleDocument;
use crate::document::shape::{Form, Member, Shape, alternative, keys};
use crate::kind::Kind;

use super::base_element::BASE_ELEMENT_OF;
use super::elements::{ELEMENTS, INITIATOR, InitiatorDocument, read_initiator};
use super::generator::{GENERATOR_OF, read_generators};
use super::metadata::{DESCRIPTION, LIKING};
use super::parameters::PARAMS;
use super::select::{SELECTION_OF, read_select};
use super::space::{SPACE, read_space};
use super::{KindTable, OfKind};

/// Keys of a production rule.
pub(in crate::document) const RULE: Shape = Shape {
    what: "a rule",
    keys: &[&DESCRIPTION, &RULE_ALONE, &LIKING],
    alternatives: &[
        alternative(&["generator"], &["generators"]),
        alternative(&["generators"], &["generator"]),
    ],
    hint: "a rule is a mapping of keys: `kfrac cat koch` shows a short one",
};

/// Keys that only a production rule has.
const RULE_ALONE: [Member; 9] = keys![
    kind: Form::Words(&[Kind::Rule.name()]), "The kind of file; may be left out.";
    extends: Form::File(Shelf::RULES),
        "Another rule to start from, by name or by file. The keys written here replace its keys; \
         `params`, `style` and `view` merge entry by entry.";
    =SPACE;
    =PARAMS;
    alone initiator: Form::Either(&[Form::File(Shelf::Initiators), ELEMENTS, Form::Mapping(&INITIATOR)]),
        "What the growth starts from: a name from the library, a list of points and elements, or a \
         mapping."
        => "the rule has no initiator", "initiator: segment";
    generator: GENERATOR_OF,
        "What replaces an element at every step: a name from the library, a list of points and \
         elements from [0, 0] to [1, 0], or a mapping.";
    generators: Form::Names(&GENERATOR_OF, 1),
        "Several generators, each under a name; `select`, or `use` on an element, assigns one \
         to each element.";
    select: SELECTION_OF,
        "Which of several generators replaces an element: by conditions tried in order, by index, or \
         at random.";
    base_element: BASE_ELEMENT_OF,
        "What an element looks like: a name from the library, or an outline. A line, if left out.";
];

impl OfKind for RuleDocument {
    const TABLE: &'static KindTable = &KindTable {
        shape: &RULE,
        about: "A production rule: what the growth starts from, and what replaces an element.",
        stand_in: "{initiator: {elements: [[0, 0], [0.5, 0]]}, generator: {elements: [[0, 0], [0.5, 0]]}}",
    };

    fn read(reader: &mut Reader, fields: &Fields<'_>, metadata: MetadataDocument) -> Self {
        let is_in_space = read_space(reader, fields);
        reader.is_in_space = is_in_space;
        let initiator = match fields.take("initiator") {
            Some(node) => read_initiator(reader, node),
            None => InitiatorDocument::listed(Vec::new(), fields.place),
        };
        let rule = Self {
            metadata,
            is_in_space,
            initiator,
            generators: read_generators(reader, fields),
            select: fields.take("select").map(|node| read_select(reader, node)),
            base_element: fields.optional(reader, "base_element"),
        };
        (reader.is_in_space, reader.may_lie_in_space) = (false, false);
        rule
    }
}
