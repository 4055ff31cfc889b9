use std::sync::Arc;

use super::Moments;
use super::moments::square;
use crate::expression::degrees;
use crate::geometry::{Bounds, DAffine2, DMat2, DVec2};
use crate::graph::exponent_of;
use crate::rule::{BaseElement, Piece, arc};

/// A condensation set or an initial set, in the coordinates of the plane.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A point.
    Point(DVec2),
    /// A line if it is open, and what it encloses if it is closed.
    Outline(BaseElement),
    /// Several of them: an approximant of another fractal. Never none.
    Union(Arc<[BaseElement]>),
}

/// A curve is measured in so many parts.
const PARTS: u32 = 16;

/// The nodes and weights of Gauss's quadrature over [0, 1], exact for polynomials of degree 11, as
/// the area's moments of a cubic outline are.
const GAUSS: [(f64, f64); 6] = [
    (0.033_765_242_898_423_99, 0.085_662_246_189_585_17),
    (0.169_395_306_766_867_74, 0.180_380_786_524_069_3),
    (0.380_690_406_958_401_55, 0.233_956_967_286_345_52),
    (0.619_309_593_041_598_4, 0.233_956_967_286_345_52),
    (0.830_604_693_233_132_3, 0.180_380_786_524_069_3),
    (0.966_234_757_101_576, 0.085_662_246_189_585_17),
];

impl Shape {
    /// A line through points, `None` if it has no length or ends where it starts.
    #[must_use]
    pub fn polyline(points: &[DVec2]) -> Option<Self> {
        Self::through(points, false)
    }

    /// What a line through points and back to the first encloses; `None` if it has no length.
    #[must_use]
    pub fn polygon(points: &[DVec2]) -> Option<Self> {
        Self::through(points, true)
    }

    fn through(points: &[DVec2], closed: bool) -> Option<Self> {
        let (&start, others) = points.split_first()?;
        let pieces = others.iter().map(|&point| Piece::Line(point)).collect();
        BaseElement::new(start, pieces, closed).map(Self::Outline)
    }

    /// An ellipse with its half axes, of which the first is turned by an angle in degrees,
    /// counter-clockwise, from the x axis. `None` if it has no extent.
    ///
    /// The outline is within 1e-7 of the ellipse, as a multiple of the longer half axis.
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

    /// Mean and covariance of the uniform distribution: along an open outline by length, within a
    /// closed one by area; in a union by area where all are closed, else by length, to which closed ones
    /// add their circumference. `None` if something is not finite or a closed outline has no area.
    ///
    /// Exact to rounding for the outline as it is, but for lengths of curves, where some 9 digits are
    /// right unless they have sharp bends. A closed outline must not cross itself, else parts count as often as it turns
    /// around them.
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

    /// The number of outlines, or points.
    pub(crate) fn count(&self) -> usize {
        match self {
            Self::Union(outlines) => outlines.len(),
            Self::Point(_) | Self::Outline(_) => 1,
        }
    }

    /// The outlines of a union, each with its share of the uniform distribution on it: by area where
    /// all are closed, else by length, which is the circumference of closed ones; equal shares of
    /// points. Any other shape has no parts.
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

/// How large an outline is, and the moments of the uniform distribution on it.
struct Measured {
    length: f64,
    /// What a closed outline encloses.
    area: Option<f64>,
    moments: Moments,
}

impl Measured {
    /// `None` if something is not finite, or a closed outline has no area.
    fn of(outline: &BaseElement) -> Option<Self> {
        // In units of its own, lest squares leave the range of doubles.
        let mut bounds = Bounds::EMPTY;
        outline.control_points().for_each(|point| bounds.add(point));
        let size = bounds.size().max_element();
        // A smaller one is that of a point, rounded.
        if !size.is_normal() {
            return None;
        }
        let unit = libm::ldexp(1.0, exponent_of(size));
        let (mut length, mut around) = (Sums::NONE, Sums::NONE);
        let mut from = outline.start();
        for piece in outline.pieces() {
            let parts = if matches!(piece, Piece::Line(_)) {
                1
            } else {
                PARTS
            };
            let share = 1.0 / f64::from(parts);
            for part in 0..parts {
                for (node, weight) in GAUSS {
                    let (point, velocity) = at(from, piece, (f64::from(part) + node) * share);
                    // From the start, lest distant shapes lose digits.
                    let (point, velocity) = ((point - outline.start()) / unit, velocity / unit);
                    length.add(point, weight * share * velocity.length());
                    around.add_around(point, weight * share * velocity);
                }
            }
            from = piece.end();
        }
        let has_area = around.total.abs() > 1e-14 * length.total * length.total;
        if outline.is_closed() && !has_area {
            return None;
        }
        let sums = if outline.is_closed() {
            &around
        } else {
            &length
        };
        let mean = sums.first / sums.total;
        let covariance = sums.second * (1.0 / sums.total) - square(mean);
        let is_finite = mean.is_finite() && covariance.is_finite();
        is_finite.then(|| Self {
            length: length.total * unit,
            area: { outline.is_closed() }.then_some(around.total.abs() * unit * unit),
            moments: Moments {
                mean: mean * unit + outline.start(),
                covariance: covariance * unit * unit,
            },
        })
    }

    /// Whether it stands for a point: is the shortest line that there is.
    fn is_point(&self) -> bool {
        self.length <= 1e-15 * (1.0 + self.moments.mean.abs().max_element())
    }
}

/// As [`Shape::shares`].
fn shares(measured: &[Measured]) -> Vec<f64> {
    if measured.iter().all(Measured::is_point) {
        return vec![1.0; measured.len()];
    }
    let areas: Option<Vec<f64>> = measured.iter().map(|outline| outline.area).collect();
    areas.unwrap_or_else(|| measured.iter().map(|outline| outline.length).collect())
}

/// The moments of a mixture.
fn union(measured: &[Measured]) -> Option<Moments> {
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

/// Point and velocity of a piece at the time `t` from 0 to 1.
fn at(from: DVec2, piece: &Piece, t: f64) -> (DVec2, DVec2) {
    match *piece {
        Piece::Line(end) => (from.lerp(end, t), end - from),
        Piece::Cubic(a, b, end) => {
            let s = 1.0 - t;
            let point = s * s * s * from + 3.0 * s * t * (s * a + t * b) + t * t * t * end;
            let velocity = s * s * (a - from) + 2.0 * s * t * (b - a) + t * t * (end - b);
            (point, 3.0 * velocity)
        }
    }
}

/// The integrals of 1, of the points and of their squares.
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

    /// Adds what the triangle between a short way and the origin encloses (Green's theorem).
    fn add_around(&mut self, point: DVec2, way: DVec2) {
        let area = point.perp_dot(way) / 2.0;
        self.total += area;
        self.first += area * (2.0 / 3.0) * point;
        self.second += square(point) * (area / 2.0);
    }
}
