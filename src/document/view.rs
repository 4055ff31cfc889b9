//! Reading of `view`: the window of the plane, and the camera in space.

use crate::geometry::{DVec3, HalfSpace};
use crate::style::{Camera, Shade, Slice, SpaceView, View};

use super::node::{Node, Value};
use super::reader::{Fields, Reader};
use super::shape::{Form, Member, Shape, keys};
use super::style::constant;

const NUMBERS: Form = Form::List(&Form::Number, 3, Some(3));
const DIRECTION: Form = Form::Either(&[
    Form::Words(&["front", "side", "top", "iso"]),
    Form::List(&Form::Number, 2, Some(2)),
]);

/// Keys of a view in space.
const SPACE: [Member; 11] = keys![
    from: DIRECTION,
        "In space: the direction of the viewer, front, side, top, iso, or azimuth and elevation in degrees; [30, 25], or \
         along the normal of a slice, if left out.";
    up: NUMBERS, "In space: the vector that points upwards in the picture; the y axis if left out.";
    look_at: NUMBERS, "In space: the point in the middle of the picture.";
    perspective: Form::Number, "In space: the angle of view in degrees; a parallel projection if left out.";
    slice: Form::Mapping(&SLAB), "In space: the part between two planes.";
    cut: Form::Either(&[Form::Mapping(&PLANE), Form::List(&Form::Mapping(&PLANE), 1, None)]),
        "In space: what lies before a plane, or before each of several, is cut off.";
    shade: Form::variant::<Shade>(), "In space: the shading.";
    light: DIRECTION, "In space: the direction of the light, as `from`; [20, 50] if left out.";
    ambient: Form::Positive, "In space: the intensity of what the light does not reach, from 0 to 1; 0.15 if left out, and 0 with `cosine`.";
    occlusion: Form::Flag(false), "In space: whether what is enclosed by its surroundings is darker.";
    shadows: Form::Flag(false), "In space: whether the set throws shadows on itself.";
];

pub(super) const VIEW: Shape = Shape {
    what: "a view",
    keys: &[
        &keys![
            window: Form::List(&Form::Number, 4, Some(4)),
                "[x, y, width, height] in the rule's units, from the lower left corner; everything, if \
                 left out.";
            margin: Form::Positive, "Pixels that are left free around the picture; if left out, 4 % of its long side, and 0 around a window and in plots.";
        ],
        &SPACE,
    ],
    alternatives: &[],
    hint: "view: {window: [x, y, width, height], margin: 10}, or in space view: {from: [30, 25]}",
};

const SLAB: Shape = Shape {
    what: "a slice",
    keys: &[&keys![
        needed normal: NUMBERS, "The vector across the slice, towards the viewer."
            => "the slice has no normal";
        needed at: Form::Number, "The value of normal · x in the middle of the slice."
            => "the slice has no place";
        thickness: Form::Positive, "The thickness in units; a section if left out.";
    ]],
    alternatives: &[],
    hint: "slice: {normal: [1, 1, 1], at: 1.5, thickness: 0.01}",
};

const PLANE: Shape = Shape {
    what: "a cut",
    keys: &[&keys![
        needed normal: NUMBERS, "The normal of the plane." => "the cut has no normal";
        needed at: Form::Number, "The value of normal · x on the plane. Points with at most this value remain."
            => "the cut has no place";
    ]],
    alternatives: &[],
    hint: "cut: {normal: [1, 0, 0], at: 0.5}",
};

