//! Projection of maps to the space in which they are drawn.

use crate::diagnostic::Place;

use super::affine::{Affine, inverse, times};
use super::eigen;
use super::evaluate::Scope;
use super::syntax::Parsed;
use super::value::{wrong, wrong_with};

/// Relative distance from invariance that counts as rounding.
const NEAR: f64 = 1e-9;

/// A linear map to the plane or to space, such that the maps of a block have images.
pub(super) struct Projection {
    /// Matrix by rows of the map from the space of the block; `None` if the two spaces are one.
    matrix: Option<Vec<f64>>,
    /// A right inverse of the matrix.
    back: Vec<f64>,
    /// Dimension of the image: 2, or 3 in space; a line lies in the plane.
    pub(super) axes: usize,
    /// Dimension of the image: 1, 2 or 3.
    rank: usize,
}

impl Projection {
    /// Returns the projection of a block: `$subspace=[M, i, …]` selects eigenspaces of a matrix.
    pub(super) fn of(scope: &mut Scope) -> Parsed<Self> {
        let dimension = scope.dimension;
        let Some(setting) = scope.definition("$subspace") else {
            return match dimension {
                1..=3 => Ok(Self::new(None, Vec::new(), dimension)),
                _ => wrong_with(
                    format!("a set of {dimension} dimensions is not drawn"),
                    &scope.place_of("$dim"),
                    "$subspace=[s, 0] selects a plane, that of the first eigenvalue of a matrix s",
                ),
            };
        };
        let place = &setting.value;
        let text = place.text();
        let mut words = text.split(|c: char| c.is_whitespace() || ",[]".contains(c));
        let mut words = words.by_ref().filter(|word| !word.is_empty());
        let (name, indices): (_, Vec<_>) = (words.next().unwrap_or_default(), words.collect());
        let matrix = scope.linear_part(name, place)?;
        let Some(cells) = eigen::cells(&matrix, dimension) else {
            return wrong(format!("the eigenvalues of {name} are not distinct"), place);
        };
        let mut rows = Vec::new();
        for index in &indices {
            let Some(cell) = index.parse().ok().and_then(|at: usize| cells.get(at)) else {
                let count = cells.len();
                let message =
                    format!("'{index}' is none of the {count} eigenspaces of {name}, from 0 on");
                return wrong(message, place);
            };
            rows.extend(cell.vector.iter().map(|entry| entry.x));
            if cell.value.y > 0.0 {
                rows.extend(cell.vector.iter().map(|entry| entry.y));
            }
        }
        let rank = rows.len() / dimension;
        if !(1..=3).contains(&rank) {
            return wrong(
                format!("a subspace of {rank} dimensions is not drawn"),
                place,
            );
        }
        let transposed: Vec<f64> = (0..dimension)
            .flat_map(|column| rows.iter().skip(column).step_by(dimension).copied())
            .collect();
        let Some(square) = inverse(&times(&rows, &transposed, rank), rank) else {
            return wrong("an eigenspace is selected twice", place);
        };
        let back = times(&transposed, &square, rank);
        Ok(Self::new(Some(rows), back, rank))
    }

    fn new(matrix: Option<Vec<f64>>, back: Vec<f64>, rank: usize) -> Self {
        Self {
            matrix,
            back,
            axes: rank.max(2),
            rank,
        }
    }

    /// Returns the image of a map: its matrix by rows, and its translation.
    pub(super) fn image(&self, map: &Affine, place: &Place) -> Parsed<Vec<f64>> {
        let Affine { matrix, shift } = match &self.matrix {
            None => map.clone(),
            Some(projection) => {
                let moved = times(projection, &map.matrix, map.dimension());
                let matrix = times(&moved, &self.back, self.rank);
                let again = times(&matrix, projection, map.dimension());
                let largest = |all: &[f64]| all.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
                let apart: Vec<f64> = moved.iter().zip(&again).map(|(a, b)| a - b).collect();
                if largest(&apart) > NEAR * largest(&moved) {
                    return wrong("this map has no image in $subspace", place);
                }
                Affine {
                    matrix: rounded(matrix),
                    shift: rounded(times(projection, &map.shift, 1)),
                }
            }
        };
        Ok(match (self.rank, &matrix[..], &shift[..]) {
            (1, [factor], [shift]) => vec![*factor, 0.0, 0.0, *factor, *shift, 0.0],
            _ => matrix.into_iter().chain(shift).collect(),
        })
    }
}

/// Rounds numbers to 15 digits of the largest, which leaves out what rounding errors add.
fn rounded(numbers: Vec<f64>) -> Vec<f64> {
    let largest = numbers.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
    if largest == 0.0 {
        return numbers;
    }
    let digits = 14.0 - libm::floor(libm::log10(largest));
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the range of digits is limited"
    )]
    let digits = digits.clamp(0.0, 300.0) as usize;
    let round = |number: f64| format!("{number:.digits$}").parse().unwrap_or(number);
    numbers.into_iter().map(round).collect()
}
