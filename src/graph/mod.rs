//! The instancing graph (Hart 1992): objects, and the instances that replace them.
//!
//! Every way of writing a linear fractal is compiled to a [`Graph`]: objects with a base element
//! of their own and a [`Production`], the instances that stand in an object's place one step
//! later. What depends on the moment (on age, step, length or, modulo m, on the index) has become
//! more objects, so that the productions of a deterministic rule are lists of fixed maps. Only
//! where numbers are drawn, or where an index has to be counted, an object says
//! [`Replacement::Evaluated`], and its instances are worked out where it stands. A rule in which the
//! choice of a generator hangs on such an index is *irregular*.
//!
//! What every number of steps is grown out of is the initiator, the same for all but in *levelled* graphs, whose
//! objects know how many steps are still to come.
//!
//! A graph has two kinds of edges. An instance composes its map with its parent's; a *reset*
//! ([`Placement::SeedsAsInitiator`]) keeps the position only.
//!
//! A graph's coordinates are those of the model unless it is [compiled near](crate::model::Model::compile_near)
//! the unit box around the origin: [`Graph::place`] leads from them to the model's.

mod bounds;
mod compile;
mod contract;
mod count;
mod error;
mod forecast;
mod hull;
mod ifs;
mod instancing;
mod likely;
mod limit;
mod lines;
mod lsystem;
mod no_limit;
mod place;
mod policy;
mod reach;
mod roots;
mod state;
mod thickness;

pub use bounds::Boxes;
pub use count::Count;
pub use error::CompileError;
pub use forecast::{Forecast, Level, Population};
pub use limit::TooLarge;
pub use no_limit::NoLimit;

pub(crate) use ifs::{filling, outline as base_element};
pub(crate) use lsystem::{Chords, Words};
pub(crate) use place::exponent_of;
pub(crate) use roots::{Root, Roots, Sown};

use std::sync::Arc;

use crate::geometry::{DVec2, Frame, Homothety};
use crate::instancing::{Coat, Thickness, Tint};
use crate::rule::{BaseElement, Part, Placement, Rule};
use crate::style::Colour;

/// An object: a kind of element in a state that decides what it becomes.
#[derive(Clone, Debug)]
pub struct Object {
    /// Its base element, by number.
    pub base_element: usize,
    /// Whether it is drawn.
    pub visible: bool,
    /// The generator that listed it, or the map that is applied to it first, by number; `None` for the
    /// initiator, and for the condensation sets of a system.
    pub origin: Option<usize>,
    /// The map of a system that is applied last to what stands there, by number, where that is told.
    pub last_map: Option<usize>,
    /// What it tints all that stands in its place with.
    pub tint: Option<Tint>,
    /// The colour of what stands in its place and has none of its own.
    pub paint: Option<Colour>,
    /// What becomes of the widths of all that stands in its place.
    pub thickness: Option<Thickness>,
    /// The index that expressions see of it, or another one that is the same to them: from 1; 1 where no
    /// index is resolved.
    pub(crate) index: u32,
    /// What it becomes: objects of one behaviour have the same replacements, however they look.
    pub(crate) behaviour: usize,
    /// What takes its place in the next step.
    pub replacement: Replacement,
}

/// What takes an object's place in the next step; objects of one behaviour share it.
#[derive(Clone, Debug)]
pub enum Replacement {
    /// Infertile: the element is kept.
    Kept,
    /// Fixed instances.
    Fixed(Arc<Production>),
    /// Instances that are worked out where the element stands, by one of these alternatives.
    Evaluated(Arc<[Alternative]>),
    /// Not resolved: the object is first reached at the depth that the graph was compiled for.
    Beyond,
}

/// What works out instances where elements stand.
#[derive(Clone, Debug)]
pub(crate) enum Evaluated {
    /// A rule whose generators depend on draws or on an index.
    Rule(Arc<Rule>),
    /// An L-system whose productions are drawn.
    Words(Arc<Words>),
}

/// A generator that may replace an object, and what its elements are.
#[derive(Clone, Debug)]
pub struct Alternative {
    /// The generator, by number; of an L-system, the word.
    pub generator: usize,
    /// The objects of its elements, by position.
    pub objects: Vec<usize>,
}

/// An instance: a frame inside its parent's, and the object that stands there.
#[derive(Clone, Debug)]
pub struct Instance {
    /// Map and direction relative to the parent.
    pub frame: Frame,
    /// Its length as a multiple of its parent's: |to − from|, or the most that its map stretches
    /// anything where that is no similarity.
    pub length: f64,
    /// Whether it joins the instance listed before it (the first one: the last, in a closed chain).
    pub joined: bool,
    /// Its position in the initiator or generator as listed, from 0, counted across parts.
    pub position: u32,
    /// The object, by number.
    pub object: usize,
}

