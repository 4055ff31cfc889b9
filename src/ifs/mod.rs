//! Iterated function systems: affine maps of the plane, a walk among them, condensation sets.
//!
//! An [`Ifs`] is the validated model of what Demko, Hodges & Naylor ("Iterated function systems",
//! SIGGRAPH 1985) draw. Maps f_1 … f_n that contract have one compact set A with
//! A = f_1(A) ∪ … ∪ f_n(A) ∪ C, the *attractor*; C is the union of the *condensation sets*. With a
//! weight for every map and every condensation set, *random iteration* draws A: a point goes to its
//! image under a map that is picked by weight, or is drawn anew from a condensation set.
//!
//! # Which way an edge points
//!
//! A *recurrent* system has a digraph too. An edge from i to j says that f_j may be applied **after**
//! f_i in random iteration. With A_i the part of the attractor where points stand that f_i has just
//! moved, A_j = f_j(C) ∪ ⋃ f_j(A_i) over the edges i → j, and A = C ∪ A_1 ∪ … ∪ A_n. This is
//! equation (2) of Hart ("The object instancing paradigm for linear fractal modeling", 1992) and the
//! convention of Barnsley, Elton & Hardin ("Recurrent iterated function systems", 1989), whose p_ij is
//! the probability of going from i to j. As objects that instance each other the edge points
//! backwards: object j holds an instance of object i under f_j. After a condensation set any map may
//! follow.
//!
//! The digraph need not be strongly connected: the equations still have one solution where the maps
//! contract and every vertex is entered. The walk then ends in a part of the digraph that it cannot
//! leave; see [`Walk::stationary`].
//!
//! # What is guaranteed
//!
//! There is at least one map and all numbers are finite. All weights are positive. Edges lead from
//! and to maps that exist, none is listed twice, and every map is entered and left by one.
//! Condensation sets have an extent, or are points. Whether the maps contract is not guaranteed but
//! told by [`Ifs::contraction`].
//!
//! Maps, edges and condensation sets are numbered from 0 here, and from 1 in messages.

mod contraction;
mod error;
mod interpolation;
mod linear;
mod map;
mod measure;
mod moments;
mod norm;
mod shape;
mod shrinking;
mod system;
mod walk;

pub use contraction::{Contraction, Verdict};
pub use error::{IfsError, Weighted};
pub use interpolation::{
    InterpolationError, interpolate, interpolation_dimension, scale_of_dimension,
};
pub use map::{Map, about, axes, complex, complex_conjugate, toward};
pub use measure::{Measure, Part};
pub use moments::Moments;
pub use shape::Shape;
pub(crate) use shrinking::Shrinking;
pub use system::System;
pub(crate) use system::hull;
pub use walk::{Choice, Step, Walk};

use crate::geometry::{DAffine2, DVec2, Homothety};
use error::check;

/// An edge of the digraph of a recurrent system: map `to` may be applied after map `from`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// The map that was applied last.
    pub from: usize,
    /// The map that may be applied next.
    pub to: usize,
    /// How likely it is, relative to the other edges from the same map; the weight of the map `to`
    /// unless given.
    pub weight: Option<f64>,
}

/// A set that belongs to the attractor with all its images.
#[derive(Clone, Debug, PartialEq)]
pub struct Condensation {
    /// The set.
    pub shape: Shape,
    /// How often a point is drawn anew from it, relative to the weights of the maps; the mean of
    /// these unless given.
    pub weight: Option<f64>,
}

/// The parts of a system, not checked yet.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Definition {
    /// The maps.
    pub maps: Vec<Map>,
    /// Which map may follow which; any may follow any unless given.
    pub edges: Option<Vec<Edge>>,
    /// The condensation sets.
    pub condensation: Vec<Condensation>,
    /// What deterministic iteration starts from, in the coordinates of the plane.
    pub initial: Option<Shape>,
}

/// An iterated function system; see the [module](self) for what it guarantees.
#[derive(Clone, Debug, PartialEq)]
pub struct Ifs {
    definition: Definition,
    weights: Vec<f64>,
    condensation_weights: Vec<f64>,
    edge_weights: Vec<f64>,
}

