//! Fractal interpolation: self-affine graphs of functions through given points (Barnsley, "Fractal functions
//! and interpolation", 1986; Demko, Hodges & Naylor 1985, section 3.5).

use super::Map;
use crate::expression::{AffineOf, Arithmetic, Doubles};
use crate::geometry::DVec2;

/// An error that leaves no curve through the points. Indices count from 0 in fields, from 1 in messages.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InterpolationError {
    /// There are fewer than three points: a single piece would be the whole curve.
    #[error("a curve needs at least three points, not {points}")]
    TooFewPoints {
        /// The number of points.
        points: usize,
    },
    /// A point is not finite.
    #[error("point {} is not finite", .point + 1)]
    PointNotFinite {
        /// Index of the point.
        point: usize,
    },
    /// A point does not lie to the right of the preceding one.
    #[error("point {} does not lie to the right of the one before", .point + 1)]
    NotIncreasing {
        /// Index of the point.
        point: usize,
    },
    /// The number of factors is neither 1 nor the number of pieces.
    #[error("there are {scales} factors for {pieces} pieces; one does for all")]
    NumberOfScales {
        /// The number of factors.
        scales: usize,
        /// The number of pieces between the points.
        pieces: usize,
    },
    /// A vertical factor does not lie between −1 and 1.
    #[error("factor {} is {scale}; the curve diverges unless it lies between -1 and 1", .number + 1)]
    Scale {
        /// Index of the factor in the list.
        number: usize,
        /// The factor.
        scale: f64,
    },
    /// No curve over an interval has the dimension.
    #[error("the dimension {dimension} is not possible; it is at least 1 and less than 2")]
    Dimension {
        /// The dimension.
        dimension: f64,
    },
    /// The points lie on a line: the curve is that line for all factors.
    #[error("the points lie on a line, so the curve is that line and has dimension 1")]
    OnALine,
}

/// Returns the maps whose attractor is the graph of a continuous function through points, from left to right.
///
/// Map i takes the whole curve to the piece between points i and i + 1. It keeps vertical lines vertical and
/// multiplies heights by its factor; `scales` holds one factor for all pieces or one for each. The weight of
/// a map is its piece's share of the width, so that random iteration visits equal widths equally often.
///
/// # Errors
///
/// Returns an error if there are fewer than three points, if a point is not finite or not to the right of the
/// preceding one, if the number of factors is neither 1 nor the number of pieces, or if a factor does not lie
/// between −1 and 1.
pub fn interpolate(points: &[DVec2], scales: &[f64]) -> Result<Vec<Map>, InterpolationError> {
    check_points(points)?;
    let pieces = points.len() - 1;
    if scales.len() != 1 && scales.len() != pieces {
        return Err(InterpolationError::NumberOfScales {
            scales: scales.len(),
            pieces,
        });
    }
    let diverges = |scale: &f64| scale.is_nan() || scale.abs() >= 1.0;
    if let Some(number) = scales.iter().position(diverges) {
        let scale = scales[number];
        return Err(InterpolationError::Scale { number, scale });
    }
    let written: Vec<_> = points.iter().map(DVec2::to_array).collect();
    let pieces = self::pieces(&mut Doubles, &written, scales).into_iter();
    let maps = pieces.zip(shares(points));
    Ok(maps
        .map(|(piece, share)| Map::new(piece.into()).weighing(share))
        .collect())
}

/// Returns the maps of [`interpolate`] in any arithmetic, for at least two points and at least one factor.
pub(crate) fn pieces<A: Arithmetic>(
    of: &mut A,
    points: &[[A::Number; 2]],
    scales: &[A::Number],
) -> Vec<AffineOf<A::Number>> {
    let span = |of: &mut A, from: &[A::Number; 2], to: &[A::Number; 2]| {
        [0, 1].map(|row| of.subtract(&to[row], &from[row]))
    };
    let first = &points[0];
    let whole = span(of, first, &points[points.len() - 1]);
    let maps = points.windows(2).zip(scales.iter().cycle());
    let maps = maps.map(|(ends, scale)| {
        let [width, height] = span(of, &ends[0], &ends[1]);
        let rise = of.multiply(scale, &whole[1]);
        let rise = of.subtract(&height, &rise);
        let along = [width, rise].map(|part| of.divide(&part, &whole[0]));
        let zero = of.decimal(0.0);
        let linear = AffineOf::linear(of, [along, [zero, scale.clone()]]);
        let image = linear.turned(of, first);
        let origin = span(of, &image, &ends[0]);
        linear.moved_to(origin)
    });
    maps.collect()
}

