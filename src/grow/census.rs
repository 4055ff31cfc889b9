//! Numbers of elements by kind and step, and of their descendants, computed without a walk.
//!
//! If all maps are fixed, the descendants of an element depend only on its object and, where a cutoff length
//! decides about replacement (all maps must then be similarities), on its length. Elements that agree in
//! these are counted as one kind.

use std::collections::BTreeMap;

use crate::geometry::{Direction, Frame};
use crate::graph::{Chain, Graph, Instance, Replacement};

use super::Subtree;

/// Maximum number of kinds, over all steps; beyond it no census is made.
const MAX_KINDS: usize = 1 << 18;

/// Number of low bits of a length that are rounded away.
const ROUNDED: u32 = 12;

/// Relative difference below which two lengths may be equal except for rounding.
const NEAR: f64 = 1e-10;

/// Largest number of elements that is reported; small multiples of it do not overflow.
const MOST: u128 = 1 << 120;

/// Key of a kind: properties that determine an element's descendants, and its direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Key {
    object: usize,
    /// Upper bits of the length, rounded.
    length: u64,
    direction: Direction,
}

/// Elements of one step with equal descendants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cohort {
    pub(crate) object: usize,
    /// Direction, composed along the path through seeds of any placement.
    pub(crate) direction: Direction,
    /// Number of elements, saturated at the largest integer.
    pub(crate) count: u64,
    /// Whether they are replaced in the next step.
    pub(crate) is_replaced: bool,
    /// Length of one of them; 0 if lengths do not matter.
    length: f64,
    /// Number of descendants of each in its own fractal at the last step.
    becomes: u128,
}

type Cohorts = BTreeMap<Key, Cohort>;

/// Kinds of elements at every step of a growth.
#[derive(Debug)]
pub(crate) struct Census {
    steps: Vec<Cohorts>,
    /// Length below which elements are not replaced; 0 if there is no such length.
    shortest: f64,
    largest: Option<u128>,
}

impl Census {
    /// Counts the elements of `steps` steps, where elements shorter than `shortest` are not replaced. `None`
    /// if the graph does not determine the descendants of elements, or if there are too many kinds.
    pub(crate) fn of<F: Frame>(graph: &Graph<F>, steps: u32, shortest: f64) -> Option<Self> {
        let is_known = graph.is_plain()
            && !graph.counts_index()
            && graph.roots.elements.is_empty()
            && (shortest <= 0.0 || graph.is_similar() && !graph.resets().contains(&true));
        if !is_known {
            return None;
        }
        let mut census = Self {
            steps: Vec::new(),
            shortest,
            largest: None,
        };
        let start = graph.initiator(steps);
        let whole = census.whole();
        let mut cohorts = Cohorts::new();
        for instance in &start.instances {
            add(&mut cohorts, &whole, instance);
        }
        let mut kinds = 0;
        let mut is_certain = true;
        for step in 0..=steps {
            if cohorts.is_empty() {
                break;
            }
            kinds += cohorts.len();
            if kinds > MAX_KINDS {
                return None;
            }
            let mut next = Cohorts::new();
            for kind in cohorts.values_mut() {
                let Some(successor) = graph.objects()[kind.object].successor() else {
                    continue;
                };
                if step == steps {
                    continue;
                }
                is_certain &= (kind.length - shortest).abs() > NEAR * shortest || shortest <= 0.0;
                if kind.length < shortest {
                    continue;
                }
                kind.is_replaced = true;
                for (_, instance) in successor.placed_instances() {
                    add(&mut next, kind, instance);
                }
            }
            census.steps.push(cohorts);
            cohorts = next;
        }
        let largest = census.count_up(graph, start);
        census.largest = Some(largest).filter(|&largest| is_certain && largest <= MOST);
        Some(census)
    }

    /// Returns the kind of the unit frame, in which the initiator stands.
    fn whole(&self) -> Cohort {
        Cohort {
            object: 0,
            direction: Direction::Normal,
            count: 1,
            is_replaced: true,
            length: if self.shortest > 0.0 { 1.0 } else { 0.0 },
            becomes: 0,
        }
    }

