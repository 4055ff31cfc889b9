//! Fractal interpolation: curves through points that look the same in every part (Barnsley,
//! "Fractal functions and interpolation", 1986; Demko, Hodges & Naylor 1985, section 3.5).

use super::Map;
use crate::geometry::{DAffine2, DVec2};

/// Why there is no curve through the points. Numbers in values count from 0, in messages from 1.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum InterpolationError {
    /// With fewer than three points there is nothing to repeat.
    #[error("a curve needs at least three points, not {points}")]
    TooFewPoints {
        /// How many there are.
        points: usize,
    },
    /// A point is not finite.
    #[error("point {} is not finite", .point + 1)]
    PointNotFinite {
        /// The point.
        point: usize,
    },
    /// A point does not lie to the right of the one before.
    #[error("point {} does not lie to the right of the one before", .point + 1)]
    NotIncreasing {
        /// The point.
        point: usize,
    },
    /// There is not one factor for all pieces, nor one for each.
    #[error("there are {scales} factors for {pieces} pieces; one does for all")]
    NumberOfScales {
        /// How many factors there are.
        scales: usize,
        /// How many pieces lie between the points.
        pieces: usize,
    },
    /// A vertical factor is not between −1 and 1.
    #[error("factor {} is {scale}; the curve diverges unless it lies between -1 and 1", .number + 1)]
    Scale {
        /// The factor's place in the list.
        number: usize,
        /// The factor.
        scale: f64,
    },
    /// No curve over an interval has this dimension.
    #[error("the dimension {dimension} is not possible; it is at least 1 and less than 2")]
    Dimension {
        /// The dimension.
        dimension: f64,
    },
    /// Points on a line give that line, whatever the factors.
    #[error("the points lie on a line, so the curve is that line and has dimension 1")]
    OnALine,
}

/// The maps whose attractor is the graph of a continuous function through points, from left to right.
///
/// Map i takes the whole curve to the piece between points i and i + 1. It keeps vertical lines
/// vertical and multiplies heights by its factor, of which there is one for all pieces or one for each.
/// A map's weight is its piece's share of the width, so that random iteration visits equal widths
/// equally often.
///
/// # Errors
///
/// If the points are fewer than three, not finite or not in order, or if the factors are of another
/// number or not between −1 and 1.
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
    let (first, whole) = (points[0], span(points));
    let maps = points.windows(2).zip(scales.iter().cycle());
    let maps = maps.map(|(ends, &scale)| {
        let piece = ends[1] - ends[0];
        let along = (piece - scale * DVec2::new(0.0, whole.y)) / whole.x;
        let mut affine = DAffine2::from_cols(along, DVec2::new(0.0, scale), DVec2::ZERO);
        affine.translation = ends[0] - affine.transform_vector2(first);
        Map::new(affine).weighing(piece.x / whole.x)
    });
    Ok(maps.collect())
}

/// The one factor with which the curve through points has a given box dimension D, at least 1 and
/// less than 2: that with Σ |d| a_i^(D − 1) = 1, a_i being the pieces' shares of the width. The
/// negative one does as well.
///
/// # Errors
///
/// If the points are fewer than three, not finite or not in order, if they lie on a line, or if
/// there is no curve of that dimension.
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
    // So close to 2 that the factor rounds to 1.
    if scale >= 1.0 {
        return Err(InterpolationError::Dimension { dimension });
    }
    Ok(scale)
}

/// The box dimension of the curve through points with given factors, to some 15 digits: the D with
/// Σ |d_i| a_i^(D − 1) = 1, or 1 if Σ |d_i| is no more than 1 or the points lie on a line (Barnsley &
/// Harrington, "The calculus of fractal interpolation functions", 1989).
///
/// # Errors
///
/// Those of [`interpolate`].
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

/// From the first point to the last.
fn span(points: &[DVec2]) -> DVec2 {
    points[points.len() - 1] - points[0]
}

/// The pieces' shares of the width.
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
