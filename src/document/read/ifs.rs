//! Reading of iterated function systems.

use crate::catalogue::Shelf;
use crate::document::MetadataDocument;
use crate::document::Written;
use crate::document::WrittenPoint;
use crate::document::ifs::{
    AlternativeMapsDocument, CondensationDocument, EdgeDocument, IfsDocument,
    InterpolationDocument, LinearDocument, MapDocument, MapsDocument, Scales, VerticesDocument,
};
use crate::document::node::{Node, Value};
use crate::document::reader::{Fields, Reader};
use crate::document::shape::{Form, KeySet, Member, Shape, alternative, keys};
use crate::kind::Kind;

use super::generator::read_random;
use super::metadata::{DESCRIPTION, LIKING};
use super::parameters::{PARAMS, written};
use super::set::{CONDENSATION, SET, read_initial, read_set};
use super::space::{self, SPACE, TURN};
use super::tint::TINT_OF;
use super::vertices::{VERTICES, read_vertices};
use super::{KindTable, OfKind};

/// Keys of an iterated function system.
const IFS: Shape = Shape {
    what: "an iterated function system",
    keys: &[&DESCRIPTION, &IFS_ALONE, &LIKING],
    alternatives: &[
        alternative(&["maps"], &["vertices", "interpolate", "at_random"]),
        alternative(&["vertices"], &["maps", "interpolate", "at_random"]),
        alternative(
            &["interpolate"],
            &["maps", "vertices", "at_random", "random"],
        ),
        alternative(
            &["at_random"],
            &["maps", "vertices", "interpolate", "edges"],
        ),
    ],
    hint: "a system is a mapping of keys: `kfrac cat gasket` shows a short one",
};

/// Keys that only an iterated function system has.
const IFS_ALONE: [Member; 12] = keys![
    needed kind: Form::Words(&[Kind::Ifs.name()]), "The kind of file.";
    =SPACE;
    extends: Form::File(Shelf::IFS),
        "Another system to start from, by name or by file. The keys written here replace its keys; \
         `params`, `style` and `view` merge entry by entry.";
    =PARAMS;
    random: Form::Names(&Form::Expression, 0),
        "Random variables, drawn for every image of the set, for its maps: uniform(a, b), \
         normal(mean, deviation) or choice(a, b, ...).";
    maps: Form::Either(&[Form::List(&Form::Mapping(&MAP), 1, None), Form::Names(&Form::Mapping(&MAP), 1)]),
        "The maps: a list of them, or a mapping of names to maps.";
    at_random: Form::List(&Form::Either(&[SOME_MAPS, Form::Mapping(&ALTERNATIVE)]), 1, None),
        "In place of `maps`: lists of maps of which one is drawn for every image of the set, by its `weight`; `[]` for nothing.";
    vertices: Form::Mapping(&VERTICES), "In place of `maps`: one map towards each of some points.";
    interpolate: Form::Mapping(&INTERPOLATION),
        "In place of `maps`: those of a curve through points that looks the same in every part.";
    condensation: Form::List(&Form::Mapping(&CONDENSATION), 1, None),
        "Sets that are drawn at every level: a stem, a trunk.";
    initial: Form::Mapping(&SET),
        "What approximant 0 draws: the condensation sets if left out, or else the box of the limit \
         set.";
    edges: Form::Names(&Form::Either(&[Form::List(&Form::Text, 1, None), Form::Names(&Form::Positive, 1)]), 1),
        "Which map may be applied after which: for every map a list of the maps that may follow it, by \
         number from 1 or by name, or a mapping of these to weights. Any may follow any if left out.";
];

const SOME_MAPS: Form = Form::List(&Form::Mapping(&MAP), 0, None);

const ALTERNATIVE: Shape = Shape {
    what: "an alternative",
    keys: &[&keys![
        needed maps: SOME_MAPS, "The maps; `[]` for nothing." => "an alternative needs `maps`";
        weight: Form::Positive, "How often it is drawn, relative to the others; 1 if left out.";
    ]],
    alternatives: &[],
    hint: "at_random: [{maps: [{scale: 1/2}, {scale: 1/2, translate: [1/2, 0]}], weight: 3}, []]",
};

