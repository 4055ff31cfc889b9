//! The instancing graph (Hart 1992): objects, and the instances that replace them.
//!
//! Every description of a linear fractal is compiled to a [`Graph`]: objects with a base element of their
//! own and a [`Successor`], the instances that take an object's place one step later. All that the
//! successors of an object yield in any number of steps, seeds included, is the *subtree* of the object.
//! Dependence on the moment (on age, step, length or, modulo m, on the index) is resolved into more
//! objects, so that the successors of a deterministic rule are lists of fixed maps. Where numbers are
//! drawn, or where an index has to be counted, an object has [`Replacement::Evaluated`], and its
//! instances are computed for each element. A rule in which the choice of a generator depends on such an
//! index is *irregular*.
//!
//! All numbers of steps are grown from one initiator, except in *time-indexed* graphs, whose objects know
//! the number of steps that remain: these have one initiator for each number of steps.
//!
//! A graph has two kinds of edges. An instance composes its map with its parent's; a *reset*
//! ([`Placement::SeedsAsInitiator`](crate::rule::Placement::SeedsAsInitiator)) keeps the position only.
//!
//! A graph's coordinates are those of the model unless it is [compiled
//! near](crate::model::Model::compile_normalised) the unit box around the origin: [`Graph::place`] maps them to
//! the model's.

mod check_size;
mod edges;
mod error;
mod forecast;
mod lines;
mod object;
mod roots;
mod source;
mod thickness;

pub use check_size::TooLarge;
pub use error::{CompileError, OutOfRange};
pub(crate) use error::{EXTENTS, FARTHEST};
pub use forecast::{Forecast, Level, Population};
pub(crate) use lines::is_ring;
pub use object::{Alternative, Chain, Instance, Object, Replacement, Seed, Successor};
pub(crate) use roots::{Root, Roots, SeededFractal};
pub(crate) use source::{Buffers, DrawVisitor, Source};

use std::num::NonZero;
use std::sync::Arc;

use crate::expression::degrees;
use crate::extent::NoLimit;
use crate::geometry::{Bounds, DAffine2, DMat2, DVec2, Frame, Frame2, Homothety, Outline, Point};
use crate::instancing::Appearance;
use crate::rule::Part;
use crate::work;

/// [Work](work) of compiling an object.
const OBJECT: usize = 128;

/// Instancing graph of a model.
///
/// Guarantees: all numbers of objects and base elements are in range; every object that is reached within
/// the depth for which the graph was compiled has its replacement.
#[derive(Clone, Debug)]
pub struct Graph<F: Frame = Frame2> {
    /// Source of instances that are computed for each element; `None` if all are fixed.
    pub(crate) source: Option<Arc<dyn Source<F>>>,
    pub(crate) base_elements: Arc<[F::Outline]>,
    /// Number of origins that objects may have.
    pub(crate) origins: usize,
    pub(crate) objects: Vec<Object<F>>,
    /// Initiators, by the number of steps that are grown from them; the last is that of all larger
    /// numbers. Never empty. Changed by [`initiators_mut`](Self::initiators_mut) alone.
    pub(crate) initiators: Vec<Chain<F>>,
    /// Bounding box of the limit set, or that the graph does not determine it, if compilation has looked for it.
    pub(crate) limit_bounds: Option<Option<Bounds<F::Point>>>,
    /// Number of positions in the initiators as listed; `None` if they have no images.
    pub(crate) listed: Option<NonZero<u32>>,
    /// Ancestry of the initiator's elements, and fractals seeded before; empty if growth begins with the
    /// initiator.
    pub(crate) roots: Arc<Roots<F>>,
    pub(crate) depth: Option<u32>,
    /// Number of steps of the approximant that the graph consists of, if it knows no other.
    pub(crate) only: Option<u32>,
    /// State between two steps, if the last step is still growing.
    pub(crate) between: Option<Between<F>>,
    /// Reason why the model, as its graph does not show, has no limit set.
    pub(crate) no_limit: Option<NoLimit>,
    pub(crate) regular: bool,
    pub(crate) counts_index: bool,
    pub(crate) draws: bool,
    pub(crate) seeds: bool,
    /// Whether any object has a tint or a paint.
    pub(crate) tints: bool,
    /// Largest factor of stroke widths, if any object changes them.
    pub(crate) widest: Option<f64>,
    /// Whether maps may be arbitrary affine maps.
    pub(crate) affine: bool,
    /// Length of an element whose frame is the unit frame.
    pub(crate) unit: f64,
    /// Approximate centre of the subtree of an element, in the unit frame.
    pub(crate) middle: F::Point,
    /// Homothety from the graph's coordinates to those of the model.
    pub(crate) place: Homothety<F::Point>,
}

