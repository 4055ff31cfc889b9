//! Reading of sets: condensation sets, initial sets and primitives.

use crate::document::ifs::{FormDocument, FractalDocument, ShapeDocument, SolidDocument};
use crate::document::mapping::{FromNode, mapping};
use crate::document::node::{Node, Value};
use crate::document::reader::{Fields, Reader};
use crate::document::shape::{Form, KeySet, Member, Shape, alternative, keys};
use crate::document::{KindDocument, Written, WrittenNumber, WrittenPoint};
use crate::expression::PARTS;
use crate::geometry::MAX_HULL_POINTS;
use crate::kind::Kind;
use crate::metadata::MAX_STEPS;

use super::ifs::{PLACE, read_placing};
use super::parameters::{is_complex, written};
use super::solid::{CUBOID, ELLIPSOID, MESH, SHAFT, SPHERE, read_solid_set};
use super::space::SOLIDS;

/// Keys of an initial set.
pub(super) const SET: Shape = Shape {
    what: "a set",
    keys: &[&FORMS, &OF_FRACTAL],
    alternatives: &ALTERNATIVES,
    hint: HINT,
};

/// Keys of a condensation set.
pub(super) const CONDENSATION: Shape = Shape {
    what: "a condensation set",
    keys: &[
        &FORMS,
        &OF_FRACTAL,
        &keys![
            weight: Form::Positive,
                "How often random iteration draws a point anew from the set, relative to the weights \
                 of the maps; the mean of these if left out.";
        ],
    ],
    alternatives: &ALTERNATIVES,
    hint: HINT,
};

const HINT: &str = "{segment: [[0, 0], [0, 1]]}, {polygon: [...]}, \
                    {disk: {centre: [0, 0], radius: 1}}, ...";

const HINT_IN_SPACE: &str = "{sphere: {centre: [0, 0, 0], radius: 1}}, \
                             {cylinder: {from: [0, 0, 0], to: [0, 1, 0], radius: 1}}, {polygon: [...]}, ...";

/// Alternative keys for the geometry of a set.
pub(super) const FORMS: [Member; 15] = keys![
    point: Form::Point, "A point: a dot as wide as a line.";
    segment: Form::List(&Form::Point, 2, Some(2)), "A line from one point to another.";
    polyline: Form::List(&Form::Point, 2, None), "A line through points.";
    polygon: Form::List(&Form::Place, 3, None),
        "What a line through points and back to the first encloses.";
    disk: Form::Mapping(&DISK), "A disk; in space, with the normal z.";
    ellipse: Form::Mapping(&ELLIPSE), "An ellipse; in space, with the normal z.";
    sphere: Form::Mapping(&SPHERE), "In space, a ball.";
    ellipsoid: Form::Mapping(&ELLIPSOID), "In space, a ball that is stretched along its axes.";
    cylinder: Form::Mapping(&SHAFT), "In space, a solid cylinder.";
    cone: Form::Mapping(&SHAFT), "In space, a solid cone; `to` is its apex.";
    box: Form::Mapping(&CUBOID), "In space, a box along the axes.";
    solid: Form::Words(&SOLIDS), "In space, the solid whose corners are those of `vertices`.";
    hull: Form::List(&Form::Place, 3, Some(MAX_HULL_POINTS)), "In space, the convex hull of points.";
    mesh: Form::Either(&[Form::MeshFile, Form::Mapping(&MESH)]),
        "In space, the faces of a mesh: the name of a file .obj, .stl or .ply, or its points and faces.";
    fractal: Form::Grown,
        "Another fractal, as it is after some steps: the name of its file, or its content.";
];

/// Keys that accompany `fractal`.
pub(super) const OF_FRACTAL: [Member; 4] = keys![
    steps: Form::Whole(0, Some(MAX_STEPS)),
        "The number of steps of the fractal; those of its file if left out.";
    seed: Form::Whole(0, None), "What the random draws of the fractal depend on; 0 if left out.";
    set: Form::Names(&Form::Either(&[Form::Number, Form::Point]), 0),
        "Values of the fractal's parameters by name, in place of those of its file.";
    map: Form::Mapping(&PLACE), "Where the fractal stands, if not where its file has it.";
];

/// Number of keys for the geometry of a set, of which `fractal` is the last.
const COUNT: usize = FORMS.len();

/// Names of the keys of a set: those of [`FORMS`], then those of [`OF_FRACTAL`].
const NAMES: [&str; COUNT + OF_FRACTAL.len()] = {
    let mut names = [""; COUNT + OF_FRACTAL.len()];
    let mut number = 0;
    while number < names.len() {
        names[number] = if number < COUNT {
            FORMS[number].name
        } else {
            OF_FRACTAL[number - COUNT].name
        };
        number += 1;
    }
    names
};

/// Returns the first `N` keys of a set but one.
const fn others<const N: usize>(one: usize) -> [&'static str; N] {
    let mut names = [""; N];
    let mut number = 0;
    while number < N {
        names[number] = NAMES[if number < one { number } else { number + 1 }];
        number += 1;
    }
    names
}

