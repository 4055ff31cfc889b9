//! Reading of lists of elements and of initiators.

use std::borrow::Cow;

use crate::diagnostic::Place;
use crate::document::mapping::{FromNode, mapping};
use crate::document::node::{Node, Value};
use crate::document::reader::{Fields, Reader};
use crate::document::rule::Entry;
use crate::document::shape::{Form, KeySet, Shape, alternative, keys};
use crate::document::{BaseElementDocument, FractalDocument, Written, WrittenNumber, WrittenPoint};
use crate::metadata::MAX_STEPS;

use super::base_element::BASE_ELEMENT_OF;
use super::space::{InSpace, only_in_space};
use super::tint::{TINT_OF, TintDocument};

mapping! {
    /// An element of a list, as written.
    struct Listed: ELEMENT = "an element",
        "an element is written {to: [1, 0]}, {from: [0, 0], to: [1, 0]} or as a point, [1, 0]", &ALTERNATIVES;
    from: Option<WrittenPoint> = Form::Place,
        "Where the element runs from; where the one before it ends, if left out.";
    to: Option<WrittenPoint> = Form::Place, "Where the element runs to.";
    face: Option<Vec<WrittenPoint>> = Form::List(&Form::Place, 3, None),
        "In space, in place of `from`, `to` and `normal`: a polygon, counter-clockwise from outside. The element runs \
         from its first point to the second, with its normal; the polygon must be similar to the first surface of the \
         base element.";
    corners: Option<Vec<WrittenPoint>> = Form::List(&Form::Place, 3, Some(3)),
        "In space, in place of `face`: three points, to which an affine map takes the first three corners of the base \
         element, or (0, 0, 0), (1, 0, 0) and (0, 1, 0). They may be any triangle.";
    up: Option<WrittenPoint> = Form::Place,
        "Beside `corners`: the vector to which the map takes [0, 0, 1]; across the corners and as long as their first \
         side, if left out.";
    normal: Option<WrittenPoint> = Form::Place,
        "In space, the direction to which the front of the element's surface points, [0, 0, 1] in its own frame. If \
         left out, the frame is turned as little as possible from the x axis to the element.";
    roll: Option<WrittenNumber> = Form::Number,
        "In space, in place of `normal`: an angle in degrees by which the frame is turned about the element.";
    direction: Option<WrittenNumber> = Form::Whole(1, Some(8)),
        "How the copy that takes its place is flipped: 1 normal (if left out), 2 y reflected (its \
         sides swapped), 3 x reflected (its ends swapped), 4 both. In space, 5 to 8 are these with z reflected.";
    fertile: bool = Form::Flag(true),
        "Whether the element is replaced; if not, it stays as it is for ever.";
    visible: bool = Form::Flag(true),
        "Whether the element is drawn. It counts, and is replaced if it is fertile, all the same.";
    connected: bool = Form::Flag(true), "Whether the element may join the one before it.";
    use as generator: Option<Written<String>> = Form::Text,
        "The generator that replaces this element, in place of the one that `select` chooses.";
    base_element: Option<Box<BaseElementDocument>> = BASE_ELEMENT_OF,
        "What this element looks like, if not like the others: a name from the library, or a shape \
         of its own.";
    tint: Option<Box<TintDocument>> = TINT_OF,
        "What it colours the element with, and all that replaces it.";
}

impl Listed {
    /// Returns the point where the element runs to; a placeholder if that is missing, which has been reported.
    pub(crate) fn end(&self) -> Cow<'_, WrittenPoint> {
        match &self.to {
            Some(to) => Cow::Borrowed(to),
            None => Cow::Owned(WrittenPoint::unknown(&self.place)),
        }
    }
}

const ALTERNATIVES: [KeySet; 4] = [
    alternative(&["to"], &["face", "corners", "up", "roll"]),
    alternative(&["to"], &["face", "corners", "up", "normal"]),
    alternative(
        &["face"],
        &["from", "to", "corners", "up", "normal", "roll"],
    ),
    alternative(&["corners"], &["from", "to", "face", "normal", "roll"]),
];

/// A list of elements.
pub(in crate::document) const ELEMENTS: Form = Form::List(
    &Form::Either(&[Form::Place, Form::Mapping(&ELEMENT)]),
    1,
    None,
);

