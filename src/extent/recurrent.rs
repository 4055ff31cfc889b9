//! Support functions of limit sets along directions that recur, by policy iteration.
//!
//! The farthest value h(o, u) = max x·u of the subtree of an object o along a unit vector u is the greatest of
//! t·u + |Lᵀu| h(c, Lᵀu / |Lᵀu|) over the instances c in the place of o, x → Lx + t being their maps. Where maps do not
//! turn, or turn by rational parts of a circle, few pairs (o, u) follow from the directions of the axes; directions that are
//! equal to ten decimals are one. With an instance chosen
//! for each pair, chains of pairs end in cycles, whose values are fixed points; a better choice for any pair yields better
//! values (Howard, "Dynamic Programming and Markov Processes", 1960). The time does not depend on how slowly maps contract.

use crate::fast_hash::FastMap;
use crate::geometry::{Bounds, Frame, Outline, Point};
use crate::graph::{Graph, Instance};

use super::bounded::Bounded;
use super::bounds::ends;
use super::terms::direction_key;

/// Limit of the number of pairs of an object and a direction.
const MAX_PAIRS: usize = 1 << 17;

/// Limit of the number of choices of all pairs.
const MAX_CHOICES: usize = 1 << 20;

/// Limit of the number of improvements of all choices.
const MAX_ROUNDS: usize = 64;

/// Relative improvement of a value that is rounding.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Relative error of fixed points above which they are not used.
const TOLERANCE: f64 = 1e-12;

/// Length relative to the size of the box below which coordinates are zero.
const NOTHING: f64 = 1e-15;

/// Object with a direction.
type Pair = (usize, [i64; 3]);

/// An instance in the place of a pair's object, whose farthest value is shift + factor · (that of a pair).
#[derive(Clone, Copy)]
struct Choice {
    shift: f64,
    /// 0 if the shift is all.
    factor: f64,
    pair: usize,
}

/// Values of pairs in the limit.
pub(super) struct Recurrent {
    /// Objects that are drawn in the limit.
    alive: Vec<bool>,
    numbers: FastMap<Pair, usize>,
    values: Vec<f64>,
}

/// Pairs with their choices.
struct Pairs<P> {
    numbers: FastMap<Pair, usize>,
    all: Vec<(usize, P)>,
    choices: Vec<Choice>,
    /// Number of the first choice of each pair, and of all choices.
    firsts: Vec<usize>,
}

impl Recurrent {
    /// Finds the values of all objects along the axes; `None` if there are too many directions.
    pub(super) fn of<F: Bounded>(graph: &Graph<F>) -> Option<Self> {
        if !graph.is_plain() || !graph.is_regular() || graph.resets().contains(&true) {
            return None;
        }
        let alive = graph.alive(true);
        let pairs = Pairs::of(graph, &alive)?;
        let values = pairs.values()?;
        Some(Self {
            alive,
            numbers: pairs.numbers,
            values,
        })
    }

    /// Returns the bounding box of the limit set that begins with some instances; `None` if their directions are unknown.
    pub(super) fn box_of<F: Frame>(&self, start: &[Instance<F>]) -> Option<Bounds<F::Point>> {
        let [max, min] = ends(|axis: F::Point| {
            let mut farthest = f64::NEG_INFINITY;
            for instance in start.iter().filter(|it| self.alive[it.object]) {
                let vector = instance.frame.pullback(axis);
                let pair = self
                    .numbers
                    .get(&(instance.object, direction_key(vector)))?;
                let shift = axis.dot(instance.frame.origin());
                farthest = farthest.max(shift + vector.length() * self.values[*pair]);
            }
            Some(farthest)
        })?;
        let nothing = NOTHING * min.abs().max(max.abs()).max_element();
        let rounded = |value: f64| if value.abs() <= nothing { 0.0 } else { value };
        let bounds = Bounds::new(min.map(rounded), max.map(rounded));
        bounds.is_finite().then_some(bounds)
    }
}

