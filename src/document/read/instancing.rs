//! Reading of instancing structures.

use crate::catalogue::Shelf;
use crate::diagnostic::Place;
use crate::document::MetadataDocument;
use crate::document::instancing::{
    AlternativeDocument, InstanceDocument, InstancingDocument, LevelDocument, MasterDocument,
    ObjectDocument, UnionDocument,
};
use crate::document::node::{Key, Node, Value};
use crate::document::reader::{Fields, Reader};
use crate::document::shape::{Form, Member, Shape, alternative, keys};
use crate::document::{Written, WrittenNumber};
use crate::expression::Expression;
use crate::kind::Kind;

use super::generator::read_random;
use super::metadata::{DESCRIPTION, LIKING};
use super::parameters::PARAMS;
use super::set::{FORMS, OF_FRACTAL, SET, read_initial, read_set};
use super::space::{SPACE, read_space};
use super::tint::TINT_OF;
use super::transform::{TRANSFORMS, read_transforms};
use super::{KindTable, OfKind};

/// Keys of an instancing structure.
const INSTANCING: Shape = Shape {
    what: "an instancing structure",
    keys: &[&DESCRIPTION, &INSTANCING_ALONE, &LIKING],
    alternatives: &[],
    hint: "a structure is a mapping of keys: `kfrac cat gasket-recursive` shows a short one",
};

/// Keys that only an instancing structure has.
const INSTANCING_ALONE: [Member; 8] = keys![
    needed kind: Form::Words(&[Kind::Instancing.name()]), "The kind of file.";
    =SPACE;
    extends: Form::File(Shelf::INSTANCING),
        "Another structure to start from, by name or by file. The keys written here replace its keys; \
         `params`, `style` and `view` merge entry by entry.";
    =PARAMS;
    random: Form::Names(&Form::Expression, 0),
        "Random variables, drawn whenever an object is replaced, for the transforms of its instances: \
         uniform(a, b), normal(mean, deviation) or choice(a, b, ...).";
    alone objects: Form::Names(&UNION_OF, 1),
        "The canonical objects, by name: each a union of instances. An object with a level is written \
         `A(n)`, and `A(0)` for one level that is another."
        => "the structure has no objects";
    alone scene: UNION_OF, "The object that places the scene."
        => "the structure has no scene", "scene: [A] places the object A";
    initial: Form::Mapping(&SET),
        "What stands for an object that has not been replaced yet. If left out, nothing does where \
         there are shapes, or else the box of the object's limit set.";
];

const UNION_OF: Form = Form::Either(&[INSTANCES, Form::Mapping(&UNION)]);

const INSTANCES: Form = Form::List(&ONE_INSTANCE, 1, None);

const SOME_INSTANCES: Form = Form::List(&ONE_INSTANCE, 0, None);

/// A mapping, or a name, possibly with a level, which is never a plain number.
const ONE_INSTANCE: Form = Form::Either(&[Form::Expression, Form::Mapping(&INSTANCE)]);

const UNION: Shape = Shape {
    what: "an object",
    keys: &[
        &keys![
            union: INSTANCES, "The instances: names of objects, or mappings.";
            at_random: Form::List(&Form::Either(&[SOME_INSTANCES, Form::Mapping(&ALTERNATIVE)]), 1, None),
                "Unions of which one is drawn for every instance of the object, by its `weight`; `[]` for nothing.";
        ],
        &TRANSFORMS,
    ],
    alternatives: &[
        alternative(&["union"], &["at_random"]),
        alternative(&["at_random"], &["union"]),
    ],
    hint: "{union: [up, left, right], scale: 1/2, translate: [0, 1/2]}",
};

const ALTERNATIVE: Shape = Shape {
    what: "an alternative",
    keys: &[
        &keys![
            needed union: SOME_INSTANCES, "The instances: names of objects, or mappings; `[]` for nothing."
                => "an alternative needs a `union` of instances";
            weight: Form::Positive, "How often it is drawn, relative to the others; 1 if left out.";
        ],
        &TRANSFORMS,
    ],
    alternatives: &[],
    hint: "at_random: [{union: [left, right], weight: 3}, [tip]]",
};

