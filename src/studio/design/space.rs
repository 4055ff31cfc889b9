//! Figures of space: the views along an axis, and maps of systems in space in such a view.
//!
//! A figure shows two coordinates of its points. A drag keeps the third one.

use serde::{Deserialize, Serialize};

use crate::document::node::{Node, Value};
use crate::edit::Edit;
use crate::geometry::{DAffine2, DAffine3, DMat2, DMat3, DVec2, DVec3};

use super::act::below;
use super::maps::{Grip, MapHandle, Pull, number, turned};
use super::names::{Basis, Names};

/// View along an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub(in crate::studio) enum View {
    /// From the front, against the z axis: x to the right, y upwards. The view of the plane.
    #[default]
    Front,
    /// From below, along the y axis: x to the right, z upwards.
    Below,
    /// From the left, along the x axis: z to the right, y upwards.
    Left,
}

impl View {
    /// Returns the axes to the right, upwards, and along the view.
    pub(super) fn axes(self) -> [usize; 3] {
        match self {
            Self::Front => [0, 1, 2],
            Self::Below => [0, 2, 1],
            Self::Left => [2, 1, 0],
        }
    }

    /// Returns the point of space with the coordinates to the right, upwards, and along the view.
    pub(super) fn point(self, seen: [f64; 3]) -> DVec3 {
        let mut point = DVec3::ZERO;
        for (axis, value) in self.axes().into_iter().zip(seen) {
            point[axis] = value;
        }
        point
    }

    /// Returns the sign of a turn about the axis along the view that is counterclockwise in the figure.
    fn sign(self) -> f64 {
        match self {
            Self::Front => 1.0,
            Self::Below | Self::Left => -1.0,
        }
    }
}

/// Keys of transforms in the order in which a map does them.
const TRANSFORMS: [&str; 5] = ["matrix", "scale", "rotate", "translate", "shift"];

/// Keys of instances that transform in other ways, which are written by hand.
const OTHERS: [&str; 2] = ["transform", "repeat"];

/// Returns a map of space as it is written, and what it depends on. The transforms of an instance are done in the order of
/// the file.
fn affine(node: &Node, names: &Names, is_instance: bool) -> Option<(DAffine3, Basis)> {
    let keys = if is_instance {
        keys(node)
    } else {
        TRANSFORMS.to_vec()
    };
    if is_instance && OTHERS.iter().any(|key| node.get(key).is_some()) {
        return None;
    }
    let mut map = DAffine3::IDENTITY;
    let mut basis = Basis::Numbers;
    for key in keys {
        if let Some(node) = node.get(key) {
            let (next, own) = transform(key, node, names)?;
            map = next * map;
            basis = basis.max(own);
        }
    }
    if let Some(fixed) = node.get("fixed").filter(|_| !is_instance) {
        let (fixed, own) = names.vector(fixed)?;
        map.translation = fixed - map.matrix3 * fixed;
        basis = basis.max(own);
    }
    map.is_finite().then_some((map, basis))
}

/// Returns the keys of the transforms of an instance, in the order of the file.
fn keys(node: &Node) -> Vec<&'static str> {
    let Value::Mapping(entries) = &node.value else {
        return Vec::new();
    };
    let known = |name: &str| TRANSFORMS.into_iter().find(|key| *key == name);
    { entries.iter() }
        .filter_map(|(key, _)| known(&key.name))
        .collect()
}

/// Returns a transform, and what it depends on.
fn transform(key: &str, node: &Node, names: &Names) -> Option<(DAffine3, Basis)> {
    let (linear, basis) = match (key, &node.value) {
        ("matrix", Value::Sequence(rows)) => {
            let rows: Option<Vec<_>> = rows.iter().map(|row| names.vector(row)).collect();
            let [(a, one), (b, two), (c, three)] = rows?[..] else {
                return None;
            };
            (
                DMat3::from_cols(a, b, c).transpose(),
                one.max(two).max(three),
            )
        }
        ("scale", _) => {
            let (factors, basis) = factors(node, names)?;
            (DMat3::from_diagonal(factors), basis)
        }
        ("rotate", Value::Sequence(turns)) => {
            let mut all = (DMat3::IDENTITY, Basis::Numbers);
            for node in turns {
                let (turn, own) = turn(node, names)?;
                all = (turn * all.0, all.1.max(own));
            }
            all
        }
        ("rotate", _) => turn(node, names)?,
        ("translate" | "shift", _) => {
            let (by, basis) = names.vector(node)?;
            return Some((DAffine3::from_translation(by), basis));
        }
        _ => return None,
    };
    Some((DAffine3::from_mat3(linear), basis))
}

