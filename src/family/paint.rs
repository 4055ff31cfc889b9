//! Colours of maps.

use super::{ParameterMap, PlaneValue, Property};
use crate::render::Pixels;
use crate::style::{Colour, Palette};

/// Colours of the values that are no numbers.
const COLOURS: [(PlaneValue, Colour); 6] = [
    (PlaneValue::NotCertified, Colour::of_rgba([12, 12, 20, 255])),
    (PlaneValue::Connected, Colour::of_rgba([36, 36, 56, 255])),
    (PlaneValue::Undecided, Colour::of_rgba([220, 40, 120, 255])),
    (
        PlaneValue::NotSimilar,
        Colour::of_rgba([120, 120, 120, 255]),
    ),
    (
        PlaneValue::DoesNotContract,
        Colour::of_rgba([236, 236, 240, 255]),
    ),
    (PlaneValue::NoSystem, Colour::of_rgba([255, 255, 255, 255])),
];

/// Legend of a map.
#[derive(Clone, Debug, PartialEq)]
pub struct Legend {
    /// Least and largest number; `None` if there are no numbers. [`ParameterMap::pixels`] states which numbers the ends of
    /// the palette are.
    pub range: Option<[f64; 2]>,
    /// Number of pixels that are numbers.
    pub numbers: u64,
    /// Other values that occur.
    pub others: Vec<LegendEntry>,
}

/// Value that is no number, in a legend.
#[derive(Clone, Debug, PartialEq)]
pub struct LegendEntry {
    /// The value.
    pub value: PlaneValue,
    /// Its colour.
    pub colour: Colour,
    /// Number of pixels.
    pub count: u64,
}

impl ParameterMap {
    /// Returns the legend.
    #[must_use]
    pub fn legend(&self) -> Legend {
        let (mut range, mut numbers) = ([f64::INFINITY, f64::NEG_INFINITY], 0);
        let mut counts = [0; COLOURS.len()];
        for value in &self.values {
            match value.number() {
                Some(number) => {
                    range = [range[0].min(number), range[1].max(number)];
                    numbers += 1;
                }
                None => counts[place(*value)] += 1,
            }
        }
        let others = COLOURS.iter().zip(counts).filter(|(_, count)| *count > 0);
        Legend {
            range: (numbers > 0).then_some(range),
            numbers,
            others: others
                .map(|((value, colour), count)| LegendEntry {
                    value: *value,
                    colour: *colour,
                    count,
                })
                .collect(),
        }
    }

    /// Draws the map, with a palette for numbers: evenly from the least dimension to the largest, or to 2 if it is larger;
    /// by logarithms from the least area to the largest, and from 1 map to the depth.
    #[must_use]
    pub fn pixels(&self, palette: &Palette) -> Pixels {
        let range = self.legend().range.unwrap_or([1.0; 2]);
        let range = match self.property {
            Property::Connected => [1.0, f64::from(self.depth)],
            Property::Dimension => [range[0].min(2.0), range[1].min(2.0)],
            Property::Area => range,
        };
        let scale = |value: f64| match self.property {
            Property::Dimension => value,
            // A point covers no area.
            Property::Connected | Property::Area => libm::log(value.max(f64::MIN_POSITIVE)),
        };
        let [low, high] = range.map(scale);
        let width = (high - low).max(f64::MIN_POSITIVE);
        let colour = |value: &PlaneValue| match value.number() {
            Some(number) => palette.at((scale(number) - low) / width),
            None => COLOURS[place(*value)].1,
        };
        let bytes = { self.values.iter() }
            .flat_map(|value| colour(value).opaque().rgba())
            .collect();
        Pixels::opaque(self.plane.size(), bytes)
    }
}

/// Returns the place of a value that is no number in the list of colours.
fn place(value: PlaneValue) -> usize {
    let found = COLOURS.iter().position(|(own, _)| *own == value);
    found.unwrap_or_default()
}
