//! Condensation sets and initial sets: points, outlines and unions of outlines, with exact moments.

use std::sync::Arc;

use super::Moments;
use super::moments::square;
use crate::expression::degrees;
use crate::geometry::{Bounds, DAffine2, DMat2, DVec2, exponent_of};
use crate::rule::{BaseElement, Piece, arc};

/// A condensation set or an initial set, in the coordinates of the plane.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A point.
    Point(DVec2),
    /// An outline: a curve if it is open, the enclosed area if it is closed.
    Outline(BaseElement),
    /// Several outlines: an approximant of another fractal. Never empty.
    Union(Arc<[BaseElement]>),
}

/// Number of parts into which the quadrature divides a curve.
const PARTS: u32 = 16;

/// Nodes and weights of the Gauss–Legendre quadrature over [0, 1] with 6 nodes: exact for polynomials up to
/// degree 11, which the area moments of a cubic outline have.
const GAUSS: [(f64, f64); 6] = [
    (0.033_765_242_898_423_99, 0.085_662_246_189_585_17),
    (0.169_395_306_766_867_74, 0.180_380_786_524_069_3),
    (0.380_690_406_958_401_55, 0.233_956_967_286_345_52),
    (0.619_309_593_041_598_4, 0.233_956_967_286_345_52),
    (0.830_604_693_233_132_3, 0.180_380_786_524_069_3),
    (0.966_234_757_101_576, 0.085_662_246_189_585_17),
];

impl Shape {
    /// Returns the open polyline through points; `None` if it has no length or ends where it starts.
    #[must_use]
    pub fn polyline(points: &[DVec2]) -> Option<Self> {
        Self::through(points, false)
    }

    /// Returns the polygon through points; `None` if it has no length.
    #[must_use]
    pub fn polygon(points: &[DVec2]) -> Option<Self> {
        Self::through(points, true)
    }

    fn through(points: &[DVec2], closed: bool) -> Option<Self> {
        let (&start, others) = points.split_first()?;
        let pieces = others.iter().map(|&point| Piece::Line(point)).collect();
        BaseElement::new(start, pieces, closed).map(Self::Outline)
    }

    /// Returns an ellipse with its half axes; the first is rotated by an angle in degrees, counter-clockwise,
    /// from the x axis. `None` if it has no extent.
    ///
    /// The outline deviates from the ellipse by at most 1e-7 times the longer half axis.
    #[must_use]
    pub fn ellipse(centre: DVec2, half_axes: DVec2, angle: f64) -> Option<Self> {
        let (cosine, sine) = (degrees::cos(angle), degrees::sin(angle));
        let along = DVec2::new(cosine, sine) * half_axes.x;
        let across = DVec2::new(-sine, cosine) * half_axes.y;
        let map = DAffine2::from_cols(along, across, centre);
        let mut pieces = arc(DVec2::X, DVec2::Y, -DVec2::X)?;
        pieces.extend(arc(-DVec2::X, -DVec2::Y, DVec2::X)?);
        let pieces: Vec<Piece> = pieces.iter().map(|piece| piece.transformed(&map)).collect();
        let start = pieces.last()?.end();
        let shape = Self::Outline(BaseElement::new(start, pieces, true)?);
        shape.moments().is_some().then_some(shape)
    }

    /// Returns mean and covariance of the uniform distribution on the shape: along an open outline by length,
    /// within a closed one by area. In a union it is by area where all outlines are closed, else by length,
    /// where closed ones contribute their circumference. `None` if a number is not finite, an outline has no
    /// extent, or a closed outline has no area.
    ///
    /// The moments are exact to rounding, except for lengths of curves, which have about 9 correct digits
    /// unless the curves have sharp bends. A closed outline must not cross itself; a region counts as often
    /// as the outline winds around it.
    #[must_use]
    pub fn moments(&self) -> Option<Moments> {
        match self {
            Self::Point(point) => point.is_finite().then(|| Moments::point(*point)),
            Self::Outline(outline) => Some(Measured::of(outline)?.moments),
            Self::Union(outlines) => {
                let measured: Vec<_> = outlines.iter().map(Measured::of).collect();
                let measured: Vec<_> = measured.into_iter().collect::<Option<_>>()?;
                union(&measured)
            }
        }
    }

