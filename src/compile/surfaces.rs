//! Graphs whose elements are drawn as several surfaces: one object for each surface.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::geometry::{Frame3, Solid};
use crate::graph::{Chain, Graph, Instance, Object, Replacement, Successor};
use crate::rule::Body;

impl Graph<Frame3> {
    /// Returns the graph of a rule in space with an object for each surface of a base element, beside the objects of the
    /// elements themselves, which draw the first surface. The further objects vanish where the element is replaced. All
    /// instances must be fixed.
    #[must_use]
    pub(crate) fn with_surfaces(mut self, bodies: &[Body]) -> Self {
        let mut outlines: Vec<Solid> = Vec::new();
        // The surface that an element itself draws is one without a colour, which would colour its subtree.
        let numbers: Vec<Vec<(usize, usize)>> = { bodies.iter() }
            .map(|body| {
                let mut surfaces: Vec<_> = body.surfaces().iter().enumerate().collect();
                surfaces.sort_by_key(|(_, surface)| surface.color.is_some());
                let surfaces = surfaces.into_iter().map(|(number, surface)| {
                    outlines.push(surface.solid.clone());
                    (number, outlines.len() - 1)
                });
                surfaces.collect()
            })
            .collect();
        let count = self.objects.len();
        let next = self.objects.iter().map(|object| object.behaviour + 1);
        let vanishing = next.max().unwrap_or(0);
        let mut others: Vec<Vec<usize>> = vec![Vec::new(); count];
        let mut added: Vec<Object<Frame3>> = Vec::new();
        for (number, object) in self.objects.iter_mut().enumerate() {
            let body = &bodies[object.base_element];
            let surfaces = &numbers[object.base_element];
            let Some(((surface, outline), more)) = surfaces.split_first() else {
                continue;
            };
            object.base_element = *outline;
            object.paint = body.surfaces()[*surface].color.or(object.paint);
            if !object.visible {
                continue;
            }
            for (surface, outline) in more {
                others[number].push(count + added.len());
                let is_kept = object.is_kept();
                added.push(Object {
                    base_element: *outline,
                    paint: body.surfaces()[*surface].color,
                    behaviour: if is_kept { object.behaviour } else { vanishing },
                    replacement: match is_kept {
                        true => Replacement::Kept,
                        false => Replacement::Fixed(Arc::default()),
                    },
                    ..object.clone()
                });
            }
        }
        // Objects that share a successor share the new one, too.
        let mut made: BTreeMap<usize, Arc<Successor<Frame3>>> = BTreeMap::new();
        for object in &mut self.objects {
            if let Replacement::Fixed(successor) = &object.replacement {
                let made = made.entry(object.behaviour).or_insert_with(|| {
                    let mut successor = Successor::clone(successor);
                    add_to(&mut successor.body, &others);
                    for seed in &mut successor.seeds {
                        add_to(&mut seed.chain, &others);
                    }
                    Arc::new(successor)
                });
                object.replacement = Replacement::Fixed(Arc::clone(made));
            }
        }
        for chain in self.initiators_mut() {
            add_to(chain, &others);
        }
        self.tints |= { self.objects.iter().chain(&added) }.any(|object| object.paint.is_some());
        self.objects.extend(added);
        self.base_elements = outlines.into();
        self
    }
}

/// Adds the further surfaces of all instances of a chain.
fn add_to(chain: &mut Chain<Frame3>, others: &[Vec<usize>]) {
    let all = std::mem::take(&mut chain.instances);
    for instance in all {
        let more = others[instance.object].iter().map(|&object| Instance {
            joined: false,
            object,
            ..instance.clone()
        });
        let more: Vec<_> = more.collect();
        chain.instances.push(instance);
        chain.instances.extend(more);
    }
}
