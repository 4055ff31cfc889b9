//! Reading of what is written otherwise in space than in the plane: maps and vertices of systems.

use crate::document::ifs::{LinearDocument, TurnDocument};
use crate::document::mapping::FromNode;
use crate::document::node::{Node, Value};
use crate::document::reader::{Fields, Reader};
use crate::document::shape::{Form, Member, Shape, alternative, key, keys};
use crate::document::{Written, WrittenNumber, WrittenPoint};
use crate::expression::Expression;

/// Key that puts a file into space.
pub(super) const SPACE: Member = key(
    "space",
    Form::Whole(2, Some(3)),
    "3 for a file in space, whose points have three coordinates; 2, the plane, if left out.",
);

/// Reads whether a file lies in space. Reports a window, which only files of the plane have.
pub(super) fn read_space(reader: &mut Reader, fields: &Fields<'_>) -> bool {
    reader.may_lie_in_space = true;
    let Some(node) = fields.take("space") else {
        return false;
    };
    match node.value {
        Value::Number(2.0) => return false,
        Value::Number(3.0) => {}
        _ => report_dimension(reader, node),
    }
    if let Some(Value::Mapping(view)) = fields.take("view").map(|view| &view.value)
        && let Some((key, _)) = view.iter().find(|(key, _)| key.name == "window")
    {
        let hint = "in space, a picture has a camera: `kfrac grow --from 30,25 --look-at 0,0,0`";
        reader.error_with_hint(&key.place, "a window lies in the plane", hint);
    }
    true
}

/// Key that puts a component into space.
pub(in crate::document) const SPACE_OF_COMPONENT: Member = key(
    "space",
    Form::Whole(2, Some(3)),
    "3 for a component in space, which only rules in space have; 2, the plane, if left out.",
);

/// The space of a component as written, which is checked when it is read.
#[derive(Clone, Copy, Debug)]
pub struct InSpace;

impl FromNode for InSpace {
    /// Reports a component of space in a file of the plane; what follows is read as in space then.
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        match node.value {
            Value::Number(2.0) => {}
            Value::Number(3.0) if reader.is_in_space => {}
            Value::Number(3.0) => {
                let message =
                    "this component lies in space, and the file that uses it in the plane";
                let hint = "write `space: 3` at the top of that file";
                reader.error_with_hint(&node.place, message, hint);
                reader.is_in_space = true;
            }
            _ => report_dimension(reader, node),
        }
        Some(Self)
    }

    fn absent(_: &Fields<'_>, _: &'static str) -> Option<Self> {
        Some(Self)
    }
}

fn report_dimension(reader: &mut Reader, node: &Node) {
    let message = format!("there is no space of dimension {}", node.place.text());
    let hint = "space: 3, or space: 2 for the plane";
    reader.error_with_hint(&node.place, message, hint);
}

/// Reports a key of a mapping that is known in space only, in a file of the plane.
pub(super) fn only_in_space(reader: &mut Reader, node: &Node, name: &str) {
    if !reader.is_in_space
        && let Value::Mapping(entries) = &node.value
        && let Some((key, _)) = entries.iter().find(|(key, _)| key.name == name)
    {
        let message = format!("`{name}` is known in space only");
        reader.error_with_hint(&key.place, message, "write `space: 3` at the top");
    }
}

/// Keys of a turn of space.
pub(super) const TURN: Shape = Shape {
    what: "a turn",
    keys: &[&keys![
        x: Form::Number, "An angle about the x axis, in degrees, from y to z.";
        y: Form::Number, "An angle about the y axis, in degrees, from z to x.";
        z: Form::Number, "An angle about the z axis, in degrees, from x to y.";
        axis: Form::Place, "In place of these: the axis of a turn by `angle`.";
        angle: Form::Number, "The angle about `axis`, in degrees, by the right-hand rule.";
    ]],
    alternatives: &[
        alternative(&["x"], &["y", "z", "axis", "angle"]),
        alternative(&["y"], &["x", "z", "axis", "angle"]),
        alternative(&["z"], &["x", "y", "axis", "angle"]),
        alternative(&["axis", "angle"], &["x", "y", "z"]),
    ],
    hint: "rotate: {y: 30}, rotate: {axis: [1, 1, 0], angle: 30}, or a list of them in order",
};

/// Names of the solids whose corners are vertices.
pub(super) const SOLIDS: [&str; 6] = [
    "tetrahedron",
    "cube",
    "octahedron",
    "dodecahedron",
    "icosahedron",
    "pyramid",
];

const MAP_HINT: &str = "{scale: 1/2, rotate: {y: 45}, translate: [1, 0, 0]} or \
                        {matrix: [[a, b, c], [d, e, f], [g, h, i]], translate: [x, y, z]}";

