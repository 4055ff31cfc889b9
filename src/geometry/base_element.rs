//! Base elements: outlines of lines and cubic Bézier curves in the unit frame, their extent and their
//! area.

use std::ops::RangeInclusive;

use super::{
    Bounds, Corners, Corners2, DAffine2, DVec2, Frame2, Outline, convex_hull, farthest, rightmost,
};

/// Piece of a base element's outline; it starts where the preceding piece ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Piece {
    /// Straight line to a point.
    Line(DVec2),
    /// Cubic Bézier curve: two control points and the end point.
    Cubic(DVec2, DVec2, DVec2),
}

impl Piece {
    /// Returns the end point of the piece.
    #[must_use]
    pub fn end(&self) -> DVec2 {
        match *self {
            Self::Line(end) | Self::Cubic(_, _, end) => end,
        }
    }

    /// Returns the point at the parameter `t`, from 0 to 1, of the piece from a point on.
    #[must_use]
    pub fn at(&self, from: DVec2, t: f64) -> DVec2 {
        match *self {
            Self::Line(end) => from.lerp(end, t),
            Self::Cubic(a, b, end) => {
                let s = 1.0 - t;
                s * s * s * from + 3.0 * s * t * (s * a + t * b) + t * t * t * end
            }
        }
    }

    /// Returns the image of the piece under a map.
    #[inline]
    #[must_use]
    pub fn transformed(&self, map: &DAffine2) -> Self {
        match *self {
            Self::Line(end) => Self::Line(map.transform_point2(end)),
            Self::Cubic(a, b, end) => Self::Cubic(
                map.transform_point2(a),
                map.transform_point2(b),
                map.transform_point2(end),
            ),
        }
    }
}

/// Base element: the outline that is drawn for an element.
///
/// Coordinates are those of the unit frame, in which the element runs from (0, 0) to (1, 0).
///
/// Guarantees: there is at least one piece, and all coordinates are finite. The end points of an open
/// base element differ; a closed one is a polygon (or a curve) whose last piece ends at its start.
#[derive(Clone, Debug, PartialEq)]
pub struct BaseElement {
    start: DVec2,
    pieces: Vec<Piece>,
    /// Start and pieces of the outline in the opposite order.
    backwards: (DVec2, Vec<Piece>),
    signed_area: f64,
    closed: bool,
    hull: Option<Box<Hull>>,
}

/// Convex hull of an outline of many lines.
#[derive(Clone, Debug, PartialEq)]
struct Hull {
    /// Corners, counter-clockwise from the leftmost.
    corners: Vec<DVec2>,
    /// Number of the rightmost corner.
    rightmost: usize,
}

impl Hull {
    /// Returns the hull of an outline; `None` if it has few lines, or curves, or if products of its coordinates may leave the
    /// range of doubles.
    fn of(start: DVec2, pieces: &[Piece]) -> Option<Box<Self>> {
        /// Number of lines from which support functions are sought on the hull.
        const MANY: usize = 32;
        /// Sizes whose products are far from the ends of the range of doubles.
        const SIZES: RangeInclusive<f64> = 1e-100..=1e100;
        let is_line = |piece: &Piece| matches!(piece, Piece::Line(_));
        if pieces.len() < MANY || !pieces.iter().all(is_line) {
            return None;
        }
        let points: Vec<DVec2> = std::iter::once(start)
            .chain(pieces.iter().map(Piece::end))
            .collect();
        let mut bounds = Bounds::EMPTY;
        points.iter().for_each(|point| bounds.add(*point));
        let far = bounds.min().abs().max(bounds.max().abs()).max_element();
        if !SIZES.contains(&bounds.size().max_element()) || !SIZES.contains(&far) {
            return None;
        }
        let corners = convex_hull(points, 0.0);
        Some(Box::new(Self {
            rightmost: rightmost(&corners),
            corners,
        }))
    }
}

