//! Affine maps of a space of any dimension.

/// Largest dimension of the space in which the maps of a block are defined.
pub(super) const MAX_DIMENSION: usize = 12;

/// An affine map x ↦ M x + t.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Affine {
    /// The matrix M by rows.
    pub(super) matrix: Vec<f64>,
    /// The translation t.
    pub(super) shift: Vec<f64>,
}

impl Affine {
    /// Returns the map x ↦ factor x.
    pub(super) fn scaling(dimension: usize, factor: f64) -> Self {
        let mut matrix = vec![0.0; dimension * dimension];
        matrix
            .iter_mut()
            .step_by(dimension + 1)
            .for_each(|it| *it = factor);
        Self::linear(dimension, matrix)
    }

    /// Returns the map of a matrix by rows.
    pub(super) fn linear(dimension: usize, matrix: Vec<f64>) -> Self {
        let shift = vec![0.0; dimension];
        Self { matrix, shift }
    }

    /// Returns the map x ↦ x + shift.
    pub(super) fn translation(shift: Vec<f64>) -> Self {
        Self {
            shift: shift.clone(),
            ..Self::scaling(shift.len(), 1.0)
        }
    }

    pub(super) fn dimension(&self) -> usize {
        self.shift.len()
    }

    /// Returns the map x ↦ self(other(x)).
    pub(super) fn after(&self, other: &Self) -> Self {
        let dimension = self.dimension();
        let moved = times(&self.matrix, &other.shift, 1);
        let shift = moved
            .iter()
            .zip(&self.shift)
            .map(|(moved, shift)| moved + shift);
        Self {
            matrix: times(&self.matrix, &other.matrix, dimension),
            shift: shift.collect(),
        }
    }

    /// Returns the map x ↦ self(x) + other(x).
    pub(super) fn plus(&self, other: &Self) -> Self {
        let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a + b).collect();
        Self {
            matrix: sum(&self.matrix, &other.matrix),
            shift: sum(&self.shift, &other.shift),
        }
    }

    /// Returns the inverse; `None` if there is none.
    pub(super) fn inverse(&self) -> Option<Self> {
        let matrix = inverse(&self.matrix, self.dimension())?;
        let back = times(&matrix, &self.shift, 1);
        Some(Self {
            matrix,
            shift: back.iter().map(|it| -it).collect(),
        })
    }

    /// Returns the map composed with itself, `exponent` times.
    pub(super) fn power(&self, mut exponent: u32) -> Self {
        let mut result = Self::scaling(self.dimension(), 1.0);
        let mut square = self.clone();
        while exponent > 0 {
            if exponent % 2 == 1 {
                result = square.after(&result);
            }
            exponent /= 2;
            if exponent > 0 {
                square = square.after(&square);
            }
        }
        result
    }

    pub(super) fn is_finite(&self) -> bool {
        self.matrix
            .iter()
            .chain(&self.shift)
            .all(|it| it.is_finite())
    }
}

/// Returns the product of two matrices by rows, the second of which has a number of columns.
pub(super) fn times(a: &[f64], b: &[f64], columns: usize) -> Vec<f64> {
    let inner = b.len() / columns;
    let row = |row: &[f64]| {
        let entry = |column: usize| {
            row.iter()
                .zip(b[column..].iter().step_by(columns))
                .map(|(a, b)| a * b)
                .sum::<f64>()
        };
        (0..columns).map(entry).collect::<Vec<f64>>()
    };
    a.chunks(inner).flat_map(row).collect()
}

/// Returns the inverse of a square matrix by rows, by Gauss–Jordan elimination with the largest pivot of each column.
pub(super) fn inverse(matrix: &[f64], dimension: usize) -> Option<Vec<f64>> {
    let mut left = matrix.to_vec();
    let mut right = Affine::scaling(dimension, 1.0).matrix;
    let largest = matrix.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
    for column in 0..dimension {
        let size = |row: &usize| left[row * dimension + column].abs();
        let pivot = (column..dimension).max_by(|a, b| size(a).total_cmp(&size(b)))?;
        // Below this, the pivot is the rounding error of the others.
        if size(&pivot) <= largest * 1e-14 {
            return None;
        }
        for side in [&mut left, &mut right] {
            for entry in 0..dimension {
                side.swap(pivot * dimension + entry, column * dimension + entry);
            }
        }
        let factor = left[column * dimension + column];
        for side in [&mut left, &mut right] {
            let row = &mut side[column * dimension..(column + 1) * dimension];
            row.iter_mut().for_each(|entry| *entry /= factor);
        }
        for row in (0..dimension).filter(|row| *row != column) {
            let factor = left[row * dimension + column];
            for side in [&mut left, &mut right] {
                for entry in 0..dimension {
                    side[row * dimension + entry] -= factor * side[column * dimension + entry];
                }
            }
        }
    }
    Some(right)
}
