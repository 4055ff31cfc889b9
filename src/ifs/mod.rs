//! Iterated function systems: affine maps of the plane or of space, the walk of random iteration, condensation sets.
//!
//! An [`Ifs`] is the validated model of the systems of Demko, Hodges & Naylor ("Iterated function systems",
//! SIGGRAPH 1985). Maps f_1 … f_n that contract have one compact set A with A = f_1(A) ∪ … ∪ f_n(A) ∪ C, the
//! *attractor*; C is the union of the *condensation sets*. With a weight for every map and every condensation
//! set, *random iteration* draws A: a point moves to its image under a map that is picked by weight, or is
//! drawn anew from a condensation set.
//!
//! # Direction of edges
//!
//! A *recurrent* system has a digraph too. An edge from i to j means that f_j may be applied **after** f_i
//! in random iteration. Let A_i be the part of the attractor that holds the points that f_i has just moved.
//! Then A_j = f_j(C) ∪ ⋃ f_j(A_i) over the edges i → j, and A = C ∪ A_1 ∪ … ∪ A_n. This is equation (2) of
//! Hart ("The object instancing paradigm for linear fractal modeling", 1992). Barnsley, Elton & Hardin
//! ("Recurrent iterated function systems", 1989) have the same convention: their p_ij is the probability of
//! going from i to j. In the instancing graph the edge points backwards: object j holds an instance of
//! object i under f_j. After a condensation set any map may follow.
//!
//! The digraph need not be strongly connected: the equations still have one solution where the maps
//! contract and every vertex is entered. The walk then ends in a part of the digraph that it cannot
//! leave; see [`Walk::stationary`].
//!
//! # Guarantees
//!
//! There is at least one map and all numbers are finite. All weights are positive. Edges lead from and to
//! existing maps, none is listed twice, and every map is entered and left by one. Condensation sets have an
//! extent, or are points. Contraction of the maps is not guaranteed; [`Ifs::contraction`] reports it.
//!
//! Maps, edges and condensation sets are numbered from 0 in this module, and from 1 in messages.

mod affine_map;
mod connectedness;
mod contraction;
mod covered;
mod error;
mod interpolation;
mod linear;
mod lyapunov;
mod map;
mod measure;
mod moments;
mod norm;
mod raw_moments;
mod shape;
mod shrinking;
mod system;
mod walk;

pub use affine_map::{AffineMap, OutlineOf, PointOf};
pub use connectedness::{Connectedness, ConnectednessSearch};
pub use contraction::{Contraction, Verdict};
pub use covered::covered_area;
pub use error::{IfsError, WeightOwner};
pub(crate) use interpolation::pieces;
pub use interpolation::{
    InterpolationError, interpolate, interpolation_dimension, scale_of_dimension,
};
pub use lyapunov::Exponent;
pub use map::{Map, about, axes, complex, complex_conjugate, toward};
pub use measure::{MapMeasure, Measure};
pub use moments::Moments;
pub(crate) use norm::best_coordinates;
pub use raw_moments::RawMoments;
pub use shape::Shape;
pub(crate) use shrinking::{Shrinking, sum_of_products};
pub use system::System;
pub use walk::{Choice, Step, Walk};

use crate::geometry::{DAffine2, Homothety, Linear};
use error::check;

/// An edge of the digraph of a recurrent system: map `to` may be applied after map `from`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// The map that was applied last.
    pub from: usize,
    /// The map that may be applied next.
    pub to: usize,
    /// Weight of the edge relative to the other edges from the same map; the weight of the map `to` if
    /// `None`.
    pub weight: Option<f64>,
}

/// A condensation set: a set that belongs to the attractor together with all its images.
#[derive(Clone, Debug, PartialEq)]
pub struct Condensation<M: AffineMap = DAffine2> {
    /// The set.
    pub shape: M::Set,
    /// Weight of drawing a point anew from the set, relative to the weights of the maps; the mean of these if
    /// `None`.
    pub weight: Option<f64>,
}

