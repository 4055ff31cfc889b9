//! Object instancing (Hart, "The object instancing paradigm for linear fractal modeling", 1992).
//!
//! A canonical object is a union of instances of other objects, of itself or of shapes, each with its own
//! map. An object that a file writes with a level, `A(n)`, is represented by one object for each level
//! that is reached.

mod appearance;
mod drawn;
mod drift;

pub use appearance::{Appearance, Thickness};
pub(crate) use drawn::{FIRST, LinearForm, cells_of_each, draw_into};
pub use drift::Drift;

use std::ops::Range;
use std::sync::Arc;

use crate::draws::Variable;
use crate::geometry::{DAffine2, DVec2, Homothety};
use crate::ifs::AffineMap;
use crate::metadata::Metadata;
use crate::style::Colour;
use crate::tween::Growing;

/// Structure of objects that instance each other.
///
/// Guarantees: all numbers of objects are in range, all maps are finite, and no instance that leads back
/// to its object is known to expand (in some cases this is undecided).
#[derive(Clone, Debug, PartialEq)]
pub struct Instancing<M: AffineMap = DAffine2> {
    pub(crate) metadata: Metadata,
    pub(crate) objects: Vec<ObjectDefinition<M>>,
    pub(crate) scene: Vec<ObjectInstance<M>>,
    pub(crate) initial: Option<M::Set>,
    /// Random variables, drawn whenever an object is replaced.
    pub(crate) variables: Arc<[Variable]>,
    /// Step that is drawn while it grows, if there is one.
    pub(crate) growing: Option<Growing>,
}

/// Canonical object: a union of instances, or one of several unions that are drawn at random.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectDefinition<M: AffineMap = DAffine2> {
    /// Name, with the level if there is one: `A(3)`.
    pub name: String,
    /// Map that is applied to the whole object.
    pub map: M,
    /// Instances of which the object is the union; those of all alternatives, one after the other, if there are any.
    pub instances: Vec<ObjectInstance<M>>,
    /// Alternatives of which one is drawn at random for every instance of the object.
    pub alternatives: Vec<ObjectAlternative>,
    /// Maps whose product is `map`, as written, for the slots of the object.
    pub(crate) transforms: Arc<[M::Written]>,
    /// Slots of the programs of the object and of its instances: its level, if it has one, and representative values of the
    /// random variables.
    pub(crate) slots: Vec<f64>,
}

/// Part of an object that is drawn at random among several.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectAlternative {
    /// Weight, of at least 0, relative to those of the others.
    pub weight: f64,
    /// Instances of the object that it consists of, by number.
    pub instances: Range<usize>,
}

/// Instance of an object or of a shape.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectInstance<M: AffineMap = DAffine2> {
    /// Map into the coordinates of the object that contains the instance; the one of representative draws if it is drawn.
    pub map: M,
    /// Object or shape that is instanced.
    pub master: Master<M>,
    /// Tint of the instance and of its contents.
    pub tint: Option<Tint>,
    /// Maps whose product is `map`, as written, for the slots of the object that contains the instance.
    pub(crate) transforms: Arc<[M::Written]>,
    /// Forms of these maps; used only where random variables are drawn.
    pub(crate) forms: Arc<[LinearForm]>,
}

/// Object or shape of which an instance is a copy.
#[derive(Clone, Debug, PartialEq)]
pub enum Master<M: AffineMap = DAffine2> {
    /// Object, by number.
    Object(usize),
    /// Shape: a primitive.
    Shape(Box<M::Set>),
}

/// Colour with its coverage (Hart 1992, section 5), and the drift of the colours that it yields.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tint {
    /// Colour; its opacity is ignored.
    pub colour: Colour,
    /// Coverage, from 0 (transparent) to 1 (opaque).
    pub alpha: f64,
    /// Drift of the colours of the instance and of its contents.
    pub drift: Drift,
}

impl Tint {
    /// Creates the tint of a colour with its coverage, from 0 to 1, without drift.
    #[must_use]
    pub fn cover(colour: Colour, alpha: f64) -> Self {
        Self {
            colour,
            alpha,
            drift: Drift::default(),
        }
    }

