//! Normalisation: coordinates in which a model has about the extent 1 and lies near the origin.
//!
//! A fractal does not depend on scale and place, but doubles have a limited range and precision. A model
//! that is large, small or far from the origin is therefore compiled in normalised coordinates, which a
//! [`Homothety`] by a power of two maps to its own; the ratio is exact in doubles. Computations on the graph
//! see numbers of order 1, and [`Graph::place`] maps results back where coordinates are reported.
//!
//! A rule is moved by its initiator alone, for generators live in the unit frames of elements. In a system
//! and in a structure every map f becomes h⁻¹ f h, and every set its image under h⁻¹. An L-system starts at
//! the origin and keeps lengths of any exponent itself.

use crate::geometry::{Bounds, DVec2, Homothety};
use crate::graph::{CompileError, Graph, exponent_of};
use crate::ifs::{self, Map};
use crate::instancing::{Instancing, Master};
use crate::rule::Rule;

use super::Model;

/// Extents beyond this, or below its inverse, are normalised.
const ORDINARY: f64 = (1u64 << 20) as f64;

/// Models at more than this multiple of their extent from the origin are normalised.
const NEAR: f64 = 1000.0;

/// The largest distance from the origin as a multiple of the extent; beyond, doubles do not resolve pixels.
const FARTHEST: f64 = 1e12;

/// The smallest and the largest extent of a model: approximants must stay in the range of doubles.
const EXTENTS: [f64; 2] = [1e-300, 1e300];

/// An error: a model beyond the range or the precision of doubles.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum OutOfRange {
    /// The model is too large or too small.
    #[error(
        "it is {size:.3e} across: what is drawn and measured is from {least:e} to {most:e}; numbers \
         in other units are right",
        least = EXTENTS[0],
        most = EXTENTS[1]
    )]
    Size {
        /// The longer side of its box, approximately.
        size: f64,
    },
    /// The model is too far from the origin.
    #[error(
        "it lies {distance:.3e} from the origin, {ratio:.1e} times its extent of {size:.3e}: numbers do not \
         tell its points apart, and less than {FARTHEST:e} times is right, such as a place at the origin",
        ratio = distance / size
    )]
    Distance {
        /// The distance from the origin.
        distance: f64,
        /// The longer side of its box, approximately.
        size: f64,
    },
    /// An approximant leaves the range of doubles.
    #[error(
        "by step {step} it becomes larger than the range of numbers, 1.8e308: fewer steps are right"
    )]
    Growth {
        /// The number of the step.
        step: u32,
    },
}

/// About where a model is, and how large.
struct Extent {
    /// A point of it.
    at: DVec2,
    /// The longer side of a box, which is no larger than its own.
    size: f64,
}

impl Extent {
    /// Of points of a model, if there are any, and of maps by which others are made of each.
    fn of(
        points: impl IntoIterator<Item = DVec2>,
        maps: impl Iterator<Item = Map>,
    ) -> Option<Self> {
        let mut points = points.into_iter();
        let at = points.next()?;
        let mut bounds = Bounds::new(at, at);
        let images = maps.map(|map| map.affine.transform_point2(at));
        points.chain(images).for_each(|point| bounds.add(point));
        Some(Self {
            at,
            size: bounds.size().max_element(),
        })
    }

    fn of_rule(rule: &Rule) -> Option<Self> {
        Self::of(rule.initiator_points().iter().copied(), std::iter::empty())
    }

    fn of_system(system: &ifs::System) -> Option<Self> {
        let ifs = system.ifs();
        let sets = ifs.condensation().iter().map(|set| &set.shape);
        let fixed = ifs.fixed_points().into_iter().flatten();
        let drawn = sets.flat_map(|set| set.control_points());
        Self::of(fixed.chain(drawn), ifs.maps().iter().cloned())
    }

    fn of_structure(structure: &Instancing) -> Option<Self> {
        let maps = || {
            let instances = structure.instances();
            let objects = instances.filter(|it| matches!(it.master, Master::Object(_)));
            objects.map(|it| Map::new(structure.map_of(it)))
        };
        let shapes = structure.instances().filter_map(|it| match &it.master {
            Master::Shape(shape) => shape.transformed(&it.map),
            Master::Object(_) => None,
        });
        let drawn = shapes.flat_map(|shape| shape.control_points());
        let initial = structure.initial().map(ifs::Shape::control_points);
        let fixed = maps().filter(Map::contracts);
        let fixed = fixed.filter_map(|map| map.fixed_point());
        let points = drawn.chain(initial.into_iter().flatten()).chain(fixed);
        Self::of(points, maps())
    }