impl BaseElement {
    /// Creates a base element from a start point and pieces; a closed outline that does not end at its
    /// start is completed by a line.
    ///
    /// Returns `None` if the outline violates a guarantee of the type: no piece, no extent, equal end
    /// points of an open outline, or a coordinate that is not finite.
    #[must_use]
    pub fn new(start: DVec2, mut pieces: Vec<Piece>, closed: bool) -> Option<Self> {
        let end = pieces.last()?.end();
        if closed && end != start {
            pieces.push(Piece::Line(start));
        }
        let stays = |piece: &Piece| match *piece {
            Piece::Line(end) => end == start,
            // // A loop has an extent although it ends at its start.
            Piece::Cubic(a, b, end) => [a, b, end] == [start; 3],
        };
        if !closed && end == start || pieces.iter().all(stays) {
            return None;
        }
        let finite = |piece: &Piece| match piece {
            Piece::Line(end) => end.is_finite(),
            Piece::Cubic(a, b, end) => a.is_finite() && b.is_finite() && end.is_finite(),
        };
        if !start.is_finite() || !pieces.iter().all(finite) {
            return None;
        }
        Some(Self {
            backwards: backwards(start, &pieces),
            signed_area: signed_area(start, &pieces),
            hull: Hull::of(start, &pieces),
            start,
            pieces,
            closed,
        })
    }

    /// Returns the image under a map, or `None` if the image has no extent or is not finite.
    #[must_use]
    pub fn transformed(&self, map: &DAffine2) -> Option<Self> {
        let pieces = self.pieces.iter().map(|piece| piece.transformed(map));
        Self::new(
            map.transform_point2(self.start),
            pieces.collect(),
            self.closed,
        )
    }

    /// Returns the line from (0, 0) to (1, 0), the base element of a rule that names none.
    #[must_use]
    pub fn line() -> Self {
        let (start, pieces) = (DVec2::ZERO, vec![Piece::Line(DVec2::X)]);
        Self {
            backwards: backwards(start, &pieces),
            signed_area: signed_area(start, &pieces),
            hull: None,
            start,
            pieces,
            closed: false,
        }
    }

    /// Returns whether the outline is closed; closed base elements never join their neighbours.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// Returns whether the outline is the line from (0, 0) to (1, 0).
    #[must_use]
    pub fn is_line(&self) -> bool {
        self.start == DVec2::ZERO && self.pieces == [Piece::Line(DVec2::X)]
    }

    /// Returns the start of the outline, in the order of listing.
    #[must_use]
    pub fn start(&self) -> DVec2 {
        self.start
    }

    /// Returns the pieces in the order of listing.
    #[must_use]
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// Returns start and pieces in the order of traversal: as listed, or reversed.
    #[inline]
    #[must_use]
    pub fn outline(&self, reversed: bool) -> (DVec2, &[Piece]) {
        if reversed {
            (self.backwards.0, &self.backwards.1)
        } else {
            (self.start, &self.pieces)
        }
    }

    /// Returns whether the outline starts at (0, 0), and whether it ends at (1, 0): at the end points of
    /// its element. Both are false for a closed outline.
    ///
    /// An element of an open outline shares these end points with the neighbours that it joins; at any
    /// other end (of a Hilbert cup, for example) a line links it to the neighbour.
    #[must_use]
    pub fn ends_meet_frame(&self) -> [bool; 2] {
        [
            !self.closed && self.start == DVec2::ZERO,
            !self.closed && self.backwards.0 == DVec2::X,
        ]
    }

    /// Returns the corners of the outline's image under a map, in the order of listing, with every curve divided
    /// into a number of chords.
    pub(crate) fn corners(&self, map: &DAffine2, chords: u32) -> Vec<DVec2> {
        let mut from = map.transform_point2(self.start);
        let mut corners = vec![from];
        for piece in &self.pieces {
            let piece = piece.transformed(map);
            if let Piece::Cubic(..) = piece {
                let inner = (1..chords).map(|chord| f64::from(chord) / f64::from(chords));
                corners.extend(inner.map(|t| piece.at(from, t)));
            }
            from = piece.end();
            corners.push(from);
        }
        corners
    }

    /// Iterates over points whose convex hull contains the outline: the ends of pieces, and the control
    /// points of curves.
    pub(crate) fn control_points(&self) -> impl Iterator<Item = DVec2> {
        let points = self.pieces.iter().flat_map(|piece| match *piece {
            Piece::Line(end) => [end; 3],
            Piece::Cubic(a, b, end) => [a, b, end],
        });
        std::iter::once(self.start).chain(points)
    }

    /// Iterates over points whose convex hull contains the outline, fewer than [`control_points`](Self::control_points) where
    /// the outline consists of many lines.
    pub(crate) fn hull_points(&self) -> impl Iterator<Item = DVec2> {
        let known = self.hull.iter().flat_map(|hull| &hull.corners).copied();
        let others = self.hull.is_none().then(|| self.control_points());
        known.chain(others.into_iter().flatten())
    }