/// Instances that stand in a row.
#[derive(Clone, Debug, Default)]
pub struct Chain {
    /// In the order of listing.
    pub instances: Vec<Instance>,
    /// Whether the first instance starts, and the last one ends, where the replaced element does.
    pub meets_frame: [bool; 2],
}

/// A chain that starts a new fractal.
#[derive(Clone, Debug)]
pub struct Seed {
    /// How the new fractal is placed.
    pub placement: Placement,
    /// Its elements.
    pub chain: Chain,
}

/// What takes an element's place, and the new fractals that it seeds.
#[derive(Clone, Debug, Default)]
pub struct Production {
    /// The instances that take the element's place; none if it vanishes.
    pub body: Chain,
    /// New fractals, in the order of their parts.
    pub seeds: Vec<Seed>,
}

/// The instancing graph of a rule.
///
/// Guarantees: all numbers of objects and base elements are in range; every object that is reached
/// within the depth that the graph was compiled for has its replacement.
#[derive(Clone, Debug)]
pub struct Graph {
    /// What works out instances where elements stand; `None` if nothing does.
    pub(crate) evaluated: Option<Evaluated>,
    pub(crate) base_elements: Arc<[BaseElement]>,
    /// The number of origins that objects may have.
    pub(crate) origins: usize,
    pub(crate) objects: Vec<Object>,
    /// By the number of steps that are grown out of it; the last one for all others. One at least.
    pub(crate) initiators: Vec<Chain>,
    /// What the initiator's elements descend from, and what has been seeded before; empty where they are
    /// a beginning.
    pub(crate) roots: Arc<Roots>,
    pub(crate) depth: Option<u32>,
    pub(crate) regular: bool,
    pub(crate) counts_index: bool,
    pub(crate) draws: bool,
    pub(crate) seeds: bool,
    /// Whether any object tints.
    pub(crate) tints: bool,
    /// The most that strokes are widened, if any object changes widths.
    pub(crate) widest: Option<f64>,
    /// Whether maps may be any affine ones.
    pub(crate) affine: bool,
    /// The length of an element whose frame is the unit frame.
    pub(crate) unit: f64,
    /// A point of the unit frame about which lies what becomes of an element.
    pub(crate) middle: DVec2,
    /// What leads from its coordinates to those of the model.
    pub(crate) place: Homothety,
}

impl Graph {
    /// What works out instances where elements stand.
    pub(crate) fn evaluated(&self) -> &Evaluated {
        let Some(evaluated) = &self.evaluated else {
            unreachable!("nothing else is evaluated while a walk goes on");
        };
        evaluated
    }

    /// The parts of an alternative: none where all of it takes the place of what is replaced.
    pub(crate) fn parts(&self, alternative: &Alternative) -> &[Part] {
        match self.evaluated() {
            Evaluated::Rule(rule) => rule.generators()[alternative.generator].parts(),
            Evaluated::Words(_) => &[],
        }
    }

    /// The number of origins that objects may have: of generators of a rule.
    #[must_use]
    pub fn origins(&self) -> usize {
        self.origins
    }

    /// The objects.
    #[must_use]
    pub fn objects(&self) -> &[Object] {
        &self.objects
    }

    /// What a number of steps are grown out of: approximant 0, unless the graph [is levelled](Graph::is_levelled).
    #[must_use]
    pub fn initiator(&self, steps: u32) -> &Chain {
        let last = self.initiators.len() - 1;
        &self.initiators[(steps as usize).min(last)]
    }

    /// All chains that nothing comes before: initiators, and what has been seeded before.
    pub(crate) fn starts(&self) -> impl Iterator<Item = &Chain> {
        let sown = self.roots.sown.iter().map(|sown| &sown.chain);
        self.initiators.iter().chain(sown)
    }

    /// Whether objects know how many steps are still to come, so that every number of steps is grown
    /// out of an initiator of its own.
    #[must_use]
    pub fn is_levelled(&self) -> bool {
        self.initiators.len() > 1
    }

    /// The base elements that objects refer to.
    #[must_use]
    pub fn base_elements(&self) -> &[BaseElement] {
        &self.base_elements
    }

    /// The number of steps for which every object is resolved; `None` if for any number.
    #[must_use]
    pub fn depth(&self) -> Option<u32> {
        self.depth
    }

