//! Boxes of the attractors of a few maps, in microseconds.

use std::collections::BinaryHeap;

use crate::geometry::{Bounds, Linear, Point};
use crate::priority::Keyed;

use super::maps::Drawable;

/// Largest number of maps in a row that are examined for a side of the box.
const MAX_WORK: usize = 1 << 11;

/// Largest distance by which a side lies outside, as a fraction of the radius of the disc around the attractor.
const TOLERANCE: f64 = 1e-5;

/// Returns the bounding box of the attractor of affine maps, each of which contracts in the Euclidean norm; `None` if one
/// does not, or contracts so little that the search takes too long. The box lies in coordinates to which `seen` rotates.
///
/// Each side is found by branch and bound: the maximum of a linear functional over the attractor is that over its images, each of
/// which lies in the image of a ball that all maps take into itself. All points of the attractor lie in the box, whose sides are
/// exact to 10⁻⁵ of the radius of that ball.
pub(super) fn attractor_box<M: Drawable>(maps: &[M], seen: &M::Linear) -> Option<Bounds<M::Point>> {
    let factors: Vec<f64> = maps.iter().map(M::largest_factor).collect();
    if !factors.iter().all(|factor| *factor < 1.0) {
        return None;
    }
    let points: Vec<M::Point> = maps.iter().map(M::fixed).collect();
    #[expect(clippy::cast_precision_loss, reason = "there are few maps")]
    let centre =
        { points.iter() }.fold(M::Point::ZERO, |sum, point| sum + *point) / points.len() as f64;
    let reaches = maps.iter().zip(&factors);
    let reaches =
        reaches.map(|(map, factor)| (map.apply(centre) - centre).length() / (1.0 - factor));
    let radius = reaches.fold(0.0, f64::max);
    if !radius.is_finite() {
        return None;
    }
    let mut corners = [M::Point::ZERO; 2];
    for (number, axis) in M::Point::AXES.iter().enumerate() {
        let farthest = farthest(maps, &points, centre, radius, seen.transposed(*axis))?;
        let corner = &mut corners[(number + 1) % 2];
        *corner = *corner + *axis * farthest;
    }
    let [min, max] = corners;
    Some(Bounds::new(min, max))
}

/// Returns the maximum of a functional over the attractor. `points` are some of its points.
fn farthest<M: Drawable>(
    maps: &[M],
    points: &[M::Point],
    centre: M::Point,
    radius: f64,
    direction: M::Point,
) -> Option<f64> {
    let node = |vector: M::Point, offset: f64| Keyed {
        key: offset + vector.dot(centre) + vector.length() * radius,
        item: (vector, offset),
    };
    let mut heap = BinaryHeap::from([node(direction, 0.0)]);
    let mut found = f64::NEG_INFINITY;
    for _ in 0..MAX_WORK {
        let Keyed {
            key,
            item: (vector, offset),
        } = heap.pop()?;
        let on_it = points.iter().map(|point| offset + vector.dot(*point));
        found = on_it.fold(found, f64::max);
        if key <= found + TOLERANCE * radius {
            return Some(key);
        }
        for map in maps {
            let inner = map.linear().transposed(vector);
            heap.push(node(inner, offset + vector.dot(map.translation())));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Fractal;
    use crate::dataset::random::anderson;
    use crate::geometry::{DAffine2, DMat2};
    use crate::random::Pcg;

    #[test]
    fn boxes_are_those_of_the_graph() {
        let mut random = Pcg::new(5, 6);
        let mut found = 0;
        for round in 0..60 {
            let maps = anderson(&mut random, 2 + round % 6);
            let Some(own) = attractor_box(&maps, &DMat2::IDENTITY) else {
                continue;
            };
            found += 1;
            let entry = |map: &DAffine2| {
                let [a, c, b, d, e, f] = map.to_cols_array();
                format!("\n  - {{matrix: [[{a}, {b}], [{c}, {d}]], shift: [{e}, {f}]}}")
            };
            let text: String = maps.iter().map(entry).collect();
            let system = Fractal::parse(&format!("kind: ifs\nmaps:{text}")).unwrap();
            let [min, max] = system.info().unwrap().limit_bounds.unwrap();
            let size = own.size().max_element();
            let apart = [own.min().x - min[0], own.min().y - min[1]];
            let sides = apart
                .into_iter()
                .chain([own.max().x - max[0], own.max().y - max[1]]);
            for side in sides {
                assert!(side.abs() < 1e-3 * size, "{own:?} {min:?} {max:?}");
            }
        }
        assert!(found >= 30, "{found}");
    }

    #[test]
    fn maps_that_do_not_contract_have_no_box() {
        let shear = DAffine2::from_cols_array(&[0.5, 0.0, 3.0, 0.5, 0.0, 0.0]);
        assert_eq!(attractor_box(&[shear], &DMat2::IDENTITY), None);
    }
}
