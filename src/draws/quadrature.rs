//! Quadrature over the draws of variables.

use crate::saturating::real;

use super::{Distribution, Variable};

/// Maximum number of nodes.
const MAX_NODES: usize = 40_000;

/// Values of all slots, with a weight.
pub(crate) type Node = (Vec<f64>, f64);

/// Returns a product of quadratures over the variables that are needed; others have a representative value. `before` are
/// the slots before the variables. Returns `None` if there are too many nodes.
pub(crate) fn nodes(variables: &[Variable], needed: &[bool], before: &[f64]) -> Option<Vec<Node>> {
    let mut nodes = vec![(before.to_vec(), 1.0)];
    for (variable, &is_needed) in variables.iter().zip(needed) {
        let mut next = Vec::new();
        for (slots, weight) in nodes {
            let values = match is_needed {
                true => nodes_of(variable.distribution(), &slots),
                false => vec![(variable.typical(&slots), 1.0)],
            };
            for (value, share) in values {
                let mut slots = slots.clone();
                slots.push(value);
                next.push((slots, weight * share));
            }
            if next.len() > MAX_NODES {
                return None;
            }
        }
        nodes = next;
    }
    Some(nodes)
}

/// Returns the nodes and weights of a quadrature over a distribution.
fn nodes_of(distribution: &Distribution, slots: &[f64]) -> Vec<(f64, f64)> {
    match distribution {
        Distribution::Uniform(low, high) => {
            let (low, high) = (low.eval(slots), high.eval(slots));
            let place = |(at, weight)| (low + (high - low) * at, weight);
            legendre().into_iter().map(place).collect()
        }
        Distribution::Normal(mean, deviation) => {
            let (mean, deviation) = (mean.eval(slots), deviation.eval(slots));
            // The trapezoidal rule is exponentially accurate for the normal density.
            const STEP: f64 = 0.25;
            let height = STEP / std::f64::consts::TAU.sqrt();
            let node = |k: i32| {
                let at = f64::from(k) * STEP;
                (mean + deviation * at, height * libm::exp(-at * at / 2.0))
            };
            (-33..=33).map(node).collect()
        }
        Distribution::Choice(values) => {
            let weight = 1.0 / real(values.len());
            values
                .iter()
                .map(|value| (value.eval(slots), weight))
                .collect()
        }
    }
}

/// Returns the nodes and weights of Gauss–Legendre quadrature for the interval from 0 to 1.
fn legendre() -> Vec<(f64, f64)> {
    const COUNT: u32 = 20;
    let count = f64::from(COUNT);
    let node = |number: u32| {
        let mut x = libm::cos(std::f64::consts::PI * (f64::from(number) + 0.75) / (count + 0.5));
        let mut slope = 1.0;
        for _ in 0..8 {
            let (mut value, mut before) = (x, 1.0);
            for degree in 2..=COUNT {
                let n = f64::from(degree);
                (value, before) = (
                    ((2.0 * n - 1.0) * x * value - (n - 1.0) * before) / n,
                    value,
                );
            }
            slope = count * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        (f64::midpoint(1.0, x), 1.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..COUNT).map(node).collect()
}

#[cfg(test)]
mod tests {
    use super::{Distribution, legendre, nodes_of};
    use crate::expression::Program;

    #[test]
    fn moments_are_integrated() {
        let third: f64 = legendre().iter().map(|(at, weight)| weight * at * at).sum();
        assert!((third - 1.0 / 3.0).abs() < 1e-14, "{third}");
        let [mean, deviation] = [3.0, 0.5].map(Program::constant);
        let normal = nodes_of(&Distribution::Normal(mean, deviation), &[]);
        let square: f64 = normal.iter().map(|(at, weight)| weight * at * at).sum();
        assert!((square - 9.25).abs() < 1e-12, "{square}");
    }
}