/// State of a graph between two steps.
#[derive(Clone, Debug)]
pub(crate) struct Between<F: Frame> {
    /// Share of the last step that has grown, from 0 to 1.
    pub(crate) share: f64,
    /// Graph of whole steps, which has the limit set of the model.
    pub(crate) whole: Arc<Graph<F>>,
}

impl<F: Frame> Graph<F> {
    /// Creates a graph of objects with fixed instances that are similarities, without draws, seeds and changes
    /// of appearance, resolved for any number of steps.
    pub(crate) fn of(
        objects: Vec<Object<F>>,
        base_elements: impl Into<Arc<[F::Outline]>>,
        initiators: Vec<Chain<F>>,
    ) -> Self {
        work::count(OBJECT * objects.len());
        Self {
            source: None,
            base_elements: base_elements.into(),
            origins: 0,
            objects,
            initiators,
            limit_bounds: None,
            listed: None,
            roots: Arc::default(),
            depth: None,
            only: None,
            between: None,
            no_limit: None,
            regular: true,
            counts_index: false,
            draws: false,
            seeds: false,
            tints: false,
            widest: None,
            affine: false,
            unit: 1.0,
            middle: F::Point::ZERO,
            place: Homothety::IDENTITY,
        }
    }

    /// Returns the share of the last step that has not grown yet; 0 except between two steps.
    pub(crate) fn lag(&self) -> f64 {
        self.between
            .as_ref()
            .map_or(0.0, |between| 1.0 - between.share)
    }

    /// Returns whether the graph consists of one approximant and does not know those before.
    pub(crate) fn is_of_one_step(&self) -> bool {
        self.only.is_some_and(|steps| steps > 0)
    }

    /// Returns the source of instances that are computed for each element.
    pub(crate) fn source(&self) -> &dyn Source<F> {
        let Some(source) = &self.source else {
            unreachable!("all instances of a graph without a source are fixed");
        };
        &**source
    }

    /// Returns the number of conditions, weights and generators that may be looked at to replace an element; a long condition
    /// counts as several.
    #[must_use]
    pub fn choices(&self) -> u64 {
        self.source.as_ref().map_or(1, |source| source.choices())
    }

    /// Returns the parts of an alternative; empty if all of its elements stay.
    pub(crate) fn parts(&self, alternative: &Alternative) -> &[Part] {
        self.source().parts(alternative.generator)
    }

    /// Returns the number of origins that objects may have: the number of generators of a rule, or of maps
    /// of a system; otherwise 0.
    #[must_use]
    pub fn origins(&self) -> usize {
        self.origins
    }

    /// Returns the objects.
    #[must_use]
    pub fn objects(&self) -> &[Object<F>] {
        &self.objects
    }

    /// Returns the chain from which a number of steps is grown: approximant 0, unless the graph [is
    /// time-indexed](Graph::is_time_indexed). Images under a [symmetry](crate::Symmetry) follow the elements as listed.
    #[must_use]
    pub fn initiator(&self, steps: u32) -> &Chain<F> {
        let last = self.initiators.len() - 1;
        &self.initiators[(steps as usize).min(last)]
    }

    /// Returns whether the initiators and as many images of them in all as `order` have at most `most` elements.
    pub(crate) fn has_room_for_images(&self, order: u64, most: u64) -> bool {
        let listed = self
            .initiators
            .iter()
            .map(|chain| chain.instances.len() as u64);
        listed.sum::<u64>().saturating_mul(order) <= most
    }

    /// Returns the position in the initiator as listed of an element of the initiator or of an image of it.
    pub(crate) fn listed_position(&self, position: u32) -> u32 {
        self.split_position(position)[1]
    }

    /// Returns the number of the image to which an element of the initiator belongs, and the element's position in the
    /// initiator as listed.
    pub(crate) fn split_position(&self, position: u32) -> [u32; 2] {
        match self.listed {
            Some(listed) => [position / listed, position % listed],
            None => [0, position],
        }
    }

    /// Iterates over all chains from which growth starts: initiators, and fractals seeded before.
    pub(crate) fn starts(&self) -> impl Iterator<Item = &Chain<F>> {
        let seeded = self.roots.seeded.iter().map(|seeded| &seeded.chain);
        self.initiators.iter().chain(seeded)
    }

    /// Returns whether the graph is time-indexed: whether its objects know the number of steps that
    /// remain, and each number of steps has its own initiator.
    #[must_use]
    pub fn is_time_indexed(&self) -> bool {
        self.initiators.len() > 1
    }

