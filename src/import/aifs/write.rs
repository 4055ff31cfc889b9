//! Documents of sets: systems of maps, or structures where a set refers to others.

use std::collections::BTreeMap;

use crate::build::NumberText;
use crate::build::written::{Entries, sequence};
use crate::diagnostic::{Diagnostics, Place};
use crate::document::node::Value;
use crate::import::maps::{Layout, System, matrix_and_shift};

use super::evaluate::Scope;
use super::subspace::Projection;
use super::syntax::Parsed;
use super::value::{wrong, wrong_with};

/// An image of a set: the numbers of the map, and the name of the set.
type Copy<'a> = (Vec<f64>, &'a str);

/// Returns the keys of the document of a block's root; `None` if the block has no set.
pub(super) fn set(scope: &mut Scope) -> Parsed<Option<Entries>> {
    let root = match scope.definition("$root") {
        Some(root) => {
            let name = root.value.text();
            match scope.sets.get(name) {
                Some(name) => Some(*name),
                None => return wrong(format!("there is no set '{name}'"), &root.value),
            }
        }
        None => scope
            .names
            .iter()
            .copied()
            .find(|name| scope.sets.contains(name)),
    };
    let Some(root) = root else {
        return scope.check().map(|()| None);
    };
    let projection = Projection::of(scope)?;
    let place = scope.place_of(root);
    let mut sets = reachable(scope, &projection, root)?;
    drop_empty(&mut sets);
    let Some(copies) = sets.get(root) else {
        return wrong(format!("the set {root} is empty"), &place);
    };
    if copies.iter().all(|(_, of)| *of == root) {
        let mut system = System::new(layout(&projection));
        let mut found = Diagnostics::default();
        for (map, _) in copies {
            system.push(numbers(map).collect(), None, &mut found);
        }
        return Ok(Some(system.entries(root, &place, &mut found)));
    }
    // Objects that are not part of the root, because all that held them is empty, would be reported as unused.
    let mut open = vec![root];
    let mut objects: Vec<&str> = Vec::new();
    while let Some(name) = open.pop() {
        if !objects.contains(&name) {
            objects.push(name);
            open.extend(sets[name].iter().rev().map(|(_, of)| *of));
        }
    }
    structure(&projection, root, &objects, &sets, &place)
}

fn layout(projection: &Projection) -> Layout {
    match projection.axes {
        3 => Layout::SPACE,
        _ => Layout::PLANE,
    }
}

fn numbers(map: &[f64]) -> impl Iterator<Item = NumberText> + '_ {
    map.iter().map(|number| NumberText::from(*number))
}

/// Returns the images that each set consists of which a root refers to, directly or through others.
fn reachable<'a>(
    scope: &mut Scope<'a>,
    projection: &Projection,
    root: &'a str,
) -> Parsed<BTreeMap<&'a str, Vec<Copy<'a>>>> {
    let mut sets = BTreeMap::new();
    let mut open = vec![root];
    while let Some(name) = open.pop() {
        if sets.contains_key(name) {
            continue;
        }
        let mut copies = Vec::new();
        for term in scope.set(name)? {
            if let Some(of) = term.set {
                copies.push((projection.image(&term.map, &term.place)?, of));
                open.push(of);
            }
        }
        sets.insert(name, copies);
    }
    Ok(sets)
}

/// Removes sets without points, and their images.
fn drop_empty(sets: &mut BTreeMap<&str, Vec<Copy>>) {
    loop {
        let count = sets.len();
        sets.retain(|_, copies| !copies.is_empty());
        if sets.len() == count {
            return;
        }
        let left: Vec<String> = sets.keys().map(|name| (*name).to_owned()).collect();
        for copies in sets.values_mut() {
            copies.retain(|(_, of)| left.binary_search_by(|it| it[..].cmp(of)).is_ok());
        }
    }
}

fn structure(
    projection: &Projection,
    root: &str,
    objects: &[&str],
    sets: &BTreeMap<&str, Vec<Copy>>,
    place: &Place,
) -> Parsed<Option<Entries>> {
    if sets.values().map(Vec::len).sum::<usize>() > 20_000 {
        return wrong_with(
            "this set has too many maps",
            place,
            "structures have up to 20000",
        );
    }
    let copy = |(map, of): &Copy| {
        let (matrix, shift) = matrix_and_shift(numbers(map).collect(), projection.axes);
        Entries::default()
            .set("object", Value::Text((*of).to_owned()))
            .set("matrix", matrix)
            .set_some("translate", shift)
            .value()
    };
    let written = objects.iter().fold(Entries::default(), |all, name| {
        all.add(*name, sequence(sets[name].iter().map(copy)))
    });
    let kind = Entries::default().set("kind", Value::Text("instancing".into()));
    let space = (projection.axes == 3).then_some(Value::Number(3.0));
    Ok(Some(
        kind.set_some("space", space)
            .set("objects", written.value())
            .set("scene", sequence([Value::Text(root.to_owned())])),
    ))
}
