//! Flat maps, whose images of a shape are line segments: stems, which no invertible map covers.

use crate::geometry::{DAffine2, DMat2, DVec2};

use super::copies::covered;
use super::ground::Ground;

/// Distance, in parts of the shape's radius, within which uncovered points belong to one segment.
const REACH: f64 = 0.15;
/// Least number of points of a segment.
const LEAST: usize = 4;

/// Returns the flat map onto the largest part of a shape that maps leave uncovered, all in cells; `None` if they leave
/// hardly anything.
///
/// The shape is projected onto the direction of the segment, and scaled to its length.
pub(super) fn stem(ground: &Ground, maps: &[DAffine2]) -> Option<DAffine2> {
    let bare = bare(ground, maps);
    let reach = REACH * ground.radius();
    let near = |point: &DVec2| {
        let near = bare.iter().filter(|it| it.distance(*point) <= reach);
        near.count()
    };
    let seed = bare.iter().copied().max_by_key(near)?;
    // Points that are connected to the seed.
    let mut part = vec![seed];
    let mut left: Vec<DVec2> = bare.into_iter().filter(|it| *it != seed).collect();
    let mut next = 0;
    while let Some(&point) = part.get(next) {
        next += 1;
        let (mut own, others) = left
            .into_iter()
            .partition(|it| it.distance(point) <= reach / 2.0);
        part.append(&mut own);
        left = others;
    }
    if part.len() < LEAST {
        return None;
    }
    let [middle, along] = axis(&part);
    let [low, high] = extent(&part, along);
    let [least, most] = extent(ground.points(), along);
    let (length, whole) = (high - low, most - least);
    if length < 2.0 || whole < 2.0 {
        return None;
    }
    let matrix = DMat2::from_cols(along * along.x, along * along.y) * (length / whole);
    let offset = middle.dot(along.perp()) * along.perp();
    let shift = offset + along * (low - least * length / whole);
    Some(DAffine2::from_mat2_translation(matrix, shift))
}

/// Returns the points of the ground that no image of the shape covers.
fn bare(ground: &Ground, maps: &[DAffine2]) -> Vec<DVec2> {
    let images: Vec<Vec<u64>> = maps.iter().map(|map| covered(ground, map)).collect();
    let is_covered = |number: usize| {
        let mut images = images.iter();
        images.any(|words| words[number / 64] >> (number % 64) & 1 == 1)
    };
    let points = ground.points().iter().enumerate();
    points
        .filter(|(number, _)| !is_covered(*number))
        .map(|(_, &point)| point)
        .collect()
}

/// Returns the mean of points and the direction of their longest axis, upwards.
#[expect(clippy::cast_precision_loss, reason = "samples are small")]
fn axis(points: &[DVec2]) -> [DVec2; 2] {
    let mean = points.iter().sum::<DVec2>() / points.len() as f64;
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for away in points.iter().map(|point| *point - mean) {
        xx += away.x * away.x;
        xy += away.x * away.y;
        yy += away.y * away.y;
    }
    let angle = 0.5 * libm::atan2(2.0 * xy, xx - yy);
    [mean, DVec2::new(libm::cos(angle), libm::sin(angle))]
}

/// Returns the least and the largest coordinate of points along a direction.
fn extent(points: &[DVec2], along: DVec2) -> [f64; 2] {
    let places = points.iter().map(|point| point.dot(along));
    places.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| {
        [low.min(at), high.max(at)]
    })
}
