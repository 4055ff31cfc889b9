//! Outlines that are much larger than what is seen of them.

use dashu_int::IBig;
use dashu_int::ops::BitTest;

use crate::expression::Precise;
use crate::geometry::{DVec2, Direction, Frame};
use crate::rule::{BaseElement, Piece};

use super::descent::pixel;
use super::fixed::{Fixed, Vector, double};

/// What is farther from the middle than this many radii is drawn nearer.
const FAR: f64 = 4.0;

/// A piece: two points of a line, or the four of a curve.
type Points = Vec<Vector>;

/// A part of an outline in pixels, as a base element and the frame that it stands in: an open one runs
/// from end to end of the frame, as what may join others has to.
pub(super) struct Clipped {
    pub(super) frame: Frame,
    pub(super) outline: BaseElement,
}

/// An outline under a map in parts of a pixel, in pixels: as it is within a radius about (0, 0), and
/// leading around that as it does everywhere else. `None` where nothing of it comes near, and it
/// does not enclose what is.
///
/// Pieces are halved until they are shorter than the radius, or farther away than they are long; the
/// latter are drawn on a circle.
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
        let shows = path.comes_near || path.goes_around();
        let outline = BaseElement::new(path.start, path.pieces, true);
        outline.filter(|_| shows).map(|outline| Clipped {
            frame: Frame::UNIT,
            outline,
        })
    } else {
        path.comes_near.then(|| path.open()).flatten()
    }
}

/// A path in pixels.
pub(super) struct Path {
    radius: f64,
    start: DVec2,
    pieces: Vec<Piece>,
    last: DVec2,
    /// Whether any of it is drawn as it is.
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

    /// One open path, or two where it comes back to its start.
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

    /// An open path; `None` if it comes back to its start.
    pub(super) fn open(self) -> Option<Clipped> {
        let frame = Frame::between(self.start, self.last, Direction::Normal);
        let back = frame.map.inverse();
        let pieces = self.pieces.iter().map(|piece| piece.transformed(&back));
        let mut pieces: Vec<Piece> = pieces.collect();
        // To the very end, which rounding must not miss.
        match pieces.last_mut()? {
            Piece::Line(end) | Piece::Cubic(_, _, end) => *end = DVec2::X,
        }
        let outline = BaseElement::new(DVec2::ZERO, pieces, false)?;
        Some(Clipped { frame, outline })
    }

    /// Goes on by a line to the start of another path, and by that.
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

    /// Goes on by a line, if that leads anywhere.
    fn go_to(&mut self, end: DVec2) {
        if end.distance(self.last) > 1e-6 * self.radius {
            self.pieces.push(Piece::Line(end));
            self.last = end;
        }
    }

    /// Goes on by a piece that begins where the one before ends.
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

    /// Whether a closed path that does not come near turns around (0, 0).
    pub(super) fn goes_around(&self) -> bool {
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
            // It may begin a little off the circle.
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

/// Where a point is drawn: where it is, or on the circle.
fn drawn((near, unit): (Vec<DVec2>, f64), radius: f64) -> DVec2 {
    let point = near[0];
    let length = point.length();
    if length * unit <= FAR * radius {
        point * unit
    } else {
        point * (FAR * radius / length)
    }
}

/// Points in doubles, and their unit in pixels.
fn near(points: &[Vector]) -> (Vec<DVec2>, f64) {
    const DIGITS: usize = 96;
    let lengths = points.iter().flatten().map(|it| it.bit_len());
    let exponent = lengths.max().unwrap_or(0).saturating_sub(DIGITS);
    let number = |number: &IBig| double(&(number >> exponent));
    let point = |[x, y]: &Vector| DVec2::new(number(x), number(y));
    (points.iter().map(point).collect(), pixel(exponent))
}

/// Both halves of a line or a curve (de Casteljau).
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
