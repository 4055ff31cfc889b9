//! Graphs between two steps: the last replacement is drawn while it grows.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use crate::draws::Path;
use crate::expression::Interval;
use crate::geometry::Frame;
use crate::graph::{
    Alternative, Between, Buffers, Chain, CompileError, Graph, Object, Replacement, Source,
    Successor,
};
use crate::ifs::System;
use crate::instancing::Instancing;
use crate::rule::{ElementContext, Extent, GrowthStart, Part, Rule, RuleFrame};
use crate::tween::{Growing, Grown};

impl<F: Frame> Graph<F> {
    /// Returns the graph one step of which is drawn while it grows, resolved for this number of steps: `grown` returns the
    /// frame of an instance that appears in this step, from the number of its base element, from its frame in the
    /// replaced element, and from whether it starts a new fractal.
    ///
    /// On their way, elements are within every ball about the middle of the replaced element that contains it and their
    /// places.
    pub(super) fn growing(
        mut self,
        Growing { steps, share }: Growing,
        grown: impl Fn(usize, &F, bool) -> F + Send + Sync + 'static,
    ) -> Self {
        if steps == 0 {
            return self;
        }
        let mut aged = Aged {
            graph: &self,
            steps,
            grown: &grown,
            numbers: BTreeMap::new(),
            keys: Vec::new(),
            made: BTreeMap::new(),
        };
        let mut initiators = self.initiators.clone();
        initiators.iter_mut().for_each(|chain| aged.chain(chain, 0));
        let mut objects: Vec<Object<F>> = Vec::new();
        let mut behaviours = BTreeMap::new();
        while let Some(&(number, age)) = aged.keys.get(objects.len()) {
            let own = &self.objects[number];
            let next = behaviours.len();
            let behaviour = *behaviours.entry((own.behaviour, age)).or_insert(next);
            let replacement = aged.replacement(&own.replacement, age);
            objects.push(Object {
                behaviour,
                replacement,
                ..own.clone()
            });
        }
        let base_elements: Vec<_> = objects.iter().map(|it| it.base_element).collect();
        let whole = Arc::new(self.clone());
        self.between = Some(Between { share, whole });
        let is_unresolved = objects.iter().any(Object::is_unresolved);
        self.depth = is_unresolved.then_some(steps);
        self.objects = objects;
        *self.initiators_mut() = initiators;
        self.source = self.source.map(|of| {
            Arc::new(LastGrows {
                of,
                last: f64::from(steps) - 1.0,
                base_elements,
                grown,
                affine: self.affine,
            }) as _
        });
        self
    }
}

/// Returns the graph of a rule, in which a step grows if the rule has one that does. Elements begin where
/// [`Rule::starts_of_growth`] has them, and seeds of filled shapes and solids as points.
pub(super) fn of_rule<F: RuleFrame>(rule: &Rule<F>, graph: Graph<F>) -> Graph<F> {
    let Some(growing @ Growing { share, .. }) = rule.growing else {
        return graph;
    };
    let starts = rule.starts_of_growth();
    let graph = Graph {
        affine: graph.affine || !F::GROWS_SIMILAR,
        ..graph
    };
    graph.growing(growing, move |base_element, frame, is_seed| {
        let start = match starts[base_element] {
            GrowthStart::Element if is_seed => GrowthStart::Point,
            start => start,
        };
        frame.grown(start, share)
    })
}

/// Returns the graph of a system, in which a step grows if the system has one that does. Images begin as the set of which
/// they are images; those that form one line rise from its chord.
pub(crate) fn of_system<M: Grown>(system: &System<M>, graph: Graph<M::Frame>) -> Graph<M::Frame> {
    let Some(growing @ Growing { share, .. }) = system.growing else {
        return graph;
    };
    let chained = system.chained;
    graph.growing(growing, move |_, frame, _| {
        let map = frame.map();
        M::Frame::from(match chained {
            true => map.raised(share),
            false => map.turned(share),
        })
    })
}

/// Returns the graph of a structure, in which a step grows if the structure has one that does. Objects that are drawn
/// begin as the object that they replace, and shapes grow out of their origins.
pub(crate) fn of_structure<M: Grown>(
    structure: &Instancing<M>,
    graph: Graph<M::Frame>,
) -> Graph<M::Frame> {
    let Some(growing @ Growing { share, .. }) = structure.growing else {
        return graph;
    };
    // Without shapes, objects are drawn as boxes; otherwise the first base element is the initial set.
    let has_shapes = structure.draws_anything();
    graph.growing(growing, move |base_element, frame, _| {
        let map = frame.map();
        M::Frame::from(match has_shapes && base_element > 0 {
            true => map.out_of_point(share),
            false => map.turned(share),
        })
    })
}

/// Objects of a graph that have been reached, each with its age: the number of steps after which it is drawn.
struct Aged<'g, F: Frame, G> {
    graph: &'g Graph<F>,
    steps: u32,
    grown: &'g G,
    numbers: BTreeMap<(usize, u32), usize>,
    keys: Vec<(usize, u32)>,
    /// Replacements by the address of those of the graph, which objects share, and by age.
    made: BTreeMap<(usize, u32), Replacement<F>>,
}

