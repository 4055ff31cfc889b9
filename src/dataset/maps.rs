//! Systems of affine maps with weights, as data sets draw, vary and label them.

use crate::chaos::{
    ChaosMap, DepthWindow, Game, HistogramWindow, RandomPoints, Seen, Start, WeightedMaps, play,
    play_in_space,
};
use crate::document::Framing;
use crate::geometry::{
    Affine, Bounds, DAffine2, DAffine3, DMat2, DMat3, DVec2, DVec3, Linear, Point,
};
use crate::ifs::{self, Definition, Ifs};

use super::extent::attractor_box;

/// Number of points from which the box is estimated where not every map contracts clearly.
const PILOT: usize = 20_000;

/// Margin in pixels, which keeps points on the edge of the box inside the picture.
const EDGE: f64 = 1.0 / 32.0;

/// Largest coordinate of an attractor; what lies beyond counts as diverging.
const FARTHEST: f64 = 1e9;

/// Points that a map takes to others.
type PointOf<M> = <M as Affine>::Point;

/// A map and its weight.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct WeightedMap<M = DAffine2> {
    /// The map.
    pub map: M,
    /// Probability with which it is applied, relative to those of the others.
    pub weight: f64,
}

impl<M> WeightedMap<M> {
    /// Creates a map of a given weight.
    #[must_use]
    pub fn new(map: M, weight: f64) -> Self {
        Self { map, weight }
    }
}

/// Maps of a system.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Maps {
    /// Maps of the plane.
    Plane(Vec<WeightedMap>),
    /// Maps of space.
    Space(Vec<WeightedMap<DAffine3>>),
}

impl Maps {
    /// Returns a row of numbers for each map: the coefficients and the weight.
    ///
    /// In the plane, these are a, b, c, d, e, f of x' = a x + b y + e, y' = c x + d y + f. In space, the matrix comes first, row by
    /// row, and then the image of the origin.
    #[must_use]
    pub fn rows(&self) -> Vec<Vec<f64>> {
        match self {
            Self::Plane(maps) => maps.iter().map(row).collect(),
            Self::Space(maps) => maps.iter().map(row).collect(),
        }
    }
}

/// Returns the coefficients of a map and its weight.
fn row<M: Drawable>(map: &WeightedMap<M>) -> Vec<f64> {
    let mut row = map.map.coefficients();
    row.push(map.weight);
    row
}

/// Maps whose attractors are drawn.
pub(super) trait Drawable: ChaosMap {
    /// Number of coefficients.
    const COEFFICIENTS: usize;

    /// Returns the coefficients: the matrix row by row, and the image of the origin.
    fn coefficients(&self) -> Vec<f64>;

    /// Creates the map of coefficients.
    fn of_coefficients(coefficients: &[f64]) -> Self;

    /// Returns the fixed point.
    fn fixed(&self) -> PointOf<Self>;

    /// Returns the largest factor by which the map lengthens a vector.
    fn largest_factor(&self) -> f64;

    /// Counts the points of an attractor in each pixel of a square, row by row from the top. `scale` is the number of pixels a
    /// unit of x and y in the coordinates of the view.
    fn hits(
        attractor: &Attractor<Self>,
        scale: DVec2,
        size: u32,
        game: &Game<'_, PointOf<Self>>,
    ) -> Option<Vec<u32>>;
}

impl Drawable for DAffine2 {
    const COEFFICIENTS: usize = 6;

    fn coefficients(&self) -> Vec<f64> {
        let [a, c, b, d, e, f] = self.to_cols_array();
        vec![a, b, c, d, e, f]
    }

    fn of_coefficients(coefficients: &[f64]) -> Self {
        let (matrix, shift) = coefficients.split_at(4);
        Self {
            matrix2: DMat2::from_cols_slice(matrix).transpose(),
            translation: DVec2::from_slice(shift),
        }
    }

    fn fixed(&self) -> DVec2 {
        (DMat2::IDENTITY - self.matrix2).inverse() * self.translation
    }

    fn largest_factor(&self) -> f64 {
        let [a, b, c, d] = self.matrix2.to_cols_array();
        let sum = a * a + b * b + c * c + d * d;
        let det = (a * d - b * c).abs();
        ((sum + 2.0 * det).sqrt() + (sum - 2.0 * det).max(0.0).sqrt()) / 2.0
    }

    fn hits(
        attractor: &Attractor<Self>,
        scale: DVec2,
        size: u32,
        game: &Game<'_>,
    ) -> Option<Vec<u32>> {
        let scale = DVec2::new(scale.x, -scale.y);
        let middle = DVec2::splat(f64::from(size) / 2.0);
        let to_pixels = Self {
            matrix2: DMat2::from_diagonal(scale),
            translation: middle - scale * attractor.bounds.centre(),
        };
        let window = HistogramWindow {
            to_pixels,
            size: [size; 2],
        };
        let played = play(&attractor.system, &window, game).ok()?;
        Some(played.counts(0).to_vec())
    }
}

