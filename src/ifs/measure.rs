//! Moments of the invariant measure that random iteration draws: by linear equations, or by iteration for many states.

use super::linear::Equations;
use super::moments::square;
use super::walk::Step;
use super::{Choice, Ifs, Moments};
use crate::geometry::{DAffine2, DMat2, DVec2};

/// Part of the measure: the distribution of the points that one map has just moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapMeasure {
    /// Share of its time that the walk spends in this part.
    pub weight: f64,
    /// Moments of the part alone; `None` if the walk leaves it for ever.
    pub moments: Option<Moments>,
}

/// Moments of the P-balanced measure (Demko, Hodges & Naylor 1985, section 3.1): the share of its time that
/// the walk of random iteration spends in each region.
#[derive(Clone, Debug, PartialEq)]
pub struct Measure {
    /// Moments of the whole measure.
    pub moments: Moments,
    /// Parts of the measure, one for each map.
    pub by_map: Vec<MapMeasure>,
}

/// Number of states of a walk from which its moments are iterated, not solved for: that takes the third power of it.
const MANY: usize = 200;

/// Largest number of states for which equations are solved where iteration does not converge.
const MOST: usize = 400;

/// Largest number of choices of a map that are taken into account together, where moments are iterated.
const MAX_STEPS: usize = 10_000_000;

/// Relative change of moments that counts as none.
const STILL: f64 = 1e-15;

/// Relative excess of a correlation over 1 that counts as rounding.
const ROUNDING: f64 = 1e-9;

impl Ifs {
    /// Returns mean and covariance of the P-balanced measure, from the equations that they solve: without a
    /// digraph the mean is m = Σ p_i (A_i m + t_i), and second moments follow likewise.
    ///
    /// Returns `None` if [there is no unique measure](super::Walk::stationary), if a condensation set has no
    /// moments, or if the second moments are infinite. They are finite where the system contracts, and
    /// wherever the expected square of a product of maps goes to zero. Where the [walk](Ifs::walk) has many states, also `None`
    /// if the moments of its steps hardly converge.
    #[must_use]
    pub fn measure(&self) -> Option<Measure> {
        let walk = self.walk();
        let drawn = self.condensation().iter().map(|set| set.shape.moments());
        let mut flow = Flow {
            maps: self.maps().iter().map(|map| map.affine).collect(),
            drawn: drawn.collect::<Option<_>>()?,
            states: walk.states(),
            stationary: walk.stationary()?,
        };
        // Moments about the mean: those of distant attractors about the origin would lose digits.
        let first = match flow.states.len() > MANY {
            true => flow.moments()?.0,
            false => flow.first_moments()?,
        };
        let centre: DVec2 = first.iter().sum();
        flow.centre(centre);
        let (first, second) = flow.moments()?;
        let mean: DVec2 = first.iter().sum();
        let moments = Moments {
            mean: mean + centre,
            covariance: second.iter().sum::<DMat2>() - square(mean),
        };
        let mut by_map = flow.parts(&first, &second);
        for moments in by_map.iter_mut().filter_map(|part| part.moments.as_mut()) {
            moments.mean += centre;
        }
        Some(Measure { moments, by_map })
    }
}

/// Flow of moments from state to state in a step of the walk. The moments of a state are those of the points
/// that are in it, times its stationary weight.
struct Flow<'a> {
    maps: Vec<DAffine2>,
    drawn: Vec<Moments>,
    states: &'a [Vec<Step>],
    stationary: Vec<f64>,
}

