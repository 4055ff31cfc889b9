//! Minimisation of a function of several variables without derivatives: CMA-ES.

use std::sync::atomic::AtomicBool;

use crate::parallel::is_cancelled;
use crate::random::Pcg;

/// Covariance matrix adaptation (Hansen, "The CMA evolution strategy: a tutorial", 2016), with the weights and rates
/// of its default settings.
pub(super) struct Cma {
    size: usize,
    mean: Vec<f64>,
    step: f64,
    /// The covariance, row by row.
    covariance: Vec<f64>,
    /// Its eigenvectors as columns, row by row, and the roots of its eigenvalues.
    basis: Vec<f64>,
    axes: Vec<f64>,
    path: Vec<f64>,
    step_path: Vec<f64>,
    weights: Vec<f64>,
    offspring: usize,
    generation: usize,
    solved: usize,
    random: Pcg,
}

/// Limit of the work of a search: a number of evaluations, and flags that end it when one is set.
#[derive(Clone, Copy)]
pub(super) struct Budget<'a> {
    pub(super) evaluations: usize,
    pub(super) flags: [Option<&'a AtomicBool>; 2],
}

impl From<usize> for Budget<'_> {
    fn from(evaluations: usize) -> Self {
        Self {
            evaluations,
            flags: [None; 2],
        }
    }
}

/// The best point that a search has found, and its value.
#[derive(Clone, Debug)]
pub(super) struct Found {
    pub(super) point: Vec<f64>,
    pub(super) value: f64,
}