const INSTANCE: Shape = Shape {
    what: "an instance",
    keys: &[
        &keys![
            object: Form::Text,
                "The object that it is one of; with its level in brackets, if it has one. In space, sphere, \
                 plane, cylinder and cone are objects unless the file has others of these names.";
            tint: TINT_OF, "What it colours all that is in it with.";
            repeat: Form::Mapping(&LOOP),
                "Further instances, each transformed once more than the one before: {count: 12, rotate: 30}.";
        ],
        &FORMS,
        &OF_FRACTAL,
        &TRANSFORMS,
    ],
    alternatives: &[],
    hint: "the name of an object, {object: up, scale: 1/2}, or {segment: [[0, 0], [0, 1]]}",
};

/// Keys of repeated instances, which are written out before they are read.
const LOOP: Shape = Shape {
    what: "a loop",
    keys: &[
        &keys![
            needed count: Form::Number, "The number of instances, the first included."
                => "a repetition needs a `count`";
        ],
        &TRANSFORMS,
    ],
    alternatives: &[],
    hint: "repeat: {count: 12, rotate: 30}",
};

impl OfKind for InstancingDocument {
    const TABLE: &'static KindTable = &KindTable {
        shape: &INSTANCING,
        about: "A structure of objects that instance each other, or themselves.",
        stand_in: "{objects: {object: [{segment: [[0, 0], [1, 0]]}]}, scene: [{segment: [[0, 0], [1, 0]]}]}",
    };

    fn read(reader: &mut Reader, fields: &Fields<'_>, metadata: MetadataDocument) -> Self {
        let is_in_space = read_space(reader, fields);
        reader.is_in_space = is_in_space;
        let objects = { fields.take("objects") }
            .and_then(|node| reader.entries(node, "a mapping of names to objects", UNION.hint));
        let objects = objects.unwrap_or_default().iter();
        let objects = objects.filter_map(|(key, node)| read_object(reader, key, node));
        let objects = objects.collect();
        let random = read_random(reader, fields.take("random"));
        let scene = fields.take("scene");
        let document = Self {
            metadata,
            is_in_space,
            random,
            objects,
            scene: scene.and_then(|node| read_scene(reader, node)),
            initial: read_initial(reader, fields),
        };
        (reader.is_in_space, reader.may_lie_in_space) = (false, false);
        document
    }
}

fn read_object(reader: &mut Reader, key: &Key, node: &Node) -> Option<ObjectDocument> {
    let place = &key.place;
    let within = |from: usize, to: usize| {
        // The whole key is the place if its notation differs from its text.
        if place.text() == key.name {
            place.within(from..to)
        } else {
            place.clone()
        }
    };
    let (name, level) = split(&key.name);
    let level = level.and_then(|(at, text)| {
        let place = within(at, at + text.len());
        let written = reader.expression(text, &place);
        match written.value.as_name() {
            Some(name) => Some(LevelDocument::Any(Written {
                value: name.to_owned(),
                place,
            })),
            None if written.value.is_unknown() => None,
            None => Some(LevelDocument::One(written)),
        }
    });
    Some(ObjectDocument {
        name: Written {
            value: name.to_owned(),
            place: within(0, name.len()),
        },
        level,
        union: read_union(reader, node)?,
    })
}

/// Splits `A(n - 1)` into the name `A` and the byte offset and text of the level.
fn split(text: &str) -> (&str, Option<(usize, &str)>) {
    let inside = text.find('(').zip(text.trim_end().strip_suffix(')'));
    match inside {
        Some((open, before)) if open < before.len() => {
            (text[..open].trim(), Some((open + 1, &before[open + 1..])))
        }
        _ => (text.trim(), None),
    }
}

fn read_scene(reader: &mut Reader, node: &Node) -> Option<UnionDocument> {
    let scene = read_union(reader, node)?;
    if let Some(at_random) = node.get("at_random") {
        let message = "the scene is not drawn at random";
        let hint = "scene: [A] places an object A, which may be";
        reader.error_with_hint(&at_random.place.first_line(), message, hint);
    }
    Some(scene)
}

fn read_union(reader: &mut Reader, node: &Node) -> Option<UnionDocument> {
    let place = node.place.clone();
    if let Value::Sequence(_) = &node.value {
        return Some(UnionDocument {
            instances: read_instances(reader, node),
            alternatives: Vec::new(),
            transforms: Vec::new(),
            place,
        });
    }
    let fields = reader.fields(node, &UNION)?;
    let instances = fields.take("union");
    let alternatives = fields.take("at_random");
    match (instances, alternatives) {
        (None, None) => {
            let message = "an object needs a `union` of instances";
            reader.error_with_hint(&place.first_line(), message, UNION.hint);
        }
        (Some(_), Some(_)) => {
            let message = "`union` does not go with `at_random`";
            let place = fields.place_of("union");
            let hint = "a union of several objects, one of which is drawn at random";
            reader.error_with_hint(place, message, hint);
        }
        _ => {}
    }
    Some(UnionDocument {
        instances: instances.map_or_else(Vec::new, |node| read_instances(reader, node)),
        alternatives: alternatives.map_or_else(Vec::new, |node| read_alternatives(reader, node)),
        transforms: read_transforms(reader, &fields),
        place,
    })
}

