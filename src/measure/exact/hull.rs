//! The affine hulls of sets, and the maps of a system in coordinates of these.
//!
//! Two maps that differ only outside the hull put a copy in the same place: whether copies coincide is
//! decided inside the hull. A Cantor set in the plane is a set of the line.

use glam::{DAffine3, DMat3, DVec3};

use super::system::{Copy, GraphDirectedSystem, ratio};

/// A strongly connected system of similarities in coordinates of the affine hulls of its sets.
#[derive(Clone, Debug)]
pub(super) struct Flat {
    /// Dimension of the space that contains the sets.
    pub(super) space: usize,
    /// Dimension of the affine hull of each set.
    pub(super) dimension: usize,
    pub(super) size: usize,
    /// Maps in the coordinates of the hulls: 0 is a point of the set, the first `dimension` axes span its
    /// hull, and the others are scaled by the ratio. The size of sets is about 1.
    pub(super) copies: Vec<Copy>,
    /// Maps from the coordinates of every set's hull to those of the original sets.
    pub(super) frames: Vec<DAffine3>,
}

/// Length, in a system of size 1, below which a component counts as zero.
const FLAT: f64 = 1e-8;

impl Flat {
    /// Computes the hulls of a system and the maps in their coordinates.
    ///
    /// Precondition: all ratios are below 1, and every set holds a copy.
    pub(super) fn of(system: &GraphDirectedSystem) -> Self {
        let points = points(system);
        let mut extent = 0.0;
        for copy in &system.copies {
            let away = copy.map.transform_point3(points[copy.to]) - points[copy.from];
            extent = f64::max(extent, away.length());
        }
        let unit = if extent > 0.0 { extent } else { 1.0 };
        let mut hulls: Vec<Vec<DVec3>> = vec![Vec::new(); system.size];
        // At least one hull grows in each round, and each grows at most three times.
        for _ in 0..=3 * system.size {
            let mut grows = false;
            for copy in &system.copies {
                let away = copy.map.transform_point3(points[copy.to]) - points[copy.from];
                let turned = hulls[copy.to].clone().into_iter();
                let turned = turned.map(|axis| (copy.map.matrix3 * axis).normalize());
                for vector in std::iter::once(away / unit).chain(turned) {
                    grows |= extend(&mut hulls[copy.from], vector);
                }
            }
            if !grows {
                break;
            }
        }
        let dimension = hulls.iter().map(Vec::len).max().unwrap_or(0);
        let bases: Vec<DMat3> = hulls.into_iter().map(completed).collect();
        let copies = system.copies.iter().map(|copy| {
            let away = copy.map.transform_point3(points[copy.to]) - points[copy.from];
            let [inner, outer] = [bases[copy.to], bases[copy.from].transpose()];
            let map = DAffine3 {
                matrix3: outer * copy.map.matrix3 * inner,
                translation: outer * away / unit,
            };
            Copy {
                map: within(map, dimension),
                ..*copy
            }
        });
        let frame = |(basis, point): (&DMat3, &DVec3)| DAffine3 {
            matrix3: *basis * unit,
            translation: *point,
        };
        Self {
            space: system.space,
            dimension,
            size: system.size,
            copies: copies.collect(),
            frames: bases.iter().zip(&points).map(frame).collect(),
        }
    }
}

/// Returns a point of every set: the limit along the first copies.
fn points(system: &GraphDirectedSystem) -> Vec<DVec3> {
    let mut first = vec![None; system.size];
    for copy in &system.copies {
        first[copy.from].get_or_insert(copy);
    }
    let mut points = vec![DVec3::ZERO; system.size];
    // A ratio of 0.99 takes this many iterations to reach the last digit.
    for _ in 0..4_000 {
        let next: Vec<DVec3> = first
            .iter()
            .map(|copy| {
                copy.map_or(DVec3::ZERO, |copy| {
                    copy.map.transform_point3(points[copy.to])
                })
            })
            .collect();
        let still = next == points;
        points = next;
        if still {
            break;
        }
    }
    points
}

/// Returns the part of a vector that is orthogonal to orthonormal axes; two passes are sufficient (Kahan).
fn remainder(axes: &[DVec3], vector: DVec3) -> DVec3 {
    let axes = axes.iter().chain(axes);
    axes.fold(vector, |left, axis| left - left.dot(*axis) * *axis)
}

/// Adds the normalised remainder of a vector to an orthonormal list, and returns `true`, if it is not in the
/// span of the list.
fn extend(axes: &mut Vec<DVec3>, vector: DVec3) -> bool {
    let left = remainder(axes, vector);
    let new = axes.len() < 3 && left.length() > FLAT;
    if new {
        axes.push(left.normalize());
    }
    new
}

/// Completes an orthonormal list to a basis.
fn completed(mut axes: Vec<DVec3>) -> DMat3 {
    // The largest remainder loses the fewest digits to rounding.
    while axes.len() < 3 {
        let all = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| remainder(&axes, axis));
        let longest =
            all.into_iter().fold(
                DVec3::ZERO,
                |a, b| if b.length() > a.length() { b } else { a },
            );
        axes.push(longest.normalize());
    }
    DMat3::from_cols(axes[0], axes[1], axes[2])
}

/// Restricts a map to the first axes; the others are scaled by its ratio.
fn within(map: DAffine3, dimension: usize) -> DAffine3 {
    let ratio = ratio(map.matrix3);
    let keep = |axis: usize, vector: DVec3| {
        let mut kept = vector;
        for row in 0..3 {
            if row >= dimension || axis >= dimension {
                kept[row] = if row == axis { ratio } else { 0.0 };
            }
        }
        kept
    };
    let linear = map.matrix3;
    let mut translation = map.translation;
    for row in dimension..3 {
        translation[row] = 0.0;
    }
    DAffine3 {
        matrix3: DMat3::from_cols(
            keep(0, linear.x_axis),
            keep(1, linear.y_axis),
            keep(2, linear.z_axis),
        ),
        translation,
    }
}
