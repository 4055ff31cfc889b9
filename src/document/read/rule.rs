//! A rule: what its keys hold.

use crate::catalogue::Shelf;
use crate::diagnostic::{Diagnostics, Place};
use crate::document::node::{Node, Value};
use crate::document::reader::{Fields, Reader};
use crate::document::rule::{InitiatorDocument, RuleDocument};
use crate::document::shape::{Form, Member, Needed, Shape, Way, key};
use crate::document::style::{STYLE, VIEW, read_style, read_view};
use crate::rule::{Description, MOST_STEPS};

use super::base_element::{BASE_ELEMENT_OF, read_base_element};
use super::elements::{ELEMENTS, INITIATOR, read_initiator};
use super::generator::{GENERATOR_OF, read_generators};
use super::parameters::{PARAMS, read_params};
use super::select::{SELECTION_OF, read_select};

/// The keys of a rule.
pub(in crate::document) const RULE: Shape = Shape {
    what: "a rule",
    keys: &[&DESCRIPTION, &RULE_ALONE],
    ways: &[
        Way {
            needs: &["generator"],
            excludes: &["generators"],
        },
        Way {
            needs: &["generators"],
            excludes: &["generator"],
        },
    ],
    hint: "a rule is a mapping of keys: `kfrac cat koch` shows a short one",
};

/// The keys that describe a file and have no meaning inside another.
pub(in crate::document) const DESCRIPTION: [Member; 5] = [
    key("title", Form::Text, "A title, in a few words."),
    key("about", Form::Text, "A few sentences on what it is."),
    key(
        "source",
        Form::Text,
        "Where it comes from: who published it, and when.",
    ),
    key(
        "tags",
        Form::List(&Form::Text, 0, None),
        "Words by which `kfrac list WORD` finds it.",
    ),
    key(
        "format",
        Form::Exactly(FORMAT),
        "The version of this format; may be left out.",
    ),
];

/// The version of the format.
const FORMAT: u32 = 1;

/// The keys that only a rule has.
const RULE_ALONE: [Member; 13] = [
    key(
        "kind",
        Form::Words(&[KIND]),
        "The kind of file; may be left out.",
    ),
    key(
        "extends",
        Form::File(Shelf::Rules),
        "Another rule to start from, by name or by file. The keys written here replace its keys; \
         `params`, `style` and `view` merge entry by entry.",
    ),
    PARAMS,
    Member {
        needed: Needed::Alone,
        ..key(
            "initiator",
            Form::Either(&[
                Form::File(Shelf::Initiators),
                ELEMENTS,
                Form::Mapping(&INITIATOR),
            ]),
            "What the growth starts from: a name from the library, a list of points and elements, \
             or a mapping.",
        )
    },
    key(
        "generator",
        GENERATOR_OF,
        "What replaces an element at every step: a name from the library, a list of points and \
         elements from [0, 0] to [1, 0], or a mapping.",
    ),
    key(
        "generators",
        Form::Names(&GENERATOR_OF, 1),
        "Several generators, each under a name; `select`, or `use` on an element, says which one \
         replaces which element.",
    ),
    key(
        "select",
        SELECTION_OF,
        "Which of several generators replaces an element: by conditions tried in order, by index, \
         or at random.",
    ),
    key(
        "base_element",
        BASE_ELEMENT_OF,
        "What an element looks like: a name from the library, or an outline. A line, if left out.",
    ),
    key(
        "steps",
        Form::Whole(0, Some(MOST_STEPS)),
        "How often elements are replaced, if `--steps` does not say.",
    ),
    key(
        "dimension",
        Form::Number,
        "The published similarity dimension. It does not change the picture.",
    ),
    key(
        "hausdorff_dimension",
        Form::Number,
        "The published dimension of the set itself, where it is smaller because copies overlap.",
    ),
    key("style", Form::Mapping(&STYLE), "How it is drawn."),
    key(
        "view",
        Form::Mapping(&VIEW),
        "Which part of the plane is drawn.",
    ),
];

/// The only kind of file that there is beside components.
pub(in crate::document) const KIND: &str = "rule";

/// Reads a rule with its parents and components in it; `complete` if all of them were found.
pub(in crate::document) fn read(
    node: &Node,
    complete: bool,
    diagnostics: &mut Diagnostics,
) -> Option<RuleDocument> {
    let mut reader = Reader::after(diagnostics);
    let rule = read_rule(&mut reader, node, complete);
    diagnostics.extend(reader.diagnostics);
    rule
}

fn read_rule(reader: &mut Reader, node: &Node, complete: bool) -> Option<RuleDocument> {
    let fields = reader.fields(node, &RULE)?;
    let initiator = match fields.take("initiator") {
        Some(node) => read_initiator(reader, node),
        None => {
            let message = "the rule has no initiator";
            reader.error_with_hint(&first_line(fields.place), message, "initiator: segment");
            InitiatorDocument::missing(fields.place)
        }
    };
    Some(RuleDocument {
        description: read_description(reader, &fields),
        params: read_params(reader, fields.take("params")),
        initiator,
        generators: read_generators(reader, &fields),
        select: fields.take("select").map(|node| read_select(reader, node)),
        base_element: fields
            .take("base_element")
            .and_then(|node| read_base_element(reader, node)),
        steps: reader.optional_number(fields.take("steps")),
        dimension: reader.optional_number(fields.take("dimension")),
        hausdorff_dimension: reader.optional_number(fields.take("hausdorff_dimension")),
        style: read_style(reader, fields.take("style")),
        view: read_view(reader, fields.take("view")),
        complete: complete && !reader.names_are_missing,
    })
}

/// Reads what a component says of itself; only what is wrong with it matters.
pub(in crate::document) fn check_description(node: &Node, diagnostics: &mut Diagnostics) {
    const DESCRIBED: Shape = Shape {
        what: "a description",
        keys: &[&DESCRIPTION],
        ways: &[],
        hint: "title: Koch curve",
    };
    let mut reader = Reader::after(diagnostics);
    if let Some(fields) = reader.fields(node, &DESCRIBED) {
        read_description(&mut reader, &fields);
    }
    diagnostics.extend(reader.diagnostics);
}

fn read_description(reader: &mut Reader, fields: &Fields<'_>) -> Description {
    if let Some(format) = fields.take("format")
        && !matches!(format.value, Value::Number(version) if version == f64::from(FORMAT))
    {
        let message = format!(
            "version '{}' of the format is not known",
            format.place.text()
        );
        reader.error_with_hint(&format.place, message, "format: 1");
    }
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

/// The first line of a place: enough to say which mapping lacks something.
pub(super) fn first_line(place: &Place) -> Place {
    let end = place.text().find(['\n', '\r']);
    place.within(0..end.unwrap_or(usize::MAX))
}