/// Description of a list of elements.
macro_rules! about_elements {
    () => {
        "A list of points and elements: a chain runs from each point to the next. Begin with a point, \
         or with an element that has `from`."
    };
}

pub(super) use about_elements;

/// An initiator as written.
#[derive(Clone, Debug)]
pub struct InitiatorDocument {
    /// Points and elements; none where it is an approximant.
    pub entries: Vec<Entry>,
    /// Approximant of another rule whose elements it has.
    pub approximant: Option<Box<FractalDocument>>,
    /// Whether one more element runs from the last point back to the first.
    pub closed: bool,
    /// Whether elements join each other at all.
    pub connected: bool,
    /// Source span of the mapping.
    pub place: Place,
}

/// Keys of an initiator.
pub(in crate::document) const INITIATOR: Shape = Shape {
    what: "an initiator",
    keys: &[&keys![
        space: Form::Whole(2, Some(3)), "3 for an initiator in space, 2 or nothing for one in the plane.";
        elements: ELEMENTS, about_elements!();
        from: Form::Grown,
            "In place of `elements`: another production rule of the plane, by name, by file or written out. The elements of its \
             approximant, with their directions, are those of the initiator.";
        steps: Form::Whole(0, Some(MAX_STEPS)),
            "Beside `from`: the number of steps of the approximant; that of the rule's file, if left out.";
        seed: Form::Whole(0, None), "Beside `from`: the seed of random draws; 0 if left out.";
        closed: Form::Flag(false),
            "Whether one more element runs from the last point back to the first.";
        connected: Form::Flag(true), "Whether elements join each other at all.";
    ]],
    alternatives: &[
        alternative(&["elements"], &["from", "steps", "seed"]),
        alternative(&["from"], &["elements", "closed", "connected"]),
    ],
    hint: "a name from the library (initiator: segment), a list of points, or \
           {elements: [...], closed: true}",
};

impl InitiatorDocument {
    /// Returns an initiator with nothing but a list; an empty one stands for one that cannot be read.
    pub(super) fn listed(entries: Vec<Entry>, place: &Place) -> Self {
        Self {
            entries,
            approximant: None,
            closed: false,
            connected: true,
            place: place.clone(),
        }
    }
}

const LIST: &str =
    "a list of points and elements: - [0, 0], then - [1, 0] or - {to: [1, 0], fertile: false}";

pub(super) fn read_initiator(reader: &mut Reader, node: &Node) -> InitiatorDocument {
    let initiator = match &node.value {
        Value::Sequence(_) => {
            let entries = Vec::from_node(reader, node);
            entries.map(|entries| InitiatorDocument::listed(entries, &node.place))
        }
        _ if reader.is_component(node) => None,
        _ => read_keys(reader, node),
    };
    initiator.unwrap_or_else(|| InitiatorDocument::listed(Vec::new(), &node.place))
}

fn read_keys(reader: &mut Reader, node: &Node) -> Option<InitiatorDocument> {
    let fields = reader.fields(node, &INITIATOR)?;
    let _: Option<InSpace> = fields.read(reader, "space");
    let approximant = fields.take("from");
    let elements = fields.take("elements");
    match (elements, approximant) {
        (None, None) => {
            let message = "an initiator needs `elements`";
            let hint = "elements: [[0, 0], [1, 0]]";
            reader.error_with_hint(&fields.place.first_line(), message, hint);
            return None;
        }
        (Some(_), Some(_)) => reader.error_with_hint(
            fields.place_of("from"),
            "`from` and `elements` cannot stand together",
            "leave out either: an approximant has its own elements",
        ),
        (Some(_), None) => {
            for key in ["steps", "seed"] {
                if let Some(node) = fields.take(key) {
                    let message = format!("`{key}` belongs to an approximant");
                    let hint = "{from: koch, steps: 3}";
                    reader.error_with_hint(&node.place, message, hint);
                }
            }
        }
        (None, Some(from)) => {
            if reader.is_in_space {
                let message = "an approximant is an initiator in the plane only";
                reader.error_with_hint(&from.place.first_line(), message, "write the elements out");
            }
            let approximant = FractalDocument::initiator(reader, &fields, from).map(Box::new);
            return Some(InitiatorDocument {
                approximant,
                ..InitiatorDocument::listed(Vec::new(), &node.place)
            });
        }
    }
    Some(InitiatorDocument {
        entries: fields.read(reader, "elements")?,
        approximant: None,
        closed: fields.read(reader, "closed")?,
        connected: fields.read(reader, "connected")?,
        place: node.place.clone(),
    })
}