    /// Counts the descendants of all kinds, from the last step backwards, and returns the number of elements
    /// of the largest fractal.
    fn count_up<F: Frame>(&mut self, graph: &Graph<F>, start: &Chain<F>) -> u128 {
        let mut largest = 0;
        for step in (0..self.steps.len()).rev() {
            let (above, below) = self.steps.split_at_mut(step + 1);
            for kind in above[step].values_mut() {
                let replacement = &graph.objects()[kind.object].replacement;
                kind.becomes = match (replacement, below.first()) {
                    (Replacement::Fixed(successor), Some(below)) if kind.is_replaced => {
                        for seed in &successor.seeds {
                            largest = largest.max(sum(below, kind, &seed.chain.instances));
                        }
                        sum(below, kind, &successor.body.instances)
                    }
                    // The replacement has no instances.
                    _ if kind.is_replaced => 0,
                    _ => 1,
                };
            }
        }
        let first = self.steps.first();
        let whole = self.whole();
        let of = |fractal: &[Instance<F>]| first.map_or(0, |first| sum(first, &whole, fractal));
        start.fractals().map(of).fold(largest, u128::max)
    }

    /// Iterates over the kinds of elements born in each step.
    pub(crate) fn steps(&self) -> impl Iterator<Item = impl Iterator<Item = &Cohort>> {
        self.steps.iter().map(BTreeMap::values)
    }

    /// Returns the number of elements of the largest fractal, if rounding of lengths cannot change it and it
    /// does not exceed 2¹²⁰.
    pub(crate) fn largest(&self) -> Option<u128> {
        self.largest
    }

    /// Returns the number of descendants, in its own fractal at the last step, of an element that can be
    /// replaced.
    pub(super) fn becomes<F: Frame>(&self, subtree: &Subtree<F>) -> u128 {
        let length = if self.shortest > 0.0 {
            subtree.frame.stretch()
        } else {
            0.0
        };
        if length < self.shortest {
            return 1;
        }
        let key = Key {
            object: subtree.object,
            length: rounded(length),
            direction: Direction::Normal,
        };
        let cohorts = self.steps.get(subtree.born as usize);
        let known = cohorts.and_then(|cohorts| {
            let not_shorter = cohorts.range(key..).next();
            let shorter = cohorts.range(..key).next_back();
            let alike = [not_shorter, shorter].into_iter().flatten();
            let off = |kind: &Cohort| (kind.length - length).abs();
            alike
                .map(|(_, kind)| kind)
                .filter(|kind| kind.object == subtree.object)
                .min_by(|a, b| off(a).total_cmp(&off(b)))
        });
        known.map_or(0, |kind| kind.becomes)
    }
}

fn rounded(length: f64) -> u64 {
    (length.to_bits() + (1 << (ROUNDED - 1))) >> ROUNDED
}

/// Returns the key and the length of an instance in the place of an element of a kind.
fn child<F: Frame>(parent: &Cohort, instance: &Instance<F>) -> (Key, f64) {
    let length = parent.length * instance.frame.stretch();
    let key = Key {
        object: instance.object,
        length: rounded(length),
        direction: parent.direction * instance.frame.direction(),
    };
    (key, length)
}

fn add<F: Frame>(cohorts: &mut Cohorts, parent: &Cohort, instance: &Instance<F>) {
    let (key, length) = child(parent, instance);
    let kind = cohorts.entry(key).or_insert(Cohort {
        object: key.object,
        direction: key.direction,
        count: 0,
        is_replaced: false,
        length,
        becomes: 0,
    });
    kind.count = kind.count.saturating_add(parent.count);
}

/// Returns the number of descendants of instances in the place of an element of a kind.
fn sum<F: Frame>(cohorts: &Cohorts, parent: &Cohort, instances: &[Instance<F>]) -> u128 {
    let children = instances.iter().map(|instance| {
        let (key, _) = child(parent, instance);
        cohorts.get(&key).map_or(0, |kind| kind.becomes)
    });
    children.fold(0, u128::saturating_add)
}
