//! Maps of a model, evaluated from its programs to an arbitrary number of bits.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use dashu_int::IBig;

use crate::compile::Chords;
use crate::expression::{AffineOf, Arithmetic, Precise, Precision, Program};
use crate::graph::{Graph, Instance};
use crate::grow::{ReplacementContext, TraversalState};
use crate::ifs::System;
use crate::instancing::Instancing;
use crate::model::Model;
use crate::rule::{ListedElement, Rule};
use crate::symmetry::Symmetry;

use super::ZoomError;
use super::fixed::{Fixed, Vector};

/// Limit of the number of cached maps.
const MAX_KNOWN: usize = 1 << 12;

/// Element that is replaced.
#[derive(Clone, Copy)]
pub(super) struct Parent<'a> {
    pub(super) state: &'a TraversalState,
    pub(super) object: usize,
    pub(super) moment: ReplacementContext,
    /// Number of significant bits in the maps of its children.
    pub(super) bits: usize,
}

/// Evaluator of the maps of instances, in multiples of 2^-`bits`.
pub(super) struct Constants<'a> {
    graph: &'a Graph,
    precision: Precision,
    kind: Kind<'a>,
    /// Isometries of the images of the initiator, if it has any.
    images: Vec<Fixed>,
    /// Cached maps of fixed instances, by the behaviour of their parent and their position.
    known: HashMap<(usize, u32), Arc<Fixed>>,
}

