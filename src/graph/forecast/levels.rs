//! The sizes of the approximants of a levelled graph: what objects come to, from the bottom up.

use std::collections::BTreeMap;

use crate::graph::{Chain, Graph, Instance, Replacement};

use super::{Count, Forecast, Sums, Tally};

/// What an element of an object comes to, for a length of 1.
#[derive(Default)]
struct Total {
    /// By object that stands in the end.
    tallies: BTreeMap<usize, Tally>,
    /// The object of the first element.
    first: usize,
    /// Whether that may join what stands before.
    joins: bool,
}

/// What objects come to that are reached within some steps.
#[derive(Default)]
pub(super) struct Totals {
    /// Of the graph's last objects, the last one first.
    last: Vec<Total>,
    /// How many tallies have been added since this was last taken.
    work: usize,
}

impl Forecast<'_> {
    /// Goes on to the next approximant of a levelled graph. `false`, and nothing happens, where it ends.
    pub(super) fn advance_level(&mut self) -> bool {
        let Some(start) = self.graph.initiators.get(self.step as usize + 1) else {
            return false;
        };
        let totals = &mut self.totals;
        let needed = start.instances.iter().map(|instance| instance.object);
        let needed = needed.min().unwrap_or(self.graph.objects.len());
        // Objects only lead to those of larger numbers.
        while self.graph.objects.len() - totals.last.len() > needed {
            let next = self.graph.objects.len() - totals.last.len() - 1;
            let total = totals.of(self.graph, next);
            totals.last.push(total);
        }
        let mut all = Total::default();
        totals.add_chain(self.graph, start, &mut all);
        self.work += std::mem::take(&mut totals.work);
        for (&object, tally) in &mut all.tallies {
            tally.sums.area = tally.sums.square * self.own_area(object);
        }
        self.standing = all.tallies;
        self.step += 1;
        true
    }
}

impl Totals {
    /// What an object comes to, if that is known of those of larger numbers.
    fn of(&mut self, graph: &Graph, number: usize) -> Total {
        let mut total = Total::default();
        match &graph.objects[number].replacement {
            Replacement::Kept | Replacement::Beyond => {
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
            Replacement::Fixed(production) => {
                self.add_chain(graph, &production.body, &mut total);
                total.joins &= production.body.meets_frame[0];
            }
            Replacement::Evaluated(alternatives) => {
                for &object in &alternatives[0].objects {
                    self.add(graph, object, [0.0; 2], &mut total);
                }
            }
        }
        total
    }

    fn add_chain(&mut self, graph: &Graph, chain: &Chain, total: &mut Total) {
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
                Replacement::Fixed(production) => production.body.meets_frame[1],
                _ => true,
            };
        }
    }

    /// Adds what an object comes to whose length and square are known. Tells its first element, and
    /// whether that may join another.
    fn add(
        &mut self,
        graph: &Graph,
        object: usize,
        [length, square]: [f64; 2],
        total: &mut Total,
    ) -> (usize, bool) {
        let other = &self.last[graph.objects.len() - 1 - object];
        for (&leaf, tally) in &other.tallies {
            self.work += 1;
            let own = total.tallies.entry(leaf).or_default();
            own.count += &tally.count;
            own.sums += Sums {
                length: length * tally.sums.length,
                square: square * tally.sums.square,
                apart: tally.sums.apart,
                ..Sums::default()
            };
        }
        (other.first, other.joins)
    }
}
