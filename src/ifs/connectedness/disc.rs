//! Discs that contain an attractor.

use super::{Budget, Connectedness};
use crate::geometry::{DAffine2, DMat2, DVec2, Linear, stretch};
use crate::ifs::AffineMap;
use crate::ifs::norm::best_coordinates;

/// Stretch above which better coordinates are sought, in which maps shrink more.
const LARGE: f64 = 0.99;

/// Margin of comparisons with 1.
const ROUNDING: f64 = 1e-12;

/// Limit of the number of products of maps.
const MAX_PRODUCTS: usize = 4096;

/// Number of improvements of the centre.
const ROUNDS: u32 = 12;

/// Largest condition number of coordinates.
const MAX_CONDITION: f64 = 1e6;

/// Maps that contract one by one, in coordinates in which they shrink.
#[derive(Clone, Debug)]
pub(in crate::ifs) struct Shrunk {
    pub(super) maps: Vec<DAffine2>,
    /// Stretches of the maps.
    pub(super) stretches: Vec<f64>,
    /// Linear map from the given coordinates to these.
    coordinates: DMat2,
    /// Relative error of the numbers of the maps.
    pub(super) error: f64,
}

impl Shrunk {
    /// Returns the maps in coordinates in which they shrink; the verdict where one does not contract.
    pub(in crate::ifs) fn of(maps: &[DAffine2]) -> Result<Self, Connectedness> {
        let radius = |map: &DAffine2| map.matrix2.spectral_radius();
        // NaN does not contract either.
        if !maps.iter().all(|map| radius(map) < 1.0 - ROUNDING) {
            return Err(Connectedness::DoesNotContract);
        }
        let stretches = |maps: &[DAffine2]| maps.iter().map(|map| stretch(&map.matrix2)).collect();
        let given = Self {
            maps: maps.to_vec(),
            stretches: stretches(maps),
            coordinates: DMat2::IDENTITY,
            error: f64::EPSILON,
        };
        if largest(&given.stretches) <= LARGE {
            return Ok(given);
        }
        let linear: Vec<DMat2> = maps.iter().map(|map| map.matrix2).collect();
        let coordinates = best_coordinates(&linear);
        let there = DAffine2::from_mat2(coordinates);
        let back = there.inverse();
        let condition = stretch(&coordinates) * stretch(&back.matrix2);
        if coordinates == DMat2::IDENTITY || !(1.0..=MAX_CONDITION).contains(&condition) {
            return Ok(given);
        }
        let maps: Vec<DAffine2> = maps.iter().map(|map| there * *map * back).collect();
        Ok(Self {
            stretches: stretches(&maps),
            maps,
            coordinates,
            error: 8.0 * f64::EPSILON * condition,
        })
    }

    /// Returns the largest stretch of a map.
    fn largest(&self) -> f64 {
        largest(&self.stretches)
    }
}

/// Maps in coordinates in which a disc about the origin contains the attractor.
#[derive(Clone, Debug)]
pub(in crate::ifs) struct Centred {
    /// Maps in these coordinates.
    pub(in crate::ifs) maps: Vec<DAffine2>,
    /// Radius of the disc.
    pub(in crate::ifs) radius: f64,
    /// Linear map from the given coordinates to these, apart from a translation.
    pub(in crate::ifs) coordinates: DMat2,
    /// Error of a point that a map moves.
    pub(in crate::ifs) error: f64,
}

impl Centred {
    /// Returns the maps about the centre of a disc; the verdict where there is none.
    pub(in crate::ifs) fn of(shrunk: &Shrunk, budget: &mut Budget) -> Result<Self, Connectedness> {
        let mut maps = shrunk.maps.clone();
        let centre = centre(&maps, &shrunk.stretches);
        let farthest = maps.iter().map(|map| map.translation.length());
        let farthest = farthest.fold(centre.length(), f64::max);
        for map in &mut maps {
            map.translation += map.matrix2 * centre - centre;
        }
        let radius = match shrunk.largest() < 1.0 - ROUNDING {
            true => reach(&maps, &shrunk.stretches),
            false => reach_of_products(&maps, budget)?,
        };
        let error = 8.0 * shrunk.error * (farthest + radius);
        let radius = radius * (1.0 + 1e-9) + error / (1.0 - shrunk.largest()).max(1e-6);
        match radius.is_finite() {
            true => Ok(Self {
                maps,
                radius,
                coordinates: shrunk.coordinates,
                error,
            }),
            false => Err(Connectedness::Undecided),
        }
    }
}

fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().copied().fold(0.0, f64::max)
}

/// Returns the radius of a disc about the origin that all maps map into itself.
fn reach(maps: &[DAffine2], stretches: &[f64]) -> f64 {
    let reaches = maps.iter().zip(stretches);
    let reaches = reaches.map(|(map, stretch)| map.translation.length() / (1.0 - stretch));
    reaches.fold(0.0, f64::max)
}

/// Returns a centre about which the maps reach little: near the centre of the smallest disc about their fixed points
/// (after Bădoiu & Clarkson 2003).
fn centre(maps: &[DAffine2], stretches: &[f64]) -> DVec2 {
    let fixed = maps.iter().map(AffineMap::fixed_point);
    let Some(fixed) = fixed.collect::<Option<Vec<DVec2>>>() else {
        return DVec2::ZERO;
    };
    #[expect(clippy::cast_precision_loss, reason = "there are few maps")]
    let mut centre = fixed.iter().sum::<DVec2>() / fixed.len() as f64;
    if fixed.len() < 3 {
        return centre;
    }
    // The farthest map, with the radius of a disc about a point.
    let farthest = |about: DVec2| {
        let reaches = maps.iter().zip(stretches).map(|(map, stretch)| {
            let moved = map.transform_point2(about) - about;
            moved.length() / (1.0 - stretch).max(ROUNDING)
        });
        let numbered = reaches.enumerate();
        numbered.fold(
            (0, 0.0),
            |most, own| if own.1 > most.1 { own } else { most },
        )
    };
    let (mut map, mut least) = farthest(centre);
    let mut tried = centre;
    for round in 0..ROUNDS {
        tried += (fixed[map] - tried) / f64::from(round + 3);
        let (next, reach) = farthest(tried);
        if reach < least {
            (centre, least) = (tried, reach);
        }
        map = next;
    }
    centre
}

/// Returns the radius of a disc about the origin that contains the attractor, from products of several maps, all of which
/// shrink although single maps do not.
fn reach_of_products(maps: &[DAffine2], budget: &mut Budget) -> Result<f64, Connectedness> {
    let mut products = maps.to_vec();
    while products.len() * maps.len() <= MAX_PRODUCTS && *budget > 0 {
        let longer = products.iter();
        let longer = longer.flat_map(|product| maps.iter().map(move |map| *map * *product));
        products = longer.collect();
        let formed = u32::try_from(products.len()).unwrap_or(u32::MAX);
        *budget = budget.saturating_sub(formed);
        let radius = |product: &DAffine2| product.matrix2.spectral_radius();
        if !products
            .iter()
            .all(|product| radius(product) < 1.0 - ROUNDING)
        {
            return Err(Connectedness::DoesNotContract);
        }
        let stretches = products.iter().map(|product| stretch(&product.matrix2));
        let stretches: Vec<f64> = stretches.collect();
        if largest(&stretches) < 1.0 - ROUNDING {
            return Ok(reach(&products, &stretches));
        }
    }
    Err(Connectedness::Undecided)
}