impl Cma {
    /// Creates a search from a point, with a first standard deviation `step` along every axis.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "numbers of variables are small"
    )]
    pub(super) fn new(start: Vec<f64>, step: f64, random: Pcg) -> Self {
        let size = start.len();
        let offspring = 4 + (3.0 * libm::log(size as f64)) as usize;
        let parents = offspring / 2;
        let raw: Vec<f64> = (0..parents)
            .map(|rank| libm::log((offspring as f64 + 1.0) / 2.0) - libm::log(rank as f64 + 1.0))
            .collect();
        let sum: f64 = raw.iter().sum();
        let unit = identity(size);
        Self {
            size,
            mean: start,
            step,
            covariance: unit.clone(),
            basis: unit,
            axes: vec![1.0; size],
            path: vec![0.0; size],
            step_path: vec![0.0; size],
            weights: raw.iter().map(|weight| weight / sum).collect(),
            offspring,
            generation: 0,
            solved: 0,
            random,
        }
    }

    /// Searches within a budget of evaluations of a function, until the steps are shorter than `least`.
    pub(super) fn minimise<'a>(
        &mut self,
        budget: impl Into<Budget<'a>>,
        least: f64,
        mut value: impl FnMut(&[f64]) -> f64,
    ) -> Found {
        let mut best = Found {
            value: value(&self.mean),
            point: self.mean.clone(),
        };
        let Budget { evaluations, flags } = budget.into();
        let is_over = || flags.into_iter().any(is_cancelled);
        let mut left = evaluations.saturating_sub(1);
        while left >= self.offspring && self.step * self.widest() > least && !is_over() {
            left -= self.offspring;
            let mut tried: Vec<(f64, Vec<f64>)> = (0..self.offspring)
                .map(|_| {
                    let point = self.sample();
                    let at: Vec<f64> = self.point(&point);
                    let value = value(&at);
                    if value < best.value {
                        best = Found { point: at, value };
                    }
                    (value, point)
                })
                .collect();
            tried.sort_by(|a, b| a.0.total_cmp(&b.0));
            self.adapt(&tried);
        }
        best
    }

    fn widest(&self) -> f64 {
        self.axes.iter().copied().fold(0.0, f64::max)
    }

    fn point(&self, offset: &[f64]) -> Vec<f64> {
        let pairs = self.mean.iter().zip(offset);
        pairs
            .map(|(mean, offset)| mean + self.step * offset)
            .collect()
    }

    /// Draws an offset from the distribution of the covariance.
    fn sample(&mut self) -> Vec<f64> {
        let normal: Vec<f64> = (0..self.size)
            .map(|axis| self.axes[axis] * self.normal())
            .collect();
        product(&self.basis, &normal)
    }

    /// Draws a normally distributed number (Box & Muller 1958).
    fn normal(&mut self) -> f64 {
        let radius = libm::sqrt(-2.0 * libm::log(1.0 - self.random.unit()));
        radius * libm::cos(std::f64::consts::TAU * self.random.unit())
    }

    #[expect(
        clippy::cast_precision_loss,
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "numbers of variables are small"
    )]
    fn adapt(&mut self, tried: &[(f64, Vec<f64>)]) {
        let size = self.size as f64;
        let effective = 1.0
            / self
                .weights
                .iter()
                .map(|weight| weight * weight)
                .sum::<f64>();
        let step_rate = (effective + 2.0) / (size + effective + 5.0);
        let damping =
            1.0 + 2.0 * (libm::sqrt((effective - 1.0) / (size + 1.0)) - 1.0).max(0.0) + step_rate;
        let path_rate = (4.0 + effective / size) / (size + 4.0 + 2.0 * effective / size);
        let one_rate = 2.0 / ((size + 1.3) * (size + 1.3) + effective);
        let many_rate = (2.0 * (effective - 2.0 + 1.0 / effective)
            / ((size + 2.0) * (size + 2.0) + effective))
            .min(1.0 - one_rate);
        let expected = libm::sqrt(size) * (1.0 - 1.0 / (4.0 * size) + 1.0 / (21.0 * size * size));

        let mut offset = vec![0.0; self.size];
        for (weight, (_, point)) in self.weights.iter().zip(tried) {
            for (sum, value) in offset.iter_mut().zip(point) {
                *sum += weight * value;
            }
        }
        self.mean = self.point(&offset);
        self.generation += 1;
        let whitened = self.whitened(&offset);
        let change = libm::sqrt(step_rate * (2.0 - step_rate) * effective);
        for (path, value) in self.step_path.iter_mut().zip(&whitened) {
            *path = (1.0 - step_rate) * *path + change * value;
        }
        let length = libm::sqrt(self.step_path.iter().map(|it| it * it).sum());
        let seen = 1.0 - libm::pow(1.0 - step_rate, 2.0 * self.generation as f64);
        let goes_on = length / libm::sqrt(seen) < (1.4 + 2.0 / (size + 1.0)) * expected;
        let change = if goes_on {
            libm::sqrt(path_rate * (2.0 - path_rate) * effective)
        } else {
            0.0
        };
        for (path, value) in self.path.iter_mut().zip(&offset) {
            *path = (1.0 - path_rate) * *path + change * value;
        }
        let stays = if goes_on {
            0.0
        } else {
            path_rate * (2.0 - path_rate)
        };
        for row in 0..self.size {
            for column in 0..=row {
                let many: f64 = { self.weights.iter().zip(tried) }
                    .map(|(weight, (_, point))| weight * point[row] * point[column])
                    .sum();
                let old = self.covariance[row * self.size + column];
                let one = self.path[row] * self.path[column] + stays * old;
                let new = (1.0 - one_rate - many_rate) * old + one_rate * one + many_rate * many;
                self.covariance[row * self.size + column] = new;
                self.covariance[column * self.size + row] = new;
            }
        }
        self.step *= libm::exp((step_rate / damping * (length / expected - 1.0)).min(1.0));
        // The eigenvectors are worth their work every few generations only.
        let pause = 1 + (1.0 / ((one_rate + many_rate) * size * 10.0)) as usize;
        if self.generation >= self.solved + pause {
            self.solved = self.generation;
            self.solve();
        }
    }

    /// Returns C^(−1/2) times a vector.
    fn whitened(&self, vector: &[f64]) -> Vec<f64> {
        let mut turned = vec![0.0; self.size];
        for (row, value) in self.basis.chunks_exact(self.size).zip(vector) {
            for (sum, entry) in turned.iter_mut().zip(row) {
                *sum += entry * value;
            }
        }
        for (value, axis) in turned.iter_mut().zip(&self.axes) {
            *value /= axis;
        }
        product(&self.basis, &turned)
    }

    /// Computes the eigenvectors of the covariance.
    fn solve(&mut self) {
        let (basis, values) = eigen(self.covariance.clone(), self.size);
        self.basis = basis;
        self.axes = values
            .iter()
            .map(|value| libm::sqrt(value.max(1e-20)))
            .collect();
    }
}