impl Flow<'_> {
    fn steps(&self) -> impl Iterator<Item = (usize, &Step)> {
        let states = self.states.iter().enumerate();
        states.flat_map(|(from, steps)| steps.iter().map(move |step| (from, step)))
    }

    /// Moves the origin of coordinates to a point.
    fn centre(&mut self, centre: DVec2) {
        for map in &mut self.maps {
            map.translation = map.transform_point2(centre) - centre;
        }
        for moments in &mut self.drawn {
            moments.mean -= centre;
        }
    }

    /// Returns the first and the second moments of all states; `None` if they are infinite, or not found.
    fn moments(&self) -> Option<(Vec<DVec2>, Vec<DMat2>)> {
        if self.states.len() > MANY {
            let settled = self.settled();
            if settled.is_some() || self.states.len() > MOST {
                return settled;
            }
        }
        let first = self.first_moments()?;
        let second = self.second_moments(&first)?;
        Some((first, second))
    }

    /// Returns the moments to which those of a walk from the origin converge, step by step.
    fn settled(&self) -> Option<(Vec<DVec2>, Vec<DMat2>)> {
        let origin = vec![(DVec2::ZERO, DMat2::ZERO); self.states.len()];
        let mut known = origin.clone();
        for _ in 0..MAX_STEPS / self.steps().count().max(1) {
            let mut next = origin.clone();
            for (from, step) in self.steps() {
                let (first, second) = known[from];
                let moved = self.moved(step, self.stationary[from], first, second);
                let all = &mut next[step.to];
                all.0 += moved.0;
                all.1 += moved.1;
            }
            let largest = |sizes: &mut dyn Iterator<Item = f64>| sizes.fold(0.0, f64::max);
            let changes = known.iter().zip(&next);
            let changes = [
                largest(&mut changes.clone().map(|(a, b)| (a.0 - b.0).length())),
                largest(&mut changes.map(|(a, b)| size(&(a.1 - b.1)))),
            ];
            let sizes = [
                largest(&mut next.iter().map(|it| it.0.length())),
                largest(&mut next.iter().map(|it| size(&it.1))),
            ];
            known = next;
            let is_finite = |it: &(DVec2, DMat2)| it.0.is_finite() && it.1.is_finite();
            if !known.iter().all(is_finite) {
                return None;
            }
            let mut pairs = changes.iter().zip(sizes);
            if pairs.all(|(change, size)| *change <= STILL * size) {
                return Some(known.into_iter().unzip());
            }
        }
        None
    }

    /// Returns the first moments of all states; `None` if the equations are singular.
    fn first_moments(&self) -> Option<Vec<DVec2>> {
        let mut equations = Equations::new(2 * self.states.len(), 1);
        for row in 0..2 * self.states.len() {
            equations.add(row, row, 1.0);
        }
        for (from, step) in self.steps() {
            let (linear, constant) = match step.choice {
                Choice::Map(map) => (self.maps[map].matrix2, self.maps[map].translation),
                Choice::Condensation(set) => (DMat2::ZERO, self.drawn[set].mean),
            };
            let flow = step.probability * self.stationary[from];
            for row in 0..2 {
                for column in 0..2 {
                    let coefficient = -step.probability * linear.col(column)[row];
                    equations.add(2 * step.to + row, 2 * from + column, coefficient);
                }
                equations.add_constant(2 * step.to + row, 0, flow * constant[row]);
            }
        }
        let solution = equations.solve()?.pop()?;
        Some(solution.chunks_exact(2).map(DVec2::from_slice).collect())
    }

    /// Returns the second moments of all states, computed from the first; `None` if they are infinite.
    ///
    /// A map of positive matrices to positive matrices has a spectral radius below 1 if and only if, with the
    /// identity added, its fixed point is positive. A second right-hand side solves for that fixed point.
    fn second_moments(&self, first: &[DVec2]) -> Option<Vec<DMat2>> {
        let mut equations = Equations::new(3 * self.states.len(), 2);
        for state in 0..self.states.len() {
            for entry in 0..3 {
                equations.add(3 * state + entry, 3 * state + entry, 1.0);
            }
            add_constant(&mut equations, state, 1, DMat2::IDENTITY);
        }
        for (from, step) in self.steps() {
            if let Choice::Map(map) = step.choice {
                let linear = self.maps[map].matrix2;
                for (column, unit) in UNITS.into_iter().enumerate() {
                    let image = linear * unit * linear.transpose() * -step.probability;
                    for (row, coefficient) in entries(image).into_iter().enumerate() {
                        equations.add(3 * step.to + row, 3 * from + column, coefficient);
                    }
                }
            }
            let moved = self.moved(step, self.stationary[from], first[from], DMat2::ZERO);
            add_constant(&mut equations, step.to, 0, moved.1);
        }
        let [second, test] = &equations.solve()?[..] else {
            return None;
        };
        let finite = test.chunks_exact(3).all(|entries| {
            let &[xx, xy, yy] = entries else {
                return false;
            };
            xx > 0.0 && yy > 0.0 && xy * xy <= (1.0 + ROUNDING) * xx * yy
        });
        let matrix = |entries: &[f64]| {
            DMat2::from_cols_array(&[entries[0], entries[1], entries[1], entries[2]])
        };
        finite.then(|| second.chunks_exact(3).map(matrix).collect())
    }

    /// Returns first and second moments of the points that a step moves, given weight and moments of its
    /// state.
    fn moved(&self, step: &Step, weight: f64, first: DVec2, second: DMat2) -> (DVec2, DMat2) {
        let (first, second) = match step.choice {
            Choice::Map(map) => {
                let DAffine2 {
                    matrix2: linear,
                    translation,
                } = self.maps[map];
                let image = linear * first;
                let mixed = outer(image, translation) + outer(translation, image);
                let second = linear * second * linear.transpose() + mixed;
                (
                    image + weight * translation,
                    second + square(translation) * weight,
                )
            }
            Choice::Condensation(set) => {
                let Moments { mean, covariance } = self.drawn[set];
                (weight * mean, (covariance + square(mean)) * weight)
            }
        };
        (step.probability * first, second * step.probability)
    }

    /// Returns the part of every map: weight and moments of the points that it has just moved.
    fn parts(&self, first: &[DVec2], second: &[DMat2]) -> Vec<MapMeasure> {
        let mut sums = vec![(0.0, DVec2::ZERO, DMat2::ZERO); self.maps.len()];
        for (from, step) in self.steps() {
            if let Choice::Map(map) = step.choice {
                let weight = self.stationary[from];
                let moved = self.moved(step, weight, first[from], second[from]);
                sums[map].0 += step.probability * weight;
                sums[map].1 += moved.0;
                sums[map].2 += moved.1;
            }
        }
        let parts = sums.into_iter().map(|(weight, first, second)| MapMeasure {
            weight,
            moments: (weight > 0.0).then(|| Moments {
                mean: first / weight,
                covariance: second * (1.0 / weight) - square(first / weight),
            }),
        });
        parts.collect()
    }
}