const MAP: Shape = Shape {
    what: "a map",
    keys: &[
        &PLACING,
        &keys![
            weight: Form::Positive,
                "How often random iteration picks the map, relative to the others: above 0, for all \
                 maps or for none.";
            tint: TINT_OF, "What it colours the images of the map with, again at every step.";
        ],
    ],
    alternatives: &PLACEMENTS,
    hint: MAP_HINT,
};

/// A map without a weight and without a tint.
pub(super) const PLACE: Shape = Shape {
    what: "a map of a set",
    keys: &[&PLACING],
    alternatives: &PLACEMENTS,
    hint: MAP_HINT,
};

const MAP_HINT: &str =
    "{scale: 1/2, rotate: 45, translate: [1, 0]} or {matrix: [[a, b], [c, d]], translate: [e, f]}";

/// A point of the plane as a complex number, or a point of space.
const NUMBER: Form = Form::Either(&[Form::Number, Form::Place]);

/// Keys that define a map.
const PLACING: [Member; 8] = keys![
    matrix: Form::List(&Form::Place, 2, Some(3)),
        "The rows of the matrix: [[a, b], [c, d]] maps [x, y] to [a x + b y, c x + d y]; in space there \
         are three rows of three numbers.";
    scale: Form::Either(&[Form::Number, Form::Place]), "A factor, or one along each axis.";
    rotate: Form::Either(&[
        Form::Number,
        Form::Point,
        Form::Mapping(&TURN),
        Form::List(&Form::Mapping(&TURN), 1, None),
    ]),
        "An angle in degrees, counter-clockwise, or one of the x axis and one of the y axis; in space a \
         turn about an axis, {y: 30} or {axis: [1, 1, 0], angle: 30}, or a list of turns in order.";
    times: NUMBER,
        "A complex factor s, as [real part, imaginary part], a number, a complex parameter or a formula, 1/(2 - i): z goes to s z.";
    conjugate: Form::Flag(false), "With `times`: z goes to s conj z.";
    translate: NUMBER, "What is added last: [x, y], x for [x, 0], a complex parameter or a formula.";
    shift: NUMBER, "Another name of `translate`.";
    fixed: NUMBER, "In place of `translate`: the point that stays where it is.";
];

const PLACEMENTS: [KeySet; 3] = [
    alternative(&["matrix"], &["scale", "rotate", "times", "conjugate"]),
    alternative(&["scale"], &["matrix", "times", "conjugate"]),
    alternative(&["times"], &["matrix", "scale", "rotate"]),
];

const INTERPOLATION: Shape = Shape {
    what: "an interpolation",
    keys: &[&keys![
        needed points: // A name of a file; `Text` would admit only text that is not a number.
            Form::Either(&[Form::List(&Form::Point, 3, None), Form::Expression]),
            "The points that the curve runs through, from left to right; or the name of a file beside \
             this one with a column of x and one of y."
            => "there are no `points`";
        scale: Form::Either(&[Form::Number, Form::List(&Form::Number, 1, None)]),
            "By how much heights shrink from the whole to its pieces, between -1 and 1: one factor, or \
             one for each piece.";
        dimension: Form::Number,
            "In place of `scale`: the dimension of the curve, from 1 to less than 2.";
    ]],
    alternatives: &[
        alternative(&["scale"], &["dimension"]),
        alternative(&["dimension"], &["scale"]),
    ],
    hint: "interpolate: {points: [[0, 0], [1, 1], [2, 0]], scale: 0.3}",
};