    /// Returns the image under a map; `None` if a part of it has no extent left.
    #[must_use]
    pub fn transformed(&self, map: &DAffine2) -> Option<Self> {
        Some(match self {
            Self::Point(point) => Self::Point(map.transform_point2(*point)),
            Self::Outline(outline) => Self::Outline(outline.transformed(map)?),
            Self::Union(outlines) => {
                let outlines = outlines.iter().map(|outline| outline.transformed(map));
                Self::Union(outlines.collect::<Option<_>>()?)
            }
        })
    }

    /// Returns points whose convex hull contains the shape: see [`BaseElement::control_points`].
    pub(crate) fn control_points(&self) -> Vec<DVec2> {
        match self {
            Self::Point(point) => vec![*point],
            Self::Outline(outline) => outline.control_points().collect(),
            Self::Union(outlines) => {
                let outlines = outlines.iter();
                outlines.flat_map(BaseElement::control_points).collect()
            }
        }
    }

    /// Returns the number of outlines of a union; 1 for any other shape.
    pub(crate) fn count(&self) -> usize {
        match self {
            Self::Union(outlines) => outlines.len(),
            Self::Point(_) | Self::Outline(_) => 1,
        }
    }

    /// Returns the outlines of a union, each with its weight in the uniform distribution: its area where all
    /// are closed, else its length, which is the circumference of closed ones; 1 if all stand for points. The
    /// weights are not normalised. Returns an empty list for any other shape, and where an outline has no
    /// moments.
    pub(crate) fn shares(&self) -> Vec<(f64, &BaseElement)> {
        let Self::Union(outlines) = self else {
            return Vec::new();
        };
        let measured: Option<Vec<_>> = outlines.iter().map(Measured::of).collect();
        let shares = measured.map(|measured| shares(&measured));
        shares
            .unwrap_or_default()
            .into_iter()
            .zip(outlines.iter())
            .collect()
    }
}

/// Size of an outline, and the moments of the uniform distribution on it.
struct Measured<'o> {
    outline: &'o BaseElement,
    /// Power of 2 near to the size of the outline, in which lengths are measured: squares could leave the range of doubles.
    unit: f64,
    /// Length of the control polygon, which is no less than that of the outline.
    span: f64,
    /// The enclosed area of a closed outline.
    area: Option<f64>,
    moments: Moments,
}

impl<'o> Measured<'o> {
    /// Measures an outline; `None` if a number is not finite, it has no extent, or it is closed and has no
    /// area.
    fn of(outline: &'o BaseElement) -> Option<Self> {
        let mut bounds = Bounds::EMPTY;
        outline.control_points().for_each(|point| bounds.add(point));
        let size = bounds.size().max_element();
        // A subnormal size is that of a point after rounding.
        if !size.is_normal() {
            return None;
        }
        let unit = libm::ldexp(1.0, exponent_of(size));
        let relative = |from: DVec2, piece: &Piece, t: f64| {
            let (point, velocity) = at(from, piece, t);
            // Coordinates relative to the start keep the digits of distant shapes.
            ((point - outline.start()) / unit, velocity / unit)
        };
        let mut sums = Sums::NONE;
        let mut from = outline.start();
        for piece in outline.pieces() {
            if outline.is_closed() {
                for (node, weight) in GAUSS {
                    let (point, velocity) = relative(from, piece, node);
                    sums.add_around(point, weight * velocity);
                }
            } else {
                for (t, weight) in nodes(piece) {
                    let (point, velocity) = relative(from, piece, t);
                    sums.add(point, weight * velocity.length());
                }
            }
            from = piece.end();
        }
        let span = span(outline, unit);
        let has_area = sums.total.abs() > 1e-14 * span * span;
        if outline.is_closed() && !has_area {
            return None;
        }
        let mean = sums.first / sums.total;
        let covariance = sums.second * (1.0 / sums.total) - square(mean);
        let is_finite = mean.is_finite() && covariance.is_finite();
        is_finite.then(|| Self {
            outline,
            unit,
            span: span * unit,
            area: { outline.is_closed() }.then_some(sums.total.abs() * unit * unit),
            moments: Moments {
                mean: mean * unit + outline.start(),
                covariance: covariance * unit * unit,
            },
        })
    }