impl FromNode for Vec<Entry> {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        let list = reader.list(node, "a list of elements", LIST);
        let entries: Vec<_> = list.iter().map(|entry| read_entry(reader, entry)).collect();
        match (&node.value, entries.as_slice()) {
            (Value::Sequence(_), [] | [Entry::Point(_)]) => {
                reader.error_with_hint(&node.place, "there is no element in this list", LIST);
            }
            (_, [Entry::Element(first), ..]) if first.from.is_none() => reader.error_with_hint(
                &first.place.first_line(),
                "the first element has no start point",
                "begin the list with a point, - [0, 0], or give the element `from`",
            ),
            _ => {}
        }
        Some(entries)
    }

    fn absent(_: &Fields<'_>, _: &'static str) -> Option<Self> {
        Some(Self::new())
    }
}

fn read_entry(reader: &mut Reader, node: &Node) -> Entry {
    let unknown = || Entry::Point(WrittenPoint::unknown(&node.place));
    if let Some(point) = reader.complex(node) {
        return Entry::Point(point);
    }
    match &node.value {
        Value::Sequence(_) => Entry::Point(reader.point(node)),
        Value::Mapping(_) => read_listed(reader, node)
            .map_or_else(unknown, |listed| Entry::Element(Box::new(listed))),
        _ => {
            reader.mismatch(node, "a point or an element", ELEMENT.hint);
            unknown()
        }
    }
}

/// Reads an element with attributes; its face or its corners, if there are any, become its ends.
fn read_listed(reader: &mut Reader, node: &Node) -> Option<Listed> {
    let mut listed = Listed::from_node(reader, node)?;
    for key in ["face", "corners", "up", "normal", "roll"] {
        only_in_space(reader, node, key);
    }
    if let (Some(_), Some(roll)) = (&listed.normal, &listed.roll) {
        let message = "`normal` and `roll` cannot stand together";
        reader.error_with_hint(
            &roll.place,
            message,
            "either of them turns the frame about the element",
        );
    }
    let (name, polygon) = match (&listed.face, &listed.corners) {
        (Some(face), _) => ("face", face),
        (None, Some(corners)) => ("corners", corners),
        (None, None) => {
            if listed.to.is_none() {
                let message = "this element has no end point";
                reader.error_with_hint(&node.place.first_line(), message, ELEMENT.hint);
            }
            if let Some(up) = &listed.up {
                let message = "`up` goes with `corners`";
                let hint = "the front of other elements is given by `normal`";
                reader.error_with_hint(&up.place, message, hint);
            }
            return Some(listed);
        }
    };
    for key in ["from", "to", "corners", "up", "normal", "roll"] {
        if let Some(node) = node.get(key)
            && (name == "face" || !matches!(key, "corners" | "up"))
        {
            let message = format!("`{key}` does not go with `{name}`");
            let hint =
                "its first two points are the ends of the element, and all say how it is turned";
            reader.error_with_hint(&node.place, message, hint);
        }
    }
    let place = || node.get(name).map_or(&node.place, |node| &node.place);
    match polygon.as_slice() {
        [from, to, _, more @ ..] if name == "face" || more.is_empty() => {
            let ends = [from, to].map(Clone::clone);
            [listed.from, listed.to] = ends.map(Some);
        }
        _ => {
            let (points, more) = match name {
                "face" => ("a face has", " or more"),
                _ => ("`corners` are", ""),
            };
            let message = format!("{points} three points{more}, not {}", polygon.len());
            let hint = format!("{name}: [[0, 0, 0], [1, 0, 0], [1, 1, 0]]");
            reader.error_with_hint(place(), message, hint);
        }
    }
    Some(listed)
}
