//! Symmetries of a shape, and maps that they make simpler.

use crate::geometry::{DAffine2, DMat2, DVec2};

use super::Candidate;
use super::collage::Ground;

/// Mean and largest distance, in cells, of a shape's image from the shape if the map is a symmetry.
const MOST: [f64; 2] = [0.6, 3.0];

/// Returns the rotations and reflections about the centroid that map a shape onto itself, as maps of the picture; the
/// identity is the first.
#[expect(clippy::cast_precision_loss, reason = "samples are small")]
pub(super) fn symmetries(ground: &Ground) -> Vec<DAffine2> {
    const ORDERS: [u32; 9] = [2, 3, 4, 5, 6, 7, 8, 10, 12];
    const AXES: u32 = 48;
    let cells = ground.cells();
    let centre = cells.iter().sum::<DVec2>() / cells.len() as f64;
    let about = |matrix: DMat2| DAffine2::from_mat2_translation(matrix, centre - matrix * centre);
    let is_symmetry = |map: &DAffine2| {
        let (mut sum, mut most) = (0.0, 0.0f64);
        for &point in ground.points() {
            let away = ground.distance(map.transform_point2(point));
            sum += away;
            most = most.max(away);
        }
        sum <= MOST[0] * ground.points().len() as f64 && most <= MOST[1]
    };
    let order = ORDERS.into_iter().rev().find(|&order| {
        is_symmetry(&about(DMat2::from_angle(
            std::f64::consts::TAU / f64::from(order),
        )))
    });
    let order = order.unwrap_or(1);
    let turn = |number: u32| {
        DMat2::from_angle(std::f64::consts::TAU * f64::from(number) / f64::from(order))
    };
    let mirror = (0..AXES).map(|number| {
        let double = std::f64::consts::TAU * f64::from(number) / f64::from(AXES);
        let axis = DVec2::from_angle(double);
        DMat2::from_cols(axis, -axis.perp())
    });
    let mut mirror = mirror.filter(|matrix| is_symmetry(&about(*matrix)));
    let mirror = mirror.next();
    let turns = (0..order).map(|number| about(turn(number)));
    let mirrored = mirror
        .into_iter()
        .flat_map(|mirror| (0..order).map(move |number| about(turn(number) * mirror)));
    turns
        .chain(mirrored)
        .map(|map| ground.outward(&map))
        .collect()
}

/// Returns a candidate with every map f replaced by f ∘ g, where g is the symmetry after which f turns least and does not
/// reflect: the attractor is the same if it has the symmetries.
pub(super) fn simplified(candidate: &Candidate, symmetries: &[DAffine2]) -> Candidate {
    let turn = |map: &DAffine2| {
        let axis = map.matrix2.x_axis;
        let flips = if map.matrix2.determinant() < 0.0 {
            1000.0
        } else {
            0.0
        };
        flips + libm::atan2(axis.y, axis.x).abs()
    };
    let simplest = |map: &DAffine2| {
        let turned = symmetries.iter().map(|symmetry| *map * *symmetry);
        turned
            .min_by(|a, b| turn(a).total_cmp(&turn(b)))
            .unwrap_or(*map)
    };
    Candidate {
        maps: candidate.maps.iter().map(simplest).collect(),
        disks: candidate.disks.clone(),
    }
}