const ALTERNATIVES: [KeySet; COUNT] = [
    alternative(&[NAMES[0]], &others::<OTHERS>(0)),
    alternative(&[NAMES[1]], &others::<OTHERS>(1)),
    alternative(&[NAMES[2]], &others::<OTHERS>(2)),
    alternative(&[NAMES[3]], &others::<OTHERS>(3)),
    alternative(&[NAMES[4]], &others::<OTHERS>(4)),
    alternative(&[NAMES[5]], &others::<OTHERS>(5)),
    alternative(&[NAMES[6]], &others::<OTHERS>(6)),
    alternative(&[NAMES[7]], &others::<OTHERS>(7)),
    alternative(&[NAMES[8]], &others::<OTHERS>(8)),
    alternative(&[NAMES[9]], &others::<OTHERS>(9)),
    alternative(&[NAMES[10]], &others::<OTHERS>(10)),
    alternative(&[NAMES[11]], &others::<OTHERS>(11)),
    alternative(&[NAMES[12]], &others::<OTHERS>(12)),
    alternative(&[NAMES[13]], &others::<OTHERS>(13)),
    alternative(&[NAMES[14]], &others::<{ COUNT - 1 }>(14)),
];

/// Number of keys that exclude each other, but for `fractal` and those that accompany it.
const OTHERS: usize = NAMES.len() - 1;

mapping! {
    /// A disk as written.
    struct DiskDocument: DISK = "a disk", "disk: {centre: [0, 0], radius: 1}";
    centre: Option<WrittenPoint> = Form::Point, "Its centre; [0, 0] if left out.";
    needed radius: WrittenNumber = Form::Positive, "Its radius, above 0."
        => "a disk needs a radius";
}

mapping! {
    /// An ellipse as written.
    struct EllipseDocument: ELLIPSE = "an ellipse",
        "ellipse: {centre: [0, 0], axes: [2, 1], rotate: 30}";
    centre: Option<WrittenPoint> = Form::Point, "Its centre; [0, 0] if left out.";
    needed axes: [WrittenNumber; 2] = Form::Either(&[Form::Number, Form::Point]),
        "Its half axes: from the centre to the right, and upwards."
        => "an ellipse needs its half axes";
    rotate: Option<WrittenNumber> = Form::Number,
        "By how much it is turned, in degrees, counter-clockwise.";
}

/// Reads the key `initial` of a file.
pub(super) fn read_initial(reader: &mut Reader, fields: &Fields<'_>) -> Option<ShapeDocument> {
    let fields = reader.fields(fields.take("initial")?, &SET)?;
    Some(read_set(reader, &fields))
}

/// Reads a set from the one key that defines its geometry.
pub(super) fn read_set(reader: &mut Reader, fields: &Fields<'_>) -> ShapeDocument {
    let place = fields.place.clone();
    let mut there = FORMS
        .iter()
        .filter_map(|form| Some((form.name, fields.take(form.name)?)));
    let hint = hint(reader);
    let Some((name, node)) = there.next() else {
        let message = "this set has no shape";
        reader.error_with_hint(&place.first_line(), message, hint);
        return ShapeDocument { form: None, place };
    };
    for (other, _) in there {
        let message = format!("this set is a {name} already");
        reader.error_with_hint(fields.place_of(other), message, "write two sets");
    }
    for key in OF_FRACTAL.iter().map(|key| key.name) {
        if name != "fractal" && fields.take(key).is_some() {
            let message = format!("`{key}` goes with `fractal`, and this set is a {name}");
            reader.error_with_hint(fields.place_of(key), message, hint);
        }
    }
    if let Some((message, hint)) = misplaced(name, reader.is_in_space) {
        reader.error_with_hint(fields.place_of(name), message, hint);
        return ShapeDocument { form: None, place };
    }
    let form = match name {
        "point" => Some(FormDocument::Point(reader.point(node))),
        "disk" => DiskDocument::from_node(reader, node).map(|disk| {
            FormDocument::Ellipse(Box::new(EllipseDocument {
                centre: disk.centre,
                axes: [disk.radius.clone(), disk.radius],
                rotate: None,
                place: disk.place,
            }))
        }),
        "ellipse" => EllipseDocument::from_node(reader, node)
            .map(|ellipse| FormDocument::Ellipse(Box::new(ellipse))),
        "fractal" => read_fractal(reader, fields, node),
        "segment" | "polyline" | "polygon" => read_outline(reader, name, node),
        "hull" => {
            let points = read_points(reader, name, node);
            points.map(|points| FormDocument::Solid(Box::new(SolidDocument::Hull(points))))
        }
        _ => read_solid_set(reader, name, node).map(|solid| FormDocument::Solid(Box::new(solid))),
    };
    ShapeDocument { form, place }
}

/// Returns a help text with the notation of sets.
fn hint(reader: &Reader) -> &'static str {
    match reader.is_in_space {
        true => HINT_IN_SPACE,
        false => HINT,
    }
}

