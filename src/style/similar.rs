//! Similar colours, by clustering.

use super::Colour;

/// Number of colours above which only neighbours in the list are compared.
const MAX_COMPARED: usize = 256;

/// Similar colours.
#[derive(Clone)]
struct Cluster {
    /// Numbers of the colours, in order.
    members: Vec<usize>,
    /// Amount of the colours, and their mean, weighted by it, in Oklab.
    weight: f64,
    mean: [f64; 3],
}

impl Cluster {
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

/// Merges similar colours, each with its amount, until there are `most`. Returns the colour of each cluster, which is the
/// member nearest to the mean, and the numbers of its members. Clusters are in the order of their first members.
pub(crate) fn similar(colours: &[(Colour, u64)], most: usize) -> Vec<(Colour, Vec<usize>)> {
    let numbered = colours.iter().enumerate();
    let mut groups: Vec<_> = numbered
        .map(|(number, &(colour, weight))| Cluster {
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
pub(crate) fn oklab(colour: Colour) -> [f64; 3] {
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
