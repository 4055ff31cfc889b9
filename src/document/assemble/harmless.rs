//! Placeholders for missing parents and components, which cause no further diagnostics.

use crate::catalogue::Shelf;
use crate::diagnostic::Place;
use crate::document::merge::Entries;
use crate::document::node::{Key, Node, Value};
use crate::kind::Kind;

/// Returns placeholder entries for a missing parent.
pub(super) fn harmless_parent(place: &Place, kind: Kind) -> Entries {
    let key = |name: &str| Key {
        name: name.into(),
        place: place.clone(),
    };
    let node = |value| Node {
        place: place.clone(),
        value,
    };
    match kind {
        Kind::Rule => vec![
            (key("initiator"), harmless(Shelf::Initiators, place)),
            (key("generator"), harmless(Shelf::Generators, place)),
        ],
        Kind::LSystem => vec![
            (key("axiom"), node(Value::Text("F".into()))),
            (key("productions"), node(Value::Mapping(Vec::new()))),
        ],
        Kind::Ifs => {
            let map = Value::Mapping(vec![(key("scale"), node(Value::Number(0.5)))]);
            vec![(key("maps"), node(Value::Sequence(vec![node(map)])))]
        }
        Kind::Instancing => {
            let segment = [0.0, 1.0].map(|x| {
                node(Value::Sequence(
                    [x, 0.0].map(|x| node(Value::Number(x))).into(),
                ))
            });
            let segment = (key("segment"), node(Value::Sequence(segment.into())));
            let union = node(Value::Sequence(vec![node(Value::Mapping(vec![segment]))]));
            let objects = Value::Mapping(vec![(key("object"), union.clone())]);
            vec![(key("objects"), node(objects)), (key("scene"), union)]
        }
    }
}

/// Returns a placeholder for a missing component.
pub(super) fn harmless(shelf: Shelf, place: &Place) -> Node {
    let node = |value| Node {
        place: place.clone(),
        value,
    };
    let number = |value| node(Value::Number(value));
    // An element that is shorter than the replaced one avoids the warning about generators that do not
    // shrink.
    let line = [0.0, 0.5].map(|x| node(Value::Sequence(vec![number(x), number(0.0)])));
    let key = if shelf == Shelf::BaseElements {
        "points"
    } else {
        "elements"
    };
    let key = Key {
        name: key.into(),
        place: place.clone(),
    };
    node(Value::Mapping(vec![(
        key,
        node(Value::Sequence(line.to_vec())),
    )]))
}
