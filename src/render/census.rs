//! Prepass without a walk for a cutoff length: prepasses from numbers of elements by kind.

use std::convert::Infallible;

use crate::geometry::Frame2;
use crate::graph::{Object, Replacement};
use crate::grow::{Census, Cohort, Element, FractalInfo, Growth, WalkError};
use crate::instancing::Appearance;
use crate::style::ColorBy;

use super::prepass::Prepass;

/// Returns an element of a kind, at an arbitrary place.
fn element(kind: &Cohort, born: u32) -> Element {
    Element {
        frame: Frame2::UNIT.with_direction(kind.direction),
        length: 1.0,
        appearance: Appearance::NONE,
        index: 1,
        object: kind.object,
        born,
        fertile: false,
        visible: true,
        joined: false,
    }
}

impl Prepass<'_> {
    /// Computes the prepass if elements are kept for their length only; `None` if that requires a walk.
    pub(super) fn counted(
        &self,
        growth: &Growth<'_>,
    ) -> Result<Option<Self>, WalkError<Infallible>> {
        let graph = self.graph();
        let by_age = self.style().color_by == ColorBy::Age && graph.seeds;
        if by_age || self.needs_lengths() || self.culling().is_bounded() {
            return Ok(None);
        }
        let shortest = self.culling().shortest().filter(|&shortest| shortest > 0.0);
        let census = shortest.and_then(|shortest| Census::of(graph, growth.steps, shortest));
        let Some(census) = census else {
            return Ok(None);
        };
        let mut prepass = self.clone();
        prepass.fractals = 1;
        for (step, kinds) in (0..).zip(census.steps()) {
            for kind in kinds {
                let object = &graph.objects()[kind.object];
                if kind.is_replaced {
                    prepass.steps = prepass.steps.max(step + 1);
                    let seeds = seeds(object).saturating_mul(kind.count);
                    prepass.fractals = prepass.fractals.saturating_add(seeds);
                } else {
                    prepass.count(object, &element(kind, step), growth.steps, kind.count);
                }
            }
        }
        if prepass.elements > growth.max_elements {
            let limit = growth.max_elements;
            return Err(WalkError::TooManyElements { limit });
        }
        let needs_ranks = self.style().color_by == ColorBy::Index;
        let is_known = !needs_ranks || prepass.count_ranks(Some(census), growth.steps);
        Ok(is_known.then_some(prepass))
    }

    /// Counts elements of the last approximant, or kept before it.
    fn count(&mut self, object: &Object, element: &Element, steps: u32, count: u64) {
        self.elements = self.elements.saturating_add(count);
        if object.visible {
            // The ages of seeded fractals are not computed here.
            let fractal = FractalInfo {
                age: steps,
                ..FractalInfo::default()
            };
            self.use_value_of(element, &fractal);
            self.strokes |= self.is_stroked(object);
        }
    }
}

/// Returns the number of fractals that an element of an object seeds when it is replaced.
fn seeds(object: &Object) -> u64 {
    match &object.replacement {
        Replacement::Fixed(production) => production.seeds.len() as u64,
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use std::num::NonZero;

    use crate::catalogue::{Catalogue, Shelf};
    use crate::document::Document;
    use crate::graph::Graph;
    use crate::grow::Growth;
    use crate::render::Prepass;
    use crate::render::culling::Culling;
    use crate::style::{ColorBy, Named, Style};

    #[test]
    fn what_is_counted_is_what_a_walk_finds() {
        let catalogue = Catalogue::embedded();
        let entries = catalogue.entries();
        let mut counted = 0;
        for entry in entries.iter().filter(|entry| entry.shelf == Shelf::RULES) {
            let source = catalogue.open(entry).unwrap();
            let document = Document::read(&source, &catalogue).unwrap();
            let Some(rule) = document.resolve(&[]).unwrap().0.into_rule() else {
                continue;
            };
            let graph = Graph::compile(&rule, 6).unwrap();
            for (_, color_by) in ColorBy::NAMES {
                let style = Style {
                    color_by: *color_by,
                    ..rule.style().clone()
                };
                for (steps, shortest) in [(0, 0.1), (4, 0.07), (6, 0.2)] {
                    let growth = Growth::steps(steps);
                    let culling = Culling::to_length(&graph, shortest);
                    let mut prepass = Prepass::new(&graph, &style, 6).of_what_is_in(culling);
                    prepass.is_bounded = true;
                    let Some(known) = prepass.counted(&growth).unwrap() else {
                        continue;
                    };
                    counted += 1;
                    let walked = prepass.walked(&growth, NonZero::<usize>::MIN).unwrap();
                    let what = format!("{} at {steps} by {color_by:?}", entry.name);
                    assert_eq!(known.elements, walked.elements, "{what}");
                    assert_eq!(known.fractals, walked.fractals, "{what}");
                    assert_eq!(known.steps, walked.steps, "{what}");
                    assert_eq!(known.strokes, walked.strokes, "{what}");
                    assert_eq!(known.classes(), walked.classes(), "{what}");
                }
            }
        }
        assert!(counted > 500, "{counted}");
    }

    #[test]
    fn what_is_counted_stays_within_limits() {
        let catalogue = Catalogue::embedded();
        let source = catalogue.component(Shelf::RULES, "koch").unwrap();
        let document = Document::read(&source, &catalogue).unwrap();
        let rule = document.resolve(&[]).unwrap().0.into_rule().unwrap();
        let graph = Graph::compile(&rule, 100).unwrap();
        let prepass =
            Prepass::new(&graph, rule.style(), 100).of_what_is_in(Culling::to_length(&graph, 1e-9));
        let error = prepass.counted(&Growth::steps(100)).unwrap_err();
        assert_eq!(error.to_string(), "there are more than 50000000 elements");
    }
}
