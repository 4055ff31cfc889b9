//! Covering of sets of the plane and of space: what differs between them.

use crate::extent::Bounded;
use crate::fast_hash::FastMap;
use crate::geometry::{
    BaseElement, Bounds, DAffine2, DAffine3, DVec2, DVec3, Frame2, Frame3, Round, Solid,
};

use super::region::{Covered, CoveredSquares, Region, TooMany, radius_of};

/// Frames whose sets are covered by points.
pub trait Covering: Bounded {
    /// Sides of a tile of 64 cells.
    const TILE: [usize; 3];

    /// Maximum distance of the centre of a cell from the part of the set that it represents, as a multiple of the radius of the
    /// cover. The rest of the radius remains for parts that are covered by points nearby.
    const NEAR: f64;

    /// Radius of balls about the points of a lattice that leaves nothing between them uncovered, as a multiple of the radius of
    /// the cover.
    const APART: f64;

    /// Returns an empty memory of the places of a box that are within a radius of visited points; `None` if it would
    /// take too much room.
    fn covered(bounds: &Bounds<Self::Point>, radius: f64) -> Option<Box<dyn Covered<Self::Point>>>;

    /// Returns the radius of a ball about a point that holds an outline.
    fn radius_of(outline: &Self::Outline, middle: Self::Point) -> f64;

    /// Adds the image of an outline, with what it encloses.
    ///
    /// # Errors
    ///
    /// If that takes too many points.
    fn add_outline(
        region: &mut Region<'_, Self::Point>,
        outline: &Self::Outline,
        map: &Self::Map,
    ) -> Result<(), TooMany>;
}

impl Covering for Frame2 {
    const TILE: [usize; 3] = [8, 8, 1];
    const NEAR: f64 = 0.75;
    // Several discs may cover a part together; a share of the radius is left for the rounding of squares.
    const APART: f64 = 0.93;

    fn covered(bounds: &Bounds, radius: f64) -> Option<Box<dyn Covered<DVec2>>> {
        let covered = CoveredSquares::new(bounds, radius)?;
        Some(Box::new(covered))
    }

    fn radius_of(outline: &BaseElement, middle: DVec2) -> f64 {
        radius_of(outline, middle)
    }

    fn add_outline(
        region: &mut Region<'_>,
        outline: &BaseElement,
        map: &DAffine2,
    ) -> Result<(), TooMany> {
        region.add_outline(outline, map)
    }
}

impl Covering for Frame3 {
    const TILE: [usize; 3] = [4, 4, 4];
    const NEAR: f64 = 0.4;
    // A part is covered by one ball.
    const APART: f64 = 1.0 - Self::NEAR;

    fn covered(bounds: &Bounds<DVec3>, radius: f64) -> Option<Box<dyn Covered<DVec3>>> {
        Some(Box::new(CoveredBalls::new(bounds.min(), radius)))
    }

    fn radius_of(solid: &Solid, middle: DVec3) -> f64 {
        if solid.primitive().is_some() {
            let bounds = solid.bounds(&DAffine3::IDENTITY);
            let away = (bounds.min() - middle).abs();
            return away.max((bounds.max() - middle).abs()).length();
        }
        let far = solid.corners().iter().map(|it| it.distance(middle));
        far.fold(0.0, f64::max)
    }

    /// Adds the centres of simplices that make up a polyhedron: it is divided from its centre, and they are halved at
    /// their longest edges.
    fn add_outline(
        region: &mut Region<'_, DVec3>,
        solid: &Solid,
        map: &DAffine3,
    ) -> Result<(), TooMany> {
        if let Some(round) = solid.primitive() {
            return add_round(region, round, &(*map * *solid.place()));
        }
        let mut open: Vec<[DVec3; 4]> = simplices(solid)
            .into_iter()
            .map(|corners| corners.map(|corner| map.transform_point3(corner)))
            .collect();
        while let Some(corners) = open.pop() {
            let middle = corners.iter().sum::<DVec3>() / 4.0;
            let away = corners.iter().map(|it| it.distance(middle));
            let reach = away.fold(0.0, f64::max);
            if region.covers(middle, reach) {
                region.work(1)?;
            } else if reach <= region.near {
                region.add(middle)?;
            } else {
                open.extend(halves(corners));
                region.work(1)?;
            }
        }
        Ok(())
    }
}