    /// Returns the length of the outline.
    fn length(&self) -> f64 {
        let mut length = 0.0;
        let mut from = self.outline.start();
        for piece in self.outline.pieces() {
            let speed = |t| (at(from, piece, t).1 / self.unit).length();
            let speeds = nodes(piece).map(|(t, weight)| weight * speed(t));
            length += speeds.sum::<f64>();
            from = piece.end();
        }
        length * self.unit
    }

    /// Returns whether the outline stands for a point: whether its size is that of rounding errors at its
    /// place.
    fn is_point(&self) -> bool {
        self.span <= 1e-15 * (1.0 + self.moments.mean.abs().max_element())
    }
}

/// Returns the weights of [`Shape::shares`].
fn shares(measured: &[Measured<'_>]) -> Vec<f64> {
    if measured.iter().all(Measured::is_point) {
        return vec![1.0; measured.len()];
    }
    let areas: Option<Vec<f64>> = measured.iter().map(|outline| outline.area).collect();
    areas.unwrap_or_else(|| measured.iter().map(Measured::length).collect())
}

/// Returns the moments of the mixture of outlines; `None` if they are not finite.
fn union(measured: &[Measured<'_>]) -> Option<Moments> {
    let shares = shares(measured);
    let total: f64 = shares.iter().sum();
    let mixed = || shares.iter().map(|share| share / total).zip(measured);
    let mean = mixed()
        .map(|(share, outline)| share * outline.moments.mean)
        .sum::<DVec2>();
    let spread = mixed().fold(DMat2::ZERO, |sum, (share, outline)| {
        let Moments {
            mean: own,
            covariance,
        } = outline.moments;
        sum + (covariance + square(own - mean)) * share
    });
    (mean.is_finite() && spread.is_finite()).then_some(Moments {
        mean,
        covariance: spread,
    })
}

/// Returns the parameters and weights by which functions of a piece are integrated that are no polynomials.
fn nodes(piece: &Piece) -> impl Iterator<Item = (f64, f64)> {
    let parts = match piece {
        Piece::Line(_) => 1,
        Piece::Cubic(..) => PARTS,
    };
    let share = 1.0 / f64::from(parts);
    (0..parts).flat_map(move |part| {
        let nodes = GAUSS.into_iter();
        nodes.map(move |(node, weight)| ((f64::from(part) + node) * share, weight * share))
    })
}

/// Returns the length of the control polygon of an outline, in units.
fn span(outline: &BaseElement, unit: f64) -> f64 {
    let mut from = outline.start();
    let sides = outline.control_points().map(|point| {
        let side = ((point - from) / unit).length();
        from = point;
        side
    });
    sides.sum()
}

/// Returns point and velocity of a piece at the parameter `t` from 0 to 1.
fn at(from: DVec2, piece: &Piece, t: f64) -> (DVec2, DVec2) {
    let velocity = match *piece {
        Piece::Line(end) => end - from,
        Piece::Cubic(a, b, end) => {
            let s = 1.0 - t;
            3.0 * (s * s * (a - from) + 2.0 * s * t * (b - a) + t * t * (end - b))
        }
    };
    (piece.at(from, t), velocity)
}

/// Integrals of 1, of the points and of their squares.
struct Sums {
    total: f64,
    first: DVec2,
    second: DMat2,
}

impl Sums {
    const NONE: Self = Self {
        total: 0.0,
        first: DVec2::ZERO,
        second: DMat2::ZERO,
    };

    fn add(&mut self, point: DVec2, weight: f64) {
        self.total += weight;
        self.first += weight * point;
        self.second += square(point) * weight;
    }

    /// Adds the integrals over the triangle between a short step `way` and the origin (Green's theorem).
    fn add_around(&mut self, point: DVec2, way: DVec2) {
        let area = point.perp_dot(way) / 2.0;
        self.total += area;
        self.first += area * (2.0 / 3.0) * point;
        self.second += square(point) * (area / 2.0);
    }
}