impl<F: Frame, G: Fn(usize, &F, bool) -> F> Aged<'_, F, G> {
    /// Returns the number of an object of an age; objects that are kept have none.
    fn number(&mut self, object: usize, age: u32) -> usize {
        let age = match self.graph.objects[object].is_kept() {
            true => 0,
            false => age,
        };
        let next = self.keys.len();
        let number = *self.numbers.entry((object, age)).or_insert(next);
        if number == next {
            self.keys.push((object, age));
        }
        number
    }

    fn chain(&mut self, chain: &mut Chain<F>, age: u32) {
        for instance in &mut chain.instances {
            instance.object = self.number(instance.object, age);
        }
    }

    /// Returns the replacement of objects of an age.
    fn replacement(&mut self, own: &Replacement<F>, age: u32) -> Replacement<F> {
        let address = match own {
            Replacement::Kept => return Replacement::Kept,
            _ if age == self.steps => return Replacement::Unresolved,
            Replacement::Unresolved => return Replacement::Unresolved,
            Replacement::Fixed(successor) => Arc::as_ptr(successor).addr(),
            Replacement::Evaluated(alternatives) => Arc::as_ptr(alternatives).addr(),
        };
        if let Some(made) = self.made.get(&(address, age)) {
            return made.clone();
        }
        let aged = self.aged(own, age);
        self.made.insert((address, age), aged.clone());
        aged
    }

    fn aged(&mut self, own: &Replacement<F>, age: u32) -> Replacement<F> {
        match own {
            Replacement::Kept | Replacement::Unresolved => own.clone(),
            Replacement::Fixed(successor) => {
                let mut successor = Successor::clone(successor);
                if age + 1 == self.steps {
                    let (graph, grown) = (self.graph, self.grown);
                    let base_element = |object: usize| graph.objects[object].base_element;
                    grow(&mut successor, graph.affine, |object, frame, is_seed| {
                        grown(base_element(object), frame, is_seed)
                    });
                }
                self.chain(&mut successor.body, age + 1);
                for seed in &mut successor.seeds {
                    self.chain(&mut seed.chain, age + 1);
                }
                Replacement::Fixed(Arc::new(successor))
            }
            Replacement::Evaluated(alternatives) => {
                let aged = alternatives.iter().map(|alternative| Alternative {
                    objects: { alternative.objects.iter() }
                        .map(|&object| self.number(object, age + 1))
                        .collect(),
                    ..alternative.clone()
                });
                Replacement::Evaluated(aged.collect())
            }
        }
    }
}

/// Replaces the frames of instances, whose objects are given by number.
fn grow<F: Frame>(
    successor: &mut Successor<F>,
    affine: bool,
    grown: impl Fn(usize, &F, bool) -> F,
) {
    let Successor { body, seeds } = successor;
    let seeds = seeds.iter_mut().map(|seed| (&mut seed.chain, true));
    for (chain, is_seed) in seeds.chain([(body, false)]) {
        for instance in &mut chain.instances {
            instance.frame = grown(instance.object, &instance.frame, is_seed);
            instance.length = match affine {
                true => instance.frame.stretch(),
                false => instance.frame.length(),
            };
        }
    }
}

/// Source of instances of which those of the last step grow.
struct LastGrows<F: Frame, G> {
    of: Arc<dyn Source<F>>,
    /// Number of the approximant whose replacement grows.
    last: f64,
    /// Base elements of the objects.
    base_elements: Vec<usize>,
    grown: G,
    affine: bool,
}

impl<F: Frame, G> fmt::Debug for LastGrows<F, G> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { of, last, .. } = self;
        f.debug_struct("LastGrows")
            .field("of", of)
            .field("last", last)
            .finish_non_exhaustive()
    }
}

impl<F: Frame, G: Fn(usize, &F, bool) -> F + Send + Sync> Source<F> for LastGrows<F, G> {
    fn evaluate(
        &self,
        alternatives: &[Alternative],
        path: Path,
        context: &ElementContext,
        buffers: &mut Buffers<F>,
        successor: &mut Successor<F>,
    ) -> Result<(), CompileError> {
        self.of
            .evaluate(alternatives, path, context, buffers, successor)?;
        if context.step >= self.last {
            grow(successor, self.affine, |object, frame, is_seed| {
                (self.grown)(self.base_elements[object], frame, is_seed)
            });
        }
        Ok(())
    }

    fn parts(&self, generator: usize) -> &[Part] {
        self.of.parts(generator)
    }

    fn extents(
        &self,
        generator: usize,
        power: f64,
        moments: &[Interval; 4],
        middle: F::Point,
    ) -> Vec<Extent> {
        // Elements on their way lie between the replaced element and their places.
        self.of.extents(generator, power, moments, middle)
    }
}