impl OfKind for IfsDocument {
    const TABLE: &'static KindTable = &KindTable {
        shape: &IFS,
        about: "An iterated function system: maps that shrink the plane, and what they are applied to.",
        stand_in: "{maps: [{scale: 0.5}]}",
    };

    fn read(reader: &mut Reader, fields: &Fields<'_>, metadata: MetadataDocument) -> Self {
        let is_in_space = space::read_space(reader, fields);
        reader.is_in_space = is_in_space;
        if is_in_space && fields.take("interpolate").is_some() {
            let message = "`interpolate` is known in the plane only";
            let hint = "in space, a system has `maps` or `vertices`";
            reader.error_with_hint(fields.place_of("interpolate"), message, hint);
        }
        let condensation = fields.take("condensation").map_or(&[][..], |node| {
            let what = "a list of condensation sets";
            reader.filled(node, what, "condensation set", CONDENSATION.hint)
        });
        let condensation = condensation.iter().filter_map(|node| {
            let fields = reader.fields(node, &CONDENSATION)?;
            Some(CondensationDocument {
                weight: fields.optional(reader, "weight"),
                shape: read_set(reader, &fields),
            })
        });
        let edges = fields.take("edges");
        let document = Self {
            metadata,
            is_in_space,
            condensation: condensation.collect(),
            random: read_random(reader, fields.take("random")),
            maps: read_maps(reader, fields),
            initial: read_initial(reader, fields),
            edges: edges
                .and_then(|node| Some((read_edges(reader, node)?, node.place.first_line()))),
        };
        (reader.is_in_space, reader.may_lie_in_space) = (false, false);
        if document.is_random() {
            document.refuse_fixed(reader);
        }
        document
    }
}

impl IfsDocument {
    /// Reports parts that systems with drawn maps do not have.
    fn refuse_fixed(&self, reader: &mut Reader) {
        let maps = match &self.maps {
            Some(MapsDocument::Listed(maps)) => vec![maps],
            Some(MapsDocument::AtRandom(alternatives)) => {
                { alternatives.iter() }.map(|it| &it.maps).collect()
            }
            _ => Vec::new(),
        };
        let maps = maps.into_iter().flatten();
        let sets = self.condensation.iter();
        let weights = maps.map(|map| &map.weight).chain(sets.map(|it| &it.weight));
        for weight in weights.flatten() {
            let message = "random iteration does not draw a system whose maps are drawn";
            let hint = "leave the weight out; alternatives under `at_random` have weights";
            reader.error_with_hint(&weight.place, message, hint);
        }
        if let Some((_, place)) = &self.edges {
            let message = "a system whose maps are drawn has no `edges`";
            let hint = "a structure, `kind: instancing`, has several objects with drawn instances";
            reader.error_with_hint(place, message, hint);
        }
        let place = match &self.maps {
            Some(MapsDocument::Vertices {
                points: VerticesDocument::Scattered(scatter),
                ..
            }) => &scatter.ellipsoid.place,
            Some(MapsDocument::Vertices {
                points: VerticesDocument::Listed(points),
                shrink,
            }) if points.is_empty() => &shrink.place,
            Some(MapsDocument::Interpolated(interpolation)) => &interpolation.place,
            _ => return,
        };
        let hint = "write `maps`, or a list of `points`";
        reader.error_with_hint(place, "there are no maps that can be drawn", hint);
    }
}

/// Reads the maps, which one of several keys gives.
fn read_maps(reader: &mut Reader, fields: &Fields<'_>) -> Option<MapsDocument> {
    let alternatives = ["maps", "vertices", "interpolate", "at_random"];
    let mut there = alternatives.iter().filter(|key| fields.take(key).is_some());
    let Some(key) = there.next() else {
        let message = "the system has no maps";
        let hint = "write `maps`, `vertices`, `interpolate` or `at_random`";
        reader.error_with_hint(&fields.place.first_line(), message, hint);
        return None;
    };
    for other in there {
        let message = format!("`{other}` stands in place of `{key}`");
        let hint = "write one of them";
        reader.error_with_hint(fields.place_of(other), message, hint);
    }
    let node = fields.take(key)?;
    match *key {
        "maps" => read_listed(reader, node),
        "at_random" => Some(read_alternatives(reader, node)),
        "vertices" => read_vertices(reader, node),
        _ => read_interpolation(reader, node).map(MapsDocument::Interpolated),
    }
}

