//! Forecasts of time-indexed graphs: totals of objects, from the bottom up.

use std::collections::BTreeMap;

use crate::count::Count;
use crate::geometry::Frame;
use crate::graph::{Chain, Graph, Instance, Replacement};

use super::{Forecast, MAX_WORK, Sums, Tally, work};

/// Work of a tally that is held, relative to that of adding 18 digits: it stands for the memory that it takes.
const HELD: u64 = 600;

/// Leaves of the subtree of an object of length 1.
#[derive(Default)]
struct Total {
    /// Tallies by object of the leaves.
    tallies: BTreeMap<usize, Tally>,
    /// Object of the first leaf.
    first: usize,
    /// Whether the first leaf may join the element before.
    joins: bool,
}

/// Totals of the objects that are reached within the steps so far.
#[derive(Default)]
pub(super) struct Totals {
    /// Totals of the last objects of the graph, in reverse order.
    last: Vec<Total>,
    /// Work of the additions since it was last taken.
    work: u64,
}

impl<F: Frame> Forecast<'_, F> {
    /// Advances to the next approximant of a time-indexed graph. Returns `false`, without effect, if the
    /// graph is not resolved further, or if the forecast takes too long.
    pub(super) fn advance_level(&mut self) -> bool {
        let Some(start) = self.graph.initiators.get(self.step as usize + 1) else {
            return false;
        };
        let totals = &mut self.totals;
        let needed = start.instances.iter().map(|instance| instance.object);
        let needed = needed.min().unwrap_or(self.graph.objects.len());
        // Objects lead only to objects of larger numbers.
        while self.graph.objects.len() - totals.last.len() > needed {
            if self.work + totals.work > MAX_WORK {
                return false;
            }
            let next = self.graph.objects.len() - totals.last.len() - 1;
            let total = totals.of(self.graph, next);
            totals.last.push(total);
        }
        let mut all = Total::default();
        totals.add_chain(self.graph, start, &mut all);
        self.work += std::mem::take(&mut totals.work);
        self.population.set(all.tallies);
        self.look();
        self.step += 1;
        true
    }
}

impl Totals {
    /// Returns the total of an object whose successors, which have larger numbers, are known.
    fn of<F: Frame>(&mut self, graph: &Graph<F>, number: usize) -> Total {
        let mut total = Total::default();
        match &graph.objects[number].replacement {
            Replacement::Kept | Replacement::Unresolved => {
                let sums = Sums {
                    length: 1.0,
                    square: 1.0,
                    ..Sums::default()
                };
                let count = Count::from(1u64);
                total = Total {
                    tallies: BTreeMap::from([(number, Tally { count, sums })]),
                    first: number,
                    joins: true,
                };
            }
            Replacement::Fixed(successor) => {
                self.add_chain(graph, &successor.body, &mut total);
                total.joins &= successor.body.meets_frame[0];
            }
            Replacement::Evaluated(alternatives) => {
                for &object in &alternatives[0].objects {
                    self.add(graph, object, [0.0; 2], &mut total);
                }
            }
        }
        total
    }

    fn add_chain<F: Frame>(&mut self, graph: &Graph<F>, chain: &Chain<F>, total: &mut Total) {
        let mut meets_end = true;
        for (index, instance) in chain.instances.iter().enumerate() {
            let Instance { object, length, .. } = *instance;
            let (first, joins) = self.add(graph, object, [length, length * length], total);
            if index == 0 {
                (total.first, total.joins) = (first, joins);
            } else if !(joins && instance.joined && meets_end) {
                let tally = total.tallies.entry(first).or_default();
                tally.sums.apart += 1.0;
            }
            meets_end = match &graph.objects[object].replacement {
                Replacement::Fixed(successor) => successor.body.meets_frame[1],
                _ => true,
            };
        }
    }

    /// Adds the total of an object at a given length and square of the length. Returns the object of its
    /// first leaf, and whether that may join another.
    fn add<F: Frame>(
        &mut self,
        graph: &Graph<F>,
        object: usize,
        [length, square]: [f64; 2],
        total: &mut Total,
    ) -> (usize, bool) {
        let other = &self.last[graph.objects.len() - 1 - object];
        let before = total.tallies.len();
        for (&leaf, tally) in &other.tallies {
            self.work += work(&tally.count);
            let own = total.tallies.entry(leaf).or_default();
            own.count += &tally.count;
            own.sums += Sums {
                length: length * tally.sums.length,
                square: square * tally.sums.square,
                apart: tally.sums.apart,
                ..Sums::default()
            };
        }
        self.work += HELD * (total.tallies.len() - before) as u64;
        (other.first, other.joins)
    }
}