/// Returns the factors along the axes.
fn factors(node: &Node, names: &Names) -> Option<(DVec3, Basis)> {
    match names.value(node) {
        Some((factor, basis)) => Some((DVec3::splat(factor), basis)),
        None => names.vector(node),
    }
}

/// Returns a turn about an axis, which is done by the right-hand rule.
fn turn(node: &Node, names: &Names) -> Option<(DMat3, Basis)> {
    let (axis, angle, basis) = match node.get("axis") {
        Some(axis) => {
            let (axis, one) = names.vector(axis)?;
            let (angle, other) = names.value(node.get("angle")?)?;
            (axis.try_normalize()?, angle, one.max(other))
        }
        None => {
            let axes = [("x", DVec3::X), ("y", DVec3::Y), ("z", DVec3::Z)];
            let own = |(key, axis)| node.get(key).map(|node| (axis, node));
            let (axis, node) = axes.into_iter().find_map(own)?;
            let (angle, basis) = own_value(node, names)?;
            (axis, angle, basis)
        }
    };
    Some((about(axis, angle), basis))
}

/// Returns the turn about an axis by an angle in degrees, by the right-hand rule.
fn about(axis: DVec3, angle: f64) -> DMat3 {
    let (sin, cos) = libm::sincos(angle.to_radians());
    let image = |of: DVec3| of * cos + axis.cross(of) * sin + axis * (axis.dot(of) * (1.0 - cos));
    let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(image);
    DMat3::from_cols(x, y, z)
}

/// Returns an angle, of which the number before parameters is the map's own.
fn own_value(node: &Node, names: &Names) -> Option<(f64, Basis)> {
    let (value, basis) = names.value(node)?;
    match basis {
        Basis::Parameters if super::maps::is_offset(node) => Some((value, Basis::Numbers)),
        _ => Some((value, basis)),
    }
}

/// Returns a map of space, or the transforms of an instance, as they are seen: images of the unit vectors to the right and
/// upwards, and of the origin.
pub(super) fn seen(node: &Node, names: &Names, is_instance: bool) -> Option<(DAffine2, Basis)> {
    let (map, basis) = affine(node, names, is_instance)?;
    let [right, up, _] = names.view().axes();
    let shown = |vector: DVec3| DVec2::new(vector[right], vector[up]);
    let linear = DMat2::from_cols(shown(map.matrix3.col(right)), shown(map.matrix3.col(up)));
    Some((
        DAffine2::from_mat2_translation(linear, shown(map.translation)),
        basis,
    ))
}

/// Returns the image of the unit vector along the view, as it is seen.
pub(super) fn depth(node: &Node, names: &Names, is_instance: bool) -> Option<[f64; 2]> {
    let (map, _) = affine(node, names, is_instance)?;
    let [right, up, along] = names.view().axes();
    let image = map.matrix3.col(along);
    Some([image[right], image[up]])
}

