//! Dispatch on the kind of a file, for editors that use one schema for all files.

use crate::catalogue::Shelf;
use crate::document::read::{
    BASE_ELEMENT, DESCRIPTION, GENERATOR, INITIATOR, PARAMS, RULE, SPACE_OF_COMPONENT,
};
use crate::document::shape::Shape;
use crate::kind::Kind;

use super::json::{Object, list};

/// Returns the JSON pointer to the schema of a shelf within the schema of all files.
pub(super) fn place(shelf: Shelf) -> String {
    format!("/definitions/{}", shelf.kind())
}

/// Returns the schema that refers to the schema of a file's kind, to that of the component to which its
/// keys belong, or else to that of rules.
///
/// The conditions are nested, so that only one schema reports mistakes: of parallel alternatives, an
/// editor cannot determine the intended one.
pub(super) fn by_kind() -> Object {
    let kinds = Kind::ALL.map(|kind| {
        let is_kind = Object::default().with("const", kind.name());
        let is_kind = Object::default().with("kind", is_kind);
        let condition = having(["kind"]).with("properties", is_kind);
        (condition, refer(Shelf::Fractals(kind)))
    });
    let known = Object::default().with("enum", list(Kind::ALL.map(Kind::name)));
    let unknown = Object::default().with("properties", Object::default().with("kind", known));
    let of_rules = names(&RULE).filter(|name| !names(&COMPONENT).any(|common| common == *name));
    let of_generators = names(&GENERATOR).filter(|name| !names(&INITIATOR).any(|own| own == *name));
    let is_shape = |name: &&str| *name != SPACE_OF_COMPONENT.name;
    let of_base_elements = names(&BASE_ELEMENT)
        .filter(|name| is_shape(name) && !names(&INITIATOR).any(|own| own == *name));
    let components = [
        (
            Object::default().with("type", "array"),
            refer(Shelf::Initiators),
        ),
        (having(of_rules), refer(Shelf::RULES)),
        (having(of_base_elements), refer(Shelf::BaseElements)),
        (having(of_generators), refer(Shelf::Generators)),
        (having(names(&INITIATOR)), refer(Shelf::Initiators)),
    ];
    let all = kinds
        .into_iter()
        .chain([(having(["kind"]), unknown)])
        .chain(components);
    all.rev()
        .fold(refer(Shelf::RULES), |otherwise, (condition, schema)| {
            Object::default()
                .with("if", condition)
                .with("then", schema)
                .with("else", otherwise)
        })
}

/// Keys that all components have beside their own.
const COMPONENT: Shape = Shape {
    keys: &[&DESCRIPTION, &[PARAMS, SPACE_OF_COMPONENT]],
    ..INITIATOR
};

fn names(shape: &Shape) -> impl Iterator<Item = &'static str> + use<> {
    shape.members().map(|member| member.name)
}

/// Returns the condition of a mapping that has at least one of the given keys.
fn having(keys: impl IntoIterator<Item = &'static str>) -> Object {
    let keys = keys.into_iter();
    let one = keys.map(|key| Object::default().with("required", list([key])));
    Object::default()
        .with("type", "object")
        .with("anyOf", list(one))
}

fn refer(shelf: Shelf) -> Object {
    Object::default().with("$ref", format!("#{}", place(shelf)))
}
