//! Distance of a point from a limit set.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use crate::geometry::{DAffine2, DVec2, distance_to_segment, stretch};
use crate::graph::{Graph, Object, Replacement};
use crate::rule::{BaseElement, Piece};

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
    let is_kept = |object: &Object| matches!(object.replacement, Replacement::Kept);
    let reaches = graph.reaches(|object| match object.replacement {
        Replacement::Kept => graph.outline_radius(object),
        _ => 0.0,
    });
    let mut nearest = f64::INFINITY;
    let mut open = BinaryHeap::new();
    let meet = |object: usize, map: DAffine2, nearest: &mut f64| {
        let found = &graph.objects()[object];
        if !alive[object] {
            return None;
        }
        if is_kept(found) {
            let outline = &graph.base_elements()[found.base_element];
            *nearest = nearest.min(distance_to_outline(point, outline, &map));
            return None;
        }
        let away = map.transform_point2(graph.middle()).distance(point);
        let reach = stretch(&map.matrix2) * reaches[object];
        *nearest = nearest.min(away + reach);
        Some(Image {
            least: (away - reach).max(0.0),
            object,
            map,
        })
    };
    let initiator = graph.initiator(0).instances.iter();
    open.extend(initiator.filter_map(|it| meet(it.object, *it.frame.map(), &mut nearest)));
    for _ in 0..MOST {
        let Some(image) = open.pop() else {
            return nearest.is_finite().then_some(nearest);
        };
        if nearest - image.least <= ENOUGH * nearest {
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
    /// Lower bound of its distance.
    least: f64,
    object: usize,
    map: DAffine2,
}

/// Orders images such that the nearest is the greatest.
impl Ord for Image {
    fn cmp(&self, other: &Self) -> Ordering {
        other.least.total_cmp(&self.least)
    }
}

impl PartialOrd for Image {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Image {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Image {}

/// Returns the distance of a point from the image of an outline; curves are approximated by 32 chords
/// each.
fn distance_to_outline(point: DVec2, outline: &BaseElement, map: &DAffine2) -> f64 {
    const CHORDS: u32 = 32;
    let mut from = map.transform_point2(outline.start());
    let mut nearest = f64::INFINITY;
    for piece in outline.pieces() {
        let ends: Vec<DVec2> = match piece.transformed(map) {
            Piece::Line(end) => vec![end],
            Piece::Cubic(a, b, end) => {
                let start = from;
                let at = |chord: u32| {
                    let t = f64::from(chord) / f64::from(CHORDS);
                    let (first, second) = (start.lerp(a, t), a.lerp(b, t));
                    let third = b.lerp(end, t);
                    first.lerp(second, t).lerp(second.lerp(third, t), t)
                };
                (1..=CHORDS).map(at).collect()
            }
        };
        for end in ends {
            nearest = nearest.min(distance_to_segment(point, from, end));
            from = end;
        }
    }
    nearest
}
