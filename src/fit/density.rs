//! The measure of a fit: weights of the maps, by which random iteration draws a picture with its values.

use crate::geometry::{DAffine2, DVec2};
use crate::saturating::{real, whole};

use super::candidate::fixed_point;
use super::moments::Target;
use super::{Candidate, Silhouette};

/// Squares along the longer side of a picture in which masses are compared.
const SQUARES: usize = 16;
/// Mass of the parts of a measure that are not divided further.
const LEAST: f64 = 1e-5;

/// Weights of the maps with which the invariant measure is closest to the values of a picture, by its moments of orders
/// up to 6.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedWeights {
    /// Probabilities of the maps, in their order.
    pub weights: Vec<f64>,
    /// Total variation: the share of the mass that lies in other squares than the picture's, of squares whose side is 1/16
    /// of the longer side.
    pub distance: f64,
}

impl FittedWeights {
    /// Fits the weights of a candidate; `None` if the shape has no values, or the candidate has disks.
    pub(super) fn of(shape: &Silhouette, candidate: &Candidate) -> Option<Self> {
        if !shape.has_values() || !candidate.disks.is_empty() {
            return None;
        }
        let weights = Target::of(shape)?.weights(&candidate.maps);
        let distance = distance(shape, &candidate.maps, &weights);
        Some(Self { weights, distance })
    }
}

/// Returns the total variation of the invariant measure from the values of a picture, in squares.
fn distance(shape: &Silhouette, maps: &[DAffine2], weights: &[f64]) -> f64 {
    let [width, height] = shape.size();
    let side = real(width.max(height)) / real(SQUARES);
    // The last square is for everything outside.
    let mut masses = [0.0; SQUARES * SQUARES + 1];
    let square = |point: DVec2| {
        let is_inside = point.x >= 0.0 && point.y >= 0.0;
        let [column, row] = [whole(point.x / side), whole(point.y / side)];
        match is_inside && column < SQUARES && row < SQUARES {
            true => row * SQUARES + column,
            false => SQUARES * SQUARES,
        }
    };
    let total: f64 = shape.masses().map(|(_, mass)| mass).sum();
    for (point, mass) in shape.masses() {
        masses[square(point)] += mass / total;
    }
    let Some(start) = maps.iter().find_map(fixed_point) else {
        return 1.0;
    };
    let mut parts = vec![(DAffine2::IDENTITY, 1.0)];
    while let Some((map, mass)) = parts.pop() {
        if mass < LEAST {
            masses[square(map.transform_point2(start))] -= mass;
            continue;
        }
        let inner = maps.iter().zip(weights);
        parts.extend(inner.map(|(inner, weight)| (map * *inner, mass * weight)));
    }
    masses.iter().map(|mass| mass.abs()).sum::<f64>() / 2.0
}
