//! The common form of all kinds: objects and their instances.

use crate::extent::{Bounded, NoLimit};
use crate::geometry::{DAffine2, Frame};
use crate::graph::{Graph, Instance, Replacement};
use crate::ifs::{AffineMap, Ifs, OutlineOf};
use crate::instancing::Tint;

use super::{Keeps, Refusal};

/// An instance: a map of an object or of a shape that is kept.
#[derive(Clone, Debug)]
pub(super) struct PlacedObject<M = DAffine2> {
    pub(super) map: M,
    /// Index of the shape that is drawn until the instance is replaced.
    pub(super) shape: usize,
    pub(super) visible: bool,
    pub(super) tint: Option<Tint>,
    /// Index of the object; `None` if the instance is kept.
    pub(super) object: Option<usize>,
}

/// A model, decomposed into objects and instances.
pub(super) struct Structure<M: AffineMap = DAffine2> {
    /// Shapes of instances.
    pub(super) shapes: Vec<OutlineOf<M>>,
    /// Instances in each object; never empty.
    pub(super) objects: Vec<Vec<PlacedObject<M>>>,
    /// Instances of the scene, which are approximant 0; never empty.
    pub(super) scene: Vec<PlacedObject<M>>,
    /// Terms of messages about instances.
    pub(super) words: Terms,
    /// Names of the objects in the file, by index, if it has names.
    pub(super) names: Vec<String>,
}

/// Terms for the parts of a file.
#[derive(Clone, Copy)]
pub(super) enum Terms {
    Maps,
    Instances,
    Elements,
}

impl<M: AffineMap> Structure<M> {
    /// Decomposes a graph into objects, one for each behaviour; a time-indexed graph is decomposed for a
    /// number of steps. Where only the limit set is kept, objects that contribute nothing to it are left out.
    /// `names` are the names of the graph's objects in the file, or empty.
    ///
    /// # Errors
    ///
    /// Returns an error if the scene is empty, or if an object in it is replaced by nothing.
    pub(super) fn of_graph(
        graph: &Graph<M::Frame>,
        steps: u32,
        keeps: Keeps,
        names: &[String],
    ) -> Result<Self, Refusal>
    where
        M::Frame: Bounded,
    {
        let alive = match keeps {
            Keeps::Limit => graph.alive(true),
            Keeps::Approximants if graph.links() => {
                let what = "lines join base elements in it that do not end where their frames do";
                return Err(Refusal::Steps(what));
            }
            Keeps::Approximants => vec![true; graph.objects().len()],
        };
        let placed = |instance: &Instance<M::Frame>| {
            let object = &graph.objects()[instance.object];
            let ends = matches!(
                object.replacement,
                Replacement::Kept | Replacement::Unresolved
            );
            let paint = object.paint.filter(|_| ends);
            let paint = paint.map(|colour| Tint::cover(colour, 1.0));
            PlacedObject {
                map: *instance.frame.map(),
                shape: object.base_element,
                visible: object.visible,
                tint: object.tint.or(paint),
                object: (!ends).then_some(object.behaviour),
            }
        };
        let mut live = vec![false; graph.behaviours().count()];
        for (object, alive) in graph.objects().iter().zip(&alive) {
            live[object.behaviour] |= alive;
        }
        // Invisible elements that are kept draw nothing at any step.
        let stays = |instance: &&Instance<M::Frame>| {
            let object = &graph.objects()[instance.object];
            match object.replacement {
                Replacement::Kept => object.visible,
                _ => live[object.behaviour],
            }
        };
        let (mut objects, mut called) = (Vec::new(), Vec::new());
        for (number, object) in graph.behaviours_by_number() {
            called.extend(names.get(number).cloned());
            objects.push(match &object.replacement {
                Replacement::Fixed(production) => {
                    let all = production.placed_instances().map(|(_, instance)| instance);
                    all.filter(&stays).map(placed).collect()
                }
                _ => Vec::new(),
            });
        }
        let initiator = graph.initiator(steps).instances.iter();
        let structure = Self {
            shapes: graph.base_elements().to_vec(),
            objects,
            scene: initiator.filter(&stays).map(placed).collect(),
            words: if graph.is_affine() {
                Terms::Instances
            } else {
                Terms::Elements
            },
            names: called,
        }
        .renumbered();
        if structure.scene.is_empty() {
            return Err(NoLimit::Empty.into());
        }
        if structure.objects.iter().any(Vec::is_empty) {
            return Err(Refusal::Steps("an element in it vanishes"));
        }
        Ok(structure)
    }