/// Reads a view. Camera and light are errors in the plane.
pub(super) fn read_view(reader: &mut Reader, node: &Node, in_space: bool) -> (View, SpaceView) {
    let mut space = SpaceView::default();
    let Some(fields) = reader.fields(node, &VIEW) else {
        return (View::default(), space);
    };
    let view = View {
        window: { fields.take("window") }.and_then(|node| window(reader, node)),
        margin: fields.optional(reader, "margin"),
    };
    let is_of_space = |name: &str| SPACE.iter().any(|member| member.name == name);
    if !in_space {
        for (name, _) in fields.in_order().filter(|(name, _)| is_of_space(name)) {
            let message = format!("`{name}` is for sets in space, and this file lies in the plane");
            let hint = "a view of the plane has a window and a margin";
            reader.error_with_hint(fields.place_of(name), message, hint);
        }
        return (view, space);
    }
    space.from = { fields.take("from") }.and_then(|node| direction(reader, node));
    space.light = { fields.take("light") }.and_then(|node| direction(reader, node));
    let up = fields.take("up");
    space.up = up.and_then(|node| vector(reader, node, "a vector upwards"));
    let look_at = fields.take("look_at");
    space.look_at = look_at.and_then(|node| numbers(reader, node).map(DVec3::from_array));
    let angle = fields.take("perspective");
    let wrong = "an angle of view is a number of degrees from 1 to 150";
    space.perspective = angle.and_then(|node| between(reader, node, [1.0, 150.0], wrong));
    let ambient = fields.take("ambient");
    let wrong = "the intensity is a number from 0 to 1";
    space.ambient = ambient.and_then(|node| between(reader, node, [0.0, 1.0], wrong));
    space.shade = { fields.take("shade") }.and_then(|node| reader.variant(node, "shading"));
    space.occlusion = { fields.take("occlusion") }.and_then(|node| reader.flag(node));
    space.shadows = { fields.take("shadows") }.and_then(|node| reader.flag(node));
    space.slice = { fields.take("slice") }.and_then(|node| slice(reader, node));
    let cuts = match fields.take("cut") {
        Some(node) if matches!(node.value, Value::Sequence(_)) => {
            reader.filled(node, "a list of cuts", "cut", PLANE.hint)
        }
        node => node.map(std::slice::from_ref).unwrap_or_default(),
    };
    for node in cuts {
        if let Some(fields) = reader.fields(node, &PLANE)
            && let Some((normal, distance)) = plane(reader, &fields)
        {
            space.cuts.push(HalfSpace { normal, distance });
        }
    }
    if space.up.is_some()
        && let Err(error) = space.camera().rotation()
    {
        let place = fields.place_of("up");
        reader.error_with_hint(place, error.to_string(), "up: [0, 1, 0]");
    }
    (view, space)
}

/// Reads a window: its lower left corner, its width and its height.
fn window(reader: &mut Reader, node: &Node) -> Option<[f64; 4]> {
    let entries = reader.list(node, "a list of four numbers", VIEW.hint);
    let numbers = entries.iter().filter_map(|entry| constant(reader, entry));
    let numbers: Vec<_> = numbers.collect();
    let window = <[f64; 4]>::try_from(numbers).ok();
    let window = window.filter(|_| entries.len() == 4);
    let is_empty = window.is_some_and(|[_, _, width, height]| width <= 0.0 || height <= 0.0);
    let is_list = matches!(node.value, Value::Sequence(_));
    if is_list && (is_empty || entries.len() != 4) {
        let message = "a window has a lower left corner, a width and a height above 0";
        reader.error_with_hint(&node.place, message, VIEW.hint);
    }
    window
}

/// Reads a direction: its name, or azimuth and elevation in degrees.
fn direction(reader: &mut Reader, node: &Node) -> Option<[f64; 2]> {
    let hint = "front, side, top, iso, or azimuth and elevation as [30, 25]";
    if let Value::Text(name) = &node.value {
        let named = Camera::NAMED.iter().find(|(known, _)| known == name);
        if named.is_none() {
            let message = format!("there is no direction '{name}'");
            reader.error_with_hint(&node.place, message, hint);
        }
        return named.map(|(_, angles)| *angles);
    }
    let angles = numbers_or(reader, node, "a direction", hint)?;
    let is_angle = angles.iter().all(|angle: &f64| angle.abs() <= 1e6);
    if !is_angle {
        reader.error_with_hint(&node.place, "angles are at most 1,000,000 degrees", hint);
    }
    is_angle.then_some(angles)
}

fn numbers(reader: &mut Reader, node: &Node) -> Option<[f64; 3]> {
    numbers_or(reader, node, "a point in space", "three numbers: [x, y, z]")
}

/// Reads a list of constants.
fn numbers_or<const N: usize>(
    reader: &mut Reader,
    node: &Node,
    what: &str,
    hint: &str,
) -> Option<[f64; N]> {
    let entries = reader.list(node, what, hint);
    if matches!(node.value, Value::Sequence(_)) && entries.len() != N {
        let message = format!("{what} has {N} numbers, this one has {}", entries.len());
        reader.error_with_hint(&node.place, message, hint);
        return None;
    }
    let numbers = entries.iter().map(|entry| constant(reader, entry));
    let numbers: Vec<f64> = numbers.collect::<Option<_>>()?;
    numbers.try_into().ok()
}

/// Reads a vector that has a direction.
fn vector(reader: &mut Reader, node: &Node, what: &str) -> Option<DVec3> {
    let vector = DVec3::from_array(numbers(reader, node)?);
    if vector.try_normalize().is_none() {
        let message = format!("{what} has a length");
        reader.error_with_hint(&node.place, message, "three numbers, not all 0: [x, y, z]");
        return None;
    }
    Some(vector)
}