    /// Returns the homothety from the coordinates of the graph, its walks and its bounds to those of the
    /// model. It is the identity for most models.
    #[must_use]
    pub fn place(&self) -> &Homothety<F::Point> {
        &self.place
    }

    /// Returns the base elements to which objects refer.
    #[must_use]
    pub fn base_elements(&self) -> &[F::Outline] {
        &self.base_elements
    }

    /// Returns the number of steps for which every object is resolved; `None` if the graph is resolved
    /// for any number.
    #[must_use]
    pub fn depth(&self) -> Option<u32> {
        self.depth
    }

    /// Returns whether the structure is known without a walk: whether the generator that replaces an
    /// element does not depend on an index that has to be counted.
    #[must_use]
    pub fn is_regular(&self) -> bool {
        self.regular
    }

    /// Returns whether a walk counts indices, for the selection or for points that depend on them.
    #[must_use]
    pub fn counts_index(&self) -> bool {
        self.counts_index
    }

    /// Returns whether random numbers are drawn.
    #[must_use]
    pub fn draws(&self) -> bool {
        self.draws
    }

    /// Returns whether approximants may have several fractals: images of the initiator under a symmetry, or seeds.
    pub(crate) fn has_fractals(&self) -> bool {
        self.seeds || self.starts().any(|start| start.count() > 1)
    }

    /// Returns whether an object may be replaced, unlike one that is [kept](Replacement::Kept).
    #[inline]
    #[must_use]
    pub fn is_fertile(&self, object: usize) -> bool {
        !self.objects[object].is_kept()
    }

    /// Returns the base element of an object that is drawn.
    #[inline]
    pub(crate) fn drawn(&self, object: usize) -> Option<&F::Outline> {
        let object = &self.objects[object];
        object
            .visible
            .then(|| &self.base_elements[object.base_element])
    }

    /// Returns the change of appearance that an object applies to its subtree.
    #[inline]
    pub(crate) fn appearance(&self, object: usize) -> Appearance {
        let Object {
            tint,
            paint,
            thickness,
            composed,
            ..
        } = self.objects[object];
        let tint = composed.or(tint.map(Appearance::of));
        let tint = tint.unwrap_or(Appearance::NONE);
        let paint = paint.map(Appearance::of_paint);
        let thickness = thickness.map(Appearance::of_thickness);
        let all = [paint, thickness].into_iter().flatten();
        all.fold(tint, Appearance::over)
    }

    /// Returns whether any object changes the appearance of its subtree.
    #[inline]
    pub(crate) fn has_appearances(&self) -> bool {
        self.tints || self.widest.is_some()
    }

    /// Returns an upper bound of the factor of stroke widths, if widths differ in the graph. It does not
    /// hold for parts that are not drawn.
    #[must_use]
    pub fn widest(&self) -> Option<f64> {
        self.widest
    }

    /// Returns whether any object colours its subtree.
    #[must_use]
    pub fn tints(&self) -> bool {
        self.tints
    }

    /// Returns the graph as that of a model which has no limit set for a reason that the graph does not show.
    #[cfg(feature = "cli")]
    pub(crate) fn without_limit(&self, reason: NoLimit) -> Self {
        Self {
            no_limit: Some(reason),
            limit_bounds: None,
            ..self.clone()
        }
    }

    /// Returns whether maps may be arbitrary affine maps, as in systems; those of rules are similarities.
    #[must_use]
    pub fn is_affine(&self) -> bool {
        self.affine
    }

    /// Returns whether all maps are similarities, up to rounding.
    #[must_use]
    pub fn is_similar(&self) -> bool {
        !self.affine
            || self
                .instances()
                .all(|(_, instance)| instance.frame.is_similarity(instance.length))
    }

    /// Returns whether the frames of all instances in which fractals start are similarities, up to rounding.
    pub(crate) fn starts_similar(&self) -> bool {
        let mut starts = self.starts().flat_map(|start| &start.instances);
        !self.affine || starts.all(|it| it.frame.is_similarity(it.length))
    }

    /// Returns whether any element may join the one before it.
    pub(crate) fn joins(&self) -> bool {
        let all = self.instances().map(|(_, instance)| instance);
        let all = all.chain(self.starts().flat_map(|start| &start.instances));
        !self.is_plain() || { all }.any(|instance| instance.joined)
    }

    /// Returns whether lines may join base elements that do not end where their frames do, so that what is drawn depends
    /// on the order of elements.
    pub(crate) fn links(&self) -> bool {
        let mut drawn = self.objects().iter().filter(|object| object.visible);
        drawn.any(|object| {
            let base_element = &self.base_elements()[object.base_element];
            !base_element.is_closed() && base_element.ends_meet_frame() != [true; 2]
        }) && self.joins()
    }