/// Reads alternatives: mappings with maps, or lists of maps.
fn read_alternatives(reader: &mut Reader, node: &Node) -> MapsDocument {
    let what = "a list of alternatives";
    let list = reader.filled(node, what, "alternative", ALTERNATIVE.hint);
    let read = |reader: &mut Reader, node: &Node| {
        let (maps, weight) = match &node.value {
            Value::Sequence(maps) => (maps.as_slice(), None),
            _ => {
                let fields = reader.fields(node, &ALTERNATIVE)?;
                let maps = fields.take("maps")?;
                let weight = fields.optional(reader, "weight");
                (reader.list(maps, "a list of maps", MAP.hint), weight)
            }
        };
        let maps = { maps.iter() }.map(|map| read_map(reader, None, map));
        Some(AlternativeMapsDocument {
            maps: maps.collect(),
            weight,
        })
    };
    MapsDocument::AtRandom(list.iter().filter_map(|node| read(reader, node)).collect())
}

fn read_listed(reader: &mut Reader, node: &Node) -> Option<MapsDocument> {
    let maps: Vec<MapDocument> = match &node.value {
        Value::Sequence(maps) => maps
            .iter()
            .map(|node| read_map(reader, None, node))
            .collect(),
        Value::Mapping(maps) => {
            let named = maps.iter();
            named
                .map(|(key, node)| read_map(reader, Some(written(key)), node))
                .collect()
        }
        _ => {
            let what = "a list of maps, or a mapping of names to maps";
            reader.mismatch(node, what, MAP.hint);
            return None;
        }
    };
    if maps.is_empty() {
        reader.error_with_hint(&node.place, "the system has no maps", MAP.hint);
        return None;
    }
    Some(MapsDocument::Listed(maps))
}

fn read_map(reader: &mut Reader, name: Option<Written<String>>, node: &Node) -> MapDocument {
    let Some(fields) = reader.fields(node, &MAP) else {
        return MapDocument {
            name,
            linear: None,
            shift: None,
            fixed: None,
            weight: None,
            tint: None,
            place: node.place.clone(),
        };
    };
    MapDocument {
        name,
        weight: fields.optional(reader, "weight"),
        tint: fields.optional(reader, "tint"),
        ..read_placing(reader, &fields)
    }
}

/// Reads a map without its name, weight and tint.
pub(super) fn read_placing(reader: &mut Reader, fields: &Fields<'_>) -> MapDocument {
    let linear = match reader.is_in_space {
        true => space::read_linear(reader, fields),
        false => read_linear(reader, fields),
    };
    if fields.take("shift").is_some() && fields.take("translate").is_some() {
        let message = "`shift` is another name of `translate`";
        let hint = "write one of them";
        reader.error_with_hint(fields.place_of("shift"), message, hint);
    }
    let shift = fields.take("translate").or(fields.take("shift"));
    let map = MapDocument {
        name: None,
        linear,
        shift: shift.map(|node| reader.complex_number(node)),
        fixed: fields.take("fixed").map(|node| reader.complex_number(node)),
        weight: None,
        tint: None,
        place: fields.place.clone(),
    };
    if map.shift.is_some() && map.fixed.is_some() {
        let message = "`fixed` stands in place of `translate`";
        let hint = "write one of them";
        reader.error_with_hint(fields.place_of("fixed"), message, hint);
    }
    map
}

fn read_linear(reader: &mut Reader, fields: &Fields<'_>) -> Option<LinearDocument> {
    let matrix = fields.take("matrix");
    let scale = fields.optional(reader, "scale");
    if let Some(node) = fields.take("rotate").filter(|node| space::is_turn(node)) {
        let message = "a turn about an axis lies in space";
        let hint = "write an angle in the plane, or `space: 3` at the top";
        reader.error_with_hint(&node.place, message, hint);
        return None;
    }
    let rotate = fields.optional(reader, "rotate");
    let times = fields.take("times").map(|node| reader.complex_number(node));
    let conjugate = fields.read(reader, "conjugate")?;
    let alternatives = [matrix.is_some(), scale.is_some(), times.is_some()];
    let keys = alternatives.iter().position(|there| *there);
    let Some(keys) = keys.and_then(|keys| PLACEMENTS.get(keys)) else {
        let message = match rotate {
            Some(_) => "this map turns, but has no scale",
            None if fields.in_order().next().is_some() => "this map has no scale and no matrix",
            None => "this map is empty",
        };
        reader.error_with_hint(&fields.place.first_line(), message, MAP_HINT);
        return None;
    };
    for other in keys.excludes {
        if fields.take(other).is_some() {
            let message = format!("`{other}` does not go with `{}`", keys.needs[0]);
            reader.error_with_hint(fields.place_of(other), message, MAP_HINT);
        }
    }
    match (matrix, scale, times) {
        (Some(node), ..) => read_matrix(reader, node).map(LinearDocument::Matrix),
        (_, Some(scale), _) => Some(LinearDocument::Axes { scale, rotate }),
        (.., Some(times)) => Some(LinearDocument::Complex { times, conjugate }),
        _ => None,
    }
}

