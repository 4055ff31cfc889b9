//! Maps of systems as parallelograms: images of the unit square.

use serde::Serialize;

use crate::document::node::{Node, Value};
use crate::edit::{Edit, PathStep};
use crate::geometry::{DAffine2, DMat2, DVec2};
use crate::ifs;

use super::names::{Basis, Names};
use super::nice;

/// A map with its handles.
#[derive(Clone, Debug, Serialize)]
pub(super) struct MapHandle {
    pub(super) name: String,
    /// Images of (0, 0), (1, 0) and (0, 1).
    pub(super) frame: [[f64; 2]; 3],
    pub(super) basis: Basis,
    pub(super) weight: Option<f64>,
    /// Forms that it is written in, as `scale`, `rotate` and `shift`.
    pub(super) form: String,
    #[serde(skip)]
    pub(super) at: Vec<PathStep>,
    #[serde(skip)]
    pub(super) node: Node,
}

impl MapHandle {
    /// Returns the corners of the parallelogram.
    pub(super) fn corners(&self) -> [[f64; 2]; 4] {
        let [o, x, y] = self.frame;
        let far = [0, 1].map(|axis| x[axis] + y[axis] - o[axis]);
        [o, x, far, y]
    }
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
        let (map, basis) = affine(node, names)?;
        let forms = [
            "matrix",
            "scale",
            "rotate",
            "times",
            "conjugate",
            "translate",
            "shift",
            "fixed",
        ];
        let written = forms.iter().filter(|key| node.get(key).is_some());
        let image = |x, y| map.transform_point2(DVec2::new(x, y)).to_array();
        Some(MapHandle {
            name: match &step {
                PathStep::Item(number) => (number + 1).to_string(),
                PathStep::Key(name) => name.clone(),
            },
            frame: [image(0.0, 0.0), image(1.0, 0.0), image(0.0, 1.0)],
            basis,
            weight: node
                .get("weight")
                .and_then(|node| names.value(node))
                .map(|it| it.0),
            form: written.copied().collect::<Vec<_>>().join(", "),
            at: at.iter().cloned().chain([step]).collect(),
            node: node.clone(),
        })
    };
    entries.into_iter().filter_map(handle).collect()
}

/// Returns a number, or a pair of equal or different ones.
fn pair(node: &Node, names: &Names) -> Option<(DVec2, Basis)> {
    match names.value(node) {
        Some((value, basis)) => Some((DVec2::splat(value), basis)),
        None => names.point(node).map(|(pair, basis)| (pair.into(), basis)),
    }
}

/// Returns a map of the plane as it is written, and what it depends on.
pub(super) fn affine(node: &Node, names: &Names) -> Option<(DAffine2, Basis)> {
    let mut basis = Basis::Numbers;
    let mut take = |key: &str| match node.get(key) {
        None => Some(None),
        Some(node) => {
            let (value, own) = pair(node, names)?;
            basis = basis.max(own);
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
        (Some(rows), _) => {
            let Value::Sequence(rows) = &rows.value else {
                return None;
            };
            let rows: Option<Vec<_>> = rows.iter().map(|row| names.point(row)).collect();
            let [(a, one), (b, other)] = rows?[..] else {
                return None;
            };
            basis = basis.max(one).max(other);
            DMat2::from_cols(DVec2::new(a[0], b[0]), DVec2::new(a[1], b[1]))
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

/// Part of a parallelogram that is dragged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Grip {
    /// The whole parallelogram.
    Body,
    /// The image of (1, 0).
    X,
    /// The image of (0, 1).
    Y,
}

/// Returns the map of which a grip has been dragged to a place; `similar` keeps its angles.
fn dragged(old: DAffine2, grip: Grip, to: DVec2, similar: bool) -> DAffine2 {
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
pub(super) fn edits(
    handle: &MapHandle,
    names: &Names,
    grip: Grip,
    to: [f64; 2],
    similar: bool,
    pixel: f64,
) -> Option<Vec<Edit>> {
    let (old, _) = affine(&handle.node, names)?;
    let node = &handle.node;
    let is_one = |key: &str| node.get(key).is_none_or(|node| names.value(node).is_some());
    let keeps = similar || node.get("matrix").is_none() && is_one("scale");
    let new = dragged(old, grip, to.into(), keeps);
    let step =
        |key: &str| -> Vec<PathStep> { handle.at.iter().cloned().chain([key.into()]).collect() };
    let number = |value: f64| nice::written(value, nice::expression(value).is_some(), pixel / 4.0);
    let two = |value: DVec2| format!("[{}, {}]", number(value.x), number(value.y));
    let put = |key: &str, value: String| match node.get(key) {
        Some(_) => Edit::set(step(key), value),
        None => Edit::add(handle.at.clone(), key, value),
    };
    let mut edits = Vec::new();
    if new.matrix2 != old.matrix2 {
        let [x, y] = [new.matrix2.x_axis, new.matrix2.y_axis];
        if node.get("matrix").is_some() {
            let rows = [DVec2::new(x.x, y.x), DVec2::new(x.y, y.y)].map(two);
            edits.push(Edit::set(
                step("matrix"),
                format!("[{}, {}]", rows[0], rows[1]),
            ));
        } else if node.get("times").is_some() {
            edits.push(Edit::set(step("times"), two(x)));
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
            let round = |angle: f64| nice::decimals(angle, 0.05);
            let one_scale = node
                .get("scale")
                .is_some_and(|node| names.value(node).is_some());
            let one_angle = is_one("rotate");
            if (factors - scale.unwrap_or(DVec2::ONE)).length() > 1e-12 {
                let text = if one_scale {
                    number(factors.x)
                } else {
                    two(factors)
                };
                edits.push(put("scale", text));
            }
            if one_angle {
                let angle = if grip == Grip::Y {
                    angles[1]
                } else {
                    angles[0]
                };
                if node.get("rotate").is_some() || round(angle) != "0" {
                    edits.push(put("rotate", round(angle)));
                }
            } else {
                let text = format!("[{}, {}]", round(angles[0]), round(angles[1]));
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
        edits.push(Edit::set(step("fixed"), two(centre)));
    } else if new.translation != old.translation {
        let key = match node.get("shift") {
            Some(_) => "shift",
            None => "translate",
        };
        edits.push(put(key, two(new.translation)));
    }
    Some(edits)
}
