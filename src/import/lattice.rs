//! Points of the Gaussian and the Eisenstein integers, and quotients of them, as exact expressions.

use crate::build::NumberText;
use crate::build::written::sequence;
use crate::document::node::Value;

/// Lattice in the plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lattice {
    /// a + b i, a square lattice.
    Gaussian,
    /// a + b ω with ω² = −1 − ω, a triangular lattice.
    Eisenstein,
}

impl Lattice {
    pub(super) fn name(self) -> char {
        match self {
            Self::Gaussian => 'G',
            Self::Eisenstein => 'E',
        }
    }

    pub(super) fn norm(self, [a, b]: [i64; 2]) -> i64 {
        match self {
            Self::Gaussian => a * a + b * b,
            Self::Eisenstein => a * a - a * b + b * b,
        }
    }

    /// Returns the product of an integer and the conjugate of another.
    pub(super) fn times_conjugate(self, [a, b]: [i64; 2], [c, d]: [i64; 2]) -> [i64; 2] {
        match self {
            Self::Gaussian => [a * c + b * d, b * c - a * d],
            // The conjugate of c + d ω is c − d − d ω.
            Self::Eisenstein => [a * c - a * d + b * d, b * c - a * d],
        }
    }

    /// Returns the point of an integer that is divided by a whole number, as expressions.
    pub(super) fn point(self, [a, b]: [i64; 2], by: i64) -> Value {
        let (x, y) = match self {
            Self::Gaussian => (fraction(a, by, ""), fraction(b, by, "")),
            Self::Eisenstein => (
                fraction(2 * a - b, 2 * by, ""),
                fraction(b, 2 * by, "sqrt(3)"),
            ),
        };
        sequence([x.0, y.0])
    }
}

/// Returns above/below times a root, as an expression in lowest terms.
fn fraction(above: i64, below: i64, root: &str) -> NumberText {
    let (mut a, mut b) = (above.abs(), below);
    while b != 0 {
        (a, b) = (b, a % b);
    }
    let (above, below) = (above / a.max(1), below / a.max(1));
    if above == 0 || root.is_empty() && below == 1 {
        #[expect(
            clippy::cast_precision_loss,
            reason = "the numbers of a gene are small"
        )]
        return NumberText::from(above as f64);
    }
    let sign = if above < 0 { "-" } else { "" };
    let front = match (above.abs(), root) {
        (above, "") => above.to_string(),
        (1, root) => root.to_owned(),
        (above, root) => format!("{above}*{root}"),
    };
    NumberText::from(match below {
        1 => format!("{sign}{front}"),
        below => format!("{sign}{front}/{below}"),
    })
}
