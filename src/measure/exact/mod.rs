//! Exact dimensions, from the neighbour maps of a self-similar set's pieces.
//!
//! The graph of the maps between neighbouring pieces determines whether the pieces of a set overlap, the
//! dimension of the set, and the dimension of its boundary.
//!
//! - Copies that are disjoint or only touch satisfy the *open set condition*, and the set has its similarity
//!   dimension (Moran 1946, Hutchinson 1981; Mauldin & Williams 1988 for graphs). Where there are finitely
//!   many neighbour maps, the condition fails only if pieces coincide (Bandt & Graf 1992, Schief 1994, Zerner
//!   1996). In a system of several sets two of them may be equal, or parts of each other, without effect: if
//!   no piece occurs twice, finitely many neighbour maps imply that a ball of a piece's size meets a bounded
//!   number of pieces. The set therefore has positive measure in its similarity dimension, and overlaps have
//!   measure zero.
//! - Pieces that coincide are counted once (Ngai & Wang 2001).
//! - The boundary of a set with interior is where neighbours touch (Strichartz & Wang 1999, Duvall & Keesling
//!   1999, Scheicher & Thuswaldner 2002). The points that two copies of another set have in common are found like it.
//! - Carpets of maps that scale the axes have a box and a Hausdorff dimension (Lalley & Gatzouras 1992).
//!
//! Maps are evaluated in double precision. Equal maps agree to about 10⁻¹³ and different ones are far apart;
//! where some are neither, nothing is decided. All searches end after a fixed amount of work.

mod affinity;
mod balls;
mod carpet;
mod closed_form;
mod distinct;
mod effort;
mod grown;
mod hull;
mod neighbours;
mod open_set;
mod part;
mod pieces;
mod random;
mod sizes;
mod spectral;
mod spectrum;
mod system;
mod types;

use std::fmt;

pub use affinity::Affinity;
pub use effort::Effort;
pub use grown::{GraphDimensions, dimensions_of_graph, dimensions_of_graph_within};
pub use spectrum::{SelfSimilarMeasure, Spectrum};
pub use system::GraphDirectedSystem;

pub(super) use pieces::distinct;

use crate::saturating::real;

use affinity::affinity;
use carpet::carpet;
use closed_form::{plain, settled};
use hull::Flat;
use neighbours::{End, Neighbours};
use part::{PartDimension, part_dimension};
use sizes::Generations;
use types::Types;

/// Overlap of the copies that a set is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overlap {
    /// No two copies have a point in common.
    None,
    /// The open set condition holds, and copies touch, or come too near to be distinguished.
    Touching,
    /// Pieces coincide.
    Exact,
    /// The overlap is not decided.
    Unknown,
}

impl fmt::Display for Overlap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::None => "none",
            Self::Touching => "touching",
            Self::Exact => "exact-overlap",
            Self::Unknown => "unknown",
        })
    }
}

/// The equation that gives a similarity dimension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Equation {
    /// Σ ratio^D = 1 (Moran 1946).
    Moran,
    /// The matrix of Σ ratio^D between objects has spectral radius 1 (Mauldin & Williams 1988).
    Spectral,
    /// The expectation of Σ ratio^D is 1 (Falconer 1986).
    Expected,
}

impl fmt::Display for Equation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Moran => "moran",
            Self::Spectral => "spectral",
            Self::Expected => "expected",
        })
    }
}

/// Similarity dimension of a set.
#[derive(Clone, Debug, PartialEq)]
pub struct Similar {
    /// The dimension, exact to about 12 digits; as exact as a quadrature with 20 nodes where ratios are drawn.
    pub value: f64,
    /// Equation that defines the dimension.
    pub equation: Equation,
    /// Equal expression in the syntax of rule files, where one was found.
    pub closed_form: Option<String>,
}

/// Hausdorff dimension of a set, or an upper bound of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Hausdorff {
    /// The Hausdorff dimension, which is equal to the box dimension unless [`Dimensions::box_dimension`] is another; `None`
    /// where it is not decided.
    pub value: Option<f64>,
    /// Equal expression in the syntax of rule files, where one was found.
    pub closed_form: Option<String>,
    /// Upper bound of the dimension; equal to the value where there is one.
    pub upper_bound: Option<f64>,
    /// Overlap of the copies in the part of the system that has the largest dimension.
    pub overlap: Overlap,
    /// Method by which the dimension was found, or attempts that failed.
    pub method: String,
}

