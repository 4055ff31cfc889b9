//! Random draws as pure functions of the seed and of an element's path.
//!
//! A path is the position in the initiator, followed at each replacement by the position in the generator
//! as listed. Its representation is a 64-bit hash that takes one mixing step a replacement. A draw
//! therefore does not depend on other draws, on the order of the walk or on the number of steps.
//!
//! A draw may also belong to an edge of the element, which neighbours share (Fournier, Fussell & Carpenter 1982). Edges
//! are known by their ends, and these by how they came to be, never by their coordinates: see [`Corner`].

mod cells;
mod quadrature;

pub(crate) use cells::{Cells, MAX_CELLS, needed};
pub(crate) use quadrature::nodes;

use crate::expression::{Interval, Program};
use crate::random::{self, GOLDEN, Pcg};

/// Hash of a seed and of an element's path, with those of the element's corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Path {
    hash: u64,
    /// Hashes of the first three corners of its surface. Elements that share a corner have equal hashes for it.
    corners: [u32; 3],
}

/// Origin of a corner of a listed element, from which neighbours find that they share it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Corner {
    /// A corner that no other element shares.
    #[default]
    Apart,
    /// The corner of this number, from 0, of the element that is replaced.
    Same(u8),
    /// A point on the edge of this number of the element that is replaced: 0 from corner 0 to corner 1, 1 from there to
    /// corner 2, 2 from there back to corner 0.
    OnEdge(u8),
    /// The point of this number inside the element that is replaced.
    Inside(u16),
}

impl Path {
    /// Returns the empty path for a seed.
    #[must_use]
    pub fn of_seed(seed: u64) -> Self {
        Self {
            hash: mix(seed ^ 0x6b66_7261_635f_7631),
            corners: [0; 3],
        }
    }

    /// Returns the path of the child at a position.
    #[inline]
    #[must_use]
    pub fn child(self, position: u32) -> Self {
        Self {
            hash: mix(self.hash.rotate_left(17) ^ (u64::from(position) + 1).wrapping_mul(GOLDEN)),
            ..self
        }
    }

    /// Returns the path with the corners of a child, which is that at this path but for them.
    #[must_use]
    pub fn with_corners(self, parent: Self, corners: &[Corner; 3]) -> Self {
        let mut number = 0;
        let corners = corners.map(|corner| {
            number += 1;
            match corner {
                Corner::Apart => low(mix(self.hash ^ number)),
                Corner::Same(corner) => parent.corners[usize::from(corner % 3)],
                Corner::OnEdge(edge) => low(parent.edge(edge)),
                Corner::Inside(point) => low(mix(
                    parent.hash ^ (u64::from(point) + 4).wrapping_mul(GOLDEN)
                )),
            }
        });
        Self { corners, ..self }
    }

    /// Returns the hash of an edge, which has no direction.
    fn edge(self, edge: u8) -> u64 {
        let [from, to] = [edge, edge + 1].map(|corner| self.corners[usize::from(corner % 3)]);
        mix(u64::from(from.min(to)) << 32 | u64::from(from.max(to)))
    }

    /// Returns the random number stream of a name at this path.
    pub(crate) fn random(self, name: &str) -> Pcg {
        self.stream(hash_of_name(name), None)
    }

    /// Returns the random number stream of a name at this path, or of one of its edges.
    fn stream(self, name: u64, edge: Option<u8>) -> Pcg {
        let own = edge.map_or(self.hash, |edge| self.edge(edge));
        let high = mix(own ^ name);
        Pcg::new(high, mix(high.wrapping_add(GOLDEN)))
    }
}

#[expect(clippy::cast_possible_truncation, reason = "half of a hash is one")]
fn low(hash: u64) -> u32 {
    hash as u32
}

/// Applies a step of SplitMix64.
fn mix(value: u64) -> u64 {
    random::mix(value.wrapping_add(GOLDEN))
}