impl Ifs {
    /// The system of these parts.
    ///
    /// Maps without weights get them by their determinants: |det| or a twentieth of the mean |det| of
    /// all maps, whatever is more, divided by the sum; equal ones if all determinants are 0. So a map
    /// that flattens the plane (the fern's stem) is still visited, and the weights add up to 1.
    ///
    /// # Errors
    ///
    /// All that is wrong with the parts, in the order maps, edges, condensation sets, initial set.
    pub fn new(definition: Definition) -> Result<Self, Vec<IfsError>> {
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

    /// The maps.
    #[must_use]
    pub fn maps(&self) -> &[Map] {
        &self.definition.maps
    }

    /// The weight of every map.
    #[must_use]
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Whether the weights of the maps are those that [`Ifs::new`] gives.
    #[must_use]
    pub fn has_default_weights(&self) -> bool {
        self.maps().iter().all(|map| map.weight.is_none())
    }

    /// Whether maps or edges have weights that were given.
    #[must_use]
    pub fn has_weights(&self) -> bool {
        let edges = self.definition.edges.iter().flatten();
        !self.has_default_weights() || { edges }.any(|edge| edge.weight.is_some())
    }

    /// The edges of the digraph with their weights, in the order of listing; `None` where any map may
    /// follow any other and itself, by its own weight.
    pub fn edges(&self) -> Option<impl Iterator<Item = (Edge, f64)>> {
        let edges = self.definition.edges.as_ref()?;
        Some(edges.iter().copied().zip(self.edge_weights.iter().copied()))
    }

    /// Whether the system has a digraph.
    #[must_use]
    pub fn is_recurrent(&self) -> bool {
        self.definition.edges.is_some()
    }

    /// The maps that may follow each map; `None` where all may.
    pub(crate) fn successors(&self) -> Option<Vec<Vec<usize>>> {
        let mut successors = vec![Vec::new(); self.maps().len()];
        for edge in self.definition.edges.as_ref()? {
            successors[edge.from].push(edge.to);
        }
        Some(successors)
    }

    /// The condensation sets.
    #[must_use]
    pub fn condensation(&self) -> &[Condensation] {
        &self.definition.condensation
    }

    /// The weight of every condensation set, on the scale of [`Ifs::weights`].
    #[must_use]
    pub fn condensation_weights(&self) -> &[f64] {
        &self.condensation_weights
    }

    /// What deterministic iteration starts from.
    #[must_use]
    pub fn initial(&self) -> Option<&Shape> {
        self.definition.initial.as_ref()
    }

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

    /// About how many instances its graph has: of every map inside every map, and of all outlines there.
    pub(crate) fn size(&self) -> usize {
        let sets = self.condensation().iter().map(|set| &set.shape);
        let outlines = sets.chain(self.initial()).map(Shape::count).sum::<usize>();
        let maps = self.maps().len();
        maps.saturating_mul(maps).saturating_mul(1 + outlines)
    }

    /// What maps do that are applied one after the other, the first of the list first.
    ///
    /// # Panics
    ///
    /// If a number is not that of a map.
    #[must_use]
    pub fn composition(&self, word: &[usize]) -> DAffine2 {
        let maps = word.iter().map(|&map| self.maps()[map].affine);
        maps.fold(DAffine2::IDENTITY, |before, map| map * before)
    }

    /// The fixed point of every map, `None` where there is no single one.
    ///
    /// It lies on the attractor; in a recurrent system only if the map may follow itself.
    #[must_use]
    pub fn fixed_points(&self) -> Vec<Option<DVec2>> {
        self.maps().iter().map(Map::fixed_point).collect()
    }
}

/// As given, or the default of [`Ifs::new`].
fn map_weights(maps: &[Map]) -> Vec<f64> {
    let given: Option<Vec<f64>> = maps.iter().map(|map| map.weight).collect();
    given.unwrap_or_else(|| {
        let areas = maps
            .iter()
            .map(|map| map.affine.matrix2.determinant().abs());
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

/// Weights divided by their sum; `None` if that is not possible.
fn shares(weights: &[f64]) -> Option<Vec<f64>> {
    // The sum alone may be infinite.
    let largest = weights.iter().copied().fold(0.0, f64::max);
    let sum: f64 = weights.iter().map(|weight| weight / largest).sum();
    let shares = weights.iter().map(|weight| weight / largest / sum);
    let shares: Vec<f64> = shares.collect();
    shares
        .iter()
        .all(|share| share.is_finite())
        .then_some(shares)
}