    /// Returns the length of an element whose frame is the unit frame: 1 in rules, in systems the longer
    /// side of the limit set's box.
    #[must_use]
    pub fn unit(&self) -> f64 {
        self.unit
    }

    /// Iterates over the first object of every behaviour.
    pub(crate) fn behaviours(&self) -> impl Iterator<Item = &Object<F>> {
        self.behaviours_by_number().map(|(_, object)| object)
    }

    /// Iterates over the first object of every behaviour, with its number.
    pub(crate) fn behaviours_by_number(&self) -> impl Iterator<Item = (usize, &Object<F>)> {
        // Behaviours are numbered in the order of the objects.
        let mut next = 0;
        self.objects.iter().enumerate().filter(move |(_, object)| {
            let first = object.behaviour == next;
            next += usize::from(first);
            first
        })
    }

    /// Returns whether the graph is plain: whether every successor is a list of fixed maps.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        !self
            .objects
            .iter()
            .any(|object| matches!(object.replacement, Replacement::Evaluated(_)))
    }
}

impl<F: Frame> Graph<F> {
    /// Returns the initiators in order to change them, and with them the limit set.
    pub(crate) fn initiators_mut(&mut self) -> &mut Vec<Chain<F>> {
        self.limit_bounds = None;
        &mut self.initiators
    }

    /// Sets the centre and the unit of length to those of the box of what is drawn.
    pub(crate) fn set_extent(&mut self, bounds: &Bounds<F::Point>) {
        self.middle = bounds.centre();
        let size = bounds.size().max_element();
        self.unit = if size > 0.0 { size } else { 1.0 };
    }
}

impl Graph {
    /// Moves the initiators into the coordinates that a homothety maps to the present ones.
    pub(crate) fn started_within(mut self, place: &Homothety) -> Self {
        if place.is_identity() {
            return self;
        }
        let within = |chain: &mut Chain| {
            for instance in &mut chain.instances {
                instance.frame = instance.frame.preimage(place);
                instance.length = instance.frame.length();
            }
        };
        self.initiators_mut().iter_mut().for_each(within);
        self.place = Homothety::new(
            self.place.exponent() + place.exponent(),
            self.place.point(place.point(DVec2::ZERO)),
        );
        self
    }

    /// Replaces what is grown by its images under isometries, in the graph's coordinates. Each image is a fractal, or several,
    /// of its own: it has the indices and the draws of the set. The positions of its elements in the initiator come after
    /// those of the images before.
    #[must_use]
    pub fn with_images(mut self, isometries: &[DAffine2]) -> Self {
        if *isometries == [DAffine2::IDENTITY] {
            return self;
        }
        let keeps_directions = self.affine;
        let instances = self.initiators.iter().flat_map(|chain| &chain.instances);
        let stride = instances.map(|it| it.position + 1).max().unwrap_or(1);
        self.listed = self.listed.or(NonZero::new(stride));
        for chain in self.initiators_mut() {
            let breaks = std::mem::take(&mut chain.breaks);
            let listed = std::mem::take(&mut chain.instances);
            for (image, isometry) in (0..).zip(isometries) {
                let before = chain.instances.len();
                let first = Some(before).filter(|_| image > 0);
                chain.breaks.extend(first);
                chain.breaks.extend(breaks.iter().map(|at| before + at));
                chain.instances.extend(listed.iter().map(|it| Instance {
                    frame: it.frame.image(isometry, keeps_directions),
                    position: it.position + image * stride,
                    ..it.clone()
                }));
            }
        }
        self
    }

    /// Turns what is grown about the origin of the model by a number of degrees, counter-clockwise.
    pub(crate) fn turned(mut self, by: f64) -> Self {
        if by == 0.0 {
            return self;
        }
        let axis = |vector: [f64; 2]| DVec2::from_array(degrees::turned(vector, by));
        let turn = DAffine2::from_mat2(DMat2::from_cols(axis([1.0, 0.0]), axis([0.0, 1.0])));
        let turned = |chain: &mut Chain| {
            for instance in &mut chain.instances {
                instance.frame = instance.frame.mapped(&turn);
            }
        };
        self.initiators_mut().iter_mut().for_each(turned);
        if !self.roots.seeded.is_empty() {
            let seeded = Arc::make_mut(&mut self.roots).seeded.iter_mut();
            seeded.for_each(|seeded| turned(&mut seeded.chain));
        }
        let shift = turn.transform_point2(self.place.point(DVec2::ZERO));
        self.place = Homothety::new(self.place.exponent(), shift);
        self
    }
}
