//! Properties of attractors that depend on parameters.

use crate::geometry::{DAffine2, DMat2, stretch};
use crate::ifs::{Connectedness, ConnectednessSearch, covered_area};
use crate::measure::moran_dimension;
use crate::style::Named;

/// Property of an attractor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Property {
    /// Whether the attractor is connected: the number of maps in the compositions by which it is certified to be
    /// disconnected. See [`ConnectednessSearch`].
    Connected,
    /// The similarity dimension: the D with Σ rᴰ = 1 over the ratios of the maps, which are similarities. It is at least
    /// the Hausdorff dimension, and more where images overlap; it may exceed 2.
    Dimension,
    /// An upper bound of the area of the attractor, in squares of the units of the file. See
    /// [`covered_area`](crate::ifs::covered_area()).
    Area,
}

impl Named for Property {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("connected", Self::Connected),
        ("dimension", Self::Dimension),
        ("area", Self::Area),
    ];
}

impl Property {
    /// Returns the default depth: the number of maps in compositions for [`Property::Connected`], the number of divisions
    /// of a square for [`Property::Area`]. The dimension does not depend on it.
    #[must_use]
    pub fn depth(self) -> u32 {
        match self {
            Self::Connected => ConnectednessSearch::DEPTH,
            Self::Dimension => 0,
            Self::Area => 6,
        }
    }
}

/// Value of a property of a member of a family.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlaneValue {
    /// Number of maps in compositions, dimension, or area.
    Number(f64),
    /// The attractor is connected.
    Connected,
    /// The attractor is not certified to be disconnected.
    NotCertified,
    /// The search has exceeded its budget, or no disc about the attractor was found.
    Undecided,
    /// A map is no similarity, so that there is no similarity dimension.
    NotSimilar,
    /// The system does not contract.
    DoesNotContract,
    /// The file admits no system with these values.
    NoSystem,
}

impl PlaneValue {
    /// The values that are no numbers, with their names.
    pub(super) const NAMES: [(&'static str, Self); 6] = [
        ("not-certified", Self::NotCertified),
        ("connected", Self::Connected),
        ("undecided", Self::Undecided),
        ("no-similarity", Self::NotSimilar),
        ("does-not-contract", Self::DoesNotContract),
        ("no-system", Self::NoSystem),
    ];

    /// Returns the number.
    #[must_use]
    pub fn number(self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(number),
            _ => None,
        }
    }

    /// Returns the name of a value that is no number.
    #[must_use]
    pub fn name(self) -> Option<&'static str> {
        let named = Self::NAMES.iter().find(|(_, value)| *value == self);
        named.map(|(name, _)| *name)
    }
}

impl std::fmt::Display for PlaneValue {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match (self.number(), self.name()) {
            (Some(number), _) => number.fmt(f),
            (None, name) => f.write_str(name.unwrap_or_default()),
        }
    }
}

impl From<Connectedness> for PlaneValue {
    fn from(connectedness: Connectedness) -> Self {
        match connectedness {
            Connectedness::Disconnected(depth) => Self::Number(depth.into()),
            Connectedness::Connected => Self::Connected,
            Connectedness::NotCertified => Self::NotCertified,
            Connectedness::Undecided => Self::Undecided,
            Connectedness::DoesNotContract => Self::DoesNotContract,
        }
    }
}

/// Evaluator of a property, with its memory.
pub(super) struct Evaluator {
    property: Property,
    depth: u32,
    search: ConnectednessSearch,
    ratios: Vec<f64>,
}

impl Evaluator {
    pub(super) fn new(property: Property, depth: u32) -> Self {
        Self {
            property,
            depth,
            search: ConnectednessSearch::new(depth),
            ratios: Vec::new(),
        }
    }

    /// Returns the value of the property for the attractor of maps.
    pub(super) fn value(&mut self, maps: &[DAffine2]) -> PlaneValue {
        match self.property {
            Property::Connected => self.search.of(maps).into(),
            Property::Dimension => self.dimension(maps),
            Property::Area => match covered_area(maps, self.depth) {
                Ok(area) => PlaneValue::Number(area),
                Err(other) => other.into(),
            },
        }
    }

    fn dimension(&mut self, maps: &[DAffine2]) -> PlaneValue {
        self.ratios.clear();
        for map in maps {
            match ratio(&map.matrix2) {
                Some(ratio) => self.ratios.push(ratio),
                None => return PlaneValue::NotSimilar,
            }
        }
        if !self.ratios.iter().all(|ratio| *ratio < 1.0) {
            return PlaneValue::DoesNotContract;
        }
        PlaneValue::Number(moran_dimension(&self.ratios))
    }
}

/// Returns the ratio of a similarity, 0 for a map to a point; `None` for another map.
fn ratio(linear: &DMat2) -> Option<f64> {
    const ROUNDING: f64 = 1e-12;
    let ratio = stretch(linear);
    let is_similar = linear.determinant().abs() >= (1.0 - ROUNDING) * (ratio * ratio);
    is_similar.then_some(ratio)
}
