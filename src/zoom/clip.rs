//! Clipping of outlines that are much larger than the window.

use crate::expression::{Precise, leading};
use crate::geometry::{DVec2, Direction, Frame2};
use crate::rule::{BaseElement, Piece};

use super::descent::pixel;
use super::fixed::{Fixed, Vector};

/// Distance from the centre, in radii, to which all points farther away are moved.
const FAR: f64 = 4.0;

/// Points of a piece: two of a line, or four of a curve.
type Points = Vec<Vector>;

/// Part of an outline in pixels, as a base element and its frame. An open one runs from end to end of the
/// frame, which joining requires.
pub(super) struct Clipped {
    pub(super) frame: Frame2,
    pub(super) outline: BaseElement,
}

/// Clips an outline under a map in parts of a pixel to a radius about (0, 0), in pixels: unchanged within
/// the radius, and with the same winding around it. `None` if the outline neither comes near the disc nor
/// encloses it.
///
/// Pieces are halved until they are shorter than the radius, or farther away than they are long; pieces
/// that are far away are drawn on a circle.
pub(super) fn clipped(
    outline: &BaseElement,
    map: &Fixed,
    bits: usize,
    radius: f64,
) -> Option<Clipped> {
    let long = |point: DVec2| {
        let point = [point.x, point.y].map(|it| Precise::of(it).fixed(bits));
        map.image(&point, bits)
    };
    let mut from = long(outline.start());
    let mut path = Path::new(&from, radius);
    for piece in outline.pieces() {
        let mut points = vec![from];
        match *piece {
            Piece::Line(end) => points.push(long(end)),
            Piece::Cubic(a, b, end) => points.extend([a, b, end].map(long)),
        }
        from = points[points.len() - 1].clone();
        path.add(points);
    }
    if outline.is_closed() {
        let shows = path.comes_near || path.encloses();
        let outline = BaseElement::new(path.start, path.pieces, true);
        outline.filter(|_| shows).map(|outline| Clipped {
            frame: Frame2::UNIT,
            outline,
        })
    } else {
        path.comes_near.then(|| path.open()).flatten()
    }
}

/// Path in pixels.
pub(super) struct Path {
    radius: f64,
    start: DVec2,
    pieces: Vec<Piece>,
    last: DVec2,
    /// Whether any part of it is drawn unchanged.
    comes_near: bool,
}

impl Path {
    pub(super) fn new(start: &Vector, radius: f64) -> Self {
        let start = drawn(near(std::slice::from_ref(start)), radius);
        Self {
            radius,
            start,
            pieces: Vec::new(),
            last: start,
            comes_near: false,
        }
    }

    /// Returns the path as one open path, or as two if it returns to its start.
    pub(super) fn ways(mut self) -> Vec<Clipped> {
        let returns = self.start.distance(self.last) <= 1e-6 * self.radius;
        if !returns || self.pieces.len() < 2 {
            return self.open().into_iter().collect();
        }
        let pieces = self.pieces.split_off(1);
        let middle = self.pieces[0].end();
        let second = Self {
            radius: self.radius,
            start: middle,
            pieces,
            last: self.last,
            comes_near: self.comes_near,
        };
        self.last = middle;
        [self, second].into_iter().filter_map(Self::open).collect()
    }

    /// Returns the path as an open outline, or `None` if it returns to its start.
    pub(super) fn open(self) -> Option<Clipped> {
        let frame = Frame2::between(self.start, self.last, Direction::Normal);
        let back = frame.map().inverse();
        let pieces = self.pieces.iter().map(|piece| piece.transformed(&back));
        let mut pieces: Vec<Piece> = pieces.collect();
        // Rounding must not move the end.
        match pieces.last_mut()? {
            Piece::Line(end) | Piece::Cubic(_, _, end) => *end = DVec2::X,
        }
        let outline = BaseElement::new(DVec2::ZERO, pieces, false)?;
        Some(Clipped { frame, outline })
    }