fn read_alternatives(reader: &mut Reader, node: &Node) -> Vec<AlternativeDocument> {
    let list = reader.filled(
        node,
        "a list of alternatives",
        "alternative",
        ALTERNATIVE.hint,
    );
    let alternatives = list.iter().filter_map(|node| {
        if let Value::Sequence(_) = &node.value {
            return Some(AlternativeDocument {
                instances: read_some_instances(reader, node),
                transforms: Vec::new(),
                weight: None,
            });
        }
        let fields = reader.fields(node, &ALTERNATIVE)?;
        let instances = fields.take("union");
        Some(AlternativeDocument {
            instances: instances.map_or_else(Vec::new, |node| read_some_instances(reader, node)),
            transforms: read_transforms(reader, &fields),
            weight: fields.optional(reader, "weight"),
        })
    });
    alternatives.collect()
}

fn read_some_instances(reader: &mut Reader, node: &Node) -> Vec<InstanceDocument> {
    let list = reader.list(node, "a list of instances", INSTANCE.hint);
    list.iter()
        .map(|node| read_instance(reader, node))
        .collect()
}

fn read_instances(reader: &mut Reader, node: &Node) -> Vec<InstanceDocument> {
    let list = reader.filled(node, "a list of instances", "instance", INSTANCE.hint);
    list.iter()
        .map(|node| read_instance(reader, node))
        .collect()
}

fn read_instance(reader: &mut Reader, node: &Node) -> InstanceDocument {
    let mut instance = InstanceDocument {
        master: None,
        transforms: Vec::new(),
        tint: None,
        place: node.place.clone(),
    };
    if let Value::Text(_) | Value::Number(_) = &node.value {
        instance.master = read_named(reader, node);
    } else if let Some(fields) = reader.fields(node, &INSTANCE) {
        instance.master = read_master(reader, &fields);
        instance.transforms = read_transforms(reader, &fields);
        instance.tint = fields.optional(reader, "tint");
    }
    instance
}

/// Reads the object or the shape that an instance refers to.
fn read_master(reader: &mut Reader, fields: &Fields<'_>) -> Option<MasterDocument> {
    let shape = FORMS.iter().find(|form| fields.take(form.name).is_some());
    for key in OF_FRACTAL.iter().map(|key| key.name) {
        if shape.is_none() && fields.take(key).is_some() {
            let message = format!("`{key}` goes with `fractal`, and there is none");
            reader.error_with_hint(fields.place_of(key), message, INSTANCE.hint);
        }
    }
    match (fields.take("object"), shape) {
        (Some(node), None) => read_named(reader, node),
        (Some(_), Some(shape)) => {
            let message = format!("an instance of an object is no {} as well", shape.name);
            let place = fields.place_of(shape.name);
            reader.error_with_hint(place, message, "write two instances");
            None
        }
        (None, Some(_)) => Some(MasterDocument::Shape(Box::new(read_set(reader, fields)))),
        (None, None) => {
            let message = "this instance names no object";
            reader.error_with_hint(&fields.place.first_line(), message, INSTANCE.hint);
            None
        }
    }
}

fn read_named(reader: &mut Reader, node: &Node) -> Option<MasterDocument> {
    let text = reader.text(node)?;
    let (name, level) = split(&text);
    let level: Option<WrittenNumber> = level.map(|(at, text)| {
        let place = node.within(at..at + text.len());
        reader.expression(text, &place)
    });
    Some(MasterDocument::Object {
        name: Written {
            value: name.to_owned(),
            place: node.within(0..name.len()),
        },
        level,
    })
}

impl Reader {
    /// Parses an expression that is part of a text; a mistake is reported and a placeholder is
    /// returned.
    fn expression(&mut self, text: &str, place: &Place) -> WrittenNumber {
        let value = self.formula(text, place).unwrap_or_else(|mut error| {
            error.hint.get_or_insert_with(|| "A(n - 1), A(0)".into());
            self.diagnostics.push(error.at(place));
            Expression::unknown()
        });
        Written {
            value,
            place: place.clone(),
        }
    }
}
