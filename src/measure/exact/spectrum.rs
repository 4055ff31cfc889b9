//! The generalised dimensions D_q of a measure, where they are known exactly.

use crate::ifs::{AffineMap, Ifs};
use crate::measure::copies::WeightedCopies;
use crate::measure::perron::{Entry, beside_one, crossing, perron};

use super::{Dimensions, GraphDirectedSystem, Overlap, dimensions};

/// Generalised dimensions D_q of a measure (Hentschel & Procaccia 1983), for all real orders q.
#[derive(Clone, Debug, PartialEq)]
pub enum Spectrum {
    /// All D_q are equal: a ball of radius r about a point of the measure has a mass of about r^D.
    Constant {
        /// The dimension D.
        value: f64,
        /// Equal expression in the syntax of rule files, where one was found.
        closed_form: Option<String>,
    },
    /// Dimensions of a measure whose copies have given shares, under the open set condition.
    Cascade(SelfSimilarMeasure),
}

/// Copies of sets by their shares of the mass and their ratios.
#[derive(Clone, Debug, PartialEq)]
pub struct SelfSimilarMeasure {
    size: usize,
    edges: Vec<Edge>,
}

/// A copy: the set that holds it, the set that it is a copy of, and logarithms.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Edge {
    from: usize,
    to: usize,
    /// Logarithm of its share of the mass.
    share: f64,
    /// Logarithm of its ratio.
    ratio: f64,
}

/// Distance from 1 below which an order counts as 1.
const NEAR_ONE: f64 = 1e-7;

/// Bound of exponents: larger exponentials do not change on which side of 1 a radius lies.
const MAX_EXPONENT: f64 = 300.0;

impl Spectrum {
    /// Returns the dimensions of a set's natural measure: all D_q are its dimension, where the measure of
    /// balls is known to be regular.
    #[must_use]
    pub fn natural(dimensions: &Dimensions) -> Option<Self> {
        let hausdorff = &dimensions.hausdorff;
        let value = hausdorff.value.filter(|_| dimensions.regular)?;
        Some(Self::Constant {
            value,
            closed_form: hausdorff.closed_form.clone(),
        })
    }

    /// Computes the dimensions of the measure that the weights of a system define, where its maps are
    /// similarities that satisfy the open set condition (Cawley & Mauldin 1992; for graphs: Edgar & Mauldin
    /// 1992; for negative orders: Riedi 1995). Maps that are listed twice count as one with the sum of their
    /// weights.
    ///
    /// Returns `None` where this is not decided, or where [the measure is not
    /// unique](crate::ifs::Walk::stationary).
    #[must_use]
    pub fn of_weights<M: AffineMap>(ifs: &Ifs<M>) -> Option<Self> {
        let WeightedCopies { copies, shares, .. } = WeightedCopies::of_weights(ifs)?;
        let maps = copies.copies.iter();
        let system = GraphDirectedSystem::of_maps(maps.map(|copy| (copy.from, copy.to, copy.map)))?;
        let Dimensions { hausdorff, .. } = dimensions(&system)?;
        let is_open = matches!(hausdorff.overlap, Overlap::None | Overlap::Touching);
        if !is_open || hausdorff.value.is_none() {
            return None;
        }
        let edges = system.ratios().zip(shares);
        let edges = edges.map(|((from, to, ratio), share)| Edge {
            from,
            to,
            share: libm::log(share),
            ratio: libm::log(ratio),
        });
        Some(Self::Cascade(SelfSimilarMeasure {
            size: copies.size,
            edges: edges.collect(),
        }))
    }

    /// Returns the dimension of an order.
    #[must_use]
    pub fn at(&self, order: f64) -> f64 {
        match self {
            Self::Constant { value, .. } => *value,
            Self::Cascade(weighted) => weighted.at(order),
        }
    }
}

impl SelfSimilarMeasure {
    fn at(&self, order: f64) -> f64 {
        if (order - 1.0).abs() < NEAR_ONE {
            return self.information();
        }
        // A single copy in each set: the mass of a point.
        if self.edges.len() == self.size {
            return 0.0;
        }
        // τ = (q − 1) D_q solves Σ p^q r^−τ = 1, or spectral radius 1 of the matrix of these sums, which
        // increases with τ.
        let radius = |tau: f64| self.radius(|edge| order * edge.share - tau * edge.ratio);
        let (mut low, mut high) = (-1.0, 1.0);
        while radius(low) > 1.0 {
            low *= 2.0;
        }
        while radius(high) <= 1.0 {
            high *= 2.0;
        }
        crossing(low, high, radius) / (order - 1.0) + 0.0
    }

    /// Returns the spectral radius of the matrix of exponentials between sets.
    fn radius(&self, exponent: impl Fn(&Edge) -> f64) -> f64 {
        let entries: Vec<Entry> = self
            .edges
            .iter()
            .map(|edge| {
                let exponent = exponent(edge).clamp(-MAX_EXPONENT, MAX_EXPONENT);
                (edge.from, edge.to, libm::exp(exponent))
            })
            .collect();
        if self.size == 1 {
            return entries.iter().map(|(.., value)| value).sum();
        }
        perron(self.size, &entries, beside_one).radius
    }

    /// Returns D_1: the entropy of the shares over the mean logarithm of the ratios (Young 1982).
    fn information(&self) -> f64 {
        let shares = self.edges.iter();
        // The stationary frequency of the sets along the address of a point: an eigenvector of the transposed
        // matrix.
        let entries: Vec<Entry> = shares
            .map(|edge| (edge.to, edge.from, libm::exp(edge.share)))
            .collect();
        let often = perron(self.size, &entries, |_| false).vector;
        let mean = |of: fn(&Edge) -> f64| -> f64 {
            let edges = self.edges.iter();
            edges
                .map(|edge| often[edge.from] * libm::exp(edge.share) * of(edge))
                .sum()
        };
        mean(|edge| edge.share) / mean(|edge| edge.ratio)
    }
}
