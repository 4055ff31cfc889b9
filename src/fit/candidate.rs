//! A system that is a candidate for a shape: affine maps and condensation disks.

use crate::geometry::{DAffine2, DMat2, DVec2, Linear};
use crate::ifs::best_coordinates;

/// A disk of the condensation set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disk {
    /// The centre.
    pub centre: DVec2,
    /// The radius, in pixels.
    pub radius: f64,
}

/// A system of maps with condensation disks, in the coordinates of a [`Silhouette`](super::Silhouette): its attractor
/// A is the union of the disks and of the images of A under the maps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Candidate {
    /// The maps.
    pub maps: Vec<DAffine2>,
    /// The condensation disks.
    pub disks: Vec<Disk>,
}

/// Coordinates of the plane in which the maps of a candidate stretch little.
#[derive(Clone, Copy, Debug)]
pub(super) struct Metric {
    pub(super) there: DMat2,
    /// The largest factor by which a map stretches a vector in these coordinates.
    pub(super) contraction: f64,
}

impl Candidate {
    /// Returns a candidate of maps alone.
    #[must_use]
    pub fn of_maps(maps: Vec<DAffine2>) -> Self {
        Self {
            maps,
            disks: Vec::new(),
        }
    }

    /// Returns the number of numbers that describe the candidate: six for a map, four if it is a similarity, and three
    /// for a disk.
    #[must_use]
    pub fn numbers(&self) -> usize {
        let maps = self
            .maps
            .iter()
            .map(|map| if is_similar(&map.matrix2) { 4 } else { 6 });
        maps.sum::<usize>() + 3 * self.disks.len()
    }

    /// Returns the coordinates in which the largest stretch of a map is nearly least.
    pub(super) fn metric(&self) -> Metric {
        let linear: Vec<DMat2> = self.maps.iter().map(|map| map.matrix2).collect();
        let there = best_coordinates(&linear);
        let back = there.inverse();
        let stretches = linear
            .iter()
            .map(|matrix| (there * *matrix * back).stretch());
        Metric {
            there,
            contraction: stretches.fold(0.0, f64::max),
        }
    }

    /// Returns the fixed points of the maps.
    pub(super) fn fixed_points(&self) -> impl Iterator<Item = DVec2> {
        self.maps.iter().filter_map(fixed_point)
    }

    /// Returns the candidate with its maps in the order in which their copies of a point lie around it, counterclockwise from
    /// the right in eighths of a turn; in an eighth, from the left and from below.
    pub(super) fn ordered(mut self, middle: DVec2) -> Self {
        let key = |map: &DAffine2| {
            let away = map.transform_point2(middle) - middle;
            let eighth = libm::atan2(away.y, away.x) / std::f64::consts::FRAC_PI_4;
            let hundredth = |value: f64| (value * 100.0).round();
            (
                eighth.round().rem_euclid(8.0),
                hundredth(away.x),
                hundredth(away.y),
            )
        };
        self.maps.sort_by(|one, other| {
            let (one, other) = (key(one), key(other));
            let first = one.0.total_cmp(&other.0);
            first
                .then(one.1.total_cmp(&other.1))
                .then(one.2.total_cmp(&other.2))
        });
        self
    }

    /// Returns the candidate with every map f replaced by g ∘ f ∘ g⁻¹ and every disk by its image, where g is a
    /// similarity.
    #[must_use]
    pub fn moved(&self, similarity: &DAffine2) -> Self {
        let back = similarity.inverse();
        let factor = libm::sqrt(similarity.matrix2.determinant().abs());
        Self {
            maps: { self.maps.iter() }
                .map(|map| *similarity * *map * back)
                .collect(),
            disks: { self.disks.iter() }
                .map(|disk| Disk {
                    centre: similarity.transform_point2(disk.centre),
                    radius: disk.radius * factor,
                })
                .collect(),
        }
    }
}

/// Returns the fixed point of a map; `None` if it has none, or more than one.
pub(super) fn fixed_point(map: &DAffine2) -> Option<DVec2> {
    let away = DMat2::IDENTITY - map.matrix2;
    (away.determinant().abs() > 1e-9).then(|| away.inverse() * map.translation)
}

/// Returns whether a matrix is a rotation or reflection times a factor.
pub(super) fn is_similar(matrix: &DMat2) -> bool {
    let [a, b] = [matrix.x_axis, matrix.y_axis];
    let tolerance = 1e-9 * (a.length() + b.length());
    let turned = (b - a.perp()).length() <= tolerance;
    turned || (b + a.perp()).length() <= tolerance
}
