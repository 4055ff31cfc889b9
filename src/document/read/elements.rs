//! Reading of lists of elements and of initiators.

use crate::document::WrittenPoint;
use crate::document::node::{Node, Value};
use crate::document::reader::{Fields, Reader};
use crate::document::rule::{Entry, InitiatorDocument, Listed};
use crate::document::shape::{Form, Shape, keys};

use super::base_element::{BASE_ELEMENT_OF, read_base_element};

const ELEMENT: Shape = Shape {
    what: "an element",
    keys: &[&keys![
        from: Form::Point, "Where the element runs from; where the one before it ends, if left out.";
        needed to: Form::Point, "Where the element runs to."
            => "this element does not say where it runs to";
        direction: Form::Whole(1, Some(4)),
            "How the copy that takes its place is flipped: 1 normal (if left out), 2 y reflected (its \
             sides swapped), 3 x reflected (its ends swapped), 4 both.";
        fertile: Form::Flag(true),
            "Whether the element is replaced; if not, it stays as it is for ever.";
        visible: Form::Flag(true),
            "Whether the element is drawn. It counts, and is replaced if it is fertile, all the same.";
        connected: Form::Flag(true), "Whether the element may join the one before it.";
        use: Form::Text, "The generator that replaces this element, whatever `select` says.";
        base_element: BASE_ELEMENT_OF,
            "What this element looks like, if not like the others: a name from the library, or a shape \
             of its own.";
    ]],
    ways: &[],
    hint: "an element is written {to: [1, 0]}, {from: [0, 0], to: [1, 0]} or as a point, [1, 0]",
};

/// A list of elements.
pub(in crate::document) const ELEMENTS: Form = Form::List(
    &Form::Either(&[Form::Point, Form::Mapping(&ELEMENT)]),
    1,
    None,
);

/// Description of lists of elements in the schema.
pub(super) const ABOUT_ELEMENTS: &str = "A list of points and elements: a chain runs from each \
    point to the next. Begin with a point, or with an element that has `from`.";

pub(in crate::document) const INITIATOR: Shape = Shape {
    what: "an initiator",
    keys: &[&keys![
        needed elements: ELEMENTS, ABOUT_ELEMENTS
            => "an initiator needs `elements`", "elements: [[0, 0], [1, 0]]";
        closed: Form::Flag(false),
            "Whether one more element runs from the last point back to the first.";
        connected: Form::Flag(true), "Whether elements join each other at all.";
    ]],
    ways: &[],
    hint: "a name from the library (initiator: segment), a list of points, or \
           {elements: [...], closed: true}",
};

const LIST: &str =
    "a list of points and elements: - [0, 0], then - [1, 0] or - {to: [1, 0], fertile: false}";

pub(super) fn read_initiator(reader: &mut Reader, node: &Node) -> InitiatorDocument {
    let mut initiator = InitiatorDocument::missing(&node.place);
    if let Value::Sequence(_) = node.value {
        initiator.entries = read_entries(reader, node);
        return initiator;
    }
    if reader.is_component(node) {
        return initiator;
    }
    if let Some(fields) = reader.fields(node, &INITIATOR) {
        initiator.closed = reader.flag(&fields, "closed");
        initiator.connected = reader.flag(&fields, "connected");
        initiator.entries = listed_entries(reader, &fields);
    }
    initiator
}

/// Reads the key `elements` of an initiator, a generator or a part.
pub(super) fn listed_entries(reader: &mut Reader, fields: &Fields<'_>) -> Vec<Entry> {
    let node = fields.take("elements");
    node.map_or_else(Vec::new, |node| read_entries(reader, node))
}

/// Reads the list of elements of an initiator or of a part.
pub(super) fn read_entries(reader: &mut Reader, node: &Node) -> Vec<Entry> {
    let list = reader.list(node, "a list of elements", LIST);
    let entries: Vec<_> = list.iter().map(|entry| read_entry(reader, entry)).collect();
    match (&node.value, entries.as_slice()) {
        (Value::Sequence(_), [] | [Entry::Point(_)]) => {
            reader.error_with_hint(&node.place, "there is no element in this list", LIST);
        }
        (_, [Entry::Element(first), ..]) if first.from.is_none() => reader.error_with_hint(
            &first.place.first_line(),
            "the first element does not say where it runs from",
            "begin the list with a point, - [0, 0], or give the element `from`",
        ),
        _ => {}
    }
    entries
}

fn read_entry(reader: &mut Reader, node: &Node) -> Entry {
    match &node.value {
        Value::Sequence(_) => return Entry::Point(reader.point(node)),
        Value::Mapping(_) => {}
        _ => {
            reader.mismatch(node, "a point or an element", ELEMENT.hint);
            return Entry::Point(WrittenPoint::unknown(&node.place));
        }
    }
    let Some(fields) = reader.fields(node, &ELEMENT) else {
        return Entry::Point(WrittenPoint::unknown(&node.place));
    };
    let to = reader.optional_point(fields.take("to"));
    Entry::Element(Box::new(Listed {
        from: reader.optional_point(fields.take("from")),
        to: to.unwrap_or_else(|| WrittenPoint::unknown(&node.place)),
        direction: reader.optional_number(fields.take("direction")),
        fertile: reader.flag(&fields, "fertile"),
        visible: reader.flag(&fields, "visible"),
        connected: reader.flag(&fields, "connected"),
        generator: fields.take("use").and_then(|node| reader.name(node)),
        base_element: fields
            .take("base_element")
            .and_then(|node| read_base_element(reader, node)),
        place: node.place.clone(),
    }))
}
