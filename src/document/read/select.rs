//! Reading of the selection of generators.

use crate::document::mapping::{FromNode, mapping};
use crate::document::node::{Node, Value};
use crate::document::reader::Reader;
use crate::document::rule::SelectDocument;
use crate::document::shape::{Form, Shape, alternative, keys};
use crate::document::{Written, WrittenNumber};

use super::parameters::written;

const SELECTION: Shape = Shape {
    what: "a selection",
    keys: &[&keys![
        by_index: Form::List(&Form::Text, 1, None),
            "Generators in turn: element 1 of a fractal takes the first, element 2 the second, and so \
             on round.";
        at_random: Form::Names(&Form::Positive, 1),
            "Generators with their weights: each element draws one of them.";
    ]],
    alternatives: &[
        alternative(&["by_index"], &["at_random"]),
        alternative(&["at_random"], &["by_index"]),
    ],
    hint: "a list of {when: CONDITION, use: NAME} that ends with {use: NAME}, or \
           {by_index: [NAME, NAME]}, or {at_random: {NAME: WEIGHT}}",
};

mapping! {
    /// A case of a selection, as written.
    struct CaseDocument: CASE = "a case of the selection",
        "- {when: age == 3, use: NAME}, and in the end - {use: NAME}";
    when: Option<WrittenNumber> = Form::Expression,
        "A condition such as `age == 3` or `odd(i)`, of the parameters and of `i`, `age`, `step` \
         and `length`. The last case has none.";
    needed use as generator: Option<Written<String>> = Form::Text,
        "The generator that replaces the element."
        => "this case names no generator";
}

/// Notations of a selection.
pub(super) const SELECTION_OF: Form = Form::Either(&[
    Form::List(&Form::Mapping(&CASE), 1, None),
    Form::Mapping(&SELECTION),
]);

pub(super) fn read_select(reader: &mut Reader, node: &Node) -> SelectDocument {
    if let Value::Sequence(entries) = &node.value {
        if entries.is_empty() {
            reader.error_with_hint(
                &node.place,
                "this selection selects nothing",
                SELECTION.hint,
            );
            return unknown(node);
        }
        let cases = entries.iter().map(|entry| {
            CaseDocument::from_node(reader, entry).unwrap_or_else(|| unknown_case(entry))
        });
        return SelectDocument::Cases(cases.collect(), node.place.clone());
    }
    let Some(fields) = reader.fields(node, &SELECTION) else {
        return unknown(node);
    };
    match (fields.take("by_index"), fields.take("at_random")) {
        (Some(list), None) => by_index(reader, list),
        (None, Some(weights)) => at_random(reader, weights),
        (Some(_), Some(_)) => {
            let message = "a selection goes by index or at random, not both";
            reader.error_with_hint(&node.place.first_line(), message, SELECTION.hint);
            unknown(node)
        }
        (None, None) => {
            // Unknown keys have been reported.
            if matches!(&node.value, Value::Mapping(entries) if entries.is_empty()) {
                let message = "this selection selects nothing";
                reader.error_with_hint(&node.place, message, SELECTION.hint);
            }
            unknown(node)
        }
    }
}

fn by_index(reader: &mut Reader, list: &Node) -> SelectDocument {
    let hint = "by_index: [gen0, gen1]";
    let entries = reader.filled(list, "a list of generators", "generator", hint);
    let names: Vec<_> = entries
        .iter()
        .filter_map(|entry| reader.name(entry))
        .collect();
    SelectDocument::ByIndex(names, list.place.clone())
}

fn at_random(reader: &mut Reader, weights: &Node) -> SelectDocument {
    let hint = "at_random: {gen0: 3, gen1: 1}";
    let Some(entries) = reader.entries(weights, "a mapping of weights", hint) else {
        return unknown(weights);
    };
    let entries = entries
        .iter()
        .map(|(key, node)| (written(key), reader.number(node)));
    SelectDocument::AtRandom(entries.collect(), weights.place.clone())
}

/// Returns a placeholder for an unreadable selection: a case with an unknown generator.
fn unknown(node: &Node) -> SelectDocument {
    SelectDocument::Cases(vec![unknown_case(node)], node.place.clone())
}

fn unknown_case(node: &Node) -> CaseDocument {
    CaseDocument {
        when: None,
        generator: None,
        place: node.place.clone(),
    }
}
