//! What kinds of elements there are at every step, and how many come of each, without a walk.
//!
//! What becomes of an element depends on its object, and on its length where that decides what is
//! replaced, if all maps are fixed (and similarities): elements that have these in common are counted
//! as one.

use std::collections::BTreeMap;

use crate::geometry::Direction;
use crate::graph::{Chain, Graph, Instance, Replacement};

use super::Subtree;

/// More kinds than this, at all steps together, are left to the walk.
const MOST_KINDS: usize = 1 << 18;

/// The bits of a length that rounding may change.
const ROUNDED: u32 = 12;

/// Lengths that differ by no more than this part of them may be the same, however they have been
/// worked out.
const NEAR: f64 = 1e-10;

/// More elements than this are not counted: multiples of the number are still numbers.
const MOST: u128 = 1 << 120;

/// What elements have in common that become the same; directions are told apart as well.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Key {
    object: usize,
    /// Bits of the length, with room for rounding.
    length: u64,
    direction: Direction,
}

/// Elements of one step that become the same.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Kind {
    pub(crate) object: usize,
    /// As if seeds that are placed as the initiator were not.
    pub(crate) direction: Direction,
    /// How many there are, or the largest number that this can tell.
    pub(crate) count: u64,
    /// Whether they are replaced in the next step.
    pub(crate) is_replaced: bool,
    /// How long one of them is; 0 where that does not matter.
    length: f64,
    /// How many elements of its fractal stand in the end for each of them.
    becomes: u128,
}

type Standing = BTreeMap<Key, Kind>;

/// The kinds of elements at every step of a growth.
#[derive(Debug)]
pub(crate) struct Census {
    steps: Vec<Standing>,
    /// The length below which nothing is replaced; 0 if there is none.
    shortest: f64,
    largest: Option<u128>,
}

impl Census {
    /// Of a number of steps, in which nothing is replaced that is shorter than a length; `None` where
    /// the graph does not tell what becomes of elements, or where there are too many kinds of them.
    pub(crate) fn of(graph: &Graph, steps: u32, shortest: f64) -> Option<Self> {
        let tells = graph.is_plain()
            && !graph.counts_index()
            && graph.roots.elements.is_empty()
            && (shortest <= 0.0 || graph.is_similar() && !graph.resets().contains(&true));
        if !tells {
            return None;
        }
        let mut census = Self {
            steps: Vec::new(),
            shortest,
            largest: None,
        };
        let start = graph.initiator(steps);
        let whole = census.whole();
        let mut standing = Standing::new();
        for instance in &start.instances {
            add(&mut standing, &whole, instance);
        }
        let mut kinds = 0;
        let mut is_certain = true;
        for step in 0..=steps {
            if standing.is_empty() {
                break;
            }
            kinds += standing.len();
            if kinds > MOST_KINDS {
                return None;
            }
            let mut next = Standing::new();
            for kind in standing.values_mut() {
                let Replacement::Fixed(production) = &graph.objects()[kind.object].replacement
                else {
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
                for (_, instance) in production.placed_instances() {
                    add(&mut next, kind, instance);
                }
            }
            census.steps.push(standing);
            standing = next;
        }
        let largest = census.count_up(graph, start);
        census.largest = Some(largest).filter(|&largest| is_certain && largest <= MOST);
        Some(census)
    }

    /// The element that the initiator stands in the place of.
    fn whole(&self) -> Kind {
        Kind {
            object: 0,
            direction: Direction::Normal,
            count: 1,
            is_replaced: true,
            length: if self.shortest > 0.0 { 1.0 } else { 0.0 },
            becomes: 0,
        }
    }

    /// Counts what kinds become, from the last step up; tells the number of elements of the largest
    /// fractal.
    fn count_up(&mut self, graph: &Graph, start: &Chain) -> u128 {
        let mut largest = 0;
        for step in (0..self.steps.len()).rev() {
            let (above, below) = self.steps.split_at_mut(step + 1);
            for kind in above[step].values_mut() {
                let replacement = &graph.objects()[kind.object].replacement;
                kind.becomes = match (replacement, below.first()) {
                    (Replacement::Fixed(production), Some(below)) if kind.is_replaced => {
                        for seed in &production.seeds {
                            largest = largest.max(sum(below, kind, &seed.chain));
                        }
                        sum(below, kind, &production.body)
                    }
                    // Nothing comes of it.
                    _ if kind.is_replaced => 0,
                    _ => 1,
                };
            }
        }
        let first = self.steps.first();
        let first = first.map_or(0, |first| sum(first, &self.whole(), start));
        largest.max(first)
    }

    /// The kinds of elements that are born in each step.
    pub(crate) fn steps(&self) -> impl Iterator<Item = impl Iterator<Item = &Kind>> {
        self.steps.iter().map(BTreeMap::values)
    }

    /// The number of elements of the largest fractal, if it is certain that a walk comes to as many, of
    /// every kind, and if that is no more than some 10^36.
    pub(crate) fn largest(&self) -> Option<u128> {
        self.largest
    }

    /// How many elements of its fractal stand in the end for one that is not the last of its line.
    pub(super) fn becomes(&self, subtree: &Subtree) -> u128 {
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
        let standing = self.steps.get(subtree.born as usize);
        let known = standing.and_then(|standing| {
            let not_shorter = standing.range(key..).next();
            let shorter = standing.range(..key).next_back();
            let alike = [not_shorter, shorter].into_iter().flatten();
            let off = |kind: &Kind| (kind.length - length).abs();
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

/// What an instance is in the place of an element of a kind, and how long.
fn child(parent: &Kind, instance: &Instance) -> (Key, f64) {
    let length = parent.length * instance.frame.stretch();
    let key = Key {
        object: instance.object,
        length: rounded(length),
        direction: parent.direction * instance.frame.direction,
    };
    (key, length)
}

fn add(standing: &mut Standing, parent: &Kind, instance: &Instance) {
    let (key, length) = child(parent, instance);
    let kind = standing.entry(key).or_insert(Kind {
        object: key.object,
        direction: key.direction,
        count: 0,
        is_replaced: false,
        length,
        becomes: 0,
    });
    kind.count = kind.count.saturating_add(parent.count);
}

/// What the instances of a chain become in the place of an element of a kind.
fn sum(standing: &Standing, parent: &Kind, chain: &Chain) -> u128 {
    let children = chain.instances.iter().map(|instance| {
        let (key, _) = child(parent, instance);
        standing.get(&key).map_or(0, |kind| kind.becomes)
    });
    children.fold(0, u128::saturating_add)
}