/// Returns the FNV-1a hash of a name; it separates the streams of the variables of a path.
fn hash_of_name(name: &str) -> u64 {
    name.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

/// Largest deviation of a normal draw from its mean, in standard deviations: √(−2 ln 2⁻⁵³), because the
/// Box–Muller transform is applied to numbers of 53 bits.
const MAX_DEVIATIONS: f64 = 8.572;

/// Returns the probability of an interval, in standard deviations from the mean, under the normal
/// distribution.
fn normal(interval: Interval) -> f64 {
    let beyond = |deviations: f64| libm::erfc(deviations / std::f64::consts::SQRT_2) / 2.0;
    let Interval { low, high } = interval;
    // The difference of the smaller tails avoids cancellation far from the mean.
    if low + high < 0.0 {
        beyond(-high) - beyond(-low)
    } else {
        beyond(low) - beyond(high)
    }
}

/// Distribution of a variable of a generator's random function.
#[derive(Clone, Debug, PartialEq)]
pub enum Distribution {
    /// Uniform on the interval from the first limit (included) to the second (excluded).
    Uniform(Program, Program),
    /// Normal, with mean and standard deviation (Box & Muller 1958).
    Normal(Program, Program),
    /// Uniform on a list of values.
    Choice(Vec<Program>),
}

/// Variable that is drawn for every replacement of an element.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    name: String,
    stream: u64,
    /// Edge of the element to which the draw belongs, if it does not belong to the element.
    edge: Option<u8>,
    distribution: Distribution,
}

/// Numbers of the ends of edges, as they follow the name of a draw for each edge.
const EDGES: [&str; 3] = ["_01", "_12", "_20"];

impl Variable {
    /// Creates a variable with a distribution.
    #[must_use]
    pub fn new(name: &str, distribution: Distribution) -> Self {
        Self {
            name: name.into(),
            stream: hash_of_name(name),
            edge: None,
            distribution,
        }
    }

    /// Creates a variable for each edge of an element: `NAME_01`, `NAME_12` and `NAME_20`. Elements that share an edge draw
    /// the same value for it.
    #[must_use]
    pub fn by_edge(name: &str, distribution: &Distribution) -> [Self; 3] {
        let mut edge = 0;
        EDGES.map(|ends| {
            edge += 1;
            Self {
                name: format!("{name}{ends}"),
                stream: hash_of_name(name),
                edge: Some(edge - 1),
                distribution: distribution.clone(),
            }
        })
    }

    /// Returns the variable without its expressions as written.
    pub(crate) fn in_doubles(&self) -> Self {
        let distribution = match &self.distribution {
            Distribution::Uniform(a, b) => Distribution::Uniform(a.in_doubles(), b.in_doubles()),
            Distribution::Normal(a, b) => Distribution::Normal(a.in_doubles(), b.in_doubles()),
            Distribution::Choice(all) => {
                Distribution::Choice(all.iter().map(Program::in_doubles).collect())
            }
        };
        Self {
            distribution,
            ..self.clone()
        }
    }

    /// Returns the edge of the element to which the draw belongs, as of [`Corner::OnEdge`]; `None` if it belongs to the
    /// element.
    #[must_use]
    pub fn edge(&self) -> Option<u8> {
        self.edge
    }

    /// Returns the name by which expressions refer to the variable.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the distribution.
    #[must_use]
    pub fn distribution(&self) -> &Distribution {
        &self.distribution
    }

    /// Returns a representative value: the midpoint of the limits, the mean, or the first choice.
    #[must_use]
    pub fn typical(&self, slots: &[f64]) -> f64 {
        match &self.distribution {
            Distribution::Uniform(low, high) => f64::midpoint(low.eval(slots), high.eval(slots)),
            Distribution::Normal(mean, _) => mean.eval(slots),
            Distribution::Choice(values) => values[0].eval(slots),
        }
    }

    /// Returns the expressions of the distribution.
    pub(super) fn programs(&self) -> Vec<&Program> {
        match &self.distribution {
            Distribution::Uniform(a, b) | Distribution::Normal(a, b) => vec![a, b],
            Distribution::Choice(values) => values.iter().collect(),
        }
    }

