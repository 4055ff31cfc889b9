//! Maps of systems, and instances of structures, as parallelograms: images of the unit square.

use serde::Serialize;

use crate::document::node::{Node, Value};
use crate::edit::{Edit, PathStep};
use crate::geometry::{DAffine2, DMat2, DVec2};
use crate::ifs;

use super::act::below;
use super::names::{Basis, Names};
use super::{instances, nice, space};

/// Keys of maps, in the order in which they are named.
const FORMS: [&str; 8] = [
    "matrix",
    "scale",
    "rotate",
    "times",
    "conjugate",
    "translate",
    "shift",
    "fixed",
];

/// A map with its handles.
#[derive(Clone, Debug, Serialize)]
pub(super) struct MapHandle {
    pub(super) name: String,
    /// Images of the lower left corner of a rectangle, of the lower right one, and of the upper left one.
    pub(super) frame: [[f64; 2]; 3],
    /// Vector of the edges of a box along the view, in space.
    pub(super) depth: Option<[f64; 2]>,
    pub(super) basis: Basis,
    pub(super) weight: Option<f64>,
    /// Forms that it is written in, as `scale`, `rotate` and `shift`.
    pub(super) form: String,
    /// Whether it is an instance of a structure, whose transforms are done in the order of the file.
    pub(super) is_instance: bool,
    /// Map of the unit square to that rectangle.
    #[serde(skip)]
    pub(super) unit: DAffine2,
    #[serde(skip)]
    pub(super) at: Vec<PathStep>,
    #[serde(skip)]
    pub(super) node: Node,
}

impl MapHandle {
    /// Creates the handle of a map that is written by a node at a place.
    pub(super) fn of(
        name: String,
        (map, basis): (DAffine2, Basis),
        node: &Node,
        at: Vec<PathStep>,
    ) -> Self {
        Self {
            name,
            frame: corners(map),
            depth: None,
            unit: DAffine2::IDENTITY,
            basis,
            weight: None,
            form: String::new(),
            is_instance: false,
            at,
            node: node.clone(),
        }
    }

    /// Shows the image of another rectangle.
    pub(super) fn lay(&mut self, unit: DAffine2) {
        let [o, x, y] = self.frame.map(DVec2::from);
        let own = DAffine2::from_cols(x - o, y - o, o);
        self.frame = corners(own * self.unit.inverse() * unit);
        self.unit = unit;
    }

    /// Returns the map for other values of names, and what it depends on.
    pub(super) fn map(&self, names: &Names) -> Option<(DAffine2, Basis)> {
        match self.is_instance {
            _ if names.is_in_space() => space::seen(&self.node, names, self.is_instance),
            true => instances::placed(&self.node, names),
            false => affine(&self.node, names),
        }
    }

    /// Returns the place of a grip for other values of names.
    pub(super) fn grip(&self, grip: Grip, names: &Names) -> Option<[f64; 2]> {
        let (map, _) = self.map(names)?;
        let corner = match grip {
            Grip::Body => DVec2::ZERO,
            Grip::X => DVec2::X,
            Grip::Y => DVec2::Y,
        };
        Some((map * self.unit).transform_point2(corner).to_array())
    }

    /// Returns the edits that write the map after a grip has been dragged, in the keys in which it is written. `None` if
    /// no map of that form lies there.
    pub(super) fn edits(&self, names: &Names, pull: &Pull) -> Option<Vec<Edit>> {
        match self.is_instance {
            _ if names.is_in_space() => space::edits(self, names, pull),
            true => instances::edits(self, names, pull),
            false => edits(self, names, pull),
        }
    }

    /// Returns the name as the page shows it.
    pub(super) fn title(&self) -> String {
        let what = if self.is_instance { "instance" } else { "map" };
        format!("{what} {}", self.name)
    }

    /// Returns the corners of the parallelogram.
    pub(super) fn corners(&self) -> [[f64; 2]; 4] {
        let [o, x, y] = self.frame;
        let far = [0, 1].map(|axis| x[axis] + y[axis] - o[axis]);
        [o, x, far, y]
    }
}

/// Returns the images of three corners of the unit square.
fn corners(map: DAffine2) -> [[f64; 2]; 3] {
    let image = |x, y| map.transform_point2(DVec2::new(x, y)).to_array();
    [image(0.0, 0.0), image(1.0, 0.0), image(0.0, 1.0)]
}

