//! Maps of a structure of objects.

use crate::document::{InstancingDocument, LevelDocument, TransformDocument, UnionDocument};
use crate::expression::Precise;
use crate::graph::{Graph, Instance};
use crate::instancing::Instancing;
use crate::zoom::fixed::Fixed;

use super::{Names, Numbers};

/// Maps of a structure of objects.
pub(super) struct OfStructure<'a> {
    document: &'a InstancingDocument,
    structure: &'a Instancing,
    /// Canonical objects of the graph's objects.
    canonical: Vec<Option<usize>>,
}

impl<'a> OfStructure<'a> {
    pub(super) fn new(document: &'a InstancingDocument, structure: &'a Instancing) -> Self {
        Self {
            document,
            structure,
            canonical: Graph::canonical_objects(structure),
        }
    }

    /// Evaluates the map of an instance in an object, or in the scene if there is no parent.
    pub(super) fn child(
        &self,
        parent: Option<usize>,
        instance: &Instance,
        numbers: &mut Numbers,
    ) -> Fixed {
        let bits = numbers.bits();
        let position = instance.position as usize;
        let inner = match self.canonical[instance.object] {
            Some(object) => {
                let (union, name) = self.union(object);
                numbers.product(&union.transforms, name.as_slice())
            }
            None => Fixed::identity(bits),
        };
        let parent = parent.and_then(|object| self.canonical[object]);
        let (union, name, whole) = match (parent, &self.document.scene) {
            (Some(object), _) => {
                let (union, name) = self.union(object);
                (union, name, None)
            }
            (None, Some(scene)) => {
                let whole = numbers.product(&scene.transforms, &[]);
                (scene, None, Some(whole))
            }
            (None, None) => return inner,
        };
        let own = numbers.product(&union.instances[position].transforms, name.as_slice());
        let map = own.after(&inner, bits, false);
        match whole {
            Some(whole) => whole.after(&map, bits, false),
            None => map,
        }
    }

    /// Returns the union of which an object consists, and the name of its level with the value.
    fn union(&self, object: usize) -> (&'a UnionDocument, Option<(&'a str, Precise)>) {
        let (number, level) = self.structure.objects()[object].origin;
        let written = &self.document.objects[number];
        let name = match &written.level {
            Some(LevelDocument::Any(name)) => Some(name.value.as_str()),
            _ => None,
        };
        (&written.union, name.zip(level.map(Precise::of)))
    }
}

impl Numbers {
    /// Evaluates the product of transforms, of which the first in the list is applied first.
    fn product(&mut self, transforms: &[TransformDocument], names: Names<'_>) -> Fixed {
        let bits = self.bits();
        let mut product = Fixed::identity(bits);
        for transform in transforms {
            let mut map = Fixed::identity(bits);
            match transform {
                TransformDocument::Scale([x, y]) => {
                    let [x, y] = [x, y].map(|factor| self.fixed(factor, names));
                    (map.axes[0][0], map.axes[1][1]) = (x, y);
                }
                TransformDocument::Rotate(angle) => {
                    map = Fixed::rotation(self.turn(angle, names), bits);
                }
                TransformDocument::Translate(shift) => map.origin = self.point(shift, names),
                TransformDocument::Matrix([first, second]) => {
                    let [[a, c], [b, d]] = [first, second].map(|row| self.point(row, names));
                    map.axes = [[a, b], [c, d]];
                }
            }
            product = map.after(&product, bits, false);
        }
        product
    }
}
