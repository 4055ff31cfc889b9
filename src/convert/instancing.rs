//! Conversion to a structure of objects that instance each other.

use crate::build::written::{Entries, sequence};
use crate::document::node::Value;
use crate::instancing::Tint;

use super::convertible::Convertible;
use super::number::value;
use super::structure::{PlacedObject, Structure};
use super::{Keeps, Refusal};

pub(super) fn write<M: Convertible>(
    structure: &Structure<M>,
    keeps: Keeps,
) -> Result<Entries, Refusal> {
    if keeps == Keeps::Approximants && structure.objects.is_empty() {
        let what = "nothing is replaced, and an object draws its shapes after a step";
        return Err(Refusal::Steps(what));
    }
    let has_shapes = structure.instances().any(|placed| placed.object.is_none());
    let initial = match structure.initial() {
        Some(Some(shape)) => Some(M::set(&structure.shapes[shape], &M::IDENTITY)),
        None if keeps == Keeps::Limit && has_shapes => { structure.drawn_before() }
            .find_map(|shape| M::set(&structure.shapes[shape], &M::IDENTITY).ok())
            .map(Ok),
        // Where there are shapes, objects that are not replaced draw nothing.
        Some(None) | None if keeps == Keeps::Limit => None,
        Some(None) if has_shapes => None,
        _ => {
            let what = "what is replaced does not all look the same, as an initial set does";
            return Err(Refusal::Steps(what));
        }
    };
    let initial = keeps.initial(initial)?;
    let mut entries = Entries::default();
    let mut objects = Entries::default();
    for (number, object) in structure.objects.iter().enumerate() {
        let name = name(structure, number);
        objects = objects.add(name, instances(structure, object)?);
    }
    if structure.objects.is_empty() {
        // A structure needs an object: the scene becomes one.
        objects = objects.add("A", instances(structure, &structure.scene)?);
        entries = entries
            .set("objects", objects.value())
            .set("scene", sequence([Value::Text("A".into())]));
    } else {
        entries = entries
            .set("objects", objects.value())
            .set("scene", instances(structure, &structure.scene)?);
    }
    Ok(entries.set_some("initial", initial.map(Entries::value)))
}

fn name<M: Convertible>(structure: &Structure<M>, object: usize) -> String {
    match structure.objects.len() {
        1 => "A".into(),
        _ => format!("A{}", object + 1),
    }
}

fn instances<M: Convertible>(
    structure: &Structure<M>,
    all: &[PlacedObject<M>],
) -> Result<Value, Refusal> {
    let instances: Result<Vec<_>, _> = all
        .iter()
        .map(|placed| instance(structure, placed))
        .collect();
    Ok(sequence(instances?))
}

fn instance<M: Convertible>(
    structure: &Structure<M>,
    placed: &PlacedObject<M>,
) -> Result<Value, Refusal> {
    let master = match placed.object {
        Some(object) => {
            let name = Value::Text(name(structure, object));
            if placed.map == M::IDENTITY && placed.tint.is_none() {
                return Ok(name);
            }
            Entries::default().set("object", name)
        }
        None => M::set(&structure.shapes[placed.shape], &M::IDENTITY)?,
    };
    Ok(placed
        .map
        .placing(master)
        .set_some("tint", placed.tint.map(tint))
        .value())
}

fn tint(tint: Tint) -> Value {
    Entries::default()
        .set("color", Value::Text(format!("{:#}", tint.colour)))
        .set("alpha", value(tint.alpha))
        .value()
}