/// Reads the rows of a matrix.
pub(super) fn read_matrix(reader: &mut Reader, node: &Node) -> Option<[WrittenPoint; 2]> {
    let hint = "matrix: [[a, b], [c, d]]";
    let rows = reader.list(node, "a list of two rows", hint);
    if let [first, second] = rows {
        return Some([reader.point(first), reader.point(second)]);
    }
    if matches!(node.value, Value::Sequence(_)) {
        let message = format!("a matrix has two rows, this one has {}", rows.len());
        let hint = match rows.len() {
            3 => {
                "the file lies in the plane: with `space: 3`, a matrix has three rows of three numbers"
            }
            _ => hint,
        };
        reader.error_with_hint(&node.place, message, hint);
    }
    None
}

fn read_interpolation(reader: &mut Reader, node: &Node) -> Option<InterpolationDocument> {
    let fields = reader.fields(node, &INTERPOLATION)?;
    let points = read_points(reader, &fields, INTERPOLATION.hint);
    let scale = fields.take("scale").map(|node| match &node.value {
        Value::Sequence(scales) => {
            Scales::Each(scales.iter().map(|node| reader.number(node)).collect())
        }
        _ => Scales::One(reader.number(node)),
    });
    let dimension = fields.optional(reader, "dimension");
    let scale = match (scale, dimension.map(Scales::Dimension)) {
        (Some(scale), None) | (None, Some(scale)) => scale,
        _ => {
            let message = "an interpolation needs `scale` or `dimension`, and not both";
            reader.error_with_hint(&node.place.first_line(), message, INTERPOLATION.hint);
            return None;
        }
    };
    Some(InterpolationDocument {
        points: points?,
        scale,
        place: node.place.clone(),
    })
}

/// Reads the required key `points`.
pub(super) fn read_points(
    reader: &mut Reader,
    fields: &Fields<'_>,
    hint: &'static str,
) -> Option<Vec<WrittenPoint>> {
    let node = fields.take("points")?;
    let list = reader.list(node, "a list of points", hint);
    if !matches!(node.value, Value::Sequence(_)) {
        return None;
    }
    Some(list.iter().map(|node| reader.point(node)).collect())
}

/// Reads the edges. Returns `None` if any of them cannot be read: edges that are missing cannot be
/// reported then.
fn read_edges(reader: &mut Reader, node: &Node) -> Option<Vec<EdgeDocument>> {
    const HINT: &str = "edges: {1: [1, 2], 2: [1]}: 2 may follow 1, and so on";
    let mut edges = Vec::new();
    let entries = reader.entries(node, "a mapping of maps to those that may follow", HINT)?;
    let mut are_read = true;
    for (key, node) in entries {
        let from = || written(key);
        match &node.value {
            Value::Sequence(followers) => {
                for follower in followers {
                    let to = reader.name(follower);
                    are_read &= to.is_some();
                    edges.extend(to.map(|to| EdgeDocument {
                        from: from(),
                        to,
                        weight: None,
                    }));
                }
            }
            Value::Mapping(followers) => {
                edges.extend(followers.iter().map(|(follower, weight)| EdgeDocument {
                    from: from(),
                    to: written(follower),
                    weight: Some(reader.number(weight)),
                }));
            }
            _ => {
                reader.mismatch(node, "a list of the maps that may follow", HINT);
                are_read = false;
            }
        }
    }
    are_read.then_some(edges)
}