/// Returns the maps of a list, or of a mapping of names.
pub(super) fn handles(node: &Node, at: &[PathStep], names: &Names) -> Vec<MapHandle> {
    let entries: Vec<(PathStep, &Node)> = match &node.value {
        Value::Sequence(items) => {
            let items = items.iter().enumerate();
            items.map(|(number, item)| (number.into(), item)).collect()
        }
        Value::Mapping(entries) => {
            let entries = entries.iter();
            entries
                .map(|(key, node)| (PathStep::Key(key.name.clone()), node))
                .collect()
        }
        _ => Vec::new(),
    };
    let handle = |(step, node): (PathStep, &Node)| {
        let name = match &step {
            PathStep::Item(number) => (number + 1).to_string(),
            PathStep::Key(name) => name.clone(),
        };
        let weight = node.get("weight").and_then(|node| names.value(node));
        Some(MapHandle {
            weight: weight.map(|it| it.0),
            form: forms(node, &FORMS),
            depth: space::depth(node, names, false).filter(|_| names.is_in_space()),
            ..MapHandle::of(name, map_of(node, names)?, node, below(at, step))
        })
    };
    entries.into_iter().filter_map(handle).collect()
}

/// Returns the keys of a mapping in which something is written, of several.
pub(super) fn forms(node: &Node, keys: &[&str]) -> String {
    let written = keys.iter().filter(|key| node.get(key).is_some());
    written.copied().collect::<Vec<_>>().join(", ")
}

/// Returns a number as it is written.
pub(super) fn number(value: f64, pixel: f64) -> String {
    nice::written(value, nice::expression(value).is_some(), pixel / 4.0)
}

/// Returns a vector as it is written.
pub(super) fn two(value: DVec2, pixel: f64) -> String {
    format!("[{}, {}]", number(value.x, pixel), number(value.y, pixel))
}

/// Returns the matrix with some rows, and what it depends on.
pub(super) fn rows(node: &Node, names: &Names) -> Option<(DMat2, Basis)> {
    let Value::Sequence(rows) = &node.value else {
        return None;
    };
    let rows: Option<Vec<_>> = rows.iter().map(|row| names.point(row)).collect();
    let [(a, one), (b, other)] = rows?[..] else {
        return None;
    };
    let matrix = DMat2::from_cols(DVec2::new(a[0], b[0]), DVec2::new(a[1], b[1]));
    Some((matrix, one.max(other)))
}

/// Returns a number, or a pair of equal or different ones.
pub(super) fn pair(node: &Node, names: &Names) -> Option<(DVec2, Basis)> {
    match names.value(node) {
        Some((value, basis)) => Some((DVec2::splat(value), basis)),
        None => names.point(node).map(|(pair, basis)| (pair.into(), basis)),
    }
}

/// Returns a map as it is written, as far as it is seen, and what it depends on.
fn map_of(node: &Node, names: &Names) -> Option<(DAffine2, Basis)> {
    match names.is_in_space() {
        true => space::seen(node, names, false),
        false => affine(node, names),
    }
}

/// Returns a map of the plane as it is written, and what it depends on.
fn affine(node: &Node, names: &Names) -> Option<(DAffine2, Basis)> {
    let mut basis = Basis::Numbers;
    let mut take = |key: &str| match node.get(key) {
        None => Some(None),
        Some(node) => {
            let (value, own) = match key {
                "scale" | "rotate" => pair(node, names)?,
                _ => names.point(node).map(|(at, own)| (at.into(), own))?,
            };
            // The number before the parameters of `90 + bend` is the map's own.
            basis = basis.max(match own {
                Basis::Parameters if key == "rotate" && is_offset(node) => Basis::Numbers,
                own => own,
            });
            Some(Some(value))
        }
    };
    let (scale, rotate, times) = (take("scale")?, take("rotate")?, take("times")?);
    let (shift, translate, fixed) = (take("shift")?, take("translate")?, take("fixed")?);
    let conjugates = matches!(
        node.get("conjugate").map(|it| &it.value),
        Some(Value::Bool(true))
    );
    let linear = match (node.get("matrix"), times) {
        (Some(node), _) => {
            let (matrix, own) = rows(node, names)?;
            basis = basis.max(own);
            matrix
        }
        (None, Some(s)) if conjugates => ifs::complex_conjugate(s, DVec2::ZERO).matrix2,
        (None, Some(s)) => ifs::complex(s, DVec2::ZERO).matrix2,
        (None, None) => ifs::axes(scale.unwrap_or(DVec2::ONE), rotate.unwrap_or(DVec2::ZERO)),
    };
    let map = match fixed {
        Some(centre) => ifs::about(linear, centre),
        None => {
            let shift = shift.or(translate).unwrap_or(DVec2::ZERO);
            DAffine2::from_mat2_translation(linear, shift)
        }
    };
    map.is_finite().then_some((map, basis))
}

