//! Coordinates of the plane in which several matrices stretch least.

use crate::geometry::{DMat2, DVec2, Linear, stretch};

/// Returns the matrices in coordinates in which their largest stretch is nearly minimal: the unit disc of
/// these coordinates is the ellipse that all of the matrices shrink best.
///
/// Ellipses form a half-plane, by their shear and the ratio of their axes, and the ellipses that all matrices
/// stretch by at most a given factor form a convex set. Descent therefore leads to the least stretch. Steps
/// are tried in directions that turn by the golden angle, which find the way out of an edge of the function.
/// An imperfect minimum makes no bound wrong, only wider.
pub(super) fn in_best_coordinates(matrices: &[DMat2]) -> Vec<DMat2> {
    let coordinates = best(matrices);
    let applied = matrices.iter().map(|&matrix| coordinates.applied(matrix));
    applied.collect()
}

/// Returns the map to coordinates in which the largest stretch of the matrices is nearly minimal: see
/// [`in_best_coordinates`].
pub(crate) fn best_coordinates(matrices: &[DMat2]) -> DMat2 {
    best(matrices).there()
}

/// Returns the coordinates in which the largest stretch of the matrices is nearly minimal.
fn best(matrices: &[DMat2]) -> Coordinates {
    const DIRECTIONS: u32 = 8;
    const GOLDEN: f64 = 2.399_963_229_728_653;
    let least = matrices
        .iter()
        .map(Linear::spectral_radius)
        .fold(0.0, f64::max);
    let (mut best, mut size, mut turn) = (Coordinates::GIVEN, 1.0, 0.0);
    let mut stretch = best.stretch(matrices);
    while size > 1e-6 && stretch > least * (1.0 + 1e-9) {
        let around = (0..DIRECTIONS).map(|number| {
            let angle = turn + f64::from(number) * (std::f64::consts::TAU / f64::from(DIRECTIONS));
            let step = size * DVec2::new(libm::cos(angle), libm::sin(angle));
            let tried = best.stepped(step);
            (tried.stretch(matrices), tried)
        });
        let found = around.min_by(|a, b| a.0.total_cmp(&b.0));
        match found {
            Some((less, coordinates))
                if less < stretch * (1.0 - 1e-9) && !coordinates.is_flat() =>
            {
                (best, stretch, size) = (coordinates, less, size * 1.5);
            }
            _ => size *= 0.7,
        }
        turn += GOLDEN;
    }
    best
}

/// Coordinates (x + shear · y, ratio · y).
#[derive(Clone, Copy)]
struct Coordinates {
    shear: f64,
    ratio: f64,
}

impl Coordinates {
    const GIVEN: Self = Self {
        shear: 0.0,
        ratio: 1.0,
    };

    /// Returns the coordinates after a step in the hyperbolic geometry of the half-plane.
    fn stepped(&self, step: DVec2) -> Self {
        Self {
            shear: self.shear + step.x * self.ratio,
            ratio: self.ratio * libm::exp(step.y),
        }
    }

    /// Returns whether products could leave the range of a double.
    fn is_flat(&self) -> bool {
        !(1e-100..1e100).contains(&self.ratio) || self.shear.abs() > 1e100
    }

    fn there(&self) -> DMat2 {
        DMat2::from_cols(DVec2::X, DVec2::new(self.shear, self.ratio))
    }

    fn applied(&self, matrix: DMat2) -> DMat2 {
        let back = DVec2::new(-self.shear, 1.0) / self.ratio;
        self.there() * matrix * DMat2::from_cols(DVec2::X, back)
    }

    fn stretch(&self, matrices: &[DMat2]) -> f64 {
        let stretches = matrices
            .iter()
            .map(|&matrix| stretch(&self.applied(matrix)));
        let numbers = stretches.map(|stretch| {
            if stretch.is_nan() {
                f64::INFINITY
            } else {
                stretch
            }
        });
        numbers.fold(0.0, f64::max)
    }
}