impl Drawable for DAffine3 {
    const COEFFICIENTS: usize = 12;

    fn coefficients(&self) -> Vec<f64> {
        let matrix = self.matrix3.transpose().to_cols_array();
        let shift = self.translation.to_array();
        [matrix.as_slice(), &shift].concat()
    }

    fn of_coefficients(coefficients: &[f64]) -> Self {
        let (matrix, shift) = coefficients.split_at(9);
        Self {
            matrix3: DMat3::from_cols_slice(matrix).transpose(),
            translation: DVec3::from_slice(shift),
        }
    }

    fn fixed(&self) -> DVec3 {
        (DMat3::IDENTITY - self.matrix3).inverse() * self.translation
    }

    fn largest_factor(&self) -> f64 {
        self.linear().stretch()
    }

    fn hits(
        attractor: &Attractor<Self>,
        scale: DVec2,
        size: u32,
        game: &Game<'_, DVec3>,
    ) -> Option<Vec<u32>> {
        let bounds = &attractor.bounds;
        let scale = DVec3::new(scale.x, -scale.y, 1.0);
        let middle = DVec2::splat(f64::from(size) / 2.0).extend(0.0);
        let to_pixels = Self {
            matrix3: DMat3::from_diagonal(scale),
            translation: middle - scale * bounds.centre(),
        };
        let window = DepthWindow {
            to_window: to_pixels * attractor.seen,
            seen: Seen::Parallel,
            // Points count at any depth.
            range: [0.0; 2],
            steps: 1,
            size: [size; 2],
            within: &[],
        };
        let played = play_in_space(&attractor.system, &window, true, game).ok()?;
        Some(played.hits().to_vec())
    }
}

/// Gives maps weights in proportion to their determinants, or equal ones if all determinants are 0.
pub(super) fn weighted<M: Affine>(maps: Vec<M>) -> Vec<WeightedMap<M>> {
    let areas: Vec<f64> = { maps.iter() }
        .map(|map| map.linear().determinant().abs())
        .collect();
    let sum: f64 = areas.iter().sum();
    #[expect(clippy::cast_precision_loss, reason = "there are few maps")]
    let equal = 1.0 / maps.len() as f64;
    let weight = |area: f64| if sum > 0.0 { area / sum } else { equal };
    let areas = areas.into_iter().map(weight);
    maps.into_iter()
        .zip(areas)
        .map(|(map, weight)| WeightedMap { map, weight })
        .collect()
}

/// A system that random iteration draws, with its box.
pub(super) struct Attractor<M: Drawable> {
    system: WeightedMaps<M>,
    /// Map to the coordinates of the view: x to the right, y up, z towards the viewer.
    seen: M,
    /// Box in the coordinates of the view.
    bounds: Bounds<PointOf<M>>,
}

impl<M: Drawable> Attractor<M> {
    /// Prepares a system; `None` if its walks diverge, or have no point to start from. `seen` is a rotation to the coordinates of
    /// the view.
    pub(super) fn of(maps: &[WeightedMap<M>], seen: M) -> Option<Self> {
        let affine: Vec<M> = maps.iter().map(|map| map.map).collect();
        if !affine.iter().all(Affine::is_finite) {
            return None;
        }
        let definition = Definition {
            maps: maps
                .iter()
                .map(|map| ifs::Map::new(map.map).weighing(map.weight))
                .collect(),
            ..Definition::default()
        };
        let system = WeightedMaps::of(&Ifs::new(definition).ok()?).ok()?;
        let bounds = attractor_box(&affine, &seen.linear()).unwrap_or_else(|| {
            let mut bounds = Bounds::EMPTY;
            for point in RandomPoints::new(&system, &Start::Attractor, 0).take(PILOT) {
                bounds.add(seen.apply(point.place));
            }
            bounds
        });
        let far = bounds.min().abs().max(bounds.max().abs()).max_element();
        (bounds.is_finite() && far < FARTHEST).then_some(Self {
            system,
            seen,
            bounds,
        })
    }

    /// Counts points in the pixels of a square, row by row from the top.
    pub(super) fn hits(
        &self,
        size: u32,
        fit: Framing,
        game: &Game<'_, PointOf<M>>,
    ) -> Option<Vec<u32>> {
        let room = f64::from(size) - 2.0 * EDGE;
        let [x, y, _] = self.bounds.size().coordinates();
        // A set without extent lies in the middle.
        let scale = |extent: f64| if extent > 0.0 { room / extent } else { 1.0 };
        let scale = match fit {
            Framing::Box => DVec2::new(scale(x), scale(y)),
            Framing::Shape => DVec2::splat(scale(x.max(y))),
        };
        M::hits(self, scale, size, game)
    }
}