/// The parts of a system before validation.
#[derive(Clone, Debug, PartialEq)]
pub struct Definition<M: AffineMap = DAffine2> {
    /// The maps.
    pub maps: Vec<Map<M>>,
    /// Edges of the digraph; if `None`, any map may follow any.
    pub edges: Option<Vec<Edge>>,
    /// The condensation sets.
    pub condensation: Vec<Condensation<M>>,
    /// Initial set of deterministic iteration, in the coordinates of the plane or of space.
    pub initial: Option<M::Set>,
}

impl<M: AffineMap> Default for Definition<M> {
    fn default() -> Self {
        Self {
            maps: Vec::new(),
            edges: None,
            condensation: Vec::new(),
            initial: None,
        }
    }
}

/// An iterated function system; its guarantees are those of the [module](self).
#[derive(Clone, Debug, PartialEq)]
pub struct Ifs<M: AffineMap = DAffine2> {
    definition: Definition<M>,
    weights: Vec<f64>,
    condensation_weights: Vec<f64>,
    edge_weights: Vec<f64>,
}

impl<M: AffineMap> Ifs<M> {
    /// Builds a system from its parts.
    ///
    /// Maps without weights get default ones: |det| of the linear part or a twentieth of the mean |det| of
    /// all maps, whichever is larger, divided by the sum; equal weights if all determinants are 0. A map that
    /// flattens the plane (the fern's stem) is thus still visited, and the weights add up to 1.
    ///
    /// # Errors
    ///
    /// Returns all errors of the parts, in the order maps, edges, condensation sets, initial set.
    pub fn new(definition: Definition<M>) -> Result<Self, Vec<IfsError>> {
        let errors = check(&definition);
        if !errors.is_empty() {
            return Err(errors);
        }
        let weights = map_weights(&definition.maps);
        let mean = mean(&weights);
        let condensation = definition.condensation.iter();
        let condensation_weights = condensation.map(|set| set.weight.unwrap_or(mean)).collect();
        let edges = definition.edges.iter().flatten();
        let edge_weights = edges.map(|edge| edge.weight.unwrap_or(weights[edge.to]));
        Ok(Self {
            edge_weights: edge_weights.collect(),
            weights,
            condensation_weights,
            definition,
        })
    }

    /// Returns the maps.
    #[must_use]
    pub fn maps(&self) -> &[Map<M>] {
        &self.definition.maps
    }

    /// Returns the weights of the maps: as given, or the defaults of [`Ifs::new`].
    #[must_use]
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Returns whether the weights of the maps are the defaults of [`Ifs::new`].
    #[must_use]
    pub fn has_default_weights(&self) -> bool {
        self.maps().iter().all(|map| map.weight.is_none())
    }

    /// Returns whether weights of maps or edges were given.
    #[must_use]
    pub fn has_weights(&self) -> bool {
        let edges = self.definition.edges.iter().flatten();
        !self.has_default_weights() || { edges }.any(|edge| edge.weight.is_some())
    }

    /// Returns the edges of the digraph with their weights, in the order of listing; `None` where any map may
    /// follow any other and itself, by its own weight.
    pub fn edges(&self) -> Option<impl Iterator<Item = (Edge, f64)>> {
        let edges = self.definition.edges.as_ref()?;
        Some(edges.iter().copied().zip(self.edge_weights.iter().copied()))
    }

    /// Returns whether the system has a digraph.
    #[must_use]
    pub fn is_recurrent(&self) -> bool {
        self.definition.edges.is_some()
    }

    /// Returns for each map the maps that may follow it, in the order of the edges; `None` where all may.
    pub(crate) fn successors(&self) -> Option<Vec<Vec<usize>>> {
        let mut successors = vec![Vec::new(); self.maps().len()];
        for edge in self.definition.edges.as_ref()? {
            successors[edge.from].push(edge.to);
        }
        Some(successors)
    }

    /// Returns the condensation sets.
    #[must_use]
    pub fn condensation(&self) -> &[Condensation<M>] {
        &self.definition.condensation
    }

    /// Returns the weight of every condensation set, on the scale of [`Ifs::weights`].
    #[must_use]
    pub fn condensation_weights(&self) -> &[f64] {
        &self.condensation_weights
    }

    /// Returns the initial set of deterministic iteration, if there is one.
    #[must_use]
    pub fn initial(&self) -> Option<&M::Set> {
        self.definition.initial.as_ref()
    }