/// Returns a message and a help text for a set of the plane in a file of space, and for one of space in a file of
/// the plane.
fn misplaced(name: &str, is_in_space: bool) -> Option<(String, &'static str)> {
    match (name, is_in_space) {
        (_, true) | ("point" | "segment" | "polyline" | "polygon", false) => None,
        ("disk" | "ellipse" | "fractal", false) => None,
        (_, false) => {
            let article = if name.starts_with('e') { "an" } else { "a" };
            Some((
                format!("{article} {name} lies in space"),
                "write `space: 3` at the top",
            ))
        }
    }
}

fn read_outline(reader: &mut Reader, name: &str, node: &Node) -> Option<FormDocument> {
    Some(FormDocument::Outline {
        points: read_points(reader, name, node)?,
        closed: name == "polygon",
    })
}

/// Reads the points of a set. Reports a number of points that the set does not have.
fn read_points(reader: &mut Reader, name: &str, node: &Node) -> Option<Vec<WrittenPoint>> {
    let (numbers, needs) = match name {
        "segment" => (2..=2, "two points"),
        "polyline" => (2..=usize::MAX, "two points or more"),
        "hull" => (3..=MAX_HULL_POINTS as usize, "from 3 to 100 points"),
        _ => (3..=usize::MAX, "three points or more"),
    };
    let hint = hint(reader);
    let points = reader.list(node, "a list of points", hint);
    if !numbers.contains(&points.len()) {
        if matches!(node.value, Value::Sequence(_)) {
            let message = format!("a {name} has {needs}, not {}", points.len());
            reader.error_with_hint(&node.place, message, hint);
        }
        return None;
    }
    Some(points.iter().map(|point| reader.point(point)).collect())
}

/// Reads a fractal whose file has been inlined in place of its name.
fn read_fractal(reader: &mut Reader, fields: &Fields<'_>, node: &Node) -> Option<FormDocument> {
    let steps = fields.optional(reader, "steps");
    let seed = fields.optional(reader, "seed");
    let set = fields.take("set");
    let set = set.map_or_else(Vec::new, |node| read_values(reader, node));
    let map = fields.take("map").and_then(|node| {
        let fields = reader.fields(node, &PLACE)?;
        Some(read_placing(reader, &fields))
    });
    let FractalFile { file, is_sound } = FractalFile::from_node(reader, node)?;
    Some(FormDocument::Fractal(Box::new(FractalDocument {
        file,
        is_sound,
        steps,
        seed,
        set,
        map,
        place: fields.place_of("fractal").clone(),
    })))
}

/// Content of a fractal's file.
pub(super) struct FractalFile {
    file: KindDocument,
    is_sound: bool,
}

impl FromNode for FractalFile {
    /// Reads a file that has been inlined in place of its name.
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        match node.value {
            Value::Mapping(_) => {}
            // Mistakes in the file have been reported.
            Value::Text(_) => return None,
            _ => {
                reader.mismatch(node, "the name of a fractal", "{fractal: koch, steps: 3}");
                return None;
            }
        }
        let kind = match node.get("kind").map(|kind| &kind.value) {
            Some(Value::Text(name)) => Kind::named(name)?,
            _ => Kind::Rule,
        };
        let mut inside = reader.inside();
        let file = KindDocument::read(&mut inside, kind, node, true);
        let is_sound = inside.is_sound(node);
        reader.take(inside);
        Some(Self {
            file: file?,
            is_sound,
        })
    }
}

impl FractalDocument {
    /// Reads the approximant of another fractal in which an initiator begins.
    pub(super) fn initiator(reader: &mut Reader, fields: &Fields<'_>, node: &Node) -> Option<Self> {
        let steps = fields.optional(reader, "steps");
        let seed = fields.optional(reader, "seed");
        let FractalFile { file, is_sound } = FractalFile::from_node(reader, node)?;
        Some(Self {
            file,
            is_sound,
            steps,
            seed,
            set: Vec::new(),
            map: None,
            place: fields.place_of("from").clone(),
        })
    }
}

/// Reads values of parameters by name.
fn read_values(reader: &mut Reader, node: &Node) -> Vec<(Written<String>, WrittenNumber)> {
    let hint = "{fractal: pythagoras, set: {angle: 30}}";
    let what = "a mapping of parameters to their values";
    let values = reader.entries(node, what, hint).unwrap_or_default();
    let values = values.iter();
    values
        .flat_map(|(key, node)| read_value(reader, written(key), node))
        .collect()
}

/// Reads the value of a parameter, or the values of the two parts of a complex parameter.
fn read_value(
    reader: &mut Reader,
    name: Written<String>,
    node: &Node,
) -> Vec<(Written<String>, WrittenNumber)> {
    if !is_complex(node, &|_| false) {
        return vec![(name, reader.number(node))];
    }
    let WrittenPoint { x, y, .. } = reader.point(node);
    let part = |(part, number): (&str, WrittenNumber)| {
        let value = format!("{}{part}", name.value);
        let place = name.place.clone();
        (Written { value, place }, number)
    };
    PARTS.into_iter().zip([x, y]).map(part).collect()
}
