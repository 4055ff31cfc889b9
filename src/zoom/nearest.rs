//! Distance of a point from a limit set.

use std::collections::BinaryHeap;

use crate::geometry::{DAffine2, DVec2, distance_to_segment, stretch};
use crate::graph::Graph;
use crate::priority::Keyed;
use crate::rule::BaseElement;

/// Limit of the number of images that are expanded.
const MOST: usize = 100_000;

/// Relative error of the distance.
const ENOUGH: f64 = 1e-3;

/// Returns the distance of a point from a limit set, to a thousandth; kept elements count with their
/// outlines. `None` if the graph does not determine it, or if it takes too many images.
///
/// Images are expanded in the order of the distances of the discs that contain them, until no disc is
/// nearer than a point that is known.
pub(crate) fn distance(graph: &Graph, point: DVec2) -> Option<f64> {
    if !graph.is_plain() || graph.depth().is_some() {
        return None;
    }
    let alive = graph.alive(true);
    let reaches = graph.reaches(|object| match object.is_kept() {
        true => graph.outline_radius(object),
        false => 0.0,
    });
    let mut nearest = f64::INFINITY;
    let mut open = BinaryHeap::new();
    let meet = |object: usize, map: DAffine2, nearest: &mut f64| {
        let found = &graph.objects()[object];
        if !alive[object] {
            return None;
        }
        if found.is_kept() {
            let outline = &graph.base_elements()[found.base_element];
            *nearest = nearest.min(distance_to_outline(point, outline, &map));
            return None;
        }
        let away = map.transform_point2(graph.middle()).distance(point);
        let reach = stretch(&map.matrix2) * reaches[object];
        *nearest = nearest.min(away + reach);
        let item = Image { object, map };
        // The nearest image is the greatest.
        let key = -(away - reach).max(0.0);
        Some(Keyed { key, item })
    };
    let initiator = graph.initiator(0).instances.iter();
    open.extend(initiator.filter_map(|it| meet(it.object, *it.frame.map(), &mut nearest)));
    for _ in 0..MOST {
        let Some(Keyed { key, item: image }) = open.pop() else {
            return nearest.is_finite().then_some(nearest);
        };
        if nearest + key <= ENOUGH * nearest {
            return Some(nearest);
        }
        let children = graph.children(image.object);
        let children = children.map(|(_, it)| (it.object, image.map * it.frame.map()));
        open.extend(children.filter_map(|(object, map)| meet(object, map, &mut nearest)));
    }
    None
}

/// Image of an object's limit set.
struct Image {
    object: usize,
    map: DAffine2,
}

/// Returns the distance of a point from the image of an outline; curves are approximated by 32 chords
/// each.
fn distance_to_outline(point: DVec2, outline: &BaseElement, map: &DAffine2) -> f64 {
    const CHORDS: u32 = 32;
    let corners = outline.corners(map, CHORDS);
    let lines = corners.windows(2);
    lines
        .map(|ends| distance_to_segment(point, ends[0], ends[1]))
        .fold(f64::INFINITY, f64::min)
}
