//! Instances of structures as parallelograms: images of the unit square under their transforms, in the order of the file.

use crate::document::node::{Node, Value};
use crate::edit::{Edit, PathStep};
use crate::geometry::{DAffine2, DMat2, DVec2};
use crate::ifs;

use super::act::below;
use super::maps::{Grip, MapHandle, Pull, dragged, forms, number, pair, rows, two};
use super::names::{Basis, Names};
use super::{nice, space};

/// Keys of translations.
const TRANSLATIONS: [&str; 2] = ["translate", "shift"];

/// Keys of instances that transform in other ways, which are written by hand.
const OTHERS: [&str; 2] = ["transform", "repeat"];

/// Returns the instances of a list whose transforms are known numbers.
pub(super) fn handles(list: &Node, at: &[PathStep], names: &Names) -> Vec<MapHandle> {
    let Value::Sequence(items) = &list.value else {
        return Vec::new();
    };
    let handles = items.iter().enumerate().filter_map(|(number, node)| {
        let name = format!("{}: {}", number + 1, master(node));
        handle(name, node, below(at, number), names)
    });
    handles.collect()
}

/// Returns the handle of what has transforms: an instance, or an object.
pub(super) fn handle(
    name: String,
    node: &Node,
    at: Vec<PathStep>,
    names: &Names,
) -> Option<MapHandle> {
    let placed = match names.is_in_space() {
        true => space::seen(node, names, true)?,
        false => placed(node, names)?,
    };
    Some(MapHandle {
        form: forms(node, &["scale", "rotate", "matrix", "translate", "shift"]),
        is_instance: true,
        depth: space::depth(node, names, true).filter(|_| names.is_in_space()),
        ..MapHandle::of(name, placed, node, at)
    })
}

/// Returns the name of what is instanced: an object, or the form of a shape.
fn master(node: &Node) -> &str {
    let Value::Mapping(entries) = &node.value else {
        return node.written().unwrap_or("instance");
    };
    let object = node.get("object").and_then(Node::written);
    let form = entries.first().map(|(key, _)| key.name.as_str());
    object.or(form).unwrap_or("instance")
}

/// Transform of an instance, and the number of its entry.
struct Part<'n> {
    entry: usize,
    key: &'n str,
    node: &'n Node,
    map: DAffine2,
}

/// Returns the transforms of an instance, in the order of application, and what they depend on.
fn parts<'n>(node: &'n Node, names: &Names) -> Option<(Vec<Part<'n>>, Basis)> {
    let Value::Mapping(entries) = &node.value else {
        return Some((Vec::new(), Basis::Numbers));
    };
    let mut basis = Basis::Numbers;
    let mut parts = Vec::new();
    for (entry, (key, node)) in entries.iter().enumerate() {
        let key = key.name.as_str();
        let (map, own) = match key {
            "scale" => {
                let (factors, basis) = pair(node, names)?;
                (DAffine2::from_scale(factors), basis)
            }
            "rotate" => {
                let (angle, basis) = names.value(node)?;
                let linear = ifs::axes(DVec2::ONE, DVec2::splat(angle));
                (DAffine2::from_mat2(linear), basis)
            }
            "matrix" => {
                let (linear, basis) = rows(node, names)?;
                (DAffine2::from_mat2(linear), basis)
            }
            _ if TRANSLATIONS.contains(&key) => {
                let (by, basis) = names.point(node)?;
                (DAffine2::from_translation(by.into()), basis)
            }
            _ if OTHERS.contains(&key) => return None,
            _ => continue,
        };
        basis = basis.max(own);
        parts.push(Part {
            entry,
            key,
            node,
            map,
        });
    }
    Some((parts, basis))
}

/// Returns the map of all transforms of an instance, and what it depends on.
pub(super) fn placed(node: &Node, names: &Names) -> Option<(DAffine2, Basis)> {
    let (parts, basis) = parts(node, names)?;
    let map = { parts.iter() }.fold(DAffine2::IDENTITY, |before, part| part.map * before);
    map.is_finite().then_some((map, basis))
}