    /// The coordinates that suit it. `exactly` measures its extent in these.
    fn place(
        &self,
        exactly: impl FnOnce(&Homothety) -> Option<f64>,
    ) -> Result<Homothety, OutOfRange> {
        let Self { at, size } = *self;
        let distance = at.abs().max_element();
        if size <= 0.0 {
            // A point has no size.
            let is_ordinary = distance == 0.0 || (1.0 / ORDINARY..=ORDINARY).contains(&distance);
            let shift = if is_ordinary { DVec2::ZERO } else { at };
            return Ok(Homothety::new(0, shift));
        }
        // At the ends of the range, rounding does not decide.
        if !(EXTENTS[0] / 2.0..=EXTENTS[1] * 2.0).contains(&size) {
            return Err(OutOfRange::Size { size });
        }
        let is_near = distance <= NEAR * size;
        if is_near && (1.0 / ORDINARY..=ORDINARY).contains(&size) {
            return Ok(Homothety::IDENTITY);
        }
        let shift = if is_near { DVec2::ZERO } else { at };
        let place = Homothety::new(exponent_of(size), shift);
        // What is estimated may be some times too small.
        if distance >= FARTHEST / 16.0 * size {
            let exactly = exactly(&place).map_or(size, |extent| extent * place.ratio());
            let size = size.max(exactly);
            if distance >= FARTHEST * size {
                return Err(OutOfRange::Distance { distance, size });
            }
        }
        Ok(place)
    }
}

impl Model {
    /// Returns the homothety from normalised coordinates to those of the model: the identity, unless the
    /// model is more than about a million times larger or smaller than 1, or more than a thousand times its
    /// extent away from the origin.
    ///
    /// # Errors
    ///
    /// If the model is larger than 1e300, smaller than 1e-300, or 1e12 times its extent away from the origin.
    pub fn place(&self) -> Result<Homothety, OutOfRange> {
        let extent = match self {
            Self::Rule(rule) => Extent::of_rule(rule),
            Self::Ifs(system) => Extent::of_system(system),
            Self::Instancing(structure) => Extent::of_structure(structure),
            Self::LSystem(_) => None,
        };
        let exactly = |place: &Homothety| {
            let graph = (self.compile_within(place, 0, 0, Self::MOST_ELEMENTS)).ok()?;
            Some(graph.limit_bounds()?.size().max_element())
        };
        let place = extent.map_or(Ok(Homothety::IDENTITY), |extent| extent.place(exactly))?;
        let stays =
            place.is_identity() || matches!(self, Self::Rule(_)) || self.moved(&place).is_some();
        Ok(if stays { place } else { Homothety::IDENTITY })
    }

    /// Returns the model in the coordinates that a homothety maps to its own, if its maps are those of the
    /// whole plane (a system or a structure). Other models are returned unchanged, and so are those without
    /// an extent in these coordinates.
    #[must_use]
    pub fn within(&self, place: &Homothety) -> Self {
        self.moved(place).unwrap_or_else(|| self.clone())
    }

    fn moved(&self, place: &Homothety) -> Option<Self> {
        match self {
            _ if place.is_identity() => None,
            Self::Ifs(system) => Some(Self::Ifs(system.within(place)?.into())),
            Self::Instancing(structure) => Some(Self::Instancing(structure.within(place)?.into())),
            Self::Rule(_) | Self::LSystem(_) => None,
        }
    }

    /// Compiles the model as [`Model::compile_for`] does, in normalised coordinates: see [`Model::place`]
    /// and [`Graph::place`].
    ///
    /// # Errors
    ///
    /// As for [`Model::compile_for`] and [`Model::place`], and if a rule grows beyond the range of numbers.
    pub fn compile_near(
        &self,
        steps: u32,
        seed: u64,
        most_elements: u64,
    ) -> Result<Graph, CompileError> {
        let graph = self.compile_within(&self.place()?, steps, seed, most_elements)?;
        if !matches!(self, Self::Rule(_)) {
            return Ok(graph);
        }
        let graph = graph.in_units_of(steps);
        graph.ok_or_else(|| OutOfRange::Growth { step: steps }.into())
    }

    /// Compiles the model as [`Model::compile_for`] does, in the coordinates that `place` maps to its own.
    ///
    /// # Errors
    ///
    /// As for [`Model::compile_for`].
    pub fn compile_within(
        &self,
        place: &Homothety,
        steps: u32,
        seed: u64,
        most_elements: u64,
    ) -> Result<Graph, CompileError> {
        if let Some(moved) = self.moved(place) {
            let mut graph = moved.compile_for(steps, seed, most_elements)?;
            graph.place = *place;
            return Ok(graph);
        }
        let graph = self.compile_for(steps, seed, most_elements)?;
        Ok(match self {
            Self::Rule(_) | Self::LSystem(_) => graph.started_within(place),
            Self::Ifs(_) | Self::Instancing(_) => graph,
        })
    }

    /// Returns [`Graph::telling_last_maps`] of a system in normalised coordinates. `None` if there are too
    /// many maps, or if the model is no system.
    ///
    /// # Errors
    ///
    /// As for [`Model::place`].
    pub fn telling_last_maps_near(&self) -> Result<Option<Graph>, OutOfRange> {
        let place = self.place()?;
        let (model, place) = match self.moved(&place) {
            Some(moved) => (moved, place),
            None => (self.clone(), Homothety::IDENTITY),
        };
        let Self::Ifs(system) = &model else {
            return Ok(None);
        };
        let graph = Graph::telling_last_maps(system);
        Ok(graph.map(|graph| Graph { place, ..graph }))
    }
}
