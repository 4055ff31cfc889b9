//! Exact dimensions, by what the pieces of a set do to each other.
//!
//! Do the pieces of a self-similar set overlap, what is then its dimension, and what is its
//! boundary's? One graph answers all three: that of the maps between neighbouring pieces.
//!
//! - Copies that are apart or only touch fulfil the *open set condition*, and the set has its
//!   similarity dimension (Moran 1946, Hutchinson 1981; Mauldin & Williams 1988 for graphs). Pieces
//!   that coincide break it, and nothing else does where neighbour maps are finitely many (Bandt &
//!   Graf 1992, Schief 1994, Zerner 1996).
//!   In a system of several sets two of them may be equal, or parts of each other; that does no
//!   harm: if no piece is there twice, finitely many neighbour maps mean that a ball of a piece's
//!   size meets a bounded number of pieces, so the set has positive measure in its similarity
//!   dimension, and overlaps have none.
//! - Pieces that coincide are counted once (Ngai & Wang 2001).
//! - The boundary of a set with inside is where neighbours touch (Strichartz & Wang 1999, Duvall &
//!   Keesling 1999, Scheicher & Thuswaldner 2002).
//!
//! Maps are evaluated in double precision. Equal ones agree to some 10⁻¹³ and different ones are far
//! apart; where some are neither, nothing is decided. All searches end after a fixed amount of work.

mod affinity;
mod balls;
mod closed_form;
mod distinct;
mod grown;
mod hull;
mod neighbours;
mod open_set;
mod part;
mod random;
mod sizes;
mod spectral;
mod system;
mod types;

use std::fmt;

pub use affinity::Affinity;
pub use grown::{Grown, dimensions_of_graph};
pub use system::System;

use affinity::affinity;
use part::{PartDimension, part_dimension};

/// How the copies lie that a set is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overlap {
    /// No two copies have a point in common.
    None,
    /// The open set condition holds, and copies touch, or come too near to tell.
    Touching,
    /// Pieces coincide.
    Exact,
    /// Not decided.
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

/// A similarity dimension.
#[derive(Clone, Debug, PartialEq)]
pub struct Similar {
    /// The dimension, exact to some 12 digits.
    pub value: f64,
    /// The equation that gives it.
    pub equation: Equation,
    /// An expression that is equal, as rule files write it, where one was found.
    pub closed_form: Option<String>,
}

/// The dimension of the set itself, or what bounds it.
#[derive(Clone, Debug, PartialEq)]
pub struct Hausdorff {
    /// The Hausdorff dimension, which is the box dimension too; `None` where it is not decided.
    pub value: Option<f64>,
    /// An expression that is equal, as rule files write it, where one was found.
    pub closed_form: Option<String>,
    /// The dimension is not larger; equal to the value where there is one.
    pub upper_bound: Option<f64>,
    /// How copies lie in the part of the system that has the largest dimension.
    pub overlap: Overlap,
    /// How it was found, or what was tried.
    pub method: String,
}

/// The dimension of the boundary of a set with inside.
#[derive(Clone, Debug, PartialEq)]
pub struct Boundary {
    /// The dimension; `None` where it is not decided.
    pub value: Option<f64>,
    /// An expression that is equal, where one was found.
    pub closed_form: Option<String>,
    /// How it was found, or why it was not.
    pub method: String,
}

/// What is known of the dimensions of a limit set.
#[derive(Clone, Debug, PartialEq)]
pub struct Dimensions {
    /// The similarity dimension; `None` where maps are not similarities.
    pub similarity: Option<Similar>,
    /// The affinity dimension, where maps are not similarities.
    pub affinity: Option<Affinity>,
    /// The dimension of the set itself; that of a single copy, where several stand together.
    pub hausdorff: Hausdorff,
    /// The dimension of its boundary, where it is known to have inside.
    pub boundary: Option<Boundary>,
}

/// The dimensions of the sets of a system: the largest of theirs.
///
/// `None` if a map does not shrink, or if nothing is a copy again and again.
#[must_use]
pub fn dimensions(system: &System) -> Option<Dimensions> {
    let parts = system.parts();
    if parts.is_empty() {
        return None;
    }
    if !system.is_similar() {
        return of_affine(&parts, system.space);
    }
    if system.ratios().any(|(_, _, ratio)| ratio >= 1.0) {
        return None;
    }
    let parts: Vec<PartDimension> = parts.iter().map(part_dimension).collect();
    let similar = parts.iter().map(|part| &part.similarity);
    let similarity = similar.max_by(|a, b| a.value.total_cmp(&b.value))?;
    let deciding = parts.iter().max_by(|a, b| rank(a).total_cmp(&rank(b)))?;
    Some(Dimensions {
        similarity: Some(similarity.clone()),
        affinity: None,
        hausdorff: deciding.hausdorff.clone(),
        boundary: deciding.boundary.clone(),
    })
}

/// The part that has the largest rank has the largest dimension, or keeps it from being known.
fn rank(part: &PartDimension) -> f64 {
    part.hausdorff.upper_bound.unwrap_or(f64::INFINITY)
}

/// What is known where maps are not similarities.
fn of_affine(parts: &[System], space: usize) -> Option<Dimensions> {
    let all: Option<Vec<Affinity>> = parts.iter().map(affinity).collect();
    let all = all?.into_iter();
    let affinity = all.max_by(|a, b| a.upper_bound.total_cmp(&b.upper_bound))?;
    #[expect(clippy::cast_precision_loss, reason = "2 or 3")]
    let space = space as f64;
    Some(Dimensions {
        similarity: None,
        affinity: Some(affinity),
        hausdorff: Hausdorff {
            value: None,
            closed_form: None,
            upper_bound: Some(affinity.upper_bound.min(space)),
            overlap: Overlap::Unknown,
            method: format!(
                "maps are not similarities: bounded by the affinity dimension, from products of {} maps (Falconer 1988)",
                affinity.length
            ),
        },
        boundary: None,
    })
}