/// Returns the edits that write a map of space after a grip has been dragged, in the keys in which it is written. `None` if
/// no map of that form lies there.
pub(super) fn edits(handle: &MapHandle, names: &Names, pull: &Pull) -> Option<Vec<Edit>> {
    let keys = keys(&handle.node);
    // Instances in another order, such as a turn behind a translation, are written by hand.
    let order = |key: &&str| {
        TRANSFORMS
            .iter()
            .position(|known| known == key)
            .map(|it| it.min(3))
    };
    let is_usual = keys.iter().is_sorted_by_key(order);
    if handle.is_instance && !is_usual {
        return None;
    }
    let (old, _) = affine(&handle.node, names, handle.is_instance)?;
    let edits = match pull.grip {
        Grip::Body => shifted(handle, names, old, pull),
        Grip::X => stretched(handle, names, old, 0, pull),
        Grip::Y => stretched(handle, names, old, 1, pull),
    }?;
    if matches!(handle.node.value, Value::Mapping(_)) {
        return Some(edits);
    }
    // An object that is named alone becomes an instance with transforms.
    let added = edits.iter().map(|edit| match edit {
        Edit::Add { key, value, .. } => Some(format!("{key}: {value}")),
        _ => None,
    });
    let added: Vec<String> = added.collect::<Option<_>>()?;
    let object = super::source_text(&handle.node);
    let text = format!("{{object: {object}, {}}}", added.join(", "));
    Some(vec![Edit::set(handle.at.clone(), text)])
}

/// Adds a key. Linear transforms of an instance are done before its translation, a turn after a scale that is there or
/// added before. `None` if the translation is the first key: nothing is added before it.
fn added(handle: &MapHandle, key: &str, value: String, has_scale: bool) -> Option<Edit> {
    let is_translation = |name: &str| ["translate", "shift"].contains(&name);
    let after = match &handle.node.value {
        Value::Mapping(entries) if handle.is_instance && !is_translation(key) => {
            let first = { entries.iter() }.position(|(key, _)| is_translation(&key.name));
            match first {
                Some(first) => {
                    let before = first.checked_sub(1)?;
                    Some(match has_scale {
                        true => "scale".to_owned(),
                        false => entries[before].0.name.clone(),
                    })
                }
                None => None,
            }
        }
        _ => None,
    };
    Some(Edit::Add {
        to: handle.at.clone(),
        key: key.into(),
        value,
        after,
    })
}

/// Writes a movement.
fn shifted(handle: &MapHandle, names: &Names, old: DAffine3, pull: &Pull) -> Option<Vec<Edit>> {
    let [right, up, _] = names.view().axes();
    let mut to = old.translation;
    (to[right], to[up]) = (pull.to.x, pull.to.y);
    match handle.node.get("fixed") {
        Some(_) if !handle.is_instance => {
            let vector = fixed_point(old.matrix3, to)?;
            placed(handle, names, "fixed", vector, pull.pixel)
        }
        _ if handle.node.get("shift").is_some() => placed(handle, names, "shift", to, pull.pixel),
        _ => placed(handle, names, "translate", to, pull.pixel),
    }
}

/// Returns the fixed point of a map; `None` if there is none, or more than one.
fn fixed_point(linear: DMat3, translation: DVec3) -> Option<DVec3> {
    let rest = DMat3::IDENTITY - linear;
    (rest.determinant().abs() > 1e-9).then(|| rest.inverse() * translation)
}

/// Writes a vector in a key.
fn placed(
    handle: &MapHandle,
    names: &Names,
    key: &str,
    vector: DVec3,
    pixel: f64,
) -> Option<Vec<Edit>> {
    let text = vector.to_array().map(|value| number(value, pixel));
    let at = below(&handle.at, key);
    let Some(node) = handle.node.get(key) else {
        let value = format!("[{}]", text.join(", "));
        return Some(vec![added(handle, key, value, false)?]);
    };
    match &node.value {
        // Coordinates that stay are written as they are.
        Value::Sequence(parts) if parts.len() == 3 => {
            let before = names.vector(node)?.0;
            let moved = (0..3).filter(|axis| (vector[*axis] - before[*axis]).abs() > 1e-12);
            Some(
                moved
                    .map(|axis| Edit::set(below(&at, axis), &text[axis]))
                    .collect(),
            )
        }
        _ => Some(vec![Edit::set(at, format!("[{}]", text.join(", ")))]),
    }
}