    /// Decomposes a system into the objects of its digraph (Hart 1992, section 3.3): one for the set that
    /// every map has just moved, or a single one where any map may follow any other. `shapes` are the
    /// outlines of the initial set and of the condensation sets.
    pub(super) fn of_ifs(ifs: &Ifs<M>, shapes: Vec<OutlineOf<M>>) -> Self {
        // An initial set of several outlines is not a shape. The limit set does not depend on it.
        let is_shape = ifs.initial().is_none_or(|set| M::outlines(set).len() == 1);
        let placed = |map: M, shape: usize, object: Option<usize>| PlacedObject {
            map,
            shape,
            visible: object.is_none() || is_shape,
            tint: None,
            object,
        };
        let count = { ifs.condensation().iter() }.map(|set| M::outlines(&set.shape).len());
        let count: usize = count.sum();
        let sets = || 1..=count;
        let drawn = || sets().map(|set| placed(M::IDENTITY, set, None));
        let maps = ifs.maps().iter().map(|map| map.affine);
        let (objects, scene) = if let Some(successors) = ifs.successors() {
            let mut objects: Vec<Vec<PlacedObject<M>>> = vec![Vec::new(); ifs.maps().len()];
            for (before, successors) in successors.iter().enumerate() {
                for &map in successors {
                    objects[map].push(placed(ifs.maps()[map].affine, 0, Some(before)));
                }
            }
            for (object, map) in objects.iter_mut().zip(maps) {
                object.extend(sets().map(|set| placed(map, set, None)));
            }
            let all = (0..objects.len()).map(|object| placed(M::IDENTITY, 0, Some(object)));
            let scene = all.chain(drawn()).collect();
            (objects, scene)
        } else {
            let maps = maps.map(|map| placed(map, 0, Some(0)));
            let scene = vec![placed(M::IDENTITY, 0, Some(0))];
            (vec![maps.chain(drawn()).collect()], scene)
        };
        Self {
            shapes,
            objects,
            scene,
            words: Terms::Maps,
            names: Vec::new(),
        }
    }

    /// Returns the structure with only those objects that the scene leads to, in breadth-first order.
    fn renumbered(self) -> Self {
        let mut numbers = vec![None; self.objects.len()];
        let mut order = Vec::new();
        let mut visit = |placed: &PlacedObject<M>, order: &mut Vec<usize>| {
            if let Some(object) = placed.object
                && numbers[object].is_none()
            {
                numbers[object] = Some(order.len());
                order.push(object);
            }
        };
        self.scene
            .iter()
            .for_each(|placed| visit(placed, &mut order));
        let mut done = 0;
        while let Some(&object) = order.get(done) {
            let placed = self.objects[object].iter();
            placed.for_each(|placed| visit(placed, &mut order));
            done += 1;
        }
        let renumbered = |all: &[PlacedObject<M>]| -> Vec<PlacedObject<M>> {
            let all = all.iter().cloned();
            all.map(|placed| PlacedObject {
                object: placed.object.and_then(|object| numbers[object]),
                ..placed
            })
            .collect()
        };
        let names = order.iter().filter_map(|&object| self.names.get(object));
        Self {
            names: names.cloned().collect(),
            objects: order
                .iter()
                .map(|&object| renumbered(&self.objects[object]))
                .collect(),
            scene: renumbered(&self.scene),
            ..self
        }
    }

    /// Returns the instances in an object, or in the scene.
    pub(super) fn placed(&self, object: Option<usize>) -> &[PlacedObject<M>] {
        object.map_or(&self.scene, |object| &self.objects[object])
    }

    /// Iterates over all instances, those of the scene first.
    pub(super) fn instances(&self) -> impl Iterator<Item = &PlacedObject<M>> {
        self.scene.iter().chain(self.objects.iter().flatten())
    }

    /// Returns the common drawing of all instances before they are replaced, which is `None` inside or a
    /// shape; `None` outside if they differ or there are none.
    pub(super) fn initial(&self) -> Option<Option<usize>> {
        let fertile = self.instances().filter(|placed| placed.object.is_some());
        let mut shapes = fertile.map(|placed| placed.visible.then_some(placed.shape));
        let first = shapes.next()?;
        shapes.all(|shape| shape == first).then_some(first)
    }

    /// Iterates over the shapes with which the limit set can be approached, where instances before they are replaced are not
    /// all drawn alike. There are none if some object never draws anything, which a common drawing would change.
    pub(super) fn drawn_before(&self) -> impl Iterator<Item = usize> {
        let mut draws_nothing = vec![true; self.objects.len()];
        loop {
            let is_nothing = |placed: &PlacedObject<M>| {
                !placed.visible && placed.object.is_some_and(|object| draws_nothing[object])
            };
            let next: Vec<_> = { self.objects.iter() }
                .map(|object| !object.is_empty() && object.iter().all(is_nothing))
                .collect();
            if next == draws_nothing {
                break;
            }
            draws_nothing = next;
        }
        let all_draw = !draws_nothing.contains(&true);
        self.instances()
            .filter(move |placed| all_draw && placed.object.is_some() && placed.visible)
            .map(|placed| placed.shape)
    }

    /// Returns the name of an instance for messages: `map 2`, `instance 3 of object 1`, `element 1 of the
    /// initiator`. With no `object`, the instance is one of the scene.
    pub(super) fn called(&self, object: Option<usize>, number: usize) -> String {
        let (what, scene, of) = match self.words {
            Terms::Maps => return format!("map {}", number + 1),
            Terms::Instances => ("instance", "the scene", "object"),
            Terms::Elements => ("element", "the initiator", "generator"),
        };
        let number = number + 1;
        match object {
            None => format!("{what} {number} of {scene}"),
            Some(object) if object < self.names.len() => {
                format!("{what} {number} of the {of} '{}'", self.names[object])
            }
            Some(_) if self.objects.len() == 1 => format!("{what} {number} of the {of}"),
            Some(object) => format!("{what} {number} of {of} {}", object + 1),
        }
    }
}
