//! Maps of a file, evaluated to an arbitrary number of bits.

mod rule;
mod structure;
mod system;
mod turtle;

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use dashu_int::IBig;

use crate::document::{KindDocument, MetadataDocument, Number, Point, Setting};
use crate::expression::{Precise, Precision};
use crate::graph::{Graph, Instance, Replacement};
use crate::grow::{ReplacementContext, Standing};
use crate::model::Model;
use crate::resolve::order_of_parameters;

use super::fixed::{Fixed, Vector};
use super::{ZoomError, ZoomSource};

/// Limit of the number of cached maps.
const MOST_KNOWN: usize = 1 << 12;

/// Element that is replaced.
#[derive(Clone, Copy)]
pub(super) struct Parent<'a> {
    pub(super) standing: &'a Standing,
    pub(super) object: usize,
    pub(super) moment: ReplacementContext,
    /// Number of significant bits in the maps of its children.
    pub(super) bits: usize,
}

/// Evaluator of the maps of instances, in multiples of 2^-`bits`.
pub(super) struct Constants<'a> {
    graph: &'a Graph,
    numbers: Numbers,
    kind: Kind<'a>,
    /// Cached maps of fixed instances, by the behaviour of their parent and their position.
    known: HashMap<(usize, u32), Arc<Fixed>>,
}

