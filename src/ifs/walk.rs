//! The walk of random iteration as a Markov chain, and its stationary weights.

use super::linear::Equations;
use super::{AffineMap, Ifs, shares};
use crate::digraph::components;
use crate::saturating::real;

/// Number of states from which stationary weights are iterated first: equations take the third power of it.
const MANY: usize = 300;

/// Largest number of states for which equations are solved.
const MOST: usize = 1500;

/// Largest number of steps of the walk that are taken into account together, where weights are iterated.
const MAX_STEPS: usize = 20_000_000;

/// Sum of the changes of weights that counts as none.
const STILL: f64 = 1e-15;

/// Move of the point in a step of the walk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// The point goes to its image under the map with this index.
    Map(usize),
    /// The point is drawn anew, uniformly, from the condensation set with this index.
    Condensation(usize),
}

/// A step that the walk may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Move of the point.
    pub choice: Choice,
    /// Probability of the step, above 0 and at most 1.
    pub probability: f64,
    /// State of the walk after the step.
    pub to: usize,
}

/// The walk of random iteration: states, and the possible steps from each.
///
/// Without a digraph there is only one state. With one, the walk is in state i after map i was applied, and
/// in one more state after the point was drawn from a condensation set, if there are any. The probability of
/// a condensation set is the same in every state: w / W, where w is its weight and W is the sum of all
/// weights of maps and condensation sets. Otherwise an edge is picked by its weight, or after a condensation
/// set a map by its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Walk {
    states: Vec<Vec<Step>>,
}

impl<M: AffineMap> Ifs<M> {
    /// Returns the walk of random iteration.
    #[must_use]
    pub fn walk(&self) -> Walk {
        let maps = self.maps().len();
        let after_condensation = if self.is_recurrent() { maps } else { 0 };
        let mut all = self.weights().to_vec();
        all.extend(self.condensation_weights());
        let all = shares(&all).unwrap_or_default();
        let drawn: Vec<Step> = all[maps..]
            .iter()
            .enumerate()
            .map(|(number, &probability)| Step {
                choice: Choice::Condensation(number),
                probability,
                to: after_condensation,
            })
            .collect();
        let followed: f64 = all[..maps].iter().sum();
        // Steps to these maps by these weights, and to the condensation sets.
        let steps = |weighted: &[(usize, f64)], state: &dyn Fn(usize) -> usize| {
            let weights: Vec<f64> = weighted.iter().map(|&(_, weight)| weight).collect();
            let shares = shares(&weights).unwrap_or_default();
            let followed = weighted.iter().zip(shares).map(|(&(map, _), share)| Step {
                choice: Choice::Map(map),
                probability: share * followed,
                to: state(map),
            });
            followed.chain(drawn.iter().copied()).collect()
        };
        let any: Vec<(usize, f64)> = self.weights().iter().copied().enumerate().collect();
        let Some(edges) = self.edges() else {
            return Walk {
                states: vec![steps(&any, &|_| 0)],
            };
        };
        let mut leaving = vec![Vec::new(); maps];
        for (edge, weight) in edges {
            leaving[edge.from].push((edge.to, weight));
        }
        if !drawn.is_empty() {
            leaving.push(any);
        }
        let states = leaving.iter().map(|weighted| steps(weighted, &|map| map));
        Walk {
            states: states.collect(),
        }
    }
}

impl Walk {
    /// Returns the possible steps from every state; their probabilities add up to 1.
    #[must_use]
    pub fn states(&self) -> &[Vec<Step>] {
        &self.states
    }

    /// Returns the stationary weights: the share of its time that a long walk spends in every state.
    ///
    /// The weights of states that the walk leaves for ever are 0. Returns `None` if there are several parts
    /// of the digraph that the walk cannot leave: its end then depends on its start. Also `None` for more than 1500 states if the
    /// weights of a walk hardly converge.
    #[must_use]
    pub fn stationary(&self) -> Option<Vec<f64>> {
        let size = self.states.len();
        let final_states = self.final_states()?;
        if size > MANY {
            let settled = self.settled(&final_states);
            if settled.is_some() || size > MOST {
                return settled;
            }
        }
        let mut equations = Equations::new(size, 1);
        for (state, steps) in self.states.iter().enumerate() {
            equations.add(state, state, 1.0);
            for step in steps {
                equations.add(step.to, state, -step.probability);
            }
        }
        // One of the equations follows from the others; the sum of all weights replaces it.
        let replaced = final_states.iter().position(|&last| last)?;
        equations.clear(replaced);
        for state in 0..size {
            equations.add(replaced, state, 1.0);
        }
        equations.add_constant(replaced, 0, 1.0);
        let mut weights = equations.solve()?.pop()?;
        for (weight, last) in weights.iter_mut().zip(final_states) {
            *weight = if last { weight.max(0.0) } else { 0.0 };
        }
        Some(weights)
    }

    /// Returns the weights to which those of the walk converge that starts anywhere in the final states and rests in every
    /// other step on average; `None` if they hardly do.
    pub(super) fn settled(&self, final_states: &[bool]) -> Option<Vec<f64>> {
        let steps: usize = self.states.iter().map(Vec::len).sum();
        let count = final_states.iter().filter(|&&last| last).count();
        let start = 1.0 / real(count);
        let start = final_states
            .iter()
            .map(|&last| if last { start } else { 0.0 });
        let mut weights: Vec<f64> = start.collect();
        for _ in 0..MAX_STEPS / steps.max(1) {
            let mut next: Vec<f64> = weights.iter().map(|weight| weight / 2.0).collect();
            for (steps, weight) in self.states.iter().zip(&weights) {
                for step in steps {
                    next[step.to] += step.probability * weight / 2.0;
                }
            }
            let changes = weights.iter().zip(&next);
            let change: f64 = changes.map(|(a, b)| (a - b).abs()).sum();
            weights = next;
            if change <= STILL {
                let sum: f64 = weights.iter().sum();
                return Some(weights.iter().map(|weight| weight / sum).collect());
            }
        }
        None
    }

    /// Returns for each state whether it belongs to the part that cannot be left; `None` if there are several
    /// such parts.
    fn final_states(&self) -> Option<Vec<bool>> {
        let targets = self.states.iter();
        let targets = targets.map(|steps| steps.iter().map(|step| step.to).collect());
        let targets: Vec<Vec<usize>> = targets.collect();
        let component = components(&targets);
        let mut left = vec![false; self.states.len()];
        for (state, targets) in targets.iter().enumerate() {
            if targets.iter().any(|&to| component[to] != component[state]) {
                left[component[state]] = true;
            }
        }
        let finals = component.iter().filter(|&&part| !left[part]);
        let mut finals: Vec<usize> = finals.copied().collect();
        finals.sort_unstable();
        finals.dedup();
        let [last] = finals[..] else {
            return None;
        };
        Some(component.iter().map(|&part| part == last).collect())
    }
}
