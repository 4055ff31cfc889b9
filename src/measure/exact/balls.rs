//! Bounding balls of the sets of a system.

use glam::{DAffine3, DVec3};

use super::system::ratio;
use crate::saturating::real;

/// A ball around each set of a system.
#[derive(Clone, Debug)]
pub(super) struct Balls {
    pub(super) centres: Vec<DVec3>,
    pub(super) radii: Vec<f64>,
}

/// Number of iterations for centres and for radii.
const ROUNDS: usize = 100;

impl Balls {
    /// Computes balls from the copies that each set is made of: similarities with ratios below 1. No set is
    /// empty.
    pub(super) fn of(copies: Vec<Vec<(usize, DAffine3)>>) -> Self {
        // The mean of the copies' centres lies well inside.
        let mut centres = vec![DVec3::ZERO; copies.len()];
        for _ in 0..ROUNDS {
            let mean = |copies: &Vec<(usize, DAffine3)>| {
                let moved = copies.iter();
                let sum: DVec3 = moved
                    .map(|(to, map)| map.transform_point3(centres[*to]))
                    .sum();
                sum / real(copies.len())
            };
            centres = copies.iter().map(mean).collect();
        }
        let reaches: Vec<Vec<(usize, f64, f64)>> = copies
            .iter()
            .zip(&centres)
            .map(|(copies, centre)| {
                let reach = |(to, map): &(usize, DAffine3)| {
                    let away = map.transform_point3(centres[*to]) - *centre;
                    (*to, away.length(), ratio(map.matrix3))
                };
                copies.iter().map(reach).collect()
            })
            .collect();
        let (mut farthest, mut largest) = (0.0, 0.0);
        for (_, away, ratio) in reaches.iter().flatten() {
            farthest = f64::max(farthest, *away);
            largest = f64::max(largest, *ratio);
        }
        // The iteration descends from the sum of a geometric series: the balls of every iteration hold the
        // sets.
        let mut radii = vec![farthest / (1.0 - largest); copies.len()];
        for _ in 0..ROUNDS {
            let radius = |reaches: &Vec<(usize, f64, f64)>| {
                let all = reaches.iter();
                all.map(|(to, away, ratio)| away + ratio * radii[*to])
                    .fold(0.0, f64::max)
            };
            radii = reaches.iter().map(radius).collect();
        }
        Self { centres, radii }
    }
}