    /// Whether the structure is known without a walk: which generator replaces an element does not
    /// hang on an index that has to be counted.
    #[must_use]
    pub fn is_regular(&self) -> bool {
        self.regular
    }

    /// Whether a walk counts indices, for the selection or for points that depend on them.
    #[must_use]
    pub fn counts_index(&self) -> bool {
        self.counts_index
    }

    /// Whether numbers are drawn.
    #[must_use]
    pub fn draws(&self) -> bool {
        self.draws
    }

    /// What an object does to the looks of all that stands in its place.
    #[inline]
    pub(crate) fn coat(&self, object: usize) -> Coat {
        let Object {
            tint,
            paint,
            thickness,
            ..
        } = self.objects[object];
        let tint = tint.map_or(Coat::NONE, Coat::of);
        let paint = paint.map(Coat::of_paint);
        let thickness = thickness.map(Coat::of_thickness);
        let all = [paint, thickness].into_iter().flatten();
        all.fold(tint, Coat::over)
    }

    /// Whether any object changes the looks of what stands in its place.
    #[inline]
    pub(crate) fn coats(&self) -> bool {
        self.tints || self.widest.is_some()
    }

    /// No stroke is wider than so many times what the style says, if widths differ in the graph; those
    /// of parts that are not drawn may be.
    #[must_use]
    pub fn widest(&self) -> Option<f64> {
        self.widest
    }

    /// Whether any object tints what stands in its place.
    #[must_use]
    pub fn tints(&self) -> bool {
        self.tints
    }

    /// Whether maps may be any affine ones, as in systems; those of rules are similarities.
    #[must_use]
    pub fn is_affine(&self) -> bool {
        self.affine
    }

    /// Whether all maps are similarities, up to rounding.
    #[must_use]
    pub fn is_similar(&self) -> bool {
        const ROUNDING: f64 = 1e-12;
        let similar = |instance: &Instance| {
            let linear = instance.frame.map.matrix2;
            let square = instance.length * instance.length;
            (linear.determinant().abs() - square).abs() <= ROUNDING * square
        };
        !self.affine || self.instances().all(|(_, instance)| similar(instance))
    }

    /// Whether any element may join the one before it.
    pub(crate) fn joins(&self) -> bool {
        let all = self.instances().map(|(_, instance)| instance);
        let all = all.chain(self.starts().flat_map(|start| &start.instances));
        !self.is_plain() || { all }.any(|instance| instance.joined)
    }

    /// The length of an element whose frame is the unit frame: 1 in rules, in systems the long side of
    /// the limit set's box.
    #[must_use]
    pub fn unit(&self) -> f64 {
        self.unit
    }

    /// The first object of every behaviour.
    pub(crate) fn behaviours(&self) -> impl Iterator<Item = &Object> {
        self.behaviours_by_number().map(|(_, object)| object)
    }

    /// The same with their numbers.
    pub(crate) fn behaviours_by_number(&self) -> impl Iterator<Item = (usize, &Object)> {
        // Behaviours are numbered in the order of the objects.
        let mut next = 0;
        self.objects.iter().enumerate().filter(move |(_, object)| {
            let first = object.behaviour == next;
            next += usize::from(first);
            first
        })
    }

    /// Whether every production is a list of fixed maps.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        !self
            .objects
            .iter()
            .any(|object| matches!(object.replacement, Replacement::Evaluated(_)))
    }
}

impl Production {
    /// All instances, with how they are placed: the body, then the seeds.
    pub(crate) fn placed_instances(&self) -> impl Iterator<Item = (Placement, &Instance)> {
        let body = self.body.instances.iter();
        let seeds = self.seeds.iter().flat_map(|seed| {
            let instances = seed.chain.instances.iter();
            instances.map(move |instance| (seed.placement, instance))
        });
        body.map(|instance| (Placement::Stays, instance))
            .chain(seeds)
    }

    /// The production of a generator whose points have been evaluated.
    ///
    /// `objects` are the objects of the generator's elements by position; `self` is overwritten,
    /// its memory used again.
    pub(crate) fn set(&mut self, parts: &[Part], points: &[DVec2], objects: &[usize]) {
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
            for element in &part.elements {
                let (from, to) = (points[element.from], points[element.to]);
                instances.push(Instance {
                    frame: Frame::between(from, to, element.direction),
                    length: (to - from).length(),
                    joined: element.joined,
                    position,
                    object: objects[position as usize],
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