/// Reads a constant within limits.
fn between(reader: &mut Reader, node: &Node, [least, most]: [f64; 2], wrong: &str) -> Option<f64> {
    let value = constant(reader, node)?;
    let is_right = (least..=most).contains(&value);
    if !is_right {
        reader.error_with_hint(&node.place, wrong, format!("from {least} to {most}"));
    }
    is_right.then_some(value)
}

fn slice(reader: &mut Reader, node: &Node) -> Option<Slice> {
    let fields = reader.fields(node, &SLAB)?;
    let thickness = fields.take("thickness");
    let wrong = "a thickness is above 0: a section has none";
    let thickness =
        thickness.map(|node| between(reader, node, [f64::MIN_POSITIVE, f64::MAX], wrong));
    let (normal, offset) = plane(reader, &fields)?;
    Some(Slice::new(normal, offset).thickness(thickness.unwrap_or_default()))
}

/// Reads the normal of a plane and its place along it.
fn plane(reader: &mut Reader, fields: &Fields<'_>) -> Option<(DVec3, f64)> {
    let normal = { fields.take("normal") }.and_then(|node| vector(reader, node, "a normal"));
    let at = { fields.take("at") }.and_then(|node| constant(reader, node));
    Some((normal?, at?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::Catalogue;
    use crate::diagnostic::{Diagnostics, Source};
    use crate::document::Document;

    fn read(space: u32, view: &str) -> Result<SpaceView, Diagnostics> {
        let text = format!(
            "kind: ifs\nspace: {space}\nmaps: [{{scale: 1/2}}, {{scale: 1/3}}]\nview: {{{view}}}\n"
        );
        let source = Source::new("test", text);
        let document = Document::read(&source, &Catalogue::embedded())?;
        let (model, _) = document.resolve(&[])?;
        Ok(model.metadata().space.clone())
    }

    #[test]
    fn views_in_space_have_all_that_the_command_line_has() {
        let view = read(
            3,
            "from: side, up: [0, 1, 1/2], look_at: [0, sqrt(4), -1], perspective: 40, margin: 3, shade: both, \
             slice: {normal: [1, 1, 1], at: phi, thickness: 0.1}, cut: [{normal: [0, 0, 1], at: 2}], \
             light: [20, -10], ambient: 0.4, occlusion: true, shadows: false",
        );
        let plane = HalfSpace {
            normal: DVec3::Z,
            distance: 2.0,
        };
        let phi = f64::midpoint(1.0, 5f64.sqrt());
        let expected = SpaceView {
            from: Some([90.0, 0.0]),
            up: Some(DVec3::new(0.0, 1.0, 0.5)),
            look_at: Some(DVec3::new(0.0, 2.0, -1.0)),
            perspective: Some(40.0),
            slice: Some(Slice::new(DVec3::ONE, phi).thickness(Some(0.1))),
            cuts: vec![plane],
            shade: Some(Shade::Both),
            light: Some([20.0, -10.0]),
            ambient: Some(0.4),
            occlusion: Some(true),
            shadows: Some(false),
        };
        assert_eq!(view.unwrap(), expected);
        // A slice on the command line is seen along its own normal.
        let mut own = SpaceView {
            slice: Some(Slice::new(DVec3::Y, 0.0)),
            ..SpaceView::default()
        };
        own = own.or(&expected);
        assert_eq!(own.direction(), [0.0, 90.0]);
        assert_eq!((own.shade, own.cuts), (expected.shade, expected.cuts));
    }

    #[test]
    fn wrong_views_are_errors() {
        for (space, view, message) in [
            (
                2,
                "from: front",
                "`from` is for sets in space, and this file lies in the plane",
            ),
            (3, "window: [0, 0, 1, 1]", "a window lies in the plane"),
            (3, "from: behind", "there is no direction 'behind'"),
            (3, "from: [1]", "a direction has 2 numbers, this one has 1"),
            (3, "from: [1e9, 0]", "angles are at most 1,000,000 degrees"),
            (3, "up: [0, 0, 0]", "a vector upwards has a length"),
            (
                3,
                "from: top, up: [0, 3, 0]",
                "the upward vector points to the viewer",
            ),
            (
                3,
                "perspective: 0",
                "an angle of view is a number of degrees from 1 to 150",
            ),
            (3, "ambient: 2", "the intensity is a number from 0 to 1"),
            (3, "slice: {at: 1}", "the slice has no normal"),
            (
                3,
                "slice: {normal: [1, 0, 0], at: 1, thickness: 0}",
                "a thickness is above 0",
            ),
            (
                3,
                "cut: {normal: [1, 0], at: 1}",
                "a point in space has 3 numbers, this one has 2",
            ),
            (3, "shade: dark", "'dark' is no shading"),
        ] {
            let errors = read(space, view).unwrap_err();
            assert!(errors.to_string().contains(message), "{view}: {errors}");
        }
    }
}
