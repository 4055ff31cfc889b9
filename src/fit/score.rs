//! Measures of the difference of two pictures: by area, along their boundaries, and by distances.

use crate::Bits;

use super::shape::distances;

/// Measures of two sets of pixels. Distances are those of centres, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Score {
    /// Intersection over union.
    pub iou: f64,
    /// Intersection over union of the pixels of each set that lie within 2 pixels of its complement.
    pub boundary_iou: f64,
    /// Hausdorff distance.
    pub hausdorff: f64,
    /// Distance that 95 % of the pixels of each set have at most from the other set: the larger of both percentiles.
    pub hausdorff95: f64,
    /// Mean of the mean distances of the pixels of each set from the other.
    pub mean_distance: f64,
    /// Share of the pixels of the second set that lie within 2 pixels of the first.
    pub coverage: f64,
}

/// Width in pixels of the band of [`Score::boundary_iou`].
const BAND: u32 = 2;

impl Score {
    /// Compares two sets of pixels of the same size. The distance from an empty set is infinite.
    #[must_use]
    pub fn new(one: &Bits, other: &Bits) -> Self {
        let sets = [one, other];
        let [boundary, other_boundary] = sets.map(boundary);
        let [there, back] = [[0, 1], [1, 0]].map(|[from, to]| Distances::new(sets[from], sets[to]));
        Self {
            iou: iou(one, other),
            boundary_iou: iou(&boundary, &other_boundary),
            hausdorff: there.largest.max(back.largest),
            hausdorff95: there.most.max(back.most),
            mean_distance: (there.mean + back.mean) / 2.0,
            coverage: back.near,
        }
    }
}

/// Returns intersection over union of two sets of the same size; 1 if both are empty.
#[expect(clippy::cast_precision_loss, reason = "pictures are small")]
pub(super) fn iou(one: &Bits, other: &Bits) -> f64 {
    let (mut common, mut all) = (0u64, 0u64);
    for (a, b) in one.words().iter().zip(other.words()) {
        common += u64::from((a & b).count_ones());
        all += u64::from((a | b).count_ones());
    }
    if all == 0 {
        1.0
    } else {
        common as f64 / all as f64
    }
}

/// Distances of the pixels of a set from another.
struct Distances {
    largest: f64,
    most: f64,
    mean: f64,
    near: f64,
}

impl Distances {
    #[expect(clippy::cast_precision_loss, reason = "pictures are small")]
    fn new(from: &Bits, to: &Bits) -> Self {
        let (Some(map), false) = (distances(to), from.is_empty()) else {
            let away = if to.is_empty() && from.is_empty() {
                0.0
            } else {
                f64::INFINITY
            };
            return Self {
                largest: away,
                most: away,
                mean: away,
                near: 0.0,
            };
        };
        let squared = map.squared();
        let mut all: Vec<f64> = { from.set_boxes() }
            .map(|[column, row]| libm::sqrt(squared[row * map.width() + column].into()))
            .collect();
        all.sort_unstable_by(f64::total_cmp);
        let count = all.len();
        let near = all.partition_point(|&distance| distance <= f64::from(BAND));
        Self {
            largest: all[count - 1],
            most: all[(count * 95).div_ceil(100) - 1],
            mean: all.iter().sum::<f64>() / count as f64,
            near: near as f64 / count as f64,
        }
    }
}

/// Returns the pixels of a set within [`BAND`] of its complement, to which everything outside the picture belongs.
fn boundary(set: &Bits) -> Bits {
    let (width, height) = (set.width(), set.height());
    let mut outside = Bits::new(width + 2, height + 2);
    for row in 0..height + 2 {
        for column in 0..width + 2 {
            let is_inside = (1..=width).contains(&column) && (1..=height).contains(&row);
            if !is_inside || !set.get(column - 1, row - 1) {
                outside.set(column, row);
            }
        }
    }
    let mut boundary = Bits::new(width, height);
    let Some(map) = distances(&outside) else {
        return boundary;
    };
    for [column, row] in set.set_boxes() {
        if map.squared()[(row + 1) * map.width() + column + 1] <= BAND * BAND {
            boundary.set(column, row);
        }
    }
    boundary
}