enum Kind<'a> {
    Rule(OfRule<'a>),
    System(&'a System, Vec<Arc<Fixed>>),
    /// A structure, with the canonical objects of the graph's objects.
    Structure(&'a Instancing, Vec<Option<usize>>),
    Turtle(Chords),
}

/// Maps of a production rule.
struct OfRule<'a> {
    rule: &'a Rule,
    /// Points of the initiator.
    points: Vec<Vector>,
    /// Elements of every generator, by position.
    listed: Vec<Vec<&'a ListedElement>>,
}

impl<'a> Constants<'a> {
    /// Creates an evaluator for a model.
    ///
    /// # Errors
    ///
    /// If an L-system neither rewrites edges nor stands for its limit set: each number of steps then has its own initiator.
    pub(super) fn new(model: &'a Model, graph: &'a Graph, bits: usize) -> Result<Self, ZoomError> {
        let mut precision = Precision::new(bits);
        precision.set_parameters(&model.metadata().numbers);
        let kind = match model {
            Model::Rule(rule) => {
                let points = rule.written_points.iter();
                let points =
                    points.map(|point| fixed_point(&precise(&mut precision, point, &[]), bits));
                Kind::Rule(OfRule {
                    rule,
                    points: points.collect(),
                    listed: rule
                        .generators()
                        .iter()
                        .map(|it| it.elements().collect())
                        .collect(),
                })
            }
            Model::Ifs(system) => {
                let maps = system.written.iter().map(|map| {
                    let map = map.map(|number| number.evaluate(&mut precision, &[]));
                    Arc::new(Fixed::of(&map, bits))
                });
                let maps = maps.collect();
                Kind::System(system, maps)
            }
            // Its graph is none of the plane.
            Model::RuleInSpace(_)
            | Model::IfsInSpace(_)
            | Model::InstancingInSpace(_)
            | Model::LSystemInSpace(_) => return Err(ZoomError::NoReach),
            Model::Instancing(structure) => {
                Kind::Structure(structure, Graph::canonical_objects(structure))
            }
            Model::LSystem(system) => {
                Kind::Turtle(Chords::of(system, bits).ok_or(ZoomError::StartsAnew)?)
            }
        };
        let group = model.metadata().symmetry.as_ref();
        let group = group.filter(|_| graph.initiator(0).count() > 1);
        let isometry = |(group, number): (&Symmetry, u32)| {
            let isometry = group.precise(&mut precision, number)?;
            Some(Fixed::of(&isometry, bits))
        };
        let numbered = group
            .into_iter()
            .flat_map(|group| (0..).map(move |it| (group, it)));
        let images = numbered.map_while(isometry).collect();
        Ok(Self {
            graph,
            precision,
            kind,
            images,
            known: HashMap::new(),
        })
    }

    pub(super) fn bits(&self) -> usize {
        self.precision.bits()
    }

    /// Returns the shortest decimal that reads as a double, in multiples of 2^-`bits`.
    pub(super) fn written(&mut self, number: f64) -> IBig {
        self.precision.decimal(number).fixed(self.bits())
    }

    /// Returns a decimal without an exponent, in multiples of 2^-`bits`.
    pub(super) fn digits(&mut self, text: &str) -> IBig {
        self.precision.digits(text).fixed(self.bits())
    }

    /// Returns the map of an instance in the initiator or in an image of it.
    pub(super) fn root(&mut self, instance: &Instance) -> Arc<Fixed> {
        let [image, position] = self.graph.split_position(instance.position);
        let listed = self.listed(instance, position as usize);
        match self.images.get(image as usize) {
            // An affine composition, for the isometry's axes may be more precise than those of the element.
            Some(isometry) if image > 0 => {
                Arc::new(isometry.after(&listed, self.precision.bits(), false))
            }
            _ => listed,
        }
    }

    /// Returns the map of an instance in the initiator, at a position there.
    fn listed(&mut self, instance: &Instance, position: usize) -> Arc<Fixed> {
        if let Kind::Rule(OfRule { rule, points, .. }) = &self.kind {
            let element = &rule.initiator().elements[position];
            let [from, to] = [element.from, element.to].map(|point| &points[point]);
            return Arc::new(Fixed::between(from, to, element.direction));
        }
        // The initiator comes first, and its images have the directions and objects of its elements.
        let first = self.graph.initiator(0).fractal(0);
        let first = first.iter().find(|it| it.position as usize == position);
        self.child(None, first.unwrap_or(instance))
    }

    /// Returns the maps of instances in the replacement of an element.
    pub(super) fn children(&mut self, parent: Parent<'_>, wanted: &[&Instance]) -> Vec<Arc<Fixed>> {
        let object = &self.graph.objects()[parent.object];
        let is_fixed = object.successor().is_some();
        let key = |instance: &Instance| (object.behaviour, instance.position);
        if is_fixed {
            let known = wanted.iter().map(|instance| self.known.get(&key(instance)));
            if let Some(known) = known.map(|map| map.cloned()).collect() {
                return known;
            }
        }
        // Cached maps have full precision, because they may be used again where more is required.
        let needed = if is_fixed { self.bits() } else { parent.bits };
        self.precision.make_do_with(needed);
        let made: Vec<Arc<Fixed>> = match &self.kind {
            Kind::Rule(rule) => rule.children(self.graph, parent, wanted, &mut self.precision),
            _ => {
                let wanted = wanted.iter();
                wanted.map(|it| self.child(Some(parent), it)).collect()
            }
        };
        if is_fixed {
            if self.known.len() > MAX_KNOWN {
                self.known.clear();
            }
            let keys = wanted.iter().map(|instance| key(instance));
            self.known.extend(keys.zip(made.iter().cloned()));
        }
        made
    }

    /// Returns the map of an instance of a model that is no rule, in an object, or in the initiator if there
    /// is no parent.
    fn child(&mut self, parent: Option<Parent<'_>>, instance: &Instance) -> Arc<Fixed> {
        let bits = self.precision.bits();
        let position = instance.position as usize;
        match &self.kind {
            Kind::Rule(_) => unreachable!("the elements of a generator are evaluated together"),
            Kind::System(system, written) => {
                let origin = self.graph.objects()[instance.object].origin;
                let maps = system.ifs().maps();
                // The instance of a condensation set may have the origin of a map without being under it.
                let map = origin
                    .filter(|&map| parent.is_some() && maps[map].affine == *instance.frame.map());
                map.map_or_else(
                    || Arc::new(Fixed::identity(bits)),
                    |map| Arc::clone(&written[map]),
                )
            }
            Kind::Structure(structure, canonical) => {
                let object = |number: usize| canonical[number].map(|it| &structure.objects()[it]);
                let mut product = |transforms: &[AffineOf<Program>], slots: &[f64]| {
                    let slots: Vec<_> = slots.iter().copied().map(Precise::of).collect();
                    AffineOf::product(&mut self.precision, transforms, &slots)
                };
                let inner = match object(instance.object) {
                    Some(of) => product(&of.transforms, &of.slots),
                    None => product(&[], &[]),
                };
                let own = match parent {
                    Some(parent) => canonical[parent.object].map(|number| {
                        let (union, slots) = structure.drawn(number, parent.state.path);
                        product(&union[position].transforms, &slots)
                    }),
                    None => Some(product(&structure.scene()[position].transforms, &[])),
                };
                let map = own.map(|own| own.after(&mut self.precision, &inner));
                Arc::new(Fixed::of(&map.unwrap_or(inner), bits))
            }
            Kind::Turtle(Chords { initiator, objects }) => {
                let lines = parent.map_or(initiator, |parent| &objects[parent.object]);
                let [from, to] = &lines[position];
                Arc::new(Fixed::between(from, to, instance.frame.direction()))
            }
        }
    }
}

impl OfRule<'_> {
    fn children(
        &self,
        graph: &Graph,
        parent: Parent<'_>,
        wanted: &[&Instance],
        precision: &mut Precision,
    ) -> Vec<Arc<Fixed>> {
        let first = wanted.first();
        let Some(number) = first.and_then(|it| graph.objects()[it.object].origin) else {
            return Vec::new();
        };
        let generator = &self.rule.generators()[number];
        let moment = parent.moment.seen(parent.state);
        let slots = generator.slots(&moment, parent.state.path);
        let slots: Vec<_> = slots.into_iter().map(Precise::of).collect();
        let mut points = BTreeMap::new();
        for instance in wanted {
            let element = self.listed[number][instance.position as usize];
            for point in [element.from, element.to] {
                let made = points.entry(point);
                made.or_insert_with(|| precise(precision, &generator.points[point], &slots));
            }
        }
        for moving in &generator.moves {
            let mut moved = moving.points.iter().filter(|it| points.contains_key(it));
            if moved.next().is_none() {
                continue;
            }
            let map = moving.map(precision, |of, program| program.evaluate(of, &slots));
            for point in &*moving.points {
                if let Some(point) = points.get_mut(point) {
                    *point = map.image(precision, point);
                }
            }
        }
        let bits = precision.bits();
        let child = |instance: &&Instance| {
            let element = self.listed[number][instance.position as usize];
            let [from, to] =
                [element.from, element.to].map(|point| fixed_point(&points[&point], bits));
            Arc::new(Fixed::between(&from, &to, element.direction))
        };
        wanted.iter().map(child).collect()
    }
}

/// Evaluates the coordinates of a point.
fn precise(of: &mut Precision, point: &[Program; 2], slots: &[Precise]) -> [Precise; 2] {
    point.each_ref().map(|number| number.evaluate(of, slots))
}

/// Returns a point in multiples of 2^-`bits`.
fn fixed_point(point: &[Precise; 2], bits: usize) -> Vector {
    point.each_ref().map(|number| number.fixed(bits))
}
