//! Object instancing (Hart, "The object instancing paradigm for linear fractal modeling", 1992).
//!
//! Canonical objects are unions of instances: of other objects, of themselves, or of shapes, each with a
//! map of its own. What a file writes with a level, `A(n)`, is here one object a level that is reached.

mod coat;

pub use coat::{Coat, Thickness};

use crate::geometry::{DAffine2, Homothety};
use crate::heading::Heading;
use crate::ifs::Shape;
use crate::style::Colour;

/// A structure of objects that instance each other.
///
/// Guarantees: all numbers of objects are in range, all maps are finite, and instances that lead back
/// to their object do not grow (or it is undecided whether they do).
#[derive(Clone, Debug, PartialEq)]
pub struct Instancing {
    pub(crate) heading: Heading,
    pub(crate) objects: Vec<Object>,
    pub(crate) scene: Vec<Instance>,
    pub(crate) initial: Option<Shape>,
}

/// A canonical object: a union of instances.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// Its name, with its level if it has one: `A(3)`.
    pub name: String,
    /// What is done to all of it.
    pub map: DAffine2,
    /// What it is made of.
    pub instances: Vec<Instance>,
    /// Where it is written: the number of an object of the file, and its level.
    pub(crate) origin: (usize, Option<f64>),
}

/// An instance of an object, or of a shape.
#[derive(Clone, Debug, PartialEq)]
pub struct Instance {
    /// Where it stands in the object that it is part of.
    pub map: DAffine2,
    /// What stands there.
    pub master: Master,
    /// What it tints all that is in it.
    pub tint: Option<Tint>,
}

/// What an instance is one of.
#[derive(Clone, Debug, PartialEq)]
pub enum Master {
    /// An object, by number.
    Object(usize),
    /// A shape: a primitive.
    Shape(Shape),
}

/// A colour and how much it covers (Hart 1992, section 5).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tint {
    /// The colour; its own opacity does not matter.
    pub colour: Colour,
    /// How much it covers, from 0, nothing, to 1, all.
    pub alpha: f64,
}

impl Instancing {
    /// What files of all kinds say.
    #[must_use]
    pub fn heading(&self) -> &Heading {
        &self.heading
    }

    /// The objects that the scene leads to.
    #[must_use]
    pub fn objects(&self) -> &[Object] {
        &self.objects
    }

    /// What the scene is made of.
    #[must_use]
    pub fn scene(&self) -> &[Instance] {
        &self.scene
    }

    /// What stands for an object that has not been replaced yet.
    #[must_use]
    pub fn initial(&self) -> Option<&Shape> {
        self.initial.as_ref()
    }

    /// The number of steps after which nothing is left to be replaced; `None` if objects lead back to
    /// themselves.
    #[must_use]
    pub fn depth(&self) -> Option<u32> {
        let children = |instances: &[Instance]| -> Vec<usize> {
            let masters = instances.iter().map(|instance| &instance.master);
            masters
                .filter_map(|master| match master {
                    Master::Object(number) => Some(*number),
                    Master::Shape(_) => None,
                })
                .collect()
        };
        let mut depths = vec![0; self.objects.len()];
        // How often each is still to be met on the way down.
        let mut meetings = vec![0u32; self.objects.len()];
        let all = self.objects.iter().map(|object| &object.instances);
        for child in all.chain([&self.scene]).flat_map(|all| children(all)) {
            meetings[child] += 1;
        }
        let mut next = vec![(children(&self.scene), 0)];
        let mut done = 0;
        let mut deepest = 0;
        while let Some((children_of, depth)) = next.pop() {
            for child in children_of {
                depths[child] = depths[child].max(depth + 1);
                meetings[child] -= 1;
                if meetings[child] == 0 {
                    done += 1;
                    deepest = deepest.max(depths[child]);
                    next.push((children(&self.objects[child].instances), depths[child]));
                }
            }
        }
        (done == self.objects.len()).then_some(deepest)
    }

    /// Where what an instance shows stands, with what the object that it is one of does to all of it.
    pub(crate) fn map_of(&self, instance: &Instance) -> DAffine2 {
        match instance.master {
            Master::Object(number) => instance.map * self.objects[number].map,
            Master::Shape(_) => instance.map,
        }
    }

    /// Returns the structure in the coordinates that a homothety maps to its own; `None` if a shape has no
    /// extent there.
    pub(crate) fn within(&self, place: &Homothety) -> Option<Self> {
        let mut within = self.clone();
        let back = place.backwards();
        let objects = within.objects.iter_mut();
        let instances = objects.flat_map(|object| {
            object.map = place.within(&object.map);
            &mut object.instances
        });
        for instance in instances.chain(&mut within.scene) {
            instance.map = place.within(&instance.map);
            if let Master::Shape(shape) = &mut instance.master {
                *shape = shape.transformed(&back)?;
            }
        }
        if let Some(initial) = &mut within.initial {
            *initial = initial.transformed(&back)?;
        }
        Some(within)
    }

    /// Whether there are shapes, or an initial set.
    pub(crate) fn draws_anything(&self) -> bool {
        let is_shape = |instance: &Instance| matches!(instance.master, Master::Shape(_));
        self.initial.is_some() || self.instances().any(is_shape)
    }

    /// All instances, those of the scene first.
    pub(crate) fn instances(&self) -> impl Iterator<Item = &Instance> {
        let objects = self.objects.iter().flat_map(|object| &object.instances);
        self.scene.iter().chain(objects)
    }
}
