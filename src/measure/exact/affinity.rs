//! The affinity dimension (Falconer 1988) of maps that are not similarities.
//!
//! The image of a ball under a map is an ellipsoid; the singular value function φ^s is the cost of covering
//! it by balls. The s at which the sum of φ^s over all products of n maps is 1 is never below the box and
//! Hausdorff dimensions, for any n, since φ^s(AB) ≤ φ^s(A) φ^s(B).

use glam::{DMat3, DVec3};

use super::Effort;
use super::spectral::dense_radius;
use super::system::GraphDirectedSystem;
use crate::geometry::Linear;
use crate::saturating::real;

/// Affinity dimension, which bounds the dimension of the set from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affinity {
    /// Upper bound from products of the length below, or shorter by one.
    pub upper_bound: f64,
    /// Estimate of the limit of the bounds: the s at which sums over products of two successive lengths are
    /// equal. Sharper, but not a bound.
    pub estimate: f64,
    /// Length of the longest products.
    pub length: usize,
}

/// Maximum number of products of one length.
const MAX_PRODUCTS: usize = 10_000;

/// Maximum number of products of entries in a product of two matrices, which have a row for each set.
const MAX_FACTORS: usize = 1 << 20;

/// Maximum length of products.
const MAX_LENGTH: usize = 40;

/// Root above which maps are taken not to contract.
const LARGEST: f64 = 16.0;

/// A product of maps along a path, by the logarithms of its singular values in falling order.
struct Product {
    from: usize,
    to: usize,
    logarithms: [f64; 3],
}

/// Computes the affinity dimension of a strongly connected part. Returns `None` unless all products of some
/// length contract, up to the length that is reached; and if there are more sets than the effort allows, about a hundred.
pub(super) fn affinity(part: &GraphDirectedSystem, effort: Effort) -> Option<Affinity> {
    if part.size.saturating_pow(3) > effort.of(MAX_FACTORS) {
        return None;
    }
    let mut paths: Vec<(usize, usize, DMat3)> = (0..part.size)
        .map(|set| (set, set, DMat3::IDENTITY))
        .collect();
    let mut sums: [Vec<Product>; 2] = [Vec::new(), Vec::new()];
    let mut contracts = false;
    let mut length = 0;
    let mut copies = vec![Vec::new(); part.size];
    for copy in &part.copies {
        copies[copy.from].push((copy.to, copy.map.matrix3));
    }
    while length < MAX_LENGTH {
        let longer = paths.iter().map(|(_, to, _)| copies[*to].len());
        if longer.sum::<usize>() > effort.of(MAX_PRODUCTS) {
            break;
        }
        let mut next = Vec::new();
        for (from, to, matrix) in &paths {
            let copies = copies[*to].iter();
            next.extend(copies.map(|(to, last)| (*from, *to, *matrix * *last)));
        }
        let products = next.iter().map(|&(from, to, matrix)| Product {
            from,
            to,
            logarithms: singular_values(matrix, part.space).map(libm::log),
        });
        let [_, last] = sums;
        sums = [last, products.collect()];
        contracts |= sums[1].iter().all(|product| product.logarithms[0] < 0.0);
        paths = next;
        length += 1;
    }
    if !contracts {
        return None;
    }
    let [shorter, longer] = &sums;
    let bounds = sums.iter().filter(|products| !products.is_empty());
    let bounds = bounds.filter_map(|products| root(|s| libm::log(sum(products, part, s))));
    let upper_bound = bounds.min_by(f64::total_cmp)?;
    let between = |s| libm::log(sum(longer, part, s)) - libm::log(sum(shorter, part, s));
    let estimate = if shorter.is_empty() {
        None
    } else {
        root(between)
    };
    Some(Affinity {
        upper_bound,
        estimate: estimate.unwrap_or(upper_bound).min(upper_bound),
        length,
    })
}

/// Finds the root of a falling function by false position with the Illinois modification (Dowell & Jarratt
/// 1971): logarithms of sums of powers are nearly straight. Returns `None` if the root is above [`LARGEST`].
fn root(excess: impl Fn(f64) -> f64) -> Option<f64> {
    let (mut low, mut high) = (0.0, LARGEST);
    let (mut above, mut below) = (excess(low), excess(high));
    if above <= 0.0 {
        return Some(0.0);
    }
    if below > 0.0 {
        return None;
    }
    while high - low > 1e-14 * LARGEST {
        let share = above / (above - below);
        let between = low + (high - low) * share;
        let inside = share.is_finite() && between > low && between < high;
        let place = if inside {
            between
        } else {
            f64::midpoint(low, high)
        };
        if place <= low || place >= high {
            break;
        }
        let value = excess(place);
        // The value at the retained end is halved, which moves the end in the next step.
        if value > 0.0 {
            (low, above, below) = (place, value, below / 2.0);
        } else {
            (high, below, above) = (place, value, above / 2.0);
        }
        if value.abs() < 1e-14 {
            return Some(place);
        }
    }
    Some(high)
}

/// Returns the spectral radius of the matrix of sums of φ^s between sets.
fn sum(products: &[Product], part: &GraphDirectedSystem, s: f64) -> f64 {
    let space = part.space;
    let mut matrix = vec![0.0; part.size * part.size];
    for product in products {
        matrix[product.from * part.size + product.to] += cost(&product.logarithms[..space], s);
    }
    if part.size == 1 {
        return matrix[0];
    }
    dense_radius(matrix, part.size)
}

/// Returns φ^s from logarithms of singular values: the product of the largest ones, the last with the
/// fractional part of s as its exponent; beyond the dimension d of the space, the determinant to the power
/// s/d.
fn cost(logarithms: &[f64], s: f64) -> f64 {
    let space = real(logarithms.len());
    if s >= space {
        return libm::exp(logarithms.iter().sum::<f64>() * s / space);
    }
    let mut left = s;
    let mut sum = 0.0;
    for logarithm in logarithms {
        if left <= 0.0 {
            break;
        }
        sum += left.min(1.0) * logarithm;
        left -= 1.0;
    }
    libm::exp(sum)
}

/// Returns singular values in falling order. In the plane the third column is orthogonal to the others, and is
/// left out.
fn singular_values(matrix: DMat3, space: usize) -> [f64; 3] {
    let DMat3 { x_axis, y_axis, .. } = matrix;
    if space < 3 {
        DMat3::from_cols(x_axis, y_axis, DVec3::ZERO).singular_values()
    } else {
        matrix.singular_values()
    }
}
