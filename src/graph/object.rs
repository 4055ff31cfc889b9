//! Objects, and the chains of instances that replace them.

use std::sync::Arc;

use crate::draws::Corner;
use crate::geometry::{Frame, Frame2, Point as _};
use crate::instancing::{Appearance, Thickness, Tint};
use crate::rule::{Part, Placement, RuleFrame};
use crate::style::Colour;

/// Object: a class of elements in a state that determines their subtrees.
#[derive(Clone, Debug)]
pub struct Object<F: Frame = Frame2> {
    /// Number of its base element.
    pub base_element: usize,
    /// Whether it is drawn.
    pub visible: bool,
    /// Number of the generator that lists it, or of the system's map that is applied to it first; `None` for
    /// elements of the initiator, outside all maps, and in graphs of structures and L-systems.
    pub origin: Option<usize>,
    /// Number of the system's map that is applied to it last, if the graph records it.
    pub last_map: Option<usize>,
    /// Tint of its subtree.
    pub tint: Option<Tint>,
    /// Colour of the parts of its subtree that have none of their own.
    pub paint: Option<Colour>,
    /// Change of stroke width of its subtree.
    pub thickness: Option<Thickness>,
    /// Appearance in place of the tint and of those of all that would contain it, if they are no longer there.
    pub(crate) composed: Option<Appearance>,
    /// Index that expressions see of it, or an equivalent one, from 1; 1 if no index is resolved.
    pub(crate) index: u32,
    /// Number of its behaviour: objects of one behaviour have equal replacements, regardless of
    /// appearance.
    pub(crate) behaviour: usize,
    /// Replacement in the next step.
    pub replacement: Replacement<F>,
}

/// Replacement of an object in the next step; objects of one behaviour share it.
#[derive(Clone, Debug)]
pub enum Replacement<F: Frame = Frame2> {
    /// Infertile: the element is kept.
    Kept,
    /// Fixed instances.
    Fixed(Arc<Successor<F>>),
    /// Instances that are computed for each element, by one of these alternatives.
    Evaluated(Arc<[Alternative]>),
    /// Not resolved: the object is first reached at the depth for which the graph was compiled.
    Unresolved,
}

/// Generator that may replace an object, with the objects of its elements.
#[derive(Clone, Debug)]
pub struct Alternative {
    /// Number of the generator; for an L-system, of the word.
    pub generator: usize,
    /// Objects of its elements, by position.
    pub objects: Vec<usize>,
}

/// Instance: a frame inside its parent's frame, and the object that is placed there.
#[derive(Clone, Debug)]
pub struct Instance<F: Frame = Frame2> {
    /// Map and direction relative to the parent.
    pub frame: F,
    /// Length as a multiple of its parent's: |to − from|, or the largest stretch of its map if that is
    /// not a similarity.
    pub length: f64,
    /// Whether it joins the instance listed before it (the first joins the last, in a closed chain).
    pub joined: bool,
    /// Position in the initiator or generator as listed, from 0, counted across parts.
    pub position: u32,
    /// Number of the object.
    pub object: usize,
    /// Origins of the first three corners of its surface, if draws belong to edges.
    pub corners: Option<[Corner; 3]>,
}

/// Sequence of instances.
#[derive(Clone, Debug, Default)]
pub struct Chain<F: Frame = Frame2> {
    /// Instances in the order of listing.
    pub instances: Vec<Instance<F>>,
    /// Whether the first instance starts, and whether the last one ends, at the end points of the
    /// replaced element.
    pub meets_frame: [bool; 2],
    /// Indices of the instances with which further fractals start, in ascending order; empty unless the chain is an
    /// initiator with images under a [symmetry](crate::Symmetry).
    pub(crate) breaks: Vec<usize>,
}

/// Chain that starts a new fractal.
#[derive(Clone, Debug)]
pub struct Seed<F: Frame = Frame2> {
    /// Placement of the new fractal.
    pub placement: Placement,
    /// Elements of the new fractal.
    pub chain: Chain<F>,
}

/// Instances that replace an element, and the new fractals that it seeds.
#[derive(Clone, Debug, Default)]
pub struct Successor<F: Frame = Frame2> {
    /// Instances that take the place of the element; empty if it vanishes.
    pub body: Chain<F>,
    /// New fractals, in the order of their parts.
    pub seeds: Vec<Seed<F>>,
}

impl<F: Frame> Chain<F> {
    /// Creates a chain that meets no end of the frame it is in.
    pub(crate) fn loose(instances: Vec<Instance<F>>) -> Self {
        Self {
            instances,
            ..Self::default()
        }
    }

    /// Returns the number of fractals that the chain starts: 1, unless it is an initiator with images.
    pub(crate) fn count(&self) -> usize {
        self.breaks.len() + 1
    }

    /// Returns the instances with which a fractal starts, by its number from 0.
    pub(crate) fn fractal(&self, number: usize) -> &[Instance<F>] {
        let from = number
            .checked_sub(1)
            .map_or(0, |before| self.breaks[before]);
        let to = self.breaks.get(number).copied();
        &self.instances[from..to.unwrap_or(self.instances.len())]
    }