/// Splits a formula that begins with a term which is a number, such as `90 + bend`, into that number and the other terms.
fn offset(text: &str) -> Option<(f64, &str)> {
    let is_digit = |at: usize, it: char| it.is_ascii_digit() || it == '.' || (at == 0 && it == '-');
    let end = { text.char_indices() }.find(|&(at, it)| !is_digit(at, it));
    let (number, rest) = text.split_at(end?.0);
    let rest = rest.trim_start();
    let number = number.parse().ok()?;
    rest.starts_with(['+', '-']).then_some((number, rest))
}

/// Returns whether a number, or each of a list, has a term of its own.
pub(super) fn is_offset(node: &Node) -> bool {
    match &node.value {
        Value::Number(_) => true,
        Value::Text(text) => offset(text).is_some(),
        Value::Sequence(parts) => parts.iter().all(is_offset),
        _ => false,
    }
}

/// Returns an angle as it is written in the place of another one. Terms with parameters stay.
pub(super) fn turned(node: Option<&Node>, names: &Names, angle: f64) -> String {
    let round = |angle: f64| nice::decimals(angle, 0.05);
    let kept = node.and_then(|node| {
        let Value::Text(text) = &node.value else {
            return None;
        };
        let (number, rest) = offset(text)?;
        let others = names.value(node)?.0 - number;
        Some(format!("{} {rest}", round(angle - others)))
    });
    kept.unwrap_or_else(|| round(angle))
}

/// Part of a parallelogram that is dragged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Grip {
    /// The whole parallelogram.
    Body,
    /// The image of the lower right corner.
    X,
    /// The image of the upper left corner.
    Y,
}

/// Movement of a grip.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pull {
    pub(super) grip: Grip,
    /// Place to which it has been dragged.
    pub(super) to: DVec2,
    /// Whether the angles of the map stay.
    pub(super) similar: bool,
    /// Length of a pixel.
    pub(super) pixel: f64,
}

/// Returns the map of which a grip has been dragged to a place; `similar` keeps its angles.
pub(super) fn dragged(old: DAffine2, grip: Grip, to: DVec2, similar: bool) -> DAffine2 {
    let mut new = old;
    let column = match grip {
        Grip::Body => {
            new.translation = to;
            return new;
        }
        Grip::X => 0,
        Grip::Y => 1,
    };
    let (before, after) = (old.matrix2.col(column), to - old.translation);
    match similar && before.length_squared() > 0.0 {
        true => {
            let by =
                DVec2::new(before.dot(after), before.perp_dot(after)) / before.length_squared();
            new.matrix2 = ifs::complex(by, DVec2::ZERO).matrix2 * old.matrix2;
        }
        false => *new.matrix2.col_mut(column) = after,
    }
    new
}

