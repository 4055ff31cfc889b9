//! What a survey would learn of what is cut at a length, counted without a walk.
//!
//! What becomes of an element depends on its object and its length alone where all maps are fixed
//! similarities: elements that have both in common are counted as one.

use std::collections::BTreeMap;
use std::convert::Infallible;

use crate::geometry::{Direction, Frame};
use crate::graph::{Graph, Instance, Object, Replacement};
use crate::grow::{Element, Fractal, Growth, WalkError};
use crate::instancing::Coat;
use crate::style::ColorBy;

use super::Survey;

/// More kinds of elements than this, at all steps together, are left to the walk.
const MOST_WORK: usize = 1 << 18;

/// The bits of a length that rounding may change.
const ROUNDED: u32 = 12;

/// Elements of one step that become the same: object, direction and length.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Kind {
    object: usize,
    direction: Direction,
    /// Bits of the length, with room for rounding.
    length: u64,
}

/// How many there are, and how long one of them is.
#[derive(Clone, Copy)]
struct Tally {
    count: u64,
    length: f64,
}

type Standing = BTreeMap<Kind, Tally>;

fn add(standing: &mut Standing, parent: (Direction, Tally), instance: &Instance) {
    let (direction, Tally { count, length }) = parent;
    let length = length * instance.frame.stretch();
    let kind = Kind {
        object: instance.object,
        direction: direction * instance.frame.direction,
        length: (length.to_bits() + (1 << (ROUNDED - 1))) >> ROUNDED,
    };
    let tally = standing.entry(kind).or_insert(Tally { count: 0, length });
    tally.count = tally.count.saturating_add(count);
}

/// One of some elements, wherever it stands.
fn element(kind: &Kind, born: u32) -> Element {
    Element {
        frame: Frame {
            direction: kind.direction,
            ..Frame::UNIT
        },
        length: 1.0,
        coat: Coat::NONE,
        index: 1,
        object: kind.object,
        born,
        fertile: false,
        joined: false,
    }
}

impl Survey<'_> {
    /// The survey of all that can be seen, where only a length cuts it; `None` where that takes a walk.
    pub(super) fn counted(
        &self,
        growth: &Growth<'_>,
    ) -> Result<Option<Self>, WalkError<Infallible>> {
        let graph = self.graph();
        if !self.can_be_counted(graph) {
            return Ok(None);
        }
        let mut survey = self.clone();
        survey.fractals = 1;
        let mut standing = Standing::new();
        let whole = Tally {
            count: 1,
            length: 1.0,
        };
        for instance in &graph.initiator(growth.steps).instances {
            add(&mut standing, (Direction::Normal, whole), instance);
        }
        let mut work = 0;
        for step in 0..=growth.steps {
            if standing.is_empty() {
                break;
            }
            work += standing.len();
            if work > MOST_WORK {
                return Ok(None);
            }
            let mut next = Standing::new();
            for (kind, &tally) in &standing {
                let object = &graph.objects()[kind.object];
                match &object.replacement {
                    Replacement::Fixed(production)
                        if step < growth.steps && !survey.sight().is_short(tally.length) =>
                    {
                        survey.steps = survey.steps.max(step + 1);
                        let seeds = (production.seeds.len() as u64).saturating_mul(tally.count);
                        survey.fractals = survey.fractals.saturating_add(seeds);
                        for (_, instance) in production.placed_instances() {
                            add(&mut next, (kind.direction, tally), instance);
                        }
                    }
                    _ => survey.count(object, &element(kind, step), growth.steps, tally.count),
                }
            }
            if survey.elements > growth.most_elements {
                let limit = growth.most_elements;
                return Err(WalkError::TooManyElements { limit });
            }
            standing = next;
        }
        Ok(Some(survey))
    }

    fn can_be_counted(&self, graph: &Graph) -> bool {
        let by_age = self.style().color_by == ColorBy::Age && graph.seeds;
        graph.is_plain()
            && graph.is_similar()
            && !graph.counts_index()
            && graph.roots.is_empty()
            && !graph.resets().contains(&true)
            && self.style().color_by != ColorBy::Index
            && !by_age
            && !self.sight().is_bounded()
    }

    /// Elements that stand in the end.
    fn count(&mut self, object: &Object, element: &Element, steps: u32, count: u64) {
        self.elements = self.elements.saturating_add(count);
        if object.visible {
            // Of fractals that are seeded no colour tells the age here.
            let fractal = Fractal {
                age: steps,
                ..Fractal::default()
            };
            self.use_value_of(element, &fractal);
            self.strokes |= self.is_stroked(object);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::num::NonZero;

    use crate::catalogue::{Catalogue, Shelf};
    use crate::document::Document;
    use crate::graph::Graph;
    use crate::grow::Growth;
    use crate::render::Survey;
    use crate::render::sight::Sight;
    use crate::style::{ColorBy, Named, Style};

    #[test]
    fn what_is_counted_is_what_a_walk_finds() {
        let catalogue = Catalogue::embedded();
        let entries = catalogue.entries();
        let mut counted = 0;
        for entry in entries.iter().filter(|entry| entry.shelf == Shelf::Rules) {
            let source = catalogue.open(entry).unwrap();
            let document = Document::read(&source, &catalogue).unwrap();
            let rule = document.resolve(&[]).unwrap().0.into_rule().unwrap();
            let graph = Graph::compile(&rule, 6).unwrap();
            for (_, color_by) in ColorBy::NAMES {
                let style = Style {
                    color_by: *color_by,
                    ..rule.style().clone()
                };
                for (steps, shortest) in [(0, 0.1), (4, 0.07), (6, 0.2)] {
                    let growth = Growth::steps(steps);
                    let sight = Sight::to_length(&graph, shortest);
                    let mut survey = Survey::new(&graph, &style, 6).of_what_is_in(sight);
                    survey.is_bounded = true;
                    let Some(told) = survey.counted(&growth).unwrap() else {
                        continue;
                    };
                    counted += 1;
                    let walked = survey.walked(&growth, NonZero::<usize>::MIN).unwrap();
                    let what = format!("{} at {steps} by {color_by:?}", entry.name);
                    assert_eq!(told.elements, walked.elements, "{what}");
                    assert_eq!(told.fractals, walked.fractals, "{what}");
                    assert_eq!(told.steps, walked.steps, "{what}");
                    assert_eq!(told.strokes, walked.strokes, "{what}");
                    assert_eq!(told.classes(), walked.classes(), "{what}");
                }
            }
        }
        assert!(counted > 500, "{counted}");
    }

    #[test]
    fn what_is_counted_stays_within_limits() {
        let catalogue = Catalogue::embedded();
        let source = catalogue.component(Shelf::Rules, "koch").unwrap();
        let document = Document::read(&source, &catalogue).unwrap();
        let rule = document.resolve(&[]).unwrap().0.into_rule().unwrap();
        let graph = Graph::compile(&rule, 100).unwrap();
        let survey =
            Survey::new(&graph, rule.style(), 100).of_what_is_in(Sight::to_length(&graph, 1e-9));
        let error = survey.counted(&Growth::steps(100)).unwrap_err();
        assert_eq!(error.to_string(), "there are more than 50000000 elements");
    }
}