/// Adds points of the image of a round primitive. A box about it is halved along the side that is mapped to the longest,
/// until the point of the primitive that is nearest to its centre covers the part of the primitive in the box.
fn add_round(region: &mut Region<'_, DVec3>, round: Round, map: &DAffine3) -> Result<(), TooMany> {
    let low = match round {
        Round::Ball => DVec3::NEG_ONE,
        _ => DVec3::new(-1.0, 0.0, -1.0),
    };
    let linear = map.matrix3;
    let lengths = DVec3::new(
        linear.x_axis.length(),
        linear.y_axis.length(),
        linear.z_axis.length(),
    );
    let mut open = vec![(low.midpoint(DVec3::ONE), (DVec3::ONE - low) / 2.0)];
    while let Some((middle, half)) = open.pop() {
        let nearest = nearest(round, middle);
        if nearest.distance(middle) > half.length() {
            region.work(1)?;
            continue;
        }
        let sides = half * lengths;
        let reach = sides.element_sum();
        if reach + (linear * (nearest - middle)).length() <= region.near {
            region.add(map.transform_point3(nearest))?;
            continue;
        }
        let axis = [DVec3::X, DVec3::Y, DVec3::Z][sides.max_position()];
        let step = axis * (half * axis).element_sum() / 2.0;
        open.extend([middle - step, middle + step].map(|middle| (middle, half - step)));
        region.work(1)?;
    }
    Ok(())
}

/// Returns the point of a round primitive that is nearest to a point.
fn nearest(round: Round, point: DVec3) -> DVec3 {
    let away = (point.x * point.x + point.z * point.z).sqrt();
    let (away_then, height) = match round {
        Round::Ball => return point / point.length().max(1.0),
        Round::Cone if point.y > 0.0 && away + point.y <= 1.0 => return point,
        Round::Cone => {
            // On the side, from the apex to the rim, or on the base.
            let along = ((away - point.y + 1.0) / 2.0).clamp(0.0, 1.0);
            let side = DVec2::new(along, 1.0 - along);
            let base = DVec2::new(away.min(1.0), 0.0);
            let own = DVec2::new(away, point.y);
            let is_base = base.distance_squared(own) < side.distance_squared(own);
            let nearest = if is_base { base } else { side };
            (nearest.x, nearest.y)
        }
        _ => (away.min(1.0), point.y.clamp(0.0, 1.0)),
    };
    let turn = if away > 0.0 { away_then / away } else { 0.0 };
    DVec3::new(point.x * turn, height, point.z * turn)
}

/// Returns simplices, which may be flat, whose union is a convex polyhedron.
fn simplices(solid: &Solid) -> Vec<[DVec3; 4]> {
    let corners = solid.corners();
    let (Some(&first), Some(&last)) = (corners.first(), corners.last()) else {
        return Vec::new();
    };
    let faces = solid.polygons();
    if faces.is_empty() {
        return vec![[first, first, last, last]];
    }
    #[expect(clippy::cast_precision_loss, reason = "there are few corners")]
    let centre = corners.iter().sum::<DVec3>() / corners.len() as f64;
    let of_face = |face: &Vec<DVec3>| {
        let pairs = face.windows(2).skip(1);
        let pieces = pairs.map(|pair| [centre, face[0], pair[0], pair[1]]);
        pieces.collect::<Vec<_>>()
    };
    faces.iter().flat_map(of_face).collect()
}

/// Halves a simplex at its longest edge.
fn halves(corners: [DVec3; 4]) -> [[DVec3; 4]; 2] {
    let mut longest = (0, 1);
    for from in 0..4 {
        for to in from + 1..4 {
            let length = |(from, to): (usize, usize)| corners[from].distance_squared(corners[to]);
            if length((from, to)) > length(longest) {
                longest = (from, to);
            }
        }
    }
    let middle = corners[longest.0].midpoint(corners[longest.1]);
    let (mut one, mut other) = (corners, corners);
    one[longest.0] = middle;
    other[longest.1] = middle;
    [one, other]
}