/// Returns the edits that write a dragged map in the keys in which it is written.
///
/// A map with one factor, or one complex factor, stays a similarity.
fn edits(handle: &MapHandle, names: &Names, pull: &Pull) -> Option<Vec<Edit>> {
    let Pull {
        grip,
        to,
        similar,
        pixel,
    } = *pull;
    let (old, _) = affine(&handle.node, names)?;
    let node = &handle.node;
    let is_one = |key: &str| node.get(key).is_none_or(|node| names.value(node).is_some());
    let keeps = similar || node.get("matrix").is_none() && is_one("scale");
    let image = dragged(old * handle.unit, grip, to, keeps);
    let new = match grip {
        Grip::Body => {
            let by = image.translation - (old * handle.unit).translation;
            DAffine2::from_translation(by) * old
        }
        Grip::X | Grip::Y => image * handle.unit.inverse(),
    };
    let step =
        |key: &str| -> Vec<PathStep> { handle.at.iter().cloned().chain([key.into()]).collect() };
    // The length by which the rectangle moves if a factor changes by 1.
    let length = handle
        .unit
        .matrix2
        .x_axis
        .length()
        .max(handle.unit.matrix2.y_axis.length());
    let factor = |value: f64| number(value, pixel / length);
    let factors_of = |value: DVec2| two(value, pixel / length);
    let two = |value: DVec2| two(value, pixel);
    let number = |value: f64| number(value, pixel);
    let put = |key: &str, value: String| match node.get(key) {
        Some(_) => Edit::set(step(key), value),
        None => Edit::add(handle.at.clone(), key, value),
    };
    // Coordinates that stay are written as they are.
    let coordinates = |key: &str, to: DVec2| match node.get(key).map(|node| &node.value) {
        Some(Value::Sequence(parts)) if parts.len() == 2 => {
            let changed = |axis: &usize| {
                let before = names.value(&parts[*axis]);
                before.is_none_or(|(before, _)| (to[*axis] - before).abs() > 1e-12)
            };
            let set = |axis: usize| Edit::set(below(&step(key), axis), number(to[axis]));
            (0..2).filter(changed).map(set).collect()
        }
        _ => vec![Edit::set(step(key), two(to))],
    };
    let mut edits = Vec::new();
    if new.matrix2 != old.matrix2 {
        let [x, y] = [new.matrix2.x_axis, new.matrix2.y_axis];
        if node.get("matrix").is_some() {
            let rows = [DVec2::new(x.x, y.x), DVec2::new(x.y, y.y)].map(factors_of);
            edits.push(Edit::set(
                step("matrix"),
                format!("[{}, {}]", rows[0], rows[1]),
            ));
        } else if node.get("times").is_some() {
            edits.push(Edit::set(step("times"), factors_of(x)));
        } else {
            let degrees = |of: DVec2| libm::atan2(of.y, of.x).to_degrees();
            let mirrored = new.matrix2.determinant() < 0.0;
            let scale = node
                .get("scale")
                .and_then(|node| pair(node, names))
                .map(|it| it.0);
            let signs = scale.map_or(DVec2::ONE, DVec2::signum);
            let sy = if mirrored == (signs.x * signs.y < 0.0) {
                signs.y
            } else {
                -signs.y
            };
            let factors = DVec2::new(x.length() * signs.x, y.length() * sy);
            let angles = [degrees(x * signs.x), degrees(-(y * sy).perp())];
            let rotate = node.get("rotate");
            let part = |axis: usize| match rotate.map(|node| &node.value) {
                Some(Value::Sequence(parts)) => parts.get(axis),
                _ => rotate,
            };
            let turn = |axis: usize| turned(part(axis), names, angles[axis]);
            let one_scale = node
                .get("scale")
                .is_some_and(|node| names.value(node).is_some());
            let one_angle = is_one("rotate");
            if (factors - scale.unwrap_or(DVec2::ONE)).length() > 1e-12 {
                let text = if one_scale {
                    factor(factors.x)
                } else {
                    factors_of(factors)
                };
                edits.push(put("scale", text));
            }
            if one_angle {
                let text = turn(usize::from(grip == Grip::Y));
                if rotate.is_some() || text != "0" {
                    edits.push(put("rotate", text));
                }
            } else {
                let text = format!("[{}, {}]", turn(0), turn(1));
                edits.push(Edit::set(step("rotate"), text));
            }
        }
    }
    if node.get("fixed").is_some() {
        let rest = DMat2::IDENTITY - new.matrix2;
        if rest.determinant().abs() < 1e-9 {
            return None;
        }
        let centre = rest.inverse() * new.translation;
        edits.extend(coordinates("fixed", centre));
    } else if new.translation != old.translation {
        let key = match node.get("shift") {
            Some(_) => "shift",
            None => "translate",
        };
        match node.get(key) {
            Some(_) => edits.extend(coordinates(key, new.translation)),
            None => edits.push(put(key, two(new.translation))),
        }
    }
    Some(edits)
}