/// Writes a stretch, and a turn about the axis along the view where nothing but such a turn is written. The origin stays.
fn stretched(
    handle: &MapHandle,
    names: &Names,
    old: DAffine3,
    side: usize,
    pull: &Pull,
) -> Option<Vec<Edit>> {
    let (mut edits, linear) = match handle.node.get("matrix") {
        Some(_) => rewritten(handle, names, old, side, pull),
        None => rescaled(handle, names, old, side, pull)?,
    };
    if handle.node.get("fixed").is_some() && !handle.is_instance {
        let fixed = fixed_point(linear, old.translation)?;
        edits.extend(placed(handle, names, "fixed", fixed, pull.pixel)?);
    }
    Some(edits)
}

/// Writes the image of a unit vector in the matrix; returns the edits and the new matrix.
fn rewritten(
    handle: &MapHandle,
    names: &Names,
    old: DAffine3,
    side: usize,
    pull: &Pull,
) -> (Vec<Edit>, DMat3) {
    let axes = names.view().axes();
    let mut linear = old.matrix3;
    let edits = [(axes[0], pull.to.x), (axes[1], pull.to.y)].map(|(row, to)| {
        let value = to - old.translation[row];
        linear.col_mut(axes[side])[row] = value;
        let at = below(&below(&handle.at, "matrix"), row);
        Edit::set(below(&at, axes[side]), number(value, pull.pixel))
    });
    (edits.to_vec(), linear)
}

/// Writes the length of the image of a unit vector in the scale, and its angle in the turn; returns the edits and the new
/// linear part.
fn rescaled(
    handle: &MapHandle,
    names: &Names,
    old: DAffine3,
    side: usize,
    pull: &Pull,
) -> Option<(Vec<Edit>, DMat3)> {
    let axes = names.view().axes();
    let shown = |vector: DVec3| DVec2::new(vector[axes[0]], vector[axes[1]]);
    let before = shown(old.matrix3.col(axes[side]));
    let after = pull.to - shown(old.translation);
    let step = |key: &str| below(&handle.at, key);
    let node = &handle.node;
    let ratio = after.length() / before.length();
    if !ratio.is_finite() || ratio == 0.0 {
        return None;
    }
    let mut edits = Vec::new();
    let scale = node.get("scale");
    let (factors, _) = match scale {
        Some(node) => factors(node, names)?,
        None => (DVec3::ONE, Basis::Numbers),
    };
    let is_one = scale.is_none_or(|node| names.value(node).is_some());
    let rounded = |value: f64| number(value, pull.pixel);
    let mut stretch = DVec3::ONE;
    if (ratio - 1.0).abs() > 1e-12 {
        let axis = axes[side];
        match scale {
            Some(_) if !is_one && !pull.similar => stretch[axis] = ratio,
            _ => stretch *= ratio,
        }
        edits.push(match scale {
            None => added(handle, "scale", rounded(ratio), false)?,
            Some(_) if is_one => Edit::set(step("scale"), rounded(factors.x * ratio)),
            Some(_) if pull.similar => {
                let all = (factors * ratio).to_array().map(rounded);
                Edit::set(step("scale"), format!("[{}]", all.join(", ")))
            }
            Some(_) => {
                let at = below(&step("scale"), axis);
                Edit::set(at, rounded(factors[axis] * ratio))
            }
        });
    }
    let key = ["x", "y", "z"][axes[2]];
    let by = names.view().sign() * before.angle_to(after).to_degrees();
    let mut turn_by = 0.0;
    match node.get("rotate") {
        None if is_one => {
            let text = turned(None, names, by);
            if text != "0" {
                let has_scale = scale.is_some() || !edits.is_empty();
                let text = format!("{{{key}: {text}}}");
                edits.push(added(handle, "rotate", text, has_scale)?);
                turn_by = by;
            }
        }
        Some(turn) if is_one => {
            if let Some(angle) = turn.get(key) {
                let (now, _) = names.value(angle)?;
                let at = below(&step("rotate"), key);
                edits.push(Edit::set(at, turned(Some(angle), names, now + by)));
                turn_by = by;
            }
        }
        _ => {}
    }
    let axis = [DVec3::X, DVec3::Y, DVec3::Z][axes[2]];
    let linear = about(axis, turn_by) * old.matrix3 * DMat3::from_diagonal(stretch);
    Some((edits, linear))
}
