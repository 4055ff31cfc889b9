//! Normalisation: coordinates in which a model has an extent of about 1 and lies near the origin.
//!
//! A fractal does not depend on scale and position, but doubles have a limited range and precision. A
//! model that is large, small or far from the origin is therefore compiled in normalised coordinates,
//! which a [`Homothety`] by a power of two maps to its own; the ratio is exact in doubles. Computations
//! on the graph see numbers of order 1, and [`Graph::place`] maps results back where coordinates are
//! reported.
//!
//! A rule is moved by its initiator alone, because generators are written in the unit frames of elements.
//! In a system and in a structure every map f becomes h⁻¹ f h, and every set its image under h⁻¹. An
//! L-system starts at the origin and represents lengths of any exponent itself.

use crate::compile::growing;
use crate::geometry::{Bounds, DVec2, Homothety, exponent_of};
use crate::graph::{CompileError, EXTENTS, FARTHEST, Graph, OutOfRange};
use crate::ifs::Map;
use crate::style::ColorBy;

use super::Model;

/// Limit of extents that are used unchanged; larger ones, and those below its inverse, are normalised.
const ORDINARY: f64 = (1u64 << 20) as f64;

/// Limit of the distance from the origin, as a multiple of the extent, of models that are used unchanged.
const NEAR: f64 = 1000.0;

/// Estimate of the position and size of a model.
pub(crate) struct Extent {
    /// Point of the model.
    at: DVec2,
    /// Longer side of a box that is at most as large as the bounding box.
    size: f64,
}

impl Extent {
    /// Returns the extent of points of a model and of the images of the first point under `maps`, or
    /// `None` if there is no point.
    pub(super) fn of(
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

    /// Returns the homothety from suitable normalised coordinates; `exactly` measures the extent in
    /// these.
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
        // The factor of two keeps rounding from deciding at the ends of the range.
        if !(EXTENTS[0] / 2.0..=EXTENTS[1] * 2.0).contains(&size) {
            return Err(OutOfRange::Size { size });
        }
        let is_near = distance <= NEAR * size;
        if is_near && (1.0 / ORDINARY..=ORDINARY).contains(&size) {
            return Ok(Homothety::IDENTITY);
        }
        let shift = if is_near { DVec2::ZERO } else { at };
        let place = Homothety::new(exponent_of(size), shift);
        // The estimate may be several times too small.
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
    /// model is more than about a million times larger or smaller than 1, or further from the origin than
    /// a thousand times its extent. It is the identity, too, if a shape has no extent in normalised
    /// coordinates.
    ///
    /// # Errors
    ///
    /// If the extent of the model is above 1e300 or below 1e-300 (within a factor of 2), or its distance
    /// from the origin reaches 1e12 times its extent.
    pub fn place(&self) -> Result<Homothety, OutOfRange> {
        let exactly = |place: &Homothety| {
            let graph = (self.compile_within(place, 0, 0, Self::MAX_ELEMENTS)).ok()?;
            Some(graph.limit_bounds()?.size().max_element())
        };
        let extent = self.as_kind().extent();
        let place = extent.map_or(Ok(Homothety::IDENTITY), |extent| extent.place(exactly))?;
        let stays =
            place.is_identity() || !self.as_kind().has_plane_maps() || self.moved(&place).is_some();
        Ok(if stays { place } else { Homothety::IDENTITY })
    }

    /// Returns the model in the coordinates that a homothety maps to its own, if it is a system or a
    /// structure, whose maps are maps of the whole plane. Other models are returned unchanged, as are
    /// models in which a shape has no extent in these coordinates.
    #[must_use]
    pub fn within(&self, place: &Homothety) -> Self {
        self.moved(place).unwrap_or_else(|| self.clone())
    }

    fn moved(&self, place: &Homothety) -> Option<Self> {
        match place.is_identity() {
            true => None,
            false => self.as_kind().within(place),
        }
    }

    /// Compiles the model as [`Model::compile_for`] does, in normalised coordinates: see [`Model::place`]
    /// and [`Graph::place`].
    ///
    /// # Errors
    ///
    /// As for [`Model::compile_for`] and [`Model::place`], and if a rule grows beyond the range of
    /// doubles.
    pub fn compile_normalised(
        &self,
        steps: u32,
        seed: u64,
        max_elements: u64,
    ) -> Result<Graph, CompileError> {
        let graph = self.compile_within(&self.place()?, steps, seed, max_elements)?;
        let graph = self.as_kind().normalised(graph, steps);
        graph.ok_or_else(|| OutOfRange::Growth { step: steps }.into())
    }

    /// Compiles the model as [`Model::compile_for`] does, in the coordinates that `place` maps to its
    /// own.
    ///
    /// # Errors
    ///
    /// As for [`Model::compile_for`].
    pub fn compile_within(
        &self,
        place: &Homothety,
        steps: u32,
        seed: u64,
        max_elements: u64,
    ) -> Result<Graph, CompileError> {
        if let Some(moved) = self.moved(place) {
            let mut graph = moved.compile_for(steps, seed, max_elements)?;
            graph.place = *place;
            return Ok(graph);
        }
        let graph = self.compile_for(steps, seed, max_elements)?;
        Ok(match self.as_kind().has_plane_maps() {
            true => graph,
            false => graph.started_within(place),
        })
    }

    /// Compiles the graph that colours by a property need, with `compile` where they need no other than any
    /// picture. Returns `None` if there are too many maps and sets to distinguish.
    ///
    /// # Errors
    ///
    /// As for [`Model::place`] and `compile`.
    pub(crate) fn compile_coloured(
        &self,
        color_by: ColorBy,
        compile: impl FnOnce() -> Result<Graph, CompileError>,
    ) -> Result<Option<Graph>, CompileError> {
        match (self, color_by) {
            (Self::Ifs(_), ColorBy::LastMap) => self.with_last_maps_normalised(),
            _ => compile().map(Some),
        }
    }

    /// Returns [`Graph::with_last_maps`] of a system in normalised coordinates, or `None` if there are
    /// too many maps, or if the model is not a system.
    ///
    /// # Errors
    ///
    /// As for [`Model::place`].
    fn with_last_maps_normalised(&self) -> Result<Option<Graph>, CompileError> {
        let place = self.place()?;
        let (model, place) = match self.moved(&place) {
            Some(moved) => (moved, place),
            None => (self.clone(), Homothety::IDENTITY),
        };
        let Self::Ifs(system) = &model else {
            return Ok(None);
        };
        let Some(graph) = Graph::with_last_maps(system) else {
            return Ok(None);
        };
        let graph = model.with_images(growing::of_system(system, graph), Self::MAX_LISTED)?;
        Ok(Some(Graph { place, ..graph }))
    }
}
