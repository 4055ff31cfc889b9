//! The walk of random iteration as a Markov chain.

use super::linear::Equations;
use super::{Ifs, shares};
use crate::digraph::components;

/// What happens to the point in a step of the walk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// It goes to its image under the map of this number.
    Map(usize),
    /// It is drawn anew, uniformly, from the condensation set of this number.
    Condensation(usize),
}

/// A step that the walk may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// What happens.
    pub choice: Choice,
    /// How likely it is, above 0 and up to 1.
    pub probability: f64,
    /// The state that the walk is in then.
    pub to: usize,
}

/// The walk of random iteration: states, and from each the steps that may be taken.
///
/// Without a digraph there is one state only. With one, state i is that in which map i was applied
/// last, and there is one more, in which the point was drawn from a condensation set, if there are
/// any. A condensation set is picked as often from any state: with the sum of all weights of maps and
/// condensation sets W, the set with weight w is picked with probability w / W. Else an edge is
/// picked by its weight, after a condensation set a map by its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Walk {
    states: Vec<Vec<Step>>,
}

impl Ifs {
    /// The walk of random iteration.
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
        // Steps to these maps by these weights, or else a condensation set.
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
    /// The steps that may be taken from every state; their probabilities add up to 1.
    #[must_use]
    pub fn states(&self) -> &[Vec<Step>] {
        &self.states
    }

    /// How much of its time a long walk spends in every state: the weights that stay as they are.
    ///
    /// They are 0 for states that the walk leaves for ever. `None` if there are several parts of the
    /// digraph that it cannot leave: where it ends depends on where it starts. The work grows with
    /// the third power of the number of states.
    #[must_use]
    pub fn stationary(&self) -> Option<Vec<f64>> {
        let size = self.states.len();
        let final_states = self.final_states()?;
        let mut equations = Equations::new(size, 1);
        for (state, steps) in self.states.iter().enumerate() {
            equations.add(state, state, 1.0);
            for step in steps {
                equations.add(step.to, state, -step.probability);
            }
        }
        // One of the equations follows from the others: the sum takes its place.
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

    /// Which states belong to the part that cannot be left, if there is one only.
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
