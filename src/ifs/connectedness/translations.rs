//! Pairs of pieces under maps that differ in their translations only.

use std::f64::consts::FRAC_1_SQRT_2;

use super::disc::Shrunk;
use super::{Budget, Meeting};
use crate::geometry::{DMat2, DVec2};

/// Largest number of differences of translations.
const MAX_DIFFERENCES: usize = 1 << 12;

/// Largest number of pairs that are compared by discs before octagons are.
const BY_DISCS: Budget = 5_000;

/// Directions across the sides of octagons.
const ACROSS: [DVec2; 4] = [
    DVec2::X,
    DVec2::Y,
    DVec2::new(FRAC_1_SQRT_2, FRAC_1_SQRT_2),
    DVec2::new(FRAC_1_SQRT_2, -FRAC_1_SQRT_2),
];

/// Descent over differences of points, with its memory.
#[derive(Clone, Debug, Default)]
pub(super) struct Translations {
    /// Differences of translations, each once.
    differences: Vec<DVec2>,
    /// Errors of differences of points, by depth.
    errors: Vec<f64>,
    stack: Vec<(DVec2, u32)>,
}

/// Common linear part of all maps.
pub(super) struct Common<'a> {
    inverse: DMat2,
    maps: &'a Shrunk,
    /// Length of the longest difference of translations.
    longest: f64,
    /// Radius of a disc that contains all differences of points of the attractor.
    radius: f64,
}

/// Set that contains all differences of points of the attractor.
enum Region {
    Disc(f64),
    /// Distances of the sides from the origin, along [`ACROSS`].
    Octagon([f64; 4]),
}

impl Region {
    /// Returns whether a point is in the region, but for an error.
    fn contains(&self, point: DVec2, error: f64) -> bool {
        match self {
            Self::Disc(radius) => {
                let limit = radius + error;
                point.length_squared() <= limit * limit * (1.0 + 1e-12)
            }
            Self::Octagon(sides) => {
                let mut sides = ACROSS.iter().zip(sides);
                sides.all(|(across, side)| point.dot(*across).abs() <= side + error)
            }
        }
    }
}

impl Common<'_> {
    /// Returns the smallest octagon about the differences of points: its sides are at the sums of the greatest distances
    /// of L^k d along a direction.
    fn octagon(&self) -> Region {
        const TERMS: u32 = 1000;
        let linear = self.maps.maps[0].matrix2;
        let transposed = linear.transpose();
        let shrinking = 1.0 - self.maps.stretches[0];
        // The functional of a term has the errors of all products before it.
        let rounding = 16.0 * self.maps.error * self.longest / (shrinking * shrinking);
        Region::Octagon(ACROSS.map(|across| {
            let (mut pulled, mut side) = (across, 0.0);
            let mut terms = 0;
            let translations = || self.maps.maps.iter().map(|map| map.translation);
            // The rest of the series is at most the length of the functional times the radius.
            while terms < TERMS && pulled.length_squared() > 1e-24 {
                let [low, high] = translations()
                    .map(|it| it.dot(pulled))
                    .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], along| {
                        [low.min(along), high.max(along)]
                    });
                side += high - low;
                pulled = transposed * pulled;
                terms += 1;
            }
            (side + pulled.length() * self.radius) * (1.0 + 1e-9) + rounding
        }))
    }
}

impl Translations {
    /// Prepares the descent; `None` where the linear parts of the maps differ, or cannot be inverted.
    pub(super) fn prepare<'a>(&mut self, maps: &'a Shrunk, depth: u32) -> Option<Common<'a>> {
        let own = &maps.maps;
        let linear = own.first()?.matrix2;
        let is_common = own.iter().all(|map| map.matrix2 == linear);
        let (stretch, area) = (maps.stretches[0], linear.determinant().abs());
        let is_regular = stretch < 1.0 && area > 1e-6 * (stretch * stretch);
        if !is_common || !is_regular || own.len() * own.len() > MAX_DIFFERENCES {
            return None;
        }
        self.differences.clear();
        for a in own {
            for b in own {
                let difference = a.translation - b.translation;
                if !self.differences.contains(&difference) {
                    self.differences.push(difference);
                }
            }
        }
        let longest = self.differences.iter().map(|it| it.length_squared());
        let longest = longest.fold(0.0, f64::max).sqrt();
        // A − A is the attractor of the maps w → L w + d.
        let radius = longest / (1.0 - stretch) * (1.0 + 1e-12 + maps.error / (1.0 - stretch));
        let growth = stretch / area * (1.0 + 1e-12);
        // Errors of a difference, of its product with a matrix, and of the inverse matrix.
        let rounding = 16.0 * maps.error * (stretch * growth);
        self.errors.clear();
        self.errors.push(0.0);
        let mut error = 0.0;
        for _ in 0..depth {
            error = growth * (error + rounding * (radius + error + longest));
            self.errors.push(error);
        }
        Some(Common {
            inverse: linear.inverse(),
            maps,
            longest,
            radius,
        })
    }

    /// Returns whether the pieces of two maps meet: by discs, and where these do not certify that the pieces are disjoint,
    /// by octagons, with the depth that discs have reached.
    pub(super) fn meeting(
        &mut self,
        common: &Common<'_>,
        pair: [usize; 2],
        depth: u32,
        budget: &mut Budget,
    ) -> Meeting {
        let disc = Region::Disc(common.radius);
        let own = BY_DISCS.min(*budget);
        let mut left = own;
        let (by_discs, reached) = self.descend(common, &disc, pair, depth, &mut left);
        *budget -= own - left;
        if let Meeting::Apart(_) = by_discs {
            return by_discs;
        }
        match self.descend(common, &common.octagon(), pair, depth, budget) {
            (Meeting::Apart(depth), _) => Meeting::Apart(depth.max(reached)),
            (other, _) => other,
        }
    }

    /// Returns whether the pieces of two maps meet, and the depth that is reached.
    fn descend(
        &mut self,
        common: &Common<'_>,
        region: &Region,
        [i, j]: [usize; 2],
        depth: u32,
        budget: &mut Budget,
    ) -> (Meeting, u32) {
        let maps = &common.maps.maps;
        let start = common.inverse * (maps[j].translation - maps[i].translation);
        let mut deepest = 1;
        if !region.contains(start, self.errors[1]) {
            return (Meeting::Apart(deepest), deepest);
        }
        self.stack.clear();
        self.stack.push((start, 1));
        let children = u32::try_from(self.differences.len()).unwrap_or(u32::MAX);
        while let Some((from, level)) = self.stack.pop() {
            if level == depth {
                return (Meeting::Unknown, deepest);
            }
            let level = level + 1;
            deepest = deepest.max(level);
            let Some(left) = budget.checked_sub(children) else {
                return (Meeting::Exceeded, deepest);
            };
            *budget = left;
            let error = self.errors[level as usize];
            let first = self.stack.len();
            for difference in &self.differences {
                let next = common.inverse * (from - *difference);
                if region.contains(next, error) {
                    self.stack.push((next, level));
                }
            }
            // The shortest difference is followed first: it is the most likely not to leave the region.
            let length = |(point, _): &(DVec2, u32)| point.length_squared();
            self.stack[first..].sort_unstable_by(|a, b| length(b).total_cmp(&length(a)));
        }
        (Meeting::Apart(deepest), deepest)
    }
}
