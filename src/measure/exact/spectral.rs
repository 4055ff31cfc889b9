//! The growth of the number of paths of a graph: the spectral radius of its matrix.

use crate::digraph::parts;

/// Relative width at which an enclosure counts as a value, once it no longer narrows.
const NARROW: f64 = 1e-13;

/// Relative width at which an enclosure is narrowed no further.
const NARROWEST: f64 = 4e-16;

/// Maximum number of products of the matrix with a vector, and of the entries that all of them may touch.
const MAX_ROUNDS: usize = 200_000;
const MAX_WORK: usize = 200_000_000;

/// Computes the spectral radius of a matrix of non-negative integers: `targets[i]` lists j as often as the
/// entry (i, j) counts. Returns `None` if it is not found to 13 digits.
///
/// The radius is the largest of those of the strongly connected parts, each computed by power iteration on
/// the part plus the identity; quotients of successive vectors enclose it (Collatz 1942, Wielandt 1950).
pub(super) fn spectral_radius(targets: &[Vec<usize>]) -> Option<f64> {
    let edges = targets.iter().enumerate();
    let edges = edges.flat_map(|(from, to)| to.iter().map(move |&to| [from, to]));
    let (_, parts) = parts(targets.len(), &edges.collect::<Vec<_>>());
    let mut radius: f64 = 0.0;
    for (size, edges) in parts {
        let mut targets = vec![Vec::new(); size];
        for [from, to] in edges {
            targets[from].push(to);
        }
        radius = radius.max(radius_of_part(&targets)?);
    }
    Some(radius)
}

fn radius_of_part(edges: &[Vec<usize>]) -> Option<f64> {
    let count: usize = edges.iter().map(Vec::len).sum();
    // A single node or a simple cycle.
    if count <= edges.len() {
        return Some(if count == 0 { 0.0 } else { 1.0 });
    }
    let mut vector = vec![1.0; edges.len()];
    let mut narrowest = f64::INFINITY;
    let rounds = MAX_ROUNDS.min(MAX_WORK / (count + edges.len()));
    for _ in 0..rounds {
        let mut next = vector.clone();
        for (entry, targets) in next.iter_mut().zip(edges) {
            *entry += targets.iter().map(|&target| vector[target]).sum::<f64>();
        }
        let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
        for (next, entry) in next.iter().zip(&vector) {
            let quotient = next / entry;
            (low, high) = (low.min(quotient), high.max(quotient));
        }
        let width = (high - low) / high;
        if width <= NARROWEST || width <= NARROW && width >= narrowest {
            return Some(f64::midpoint(low, high) - 1.0);
        }
        narrowest = width;
        let largest = next.iter().copied().fold(0.0, f64::max);
        next.iter_mut().for_each(|entry| *entry /= largest);
        vector = next;
    }
    None
}

/// Computes the spectral radius of a small matrix without negative entries, row by row.
///
/// By repeated squaring: the k-th root of the largest entry of the k-th power converges to it.
pub(super) fn dense_radius(mut matrix: Vec<f64>, size: usize) -> f64 {
    let mut exponent = 1.0;
    let mut logarithm = 0.0;
    for _ in 0..60 {
        let largest = matrix.iter().copied().fold(0.0, f64::max);
        if largest == 0.0 {
            return 0.0;
        }
        logarithm += libm::log(largest) / exponent;
        matrix.iter_mut().for_each(|entry| *entry /= largest);
        if size == 1 {
            break;
        }
        let entry = |at: usize| -> f64 {
            let (row, column) = (at / size, at % size);
            let inner = (0..size).map(|k| matrix[row * size + k] * matrix[k * size + column]);
            inner.sum()
        };
        matrix = (0..size * size).map(entry).collect();
        exponent *= 2.0;
    }
    libm::exp(logarithm)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails where it unwraps nothing")]

    use super::{dense_radius, spectral_radius};

    #[test]
    fn fibonacci_and_cycles() {
        let golden = f64::midpoint(1.0, 5f64.sqrt());
        let radius = spectral_radius(&[vec![0, 1], vec![0]]).unwrap();
        assert!((radius - golden).abs() < 1e-13);
        // A bipartite graph, with two edges each way, and a node that leads to it.
        let radius = spectral_radius(&[vec![1, 1], vec![0, 0], vec![0, 1, 2]]).unwrap();
        assert!((radius - 2.0).abs() < 1e-13);
        assert_eq!(spectral_radius(&[vec![1], vec![2], vec![0]]), Some(1.0));
        assert_eq!(spectral_radius(&[vec![1], vec![]]), Some(0.0));
        assert_eq!(spectral_radius(&[]), Some(0.0));
        assert!((dense_radius(vec![1.0, 1.0, 1.0, 0.0], 2) - golden).abs() < 1e-13);
        assert!((dense_radius(vec![0.0, 3.0, 12.0, 0.0], 2) - 6.0).abs() < 1e-12);
        assert_eq!(dense_radius(vec![0.0, 1.0, 0.0, 0.0], 2), 0.0);
    }
}