/// Reads the linear part of a map of space.
pub(super) fn read_linear(reader: &mut Reader, fields: &Fields<'_>) -> Option<LinearDocument> {
    for key in ["times", "conjugate"] {
        if fields.take(key).is_some() {
            let message = format!("`{key}` is for complex numbers, which lie in the plane");
            reader.error_with_hint(fields.place_of(key), message, MAP_HINT);
            return None;
        }
    }
    let (matrix, scale) = (fields.take("matrix"), fields.take("scale"));
    let rotate = fields.take("rotate");
    if let Some(node) = matrix {
        for key in ["scale", "rotate"] {
            if fields.take(key).is_some() {
                let message = format!("`{key}` does not go with `matrix`");
                reader.error_with_hint(fields.place_of(key), message, MAP_HINT);
            }
        }
        return read_matrix(reader, node).map(LinearDocument::MatrixInSpace);
    }
    let Some(scale) = scale else {
        let message = match rotate {
            Some(_) => "this map turns, but has no scale",
            None if fields.in_order().next().is_some() => "this map has no scale and no matrix",
            None => "this map is empty",
        };
        reader.error_with_hint(&fields.place.first_line(), message, MAP_HINT);
        return None;
    };
    let scale = read_factors(reader, scale, "factors", FACTORS_HINT);
    let turns = rotate.map(|node| read_turns(reader, node));
    Some(LinearDocument::AxesInSpace {
        scale: scale?,
        turns: turns.unwrap_or(Some(Vec::new()))?,
    })
}

/// Reads the rows of a matrix.
pub(super) fn read_matrix(reader: &mut Reader, node: &Node) -> Option<[WrittenPoint; 3]> {
    let hint = "matrix: [[a, b, c], [d, e, f], [g, h, i]]";
    let rows = reader.list(node, "a list of three rows", hint);
    if let [first, second, third] = rows {
        let rows = [first, second, third];
        for row in rows {
            if matches!(&row.value, Value::Sequence(entries) if entries.len() == 2) {
                let message = "a row has three numbers in space, this one has 2";
                reader.error_with_hint(&row.place, message, hint);
                return None;
            }
        }
        return Some(rows.map(|row| reader.point(row)));
    }
    if matches!(node.value, Value::Sequence(_)) {
        let message = format!(
            "a matrix has three rows in space, this one has {}",
            rows.len()
        );
        reader.error_with_hint(&node.place, message, hint);
    }
    None
}

pub(super) const FACTORS_HINT: &str = "scale: 1/2, or scale: [sx, sy, sz]";

/// Reads three numbers, or one that stands for all.
pub(super) fn read_factors(
    reader: &mut Reader,
    node: &Node,
    what: &str,
    hint: &str,
) -> Option<[WrittenNumber; 3]> {
    let Value::Sequence(entries) = &node.value else {
        let number = reader.number(node);
        return Some([number.clone(), number.clone(), number]);
    };
    if entries.len() == 3 {
        let point = reader.point(node);
        let WrittenPoint { x, y, z, .. } = point;
        return Some([x, y, *z?]);
    }
    let message = format!("there are three {what} in space, not {}", entries.len());
    reader.error_with_hint(&node.place, message, hint);
    None
}

/// Reads a turn, or a list of them in order.
pub(super) fn read_turns(reader: &mut Reader, node: &Node) -> Option<Vec<TurnDocument>> {
    match &node.value {
        Value::Sequence(turns)
            if !turns.is_empty()
                && turns
                    .iter()
                    .all(|turn| matches!(turn.value, Value::Mapping(_))) =>
        {
            let turns: Vec<_> = turns.iter().map(|turn| read_turn(reader, turn)).collect();
            turns.into_iter().collect()
        }
        Value::Mapping(_) => Some(vec![read_turn(reader, node)?]),
        _ => {
            let message = "in space, a turn has an axis";
            reader.error_with_hint(&node.place, message, TURN.hint);
            None
        }
    }
}

/// Returns whether a node is a turn about an axis, or a list that begins with one.
pub(super) fn is_turn(node: &Node) -> bool {
    match &node.value {
        Value::Mapping(_) => true,
        Value::Sequence(turns) => turns.first().is_some_and(is_turn),
        _ => false,
    }
}

fn read_turn(reader: &mut Reader, node: &Node) -> Option<TurnDocument> {
    let fields = reader.fields(node, &TURN)?;
    let axes = [("x", [1, 0, 0]), ("y", [0, 1, 0]), ("z", [0, 0, 1])];
    let mut there = axes.iter().filter(|(key, _)| fields.take(key).is_some());
    let (first, second) = (there.next(), there.next());
    if let Some((key, _)) = second {
        let message = "the order of these turns is open";
        let hint = "write a list: rotate: [{x: 20}, {y: 30}]";
        reader.error_with_hint(fields.place_of(key), message, hint);
        return None;
    }
    let (axis, angle) = (fields.take("axis"), fields.take("angle"));
    match (first, axis, angle) {
        (Some((key, axis)), None, None) => {
            let [x, y, z] = axis.map(|along| number(f64::from(along), node));
            let axis = WrittenPoint {
                x,
                y,
                z: Some(Box::new(z)),
                place: node.place.clone(),
            };
            let angle = reader.number(fields.take(key)?);
            Some(TurnDocument { axis, angle })
        }
        (None, Some(axis), Some(angle)) => Some(TurnDocument {
            axis: reader.point(axis),
            angle: reader.number(angle),
        }),
        _ => {
            let message = "a turn has one of the axes x, y and z, or `axis` and `angle`";
            reader.error_with_hint(&node.place.first_line(), message, TURN.hint);
            None
        }
    }
}