    /// Returns the bit patterns of the colour, the coverage and the drift, as a key.
    pub(crate) fn bits(self) -> [u64; 6] {
        let [red, green, blue, _] = self.colour.rgba();
        let colour = u32::from_be_bytes([0, red, green, blue]);
        let [hue, saturation, lightness, opacity] = self.drift.changes().map(f64::to_bits);
        let alpha = self.alpha.to_bits();
        [
            u64::from(colour),
            alpha,
            hue,
            saturation,
            lightness,
            opacity,
        ]
    }
}

impl<M: AffineMap> Instancing<M> {
    /// Returns the metadata of the file.
    #[must_use]
    pub fn metadata(&self) -> &Metadata {
        &self.metadata
    }

    /// Returns the objects that the scene reaches.
    #[must_use]
    pub fn objects(&self) -> &[ObjectDefinition<M>] {
        &self.objects
    }

    /// Returns the instances of the scene.
    #[must_use]
    pub fn scene(&self) -> &[ObjectInstance<M>] {
        &self.scene
    }

    /// Returns the shape that represents an object that has not been replaced yet.
    #[must_use]
    pub fn initial(&self) -> Option<&M::Set> {
        self.initial.as_ref()
    }

    /// Returns the random variables, which are drawn whenever an object is replaced.
    #[must_use]
    pub fn variables(&self) -> &[Variable] {
        &self.variables
    }

    /// Returns the number of steps after which no object is left to be replaced, or `None` if an object
    /// leads back to itself.
    #[must_use]
    pub fn depth(&self) -> Option<u32> {
        let children = |instances: &[ObjectInstance<M>]| -> Vec<usize> {
            let masters = instances.iter().map(|instance| &instance.master);
            masters
                .filter_map(|master| match master {
                    Master::Object(number) => Some(*number),
                    Master::Shape(_) => None,
                })
                .collect()
        };
        let mut depths = vec![0; self.objects.len()];
        // Number of instances of each object that have not been counted yet: an object is expanded after
        // its last.
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

    /// Returns the map of an instance, composed with the map that its object applies to itself.
    pub(crate) fn map_of(&self, instance: &ObjectInstance<M>) -> M {
        match instance.master {
            Master::Object(number) => instance.map * self.objects[number].map,
            Master::Shape(_) => instance.map,
        }
    }

    /// Returns whether the structure has a shape or an initial set.
    pub(crate) fn draws_anything(&self) -> bool {
        let is_shape = |instance: &ObjectInstance<M>| matches!(instance.master, Master::Shape(_));
        self.initial.is_some() || self.instances().any(is_shape)
    }

    /// Iterates over all instances, those of the scene first.
    pub(crate) fn instances(&self) -> impl Iterator<Item = &ObjectInstance<M>> {
        let objects = self.objects.iter().flat_map(|object| &object.instances);
        self.scene.iter().chain(objects)
    }
}

impl Instancing {
    /// Returns the structure in the coordinates that a homothety maps to the structure's own, or `None`
    /// if a shape has no extent there.
    pub(crate) fn within(&self, place: &Homothety) -> Option<Self> {
        let mut within = self.clone();
        within.metadata = self.metadata.within(place);
        let back = place.backwards();
        let forth = DAffine2::from_scale_angle_translation(
            DVec2::splat(place.ratio()),
            0.0,
            place.point(DVec2::ZERO),
        );
        let [first, last] = [forth, back].map(|it| [it.into()]);
        let objects = within.objects.iter_mut();
        let instances = objects.flat_map(|object| {
            object.map = place.within(&object.map);
            &mut object.instances
        });
        for instance in instances.chain(&mut within.scene) {
            instance.map = place.within(&instance.map);
            if !self.variables.is_empty() {
                instance.transforms = [&first, &*instance.transforms, &last].concat().into();
                let scaling = &[LinearForm::Scaling][..];
                instance.forms = [scaling, &instance.forms, scaling].concat().into();
            }
            if let Master::Shape(shape) = &mut instance.master {
                **shape = shape.transformed(&back)?;
            }
        }
        if let Some(initial) = &mut within.initial {
            *initial = initial.transformed(&back)?;
        }
        Some(within)
    }
}