fn identity(size: usize) -> Vec<f64> {
    let mut unit = vec![0.0; size * size];
    (0..size).for_each(|axis| unit[axis * size + axis] = 1.0);
    unit
}

fn product(matrix: &[f64], vector: &[f64]) -> Vec<f64> {
    let rows = matrix.chunks_exact(vector.len());
    rows.map(|row| row.iter().zip(vector).map(|(a, b)| a * b).sum())
        .collect()
}

/// Returns the eigenvectors of a symmetric matrix as columns, row by row, and the eigenvalues (Jacobi's method).
fn eigen(mut matrix: Vec<f64>, size: usize) -> (Vec<f64>, Vec<f64>) {
    let mut basis = identity(size);
    for _ in 0..30 {
        let mut rest = 0.0;
        let mut whole = 0.0;
        for row in 0..size {
            whole += matrix[row * size + row] * matrix[row * size + row];
            for column in 0..row {
                rest += matrix[row * size + column] * matrix[row * size + column];
            }
        }
        if rest <= 1e-24 * whole {
            break;
        }
        for p in 0..size {
            for q in p + 1..size {
                let off = matrix[p * size + q];
                if off == 0.0 {
                    continue;
                }
                let theta = (matrix[q * size + q] - matrix[p * size + p]) / (2.0 * off);
                let sign = if theta < 0.0 { -1.0 } else { 1.0 };
                let tangent = sign / (theta.abs() + libm::sqrt(theta * theta + 1.0));
                let cosine = 1.0 / libm::sqrt(tangent * tangent + 1.0);
                let sine = tangent * cosine;
                for k in 0..size {
                    let (a, b) = (matrix[k * size + p], matrix[k * size + q]);
                    matrix[k * size + p] = cosine * a - sine * b;
                    matrix[k * size + q] = sine * a + cosine * b;
                }
                for k in 0..size {
                    let (a, b) = (matrix[p * size + k], matrix[q * size + k]);
                    matrix[p * size + k] = cosine * a - sine * b;
                    matrix[q * size + k] = sine * a + cosine * b;
                    let (a, b) = (basis[k * size + p], basis[k * size + q]);
                    basis[k * size + p] = cosine * a - sine * b;
                    basis[k * size + q] = sine * a + cosine * b;
                }
            }
        }
    }
    let values = (0..size).map(|axis| matrix[axis * size + axis]).collect();
    (basis, values)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A long valley that is turned against the axes.
    #[test]
    fn rosenbrock_is_minimised() {
        let rosenbrock = |x: &[f64]| {
            let pairs = x.windows(2);
            pairs
                .map(|pair| {
                    let [a, b] = [pair[0], pair[1]];
                    100.0 * (b - a * a) * (b - a * a) + (1.0 - a) * (1.0 - a)
                })
                .sum()
        };
        let mut search = Cma::new(vec![-1.0; 5], 0.5, Pcg::new(1, 2));
        let found = search.minimise(10_000, 1e-12, rosenbrock);
        assert!(found.value < 1e-10, "{found:?}");
        assert!(found.point.iter().all(|x| (x - 1.0).abs() < 1e-4));
    }
}
