//! Lists of elements, and initiators.

use crate::document::Point;
use crate::document::node::{Node, Value};
use crate::document::reader::{Fields, Reader};
use crate::document::rule::{Entry, InitiatorDocument, Listed};
use crate::document::shape::Shape;

use super::base_element::read_base_element;
use super::rule::first_line;

const ELEMENT: Shape = Shape {
    what: "an element",
    keys: &[
        "from",
        "to",
        "direction",
        "fertile",
        "visible",
        "connected",
        "use",
        "base_element",
    ],
    hint: "an element is written {to: [1, 0]}, {from: [0, 0], to: [1, 0]} or as a point, [1, 0]",
};

const INITIATOR: Shape = Shape {
    what: "an initiator",
    keys: &["elements", "closed", "connected"],
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
        initiator.closed = reader.flag(fields.take("closed"), false);
        initiator.connected = reader.flag(fields.take("connected"), true);
        initiator.entries = required_entries(reader, &fields, INITIATOR.what);
    }
    initiator
}

/// The `elements` of an initiator, a generator or a part.
pub(super) fn required_entries(reader: &mut Reader, fields: &Fields<'_>, what: &str) -> Vec<Entry> {
    if let Some(node) = fields.take("elements") {
        return read_entries(reader, node);
    }
    reader.error_with_hint(
        &first_line(fields.place),
        format!("{what} needs `elements`"),
        "elements: [[0, 0], [1, 0]]",
    );
    Vec::new()
}

/// The list of elements of an initiator or of a part.
pub(super) fn read_entries(reader: &mut Reader, node: &Node) -> Vec<Entry> {
    let list = reader.list(node, "a list of elements", LIST);
    let entries: Vec<_> = list.iter().map(|entry| read_entry(reader, entry)).collect();
    match (&node.value, entries.as_slice()) {
        (Value::Sequence(_), [] | [Entry::Point(_)]) => {
            reader.error_with_hint(&node.place, "there is no element in this list", LIST);
        }
        (_, [Entry::Element(first), ..]) if first.from.is_none() => reader.error_with_hint(
            &first_line(&first.place),
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
            return Entry::Point(Point::unknown(&node.place));
        }
    }
    let Some(fields) = reader.fields(node, &ELEMENT) else {
        return Entry::Point(Point::unknown(&node.place));
    };
    let to = reader.optional_point(fields.take("to")).unwrap_or_else(|| {
        let message = "this element does not say where it runs to";
        reader.error_with_hint(&first_line(&node.place), message, ELEMENT.hint);
        Point::unknown(&node.place)
    });
    Entry::Element(Box::new(Listed {
        from: reader.optional_point(fields.take("from")),
        to,
        direction: reader.optional_number(fields.take("direction")),
        fertile: reader.flag(fields.take("fertile"), true),
        visible: reader.flag(fields.take("visible"), true),
        connected: reader.flag(fields.take("connected"), true),
        generator: fields.take("use").and_then(|node| reader.name(node)),
        base_element: fields
            .take("base_element")
            .and_then(|node| read_base_element(reader, node)),
        place: node.place.clone(),
    }))
}