    /// Extends `bounds` by the box of the outline placed in a frame, padded by `pad` on every side.
    pub fn add_to(&self, bounds: &mut Bounds, frame: &Frame2, pad: f64) {
        let mut from = frame.apply(self.start);
        let mut add = |point: DVec2| {
            bounds.add(point - pad);
            bounds.add(point + pad);
        };
        add(from);
        for piece in &self.pieces {
            let piece = piece.transformed(frame.map());
            if let Piece::Cubic(a, b, end) = piece {
                let largest = |u: DVec2| largest_of_cubic([from, a, b, end].map(|p| p.dot(u)));
                add(DVec2::new(largest(DVec2::X), largest(DVec2::Y)));
                add(-DVec2::new(largest(-DVec2::X), largest(-DVec2::Y)));
            }
            from = piece.end();
            add(from);
        }
    }

    /// Returns the signed area between the outline and the line from its end back to its start: positive
    /// where that contour runs counter-clockwise.
    #[must_use]
    pub fn signed_area(&self) -> f64 {
        self.signed_area
    }
}

impl Outline<Frame2> for BaseElement {
    forward! {
        is_closed(&self) -> bool;
        is_line(&self) -> bool;
        ends_meet_frame(&self) -> [bool; 2];
        signed_area(&self) -> f64;
        add_to(&self, bounds: &mut Bounds, frame: &Frame2, pad: f64) -> ();
    }

    fn complexity(&self) -> usize {
        self.pieces.len()
    }

    fn support(&self, direction: DVec2) -> f64 {
        if let Some(Hull { corners, rightmost }) = self.hull.as_deref()
            && let Some(corner) = farthest(corners, *rightmost, direction)
        {
            return corners[corner].dot(direction);
        }
        let mut from = self.start.dot(direction);
        let mut largest = from;
        for piece in &self.pieces {
            let end = piece.end().dot(direction);
            largest = largest.max(end);
            if let Piece::Cubic(a, b, _) = piece {
                let values = [from, a.dot(direction), b.dot(direction), end];
                largest = largest.max(largest_of_cubic(values));
            }
            from = end;
        }
        largest
    }

    fn add_corners(&self, corners: &mut Corners2, frame: &Frame2) -> bool {
        let (start, pieces) = self.outline(frame.direction().is_reversed());
        corners.add(frame.apply(start));
        pieces.iter().all(|piece| {
            let is_line = matches!(piece, Piece::Line(_));
            corners.add(frame.apply(piece.end()));
            is_line
        })
    }
}

/// Computes the signed area between an outline and the line from its end back to its start.
fn signed_area(start: DVec2, pieces: &[Piece]) -> f64 {
    let mut from = start;
    let mut twice = 0.0;
    for piece in pieces {
        // ½∮(x dy − y dx) of a cubic is a sum of cross products of its control points.
        if let Piece::Cubic(a, b, end) = *piece {
            twice += (6.0 * (from.perp_dot(a) + b.perp_dot(end))
                + 3.0 * (from.perp_dot(b) + a.perp_dot(b) + a.perp_dot(end))
                + from.perp_dot(end))
                / 10.0;
        } else {
            twice += from.perp_dot(piece.end());
        }
        from = piece.end();
    }
    (twice + from.perp_dot(start)) / 2.0
}

fn backwards(start: DVec2, pieces: &[Piece]) -> (DVec2, Vec<Piece>) {
    let mut from = start;
    let mut reversed = Vec::with_capacity(pieces.len());
    for piece in pieces {
        reversed.push(match *piece {
            Piece::Line(_) => Piece::Line(from),
            Piece::Cubic(a, b, _) => Piece::Cubic(b, a, from),
        });
        from = piece.end();
    }
    reversed.reverse();
    (from, reversed)
}

/// Returns the maximum of a cubic Bézier polynomial over [0, 1], from the zeros of its derivative.
fn largest_of_cubic([p0, p1, p2, p3]: [f64; 4]) -> f64 {
    let (d0, d1, d2) = (p1 - p0, p2 - p1, p3 - p2);
    let (a, b, c) = (d0 - 2.0 * d1 + d2, d1 - d0, d0);
    let root = (b * b - a * c).max(0.0).sqrt();
    // The zeros of a t² + 2 b t + c, in the form without cancellation.
    let q = -(b + b.signum() * root);
    [q / a, c / q]
        .into_iter()
        .filter(|t| (0.0..=1.0).contains(t))
        .map(|t| {
            let s = 1.0 - t;
            s * s * s * p0 + 3.0 * s * s * t * p1 + 3.0 * s * t * t * p2 + t * t * t * p3
        })
        .fold(p0.max(p3), f64::max)
}