/// Returns the vertical factor d with which the curve through points, with this one factor for all pieces,
/// has a given box dimension D, at least 1 and less than 2: the positive solution of Σ |d| a_i^(D − 1) = 1,
/// where a_i are the pieces' shares of the width. The factor −d gives the same dimension.
///
/// # Errors
///
/// Returns an error if there are fewer than three points, if a point is not finite or not to the right of the
/// preceding one, if the points lie on a line, or if the dimension is out of range or so close to 2 that the
/// factor rounds to 1.
pub fn scale_of_dimension(points: &[DVec2], dimension: f64) -> Result<f64, InterpolationError> {
    check_points(points)?;
    if !(1.0..2.0).contains(&dimension) {
        return Err(InterpolationError::Dimension { dimension });
    }
    if on_a_line(points) {
        return Err(InterpolationError::OnALine);
    }
    let scale = 1.0
        / shares(points)
            .map(|share| libm::pow(share, dimension - 1.0))
            .sum::<f64>();
    // The dimension is so close to 2 that the factor rounds to 1.
    if scale >= 1.0 {
        return Err(InterpolationError::Dimension { dimension });
    }
    Ok(scale)
}

/// Returns the box dimension of the curve through points with given factors, to about 15 digits: the solution
/// D of Σ |d_i| a_i^(D − 1) = 1, or 1 if Σ |d_i| is at most 1 or the points lie on a line (Barnsley &
/// Harrington, "The calculus of fractal interpolation functions", 1989).
///
/// # Errors
///
/// Returns the errors of [`interpolate`].
pub fn interpolation_dimension(
    points: &[DVec2],
    scales: &[f64],
) -> Result<f64, InterpolationError> {
    interpolate(points, scales)?;
    let sum = |dimension: f64| -> f64 {
        let terms = shares(points).zip(scales.iter().cycle());
        terms
            .map(|(share, scale)| scale.abs() * libm::pow(share, dimension - 1.0))
            .sum()
    };
    if on_a_line(points) {
        return Ok(1.0);
    }
    let (mut low, mut high) = (1.0, 2.0);
    loop {
        let middle = f64::midpoint(low, high);
        if middle <= low || middle >= high {
            return Ok(low);
        }
        if sum(middle) > 1.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
}

fn check_points(points: &[DVec2]) -> Result<(), InterpolationError> {
    let finite = points.iter().position(|point| !point.is_finite());
    if let Some(point) = finite {
        return Err(InterpolationError::PointNotFinite { point });
    }
    let back = points.windows(2).position(|ends| ends[1].x <= ends[0].x);
    if let Some(before) = back {
        return Err(InterpolationError::NotIncreasing { point: before + 1 });
    }
    if points.len() < 3 {
        return Err(InterpolationError::TooFewPoints {
            points: points.len(),
        });
    }
    Ok(())
}

/// Returns the vector from the first point to the last.
fn span(points: &[DVec2]) -> DVec2 {
    points[points.len() - 1] - points[0]
}

/// Iterates over the pieces' shares of the width.
fn shares(points: &[DVec2]) -> impl Iterator<Item = f64> {
    let width = span(points).x;
    points
        .windows(2)
        .map(move |ends| (ends[1].x - ends[0].x) / width)
}

fn on_a_line(points: &[DVec2]) -> bool {
    let (first, whole) = (points[0], span(points));
    let height = points
        .iter()
        .map(|point| (point.y - first.y).abs())
        .fold(0.0, f64::max);
    points.iter().all(|point| {
        let off = point.y - first.y - whole.y * ((point.x - first.x) / whole.x);
        off.abs() <= 1e-12 * height
    })
}
