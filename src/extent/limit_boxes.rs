//! Bounding boxes of limit sets, by bounds that are tried one after the other.

use std::borrow::Cow;
use std::cell::{Cell, OnceCell};
use std::sync::Arc;

use crate::fast_hash::FastMap;
use crate::geometry::{Bounds, Frame};
use crate::graph::{Graph, Instance, Replacement};

use super::bounded::{Bounded, Fineness};
use super::bounds::Reach;
use super::farthest::Balls;
use super::recurrent::Recurrent;

/// Bounding boxes of limit sets of a graph, which share the bounds on subtrees: see [`Graph::limit_bounds`].
pub(crate) struct LimitBoxes<'g, F: Frame> {
    graph: Cow<'g, Graph<F>>,
    /// Bounds that are tried one after the other.
    attempts: Vec<Attempt<F>>,
    /// Farthest values along directions that recur, which are tried first where there are many behaviours.
    recurrent: OnceCell<Option<Recurrent>>,
    /// Balls for frames without hulls, which are tried last.
    balls: OnceCell<Balls<F>>,
    /// Number of the attempt that found the last box; those before it fail again, as a rule.
    first: Cell<usize>,
}

/// Bounds by hulls of a fineness, or by ratios, once they are asked for.
struct Attempt<F: Frame> {
    fineness: Option<Fineness>,
    reach: OnceCell<Option<Reach<F>>>,
}

impl<F: Bounded> Graph<F> {
    /// Returns the bounding box of the limit set: of the limit of the approximants as drawn, which
    /// contains infertile visible elements.
    ///
    /// Exact to some 15 digits, or to 1e-10 of its longer side where maps contract so slowly that full
    /// precision would take too long. `None` if there is no limit set, or if the graph does not determine
    /// the box.
    #[must_use]
    pub fn limit_bounds(&self) -> Option<Bounds<F::Point>> {
        self.limit_bounds
            .unwrap_or_else(|| self.limit_boxes()?.at(&self.initiator(0).instances))
    }

    /// Returns the boxes of limit sets that begin with given instances; `None` if there are none.
    pub(crate) fn limit_boxes(&self) -> Option<LimitBoxes<'_, F>> {
        if self.depth.is_some() || !self.contracts() {
            return None;
        }
        let is_much = self.has_many_behaviours();
        // Polygons of many behaviours take long.
        let mut finenesses = match (F::HAS_HULLS, is_much) {
            (false, _) => vec![],
            (true, true) => vec![Some(Fineness::COARSE)],
            (true, false) => vec![Some(Fineness::COARSE), Some(Fineness::FINE)],
        };
        // Ratios need no polygons, but bound flat sets loosely. Balls take less where there are many behaviours.
        if F::HAS_HULLS || !is_much {
            let place = if self.prefers_hulls() {
                finenesses.len()
            } else {
                0
            };
            finenesses.insert(place, None);
        }
        let attempts = finenesses.into_iter().map(|fineness| Attempt {
            fineness,
            reach: OnceCell::new(),
        });
        Some(LimitBoxes {
            graph: self.living(),
            attempts: attempts.collect(),
            recurrent: OnceCell::new(),
            balls: OnceCell::new(),
            first: Cell::new(0),
        })
    }

    /// Returns the graph, without instances that are not drawn in the limit if these are most of all.
    fn living(&self) -> Cow<'_, Self> {
        let alive = self.alive(true);
        let (mut all, mut left) = (0, 0);
        for (_, instance) in self.instances() {
            all += 1;
            left += usize::from(alive[instance.object]);
        }
        if 2 * left >= all {
            return Cow::Borrowed(self);
        }
        let mut living = self.clone();
        let mut known = FastMap::default();
        for object in &mut living.objects {
            if let Replacement::Fixed(successor) = &mut object.replacement {
                let new = known.entry(Arc::as_ptr(successor));
                let new =
                    new.or_insert_with(|| Arc::new(successor.retaining(|it| alive[it.object])));
                *successor = Arc::clone(new);
            }
        }
        Cow::Owned(living)
    }
}

impl<F: Bounded> LimitBoxes<'_, F> {
    /// Returns the bounding box of the limit set that begins with some instances: see [`Graph::limit_bounds`].
    pub(crate) fn at(&self, start: &[Instance<F>]) -> Option<Bounds<F::Point>> {
        let recurrent = self.recurrent.get_or_init(|| {
            let is_much = self.graph.has_many_behaviours();
            is_much.then(|| Recurrent::of(&self.graph))?
        });
        if let Some(bounds) = { recurrent.as_ref() }.and_then(|known| known.box_of(start)) {
            return Some(bounds);
        }
        let attempts = self.first.get()..=self.attempts.len();
        let mut found = attempts.filter_map(|number| Some((number, self.tried(number, start)?)));
        let (number, bounds) = found.next()?;
        self.first.set(number);
        Some(bounds)
    }

    /// Returns the bounding box of the limit of an object's subtree, in its unit frame.
    pub(crate) fn at_object(&self, object: usize) -> Option<Bounds<F::Point>> {
        self.at(&[Instance {
            length: F::UNIT.stretch(),
            ..Instance::new(object, F::UNIT, 0)
        }])
    }

    /// Returns the box that an attempt finds, or after the last one, balls.
    fn tried(&self, number: usize, start: &[Instance<F>]) -> Option<Bounds<F::Point>> {
        let graph = &*self.graph;
        let Some(Attempt { fineness, reach }) = self.attempts.get(number) else {
            let by_balls = !F::HAS_HULLS && graph.check_maps().is_ok();
            let balls = by_balls.then(|| self.balls.get_or_init(|| Balls::of(graph)))?;
            return graph.limit_bounds_by(balls, start);
        };
        let reach = reach.get_or_init(|| {
            let mut reach = graph.reach_within(true, *fineness, |_| 0.0)?;
            let is_last = F::HAS_HULLS && number + 1 == self.attempts.len();
            reach.is_patient = is_last && !graph.has_many_behaviours();
            Some(reach)
        });
        graph.box_by(reach.as_ref()?, start, None)
    }

    /// Returns the number of states and instances that were looked at.
    pub(crate) fn looked(&self) -> usize {
        let attempts = self.attempts.iter();
        let attempts = attempts.filter_map(|it| it.reach.get()?.as_ref());
        let looked = attempts.map(|reach| reach.looked.get());
        let by_balls = self.balls.get().map(|balls| balls.looked.get());
        looked.chain(by_balls).sum()
    }
}

#[cfg(test)]
mod tests;