    /// Returns the number of values of a choice; `None` for other distributions.
    pub(super) fn choices(&self) -> Option<usize> {
        match &self.distribution {
            Distribution::Choice(values) => Some(values.len()),
            _ => None,
        }
    }

    /// Divides the range of the variable, for slots within the given intervals, into `count` intervals,
    /// each with its probability; the intervals are valid up to rounding.
    ///
    /// The values of a choice are separate intervals if `count` is their number, otherwise one interval.
    #[expect(clippy::cast_precision_loss, reason = "numbers of parts are small")]
    pub(super) fn parts(&self, slots: &[Interval], count: usize) -> Vec<(Interval, f64)> {
        let share = 1.0 / count as f64;
        match &self.distribution {
            Distribution::Uniform(low, high) => {
                let (low, high) = (low.range(slots), high.range(slots));
                let part = |number| {
                    let least = Interval::along(low.low, high.low, number, count);
                    let most = Interval::along(low.high, high.high, number, count);
                    (least.or(most), share)
                };
                (0..count).map(part).collect()
            }
            Distribution::Normal(mean, deviation) => {
                let (mean, deviation) = (mean.range(slots), deviation.range(slots));
                let part = |number| {
                    let part = Interval::new(-MAX_DEVIATIONS, MAX_DEVIATIONS).part(number, count);
                    (mean + deviation * part, normal(part))
                };
                (0..count).map(part).collect()
            }
            Distribution::Choice(values) => {
                let ranges = values.iter().map(|value| value.range(slots));
                if count == values.len() {
                    return ranges.map(|range| (range, share)).collect();
                }
                vec![(ranges.reduce(Interval::or).unwrap_or(Interval::ALL), 1.0)]
            }
        }
    }

    /// Returns the value drawn for a path.
    #[must_use]
    pub fn draw(&self, path: Path, slots: &[f64]) -> f64 {
        let mut stream = path.stream(self.stream, self.edge);
        match &self.distribution {
            Distribution::Uniform(low, high) => {
                let (low, high) = (low.eval(slots), high.eval(slots));
                low + (high - low) * stream.unit()
            }
            Distribution::Normal(mean, deviation) => {
                // 1 − u lies in (0, 1]: its logarithm is finite.
                let radius = (-2.0 * libm::log(1.0 - stream.unit())).sqrt();
                let angle = std::f64::consts::TAU * stream.unit();
                mean.eval(slots) + deviation.eval(slots) * radius * libm::cos(angle)
            }
            Distribution::Choice(values) => {
                values[pick_index(&mut stream, values.len())].eval(slots)
            }
        }
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "a count of list entries, and a floor below it"
)]
fn pick_index(stream: &mut Pcg, count: usize) -> usize {
    ((stream.unit() * count as f64) as usize).min(count - 1)
}

/// Name of the stream for selection at random; names of variables contain no space.
const SELECTION: &str = "the selection";

/// Draws the index of an entry by weight; the weights are not negative and not all zero.
#[must_use]
pub(crate) fn pick_by_weight(path: Path, weights: impl Iterator<Item = f64> + Clone) -> usize {
    let total: f64 = weights.clone().sum();
    let mut left = path.stream(hash_of_name(SELECTION), None).unit() * total;
    let mut last = 0;
    for (index, weight) in weights.enumerate() {
        if weight > 0.0 {
            last = index;
            if left < weight {
                return index;
            }
            left -= weight;
        }
    }
    last
}

#[cfg(test)]
mod tests {
    use super::*;

    fn program(value: f64) -> Program {
        Program::constant(value)
    }

    fn draws(distribution: Distribution) -> Vec<f64> {
        let variable = Variable::new("tilt", distribution);
        let root = Path::of_seed(7).child(0);
        (0..4)
            .map(|position| variable.draw(root.child(position), &[]))
            .collect()
    }