    /// Iterates over the fractals that the chain starts.
    pub(crate) fn fractals(&self) -> impl Iterator<Item = &[Instance<F>]> {
        (0..self.count()).map(|number| self.fractal(number))
    }
}

impl<F: Frame> From<Chain<F>> for Successor<F> {
    fn from(body: Chain<F>) -> Self {
        Self {
            body,
            seeds: Vec::new(),
        }
    }
}

impl<F: Frame> Instance<F> {
    /// Creates an instance of an object that joins none before it, of the length of its frame.
    pub(crate) fn new(object: usize, frame: F, position: u32) -> Self {
        Self {
            length: frame.length(),
            frame,
            joined: false,
            position,
            object,
            corners: None,
        }
    }
}

impl<F: Frame> Object<F> {
    /// Returns whether the object is never replaced.
    #[must_use]
    pub fn is_kept(&self) -> bool {
        matches!(self.replacement, Replacement::Kept)
    }

    /// Returns whether the successor of the object lies beyond the depth of the graph.
    pub(crate) fn is_unresolved(&self) -> bool {
        matches!(self.replacement, Replacement::Unresolved)
    }

    /// Returns the successors that replace elements of the object in turn or at random; empty for others.
    pub(crate) fn alternatives(&self) -> &[Alternative] {
        match &self.replacement {
            Replacement::Evaluated(alternatives) => alternatives,
            _ => &[],
        }
    }

    /// Returns the successor of the object, if it is the same for all its elements.
    #[must_use]
    pub fn successor(&self) -> Option<&Arc<Successor<F>>> {
        match &self.replacement {
            Replacement::Fixed(successor) => Some(successor),
            _ => None,
        }
    }

    /// Creates a visible object of a base element that is kept, without origin and appearance.
    pub(crate) fn kept(base_element: usize) -> Self {
        Self {
            base_element,
            visible: true,
            origin: None,
            last_map: None,
            tint: None,
            paint: None,
            thickness: None,
            composed: None,
            index: 1,
            behaviour: 0,
            replacement: Replacement::Kept,
        }
    }
}

impl<F: Frame> Successor<F> {
    /// Empties the successor, and keeps its memory.
    pub(crate) fn clear(&mut self) {
        self.seeds.clear();
        self.body.instances.clear();
        self.body.meets_frame = [false; 2];
    }

    /// Returns the successor without some of the instances, for what does not depend on how they are joined.
    pub(crate) fn retaining(&self, is_kept: impl Fn(&Instance<F>) -> bool) -> Self {
        let retained = |chain: &Chain<F>| Chain {
            instances: { chain.instances.iter() }
                .filter(|it| is_kept(it))
                .cloned()
                .collect(),
            meets_frame: chain.meets_frame,
            breaks: chain.breaks.clone(),
        };
        let seeds = self.seeds.iter().map(|seed| Seed {
            chain: retained(&seed.chain),
            placement: seed.placement,
        });
        Self {
            body: retained(&self.body),
            seeds: seeds.collect(),
        }
    }

    /// Iterates over all instances with their placements: the body, then the seeds.
    pub(crate) fn placed_instances(&self) -> impl Iterator<Item = (Placement, &Instance<F>)> {
        let body = self.body.instances.iter();
        let seeds = self.seeds.iter().flat_map(|seed| {
            let instances = seed.chain.instances.iter();
            instances.map(move |instance| (seed.placement, instance))
        });
        body.map(|instance| (Placement::Stays, instance))
            .chain(seeds)
    }
}

impl<F: RuleFrame> Successor<F> {
    /// Overwrites the successor with that of a generator whose points have been evaluated, and reuses
    /// its memory.
    ///
    /// `objects` are the objects of the generator's elements by position.
    pub(crate) fn set(&mut self, parts: &[Part], points: &[F::Point], objects: &[usize]) {
        let mut seeds = std::mem::take(&mut self.seeds).into_iter();
        self.body.instances.clear();
        self.body.meets_frame = [false; 2];
        let mut position = 0;
        for part in parts {
            let from = self.body.instances.len();
            let mut seed = part.placement.seeds().then(|| {
                let mut seed = seeds.next().unwrap_or_else(|| Seed {
                    placement: part.placement,
                    chain: Chain::default(),
                });
                seed.placement = part.placement;
                seed.chain.instances.clear();
                seed.chain.meets_frame = [false; 2];
                seed
            });
            let instances = seed
                .as_mut()
                .map_or(&mut self.body.instances, |seed| &mut seed.chain.instances);
            instances.reserve(part.elements.len());
            for element in &part.elements {
                let (from, to) = (points[element.from], points[element.to]);
                let frame = F::placed(element, points);
                let length = match element.is_stretched() {
                    true => frame.stretch(),
                    false => (to - from).length(),
                };
                instances.push(Instance {
                    frame,
                    length,
                    joined: element.joined,
                    position,
                    object: objects[position as usize],
                    corners: element.corners,
                });
                position += 1;
            }
            match seed {
                Some(seed) => self.seeds.push(seed),
                None if !part.elements.is_empty() => {
                    if from == 0 {
                        self.body.meets_frame[0] = part.meets_frame[0];
                    }
                    self.body.meets_frame[1] = part.meets_frame[1];
                }
                None => {}
            }
        }
    }
}
