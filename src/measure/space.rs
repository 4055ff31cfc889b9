//! The plane and space, as far as covers by boxes differ between them.

use std::fmt::Debug;

use glam::DQuat;

use super::statistics::weighted_means;
use crate::geometry::{Affine, DAffine2, DAffine3, DMat2, DMat3, DVec2, DVec3, eigen};

/// Maps of the plane or of space, with what covers by boxes need of either.
pub trait Space: Affine {
    /// Turn of a set against a grid: an angle in radians in the plane, a rotation in space.
    type Turn: Copy + Debug + PartialEq + Send + Sync + 'static;

    /// No turn.
    const ALONG: Self::Turn;

    /// Number of halvings of the extent that lead to the smallest boxes: their coordinates fit in a key of 64 bits,
    /// and so do their counts.
    const LEVELS: u32;

    /// Number of halvings of the extent that lead to the smallest boxes of points: those of a grid that is turned
    /// and begins before the points have keys of 64 bits, too.
    const FINEST_LEVELS: u32;

    /// Number of halvings of the extent that lead to the smallest boxes of a grid that is kept as bits.
    const FILLED_LEVELS: u32;

    /// Numbers of boxes in a row of grids for masses, in the order of trial.
    const FINENESS: &'static [usize];

    /// Whether the boxes along the axes are counted by their states where these are finitely many.
    const COUNTS_STATES: bool;

    /// Returns the turn and the shift of the grid with a number; grids are spread evenly, from the one along the
    /// axes on.
    fn spread(number: f64) -> (Self::Turn, Self::Point);

    /// Returns the linear map of a turn.
    fn rotation(turn: &Self::Turn) -> Self::Linear;

    /// Returns the numbers of boxes along the axes of a cube of boxes, with 1 beyond the dimension.
    fn boxes(side: usize) -> [usize; 3];

    /// Returns the turn that takes the principal axes of points, which have frequencies, to the coordinate axes: the
    /// longest to the first. Axes point towards positive skewness.
    fn principal(points: impl Iterator<Item = (Self::Point, f64)> + Clone) -> Self::Turn;

    /// Returns the turn that a turn follows.
    fn after(turn: &Self::Turn, first: &Self::Turn) -> Self::Turn;
}

/// Relative difference of variances below which there is no principal axis.
const ROUND: f64 = 1e-9;

impl Space for DAffine2 {
    type Turn = f64;

    const ALONG: f64 = 0.0;
    const LEVELS: u32 = 30;
    const FINEST_LEVELS: u32 = 30;
    const FILLED_LEVELS: u32 = 14;
    const FINENESS: &'static [usize] = &[1024, 512, 256, 128];
    const COUNTS_STATES: bool = false;

    fn spread(number: f64) -> (f64, DVec2) {
        // The reciprocals of the positive roots of x² = x + 1 and x³ = x + 1.
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        const PLASTIC: f64 = 0.754_877_666_246_692_7;
        let turn = (number * GOLDEN).fract() * std::f64::consts::FRAC_PI_2;
        let shift = (DVec2::new(PLASTIC, PLASTIC * PLASTIC) * number).fract();
        (turn, shift)
    }

    fn rotation(turn: &f64) -> DMat2 {
        let (sin, cos) = libm::sincos(*turn);
        DMat2::from_cols(DVec2::new(cos, sin), DVec2::new(-sin, cos))
    }

    fn boxes(side: usize) -> [usize; 3] {
        [side, side, 1]
    }

    fn principal(points: impl Iterator<Item = (DVec2, f64)> + Clone) -> f64 {
        let coordinates = points.clone().map(|(at, points)| (at.to_array(), points));
        let middle = DVec2::from_array(weighted_means(coordinates));
        let moments = points.clone().map(|(at, points)| {
            let away = at - middle;
            ([away.x * away.x, away.x * away.y, away.y * away.y], points)
        });
        let [xx, xy, yy] = weighted_means(moments);
        if libm::hypot(xx - yy, 2.0 * xy) <= ROUND * (xx + yy) {
            return 0.0;
        }
        let angle = libm::atan2(2.0 * xy, xx - yy) / 2.0;
        let (sin, cos) = libm::sincos(angle);
        let cubes = points.map(|(at, points)| {
            let along = (at - middle).dot(DVec2::new(cos, sin));
            ([along * along * along], points)
        });
        let [skewness] = weighted_means(cubes);
        if skewness < 0.0 {
            -(angle + std::f64::consts::PI)
        } else {
            -angle
        }
    }

    fn after(turn: &f64, first: &f64) -> f64 {
        turn + first
    }
}

impl Space for DAffine3 {
    type Turn = DMat3;

    const ALONG: DMat3 = DMat3::IDENTITY;
    const LEVELS: u32 = 20;
    const FINEST_LEVELS: u32 = 18;
    const FILLED_LEVELS: u32 = 9;
    const FINENESS: &'static [usize] = &[32, 16];
    const COUNTS_STATES: bool = true;

    /// Spreads rotations evenly (Shoemake 1992), from the identity on.
    fn spread(number: f64) -> (DMat3, DVec3) {
        // The reciprocal of the positive root of x⁷ = x + 1: its powers spread points over six dimensions.
        const ROOT: f64 = 0.898_653_712_628_699_3;
        let mut power = 1.0;
        let parts = [(); 6].map(|()| {
            power *= ROOT;
            (number * power).fract()
        });
        let [share, first, second, shift @ ..] = parts;
        let (scalar, vector) = ((1.0 - share).sqrt(), share.sqrt());
        let [(sin, cos), (x, y)] =
            [first, second].map(|part| libm::sincos(part * std::f64::consts::TAU));
        let turn = DQuat::from_xyzw(vector * x, vector * y, scalar * sin, scalar * cos);
        (DMat3::from_quat(turn), DVec3::from_array(shift))
    }

    fn rotation(turn: &DMat3) -> DMat3 {
        *turn
    }

    fn boxes(side: usize) -> [usize; 3] {
        [side; 3]
    }

    fn principal(points: impl Iterator<Item = (DVec3, f64)> + Clone) -> DMat3 {
        let coordinates = points.clone().map(|(at, points)| (at.to_array(), points));
        let middle = DVec3::from_array(weighted_means(coordinates));
        let moments = points.clone().map(|(at, points)| {
            let [x, y, z] = (at - middle).to_array();
            ([x * x, x * y, x * z, y * y, y * z, z * z], points)
        });
        let [xx, xy, xz, yy, yz, zz] = weighted_means(moments);
        let (values, vectors) = eigen(&DMat3::from_cols(
            DVec3::new(xx, xy, xz),
            DVec3::new(xy, yy, yz),
            DVec3::new(xz, yz, zz),
        ));
        if values.max_element() - values.min_element() <= ROUND * values.max_element() {
            return DMat3::IDENTITY;
        }
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| values[b].total_cmp(&values[a]));
        let axes = [order[0], order[1]].map(|axis| vectors.col(axis));
        let cubes = points.map(|(at, points)| {
            let along = axes.map(|axis| (at - middle).dot(axis));
            (along.map(|along| along * along * along), points)
        });
        let [one, other] = weighted_means(cubes);
        let towards = |axis: DVec3, skewness: f64| if skewness < 0.0 { -axis } else { axis };
        let [first, second] = [towards(axes[0], one), towards(axes[1], other)];
        DMat3::from_cols(first, second, first.cross(second)).transpose()
    }

    fn after(turn: &DMat3, first: &DMat3) -> DMat3 {
        *turn * *first
    }
}
