//! Boxes of the attractors of a few maps, in microseconds.

use std::collections::BinaryHeap;

use crate::geometry::{Bounds, DAffine2, DVec2};
use crate::priority::Keyed;

/// Largest number of maps in a row that are examined for a side of the box.
const MAX_WORK: usize = 1 << 11;

/// Largest distance by which a side lies outside, as a fraction of the radius of the disc around the attractor.
const TOLERANCE: f64 = 1e-5;

/// Returns the bounding box of the attractor of affine maps, each of which contracts in the Euclidean norm; `None` if one
/// does not, or contracts so little that the search takes too long.
///
/// Each side is found by branch and bound: the maximum of a linear functional over the attractor is that over its images, each of
/// which lies in the image of a disc that all maps take into itself. All points of the attractor lie in the box, whose sides are
/// exact to 10⁻⁵ of the radius of that disc.
pub(super) fn attractor_box(maps: &[DAffine2]) -> Option<Bounds> {
    let factors: Vec<f64> = maps.iter().map(largest_factor).collect();
    if !factors.iter().all(|factor| *factor < 1.0) {
        return None;
    }
    let fixed =
        |map: &DAffine2| (DAffine2::IDENTITY.matrix2 - map.matrix2).inverse() * map.translation;
    let points: Vec<DVec2> = maps.iter().map(fixed).collect();
    #[expect(clippy::cast_precision_loss, reason = "there are few maps")]
    let centre = points.iter().sum::<DVec2>() / points.len() as f64;
    let reaches = maps.iter().zip(&factors);
    let reaches =
        reaches.map(|(map, factor)| map.transform_point2(centre).distance(centre) / (1.0 - factor));
    let radius = reaches.fold(0.0, f64::max);
    if !radius.is_finite() {
        return None;
    }
    let farthest = |direction: DVec2| farthest(maps, &points, centre, radius, direction);
    let max = DVec2::new(farthest(DVec2::X)?, farthest(DVec2::Y)?);
    let min = -DVec2::new(farthest(DVec2::NEG_X)?, farthest(DVec2::NEG_Y)?);
    Some(Bounds::new(min, max))
}

/// Returns the largest factor by which a map lengthens a vector.
fn largest_factor(map: &DAffine2) -> f64 {
    let [a, b, c, d] = map.matrix2.to_cols_array();
    let sum = a * a + b * b + c * c + d * d;
    let det = (a * d - b * c).abs();
    ((sum + 2.0 * det).sqrt() + (sum - 2.0 * det).max(0.0).sqrt()) / 2.0
}

/// Returns the maximum of a functional over the attractor. `points` are some of its points.
fn farthest(
    maps: &[DAffine2],
    points: &[DVec2],
    centre: DVec2,
    radius: f64,
    direction: DVec2,
) -> Option<f64> {
    let node = |vector: DVec2, offset: f64| Keyed {
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
            let inner = map.matrix2.transpose() * vector;
            heap.push(node(inner, offset + vector.dot(map.translation)));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Fractal;
    use crate::dataset::random::anderson;
    use crate::random::Pcg;

    #[test]
    fn boxes_are_those_of_the_graph() {
        let mut random = Pcg::new(5, 6);
        let mut found = 0;
        for round in 0..60 {
            let maps = anderson(&mut random, 2 + round % 6);
            let Some(own) = attractor_box(&maps) else {
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
        assert_eq!(attractor_box(&[shear]), None);
    }
}
