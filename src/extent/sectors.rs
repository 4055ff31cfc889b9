//! Images that can reach farthest, for sectors of directions that are halved as far as they are asked for.

use std::cell::{Cell, OnceCell};

use crate::geometry::DVec2;

/// Least number of images for which sectors are worth their cost: for fewer, all are looked at.
pub(super) const MANY: usize = 32;

/// Number of contenders up to which a sector is not halved.
const FEW: usize = 8;

/// Maximum number of halvings of a sector.
const MAX_HALVINGS: u32 = 24;

/// Number of halvings of quarters after which images that contend nowhere are found.
const HALVINGS: u32 = 3;

/// Maximum number of support functions that are evaluated, for each image.
const MAX_WORK: usize = 32;

/// Distance by which the others must fall short, relative to the size, so that rounding drops none.
const MARGIN: f64 = 1e-9;

/// Directions between which the quarters lie.
pub(super) const AXES: [DVec2; 4] = [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y];

/// Bound of the support function of an image, by number and direction.
pub(super) type Support<'a> = &'a dyn Fn(u32, DVec2) -> f64;

/// A convex set that is the hull of images, approximated by a polygon.
pub(super) struct Whole<'a> {
    /// Corners of the polygon.
    pub(super) corners: &'a [DVec2],
    /// Distance within which the set contains the corners.
    pub(super) within: f64,
    /// Upper bound of the support functions of images.
    pub(super) reach: Support<'a>,
    /// Upper bound that is found faster, and no less than the other but for rounding.
    pub(super) at_most: Support<'a>,
}

impl Whole<'_> {
    /// Returns a corner that is farthest along a direction; `None` without corners.
    fn farthest(&self, direction: DVec2) -> Option<DVec2> {
        let farther = |a: &&DVec2, b: &&DVec2| a.dot(direction).total_cmp(&b.dot(direction));
        self.corners.iter().max_by(farther).copied()
    }
}

/// Images that may reach farthest, for the sectors between the axes and their parts.
pub(super) struct Sectors {
    quarters: [Sector; 4],
    /// Distance by which an image must fall short of a corner along all directions so that it never reaches farthest.
    lost: f64,
    /// Number of support functions that may still be evaluated.
    left: Cell<usize>,
}

/// Directions between two sides, which are unit vectors.
struct Sector {
    /// The sides, counter-clockwise.
    sides: [DVec2; 2],
    /// Numbers of the images that may reach farthest along a direction of the sector, in the order of the images.
    contenders: Vec<u32>,
    /// Support functions of the contenders along the sides.
    reached: [Vec<f64>; 2],
    /// The halves, as far as they were asked for; `None` where halving is not worth its cost.
    halves: OnceCell<Option<Box<[Sector; 2]>>>,
}