impl Hausdorff {
    /// Returns a dimension that is not decided.
    fn unknown(upper_bound: f64, method: String) -> Self {
        Self {
            value: None,
            closed_form: None,
            upper_bound: Some(upper_bound),
            overlap: Overlap::Unknown,
            method,
        }
    }
}

/// Dimension of a set other than the limit set, or another dimension of it.
#[derive(Clone, Debug, PartialEq)]
pub struct OtherDimension {
    /// The dimension; `None` where it is not decided.
    pub value: Option<f64>,
    /// Equal expression in the syntax of rule files, where one was found.
    pub closed_form: Option<String>,
    /// Method by which the dimension was found, or reason why it was not.
    pub method: String,
}

/// Dimensions of a limit set, as far as they are known.
#[derive(Clone, Debug, PartialEq)]
pub struct Dimensions {
    /// The similarity dimension; `None` where maps are not similarities.
    pub similarity: Option<Similar>,
    /// The affinity dimension, where maps are not similarities.
    pub affinity: Option<Affinity>,
    /// The dimension of the set itself; that of a single copy, where there are several.
    pub hausdorff: Hausdorff,
    /// The dimension of the boundary, where the set is known to have interior.
    pub boundary: Option<OtherDimension>,
    /// The dimension of the points that two copies have in common, where neighbour maps find that copies of a set without
    /// interior touch.
    pub contact: Option<OtherDimension>,
    /// The box dimension of a self-affine carpet.
    pub box_dimension: Option<OtherDimension>,
    /// Whether the natural measure is known to be regular: a ball of radius r about a point of the set has a
    /// mass of about r^D, where D is the dimension.
    pub regular: bool,
}

/// Computes the dimensions of the sets of a system: the largest over all sets.
///
/// Returns `None` if a map does not contract, or if no set holds copies of itself.
#[must_use]
pub fn dimensions(system: &GraphDirectedSystem) -> Option<Dimensions> {
    dimensions_within(system, Effort::Full)
}

/// Computes the dimensions of the sets of a system, as [`dimensions`] does, within an effort.
#[must_use]
pub fn dimensions_within(system: &GraphDirectedSystem, effort: Effort) -> Option<Dimensions> {
    let system = &*system.in_own_units();
    let (component, components) = system.components();
    let parts = components.iter().filter(|part| !part.copies.is_empty());
    let parts: Vec<&GraphDirectedSystem> = parts.collect();
    if parts.is_empty() {
        return None;
    }
    if !system.is_similar() {
        return of_affine(&parts, effort);
    }
    if !system.shrinks() {
        return None;
    }
    let parts = components.iter();
    let of_part = |part: &GraphDirectedSystem| {
        (!part.copies.is_empty()).then(|| part_dimension(part, effort))
    };
    let parts: Vec<Option<PartDimension>> = parts.map(of_part).collect();
    let regular = is_regular(system, &component, &parts);
    let parts: Vec<PartDimension> = parts.into_iter().flatten().collect();
    let similar = parts.iter().map(|part| &part.similarity);
    let similarity = similar.max_by(|a, b| a.value.total_cmp(&b.value))?;
    let deciding = parts.iter().max_by(|a, b| rank(a).total_cmp(&rank(b)))?;
    Some(Dimensions {
        similarity: Some(similarity.clone()),
        affinity: None,
        hausdorff: deciding.hausdorff.clone(),
        boundary: deciding.boundary.clone(),
        contact: deciding.contact.clone(),
        box_dimension: None,
        regular,
    })
}

/// Counts the distinct pieces of a set in generations 0, 1, … up to `last`: pieces that coincide count once (Ngai
/// & Wang 2001). A piece of the size ρ^k belongs to the generations up to k, where ρ is the largest number of
/// which all ratios are powers.
///
/// Returns `None` where pieces are not of finitely many types, where not all sets hold copies of each other, and
/// beyond the range of 64 bits.
#[must_use]
pub fn distinct_pieces(system: &GraphDirectedSystem, last: usize) -> Option<Vec<u64>> {
    let (_, components) = system.components();
    let is_one = components.len() == 1 && !system.copies.is_empty();
    let system = Some(system).filter(|system| is_one && system.shrinks())?;
    let generations = Generations::of(&Flat::of(system))?;
    let neighbours = Neighbours::of(&generations, Effort::Full);
    let neighbours = Some(neighbours).filter(|found| found.end == End::Complete)?;
    Types::of(&generations, &neighbours, Effort::Full)?.counts(last)
}