fn number(value: f64, node: &Node) -> WrittenNumber {
    Written {
        value: Expression::number(value),
        place: node.place.clone(),
    }
}

/// Reads the name of a solid. Reports one that is not known.
pub(super) fn read_name_of_solid(reader: &mut Reader, node: &Node) -> Option<Written<String>> {
    let name = reader.text(node)?;
    if !SOLIDS.contains(&name.as_str()) {
        let hint = crate::diagnostic::did_you_mean(&name, SOLIDS)
            .unwrap_or_else(|| format!("one of: {}", SOLIDS.join(", ")));
        reader.error_with_hint(&node.place, format!("'{name}' is no solid"), hint);
        return None;
    }
    Some(Written {
        value: name,
        place: node.place.clone(),
    })
}

/// Returns the corners of a solid of a name, about the origin; all coordinates are exact expressions. `None` if the name is
/// not known.
pub(crate) fn corners_of_solid(name: &Written<String>) -> Option<Vec<WrittenPoint>> {
    let coordinate = |text: &str| Written {
        value: Expression::parse(text).unwrap_or_else(|_| Expression::unknown()),
        place: name.place.clone(),
    };
    let corners = corners_of(&name.value)?;
    let corners = corners.iter().map(|[x, y, z]| WrittenPoint {
        x: coordinate(x),
        y: coordinate(y),
        z: Some(Box::new(coordinate(z))),
        place: name.place.clone(),
    });
    Some(corners.collect())
}

/// Returns the corners of a solid (Coxeter, "Regular Polytopes", 3.7); the pyramid has a square base and edges
/// of length 2.
fn corners_of(name: &str) -> Option<Vec<[String; 3]>> {
    const SIGNS: [&str; 2] = ["", "-"];
    let point = |x: String, y: String, z: String| [x, y, z];
    let signed = |sign: &str, value: &str| format!("{sign}{value}");
    let cube = || {
        let signs = SIGNS.iter().flat_map(|a| SIGNS.iter().map(move |b| (a, b)));
        let signs = signs.flat_map(|(a, b)| SIGNS.iter().map(move |c| (a, b, c)));
        signs.map(|(a, b, c)| point(signed(a, "1"), signed(b, "1"), signed(c, "1")))
    };
    // The corners (0, ± a, ± b) and their cyclic permutations.
    let golden = |first: &'static str, second: &'static str| {
        let signs = SIGNS.iter().flat_map(|a| SIGNS.iter().map(move |b| (a, b)));
        signs.flat_map(move |(a, b)| {
            let (zero, a, b) = ("0".to_owned(), signed(a, first), signed(b, second));
            [
                point(zero.clone(), a.clone(), b.clone()),
                point(b.clone(), zero.clone(), a.clone()),
                point(a, b, zero),
            ]
        })
    };
    Some(match name {
        "cube" => cube().collect(),
        "tetrahedron" => {
            let is_even = |corner: &[String; 3]| {
                corner.iter().filter(|at| at.starts_with('-')).count() % 2 == 0
            };
            cube().filter(is_even).collect()
        }
        "octahedron" => {
            let axes = (0..3).flat_map(|axis| SIGNS.map(|sign| (axis, sign)));
            let corner = |(axis, sign): (usize, &str)| {
                [0, 1, 2].map(|at| match at == axis {
                    true => signed(sign, "1"),
                    false => "0".to_owned(),
                })
            };
            axes.map(corner).collect()
        }
        "dodecahedron" => cube().chain(golden("(1/phi)", "phi")).collect(),
        "icosahedron" => golden("1", "phi").collect(),
        "pyramid" => {
            let base = SIGNS.iter().flat_map(|a| SIGNS.iter().map(move |b| (a, b)));
            let base = base.map(|(a, b)| point(signed(a, "1"), "0".into(), signed(b, "1")));
            let apex = point("0".into(), "sqrt(2)".into(), "0".into());
            base.chain([apex]).collect()
        }
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::{SOLIDS, corners_of};

    #[test]
    fn every_solid_has_corners() {
        for name in SOLIDS {
            assert!(
                corners_of(name).is_some_and(|corners| corners.len() >= 4),
                "{name}"
            );
        }
        assert!(corners_of("ball").is_none());
    }
}
