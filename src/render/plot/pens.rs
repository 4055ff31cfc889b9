//! Assignment of colours to pens, by clustering.

use std::num::NonZero;

use crate::style::Colour;

/// Number of pens of a plot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Pens {
    /// One pen for each colour if there are at most [`Pens::FEW`], otherwise one for all.
    #[default]
    Few,
    /// One pen for each colour.
    Each,
    /// At most this many pens: similar colours share one.
    AtMost(NonZero<usize>),
}

impl Pens {
    /// Largest number of colours that have their own pens by default.
    pub const FEW: usize = 8;

    /// Returns the maximum number of pens for a number of colours.
    fn most(self, colours: usize) -> usize {
        match self {
            Self::Few if colours > Self::FEW => 1,
            Self::Few | Self::Each => colours,
            Self::AtMost(most) => most.get(),
        }
    }
}

/// Number of colours above which only neighbours in the list are compared.
const MAX_COMPARED: usize = 256;

/// Colours that share a pen.
#[derive(Clone)]
struct PenColours {
    /// Numbers of the colours, in order.
    members: Vec<usize>,
    /// Amount that the colours draw; their mean, weighted by it, in Oklab.
    weight: f64,
    mean: [f64; 3],
}

impl PenColours {
    /// Returns the cost of merging two clusters: the increase of the sum of squared distances from the mean
    /// (Ward 1963).
    fn cost(&self, other: &Self) -> f64 {
        squared(self.mean, other.mean) * self.weight * other.weight / (self.weight + other.weight)
    }

    fn take(&mut self, other: Self) {
        let weight = self.weight + other.weight;
        let share = other.weight / weight;
        for (mean, theirs) in self.mean.iter_mut().zip(other.mean) {
            *mean += (theirs - *mean) * share;
        }
        self.weight = weight;
        self.members.extend(other.members);
        self.members.sort_unstable();
    }
}

/// Assigns colours, each with the amount it draws, to pens. Returns the colour of each pen, which is the
/// member nearest to the mean, and the numbers of its members. Pens are in the order of their first members.
pub(super) fn shared(colours: &[(Colour, u64)], pens: Pens) -> Vec<(Colour, Vec<usize>)> {
    let most = pens.most(colours.len());
    let numbered = colours.iter().enumerate();
    let mut groups: Vec<_> = numbered
        .map(|(number, &(colour, weight))| PenColours {
            members: vec![number],
            #[expect(clippy::cast_precision_loss, reason = "a weight needs few digits")]
            weight: weight.max(1) as f64,
            mean: oklab(colour),
        })
        .collect();
    while groups.len() > most {
        let reach = if groups.len() > MAX_COMPARED {
            1
        } else {
            groups.len()
        };
        let pairs = (0..groups.len()).flat_map(|first| {
            let others = first + 1..groups.len().min(first + 1 + reach);
            others.map(move |second| (first, second))
        });
        let cost = |&(first, second): &(usize, usize)| groups[first].cost(&groups[second]);
        let Some((first, second)) = pairs.min_by(|a, b| cost(a).total_cmp(&cost(b))) else {
            break;
        };
        let taken = groups.remove(second);
        groups[first].take(taken);
    }
    groups
        .into_iter()
        .map(|group| {
            let off = |number: usize| squared(oklab(colours[number].0), group.mean);
            let numbers = group.members.iter().copied();
            let nearest = numbers.min_by(|&a, &b| off(a).total_cmp(&off(b)));
            let colour = nearest.map_or(Colour::BLACK, |number| colours[number].0);
            (colour, group.members)
        })
        .collect()
}

fn squared(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}

/// Converts a colour to Oklab: lightness and two opponent axes, with perceptually uniform distances
/// (B. Ottosson 2020, "A perceptual color space for image processing").
fn oklab(colour: Colour) -> [f64; 3] {
    let [red, green, blue, _] = colour.rgba();
    let linear = |value: u8| {
        let value = f64::from(value) / 255.0;
        if value <= 0.04045 {
            value / 12.92
        } else {
            libm::pow((value + 0.055) / 1.055, 2.4)
        }
    };
    let rgb = [red, green, blue].map(linear);
    let times = |rows: [[f64; 3]; 3], by: [f64; 3]| {
        rows.map(|row| row[0] * by[0] + row[1] * by[1] + row[2] * by[2])
    };
    const CONES: [[f64; 3]; 3] = [
        [0.412_221_470_8, 0.536_332_536_3, 0.051_445_992_9],
        [0.211_903_498_2, 0.680_699_545_1, 0.107_396_956_6],
        [0.088_302_461_9, 0.281_718_837_6, 0.629_978_700_5],
    ];
    const LAB: [[f64; 3]; 3] = [
        [0.210_454_255_3, 0.793_617_785_0, -0.004_072_046_8],
        [1.977_998_495_1, -2.428_592_205_0, 0.450_593_709_9],
        [0.025_904_037_1, 0.782_771_766_2, -0.808_675_766_0],
    ];
    times(LAB, times(CONES, rgb).map(libm::cbrt))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::style::Palette;

    fn along(palette: &str, count: usize) -> Vec<(Colour, u64)> {
        let palette = Palette::named(palette).unwrap();
        #[expect(clippy::cast_precision_loss, reason = "few colours")]
        let place = |number: usize| number as f64 / (count - 1) as f64;
        let colours = (0..count).map(|number| (palette.at(place(number)), 100));
        colours.collect()
    }

    #[test]
    fn pens_follow_a_palette() {
        for palette in ["viridis", "sunset", "magma", "earth-to-leaf"] {
            let colours = along(palette, 64);
            for most in [1, 2, 3, 5, 8, 16] {
                let pens = Pens::AtMost(NonZero::new(most).unwrap());
                let shared = shared(&colours, pens);
                assert_eq!(shared.len(), most, "{palette}");
                // The pens partition the palette into intervals, none of which is nearly the whole.
                let order: Vec<_> = shared.iter().flat_map(|pen| pen.1.clone()).collect();
                assert_eq!(order, (0..64).collect::<Vec<_>>(), "{palette} of {most}");
                let largest = shared.iter().map(|pen| pen.1.len()).max().unwrap();
                assert!(largest <= (3 * 64 / most).min(64), "{palette} of {most}");
            }
        }
    }

    #[test]
    fn few_colours_keep_their_pens_and_many_share_one() {
        assert_eq!(shared(&along("viridis", 8), Pens::Few).len(), 8);
        assert_eq!(shared(&along("viridis", 9), Pens::Few).len(), 1);
        assert_eq!(shared(&along("viridis", 64), Pens::Each).len(), 64);
        assert_eq!(shared(&[], Pens::Few), []);
        let reds = ["#f00", "#e00", "#00f", "#f10"].map(|text| (Colour::parse(text).unwrap(), 1));
        let two = shared(&reds, Pens::AtMost(NonZero::new(2).unwrap()));
        let members: Vec<_> = two.iter().map(|pen| pen.1.as_slice()).collect();
        assert_eq!(members, [&[0, 1, 3][..], &[2]]);
        assert_eq!(two[1].0, reds[2].0);
    }

    #[test]
    fn very_many_colours_come_to_an_end() {
        let colours = along("turbo", 3000);
        let shared = shared(&colours, Pens::AtMost(NonZero::new(4).unwrap()));
        assert_eq!(shared.len(), 4);
        assert_eq!(shared.iter().map(|pen| pen.1.len()).sum::<usize>(), 3000);
    }
}