    /// Every random picture depends on the draws: these values must never change.
    #[test]
    fn draws_are_pinned() {
        let uniform = draws(Distribution::Uniform(program(-20.0), program(20.0)));
        assert_eq!(
            uniform,
            [
                -8.373871261423504,
                18.81062091402123,
                12.698145780350046,
                -6.764760681728541
            ]
        );
        let normal = draws(Distribution::Normal(program(0.0), program(1.0)));
        assert_eq!(
            normal,
            [
                0.292350687707011,
                -2.1359064076414533,
                1.2582490307144698,
                0.1277267213301893
            ]
        );
        let choice = draws(Distribution::Choice(vec![
            program(1.0),
            program(2.0),
            program(3.0),
        ]));
        assert_eq!(choice, [1.0, 3.0, 3.0, 1.0]);
        let root = Path::of_seed(7).child(0);
        let picks: Vec<_> = (0..24)
            .map(|p| pick_by_weight(root.child(p), [3.0, 0.0, 1.0].into_iter()))
            .collect();
        assert_eq!(
            picks,
            [
                0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 2, 2, 0
            ]
        );
    }

    #[test]
    fn typical_values_are_in_the_middle() {
        let typical = |distribution| Variable::new("x", distribution).typical(&[]);
        assert_eq!(
            typical(Distribution::Uniform(program(2.0), program(5.0))),
            3.5
        );
        assert_eq!(
            typical(Distribution::Normal(program(1.0), program(9.0))),
            1.0
        );
        let choice = Distribution::Choice(vec![program(7.0), program(1.0)]);
        assert_eq!(typical(choice), 7.0);
    }

    /// Compares means and variances of many draws with those of the distributions, within four standard
    /// errors.
    #[test]
    fn draws_are_distributed_as_they_say() {
        let count = 40_000u32;
        let sample = |distribution: Distribution| -> (f64, f64) {
            let variable = Variable::new("x", distribution);
            let path = Path::of_seed(0);
            let values: Vec<_> = (0..count)
                .map(|position| variable.draw(path.child(position), &[]))
                .collect();
            let mean = values.iter().sum::<f64>() / f64::from(count);
            let square = values
                .iter()
                .map(|value| (value - mean) * (value - mean))
                .sum::<f64>();
            (mean, square / f64::from(count))
        };
        let error = 4.0 / f64::from(count).sqrt();
        let (mean, variance) = sample(Distribution::Uniform(program(2.0), program(5.0)));
        assert!((mean - 3.5).abs() < error * 0.75f64.sqrt() && (variance - 0.75).abs() < error);
        let (mean, variance) = sample(Distribution::Normal(program(1.0), program(2.0)));
        assert!(
            (mean - 1.0).abs() < error * 2.0 && (variance - 4.0).abs() < error * 4.0 * 2f64.sqrt()
        );
        let (mean, _) = sample(Distribution::Choice(vec![
            program(0.0),
            program(1.0),
            program(5.0),
        ]));
        assert!((mean - 2.0).abs() < error * 2.2);
        let picked = (0..count)
            .filter(|&p| pick_by_weight(Path::of_seed(1).child(p), [3.0, 1.0].into_iter()) == 0)
            .count();
        assert!((picked as f64 / f64::from(count) - 0.75).abs() < error * 0.44);
    }

    /// Different names, positions, depths and seeds have different streams.
    #[test]
    fn streams_are_apart() {
        let mut seen = std::collections::BTreeSet::new();
        for seed in 0..10 {
            for path in [
                Path::of_seed(seed),
                Path::of_seed(seed).child(0),
                Path::of_seed(seed).child(0).child(0),
            ] {
                for position in 0..10 {
                    for name in ["a", "b", "ab"] {
                        assert!(
                            seen.insert(
                                path.child(position).stream(hash_of_name(name), None).bits()
                            )
                        );
                    }
                }
                // The child at 0 of one path is also the start of the next.
                seen.clear();
            }
        }
    }
}