/// Returns cubic Bézier pieces along the circular arc from `from` through `through` to `to`, or `None` if
/// the three points are collinear.
///
/// Each piece spans at most 22.5°, which limits the deviation from the arc to 1e-7 of its radius. Its sector has the area
/// of that of the arc, to rounding.
#[must_use]
pub fn arc(from: DVec2, through: DVec2, to: DVec2) -> Option<Vec<Piece>> {
    let (a, b) = (through - from, to - from);
    let cross = 2.0 * a.perp_dot(b);
    let centre = from + (a.perp() * b.length_squared() - b.perp() * a.length_squared()) / cross;
    if !centre.is_finite() || cross.abs() < 1e-12 * b.length_squared() {
        return None;
    }
    let angle = |p: DVec2| libm::atan2((p - centre).y, (p - centre).x);
    let turn = |angle: f64| angle - std::f64::consts::TAU * (angle / std::f64::consts::TAU).floor();
    let whole = if cross > 0.0 {
        turn(angle(to) - angle(from))
    } else {
        -turn(angle(from) - angle(to))
    };
    let count = (whole.abs() / (std::f64::consts::PI / 8.0)).ceil().max(1.0);
    let step = whole / count;
    let (sine, cosine) = (libm::sin(step), libm::cos(step));
    let handle = handle(step);
    let mut radius = from - centre;
    let mut pieces = Vec::new();
    let mut number = 1.0;
    while number <= count {
        let next = DVec2::new(
            radius.x * cosine - radius.y * sine,
            radius.x * sine + radius.y * cosine,
        );
        let end = if number == count { to } else { centre + next };
        pieces.push(Piece::Cubic(
            centre + radius + radius.perp() * handle,
            centre + next - next.perp() * handle,
            end,
        ));
        radius = next;
        number += 1.0;
    }
    Some(pieces)
}

/// Returns the length of the handles of a cubic piece that has the area of an arc by an angle, at the radius 1.
fn handle(angle: f64) -> f64 {
    /// Angle below which a piece with its middle on the arc has the same area, to rounding.
    const SMALL: f64 = 0.02;
    if angle.abs() < SMALL {
        return 4.0 / 3.0 * libm::tan(angle / 4.0);
    }
    // Twice the area of the sector, which is the angle, is quadratic in the length.
    let (sine, half) = (libm::sin(angle), libm::sin(angle / 2.0));
    let drop = 12.0 * half * half;
    let root = (drop * drop - 30.0 * sine * (angle - sine)).sqrt();
    (drop - root) / (3.0 * sine)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Outlines of many lines have a hull, unless products of their coordinates may leave the range of doubles.
    #[test]
    fn supports_of_hulls_are_those_of_all_points() {
        let corner = |number: u32| {
            let angle = f64::from(number) * 2.4;
            DVec2::from_angle(angle) * DVec2::new(3.0, 1.0) * f64::from(1 + number % 7)
        };
        let sizes = [(31, 1.0), (32, 1.0), (500, 1.0), (40, 1e155), (40, 1e-170)];
        for (count, size) in sizes {
            let points: Vec<DVec2> = (0..count).map(|number| corner(number) * size).collect();
            let lines = points[1..].iter().map(|point| Piece::Line(*point));
            let outline = BaseElement::new(points[0], lines.collect(), true).unwrap();
            assert_eq!(outline.hull.is_some(), count >= 32 && size == 1.0);
            for angle in 0..100 {
                let direction = DVec2::from_angle(f64::from(angle)) * 0.3;
                let along = points.iter().map(|point| point.dot(direction));
                let most = along.fold(f64::NEG_INFINITY, f64::max);
                assert!((outline.support(direction) - most).abs() <= 1e-15 * most.abs());
                let of_hull = outline.hull_points().map(|point| point.dot(direction));
                assert!(of_hull.fold(f64::NEG_INFINITY, f64::max) >= most - 1e-14 * size);
            }
        }
    }
}