    /// Appends a line to the start of another path, and that path.
    pub(super) fn append(&mut self, other: &Self) {
        self.go_to(other.start);
        for piece in &other.pieces {
            match *piece {
                Piece::Line(end) => self.go_to(end),
                Piece::Cubic(_, _, end) => {
                    self.pieces.push(*piece);
                    self.last = end;
                }
            }
        }
        self.go_to(other.last);
        self.comes_near |= other.comes_near;
    }

    /// Appends a line, unless its length is negligible.
    fn go_to(&mut self, end: DVec2) {
        if end.distance(self.last) > 1e-6 * self.radius {
            self.pieces.push(Piece::Line(end));
            self.last = end;
        }
    }

    /// Appends a piece that begins at the end of the previous one.
    pub(super) fn add(&mut self, whole: Points) {
        let mut stack = vec![whole];
        while let Some(points) = stack.pop() {
            let (near, unit) = near(&points);
            let (first, rest) = (near[0], &near[1..]);
            let length = rest.iter().map(|it| it.distance(first)).fold(0.0, f64::max);
            let away = first.length() - length;
            let is_short = length * unit <= self.radius;
            if is_short || away >= length {
                self.draw(&near, unit, is_short);
            } else {
                let [first, second] = halves(&points);
                stack.extend([second, first]);
            }
        }
    }

    /// Returns whether the path, closed by a line, winds around (0, 0); it must not come near.
    pub(super) fn encloses(&self) -> bool {
        let ends = self.pieces.iter().map(Piece::end);
        let from = std::iter::once(self.start).chain(ends.clone());
        let turns = from.zip(ends.chain([self.start]));
        let angle = |(a, b): (DVec2, DVec2)| libm::atan2(a.perp_dot(b), a.dot(b));
        turns.map(angle).sum::<f64>().abs() > std::f64::consts::PI
    }

    fn draw(&mut self, near: &[DVec2], unit: f64, is_short: bool) {
        let inside = |point: &DVec2| point.length() * unit <= FAR * self.radius;
        if is_short && near.iter().all(inside) {
            let points: Vec<DVec2> = near.iter().map(|point| *point * unit).collect();
            let piece = match points[..] {
                [_, a, b, end] => Piece::Cubic(a, b, end),
                _ => Piece::Line(points[points.len() - 1]),
            };
            let (first, last) = (points[0], piece.end());
            // The piece may begin slightly off the circle.
            self.go_to(first);
            self.pieces.push(piece);
            self.last = last;
            self.comes_near = true;
            return;
        }
        let end = drawn((vec![near[near.len() - 1]], unit), self.radius);
        if end.distance(self.last) > 1e-3 * self.radius {
            self.pieces.push(Piece::Line(end));
            self.last = end;
        }
    }
}

/// Returns the position at which a point is drawn: unchanged, or moved to the circle.
fn drawn((near, unit): (Vec<DVec2>, f64), radius: f64) -> DVec2 {
    let point = near[0];
    let length = point.length();
    if length * unit <= FAR * radius {
        point * unit
    } else {
        point * (FAR * radius / length)
    }
}

/// Converts points to doubles; returns their unit in pixels as well.
fn near(points: &[Vector]) -> (Vec<DVec2>, f64) {
    let (near, exponent) = leading(points.iter().flatten());
    let near: Vec<f64> = near.collect();
    let points = near.chunks_exact(2).map(DVec2::from_slice);
    (points.collect(), pixel(exponent))
}

/// Halves a line or a curve (de Casteljau).
fn halves(points: &Points) -> [Points; 2] {
    let middle = |a: &Vector, b: &Vector| [(&a[0] + &b[0]) >> 1, (&a[1] + &b[1]) >> 1];
    let (mut first, mut second) = (Vec::new(), Vec::new());
    let mut row = points.clone();
    loop {
        first.push(row[0].clone());
        second.push(row[row.len() - 1].clone());
        if row.len() == 1 {
            break;
        }
        row = row
            .windows(2)
            .map(|pair| middle(&pair[0], &pair[1]))
            .collect();
    }
    second.reverse();
    [first, second]
}
