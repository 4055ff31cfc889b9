//! Graphs with fixed instances whose objects also distinguish a property of their elements.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::geometry::{Direction, Frame as _, Frame3};
use crate::graph::{Chain, Graph, Instance, Object, Replacement, Successor};

/// Limit of the steps whose ages are distinguished; fractals that are seeded later count as of this step.
const MAX_STEPS: u32 = 64;

impl Graph<Frame3> {
    /// Returns the graph with an object for each direction in which elements of an object stand. The origins of objects are
    /// the numbers of the directions, from 0.
    pub(crate) fn by_direction(self) -> Self {
        let next = |direction: &Direction, instance: &Instance<Frame3>, _| {
            *direction * instance.frame.direction()
        };
        let class = |direction: &Direction| usize::from(direction.number()) - 1;
        let root = |instance: &Instance<Frame3>| instance.frame.direction();
        self.distinguished(root, next, class, 8)
    }

    /// Returns the graph with an object for each age that fractals have when `steps` steps are grown. The origins of objects
    /// are the ages.
    pub(crate) fn by_age(self, steps: u32) -> Self {
        let steps = steps.min(MAX_STEPS);
        // The step that is reached, and the one in which the fractal is seeded.
        let next = |[step, seeded]: &[u32; 2], _: &Instance<Frame3>, is_seed: bool| {
            let step = (*step + 1).min(steps);
            [step, if is_seed { step } else { *seeded }]
        };
        let class = |[_, seeded]: &[u32; 2]| (steps - seeded) as usize;
        self.distinguished(|_| [0, 0], next, class, steps as usize + 1)
    }

    /// Returns the graph with an object for each state that elements of an object have. `root` is the state of an element of
    /// the initiator, `next` that of an instance in an element of a state, `class` the origin of the objects of a state, of
    /// which there are `classes`.
    fn distinguished<S: Clone + Ord>(
        mut self,
        root: impl Fn(&Instance<Frame3>) -> S,
        next: impl Fn(&S, &Instance<Frame3>, bool) -> S,
        class: impl Fn(&S) -> usize,
        classes: usize,
    ) -> Self {
        let mut made = Made {
            numbers: BTreeMap::new(),
            keys: Vec::new(),
        };
        for chain in self.initiators_mut() {
            made.distinguish(chain, &root);
        }
        let mut objects: Vec<Object<Frame3>> = Vec::new();
        let mut behaviours: BTreeMap<(usize, S), (usize, Replacement<Frame3>)> = BTreeMap::new();
        while let Some((object, state)) = made.keys.get(objects.len()).cloned() {
            let own = &self.objects[object];
            let count = behaviours.len();
            let key = (own.behaviour, state.clone());
            let known = behaviours.entry(key).or_insert_with(|| {
                let replacement = match &own.replacement {
                    Replacement::Fixed(successor) => {
                        let mut successor = Successor::clone(successor);
                        made.distinguish(&mut successor.body, |it| next(&state, it, false));
                        for seed in &mut successor.seeds {
                            made.distinguish(&mut seed.chain, |it| next(&state, it, true));
                        }
                        Replacement::Fixed(Arc::new(successor))
                    }
                    other => other.clone(),
                };
                (count, replacement)
            });
            let (behaviour, replacement) = known.clone();
            objects.push(Object {
                origin: Some(class(&state)),
                behaviour,
                replacement,
                ..own.clone()
            });
        }
        self.objects = objects;
        self.origins = classes;
        self
    }
}

/// Objects that have been reached, each with its state.
struct Made<S> {
    numbers: BTreeMap<(usize, S), usize>,
    keys: Vec<(usize, S)>,
}

impl<S: Clone + Ord> Made<S> {
    fn distinguish(&mut self, chain: &mut Chain<Frame3>, state: impl Fn(&Instance<Frame3>) -> S) {
        for instance in &mut chain.instances {
            let key = (instance.object, state(instance));
            let keys = &mut self.keys;
            instance.object = *self.numbers.entry(key.clone()).or_insert_with(|| {
                keys.push(key);
                keys.len() - 1
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::catalogue::Catalogue;
    use crate::diagnostic::Source;
    use crate::document::Document;
    use crate::geometry::Frame as _;
    use crate::grow::{Elements, Growth};
    use crate::model::Model;
    use crate::style::{ColorBy, Style};

    const RULE: &str = "space: 3
initiator: [[0, 0, 0], {to: [0, 1, 0], direction: 5}]
generator:
  parts:
    - connected: false
      elements:
        - {from: [0, 0, 0], to: [1/2, 0, 0], direction: 2}
        - {from: [1/2, 0, 0], to: [1, 0, 0], fertile: false, direction: 8}
    - {seeds: true, connected: false, elements: [{from: [0, 0, 1], to: [1/3, 0, 1], direction: 3}]}
";

    /// Objects of the graph that is drawn record the properties that the walk over the rule finds.
    #[test]
    fn objects_record_the_property_of_their_elements() {
        let source = Source::new("test", RULE);
        let document = Document::read(&source, &Catalogue::embedded()).unwrap();
        let model: Model = document.resolve(&[]).unwrap().0;
        for steps in 0..5 {
            let growth = Growth::steps(steps);
            let graph = model.graph_in_space(steps).unwrap().unwrap();
            let walked: Vec<_> = Elements::of(&graph, &growth).map(Result::unwrap).collect();
            for by in [
                ColorBy::Direction,
                ColorBy::Age,
                ColorBy::Index,
                ColorBy::Fractal,
            ] {
                let drawn = model.drawn_in_space(Some(steps), &growth, by);
                let drawn = drawn.unwrap().unwrap();
                let growth = Growth::steps(drawn.steps.unwrap());
                let found: Vec<_> = Elements::of(&drawn.graph, &growth)
                    .map(Result::unwrap)
                    .collect();
                assert_eq!(found.len(), walked.len());
                for ((fractal, element), (_, found)) in walked.iter().zip(&found) {
                    let expected = match by {
                        ColorBy::Direction => usize::from(element.frame.direction().number()) - 1,
                        ColorBy::Age => fractal.age as usize,
                        ColorBy::Index => usize::try_from(element.index - 1).unwrap(),
                        _ => usize::try_from(fractal.number).unwrap(),
                    };
                    let origin = drawn.graph.objects()[found.object].origin;
                    assert_eq!(origin, Some(expected), "{by:?} {steps}");
                    assert!(found.frame.map().abs_diff_eq(*element.frame.map(), 1e-12));
                }
                let mut style = Style {
                    color_by: by,
                    ..Style::default()
                };
                drawn.colour(&mut style);
                assert_eq!(style.color_by, ColorBy::Generator);
            }
        }
    }
}