impl<P: Point> Pairs<P> {
    /// Finds the pairs that follow from the objects that are drawn along the axes.
    fn of<F: Bounded + Frame<Point = P>>(graph: &Graph<F>, alive: &[bool]) -> Option<Self> {
        let count = alive.iter().filter(|alive| **alive).count();
        if count.saturating_mul(P::AXES.len()) > MAX_PAIRS {
            return None;
        }
        let mut pairs = Self {
            numbers: FastMap::default(),
            all: Vec::new(),
            choices: Vec::new(),
            firsts: Vec::new(),
        };
        for object in (0..alive.len()).filter(|object| alive[*object]) {
            P::AXES.iter().for_each(|axis| {
                pairs.number(object, *axis);
            });
        }
        while let Some((number, direction)) = pairs.all.get(pairs.firsts.len()).copied() {
            pairs.firsts.push(pairs.choices.len());
            let object = &graph.objects()[number];
            if object.is_kept() && object.visible {
                let own = graph.base_elements()[object.base_element].support(direction);
                pairs.add(own, 0.0, 0);
            }
            let successor = object.successor().into_iter();
            for (_, instance) in successor.flat_map(|it| it.placed_instances()) {
                if !alive[instance.object] {
                    continue;
                }
                let shift = direction.dot(instance.frame.origin());
                let vector = instance.frame.pullback(direction);
                let length = vector.length();
                if !length.is_finite() {
                    return None;
                }
                let pair = match length > 0.0 {
                    true => pairs.number(instance.object, vector / length),
                    false => 0,
                };
                pairs.add(shift, length, pair);
            }
            let is_much = pairs.all.len() > MAX_PAIRS || pairs.choices.len() > MAX_CHOICES;
            if is_much || pairs.choices.len() == pairs.firsts[pairs.firsts.len() - 1] {
                return None;
            }
        }
        pairs.firsts.push(pairs.choices.len());
        Some(pairs)
    }

    /// Returns the number of a pair.
    fn number(&mut self, object: usize, direction: P) -> usize {
        let next = self.all.len();
        let pair = (object, direction_key(direction));
        let number = *self.numbers.entry(pair).or_insert(next);
        if number == next {
            self.all.push((object, direction));
        }
        number
    }

    fn add(&mut self, shift: f64, factor: f64, pair: usize) {
        self.choices.push(Choice {
            shift,
            factor,
            pair,
        });
    }

    /// Returns the greatest values of all pairs; `None` if they are not found, or not finite.
    fn values(&self) -> Option<Vec<f64>> {
        let of = |pair: usize| &self.choices[self.firsts[pair]..self.firsts[pair + 1]];
        let farthest = |choices: &[Choice]| {
            let order = |a: &&Choice, b: &&Choice| a.shift.total_cmp(&b.shift);
            choices.iter().max_by(order).copied()
        };
        let mut chosen: Vec<Choice> = { 0..self.all.len() }
            .map(|pair| farthest(of(pair)))
            .collect::<Option<_>>()?;
        for _ in 0..MAX_ROUNDS {
            let values = values_of(&chosen)?;
            let mut is_best = true;
            for (pair, chosen) in chosen.iter_mut().enumerate() {
                let value = |choice: &Choice| choice.shift + choice.factor * values[choice.pair];
                // Around a cycle, values differ by rounding from those of their choices.
                let mut most = values[pair].max(value(chosen));
                for choice in of(pair) {
                    let value = value(choice);
                    if value - most > ROUNDING * (most.abs() + choice.shift.abs()) {
                        (most, *chosen) = (value, *choice);
                        is_best = false;
                    }
                }
            }
            if is_best {
                return values
                    .iter()
                    .all(|value| value.is_finite())
                    .then_some(values);
            }
        }
        None
    }
}

/// Returns the values of all pairs if each has one choice; `None` if a cycle of choices does not contract, or so slowly that
/// rounding shows.
fn values_of(chosen: &[Choice]) -> Option<Vec<f64>> {
    #[derive(Clone, Copy, PartialEq)]
    enum Known {
        Not,
        /// The pair is on the current way, at this place.
        Now(usize),
        Fully,
    }
    let mut values = vec![0.0; chosen.len()];
    let mut known = vec![Known::Not; chosen.len()];
    let mut way = Vec::new();
    for start in 0..chosen.len() {
        let mut at = start;
        while known[at] == Known::Not {
            known[at] = Known::Now(way.len());
            way.push(at);
            if chosen[at].factor > 0.0 {
                at = chosen[at].pair;
            }
        }
        if let Known::Now(first) = known[at] {
            let cycle = way[first..].iter().rev();
            // The rounding of a choice is scaled by the factors of those before it.
            let (shift, factor, error) =
                cycle.fold((0.0, 1.0, 0.0), |(shift, factor, error), pair| {
                    let choice = chosen[*pair];
                    let shift = choice.shift + choice.factor * shift;
                    let error = f64::EPSILON + choice.factor * error;
                    (shift, choice.factor * factor, error)
                });
            if factor >= 1.0 || error > TOLERANCE * (1.0 - factor) {
                return None;
            }
            values[at] = shift / (1.0 - factor);
            known[at] = Known::Fully;
        }
        for pair in way.drain(..).rev() {
            if known[pair] != Known::Fully {
                let choice = chosen[pair];
                values[pair] = choice.shift + choice.factor * values[choice.pair];
                known[pair] = Known::Fully;
            }
        }
    }
    Some(values)
}
