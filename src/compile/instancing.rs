//! Compilation of a structure of objects to its graph.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::extent::{Bounded, LimitBoxes};
use crate::geometry::{Bounds, Frame};
use crate::instancing::{self, Instancing, Master, Tint};

use crate::graph::{Chain, Graph, Instance, Object, Replacement, Successor};
use crate::ifs::{AffineMap, OutlineOf, PointOf};

/// Limit of the number of objects that are drawn as boxes of their own if nothing else is drawn.
const MAX_BOXES: usize = 256;

/// Number of states looked at after which no further box is computed.
const MAX_LOOKED: usize = 250_000;

/// Bounding boxes of the subtrees of objects, as far as they are few and take little work.
struct ObjectBoxes<'b, 'g, F: Frame> {
    limits: &'b LimitBoxes<'g, F>,
    /// Number of states that were looked at before.
    looked: usize,
    /// Number of boxes that were asked for.
    asked: usize,
}

impl<'b, 'g, F: Bounded> ObjectBoxes<'b, 'g, F> {
    fn of(limits: &'b LimitBoxes<'g, F>) -> Self {
        Self {
            limits,
            looked: limits.looked(),
            asked: 0,
        }
    }

    /// Returns the bounding box of the subtree of an object.
    fn box_of(&mut self, object: usize) -> Option<Bounds<F::Point>> {
        self.asked += 1;
        if self.asked > MAX_BOXES || self.limits.looked() - self.looked > MAX_LOOKED {
            return None;
        }
        self.limits.at_object(object)
    }
}

impl<F: Bounded> Graph<F> {
    /// Compiles a structure to its graph, whose unit frame is the plane or space itself.
    ///
    /// Approximant 0 is the scene, in which an instance of an object is drawn as the initial set, if
    /// there is one, under the map that the object applies to itself; each step replaces instances of
    /// objects by the instances of which the objects consist. Shapes are infertile. Without shapes and
    /// initial set, an object is drawn as the bounding box of its limit set; alternatives, of which one is drawn at random,
    /// count together there, under representative maps where maps are drawn.
    #[must_use]
    pub fn of_structure<M: AffineMap<Frame = F>>(structure: &Instancing<M>) -> Self {
        let (mut graph, canonical) = Compiler::new(structure).run();
        let limit = match structure.draws_anything() {
            true => graph.limit_bounds(),
            false => graph.draw_boxes::<M>(),
        };
        let extent = limit.or_else(|| graph.bounds(0));
        if let Some(bounds) = extent.filter(|bounds| !bounds.is_empty()) {
            graph.set_extent(&bounds);
        }
        graph.draw_unions(structure, &canonical);
        graph.limit_bounds = (!graph.draws).then_some(limit);
        graph
    }

    /// Returns, for every object of the graph of a structure, its canonical object; `None` for shapes.
    pub(crate) fn canonical_objects<M: AffineMap<Frame = F>>(
        structure: &Instancing<M>,
    ) -> Vec<Option<usize>> {
        let mut compiler = Compiler::new(structure);
        compiler.reach();
        compiler.of
    }

    /// Draws every object as the bounding box of its limit set. Returns that of the whole.
    fn draw_boxes<M: AffineMap<Frame = F>>(&mut self) -> Option<Bounds<F::Point>> {
        // The limit set contains visible objects only.
        self.objects
            .iter_mut()
            .for_each(|object| object.visible = true);
        let limits = self.limit_boxes();
        let whole = { limits.as_ref() }.and_then(|it| it.at(&self.initiator(0).instances));
        // If one box takes too long, the others do as well.
        let is_cheap = |limits: &&LimitBoxes<F>| whole.is_some() || limits.looked() <= MAX_LOOKED;
        let mut known = { limits.as_ref().filter(is_cheap) }.map(ObjectBoxes::of);
        let mut boxes: Vec<Option<Bounds<F::Point>>> = Vec::new();
        for (number, _) in self.behaviours_by_number() {
            let is_cheap = boxes.last().is_none_or(Option::is_some);
            let known = known.as_mut().filter(|_| is_cheap);
            boxes.push(known.and_then(|known| known.box_of(number)));
        }
        let first = self.base_elements.len();
        let boxes = boxes.into_iter().map(M::filling);
        self.base_elements = self.base_elements.iter().cloned().chain(boxes).collect();
        for object in &mut self.objects {
            object.base_element = first + object.behaviour;
        }
        whole
    }

    /// Returns the bounding boxes of the subtrees of some objects of a structure, in their own
    /// coordinates; `None` where one is unknown.
    pub(crate) fn boxes_of<M: AffineMap<Frame = F>>(
        structure: &Instancing<M>,
        objects: &[usize],
    ) -> Vec<Option<Bounds<PointOf<M>>>> {
        let scene = objects.iter().map(|&number| instancing::ObjectInstance {
            map: M::IDENTITY,
            master: Master::Object(number),
            tint: None,
            transforms: Arc::default(),
            forms: Arc::default(),
        });
        let alone = Instancing {
            scene: scene.collect(),
            ..structure.clone()
        };
        let (mut graph, _) = Compiler::new(&alone).run();
        if !alone.draws_anything() {
            graph
                .objects
                .iter_mut()
                .for_each(|object| object.visible = true);
        }
        let limits = graph.limit_boxes();
        let mut known = limits.as_ref().map(ObjectBoxes::of);
        let roots = graph.initiator(0).instances.iter();
        roots
            .map(|root| known.as_mut()?.box_of(root.object))
            .collect()
    }
}

