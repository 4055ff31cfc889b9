//! Which schema holds for a file, where editors are given one for all.

use crate::catalogue::Shelf;
use crate::document::read::{DESCRIPTION, GENERATOR, INITIATOR, PARAMS, RULE};
use crate::document::shape::Shape;
use crate::model::Kind;

use super::json::{Object, list};

/// Where the schema of a kind of file stands in that of all.
pub(super) fn place(shelf: Shelf) -> String {
    format!("/definitions/{}", shelf.kind())
}

/// Leads to the schema of a file's kind, or to that of the component that its keys belong to; a file of
/// neither is a rule.
///
/// One condition comes after another, so that only one schema says what is wrong: of alternatives that
/// stand side by side an editor cannot know which was meant.
pub(super) fn by_kind() -> Object {
    let kinds = Kind::ALL.map(|kind| {
        let is_kind = Object::default().with("const", kind.name());
        let is_kind = Object::default().with("kind", is_kind);
        let condition = having(["kind"]).with("properties", is_kind);
        (condition, refer(Shelf::of(kind)))
    });
    let known = Object::default().with("enum", list(Kind::ALL.map(Kind::name)));
    let unknown = Object::default().with("properties", Object::default().with("kind", known));
    let of_rules = names(&RULE).filter(|name| !names(&COMPONENT).any(|common| common == *name));
    let of_generators = names(&GENERATOR).filter(|name| !names(&INITIATOR).any(|own| own == *name));
    let components = [
        (
            Object::default().with("type", "array"),
            refer(Shelf::Initiators),
        ),
        (having(of_rules), refer(Shelf::Rules)),
        (having(["points"]), refer(Shelf::BaseElements)),
        (having(of_generators), refer(Shelf::Generators)),
        (having(names(&INITIATOR)), refer(Shelf::Initiators)),
    ];
    let all = kinds
        .into_iter()
        .chain([(having(["kind"]), unknown)])
        .chain(components);
    all.rev()
        .fold(refer(Shelf::Rules), |otherwise, (condition, schema)| {
            Object::default()
                .with("if", condition)
                .with("then", schema)
                .with("else", otherwise)
        })
}

/// The keys of components beside their own.
const COMPONENT: Shape = Shape {
    keys: &[&DESCRIPTION, &[PARAMS]],
    ..INITIATOR
};

fn names(shape: &Shape) -> impl Iterator<Item = &'static str> + use<> {
    shape.members().map(|member| member.name)
}

/// A mapping that has one of some keys.
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