/// The symmetric matrices in which one of the entries xx, xy and yy is 1 and the others are 0.
const UNITS: [DMat2; 3] = [
    DMat2::from_cols(DVec2::X, DVec2::ZERO),
    DMat2::from_cols(DVec2::Y, DVec2::X),
    DMat2::from_cols(DVec2::ZERO, DVec2::Y),
];

/// Returns the entries xx, xy and yy of a symmetric matrix.
fn entries(matrix: DMat2) -> [f64; 3] {
    [matrix.x_axis.x, matrix.x_axis.y, matrix.y_axis.y]
}

fn add_constant(equations: &mut Equations, state: usize, side: usize, matrix: DMat2) {
    for (entry, constant) in entries(matrix).into_iter().enumerate() {
        equations.add_constant(3 * state + entry, side, constant);
    }
}

/// Returns the largest entry of a matrix, regardless of signs.
fn size(matrix: &DMat2) -> f64 {
    matrix.x_axis.abs().max(matrix.y_axis.abs()).max_element()
}

/// Returns the matrix v wᵀ.
fn outer(v: DVec2, w: DVec2) -> DMat2 {
    DMat2::from_cols(v * w.x, v * w.y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ifs::{Definition, Edge, Map};

    /// A system of maps each of which may be followed by two others, so that the walk has a state for each.
    fn branching(count: usize) -> Ifs {
        let maps = (0..count).map(|number| {
            let turn = 0.7 * number as f64;
            let shift = DVec2::new(libm::cos(turn), libm::sin(2.0 * turn));
            let scale = DVec2::new(0.6, 0.9);
            let map = DAffine2::from_scale_angle_translation(scale, turn, 100.0 + shift);
            Map::new(map).weighing(1.0 + turn)
        });
        let edge = |from: usize, to: usize| Edge {
            from,
            to: to % count,
            weight: None,
        };
        let edges =
            (0..count).flat_map(|from| [edge(from, 2 * from + 1), edge(from, 2 * from + 2)]);
        let definition = Definition {
            maps: maps.collect(),
            edges: Some(edges.collect()),
            ..Definition::default()
        };
        Ifs::new(definition).unwrap()
    }

    #[test]
    fn iterated_moments_are_those_of_the_equations() {
        let system = branching(7);
        let walk = system.walk();
        let stationary = walk.stationary().unwrap();
        let settled = walk.settled(&[true; 7]).unwrap();
        for (a, b) in stationary.iter().zip(&settled) {
            assert!((a - b).abs() < 1e-13, "{stationary:?} {settled:?}");
        }
        let flow = Flow {
            maps: system.maps().iter().map(|map| map.affine).collect(),
            drawn: Vec::new(),
            states: walk.states(),
            stationary,
        };
        let (first, second) = flow.moments().unwrap();
        let (iterated_first, iterated_second) = flow.settled().unwrap();
        for state in 0..7 {
            let [a, b] = [first[state], iterated_first[state]];
            assert!((a - b).length() < 1e-11 * a.length(), "{a} {b}");
            let [a, b] = [second[state], iterated_second[state]];
            assert!(size(&(a - b)) < 1e-11 * size(&a), "{a} {b}");
        }
    }

    #[test]
    fn moments_of_many_states_are_found() {
        let measure = branching(1200).measure().unwrap();
        let weights: f64 = measure.by_map.iter().map(|part| part.weight).sum();
        assert!((weights - 1.0).abs() < 1e-12, "{weights}");
    }
}