    /// Estimates the number of instances in the system's graph: every map inside every map, and every outline
    /// inside these.
    pub(crate) fn size(&self) -> usize {
        let maps = self.maps().len();
        maps.saturating_mul(maps)
            .saturating_mul(1 + self.outlines())
    }

    /// Returns the number of outlines of all sets.
    fn outlines(&self) -> usize {
        let sets = self.condensation().iter().map(|set| &set.shape);
        let outlines = sets.chain(self.initial()).map(|set| M::outlines(set).len());
        outlines.sum()
    }

    /// Returns the number of instances that the system's graph holds.
    pub(crate) fn held(&self) -> usize {
        let maps = self.maps().len();
        let inside = match &self.definition.edges {
            Some(edges) => edges.len(),
            None if self.is_alike() => maps,
            None => maps.saturating_mul(maps),
        };
        inside.saturating_mul(1 + self.outlines())
    }

    /// Returns whether the set inside every map is replaced by the same objects of the system's graph. They depend on
    /// the map with a digraph, and with condensation sets beside an initial set, whose objects are inside the map.
    pub(crate) fn is_alike(&self) -> bool {
        let drawn_apart = !self.condensation().is_empty() && self.initial().is_some();
        !self.is_recurrent() && !drawn_apart
    }

    /// Returns the composition of maps that are applied one after the other, the first of the list first.
    ///
    /// # Panics
    ///
    /// Panics if an index is not that of a map.
    #[must_use]
    pub fn composition(&self, word: &[usize]) -> M {
        let maps = word.iter().map(|&map| self.maps()[map].affine);
        maps.fold(M::IDENTITY, |before, map| map * before)
    }

    /// Returns the fixed point of every map; `None` where there is none, or more than one.
    ///
    /// The fixed point of a map lies on the attractor; in a recurrent system only if the map may follow
    /// itself.
    #[must_use]
    pub fn fixed_points(&self) -> Vec<Option<PointOf<M>>> {
        self.maps().iter().map(Map::fixed_point).collect()
    }
}

impl Ifs {
    /// Returns the system in the coordinates that a homothety maps to its own; `None` if a set has no extent
    /// there.
    pub(crate) fn within(&self, place: &Homothety) -> Option<Self> {
        let mut within = self.clone();
        let (definition, back) = (&mut within.definition, place.backwards());
        for map in &mut definition.maps {
            map.affine = place.within(&map.affine);
        }
        for set in &mut definition.condensation {
            set.shape = set.shape.transformed(&back)?;
        }
        if let Some(initial) = &mut definition.initial {
            *initial = initial.transformed(&back)?;
        }
        Some(within)
    }
}

/// Returns the weights of the maps: as given, or the defaults of [`Ifs::new`].
fn map_weights<M: AffineMap>(maps: &[Map<M>]) -> Vec<f64> {
    let given: Option<Vec<f64>> = maps.iter().map(|map| map.weight).collect();
    given.unwrap_or_else(|| {
        let areas = maps
            .iter()
            .map(|map| map.affine.linear().determinant().abs());
        let areas: Vec<f64> = areas.collect();
        let floor = mean(&areas) / 20.0;
        let raised: Vec<f64> = areas.iter().map(|area| area.max(floor)).collect();
        // The determinants may leave the range of a double at either end.
        shares(&raised).unwrap_or_else(|| shares(&vec![1.0; maps.len()]).unwrap_or_default())
    })
}

fn mean(values: &[f64]) -> f64 {
    let shares = vec![1.0; values.len()];
    let shares = self::shares(&shares).unwrap_or_default();
    values
        .iter()
        .zip(shares)
        .map(|(value, share)| value * share)
        .sum()
}

/// Returns weights divided by their sum; `None` if a share is not finite.
fn shares(weights: &[f64]) -> Option<Vec<f64>> {
    // The sum alone may overflow.
    let largest = weights.iter().copied().fold(0.0, f64::max);
    let sum: f64 = weights.iter().map(|weight| weight / largest).sum();
    let shares = weights.iter().map(|weight| weight / largest / sum);
    let shares: Vec<f64> = shares.collect();
    shares
        .iter()
        .all(|share| share.is_finite())
        .then_some(shares)
}