/// Returns `true` if the natural measure is known to be regular.
///
/// The measure of a set is regular if its pieces do not overlap, or are of finitely many types: a ball meets
/// a bounded number of distinct pieces of its size r, each of which has a mass of about r^D. Finitely many
/// copies of sets of this kind have a regular measure as well, wherever they lie. Sets of smaller dimensions
/// may be present, unless they hold copies of the former: these would be infinitely many. Pieces that
/// coincide are distinguished only [in sets that hold no others](distinct).
fn is_regular(
    system: &GraphDirectedSystem,
    component: &[usize],
    parts: &[Option<PartDimension>],
) -> bool {
    const SAME: f64 = 1e-9;
    let decided = || parts.iter().flatten().map(|part| part.hausdorff.value);
    let most = decided().flatten().fold(0.0, f64::max);
    if decided().any(|value| value.is_none()) {
        return false;
    }
    // Whether a component leads to one of the largest dimension; successors have lower numbers and come
    // first.
    let mut leads = vec![false; parts.len()];
    for (number, part) in parts.iter().enumerate() {
        let own_copies = system.copies.iter();
        let own_copies = own_copies.filter(|copy| component[copy.from] == number);
        let mut others: Vec<usize> = own_copies.map(|copy| component[copy.to]).collect();
        others.retain(|&other| other != number);
        let is_above = others.iter().any(|&other| leads[other]);
        let hausdorff = part.as_ref().map(|part| &part.hausdorff);
        let own = hausdorff.and_then(|hausdorff| hausdorff.value);
        let is_largest = own.is_some_and(|own| most - own <= SAME);
        let coincide = hausdorff.is_some_and(|hausdorff| hausdorff.overlap == Overlap::Exact);
        if coincide && !others.is_empty() {
            return false;
        }
        if is_above && own.is_some() && !is_largest {
            return false;
        }
        leads[number] = is_above || is_largest;
    }
    true
}

/// Returns the rank of a part: the part of the largest rank has the largest dimension, or prevents it from
/// being known.
fn rank(part: &PartDimension) -> f64 {
    part.hausdorff.upper_bound.unwrap_or(f64::INFINITY)
}

/// Returns the dimensions of a system whose maps are not similarities, as far as they are known.
fn of_affine(parts: &[&GraphDirectedSystem], effort: Effort) -> Option<Dimensions> {
    let carpet = match parts {
        [part] => carpet(part),
        _ => None,
    };
    let all: Option<Vec<Affinity>> = parts.iter().map(|part| affinity(part, effort)).collect();
    let all = all?;
    let bounds = all.iter().zip(parts).map(|(affinity, part)| {
        let hull = real(Flat::of(part).dimension);
        affinity.upper_bound.min(hull)
    });
    let bound = bounds.fold(0.0, f64::max);
    let affinity = { all.into_iter() }.max_by(|a, b| a.upper_bound.total_cmp(&b.upper_bound))?;
    let hausdorff = match &carpet {
        Some(carpet) => Hausdorff {
            value: Some(settled(carpet.hausdorff)),
            closed_form: plain(settled(carpet.hausdorff)),
            upper_bound: Some(settled(carpet.hausdorff)),
            overlap: match carpet.is_apart {
                true => Overlap::None,
                false => Overlap::Touching,
            },
            method: format!("self-affine {}", carpet.described()),
        },
        None => {
            let reason = if bound < affinity.upper_bound {
                "bounded by the affine hull".into()
            } else {
                format!(
                    "bounded by the affinity dimension, from products of {} maps (Falconer 1988)",
                    affinity.length
                )
            };
            Hausdorff::unknown(bound, format!("maps are not similarities: {reason}"))
        }
    };
    let box_dimension = carpet.map(|carpet| {
        let value = settled(carpet.box_dimension);
        OtherDimension {
            value: Some(value),
            closed_form: plain(value),
            method: carpet.described().into(),
        }
    });
    Some(Dimensions {
        similarity: None,
        affinity: Some(affinity),
        hausdorff,
        boundary: None,
        contact: None,
        box_dimension,
        regular: false,
    })
}