/// Balls of one radius about points, by cells of a grid of that side.
struct CoveredBalls {
    corner: DVec3,
    radius: f64,
    centres: Vec<DVec3>,
    /// Number of the last centre in each cell, whose coordinates are packed.
    last: FastMap<u64, u32>,
    /// Number of the centre before each in its cell.
    before: Vec<Option<u32>>,
}

impl CoveredBalls {
    /// Number of bits of a coordinate of a cell. Cells beyond are one with the last ones.
    const BITS: u32 = 21;

    fn new(corner: DVec3, radius: f64) -> Self {
        Self {
            corner: corner - radius,
            radius,
            centres: Vec::new(),
            last: FastMap::default(),
            before: Vec::new(),
        }
    }

    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "casts from floats saturate"
    )]
    fn cell(&self, point: DVec3) -> [u64; 3] {
        let cell = (point - self.corner) / self.radius;
        cell.to_array()
            .map(|it| (it as u64).min((1 << Self::BITS) - 1))
    }

    fn key([x, y, z]: [u64; 3]) -> u64 {
        ((z << Self::BITS | y) << Self::BITS) | x
    }
}

impl Covered<DVec3> for CoveredBalls {
    fn has(&self, middle: DVec3, radius: f64) -> bool {
        let spare = self.radius - radius;
        if spare.is_nan() || spare < 0.0 {
            return false;
        }
        // The centres of balls that hold this one are within the spare length.
        let low = self.cell(middle - DVec3::splat(spare));
        let high = self.cell(middle + DVec3::splat(spare));
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for z in low[2]..=high[2] {
                    let mut next = self.last.get(&Self::key([x, y, z])).copied();
                    while let Some(number) = next {
                        let centre = self.centres[number as usize];
                        if centre.distance_squared(middle) <= spare * spare {
                            return true;
                        }
                        next = self.before[number as usize];
                    }
                }
            }
        }
        false
    }

    fn add(&mut self, middle: DVec3, _radius: f64) {
        let Ok(number) = u32::try_from(self.centres.len()) else {
            return;
        };
        let key = Self::key(self.cell(middle));
        let before = self.last.insert(key, number);
        self.centres.push(middle);
        self.before.push(before);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the points that cover a solid.
    fn cover(solid: &Solid, radius: f64) -> Vec<DVec3> {
        let mut points = Vec::new();
        let mut visit = |point| points.push(point);
        let covered = Frame3::covered(&solid.bounds(&DAffine3::IDENTITY), radius);
        let mut region = Region::new(covered, radius, 1_000_000, &mut visit);
        let added = Frame3::add_outline(&mut region, solid, &DAffine3::IDENTITY);
        assert_eq!(added, Ok(()));
        points
    }

    #[test]
    fn covers_lie_in_solids_and_reach_all_of_them() {
        const RADIUS: f64 = 0.2;
        let tall = DAffine3::from_scale(DVec3::new(0.3, 2.0, 0.3));
        let solids = [
            Solid::cuboid(&Bounds::new(DVec3::ZERO, DVec3::new(1.0, 2.0, 0.5))),
            Solid::hull(&[DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z]),
            Solid::hull(&[DVec3::ZERO, DVec3::X, DVec3::Y]),
            Solid::hull(&[DVec3::ZERO, DVec3::ONE]),
            Solid::round(Round::Ball, DAffine3::IDENTITY),
            Solid::round(Round::Cylinder, tall),
            Solid::round(Round::Cone, tall),
        ];
        for solid in solids {
            let points = cover(&solid, RADIUS);
            // The support functions of the points and of the solid agree to within the radius.
            for turn in 1..200 {
                let [a, b, c] = [0.7, 1.3, 2.1].map(|by| libm::sin(by * f64::from(turn)));
                let along = DVec3::new(a, b, c).normalize();
                let far = points.iter().map(|point| point.dot(along));
                let far = far.fold(f64::NEG_INFINITY, f64::max);
                let reach = crate::geometry::Outline::support(&solid, along);
                assert!(far <= reach + 1e-12 && far >= reach - RADIUS, "{solid:?}");
            }
        }
        // Inside, too.
        let ball = cover(&Solid::round(Round::Ball, DAffine3::IDENTITY), RADIUS);
        let origin = ball.iter().map(|point| point.length());
        assert!(origin.fold(1.0, f64::min) <= RADIUS);
    }
}
