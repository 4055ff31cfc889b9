//! Systems whose maps are drawn at random: they are resolved as structures of one object, which is replaced by its images.

use crate::diagnostic::Place;
use crate::document::{
    AlternativeDocument, IfsDocument, InstanceDocument, InstancingDocument, LinearDocument,
    MapDocument, MapsDocument, MasterDocument, ObjectDocument, ShapeDocument, TransformDocument,
    UnionDocument, VerticesDocument, Written,
};

/// Name of the object.
const SET: &str = "set";

/// Returns the structure of a system whose maps are drawn for every image of the set.
pub(in crate::resolve) fn structure(document: &IfsDocument) -> InstancingDocument {
    let place = document.metadata.place.first_line();
    let own = document.condensation.iter();
    let own: Vec<_> = own.map(|it| shape(&it.shape)).collect();
    let all = |maps: &[MapDocument]| {
        let images = maps.iter().map(|map| image(map, &place));
        images.chain(own.iter().cloned()).collect()
    };
    let (instances, alternatives) = match &document.maps {
        None => (Vec::new(), Vec::new()),
        Some(MapsDocument::AtRandom(alternatives)) => {
            let alternatives = alternatives.iter().map(|it| AlternativeDocument {
                instances: all(&it.maps),
                transforms: Vec::new(),
                weight: it.weight.clone(),
            });
            (Vec::new(), alternatives.collect())
        }
        Some(maps) => (all(&images(maps, document.is_in_space)), Vec::new()),
    };
    let union = |instances, alternatives| UnionDocument {
        instances,
        alternatives,
        transforms: Vec::new(),
        place: place.clone(),
    };
    InstancingDocument {
        metadata: document.metadata.clone(),
        is_in_space: document.is_in_space,
        random: document.random.clone(),
        objects: vec![ObjectDocument {
            name: name(&place),
            level: None,
            union: union(instances, alternatives),
        }],
        scene: Some(union(vec![of_set(&place)], Vec::new())),
        initial: document.initial.clone(),
    }
}

/// Returns the maps of a list or towards vertices.
fn images(maps: &MapsDocument, is_in_space: bool) -> Vec<MapDocument> {
    match maps {
        MapsDocument::Listed(maps) => maps.clone(),
        MapsDocument::Vertices {
            points: VerticesDocument::Listed(points),
            shrink,
        } => {
            let linear = match is_in_space {
                true => LinearDocument::AxesInSpace {
                    scale: std::array::from_fn(|_| shrink.clone()),
                    turns: Vec::new(),
                },
                false => LinearDocument::Axes {
                    scale: std::array::from_fn(|_| shrink.clone()),
                    rotate: None,
                },
            };
            let toward = points.iter().map(|point| MapDocument {
                name: None,
                linear: Some(linear.clone()),
                shift: None,
                fixed: Some(point.clone()),
                weight: None,
                tint: None,
                place: point.place.clone(),
            });
            toward.collect()
        }
        // They were reported when the file was read.
        MapsDocument::Vertices { .. }
        | MapsDocument::Interpolated(_)
        | MapsDocument::AtRandom(_) => Vec::new(),
    }
}

fn name(place: &Place) -> Written<String> {
    Written {
        value: SET.into(),
        place: place.clone(),
    }
}

/// Returns the set itself.
fn of_set(place: &Place) -> InstanceDocument {
    InstanceDocument {
        master: Some(MasterDocument::Object {
            name: name(place),
            level: None,
        }),
        transforms: Vec::new(),
        tint: None,
        place: place.clone(),
    }
}

/// Returns the image of the set under a map.
fn image(map: &MapDocument, place: &Place) -> InstanceDocument {
    let linear = map.linear.iter().flat_map(transforms);
    let (before, after) = match (&map.fixed, &map.shift) {
        (Some(fixed), _) => (
            Some(TransformDocument::TranslateBack(fixed.clone())),
            Some(TransformDocument::Translate(fixed.clone())),
        ),
        (None, shift) => (None, shift.clone().map(TransformDocument::Translate)),
    };
    InstanceDocument {
        tint: map.tint.clone(),
        place: map.place.clone(),
        transforms: before.into_iter().chain(linear).chain(after).collect(),
        ..of_set(place)
    }
}

/// Returns the transforms of which a linear map consists.
fn transforms(linear: &LinearDocument) -> Vec<TransformDocument> {
    let whole = || vec![TransformDocument::Linear(Box::new(linear.clone()))];
    match linear {
        LinearDocument::Axes {
            rotate: Some([first, second]),
            ..
        } if first.place.text() != second.place.text() => whole(),
        LinearDocument::Axes { scale, rotate } => {
            let turn = rotate
                .clone()
                .map(|[turn, _]| TransformDocument::Rotate(turn));
            let scale = TransformDocument::Scale(scale.clone());
            std::iter::once(scale).chain(turn).collect()
        }
        LinearDocument::Complex { .. } => whole(),
        LinearDocument::Matrix(rows) => vec![TransformDocument::Matrix(rows.clone())],
        LinearDocument::AxesInSpace { scale, turns } => vec![
            TransformDocument::ScaleInSpace(scale.clone()),
            TransformDocument::Turns(turns.clone()),
        ],
        LinearDocument::MatrixInSpace(rows) => vec![TransformDocument::MatrixInSpace(rows.clone())],
    }
}

/// Returns a condensation set.
fn shape(shape: &ShapeDocument) -> InstanceDocument {
    InstanceDocument {
        master: Some(MasterDocument::Shape(Box::new(shape.clone()))),
        transforms: Vec::new(),
        tint: None,
        place: shape.place.clone(),
    }
}