/// Creates an instance with a map, not joined to any other.
pub(super) fn instance<M: AffineMap>(
    object: usize,
    map: &M,
    position: usize,
) -> Instance<M::Frame> {
    let frame = M::Frame::from(*map);
    Instance {
        length: frame.stretch(),
        ..Instance::new(object, frame, u32::try_from(position).unwrap_or(u32::MAX))
    }
}

/// Canonical object or shape, by number.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum CanonicalNode {
    Canonical(usize),
    /// Shape, by the number of its base element.
    Shape(usize),
}

struct Compiler<'s, M: AffineMap> {
    structure: &'s Instancing<M>,
    base_elements: Vec<OutlineOf<M>>,
    objects: Vec<Object<M::Frame>>,
    /// Numbers of base elements, by their outlines.
    outlines: BTreeMap<Vec<u64>, usize>,
    /// Numbers of objects, by canonical object or shape, and by tint.
    numbers: BTreeMap<(CanonicalNode, Option<[u64; 6]>), usize>,
    /// Canonical object of every object of the graph.
    of: Vec<Option<usize>>,
}

impl<'s, M: AffineMap> Compiler<'s, M> {
    fn new(structure: &'s Instancing<M>) -> Self {
        let initial = { structure.initial.as_ref() }.map(|set| M::outlines(set).swap_remove(0));
        Self {
            structure,
            base_elements: vec![initial.unwrap_or_else(M::unseen)],
            objects: Vec::new(),
            outlines: BTreeMap::new(),
            numbers: BTreeMap::new(),
            of: Vec::new(),
        }
    }

    /// Creates the objects that the scene reaches, and returns the scene as the initiator.
    fn reach(&mut self) -> Chain<M::Frame> {
        let initiator = self.chain(&self.structure.scene);
        // Graph objects of one canonical object share its successor.
        let mut made: BTreeMap<usize, Arc<Successor<M::Frame>>> = BTreeMap::new();
        let mut behaviours: BTreeMap<Option<usize>, usize> = BTreeMap::new();
        let mut done = 0;
        while done < self.objects.len() {
            let of = self.of[done];
            let next = behaviours.len();
            self.objects[done].behaviour = *behaviours.entry(of).or_insert(next);
            if let Some(canonical) = of {
                let successor = match made.get(&canonical) {
                    Some(successor) => Arc::clone(successor),
                    None => {
                        let object = &self.structure.objects[canonical];
                        let successor = Arc::new(self.chain(&object.instances).into());
                        made.insert(canonical, Arc::clone(&successor));
                        successor
                    }
                };
                self.objects[done].replacement = Replacement::Fixed(successor);
            }
            done += 1;
        }
        initiator
    }

    /// Returns the graph, with the canonical object of each of its objects. An object with alternatives consists of all of
    /// them.
    fn run(mut self) -> (Graph<M::Frame>, Vec<Option<usize>>) {
        let initiator = self.reach();
        let tints = self.objects.iter().any(|object| object.tint.is_some());
        let graph = Graph {
            tints,
            affine: true,
            ..Graph::of(self.objects, self.base_elements, vec![initiator])
        };
        (graph, self.of)
    }

    fn chain(&mut self, instances: &[instancing::ObjectInstance<M>]) -> Chain<M::Frame> {
        let numbered = instances.iter().enumerate();
        let placed = numbered.map(|(position, of)| {
            let map = self.structure.map_of(of);
            instance(self.object(of), &map, position)
        });
        Chain::loose(placed.collect())
    }

    /// Returns the graph object of an instance, which is created if it is new.
    fn object(&mut self, instance: &instancing::ObjectInstance<M>) -> usize {
        let kind = match &instance.master {
            Master::Object(number) => CanonicalNode::Canonical(*number),
            Master::Shape(shape) => CanonicalNode::Shape(self.base_element(shape)),
        };
        let made = self.objects.len();
        let key = (kind, instance.tint.map(Tint::bits));
        let number = *self.numbers.entry(key).or_insert(made);
        if number == made {
            let (base_element, visible, of) = match kind {
                CanonicalNode::Canonical(number) => {
                    (0, self.structure.initial.is_some(), Some(number))
                }
                CanonicalNode::Shape(base_element) => (base_element, true, None),
            };
            self.objects.push(Object {
                visible,
                tint: instance.tint,
                ..Object::kept(base_element)
            });
            self.of.push(of);
        }
        number
    }

    /// Returns the base element of a shape, which is never that of the initial set.
    fn base_element(&mut self, shape: &M::Set) -> usize {
        let made = M::outlines(shape).swap_remove(0);
        let next = self.base_elements.len();
        let number = *self.outlines.entry(M::key(&made)).or_insert(next);
        if number == next {
            self.base_elements.push(made);
        }
        number
    }
}