impl Sectors {
    /// Examines images along the axes.
    pub(super) fn of(images: Vec<u32>, whole: &Whole<'_>) -> Self {
        let far = AXES.map(|axis| whole.farthest(axis).map_or(0.0, |corner| corner.dot(axis)));
        let lost = whole.within + MARGIN * far.map(f64::abs).into_iter().fold(0.0, f64::max);
        let along = |images: &[u32], axis, support: Support<'_>| -> Vec<f64> {
            images.iter().map(|it| support(*it, axis)).collect()
        };
        let most = AXES.map(|axis| along(&images, axis, whole.at_most));
        let quarters = [0, 1, 2, 3].map(|quarter| {
            let sides = [quarter, (quarter + 1) % 4];
            let axes = sides.map(|side: usize| AXES[side]);
            let ends = sides.map(|side| &most[side]);
            let images = Sector::of(&images, axes, ends, lost, whole).contenders;
            let ends = axes.map(|axis| along(&images, axis, whole.reach));
            Sector::of(&images, axes, ends.each_ref(), lost, whole)
        });
        Self {
            quarters,
            lost,
            left: Cell::new(MAX_WORK * images.len()),
        }
    }

    /// Returns the numbers of the images that may reach farthest along a vector; `None` if its coordinates are not finite.
    pub(super) fn along(&self, vector: DVec2, whole: &Whole<'_>) -> Option<&[u32]> {
        if !vector.is_finite() {
            return None;
        }
        let quarter = match (vector.x > 0.0, vector.y >= 0.0) {
            (true, true) => 0,
            (false, true) if vector.y > 0.0 => 1,
            (false, _) => 2,
            (true, false) => 3,
        };
        let mut sector = &self.quarters[quarter];
        for _ in 0..MAX_HALVINGS {
            let Some(halves) = self.halves(sector, whole) else {
                break;
            };
            let is_second = halves[1].sides[0].perp_dot(vector) >= 0.0;
            sector = &halves[usize::from(is_second)];
        }
        Some(&sector.contenders)
    }

    /// Returns the numbers of the images that may reach farthest along any direction, in rising order.
    pub(super) fn anywhere(&self, whole: &Whole<'_>) -> Vec<u32> {
        let mut sectors: Vec<&Sector> = self.quarters.iter().collect();
        for _ in 0..HALVINGS {
            let parts = sectors.into_iter().flat_map(|sector| {
                let halves = self.halves(sector, whole);
                halves.map_or_else(|| vec![sector], |halves| halves.iter().collect())
            });
            sectors = parts.collect();
        }
        let all = sectors.iter().flat_map(|sector| &sector.contenders);
        let mut all: Vec<u32> = all.copied().collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Returns the halves of a sector; `None` where its contenders are few, or the work is used up.
    fn halves<'s>(&self, sector: &'s Sector, whole: &Whole<'_>) -> Option<&'s [Sector; 2]> {
        let halves = sector.halves.get_or_init(|| {
            let count = sector.contenders.len();
            let left = self.left.get().checked_sub(count)?;
            if count <= FEW {
                return None;
            }
            self.left.set(left);
            let [first, last] = sector.sides;
            let middle = (first + last).normalize_or_zero();
            let between = sector.contenders.iter();
            let between: Vec<f64> = between.map(|it| (whole.reach)(*it, middle)).collect();
            let half = |sides, ends| Sector::of(&sector.contenders, sides, ends, self.lost, whole);
            let halves = [
                half([first, middle], [&sector.reached[0], &between]),
                half([middle, last], [&between, &sector.reached[1]]),
            ];
            let both = halves.each_ref().map(|half| half.contenders.len());
            // Halves that share most of their contenders are not worth their cost.
            (2 * (both[0] + both[1]) <= 3 * count).then(|| Box::new(halves))
        });
        halves.as_deref()
    }
}

impl Sector {
    /// Keeps those of some images that may reach farthest between two sides, along which their support functions are given.
    ///
    /// Support functions are convex and homogeneous: along a unit vector between the sides, that of an image is at most the
    /// combination of those along the sides. An image does not contend if along both sides it falls short of one and the same
    /// corner.
    fn of(
        images: &[u32],
        sides: [DVec2; 2],
        reached: [&Vec<f64>; 2],
        lost: f64,
        whole: &Whole<'_>,
    ) -> Self {
        let between = [sides[0], sides[0] + sides[1], sides[1]];
        let least = between.map(|direction| {
            let corner = whole.farthest(direction);
            // Without corners, all contend.
            sides.map(|side| corner.map_or(f64::NEG_INFINITY, |it| it.dot(side) - lost))
        });
        let mut sector = Self {
            sides,
            contenders: Vec::new(),
            reached: [const { Vec::new() }; 2],
            halves: OnceCell::new(),
        };
        for (place, number) in images.iter().enumerate() {
            let ends = reached.map(|reached| reached[place]);
            // An image whose reach is not a number contends.
            let falls_short = |least: &[f64; 2]| ends[0] < least[0] && ends[1] < least[1];
            if !least.iter().any(falls_short) {
                sector.contenders.push(*number);
                sector.reached[0].push(ends[0]);
                sector.reached[1].push(ends[1]);
            }
        }
        sector
    }
}

#[cfg(test)]
mod tests;
