//! Systems of affine maps with weights, as data sets draw, vary and label them.

use crate::chaos::{Game, Histogram, HistogramWindow, RandomPoints, Start, WeightedMaps, play};
use crate::document::Fit;
use crate::geometry::{Bounds, DAffine2, DVec2};
use crate::ifs::{self, Definition, Ifs};

use super::extent::attractor_box;

/// Number of points from which the box is estimated where not every map contracts clearly.
const PILOT: usize = 20_000;

/// Margin in pixels, which keeps points on the edge of the box inside the picture.
const EDGE: f64 = 1.0 / 32.0;

/// Largest coordinate of an attractor; what lies beyond counts as diverging.
const FARTHEST: f64 = 1e9;

/// A map and its weight: x' = a x + b y + e, y' = c x + d y + f.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct WeightedMap {
    /// The map.
    pub map: DAffine2,
    /// Probability with which it is applied, relative to those of the others.
    pub weight: f64,
}

impl WeightedMap {
    /// Creates a map of a given weight.
    #[must_use]
    pub fn new(map: DAffine2, weight: f64) -> Self {
        Self { map, weight }
    }

    /// Returns a, b, c, d, e, f and the weight.
    #[must_use]
    pub fn row(&self) -> [f64; 7] {
        let [a, c, b, d, e, f] = self.map.to_cols_array();
        [a, b, c, d, e, f, self.weight]
    }

    /// Creates a map from a, b, c, d, e, f and the weight.
    #[must_use]
    pub fn of_row([a, b, c, d, e, f, weight]: [f64; 7]) -> Self {
        Self::new(DAffine2::from_cols_array(&[a, c, b, d, e, f]), weight)
    }
}

/// Gives maps weights in proportion to their determinants, or equal ones if all determinants are 0.
pub(super) fn weighted(maps: Vec<DAffine2>) -> Vec<WeightedMap> {
    let areas: Vec<f64> = { maps.iter() }
        .map(|map| map.matrix2.determinant().abs())
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
pub(super) struct Attractor {
    system: WeightedMaps,
    bounds: Bounds,
}

impl Attractor {
    /// Prepares a system; `None` if its walks diverge, or have no point to start from.
    pub(super) fn of(maps: &[WeightedMap]) -> Option<Self> {
        let affine: Vec<DAffine2> = maps.iter().map(|map| map.map).collect();
        if !affine.iter().all(|map| map.is_finite()) {
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
        let bounds = attractor_box(&affine).unwrap_or_else(|| {
            let mut bounds = Bounds::EMPTY;
            for point in RandomPoints::new(&system, &Start::Attractor, 0).take(PILOT) {
                bounds.add(point.place);
            }
            bounds
        });
        let far = bounds.min().abs().max(bounds.max().abs()).max_element();
        (bounds.is_finite() && far < FARTHEST).then_some(Self { system, bounds })
    }

    /// Counts points in a square of `size` pixels.
    pub(super) fn histogram(&self, size: u32, fit: Fit, game: &Game<'_>) -> Option<Histogram> {
        let room = f64::from(size) - 2.0 * EDGE;
        let extent = self.bounds.size();
        // A set without extent lies in the middle.
        let scale = |extent: f64| if extent > 0.0 { room / extent } else { 1.0 };
        let scale = match fit {
            Fit::Box => DVec2::new(scale(extent.x), scale(extent.y)),
            Fit::Shape => DVec2::splat(scale(extent.max_element())),
        };
        let scale = DVec2::new(scale.x, -scale.y);
        let middle = DVec2::splat(f64::from(size) / 2.0);
        let to_pixels = DAffine2 {
            matrix2: crate::geometry::DMat2::from_diagonal(scale),
            translation: middle - scale * self.bounds.centre(),
        };
        let window = HistogramWindow {
            to_pixels,
            size: [size; 2],
        };
        play(&self.system, &window, game).ok()
    }
}