/// Returns the edits that write the transforms of an instance of which a grip has been dragged to a place, in the keys in
/// which they are written; `None` where these keys, in their order, cannot express it.
pub(super) fn edits(handle: &MapHandle, names: &Names, pull: &Pull) -> Option<Vec<Edit>> {
    let (parts, _) = parts(&handle.node, names)?;
    let (old, _) = placed(&handle.node, names)?;
    let changes = match pull.grip {
        Grip::Body => vec![shifted(&parts, pull.to - old.translation, pull.pixel)?],
        Grip::X | Grip::Y => turned(&parts, names, old, pull)?,
    };
    let Value::Mapping(entries) = &handle.node.value else {
        let all = changes.iter().map(|(key, value)| format!("{key}: {value}"));
        let all: Vec<_> = all.collect();
        let object = super::source_text(&handle.node);
        let text = format!("{{object: {object}, {}}}", all.join(", "));
        return Some(vec![Edit::set(handle.at.clone(), text)]);
    };
    // New linear maps are done before the translations.
    let first = parts.iter().find(|it| TRANSLATIONS.contains(&it.key));
    let mut before = match first {
        Some(part) => Some(entries[part.entry.checked_sub(1)?].0.name.clone()),
        None => None,
    };
    let mut edits = Vec::new();
    for (key, value) in changes {
        if handle.node.get(key).is_some() {
            edits.push(Edit::set(below(&handle.at, key), value));
            continue;
        }
        edits.push(Edit::Add {
            to: handle.at.clone(),
            key: key.into(),
            value,
            after: before.clone().filter(|_| !TRANSLATIONS.contains(&key)),
        });
        before = before.map(|_| key.to_owned());
    }
    Some(edits)
}

/// Key of a transform, and its value as text.
type Change = (&'static str, String);

/// Returns the translation that moves an instance by a vector.
fn shifted(parts: &[Part<'_>], by: DVec2, pixel: f64) -> Option<Change> {
    let Some(at) = parts.iter().rposition(|it| TRANSLATIONS.contains(&it.key)) else {
        return Some(("translate", two(by, pixel)));
    };
    let linear = { parts[at + 1..].iter() }.fold(DMat2::IDENTITY, |m, it| it.map.matrix2 * m);
    let inverse = linear.inverse();
    let key = TRANSLATIONS.iter().find(|key| **key == parts[at].key)?;
    let to = parts[at].map.translation + inverse * by;
    to.is_finite().then(|| (*key, two(to, pixel)))
}

/// Returns the matrix, or factors and angle, of an instance of which the image of a unit vector has been dragged to a place.
fn turned(parts: &[Part<'_>], names: &Names, old: DAffine2, pull: &Pull) -> Option<Vec<Change>> {
    let Pull {
        grip,
        to,
        similar,
        pixel,
    } = *pull;
    let moves = |part: &&Part<'_>| TRANSLATIONS.contains(&part.key);
    let linear: Vec<_> = parts.iter().filter(|part| !moves(part)).collect();
    // A linear map behind a translation moves it, too.
    if parts
        .iter()
        .skip_while(|it| !moves(it))
        .any(|it| !moves(&it))
    {
        return None;
    }
    let keys: Vec<_> = linear.iter().map(|part| part.key).collect();
    if keys == ["matrix"] {
        let [x, y] = {
            let new = dragged(old, grip, to, similar).matrix2;
            [new.x_axis, new.y_axis]
        };
        let rows = [DVec2::new(x.x, y.x), DVec2::new(x.y, y.y)].map(|row| two(row, pixel));
        return Some(vec![("matrix", format!("[{}, {}]", rows[0], rows[1]))]);
    }
    let of = |key: &str| linear.iter().find(|part| part.key == key);
    let factors = of("scale").and_then(|part| pair(part.node, names));
    let mut factors = factors.map_or(DVec2::ONE, |it| it.0);
    let angle = of("rotate").and_then(|part| names.value(part.node));
    let mut angle = angle.map_or(0.0, |it| it.0);
    let is_one = of("scale").is_none_or(|part| names.value(part.node).is_some());
    let is_known = match keys[..] {
        [] | ["scale"] | ["rotate"] | ["scale", "rotate"] => true,
        ["rotate", "scale"] => is_one,
        _ => false,
    };
    if !is_known {
        return None;
    }
    let (axis, sign) = match grip {
        Grip::Y => (1, factors.y.signum()),
        _ => (0, factors.x.signum()),
    };
    let (before, after) = (old.matrix2.col(axis), to - old.translation);
    let length = after.length();
    if length == 0.0 || before.length() == 0.0 {
        return None;
    }
    if is_one || similar {
        factors *= length / before.length();
        angle += before.angle_to(after).to_degrees();
    } else {
        let quarter = if axis == 1 { 90.0 } else { 0.0 };
        let along = sign * after;
        factors[axis] = sign * length;
        angle = libm::atan2(along.y, along.x).to_degrees() - quarter;
    }
    angle -= 360.0 * (angle / 360.0).round();
    let degrees = nice::decimals(angle, 0.05);
    let written = if is_one {
        number(factors.x, pixel)
    } else {
        two(factors, pixel)
    };
    let mut changes = Vec::new();
    if of("scale").is_some() || written != "1" {
        changes.push(("scale", written));
    }
    if of("rotate").is_some() || degrees != "0" {
        changes.push(("rotate", degrees));
    }
    Some(changes)
}
