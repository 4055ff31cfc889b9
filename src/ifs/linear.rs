//! Small dense systems of linear equations, solved by Gaussian elimination with partial pivoting.

/// Equations `matrix · x = constants`, for several right-hand sides at once.
pub(super) struct Equations {
    unknowns: usize,
    /// The rows of the matrix, each followed by its constants, one for each right-hand side.
    rows: Vec<Vec<f64>>,
}

impl Equations {
    /// Returns as many equations as unknowns, all zero.
    pub(super) fn new(unknowns: usize, sides: usize) -> Self {
        Self {
            unknowns,
            rows: vec![vec![0.0; unknowns + sides]; unknowns],
        }
    }

    /// Adds to the coefficient of an unknown in an equation.
    pub(super) fn add(&mut self, equation: usize, unknown: usize, coefficient: f64) {
        self.rows[equation][unknown] += coefficient;
    }

    /// Resets an equation to zero, constants included.
    pub(super) fn clear(&mut self, equation: usize) {
        self.rows[equation].fill(0.0);
    }

    /// Adds to the constant of a right-hand side in an equation.
    pub(super) fn add_constant(&mut self, equation: usize, side: usize, constant: f64) {
        self.rows[equation][self.unknowns + side] += constant;
    }

    /// Returns the unknowns, one list for each right-hand side, by Gaussian elimination with partial
    /// pivoting; `None` if the matrix is singular or the numbers leave the range of a double.
    pub(super) fn solve(mut self) -> Option<Vec<Vec<f64>>> {
        let size = self.unknowns;
        for column in 0..size {
            let pivot = (column..size).max_by(|&a, &b| {
                let entry = |row: usize| self.rows[row][column].abs();
                entry(a).total_cmp(&entry(b))
            })?;
            self.rows.swap(column, pivot);
            let (above, below) = self.rows.split_at_mut(column + 1);
            let pivot = &above[column];
            if pivot[column] == 0.0 {
                return None;
            }
            for row in below {
                let factor = row[column] / pivot[column];
                if factor != 0.0 {
                    for (entry, pivot) in row[column..].iter_mut().zip(&pivot[column..]) {
                        *entry -= factor * pivot;
                    }
                }
            }
        }
        let sides = self.rows.first().map_or(0, |row| row.len() - size);
        let solutions = (0..sides).map(|side| self.substitute(side));
        let solutions: Vec<Vec<f64>> = solutions.collect();
        let finite = solutions.iter().flatten().all(|value| value.is_finite());
        finite.then_some(solutions)
    }

    /// Returns the unknowns of the triangular matrix for a right-hand side, by back substitution.
    fn substitute(&self, side: usize) -> Vec<f64> {
        let mut solution = vec![0.0; self.unknowns];
        for (index, row) in self.rows.iter().enumerate().rev() {
            let known = (index + 1..self.unknowns).map(|column| row[column] * solution[column]);
            let known: f64 = known.sum();
            solution[index] = (row[self.unknowns + side] - known) / row[index];
        }
        solution
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_exchanged_where_a_pivot_is_zero() {
        let mut equations = Equations::new(2, 2);
        equations.add(0, 1, 2.0);
        equations.add(1, 0, 3.0);
        equations.add(1, 1, 1.0);
        for (side, constants) in [[4.0, 5.0], [2.0, 7.0]].into_iter().enumerate() {
            equations.add_constant(0, side, constants[0]);
            equations.add_constant(1, side, constants[1]);
        }
        assert_eq!(
            equations.solve(),
            Some(vec![vec![1.0, 2.0], vec![2.0, 1.0]])
        );
    }

    #[test]
    fn a_singular_matrix_has_no_solution() {
        let mut equations = Equations::new(2, 1);
        for (equation, factor) in [(0, 1.0), (1, 2.0)] {
            equations.add(equation, 0, factor);
            equations.add(equation, 1, 3.0 * factor);
        }
        equations.add_constant(0, 0, 1.0);
        assert_eq!(equations.solve(), None);
    }
}
