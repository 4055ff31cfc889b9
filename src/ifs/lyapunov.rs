//! Contraction on average: the Lyapunov exponent of the walk of random iteration.

use std::fmt;

use super::walk::{Choice, Walk};
use super::{AffineMap, Ifs, PointOf};
use crate::geometry::{Linear, Point as _};

/// Limit of the number of products that are formed.
const MAX_PRODUCTS: usize = 200_000;

/// Largest length of products.
const LONGEST: u32 = 64;

/// The Lyapunov exponent of a walk: the limit of E log ‖Aₙ … A₁‖ / n, where the Aₖ are the linear parts of the maps in
/// the order in which the walk applies them (Furstenberg & Kesten 1960).
///
/// If it is negative, the points of the walk approach one probability measure from any start, though products of some
/// maps grow (Barnsley & Elton 1988; Diaconis & Freedman 1999). The measure need not be bounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponent {
    /// Upper bound of the exponent, in natural logarithms; −∞ where products become 0, or points are drawn anew from
    /// condensation sets.
    pub upper: f64,
    /// Whether the bound is the exponent itself: all maps are similarities.
    pub is_exact: bool,
    /// Length of the products whose mean logarithm is the bound.
    pub length: u32,
}

impl Exponent {
    /// Returns whether the exponent is negative, beyond rounding errors: whether the walk contracts on average.
    #[must_use]
    pub fn is_negative(&self) -> bool {
        self.upper < -1e-9
    }
}

impl fmt::Display for Exponent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let is = if self.is_exact { "is" } else { "is at most" };
        match self.upper == f64::NEG_INFINITY {
            true => write!(f, "its Lyapunov exponent is minus infinity"),
            false => write!(f, "its Lyapunov exponent {is} {:.6}", self.upper),
        }
    }
}

impl<M: AffineMap> Ifs<M> {
    /// Returns the Lyapunov exponent of the walk, or an upper bound of it from at most 200,000 products; `None` if the
    /// walk has several parts that it cannot leave.
    ///
    /// The mean logarithms of norms of products are subadditive: divided by the length of the products, each bounds the
    /// exponent. Lengths are doubled while the bound is positive, or the maps are no similarities.
    #[must_use]
    pub fn lyapunov_exponent(&self) -> Option<Exponent> {
        const ROUNDING: f64 = 1e-12;
        let linear: Vec<M::Linear> = self.maps().iter().map(|map| map.affine.linear()).collect();
        let is_similar = |map: &M::Linear| {
            let values = map.singular_values();
            values[0] - values[PointOf::<M>::DIMENSION - 1] <= ROUNDING * values[0]
        };
        let is_exact = linear.iter().all(is_similar);
        let mean = Mean {
            linear: M::in_best_coordinates(&linear),
            walk: self.walk(),
        };
        let weights = mean.walk.stationary()?;
        let mut best = Exponent {
            upper: f64::INFINITY,
            is_exact,
            length: 0,
        };
        let branches = mean.walk.states().iter().map(Vec::len).max().unwrap_or(1);
        let mut length = 1;
        let mut products = branches.saturating_mul(weights.len());
        while length <= LONGEST && products <= MAX_PRODUCTS {
            let states = weights
                .iter()
                .enumerate()
                .filter(|(_, weight)| **weight > 0.0);
            let sums = states
                .map(|(state, weight)| weight * mean.logarithm(state, M::Linear::IDENTITY, length));
            let upper = sums.sum::<f64>() / f64::from(length);
            if upper < best.upper {
                best = Exponent {
                    upper,
                    length,
                    ..best
                };
            }
            if is_exact || best.upper == f64::NEG_INFINITY {
                break;
            }
            length += 1;
            products = products.saturating_mul(branches);
        }
        (best.length > 0).then_some(best)
    }
}

struct Mean<L> {
    linear: Vec<L>,
    walk: Walk,
}

impl<L: Linear> Mean<L> {
    /// Returns the mean logarithm of the norms of products that begin with a product, and have some more maps that the
    /// walk applies after a state.
    fn logarithm(&self, state: usize, product: L, more: u32) -> f64 {
        if more == 0 {
            return libm::log(product.stretch());
        }
        let terms = self.walk.states()[state].iter().map(|step| {
            let Choice::Map(map) = step.choice else {
                return f64::NEG_INFINITY;
            };
            step.probability * self.logarithm(step.to, self.linear[map] * product, more - 1)
        });
        terms.sum()
    }
}