enum Kind<'a> {
    Rule(rule::OfRule<'a>),
    System(system::OfSystem<'a>),
    Structure(structure::OfStructure<'a>),
    Turtle(turtle::OfTurtle),
}

/// Evaluator of numbers as written.
struct Numbers {
    precision: Precision,
    /// Parameters of the file.
    params: BTreeMap<String, Precise>,
}

/// Names that expressions see beside parameters, with their values.
type Names<'n> = &'n [(&'n str, Precise)];

impl<'a> Constants<'a> {
    /// Creates an evaluator for a model and its file.
    ///
    /// # Errors
    ///
    /// If an L-system does not rewrite edges: each number of steps then has its own initiator.
    pub(super) fn new(
        source: &ZoomSource<'a>,
        graph: &'a Graph,
        bits: usize,
    ) -> Result<Self, ZoomError> {
        let document = source.document.kind();
        let mut numbers = Numbers {
            precision: Precision::new(bits),
            params: BTreeMap::new(),
        };
        numbers.read_parameters(document.metadata(), source.settings);
        let kind = match (document, source.model) {
            (KindDocument::Rule(document), Model::Rule(rule)) => {
                Kind::Rule(rule::OfRule::new(document, rule, &mut numbers))
            }
            (KindDocument::Ifs(document), Model::Ifs(system)) => {
                let omitted = source.omitted;
                Kind::System(system::OfSystem::new(
                    document,
                    system,
                    omitted,
                    &mut numbers,
                ))
            }
            (KindDocument::Instancing(document), Model::Instancing(structure)) => {
                Kind::Structure(structure::OfStructure::new(document, structure))
            }
            (KindDocument::LSystem(_), Model::LSystem(system)) => {
                let turtle = turtle::OfTurtle::new(system, bits);
                Kind::Turtle(turtle.ok_or(ZoomError::StartsAnew)?)
            }
            _ => unreachable!("a model is of the kind of its document"),
        };
        Ok(Self {
            graph,
            numbers,
            kind,
            known: HashMap::new(),
        })
    }

    pub(super) fn bits(&self) -> usize {
        self.numbers.bits()
    }

    /// Returns the shortest decimal that reads as a double, in multiples of 2^-`bits`.
    pub(super) fn written(&self, number: f64) -> IBig {
        self.numbers.precision.written(number).fixed(self.bits())
    }

    /// Returns the map of an instance in the initiator.
    pub(super) fn root(&mut self, instance: &Instance) -> Arc<Fixed> {
        Arc::new(match &mut self.kind {
            Kind::Rule(rule) => rule.root(instance),
            Kind::System(_) => Fixed::identity(self.numbers.bits()),
            Kind::Structure(structure) => structure.child(None, instance, &mut self.numbers),
            Kind::Turtle(turtle) => turtle.child(None, instance),
        })
    }

    /// Returns the maps of instances in the replacement of an element.
    pub(super) fn children(&mut self, parent: Parent<'_>, wanted: &[&Instance]) -> Vec<Arc<Fixed>> {
        let object = &self.graph.objects()[parent.object];
        let is_fixed = matches!(object.replacement, Replacement::Fixed(_));
        let key = |instance: &Instance| (object.behaviour, instance.position);
        if is_fixed {
            let known = wanted.iter().map(|instance| self.known.get(&key(instance)));
            if let Some(known) = known.map(|map| map.cloned()).collect() {
                return known;
            }
        }
        // Cached maps have full precision, because they may be used again where more is required.
        let needed = if is_fixed { self.bits() } else { parent.bits };
        self.numbers.precision.make_do_with(needed);
        let made: Vec<Arc<Fixed>> = match &mut self.kind {
            Kind::Rule(rule) => rule.children(self.graph, parent, wanted, &mut self.numbers),
            Kind::System(system) => {
                let bits = self.numbers.bits();
                let child = |instance: &&Instance| system.child(self.graph, instance, bits);
                wanted.iter().map(child).collect()
            }
            Kind::Structure(structure) => {
                let mut child = |instance: &&Instance| {
                    structure.child(Some(parent.object), instance, &mut self.numbers)
                };
                wanted.iter().map(|it| Arc::new(child(it))).collect()
            }
            Kind::Turtle(turtle) => {
                let child = |it: &&Instance| turtle.child(Some(parent.object), it);
                wanted.iter().map(|it| Arc::new(child(it))).collect()
            }
        };
        if is_fixed {
            if self.known.len() > MOST_KNOWN {
                self.known.clear();
            }
            let keys = wanted.iter().map(|instance| key(instance));
            self.known.extend(keys.zip(made.iter().cloned()));
        }
        made
    }
}

impl Numbers {
    fn bits(&self) -> usize {
        self.precision.bits()
    }

    /// Evaluates the parameters, each after those on which its value depends.
    fn read_parameters(&mut self, heading: &MetadataDocument, settings: &[Setting]) {
        let (order, _) = order_of_parameters(&heading.params);
        for index in order {
            let written = &heading.params[index];
            let name = &written.name.value;
            let set = settings.iter().rfind(|setting| setting.name == *name);
            let value = match set {
                Some(Setting {
                    written: Some(written),
                    ..
                }) => self.precision.value(written, &|_| None),
                Some(setting) => self.precision.written(setting.value),
                None => self.number(&written.value, &[]),
            };
            self.params.insert(name.clone(), value);
        }
    }

    fn number(&mut self, number: &Number, names: Names<'_>) -> Precise {
        let Self { precision, params } = self;
        precision.value(&number.value, &|name| {
            let own = names.iter().find(|(own, _)| *own == name);
            own.map(|(_, value)| value)
                .or_else(|| params.get(name))
                .cloned()
        })
    }

    /// Evaluates a number in multiples of 2^-`bits`.
    fn fixed(&mut self, number: &Number, names: Names<'_>) -> IBig {
        let value = self.number(number, names);
        value.fixed(self.bits())
    }

    fn point(&mut self, point: &Point, names: Names<'_>) -> Vector {
        [&point.x, &point.y].map(|number| self.fixed(number, names))
    }

    /// Returns the cosine and sine of an angle in degrees.
    fn turn(&mut self, angle: &Number, names: Names<'_>) -> Vector {
        let angle = self.number(angle, names);
        let [sine, cosine] = self.precision.sine_cosine(&angle);
        [cosine, sine].map(|value| value.fixed(self.bits()))
    }
}
