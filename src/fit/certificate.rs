//! The collage theorem's bound on the distance of an attractor from a shape.

use crate::Bits;
use crate::geometry::{DVec2, stretch};
use crate::morphology::DistanceMap;

use super::shape::{centre, distances, place};
use super::{Candidate, Silhouette};

/// The guarantee of the collage theorem for a candidate (Barnsley, Ervin, Hardin & Lancaster 1986): if the collage of a
/// shape S, the union of its images and of the condensation set, has the Hausdorff distance ε from S, and all maps
/// contract by m, the attractor's distance from S is at most ε/(1 − m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certificate {
    /// Hausdorff distance of the collage from the shape, both as sets of the centres of pixels, in pixels.
    pub collage: f64,
    /// The largest factor by which a map stretches, in the ellipsoidal norm in which it is nearly least.
    pub contraction: f64,
    /// The bound on the Hausdorff distance of the attractor from the shape, in pixels: ε/(1 − m), times the quotient of
    /// the norm's axes where the norm is not the Euclidean one, and half a pixel's diagonal for the rounding of the
    /// attractor to centres of pixels.
    pub bound: f64,
}

/// Half the diagonal of a pixel.
const HALF_DIAGONAL: f64 = std::f64::consts::FRAC_1_SQRT_2;

impl Certificate {
    /// Computes the certificate of a candidate.
    #[must_use]
    pub fn new(shape: &Silhouette, candidate: &Candidate) -> Self {
        let collage = distance(shape, candidate);
        let linear: Vec<_> = candidate.maps.iter().map(|map| map.matrix2).collect();
        let euclidean = linear.iter().map(stretch).fold(0.0, f64::max);
        let metric = candidate.metric();
        let skew = stretch(&metric.there) * stretch(&metric.there.inverse());
        let own = collage * skew / (1.0 - metric.contraction).max(0.0);
        let plain = collage / (1.0 - euclidean).max(0.0);
        // 0/0 where nothing is off, and nothing contracts.
        let [own, plain] =
            [own, plain].map(|bound| if bound.is_nan() { f64::INFINITY } else { bound });
        Self {
            collage,
            contraction: metric.contraction.min(euclidean),
            bound: own.min(plain) + HALF_DIAGONAL,
        }
    }
}

/// Returns the Hausdorff distance of a shape's collage from the shape, of images of centres from centres.
pub(super) fn distance(shape: &Silhouette, candidate: &Candidate) -> f64 {
    let [width, height] = shape.size();
    let Some(own) = distances(shape.bits()) else {
        return f64::INFINITY;
    };
    let images = { candidate.maps.iter() }.flat_map(|map| {
        shape
            .points()
            .iter()
            .map(|point| map.transform_point2(*point))
    });
    let mut all: Vec<DVec2> = images.collect();
    for disk in &candidate.disks {
        let everywhere = (0..height).flat_map(|row| (0..width).map(move |column| [column, row]));
        let inside = everywhere.map(|place| centre(place, height));
        all.extend(inside.filter(|point| point.distance(disk.centre) <= disk.radius));
        all.push(disk.centre);
    }
    let Some(nearest) = Nearest::new(&all, shape.size()) else {
        return f64::INFINITY;
    };
    let back = shape
        .points()
        .iter()
        .map(|&point| nearest.distance(&all, point));
    let there = all.iter().map(|&point| away(&own, shape, point));
    let largest = back.chain(there).fold(0.0, f64::max);
    // A disk lies within half a diagonal of its pixels.
    if candidate.disks.is_empty() {
        largest
    } else {
        largest + HALF_DIAGONAL
    }
}

/// Returns the distance of a point from the centres of a shape's pixels.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "clamped to the picture"
)]
fn away(distances: &DistanceMap, shape: &Silhouette, point: DVec2) -> f64 {
    let [width, height] = shape.size();
    let clamped = |value: f64, length: usize| value.clamp(0.0, length as f64 - 0.5) as usize;
    let [column, row] = [
        clamped(point.x, width),
        clamped(height as f64 - point.y, height),
    ];
    // The pixel nearest to the centre of the point's pixel, and those of the pixels around it.
    let mut least = f64::INFINITY;
    for row in row.saturating_sub(1)..=(row + 1).min(height - 1) {
        for column in column.saturating_sub(1)..=(column + 1).min(width - 1) {
            let found = distances.nearest()[row * width + column];
            let found = centre(place(found, width), height);
            least = least.min(found.distance(point));
        }
    }
    least
}

/// Points in the pixels that hold them.
struct Nearest {
    distances: DistanceMap,
    /// Numbers of points in the order of their pixels, and where those of each pixel begin.
    order: Vec<u32>,
    first: Vec<u32>,
    size: [usize; 2],
}

impl Nearest {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "clamped to the picture"
    )]
    fn new(points: &[DVec2], [width, height]: [usize; 2]) -> Option<Self> {
        let pixel = |point: &DVec2| {
            let clamped =
                |value: f64, length: usize| value.clamp(0.0, length as f64 - 0.5) as usize;
            [
                clamped(point.x, width),
                clamped(height as f64 - point.y, height),
            ]
        };
        let mut bits = Bits::new(width, height);
        let mut first = vec![0; width * height + 1];
        for point in points {
            let [column, row] = pixel(point);
            bits.set(column, row);
            first[row * width + column + 1] += 1;
        }
        for index in 1..first.len() {
            first[index] += first[index - 1];
        }
        let mut next = first.clone();
        let mut order = vec![0; points.len()];
        for (number, point) in points.iter().enumerate() {
            let [column, row] = pixel(point);
            let slot = &mut next[row * width + column];
            order[*slot as usize] = number as u32;
            *slot += 1;
        }
        Some(Self {
            distances: distances(&bits)?,
            order,
            first,
            size: [width, height],
        })
    }

    /// Returns the distance of a pixel's centre from a point near it: the nearest point, or one that is farther by at
    /// most a pixel's diagonal, so that the bound stays one.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "the centre lies in the picture"
    )]
    fn distance(&self, points: &[DVec2], centre: DVec2) -> f64 {
        let [width, height] = self.size;
        let [column, row] = [centre.x as usize, (height as f64 - centre.y) as usize];
        let mut least = f64::INFINITY;
        for row in row.saturating_sub(1)..=(row + 1).min(height - 1) {
            for column in column.saturating_sub(1)..=(column + 1).min(width - 1) {
                let cell = self.distances.nearest()[row * width + column] as usize;
                let own = self.first[cell] as usize..self.first[cell + 1] as usize;
                for &number in &self.order[own] {
                    least = least.min(points[number as usize].distance(centre));
                }
            }
        }
        least
    }
}
